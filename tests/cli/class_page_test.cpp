// The manual of the classes: every one has an example that a scene takes as it stands, and a picture of it.
#include <regex>
#include <set>

#include "host/html.h"
#include "host/scene/classes.h"
#include "tests/cli/program.h"
#include "tests/support/light_probe.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

std::string article(const std::string& page, const std::string& id) {
    const size_t begin = page.find("<article id=\"" + id + "\">");
    return begin == std::string::npos ? "" : page.substr(begin, page.find("</article>", begin) - begin);
}

// The data of all pictures, base64.
std::set<std::string> pictures(const std::string& page) {
    std::set<std::string> found;
    const std::string mark = "data:image/png;base64,";
    for (size_t at = 0; (at = page.find(mark, at)) != std::string::npos;) {
        at += mark.size();
        found.insert(page.substr(at, page.find('"', at) - at));
    }
    return found;
}

}  // namespace

TEST_CASE(
    "the page has every class with its parameters, an example that names the class, and a picture of its "
    "own") {
    const Executable program;
    const Run run = program.run({"classes", "--html", "classes.html", "--passes", "1"});
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.empty());
    CHECK(run.err.find("warning") == std::string::npos);
    const std::string page = read_text(program.folder / "classes.html");
    CHECK(page.ends_with("</html>\n"));
    CHECK(page.find("http") == std::string::npos);  // it needs no other file
    ClassRegistry registry(test_sources());
    size_t count = 0;
    for (const InterfaceInfo& interface : all_interfaces())
        for (const ClassInfo& listed : registry.classes(interface.interface)) {
            const ClassInfo& info = *registry.find(interface.interface, listed.name);
            CAPTURE(info.file);
            ++count;
            const std::string part = article(page, std::string(interface.name) + "-" + info.name);
            for (const Parameter& p : info.parameters)
                if (p.from_scene)
                    CHECK_MESSAGE(part.find("<code>" + p.member.name + "</code>") != std::string::npos,
                                  p.member.name);
            REQUIRE(!info.example.empty());
            CHECK(part.find("<pre>" + escaped(info.example) + "</pre>") != std::string::npos);
            CHECK(part.find("data:image/png;base64,iVBORw0KGgo") != std::string::npos);
            CHECK(nlohmann::json::parse(info.example, nullptr, false).is_object());
            // glTF has words of its own for these: meshes, emission, materials.
            if (info.name != "triangle" && info.name != "area" && info.name != "principled")
                CHECK(info.example.find(fmt::format("\"class\": \"{}\"", info.name)) != std::string::npos);
        }
    CHECK(pictures(page).size() == count);  // no two alike
}

TEST_CASE("a page of one class, of shaders from a folder: without an example it has no picture") {
    const Executable program;
    std::filesystem::copy(source_path("shaders"), program.folder / "shaders",
                          std::filesystem::copy_options::recursive);
    const auto file = program.folder / "shaders/surfaces/absorber.glsl";
    const std::string text = read_text(file);
    const auto page_of = [&](const std::string& example) {
        write_text(file, std::regex_replace(text, std::regex("// Example:\n(//     .*\n)+"), example));
        return program.run(
            {"classes", "absorber", "--html", "a.html", "--shaders", "shaders", "--passes", "1"});
    };
    REQUIRE(page_of("").code == 0);
    const std::string page = read_text(program.folder / "a.html");
    CHECK(page.find("Absorbs all light") != std::string::npos);
    CHECK(page.find("<article id=\"surface-conductor\"") == std::string::npos);
    CHECK(page.find("<pre>") == std::string::npos);
    CHECK(pictures(page).empty());
    // What is wrong with an example is one line that names the class or the place, and the page stays as it
    // was.
    for (const auto& [example, named] :
         {std::pair("// Example:\n//     {\"materials\": [\n", "surfaces/absorber.glsl"),
          std::pair("// Example:\n//     {\"materials\": [{\"name\": 3}]}\n", "/materials/2/name")}) {
        const Run run = page_of(example);
        CAPTURE(run.err);
        CHECK(run.code == 2);
        CHECK(run.err.find(named) != std::string::npos);
        CHECK(read_text(program.folder / "a.html") == page);
    }
}

TEST_CASE("an interrupted page is whole, with the pictures so far, and leaves no folder behind") {
    Executable program;
    std::filesystem::create_directory(program.folder / "tmp");
    program.environment["TMPDIR"] = (program.folder / "tmp").string();
    const pid_t child = program.start({"classes", "--html", "classes.html", "--passes", "1000000"});
    for (int i = 0; i < 1200 && read_text(program.folder / "stderr.txt").find("passes") == std::string::npos;
         ++i)
        usleep(100000);
    CHECK(!std::filesystem::is_empty(program.folder / "tmp"));
    kill(child, SIGINT);
    const Run run = program.finish(child);
    CAPTURE(run.err);
    CHECK(run.code == 130);
    const std::string page = read_text(program.folder / "classes.html");
    CHECK(page.ends_with("</html>\n"));
    CHECK(!article(page, "surface-conductor").empty());
    CHECK(std::filesystem::is_empty(program.folder / "tmp"));
}
