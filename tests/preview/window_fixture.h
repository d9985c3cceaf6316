// `etendue view` in a window of a real X server.
#pragma once
#include <chrono>
#include <thread>
#include <utility>

#include "host/image/exr.h"
#include "tests/cli/program.h"
#include "tests/preview/tone_curves_twin.h"
#include "tests/preview/x_server.h"

namespace etendue {

class ViewedScene {
  public:
    // Starts the program; `words` follow `view SCENE`. The scene's text is written into the program's folder.
    ViewedScene(const std::string& scene, std::vector<std::string> words, int dots_per_inch = 96,
                const std::map<std::string, std::string>& environment = {})
        : x(dots_per_inch) {
        program.environment = environment;
        program.environment["DISPLAY"] = x.name();
        std::ofstream(program.folder / "scene.gltf") << scene;
        words.insert(words.begin(), {"view", "scene.gltf", "--stats", "stats.json"});
        process = program.start(words);
        x.wait_for_window();
    }
    ~ViewedScene() {
        if (process > 0) kill(process, SIGKILL), waitpid(process, nullptr, 0);
    }

    // Closes the window by its key; what the program said.
    Run close() {
        x.key("Escape");
        return wait();
    }
    // Until the program has ended.
    Run wait() {
        for (int i = 0; i < 600; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
            siginfo_t info{};
            if (waitid(P_PID, id_t(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                info.si_pid == process)
                return program.finish(std::exchange(process, -1));
        }
        FAIL("the program does not end");
        return {};
    }

    Executable program;
    XServer x;
    pid_t process = -1;
};

// Greatest difference of a channel, in steps of 1/255, leaving out the `worst` share of the pixels; of
// pictures of the same size.
inline double greatest_difference(const Screenshot& shot, const Image& image, const ViewSettings& settings,
                                  double worst = 0) {
    if (shot.width != int(image.width) || shot.height != int(image.height)) return 255;
    const auto channels = picture_channels(image);
    std::vector<double> differences;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            glm::dvec3 radiance;
            for (size_t c = 0; c < 3; ++c) radiance[int(c)] = plane(image, channels[c])[y * image.width + x];
            const glm::dvec3 color = 255.0 * shown_color(settings, radiance);
            double greatest = 0;
            for (int c = 0; c < 3; ++c)
                greatest = std::max(greatest, std::abs(color[c] - shot.at(int(x), int(y))[c]));
            differences.push_back(greatest);
        }
    const auto last = differences.end() - 1 - std::ptrdiff_t(worst * double(differences.size()));
    std::nth_element(differences.begin(), last, differences.end());
    return *last;
}

// Of the pixels, the share that differ by more than a few steps.
inline double changed_share(const Screenshot& a, const Screenshot& b) {
    if (a.rgb.size() != b.rgb.size()) return 1;
    size_t changed = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3)
        changed += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) +
                       std::abs(a.rgb[i + 2] - b.rgb[i + 2]) >
                   12;
    return double(changed) / double(a.rgb.size() / 3);
}

}  // namespace etendue
