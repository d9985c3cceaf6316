// --algorithm auto while passes go on (host/commands/choose_meanwhile.h): what is chosen, when, and what the
// user is told. Scene caustic_box: backward rays alone miss its caustic, so that a pilot always ends with
// bidirectional.
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

const std::string caustic_box = source_path("scenes/caustic_box.gltf");

nlohmann::json stats_of(const Executable& program, const Run& run) {
    REQUIRE_MESSAGE(run.code == 0, run.err);
    return nlohmann::json::parse(read_text(program.folder / "stats.json"));
}

// Of caustic_box, with statistics.
Run render(const Executable& program, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"render", caustic_box, "-o", "out.exr", "--stats", "stats.json"};
    words.insert(words.end(), more.begin(), more.end());
    return program.run(words);
}

bool says(const Run& run, const std::string& text) { return run.err.find(text) != std::string::npos; }

}  // namespace

TEST_CASE("render: where forward rays win, the passes that were asked for are theirs") {
    const Executable program;
    const Run run = render(program, {"--size", "96x96", "--passes", "256"});
    const auto stats = stats_of(program, run);
    CHECK(stats["algorithm"] == "bidirectional");
    CHECK(stats["passes"] == 256);
    CHECK(stats["forward_rays"].get<double>() >= 256 * 96 * 96 * 0.25);
    CHECK(stats["pilot_seconds"].get<double>() > 0);
    CHECK(says(run, "starting anew"));
}

TEST_CASE(
    "render: a pilot that would cost more than a tenth is left out, and a line says what that may cost") {
    const Executable program;
    const Run run = render(program, {"--size", "32x32", "--passes", "4"});
    const auto stats = stats_of(program, run);
    CHECK(stats["algorithm"] == "backward");
    CHECK(stats["passes"] == 4);
    CHECK(stats["pilot_seconds"] == 0);
    CHECK(says(run, "no pilot for so few passes"));
    CHECK(says(run, "--algorithm bidirectional"));
}

TEST_CASE("render: a pilot that is not done in time is given up") {
    const Executable program;
    const Run run = render(program, {"--size", "64x64", "--time", "0.02"});
    const auto stats = stats_of(program, run);
    CHECK(stats["algorithm"] == "backward");
    CHECK(says(run, "not done in time"));
}

TEST_CASE("render: a run that ended before its pilot had told chooses when it goes on") {
    const Executable program;
    const std::vector<std::string> words = {"render", caustic_box, "-o",       "out.exr",
                                            "--size", "96x96",     "--passes", "512"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), words.begin(), words.end());
        return more;
    };
    // Ended at the first line of progress: a pilot takes longer.
    const pid_t child = program.start(with({"--checkpoint", "c.etd"}));
    for (int i = 0; i < 400 && read_text(program.folder / "stderr.txt").empty(); ++i) usleep(5000);
    kill(child, SIGINT);
    const Run stopped = program.finish(child);
    REQUIRE(std::filesystem::exists(program.folder / "c.etd"));
    const Run run = program.run(with({"--resume", "c.etd", "--stats", "stats.json"}));
    const auto stats = stats_of(program, run);
    CHECK(stats["algorithm"] == "bidirectional");
    CHECK(stats["passes"] == 512);
}

TEST_CASE("render: an error that backward rays reach at once is asked of what is chosen") {
    const Executable program;
    const Run run = render(program, {"--size", "64x64", "--error", "0.3"});
    const auto stats = stats_of(program, run);
    CHECK(stats["algorithm"] == "bidirectional");
    CHECK(stats["passes"] > 1);
    CHECK(stats["estimated_relative_error"] < 0.3);
}

TEST_CASE("render: a named algorithm runs no pilot and says nothing") {
    const Executable program;
    const Run run = render(program, {"--size", "32x32", "--passes", "4", "--algorithm", "backward"});
    CHECK(stats_of(program, run)["algorithm_reason"] == "asked for");
    CHECK(!says(run, "pilot"));
}
