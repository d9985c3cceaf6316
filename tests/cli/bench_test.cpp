// The bench on a scene that takes milliseconds: its files, its folder, and its interruption.
#include "host/bench/results.h"
#include "host/image/exr.h"
#include "tests/cli/program.h"

using namespace etendue;

namespace {

const std::vector<std::string> bench = {"bench", "s.gltf", "-o", "out", "--size", "16x8", "--time", "0.2"};

std::vector<std::string> with(std::vector<std::string> more) {
    std::vector<std::string> words = bench;
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

bool has_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

}  // namespace

TEST_CASE("a bench leaves points, a page and images, and can draw its page again") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const Run run = program.run(with({"--algorithms", "backward,auto"}));
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.find("backward") != std::string::npos);
    CHECK(run.out.find("slope by passes") != std::string::npos);
    const BenchResults results = read_results(program.folder / "out");
    REQUIRE(results.scenes.size() == 1);
    CHECK(results.scenes[0].name == "s");
    CHECK(results.scenes[0].reference_relmse > 0);
    const auto all = curves(results, results.scenes[0]);
    REQUIRE(all.size() == 2);
    CHECK(all[0].algorithm == "backward");
    CHECK(all[1].algorithm == "auto");
    for (const BenchCurve& curve : all) {
        REQUIRE(curve.levels.size() >= 3);
        CHECK(curve.levels.back().relmse < 0.5 * curve.levels.front().relmse);
        REQUIRE(curve.by_passes);
        CHECK(curve.by_passes->slope < -0.7);
        CHECK(std::abs(curve.bias.value) < 0.02);
    }
    double spent = 0;
    for (const BenchPoint& p : results.points) {
        CHECK((p.passes & (p.passes - 1)) == 0);
        CHECK(rays(p) > 0);
        spent += p.seconds;
    }
    CHECK(spent < 2);  // two algorithms of 0.2 s; machines stutter
    for (const char* name : {"s.backward.png", "s.auto.png", "s.reference.png"})
        CHECK(std::filesystem::exists(program.folder / "out" / name));
    CHECK(read_exr(program.folder / "out/s.reference.exr").width == 16);
    std::string page = read_text(program.folder / "out/index.html");
    CHECK(page.find("data:image/png;base64,") != std::string::npos);
    CHECK((page.find("<svg") != std::string::npos) == has_gnuplot());

    // Points of others join the page.
    const std::string csv = read_text(program.folder / "out/bench.csv");
    write_text(program.folder / "out/bench.csv", csv + "s,another renderer,0,4,0.5,0,0,0,0.01,0.0101,0\n");
    CHECK(program.run({"bench", "-o", "out", "-q"}).code == 0);
    page = read_text(program.folder / "out/index.html");
    CHECK(page.find("another renderer") != std::string::npos);

    // A folder of an earlier bench is used again, without gnuplot too.
    std::filesystem::rename(program.folder / "out/s.reference.exr", program.folder / "r.exr");
    program.environment = {{"PATH", "/nonexistent"}};
    const Run given = program.run(with({"--algorithms", "backward", "--reference", "r.exr", "--seed", "9"}));
    CAPTURE(given.err);
    CHECK(given.code == 0);
    CHECK(given.err.find("gnuplot is not installed") != std::string::npos);
    CHECK(read_results(program.folder / "out").points[0].seed == 9);
    CHECK(read_results(program.folder / "out").scenes[0].reference == "r.exr");
    CHECK(read_text(program.folder / "out/index.html").find("<svg") == std::string::npos);
}

TEST_CASE("a reference in another unit is noticed") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    REQUIRE(
        program.run({"render", "s.gltf", "-o", "r.exr", "--size", "16x8", "--passes", "256", "-q"}).code ==
        0);
    for (const float scale : {1.0f, 1 / 683.0f}) {
        Image reference = read_exr(program.folder / "r.exr");
        for (float& value : reference.values) value *= scale;
        write_exr(program.folder / "r.exr", reference);
        const Run run = program.run(with({"--reference", "r.exr", "--algorithms", "backward"}));
        CAPTURE(run.err);
        CHECK(run.code == 0);
        CHECK((run.err.find("another unit") != std::string::npos) == (scale != 1));
    }
}

TEST_CASE("a bench writes nothing over, and bad input is one line") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    write_text(program.folder / "file", "precious");
    std::filesystem::create_directory(program.folder / "full");
    write_text(program.folder / "full/thesis.txt", "precious");
    REQUIRE(program.run({"render", "s.gltf", "-o", "r.exr", "--size", "8x8", "--passes", "1", "-q"}).code ==
            0);
    struct {
        std::vector<std::string> words;
        const char* named;
    } const inputs[] = {
        {{"bench", "s.gltf", "-o", "full"}, "full"},
        {{"bench", "s.gltf", "-o", "file"}, "file"},
        {{"bench", "-o", "full"}, "bench.csv"},
        {{"bench", "nothing.gltf", "-o", "new"}, "nothing.gltf"},
        {{"bench", "s.gltf", "-o", "new", "--receiver", "ear"}, "ear"},
        {with({"--reference", "none.exr"}), "none.exr"},
        {with({"--reference", "r.exr"}), "8 x 8"},
        {with({"--algorithms", "sideways"}), "sideways"},
    };
    for (const auto& input : inputs) {
        CAPTURE(input.named);
        const Run run = program.run(input.words);
        CHECK(run.code == 2);
        CHECK(run.err.find(input.named) != std::string::npos);
        CHECK(run.err.find("etendue: ") != std::string::npos);
        CHECK(run.out.empty());
    }
    CHECK(read_text(program.folder / "full/thesis.txt") == "precious");
    CHECK(read_text(program.folder / "file") == "precious");
    CHECK(!std::filesystem::exists(program.folder / "full/bench.csv"));
}

TEST_CASE("an interrupted bench writes the results so far and ends with 130") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    REQUIRE(program.run({"render", "s.gltf", "-o", "r.exr", "--size", "16x8", "--passes", "64", "-q"}).code ==
            0);
    const pid_t child = program.start({"bench", "s.gltf", "-o", "out", "--reference", "r.exr", "--time",
                                       "600", "--algorithms", "backward"});
    const auto csv = program.folder / "out/bench.csv";
    for (int i = 0; i < 1200 && !std::filesystem::exists(csv); ++i) usleep(100000);
    kill(child, SIGINT);
    const Run run = program.finish(child);
    CAPTURE(run.err);
    CHECK(run.code == 130);
    CHECK(!read_results(program.folder / "out").points.empty());
    CHECK(read_text(program.folder / "out/index.html").find("16 × 8") != std::string::npos);
}
