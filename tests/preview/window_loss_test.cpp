// Devices, surfaces and swapchains that are lost while one looks (preload/vulkan_faults.cpp).
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/preview/two_balls.h"

using namespace etendue;

namespace {

constexpr int device_lost = -4, surface_lost = -1000000000, out_of_date = -1000001004,
              suboptimal = 1000001003;  // VkResult

struct Faulty : ViewedScene {
    Faulty() : ViewedScene(two_balls, words_with("320x240"), 96, {{"LD_PRELOAD", ETENDUE_FAULTS}}) {
        write_text(files.folder / "scene.gltf", two_balls);
        front = headless(files, "320x240"), side = headless(files, "320x240", "side");
        x.key("Tab");
        REQUIRE(shows(x, front, {}));
    }
    // From now on, for so many calls; then the second camera is asked for.
    void fail(const std::string& call, int result, int count) {
        const std::filesystem::path file = program.folder / "faults.txt",
                                    next = program.folder / "faults.new";
        write_text(next, fmt::format("{} {} {}\n", call, result, count));
        std::filesystem::rename(next, file);
        x.key("2");
        // The window may be gone by then.
        for (int i = 0; i < 1200 && std::filesystem::exists(file); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        CHECK(!std::filesystem::exists(file));
    }
    nlohmann::json stats() { return nlohmann::json::parse(read_text(program.folder / "stats.json")); }
    Executable files;
    Image front, side;
};

constexpr double notice_share = 0.1;  // of the pixels lies under what is said below

}  // namespace

TEST_CASE("a device or surface that is lost is replaced, and scene and camera stay") {
    Faulty view;
    const std::pair<const char*, int> losses[] = {
        {"renderer vkQueueSubmit", device_lost},   {"renderer vkQueueWaitIdle", device_lost},
        {"window vkQueueSubmit", device_lost},     {"window vkQueuePresentKHR", device_lost},
        {"window vkWaitForFences", device_lost},   {"window vkAcquireNextImageKHR", surface_lost},
        {"window vkQueuePresentKHR", surface_lost}};
    for (const auto& [call, result] : losses) {
        CAPTURE(call);
        view.fail(call, result, 1);
        CHECK(shows(view.x, view.side, {}, notice_share));
        view.x.key("1");
        CHECK(shows(view.x, view.front, {}, notice_share));
    }
    const Run run = view.close();
    CHECK(run.code == 0);
    CHECK(run.err == "");
    CHECK(view.stats()["devices_lost"] == 2);
    CHECK(view.stats()["window_devices_lost"] == 5);
}

TEST_CASE("a swapchain that is out of date or no longer fits is replaced") {
    Faulty view;
    for (const char* call : {"window vkAcquireNextImageKHR", "window vkQueuePresentKHR"})
        for (const int result : {out_of_date, suboptimal}) {
            CAPTURE(call);
            CAPTURE(result);
            view.fail(call, result, 3);
            CHECK(shows(view.x, view.side, {}, notice_share));
            view.x.key("1");
            CHECK(shows(view.x, view.front, {}, notice_share));
        }
    CHECK(view.close().err == "");
    CHECK(view.stats()["devices_lost"] == 0);
    CHECK(view.stats()["window_devices_lost"] == 0);
}

TEST_CASE("where every device is lost the program ends with one line, and the last picture is kept") {
    for (const std::string side : {"renderer", "window"}) {
        CAPTURE(side);
        Faulty view;
        view.fail(side + " vkQueueSubmit", device_lost, 1000);
        const Run run = view.wait();
        CHECK(run.code == 3);
        CHECK(run.error_lines() == 1);
        CHECK(run.err.find("the device was lost") != std::string::npos);
        CHECK(run.err.find("the last picture is in scene-001.exr") != std::string::npos);
        Image kept = read_exr(view.program.folder / "scene-001.exr");
        REQUIRE(find_channel(kept, "G") >= 0);
        if (side == "window") continue;  // the renderer may have gone on
        const auto ours = plane(kept, size_t(find_channel(kept, "G"))),
                   theirs = plane(view.front, size_t(find_channel(view.front, "G")));
        // The device rounds the sums of the film once more than the host does, which shows in dark pixels.
        REQUIRE(ours.size() == theirs.size());
        double worst = 0;
        for (size_t i = 0; i < ours.size(); ++i)
            worst = std::max(worst, double(std::fabs(ours[i] - theirs[i])) / std::max(theirs[i], 1e-6f));
        CHECK(worst < 1e-4);
    }
}
