// Total internal reflection: a square pipe of lossless glass (index 1.5) loses nothing at its walls, however
// grazing.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/render_probe.h"

using namespace etendue;

// Whatever enters at its end meets the walls beyond the critical angle: at 48.2 degrees or more, 41.8 being
// critical. What is lost is Fresnel's reflection R at both ends, back and forth between them: (1 - R) / (1 +
// R) is left.
TEST_CASE("a light pipe passes on all that enters, at angles from grazing its walls to 80 degrees") {
    constexpr double width = 0.1, length = 1, n = 1.5;
    struct Case {
        double degrees;
        float lamp;  // m: a wide one makes the scene large, which must not make the pipe less exact
    };
    for (const auto& [degrees, lamp] : {Case{0.001, 2}, {0.1, 2}, {5, 2}, {45, 2}, {80, 2}, {80, 1000}}) {
        CAPTURE(degrees);
        CAPTURE(lamp);
        SceneBuilder s;
        s.medium("glass", {{"ior", n}});
        add_box(s, {float(width), float(width), float(length)},
                s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}), false,
                at(0, 0, -length / 2));
        s.rectangle(lamp, lamp, s.black_emitter(1), at(0, 0, -length - 0.01));
        const double a = degrees * std::numbers::pi / 180;
        // In the plane of x, towards -z and +x.
        s.orthographic(0.01 * std::cos(a), {{-0.5 * std::sin(a), 0, 0.5 * std::cos(a)},
                                            {0, -std::sin(a / 2), 0, std::cos(a / 2)}});
        RenderPlan plan;
        plan.width = plan.height = 4, plan.passes = 1024, plan.seeds = 8;
        const Estimates e = render_estimates(s.import(), plan);
        const double ci = std::cos(a), ct = std::sqrt(1 - (1 - ci * ci) / (n * n));
        const double rs = (ci - n * ct) / (ci + n * ct), rp = (n * ci - ct) / (n * ci + ct);
        const double r = 0.5 * (rs * rs + rp * rp), expected = (1 - r) / (1 + r);
        const WindowMean seen = window_mean(e);
        MESSAGE(degrees, " degrees: ", seen.mean, " +- ", seen.standard_error, ", expected ", expected);
        CHECK(seen.standard_error < 0.003);
        CHECK(std::fabs(seen.mean - expected) < 5 * seen.standard_error);
    }
}

// Ridges of 90 degrees under a flat face, which is lit and seen head-on: both flanks reflect totally where
// the index is above the root of 2, and all light returns.
TEST_CASE("a prism film sends back all light that comes straight on, if its index is above 1.414") {
    const int ridges = 8;
    std::vector<glm::vec3> positions;  // of each end of the film: face and back, from left to right
    for (const float y : {-20.0f, 20.0f})
        for (int i = 0; i <= 2 * ridges; ++i) {
            const float x = 0.5f * float(i - ridges);
            positions.push_back({x, y, 0});
            positions.push_back({x, y, i % 2 ? -0.7f : -0.2f});
        }
    const uint32_t end = uint32_t(positions.size()) / 2;
    std::vector<uint32_t> indices;
    const auto quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
        indices.insert(indices.end(), {a, b, c, a, c, d});
    };
    for (uint32_t i = 0; i < 4 * ridges; i += 2) {
        quad(i, i + 2, end + i + 2, end + i);          // the face
        quad(i + 1, end + i + 1, end + i + 3, i + 3);  // a flank
        quad(i, i + 1, i + 3, i + 2);                  // both ends
        quad(end + i, end + i + 2, end + i + 3, end + i + 1);
    }
    quad(0, end, end + 1, 1);
    quad(end - 2, end - 1, 2 * end - 1, 2 * end - 2);
    const auto seen = [&](double ior) {
        SceneBuilder s;
        s.medium("plastic", {{"ior", ior}});
        s.mesh(positions, indices,
               s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "plastic"}}), at(0, 0, 0));
        s.rectangle(60, 60, s.black_emitter(1), {{0, 0, 5}, {0, 1, 0, 0}});
        s.orthographic(1.7, at(0.1, 0, 2));
        RenderPlan plan;
        plan.width = plan.height = 16, plan.passes = 256;
        return window_mean(render_estimates(s.import(), plan));
    };
    for (const double ior : {1.49, 1.586}) {
        CAPTURE(ior);
        CHECK(seen(ior).mean == doctest::Approx(1).epsilon(1e-4));
    }
    CHECK(seen(1.40).mean < 0.5);
}
