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
