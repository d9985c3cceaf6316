// What happens to windows: other sizes, other displays, files that change.
#include <doctest/doctest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/preview/two_balls.h"
#include "tests/support/class_file.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

// Of /proc/PID/status, in KiB.
double resident_kib(pid_t process) {
    std::istringstream lines(read_text("/proc/" + std::to_string(process) + "/status"));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("VmRSS:")) return std::stod(line.substr(6));
    return 0;
}

// Seconds of processor time so far.
double processor_seconds(pid_t process) {
    std::string text = read_text("/proc/" + std::to_string(process) + "/stat");
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    double user = 0, system = 0;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    fields >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
}

nlohmann::json stats_of(const ViewedScene& view) {
    return nlohmann::json::parse(read_text(view.program.folder / "stats.json"));
}

void sleep_seconds(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// KiB that the process holds once it rests. Kernels that are compiled while passes run take tens of megabytes
// of the compiler's for a while.
double resting_kib(pid_t process) {
    for (int i = 0; i < 120; ++i) {
        const double before = processor_seconds(process);
        sleep_seconds(0.5);
        if (processor_seconds(process) - before < 0.05) break;
    }
    return resident_kib(process);
}

}  // namespace

TEST_CASE("a window that is resized 50 times shows the image of its last size and leaks nothing") {
    ViewedScene view(two_balls, words_with("320x240"));
    const Image large = headless_image(two_balls, "400x300"), small = headless_image(two_balls, "200x160");
    view.x.key("Tab");
    double settled = 0;
    for (int i = 0; i < 50; ++i) {
        view.x.resize(200 + 4 * (i * 37 % 50), 160 + 3 * (i * 23 % 46));
        sleep_seconds(0.05);
        if (i == 9) {
            view.x.resize(400, 300);
            REQUIRE(shows(view.x, large, {}));
            settled = resting_kib(view.process);
        }
    }
    view.x.resize(200, 160);
    CHECK(shows(view.x, small, {}));
    view.x.resize(400, 300);
    CHECK(shows(view.x, large, {}));
    // 40 swapchains of that size would hold 40 x 4 images of half a megabyte.
    CHECK(resting_kib(view.process) < settled + 32 * 1024);
    CHECK(view.close().err == "");
    const nlohmann::json stats = stats_of(view);
    CHECK(stats["device_bytes"].get<double>() < 60e6);
    CHECK(stats["window_device_bytes"].get<double>() < 10e6);
}

TEST_CASE("a minimised window rests, and is as before when it comes back") {
    ViewedScene view(two_balls, {"--exposure", "0", "--algorithm", "backward", "--size", "320x240"});
    view.x.key("Tab");
    REQUIRE(view.x.wait_until([](const Screenshot& shot) { return shot.at(160, 5)[0] > 200; }));
    view.x.set_minimised(true);
    sleep_seconds(0.5);
    const double before = processor_seconds(view.process);
    sleep_seconds(1);
    CHECK(processor_seconds(view.process) - before < 0.1);
    view.x.set_minimised(false);
    CHECK(view.x.wait_until([](const Screenshot& shot) { return shot.at(160, 5)[0] > 200; }));
    CHECK(view.close().err == "");
}

TEST_CASE("a picture at rest costs no processor time") {
    ViewedScene view(two_balls, words_with("320x240"));
    view.x.key("Tab");
    REQUIRE(shows(view.x, headless_image(two_balls, "320x240"), {}));
    sleep_seconds(0.5);
    const double before = processor_seconds(view.process);
    sleep_seconds(1);
    CHECK(processor_seconds(view.process) - before < 0.1);
    CHECK(view.close().err == "");
}

TEST_CASE("on a display of twice the resolution panels are twice as large") {
    // The panel's ground is dark where the picture is white: how far to the right?
    const auto panel_width = [](XServer& x) {
        int width = 0;
        CHECK(x.wait_until([&](const Screenshot& shot) {
            if (shot.at(shot.width - 10, 6)[0] < 200) return false;
            for (width = 0; width < shot.width - 20 && shot.at(width + 20, 60)[2] < 200;) ++width;
            return width > 100;
        }));
        return double(width);
    };
    ViewedScene usual(two_balls, words_with("900x500")), fine(two_balls, words_with("900x500"), 192);
    CHECK(panel_width(fine.x) / panel_width(usual.x) == doctest::Approx(2).epsilon(0.05));
    CHECK(usual.close().err == "");
    CHECK(fine.close().err == "");
}

TEST_CASE(
    "a scene file that changes is shown anew; of a broken one the message, and the last picture stays") {
    ViewedScene view(two_balls, words_with("320x240"));
    const Image before = headless_image(two_balls, "320x240");
    view.x.key("Tab");
    REQUIRE(shows(view.x, before, {}));
    const std::string blue = replaced(two_balls, "[0.8, 0.1, 0.1]", "[0.1, 0.1, 0.9]");
    write_text(view.program.folder / "scene.gltf", blue);
    const Image after = headless_image(blue, "320x240");
    REQUIRE(shows(view.x, after, {}));
    const Screenshot good = view.x.screenshot();

    write_text(view.program.folder / "scene.gltf", replaced(two_balls, "\"radius\": 0.6", "\"radius\": -1"));
    // The message stands above; all else is as it was.
    const auto differs_above = [&](const Screenshot& shot) {
        bool above = false, below = false;
        for (size_t i = 0; i < shot.rgb.size(); ++i)
            (i < shot.rgb.size() / 2 ? above : below) |= shot.rgb[i] != good.rgb[i];
        return above && !below;
    };
    CHECK(view.x.wait_until(differs_above));
    write_text(view.program.folder / "scene.gltf", blue);
    CHECK(shows(view.x, after, {}));
    CHECK(view.close().err == "");
}

TEST_CASE("shaders of a folder are read again when they change") {
    TemporaryFolder shaders;
    std::filesystem::copy(source_path("shaders"), shaders.path, std::filesystem::copy_options::recursive);
    ViewedScene view(two_balls, words_with("320x240", {"--shaders", shaders.path.string()}));
    view.x.key("Tab");
    REQUIRE(shows(view.x, headless_image(two_balls, "320x240"), {}));
    const std::filesystem::path file = shaders / "lights/constant.glsl";
    const std::string text = read_text(file);
    write_text(file, text + "\nbroken\n");
    const Screenshot good = view.x.screenshot();
    CHECK(view.x.wait_until([&](const Screenshot& shot) { return shot.rgb != good.rgb; }));  // the message
    write_text(file, text + "\n// as it was\n");
    CHECK(shows(view.x, headless_image(two_balls, "320x240"), {}));
    CHECK(view.close().err == "");
}

TEST_CASE("Ctrl+S saves the image as EXR and PNG") {
    ViewedScene view(two_balls, words_with("320x240"));
    const Image image = headless_image(two_balls, "320x240");
    view.x.key("Tab");
    REQUIRE(shows(view.x, image, {}));
    view.x.hold("Control_L", true);
    view.x.key("s");
    view.x.hold("Control_L", false);
    const std::filesystem::path exr = view.program.folder / "scene-001.exr";
    for (int i = 0; i < 200 && !std::filesystem::exists(view.program.folder / "scene-001.png"); ++i)
        sleep_seconds(0.05);
    REQUIRE(std::filesystem::exists(view.program.folder / "scene-001.png"));
    const Image saved = read_exr(exr);
    REQUIRE(pixel_count(saved) == pixel_count(image));
    const auto ours = plane(saved, size_t(find_channel(saved, "G"))),
               theirs = plane(image, size_t(find_channel(image, "G")));
    CHECK(std::equal(ours.begin(), ours.end(), theirs.begin()));
    CHECK(find_channel(saved, "error.G") >= 0);
    CHECK(view.close().err == "");
}

TEST_CASE("a scene that brings class files is asked for, and shown only after a yes") {
    const TemporaryFolder folder;
    write_text(folder / "chalk.glsl", chalk_class());
    // A relative path leads there from wherever the program's folder is.
    const std::string there = (std::filesystem::path("../") / folder.path.filename() / "chalk.glsl").string();
    const std::string scene =
        replaced(replaced(two_balls, R"("class": "lambertian", "reflectance": 0.5)",
                          R"("class": "chalk", "reflectance": 0.5)"),
                 R"("ETD_optics": {"environment")",
                 R"("ETD_optics": {"class_files": [{"interface": "surface", "file": ")" + there +
                     R"("}], "environment")");
    {
        ViewedScene view(scene, words_with("320x240"));
        sleep_seconds(2);
        CHECK(view.x.screenshot().at(160, 5)[0] < 100);  // no picture
        view.x.key("n");
        const Run run = view.wait();
        CHECK(run.code == 2);
        CHECK_MESSAGE(run.err.find("--allow-class-files") != std::string::npos, run.err);
        CHECK(run.error_lines() == 1);
    }
    ViewedScene view(scene, words_with("320x240"));
    sleep_seconds(2);
    view.x.key("y");
    view.x.key("Tab");
    CHECK(view.x.wait_until([](const Screenshot& shot) { return shot.at(160, 5)[0] > 200; }));
    CHECK(view.close().err == "");
}
