// etendue rays: files of recorded paths.
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

using namespace etendue;

TEST_CASE("paths are written as JSON, as a table and as lines of glTF") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const std::vector<std::string> rays = {"rays", "s.gltf", "--paths", "200", "-o"};
    const auto with = [&](std::vector<std::string> more) {
        std::vector<std::string> words = rays;
        words.insert(words.end(), more.begin(), more.end());
        return program.run(words);
    };
    Run run = with({"r.json"});
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out == "200 of 200 paths\n");
    const auto json = nlohmann::json::parse(read_text(program.folder / "r.json"));
    CHECK(json["unit"] == "lm");
    REQUIRE(json["paths"].size() == 200);
    size_t vertices = 0, reflected = 0;
    for (const auto& path : json["paths"]) {
        CHECK(path["vertices"][0]["object"] == "environment");
        vertices += path["vertices"].size();
        for (const auto& v : path["vertices"])
            if (v["event"] == "reflected") {
                ++reflected;
                break;
            }
    }
    CHECK(reflected > 20);
    REQUIRE(with({"r.csv", "--events", "reflected"}).out == fmt::format("{} of 200 paths\n", reflected));
    const auto kept = [&](const char* option) {
        return std::atoi(with({"r.csv", option, "ball"}).out.c_str());  // the name of the node
    };
    CHECK(size_t(kept("--objects")) >= reflected);
    CHECK(kept("--objects") + kept("--without") == 200);
    REQUIRE(with({"r.csv"}).code == 0);
    const std::string table = read_text(program.folder / "r.csv");
    CHECK(table.starts_with("path,vertex,event,object,shape,x,y,z,arriving,leaving,wavelength,s1,s2,s3\n"));
    CHECK(size_t(std::count(table.begin(), table.end(), '\n')) == vertices + 1);
    REQUIRE(with({"r.glb"}).code == 0);
    const std::string lines = read_text(program.folder / "r.glb");
    uint32_t header[5];
    REQUIRE(lines.size() > sizeof header);
    std::memcpy(header, lines.data(), sizeof header);
    CHECK(header[0] == 0x46546C67);
    CHECK(header[2] == lines.size());
    const auto document = nlohmann::json::parse(lines.substr(20, header[3]));
    CHECK(document["accessors"][0]["count"] == 2 * (vertices - 200));  // both ends of every line
    CHECK(lines.size() == 28 + header[3] + document["buffers"][0]["byteLength"].get<size_t>());
}

TEST_CASE("what rays cannot do is one line") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const Run ending = program.run({"rays", "s.gltf", "-o", "r.txt"});
    CHECK(ending.code == 2);
    CHECK(ending.err == "etendue: --output r.txt: paths are written as .json, .csv or .glb\n");
    const Run event = program.run({"rays", "s.gltf", "-o", "r.csv", "--events", "shone"});
    CHECK(event.code == 2);
    CHECK(event.error_lines() == 1);
}
