// The command line: what it understands, and one line for what it does not.
#include "host/cli/cli.h"

#include <doctest/doctest.h>

#include <vector>

#include "host/error.h"

using namespace etendue;

namespace {

CommandLine parse(std::vector<const char*> words) {
    words.insert(words.begin(), "etendue");
    return parse_command_line(int(words.size()), words.data());
}

std::string complaint(std::vector<const char*> words) {
    try {
        parse(std::move(words));
    } catch (const Error& e) {
        CHECK(e.code == ExitCode::bad_input);
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
        return e.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("a view without options refines for ever, from a metered exposure; with them it is as they say") {
    auto options = std::get<ViewOptions>(parse({"view", "models/box.glb"}));
    CHECK(options.scene == "models/box.glb");
    CHECK(!options.passes);
    CHECK(!options.exposure);
    CHECK(!options.size);
    CHECK(options.curve == ToneCurve::srgb);
    options =
        std::get<ViewOptions>(parse({"view", "a.gltf", "--exposure", "-2.5", "--tone-curve", "agx",
                                     "--passes", "7", "--size", "640x480", "--algorithm", "bidirectional"}));
    CHECK(options.exposure == -2.5);
    CHECK(options.curve == ToneCurve::agx);
    CHECK(options.passes == 7);
    CHECK(options.size->width == 640);
    CHECK(options.algorithm == Algorithm::bidirectional);
    for (const char* bad : {"", "-", "x", "1e9", "nan", "1 2"}) {
        CAPTURE(bad);
        CHECK(complaint({"view", "a.gltf", "--exposure", bad}).starts_with("--exposure"));
    }
    CHECK(complaint({"view", "a.gltf", "--tone-curve", "film"}).find("agx") != std::string::npos);
    CHECK(complaint({"view", "a.gltf", "--output", "a.exr"}).find("--output") != std::string::npos);
}

TEST_CASE("a render without options runs 64 passes into the scene's name in the current folder") {
    auto options = std::get<RenderOptions>(parse({"render", "models/box.glb"}));
    CHECK(options.scene == "models/box.glb");
    CHECK(options.output == "box.exr");
    CHECK(options.passes == 64);
    CHECK(!options.seconds);
    CHECK(!options.error);
    CHECK(options.command_line == "etendue render models/box.glb");
}

TEST_CASE("every option of render is understood") {
    auto o = std::get<RenderOptions>(
        parse({"render",         "a.gltf",  "-o",          "b c.exr",    "--error",      "1e-2",
               "--size",         "640x480", "--receiver",  "left",       "--seed",       "9",
               "--environment",  "sky.hdr", "--algorithm", "backward",   "--color",      "rgb",
               "--polarization", "off",     "--device",    "1",          "--checkpoint", "c",
               "--resume",       "r",       "--stats",     "s.json",     "--shaders",    "dir",
               "--aovs",         "--quiet", "--sampler",   "independent"}));
    CHECK(o.output == "b c.exr");
    CHECK(o.error == 1e-2);
    CHECK(!o.passes);
    CHECK(o.size->width == 640);
    CHECK(o.size->height == 480);
    CHECK(o.receiver == "left");
    CHECK(o.seed == 9);
    CHECK(o.environment == "sky.hdr");
    CHECK(o.algorithm == Algorithm::backward);
    CHECK(o.color == ColorMode::rgb);
    CHECK(o.samples == SampleSequence::independent);
    CHECK(o.polarization == PolarizationMode::off);
    CHECK(o.device == "1");
    CHECK(o.checkpoint == "c");
    CHECK(o.resume == "r");
    CHECK(o.stats == "s.json");
    CHECK(o.shaders == "dir");
    CHECK(o.aovs);
    CHECK(o.quiet);
    CHECK(o.command_line.starts_with("etendue render a.gltf -o 'b c.exr' --error"));
}

TEST_CASE("forward paths have an algorithm and a memory of their own") {
    auto usual = std::get<RenderOptions>(parse({"render", "a.gltf"}));
    CHECK(usual.algorithm == Algorithm::automatic);
    CHECK(usual.vertex_bytes == uint64_t(256) << 20);
    auto o = std::get<RenderOptions>(
        parse({"render", "a.gltf", "--algorithm", "bidirectional", "--vertex-memory", "4096"}));
    CHECK(o.algorithm == Algorithm::bidirectional);
    CHECK(o.vertex_bytes == uint64_t(4) << 30);
}

TEST_CASE("passes, time and error exclude each other") {
    CHECK(complaint({"render", "a.gltf", "--passes", "1", "--time", "1"}) ==
          "--passes excludes --time (see etendue render --help)");
    CHECK(complaint({"render", "a.gltf", "--time", "1", "--error", "1"}) != "no error");
}

TEST_CASE("numbers that are none, out of range or not finite are refused") {
    for (const char* passes : {"0", "-3", "1.5", "0x10", "nan", "1e3", "", "99999999999999999999"})
        CHECK(complaint({"render", "a.gltf", "--passes", passes}) != "no error");
    for (const char* seconds : {"0", "-1", "nan", "inf", "1s"})
        CHECK(complaint({"render", "a.gltf", "--time", seconds}) != "no error");
    for (const char* mebibytes : {"0", "-1", "1.5", "64M", "99999999"})
        CHECK(complaint({"render", "a.gltf", "--vertex-memory", mebibytes}) != "no error");
    for (const char* bins : {"0", "-1", "1.5", "471", "many"})
        CHECK(complaint({"render", "a.gltf", "--spectral-bins", bins}) != "no error");
    for (const char* size : {"640", "0x480", "640x", "x480", "640x480x3", "-4x4", "70000x4"})
        CHECK(complaint({"render", "a.gltf", "--size", size}) != "no error");
    for (const char* limit : {"0", "nan", "abc"})
        CHECK(complaint({"compare", "a", "b", "--max-relmse", limit}) != "no error");
}

TEST_CASE("wrong usage is one line that says what is allowed") {
    CHECK(complaint({}) ==
          "no command given; one of: render, measure, merge, view, rays, compare, bench, inspect, lens, "
          "classes, "
          "devices "
          "(see etendue --help)");
    CHECK(complaint({"paint"}).starts_with("no command 'paint'; one of: render,"));
    CHECK(complaint({"render"}) == "SCENE is required (see etendue render --help)");
    CHECK(complaint({"render", ""}) == "SCENE is empty (see etendue render --help)");
    CHECK(complaint({"render", "a.gltf", "--algorithm", "sideways"}) ==
          "--algorithm sideways: not available; allowed: auto, backward, forward, bidirectional");
    CHECK(complaint({"render", "a.gltf", "--spectral-bins", "4", "--color", "rgb"}) ==
          "--spectral-bins: goes with --color spectral or auto, not with rgb");
    CHECK(complaint({"render", "a.gltf", "--sampler", "halton"}) ==
          "--sampler halton: not available; allowed: sobol, independent");
    CHECK(complaint({"render", "a.gltf", "-o", "a.jpg"}).ends_with("the name must end in .exr"));
    CHECK(complaint({"render", "a.gltf", "--passes"}) ==
          "--passes: value is missing (see etendue render --help)");
    CHECK(complaint({"render", "a.gltf", "--bogus"}) ==
          "The following argument was not expected: --bogus (see etendue render --help)");
    CHECK(complaint({"compare", "a.exr"}) != "no error");
    CHECK(complaint({"bench", "a.gltf"}) == "--output is required (see etendue bench --help)");
    CHECK(complaint({"bench", "a.gltf", "-o", "d", "--algorithms", "auto,auto"}) ==
          "--algorithms: auto is named twice");
    CHECK(complaint({"bench", "a.gltf", "-o", "d", "--algorithms", "auto,"}) ==
          "--algorithms : not available; allowed: auto, backward, forward, bidirectional");
    CHECK(complaint({"bench", "a.gltf", "b.gltf", "-o", "d", "--reference", "r.exr"}) ==
          "--reference: goes with one scene, not with 2");
    CHECK(complaint({"bench", "a.gltf", "-o", "d", "--reference-relmse", "1e-4"}) ==
          "--reference-relmse: goes with --reference");
    CHECK(complaint({"devices", "extra"}) != "no error");
}

TEST_CASE("help and version are answers, not errors") {
    CHECK(std::get<TextAnswer>(parse({"--version"})).text.starts_with("etendue "));
    CHECK(std::get<TextAnswer>(parse({"--help"})).text.find("compare") != std::string::npos);
    CHECK(std::get<TextAnswer>(parse({"render", "--help"})).text.find("Usage: etendue render") !=
          std::string::npos);
}

TEST_CASE("the other commands are understood") {
    CHECK(std::get<CompareOptions>(parse({"compare", "a", "b", "--max-relmse", "1e-3"})).max_relmse == 1e-3);
    const auto bench = std::get<BenchOptions>(
        parse({"bench", "a.gltf", "b.gltf", "-o", "dir", "--algorithms", "auto,forward", "--time", "2.5",
               "--size", "8x4", "--seed", "3", "--vertex-memory", "16"}));
    CHECK(bench.scenes == std::vector<std::filesystem::path>{"a.gltf", "b.gltf"});
    CHECK(bench.output == "dir");
    CHECK(bench.algorithms == std::vector<Algorithm>{Algorithm::automatic, Algorithm::forward});
    CHECK(bench.seconds == 2.5);
    CHECK(bench.size->height == 4);
    CHECK(bench.seed == 3);
    CHECK(bench.vertex_bytes == 16 << 20);
    CHECK(std::get<BenchOptions>(parse({"bench", "-o", "dir"})).algorithms.size() == 4);
    CHECK(std::get<InspectOptions>(parse({"inspect", "a.gltf", "--device", "llvmpipe"})).device ==
          "llvmpipe");
    CHECK(std::get<ClassesOptions>(parse({"classes", "sphere"})).name == "sphere");
    CHECK(std::holds_alternative<DevicesOptions>(parse({"devices"})));
}
