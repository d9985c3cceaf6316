// Passes of one render, made apart and merged: the film of a single run, bit for bit, whatever the ranges and
// the order. Passes must not depend on earlier ones, nor sums on their order.
#include <algorithm>
#include <random>

#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

// A ball of glass before a wall, with a lamp of 1e6 times the wall's radiance, which pixels see: caustics, so
// that vertices merge, and samples of all sizes in one pixel.
SceneDescription ball_and_lamp(bool spectral) {
    SceneBuilder s;
    s.medium("glass", spectral ? nlohmann::json{{"ior", {{"name", "BK7 ior"}}}, {"scattering", 0.1}}
                               : nlohmann::json{{"ior", 1.5}});
    s.rectangle(8, 8, s.lambertian({0.7, 0.5, 1e-6}), at(0, 0, -2));
    s.sphere(0.8, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}), at(0, 0, 0));
    s.sphere(0.05, s.black_emitter({1e6, 1e5, 1e-2}), at(1.5, 1, 1));
    s.environment({1e-4, 1e-6, 1e-5});
    s.perspective(0.7, at(0, 0, 6));
    return s.import();
}

// Every part by a renderer that has rendered nothing else, in an order of its own.
FilmState merged_parts(Scene& scene, const RenderSettings& settings, uint32_t passes, uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<PassRange> ranges;
    for (uint64_t first = 0; first < passes;) {
        const uint64_t end = std::min<uint64_t>(passes, first + 1 + random() % 6);
        ranges.push_back({first, end});
        first = end;
    }
    std::shuffle(ranges.begin(), ranges.end(), random);
    FilmState all;
    for (const PassRange& range : ranges) {
        Renderer renderer(test_device(), scene, settings);
        renderer.begin_at(range.first);
        renderer.render_passes(uint32_t(range.count()));
        const FilmState part = renderer.state();
        CHECK(part.passes.ranges() == std::vector{range});
        if (all.passes.empty()) {
            all = part;
            continue;
        }
        merge(all.pixels, part.pixels);
        merge(all.bins, part.bins);
        all.passes.add(part.passes);
        add(all.counters, part.counters);
    }
    return all;
}

// Returns what the single run counted.
RenderCounters check_parts(Scene& scene, RenderSettings settings, uint32_t passes, uint32_t seed) {
    settings.receiver = scene.receivers.front().ref;
    settings.width = 24, settings.height = 16, settings.seed = 3;
    Renderer single(test_device(), scene, settings);
    single.render_passes(passes);
    const FilmState expected = single.state(), parts = merged_parts(scene, settings, passes, seed);
    CHECK(parts.passes == expected.passes);
    CHECK(parts.pixels == expected.pixels);
    CHECK(parts.bins == expected.bins);
    CHECK(parts.counters.rays == expected.counters.rays);
    CHECK(parts.counters.forward_paths == expected.counters.forward_paths);
    const Image image = single.develop(),
                merged = develop_film(single.film_shape(), parts.pixels, parts.passes, true);
    CHECK(merged.values == image.values);
    CHECK(std::any_of(image.values.begin(), image.values.end(), [](float v) { return v > 0; }));
    return expected.counters;
}

}  // namespace

TEST_CASE("parts of any ranges, merged in any order, are the film of a single run, bit for bit") {
    Scene scene = compile_test_scene(ball_and_lamp(false));
    RenderSettings settings;
    settings.algorithm = Algorithm::backward;
    check_parts(scene, settings, 23, 1);
    settings.algorithm = Algorithm::bidirectional;
    settings.forward_paths = 2;
    check_parts(scene, settings, 16, 2);
    settings.vertex_bytes = 1 << 16;  // too little: all passes have as few paths as fit in the first
    settings.forward_paths = 16;
    CHECK(check_parts(scene, settings, 9, 3).forward_paths_a_pass < 16 * 24 * 16);
}

TEST_CASE("parts in wavelengths, with the bins of a spectral image, are those of a single run") {
    Scene scene = compile_test_scene(ball_and_lamp(true));
    RenderSettings settings;
    settings.algorithm = Algorithm::bidirectional;
    settings.spectral_bins = 8;
    check_parts(scene, settings, 11, 4);
}
