// etendue lens: what it prints, draws and refuses.
#include "tests/cli/program.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

const char* singlet = "title A <plano-convex> lens\nfields 0 5\n50 10 1.5 40\n0 93.33333 1 40\n";

void check_has(const std::string& text, const std::vector<std::string>& words) {
    for (const std::string& word : words) CHECK_MESSAGE(text.find(word) != std::string::npos, text);
}

}  // namespace

TEST_CASE("a lens is told with its figures") {
    const Executable program;
    const Run run = program.run({"lens", source_path("tests/host/lenses/own_dgauss_tronnier.txt")});
    CHECK(run.code == 0);
    CHECK(run.err.empty());
    check_has(run.out,
              {"focal length            100.7163\n", "back focal length       72.21181\n", "2.03015\n",
               "49.61021 across, 39.89297 behind", "53.07704 across, -35.54271 behind", "1.717000"});
}

TEST_CASE("a lens is drawn, and its rays are written") {
    const Executable program;
    write_text(program.folder / "a.txt", singlet);
    CHECK(program.run({"lens", "a.txt", "-o", "a.svg", "--rays", "5"}).code == 0);
    const std::string svg = read_text(program.folder / "a.svg");
    CHECK(svg.starts_with("<svg "));
    CHECK(svg.ends_with("</svg>\n"));
    check_has(svg, {"A &lt;plano-convex&gt; lens", "fill:#cfe3f2", "mm</text>", "5°"});
    size_t rays = 0;
    for (size_t at = 0; (at = svg.find("stroke-width:.7\"", at)) != svg.npos; ++at) ++rays;
    CHECK(rays == 10);

    CHECK(program.run({"lens", "a.txt", "-o", "a.csv", "--rays", "2"}).code == 0);
    const std::string csv = read_text(program.folder / "a.csv");
    CHECK(csv.starts_with("field,wavelength_nm,pupil_x,pupil_y,surface,x_mm"));
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 2 * 4 * 4);  // fields, rays, start and surfaces
}

TEST_CASE("what lens cannot do is one line") {
    const Executable program;
    write_text(program.folder / "a.txt", singlet);
    write_text(program.folder / "bad.zmx", "SURF 0\nSURF 1\n GLAS NOGLASS\nSURF 2\n");
    struct Case {
        std::vector<std::string> words, says;
    };
    for (const Case& c : {Case{{"lens"}, {"FILE is required"}},
                          {{"lens", "none.zmx"}, {"none.zmx"}},
                          {{"lens", "bad.zmx"}, {"bad.zmx: line 3", "NOGLASS"}},
                          {{"lens", "a.txt", "-o", "a.png"}, {"a.png", ".svg or .csv"}},
                          {{"lens", "a.txt", "-o", "none/a.svg"}, {"none/a.svg"}},
                          {{"lens", "a.txt", "--rays", "5"}, {"--rays", "--output"}},
                          {{"lens", "a.txt", "-o", "a.svg", "--rays", "0"}, {"--rays 0", "1 to 1000"}}}) {
        const Run run = program.run(c.words);
        CHECK(run.code == 2);
        CHECK_MESSAGE(run.error_lines() == 1, run.err);
        check_has(run.err, c.says);
    }
}
