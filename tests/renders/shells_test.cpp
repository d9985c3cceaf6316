// A thousand nested shells of glass whose index grows inwards: a ball of graded index.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/render_probe.h"

using namespace etendue;

// n = 2 - r / m between the radii 1 m and 0.5 m. Light within keeps n r sin(angle to the radius) (Bouguer;
// Born & Wolf, section 3.2.1), and n r grows with r: so the black core of radius 0.5 m and index 1.5 around
// it is seen 0.75 m wide, and all that passes it sees the sky, of which the shells keep nothing.
TEST_CASE("a thousand nested shells: light bends as in a graded index, and none is lost") {
    constexpr int shells = 1000;
    constexpr double outer = 1, core = 0.5, half_height = 1.05;
    SceneBuilder s;
    std::string outside;
    for (int i = 0; i < shells; ++i) {
        const double r = outer + (core - outer) * i / shells, middle = r + (core - outer) * 0.5 / shells;
        const std::string name = "shell " + std::to_string(i);
        s.medium(name, {{"ior", 2 - middle}});
        nlohmann::json optics = {{"surface", {{"class", "dielectric"}}}, {"inside", name}};
        if (i > 0) optics["outside"] = outside;
        s.sphere(float(r), s.material(optics), at(0, 0, 0));
        outside = name;
    }
    s.sphere(float(core), s.surface({{"class", "absorber"}}), at(0, 0, 0));
    s.environment({1, 1, 1});
    s.orthographic(half_height, at(0, 0, 3));
    Scene scene = compile_test_scene(s.import());
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 1, plan.seeds = 8;
    const Estimates e = render_estimates(scene, plan);
    const double disk = std::numbers::pi * 1.5 * core * 1.5 * core, picture = 4 * half_height * half_height;
    const WindowMean seen = window_mean(e);
    MESSAGE("part of the picture that is sky: ", seen.mean, " +- ", seen.standard_error, ", expected ",
            1 - disk / picture);
    CHECK(seen.standard_error < 0.01);
    CHECK(std::fabs(seen.mean - (1 - disk / picture)) < 4 * seen.standard_error + 1e-3);
}
