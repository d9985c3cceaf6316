// Images of forward and of bidirectional rays against those of backward rays alone, from independent seeds.
#pragma once
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/render_probe.h"

namespace etendue {

struct Comparison {
    uint32_t width = 32, height = 24, seeds = 16;
    uint32_t backward = 256, forward = 128, bidirectional = 64;  // passes; 0 = not compared
    double tolerance = 0.002;             // of the mean over the image, besides four standard errors
    double largest_error = 0.005;         // that these may have, else the comparison says little
    float merge_radius = 0.1f;            // bias of merging grows with its square
    bool stokes = false;                  // S0 to S3 are compared
    std::string receiver = "";            // name; empty = the first
    std::vector<LightLayer> layers = {};  // are compared, too
    bool unconnected = false;             // bidirectional rays whose vertices are not connected, too
};

// Two sets of images of one scene, by what one is called. Pixels and tiles of 8 x 8 by Student's t over the
// seeds: a false alarm in 1000 runs each. The mean of all by four standard errors: one in 1000 (15 degrees of
// freedom). Seeds are fixed, so a build either passes always or never. `layers`: 4 of Stokes images.
inline void check_agreement(const std::string& name, const Estimates& e, const Estimates& expected,
                            double tolerance = 0.002, double largest_error = 0.005, uint32_t layers = 1) {
    const Agreement pixels = agreement(e, expected, 1), tiles = agreement(e, expected, 8);
    MESSAGE(name, ": pixels ", describe(pixels), "; tiles ", describe(tiles));
    CAPTURE(name);
    CHECK(pixels.holds);
    CHECK(tiles.holds);
    CHECK(pixels.rms_z < 1.15);
    CHECK(tiles.rms_z < 1.4);
    double intensity = 0;
    for (uint32_t layer = 0; layer < layers; ++layer) {
        const Window window{0, layer * e.height / layers, e.width, e.height / layers};
        const WindowMean ours = window_mean(e, window), theirs = window_mean(expected, window);
        if (layer == 0) intensity = theirs.mean;
        const double error = std::hypot(ours.standard_error, theirs.standard_error);
        const double bias = ours.mean - theirs.mean;
        MESSAGE(name, ": S", layer, " ", 100 * theirs.mean / intensity, " %, bias ", 100 * bias / intensity,
                " % +- ", 100 * error / intensity, " %");
        CAPTURE(layer);
        CHECK(intensity > 0);
        CHECK(std::fabs(bias) < tolerance * intensity + 4 * error);
        CHECK(error < largest_error * intensity);
    }
}

inline void check_against_backward(Scene& scene, const Comparison& c) {
    RenderPlan plan;
    plan.width = c.width, plan.height = c.height, plan.seeds = c.seeds;
    plan.merge_radius = c.merge_radius, plan.stokes = c.stokes, plan.receiver = c.receiver;
    plan.layers = c.layers;
    plan.algorithm = Algorithm::backward, plan.passes = c.backward;
    const Estimates expected = render_estimates(scene, plan);
    const auto check = [&](Algorithm algorithm, uint32_t passes, uint32_t first_seed) {
        if (passes == 0) return;
        plan.algorithm = algorithm, plan.passes = passes, plan.first_seed = first_seed;
        check_agreement(algorithm_name(algorithm), render_estimates(scene, plan), expected, c.tolerance,
                        c.largest_error, expected.height / c.height);
    };
    check(Algorithm::forward, c.forward, 1001);
    check(Algorithm::bidirectional, c.bidirectional, 2001);
    plan.connect = false;
    if (c.unconnected) check(Algorithm::bidirectional, c.bidirectional, 3001);
}

inline void check_against_backward(const SceneBuilder& builder, const Comparison& c = {},
                                   const std::filesystem::path& file = "scene.gltf") {
    Scene scene = compile_test_scene(builder.import(file));
    check_against_backward(scene, c);
}

}  // namespace etendue
