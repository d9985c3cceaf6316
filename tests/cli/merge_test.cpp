// One render by several processes: ranges of passes, parts, and what becomes of them where workers die.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/image/exr.h"
#include "tests/cli/program.h"

using namespace etendue;

namespace {

bool says(const Run& run, const std::string& text) {
    return (run.out + run.err).find(text) != std::string::npos;
}

// A process on the scene of `folder`, with a working folder of its own.
struct Worker {
    const TemporaryFolder& shared;
    Executable program;
    std::vector<std::string> words(const std::string& passes, const std::string& part,
                                   std::vector<std::string> more = {}) const {
        std::vector<std::string> all = {"render",
                                        (shared / "s.gltf").string(),
                                        "--size",
                                        "24x12",
                                        "--algorithm",
                                        "backward",
                                        "--passes",
                                        passes,
                                        "-o",
                                        "out.exr",
                                        "--aovs",
                                        "--checkpoint",
                                        (shared / part).string()};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    void render(const std::string& passes, const std::string& part,
                std::vector<std::string> more = {}) const {
        const Run run = program.run(words(passes, part, more));
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
    }
};

}  // namespace

TEST_CASE(
    "workers that die, come late or do things twice, and a part cut short: the single run's image in the "
    "end") {
    Executable program;
    const TemporaryFolder& shared = program.folder;
    write_text(shared / "s.gltf", small_scene());
    Worker first{shared, {}}, second{shared, {}}, third{shared, {}};
    const auto merge = [&](std::vector<std::string> more) {
        more.insert(more.begin(), "merge");
        more.insert(more.end(), {"-o", "merged.exr", "--aovs"});
        return program.run(more);
    };

    // Three at once. One is killed in the middle.
    const pid_t a = first.program.start(first.words("0:7", "a.etd")),
                b = second.program.start(second.words("7:1000000", "b.etd")),
                c = third.program.start(third.words("12:21", "c.etd"));
    for (int i = 0;
         i < 1200 && read_text(second.program.folder / "stderr.txt").find("pass") == std::string::npos; ++i)
        usleep(50000);
    kill(b, SIGKILL);
    CHECK(second.program.finish(b).code == 128 + SIGKILL);
    REQUIRE(first.program.finish(a).code == 0);
    REQUIRE(third.program.finish(c).code == 0);
    CHECK(!std::filesystem::exists(shared / "b.etd"));
    Run run = merge({"c.etd", "a.etd"});
    CHECK(run.code == 2);
    CHECK(run.error_lines() == 1);
    CHECK(says(run, "passes 7:12 are missing"));
    CHECK(!std::filesystem::exists(shared / "merged.exr"));

    // A late one does what is missing, and a range is done twice.
    second.render("7:12", "b.etd");
    second.render("0:7", "again.etd");
    run = merge({"c.etd", "again.etd", "a.etd", "b.etd"});
    CHECK(run.code == 2);
    CHECK(says(run, "a.etd: has passes 0:7, and so has again.etd"));

    // A part is cut short on disk.
    std::filesystem::resize_file(shared / "c.etd", std::filesystem::file_size(shared / "c.etd") - 100);
    run = merge({"a.etd", "b.etd", "c.etd"});
    CHECK(run.code == 2);
    CHECK(says(run, "c.etd: damaged"));
    run = merge({"a.etd", "c.etd", "b.etd", "--partial", "--passes", "21"});
    CHECK(run.code == 0);
    CHECK(says(run, "left out: c.etd: damaged"));
    CHECK(says(run, "passes 12:21 are missing"));
    CHECK(std::get<double>(read_exr(shared / "merged.exr").attributes.at("passes")) == 12);
    CHECK(std::get<std::string>(read_exr(shared / "merged.exr").attributes.at("pixelUnit")) == "cd/m²");

    third.render("12:21", "c.etd");
    run = merge({"c.etd", "a.etd", "b.etd", "--checkpoint", "all.etd", "--stats", "stats.json"});
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(says(run, "passes 0:21 of 3 parts: relative error"));
    first.render("21", "single.etd");
    const Image single = read_exr(first.program.folder / "out.exr"), merged = read_exr(shared / "merged.exr");
    CHECK(merged.channels == single.channels);  // errors, albedo, normals and depth among them
    CHECK(merged.values == single.values);
    const auto stats = nlohmann::json::parse(read_text(shared / "stats.json"));
    CHECK(stats["pass_count"] == 21);
    CHECK(stats["estimated_relative_error"].get<double>() > 0);

    // A merge of merged parts; and the whole may be gone on from.
    REQUIRE(program.run({"merge", "c.etd", "b.etd", "--passes", "7:21", "--checkpoint", "bc.etd"}).code == 0);
    REQUIRE(merge({"bc.etd", "a.etd"}).code == 0);
    CHECK(read_exr(shared / "merged.exr").values == single.values);
    first.render("30", "more.etd", {"--resume", (shared / "all.etd").string()});
    const Image resumed = read_exr(first.program.folder / "out.exr");
    first.render("30", "single.etd");
    CHECK(read_exr(first.program.folder / "out.exr").values == resumed.values);
}

TEST_CASE("merge names what parts of different renders differ by") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    write_text(program.folder / "other.gltf", small_scene(R"({"class": "lambertian", "reflectance": 0.2})"));
    const auto part = [&](const std::string& name, std::vector<std::string> more) {
        const std::string scene = more.front();
        more.erase(more.begin());
        more.insert(more.begin(), {"render", scene, "-o", "out.exr", "--checkpoint", name});
        const Run run = program.run(more);
        CAPTURE(run.err);
        REQUIRE(run.code == 0);
    };
    part("a", {"s.gltf", "--passes", "0:1", "--size", "8x4", "--algorithm", "backward"});
    const std::vector<std::pair<std::string, std::vector<std::string>>> others = {
        {"its scene is", {"other.gltf", "--passes", "1:2", "--size", "8x4", "--algorithm", "backward"}},
        {"its size is \"16x4\", in a \"8x4\"",
         {"s.gltf", "--passes", "1:2", "--size", "16x4", "--algorithm", "backward"}},
        {"its seed is 7, in a 0",
         {"s.gltf", "--passes", "1:2", "--size", "8x4", "--algorithm", "backward", "--seed", "7"}},
        {"its algorithm is \"forward\", in a \"backward\"",
         {"s.gltf", "--passes", "1:2", "--size", "8x4", "--algorithm", "forward"}}};
    for (const auto& [wanted, words] : others) {
        part("b", words);
        const Run run = program.run({"merge", "a", "b", "-o", "merged.exr"});
        CAPTURE(run.err);
        CHECK(run.code == 2);
        CHECK(run.error_lines() == 1);
        CHECK(says(run, wanted));
        CHECK(!std::filesystem::exists(program.folder / "merged.exr"));
    }
}

TEST_CASE("what auto chooses can be told to all machines, and a range wants it") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const Run run = program.run({"inspect", "s.gltf", "--json"});
    REQUIRE(run.code == 0);
    const auto json = nlohmann::json::parse(run.out);
    CHECK(json["algorithm"] == "backward");
    CHECK(json["arguments"] == std::vector<std::string>{"--algorithm", "backward"});
    const Run refused = program.run({"render", "s.gltf", "--passes", "0:4"});
    CHECK(refused.code == 2);
    CHECK(says(refused, "named --algorithm"));
    for (const char* range : {"4:4", "5:4", "1:", ":4", "1:2:3", "-1:4"})
        CHECK(program.run({"render", "s.gltf", "--algorithm", "backward", "--passes", range}).code == 2);
    CHECK(program.run({"render", "s.gltf", "--forward-paths", "2"}).code == 2);
    CHECK(program.run({"merge", "a"}).code == 2);
}
