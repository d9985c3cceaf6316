// The commands on good input: what they write, and with which exit code they end.
#include <nlohmann/json.hpp>

#include "host/image/exr.h"
#include "tests/cli/program.h"
#include "tests/support/class_file.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

const std::vector<std::string> render = {"render", "s.gltf", "-o",     "out.exr",
                                         "--size", "16x8",   "--seed", "7"};

std::vector<std::string> with(std::vector<std::string> more) {
    std::vector<std::string> words = render;
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

double number(const Image& image, const char* name) { return std::get<double>(image.attributes.at(name)); }
std::string text(const Image& image, const char* name) {
    return std::get<std::string>(image.attributes.at(name));
}
std::span<const float> channel(const Image& image, const char* name) {
    return plane(image, size_t(find_channel(image, name)));
}

}  // namespace

TEST_CASE("a render writes an image with its attributes, layers and statistics") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const Run run = program.run(with({"--passes", "8", "--aovs", "--stats", "stats.json"}));
    CAPTURE(run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.empty());
    // Progress into a file, not a terminal: plain lines without control characters.
    CHECK(run.err.find('\r') == std::string::npos);
    CHECK(run.err.find('\033') == std::string::npos);
    CHECK(!run.err.empty());

    const Image image = read_exr(program.folder / "out.exr");
    CHECK(image.width == 16);
    CHECK(image.height == 8);
    for (const char* name : {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y",
                             "normal.Z", "depth.Z", "error.R", "error.G", "error.B"}) {
        CAPTURE(name);
        REQUIRE(find_channel(image, name) >= 0);
    }
    // The pixel at the corner sees the environment; one in the middle the ball, 4 m away and facing the
    // camera.
    const size_t middle = 4 * 16 + 8;
    CHECK(channel(image, "R")[0] == doctest::Approx(1));
    // Of 8 samples of a soft environment: within a few errors, as the layer states them.
    CHECK(std::fabs(channel(image, "R")[middle] - 0.5) < 4 * channel(image, "error.R")[middle]);
    CHECK(channel(image, "error.R")[middle] < 0.1);
    CHECK(channel(image, "albedo.G")[middle] == doctest::Approx(0.5).epsilon(0.01));
    CHECK(channel(image, "normal.Z")[middle] > 0.8);
    CHECK(channel(image, "depth.Z")[middle] == doctest::Approx(4).epsilon(0.1));
    CHECK(text(image, "scene") == "s.gltf");
    CHECK(text(image, "command").starts_with("etendue render s.gltf -o out.exr"));
    CHECK(number(image, "seed") == 7);
    CHECK(number(image, "passes") == 8);
    CHECK(number(image, "rays") >= 8 * 16 * 8);
    CHECK(number(image, "seconds") > 0);
    for (const char* name : {"device", "driver", "version"}) CHECK(!text(image, name).empty());

    const auto stats = nlohmann::json::parse(read_text(program.folder / "stats.json"));
    for (const char* member : {"passes", "forward_rays", "backward_rays", "seconds", "rays_per_second",
                               "kernels", "estimated_relative_error", "compiled_kernels", "compile_seconds",
                               "device", "driver", "peak_device_memory_bytes", "non_finite_samples"}) {
        CAPTURE(member);
        CHECK(stats.contains(member));
    }
    CHECK(stats["passes"] == 8);
    CHECK(stats["non_finite_samples"] == 0);
    CHECK(stats["backward_rays"].get<double>() >= 8 * 16 * 8);
    CHECK(!stats["compiled_kernels"].empty());
    for (const auto& [name, kernel] : stats["kernels"].items()) {
        CAPTURE(name);
        CHECK(kernel.contains("seconds"));
        CHECK(kernel.contains("rays_per_second"));
    }
    // The balance adds up. Half of what meets the ball is absorbed, once or more often.
    const auto& balance = stats.at("power_balance");
    double parts = balance["absorbed"].get<double>() + balance["received"].get<double>();
    for (const auto& [cause, part] : balance["lost"].items()) parts += part.get<double>();
    CHECK(parts == doctest::Approx(balance["emitted"].get<double>()));
    CHECK(balance["absorbed"].get<double>() > 0.05);
    CHECK(balance["absorbed"].get<double>() < 0.5);
}

TEST_CASE("without --aovs an image has its colours only, and --quiet says nothing") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const Run run = program.run(with({"--passes", "2", "--quiet"}));
    CHECK(run.code == 0);
    CHECK(run.err.empty());
    CHECK(run.out.empty());
    CHECK(read_exr(program.folder / "out.exr").channels.size() == 3);
}

TEST_CASE("a resumed render is bit for bit the uninterrupted one") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    REQUIRE(program.run(with({"--passes", "13"})).code == 0);
    const Image whole = read_exr(program.folder / "out.exr");
    REQUIRE(program.run(with({"--passes", "5", "--checkpoint", "state"})).code == 0);
    CHECK(read_exr(program.folder / "out.exr").values != whole.values);
    const Run resumed = program.run(with({"--passes", "13", "--resume", "state"}));
    CAPTURE(resumed.err);
    REQUIRE(resumed.code == 0);
    CHECK(read_exr(program.folder / "out.exr").values == whole.values);

    // Another seed or another scene is not the same render, so not to be gone on with.
    const Run refused = program.run(with({"--passes", "13", "--resume", "state", "--seed", "8"}));
    CHECK(refused.code == 2);
    CHECK(refused.error_lines() == 1);
    write_text(program.folder / "s.gltf", small_scene(R"({"class": "lambertian", "reflectance": 0.25})"));
    CHECK(program.run(with({"--passes", "13", "--resume", "state"})).code == 2);
    CHECK(read_exr(program.folder / "out.exr").values == whole.values);
}

TEST_CASE("an interrupted render writes the image so far and ends with 130") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    for (const int signal : {SIGINT, SIGTERM}) {
        std::filesystem::remove(program.folder / "out.exr");
        write_text(program.folder / "stderr.txt", "");
        const pid_t child = program.start(with({"--time", "600"}));
        // Its first line of progress says that it renders.
        for (int i = 0;
             i < 1200 && read_text(program.folder / "stderr.txt").find("pass") == std::string::npos; ++i)
            usleep(100000);
        kill(child, signal);
        const Run run = program.finish(child);
        CAPTURE(run.err);
        CHECK(run.code == 130);
        const Image image = read_exr(program.folder / "out.exr");
        CHECK(number(image, "passes") >= 1);
        CHECK(channel(image, "R")[0] == doctest::Approx(1));
    }
}

TEST_CASE("a render to an error stops when it is reached") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    CHECK(program.run(with({"--error", "0.02", "--stats", "stats.json"})).code == 0);
    const auto stats = nlohmann::json::parse(read_text(program.folder / "stats.json"));
    CHECK(stats["estimated_relative_error"].get<double>() <= 0.02);
}

TEST_CASE("compare ends with 1 beyond its limit") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    REQUIRE(program.run(with({"--passes", "4"})).code == 0);
    std::filesystem::rename(program.folder / "out.exr", program.folder / "a.exr");
    REQUIRE(program.run(with({"--passes", "4", "--seed", "8"})).code == 0);
    const Run same = program.run({"compare", "a.exr", "a.exr", "--max-relmse", "1e-9"});
    CHECK(same.code == 0);
    CHECK(same.out.find("relMSE    0\n") != std::string::npos);
    const Run other = program.run({"compare", "a.exr", "out.exr", "--max-relmse", "1e-9"});
    CHECK(other.code == 1);
    CHECK(other.err.empty());
    CHECK(program.run({"compare", "a.exr", "out.exr"}).code == 0);
    REQUIRE(program.run({"render", "s.gltf", "-o", "small.exr", "--size", "8x8", "--passes", "1"}).code == 0);
    const Run sizes = program.run({"compare", "a.exr", "small.exr"});
    CHECK(sizes.code == 2);
    CHECK(sizes.error_lines() == 1);
}

TEST_CASE("inspect tells flux, peak and opening of a photometric file, and what was corrected") {
    Executable program;
    write_text(program.folder / "lamp.ies",
               "IES:LM-63-2019\nTILT=NONE\n1 500 1 2 4 1 2 -0.2 -0.2 0\n1 1 9\n0 180\n0 90 180 270\n1 1 1 1 "
               "1 1 1 1\n");
    write_text(program.folder / "s.gltf",
               R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "nodes": [
{"extensions": {"ETD_optics": {"light": {"class": "ies", "file": "lamp.ies"}}}}, {"extensions": {"ETD_optics": {"receiver":
{"class": "illuminance", "size": [1, 1]}}}}], "scenes": [{"nodes": [0, 1]}], "scene": 0})");
    const Run inspect = program.run({"inspect", "s.gltf"});
    CAPTURE(inspect.err);
    CHECK(inspect.code == 0);
    for (const char* said : {"lamp.ies: 12.5664 lm, peak 1 cd, opening disk of diameter 0.2 m",
                             "lights     1 (0 at infinity), 12.5664 lm"})
        CHECK_MESSAGE(inspect.out.find(said) != std::string::npos, inspect.out);
    for (const char* said :
         {"lamp.ies: the horizontal angles end at 270°", "12.5664 lm, its lamps have 500 lm"})
        CHECK(inspect.err.find(said) != std::string::npos);
}

TEST_CASE("inspect tells what a ray file holds; backward rays alone say that they leave it out") {
    Executable program;
    write_text(program.folder / "led.ray",
               read_text(source_path("tests/host/rays/own_odd_unnormalised.tm25ray")));
    write_text(program.folder / "s.gltf",
               R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ETD_optics"], "nodes": [
{"name": "LED", "extensions": {"ETD_optics": {"light": {"class": "rays", "file": "led.ray"}}}}, {"translation": [0, 0, 1],
"rotation": [1, 0, 0, 0], "extensions": {"ETD_optics": {"receiver": {"class": "illuminance", "size": [1, 1], "resolution": [2, 2]}}}}],
"scenes": [{"nodes": [0, 1]}], "scene": 0})");
    const Run inspect = program.run({"inspect", "s.gltf"});
    CAPTURE(inspect.err);
    CHECK(inspect.code == 0);
    for (const char* said :
         {"led.ray: TM-25, 1 rays, 1 W, from (0, 0, 0) to (0, 0, 0) mm",
          "algorithm  bidirectional, fused schedule: forward rays alone bring the light of LED"})
        CHECK_MESSAGE(inspect.out.find(said) != std::string::npos, inspect.out);
    for (const char* said :
         {"led.ray: 1 of 1 directions were no unit vectors", "led.ray: tells watts and no wavelengths"})
        CHECK(inspect.err.find(said) != std::string::npos);
    const auto render = [&](const std::string& algorithm) {
        return program.run({"render", "s.gltf", "-o", "out.exr", "--passes", "2", "--algorithm", algorithm});
    };
    const std::string left_out = "backward rays find no light of LED: it is left out";
    CHECK(render("backward").err.find(left_out) != std::string::npos);
    CHECK(render("auto").err.find(left_out) == std::string::npos);
}

TEST_CASE("inspect, classes and devices tell what there is") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const Run inspect = program.run({"inspect", "s.gltf"});
    CAPTURE(inspect.err);
    CHECK(inspect.code == 0);
    for (const char* word : {"sphere", "lambertian", "constant", "trace_paths", "eye"}) {
        CAPTURE(word);
        CHECK(inspect.out.find(word) != std::string::npos);
    }
    // A named algorithm takes no pilot: the kernels are its own.
    const auto inspected = [&](const std::string& algorithm) {
        return program.run({"inspect", "s.gltf", "--algorithm", algorithm}).out;
    };
    CHECK(inspected("backward").find("backward, fused schedule: asked for") != std::string::npos);
    CHECK(inspected("backward").find("sort_vertices") == std::string::npos);
    CHECK(inspected("bidirectional").find("sort_vertices") != std::string::npos);
    CHECK(program.run({"inspect", "s.gltf", "--algorithm", "backward", "--json"}).code == 2);
    const Run list = program.run({"classes"});
    CHECK(list.code == 0);
    CHECK(list.out.find("that reflects and refracts (Walter et al. 2007), sampled by visible normals.\n") !=
          std::string::npos);
    const Run classes = program.run({"classes", "conductor"});
    CHECK(classes.code == 0);
    for (const char* word : {"alpha", "[0, 1]", "reflectance", "multiscatter"})
        CHECK(classes.out.find(word) != std::string::npos);
    const Run devices = program.run({"devices"});
    CHECK(devices.code == 0);
    CHECK(devices.out.find("(default)") != std::string::npos);
    CHECK(program.run({"--version"}).out.starts_with("etendue "));
    CHECK(program.run({"render", "--help"}).code == 0);
}

TEST_CASE("a spectral image has a channel a bin, and is resumed with them") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    REQUIRE(program.run(with({"--passes", "12", "--spectral-bins", "4"})).code == 0);
    const Image whole = read_exr(program.folder / "out.exr");
    CHECK(text(whole, "spectralLayoutVersion") == "1.0");
    // Light of a colour lies on D65: the bins that hold red, green and blue are lit.
    for (const char* name : {"S0.418,750000nm", "S0.536,250000nm", "S0.653,750000nm"}) {
        REQUIRE(find_channel(whole, name) >= 0);
        CHECK(channel(whole, name)[0] > 0);
    }
    REQUIRE(program.run(with({"--passes", "5", "--spectral-bins", "4", "--checkpoint", "state"})).code == 0);
    REQUIRE(program.run(with({"--passes", "12", "--spectral-bins", "4", "--resume", "state"})).code == 0);
    CHECK(read_exr(program.folder / "out.exr").values == whole.values);
    CHECK(program.run(with({"--passes", "12", "--color", "spectral", "--resume", "state"})).code == 2);
}

TEST_CASE("a scene's own class files run where they are allowed") {
    Executable program;
    std::filesystem::create_directory(program.folder / "scene");
    write_text(program.folder / "scene/chalk.glsl", chalk_class());
    nlohmann::json scene = nlohmann::json::parse(small_scene(R"({"class": "chalk"})"));
    scene["extensions"]["ETD_optics"]["class_files"] = {{{"interface", "surface"}, {"file", "chalk.glsl"}}};
    write_text(program.folder / "scene/s.gltf", scene.dump());
    const Run run = program.run({"render", "scene/s.gltf", "-o", "out.exr", "--passes", "1", "--size", "4x4",
                                 "-q", "--allow-class-files"});
    CHECK_MESSAGE(run.code == 0, run.err);
    CHECK(std::filesystem::exists(program.folder / "out.exr"));
}

TEST_CASE("an output that cannot be written costs no other one") {
    Executable program;
    write_text(program.folder / "s.gltf", small_scene());
    const auto is_line_of_full_disk = [](const Run& run) {
        return run.code == 2 && run.error_lines() == 1 && run.err.find("No space left") != std::string::npos;
    };
    Run run =
        program.run(with({"--passes", "1", "-q", "--stats", "stats.json", "--checkpoint", "/dev/full"}));
    CHECK_MESSAGE(is_line_of_full_disk(run), run.err);
    CHECK(read_exr(program.folder / "out.exr").width == 16);
    CHECK(nlohmann::json::parse(read_text(program.folder / "stats.json"))["passes"] == 1);

    std::filesystem::remove(program.folder / "out.exr");
    std::filesystem::create_symlink("/dev/full", program.folder / "out.exr");
    run = program.run(with({"--passes", "2", "-q", "--stats", "stats.json", "--checkpoint", "state"}));
    CHECK_MESSAGE(is_line_of_full_disk(run), run.err);
    CHECK(nlohmann::json::parse(read_text(program.folder / "stats.json"))["passes"] == 2);
    CHECK(std::filesystem::file_size(program.folder / "state") > 0);

    run = program.run(with({"--passes", "2", "-q", "--stats", "/dev/full", "--checkpoint", "again"}));
    CHECK_MESSAGE(is_line_of_full_disk(run), run.err);
    CHECK(run.err.find("out.exr") < run.err.find("/dev/full"));
    CHECK(std::filesystem::file_size(program.folder / "again") > 0);
}
