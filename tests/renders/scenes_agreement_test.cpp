// Forward, backward and bidirectional rays give the same image of every scene in scenes/.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "host/gltf/gltf.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

// Smooth water and glass hide the small lamps of these scenes from all rays but the one backward ray in some
// thousand that hits it: as they are, images agree within a noise of per cents, after many passes. So they
// are compared a second time with lamps so many times as wide, of the same radiance.
struct HiddenLamp {
    float wider;
    uint32_t backward, forward, bidirectional;  // passes as they are; 0 = too many for a test
    double largest_error;
};
const std::map<std::string, HiddenLamp> hidden_lamps = {{"caustic_box", {8, 16384, 128, 1024, 0.02}},
                                                        {"glass_in_fog", {10, 0, 0, 0, 0}},
                                                        {"pool", {10, 16384, 2048, 64, 0.04}}};

void widen_lamp(SceneDescription& scene, float factor) {
    const auto lamp = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                   [](const MeshDescription& mesh) { return mesh.name == "lamp"; });
    REQUIRE(lamp != scene.meshes.end());
    for (glm::vec3& position : lamp->positions) {  // lies flat around the axis x = z = 0
        position.x *= factor;
        position.z *= factor;
    }
}

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(source_path("scenes")))
        if (entry.path().extension() == ".gltf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// The lamps of these scenes are points, which no backward ray meets behind smooth glass, and what they light
// is seen through the glass by bidirectional rays only: what is seen beside the glass is compared. No
// backward ray meets those of a ray file.
const std::map<std::string, Window> beside_glass = {
    {"prism", {0, 0, 32, 14}}, {"rainbow", {0, 0, 18, 24}}, {"led_lens", {0, 0, 32, 24}}};

void compare_beside_glass(Scene& scene, const Comparison& c, const Window& window) {
    RenderPlan plan;
    plan.width = c.width, plan.height = c.height, plan.seeds = c.seeds;
    plan.merge_radius = c.merge_radius;
    plan.algorithm = Algorithm::forward, plan.passes = 4 * c.forward;
    const Estimates forward = render_estimates(scene, plan);
    plan.algorithm = Algorithm::bidirectional, plan.passes = 4 * c.bidirectional, plan.first_seed = 2001;
    const Estimates both = render_estimates(scene, plan);
    for (const uint32_t tile : {1u, 7u}) {
        const Agreement a = agreement(both, forward, tile, window);
        MESSAGE("bidirectional against forward, tiles of ", tile, ": ", describe(a));
        CHECK(a.holds);
        CHECK(a.rms_z < 1.4);
    }
    const WindowMean f = window_mean(forward, window), b = window_mean(both, window);
    const double error = std::hypot(f.standard_error, b.standard_error);
    CHECK(std::fabs(b.mean - f.mean) < c.tolerance * f.mean + 4 * error);
    CHECK(error < c.largest_error * f.mean);
}

}  // namespace

TEST_CASE("algorithms agree: every scene in scenes/" * doctest::test_suite("long")) {
    for (const std::filesystem::path& file : scene_files()) {
        const std::string name = file.stem().string();
        SUBCASE(name.c_str()) {
            CAPTURE(name);
            MESSAGE(name);
            Comparison c;
            c.width = 32, c.height = 24, c.seeds = 16;
            c.largest_error = 0.02;  // glass hides lamps from forward rays, too
            if (name == "materials" || name == "cloud") c.forward = 512;
            SceneDescription description = import_gltf(file);
            if (const auto hidden = hidden_lamps.find(name); hidden != hidden_lamps.end()) {
                const HiddenLamp& h = hidden->second;
                Comparison long_one = c;
                long_one.backward = h.backward, long_one.forward = h.forward;
                long_one.bidirectional = h.bidirectional, long_one.largest_error = h.largest_error;
                Scene as_it_is = compile_test_scene(description);
                if (h.backward > 0) check_against_backward(as_it_is, long_one);
                widen_lamp(description, h.wider);
            }
            Scene scene = compile_test_scene(description);
            if (const auto window = beside_glass.find(name); window != beside_glass.end())
                compare_beside_glass(scene, c, window->second);
            else
                check_against_backward(scene, c);
        }
    }
}
