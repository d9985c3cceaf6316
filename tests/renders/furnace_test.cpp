// Lossless things under light that is the same from everywhere cannot be seen: their radiance is the
// environment's.
//
// One row of spheres, a cell of the image each. The environment is coloured, so that a channel that is lost
// or mixed shows.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/renders/sphere_row.h"

using namespace etendue;

namespace {

struct Sphere {
    std::string name;
    nlohmann::json surface;
    bool inside_glass;  // separates a medium of ior 1.5 from vacuum
    double tolerance;   // relative, of the mean over the sphere
};

const std::vector<Sphere>& spheres() {
    static const std::vector<Sphere> list = {
        {"lambertian", {{"class", "lambertian"}, {"reflectance", 1}}, false, 0.0005},
        {"mirror", {{"class", "conductor"}, {"reflectance", 1}}, false, 0.0005},
        {"glass", {{"class", "dielectric"}}, true, 0.0005},
        {"pane", {{"class", "thin_dielectric"}}, false, 0.0005},
        {"boundary", {{"class", "boundary"}}, true, 0.0005},
        {"conductor .05",
         {{"class", "conductor"}, {"reflectance", 1}, {"alpha", 0.05}, {"multiscatter", true}},
         false,
         0.005},
        {"conductor .3",
         {{"class", "conductor"}, {"reflectance", 1}, {"alpha", 0.3}, {"multiscatter", true}},
         false,
         0.005},
        {"conductor .8",
         {{"class", "conductor"}, {"reflectance", 1}, {"alpha", 0.8}, {"multiscatter", true}},
         false,
         0.005},
        {"rough glass .05", {{"class", "dielectric"}, {"alpha", 0.05}, {"multiscatter", true}}, true, 0.005},
        {"rough glass .3", {{"class", "dielectric"}, {"alpha", 0.3}, {"multiscatter", true}}, true, 0.005},
        {"rough glass .8", {{"class", "dielectric"}, {"alpha", 0.8}, {"multiscatter", true}}, true, 0.005},
        {"single scattering conductor .8",
         {{"class", "conductor"}, {"reflectance", 1}, {"alpha", 0.8}},
         false,
         0},
    };
    return list;
}

constexpr uint32_t cell = sphere_pixels;
constexpr double spacing = sphere_spacing, radius = 1;  // m
const double environment[3] = {0.5, 1, 2};

Estimates render_row() {
    SceneBuilder scene;
    scene.medium("glass", {{"ior", 1.5}});
    for (size_t i = 0; i < spheres().size(); ++i) {
        nlohmann::json optics = {{"surface", spheres()[i].surface}};
        if (spheres()[i].inside_glass) optics["inside"] = "glass";
        // The one that loses light stands far behind the others, which would show what it lacks.
        const double z = spheres()[i].tolerance > 0 ? 0 : -30;
        scene.sphere(radius, scene.material(optics), at(spacing * (double(i) + 0.5), 0, z));
    }
    scene.environment({environment[0], environment[1], environment[2]});
    scene.orthographic(0.5 * spacing, at(0.5 * spacing * double(spheres().size()), 0, 5));
    RenderPlan plan;
    plan.width = cell * uint32_t(spheres().size()), plan.height = cell, plan.passes = 1024, plan.seeds = 8;
    return render_estimates(scene.import(), plan);
}

}  // namespace

TEST_CASE("lossless spheres are invisible under a constant environment") {
    const Estimates e = render_row();
    for (size_t i = 0; i < spheres().size(); ++i) {
        const Sphere& sphere = spheres()[i];
        const WindowMean m = disk_albedo(e, i, radius, environment);
        CAPTURE(sphere.name);
        CAPTURE(m.mean);
        CAPTURE(m.standard_error);
        if (sphere.tolerance > 0) {
            CHECK(std::fabs(m.mean - 1) < sphere.tolerance);
            CHECK(m.standard_error < 0.3 * sphere.tolerance);  // otherwise the check above says nothing
        } else {
            // The counter-example: without multiscatter the same surface loses light, and the test would see
            // it.
            CHECK(m.mean < 0.97);
        }
    }
    // The corners of the cells show the environment itself.
    for (size_t i = 0; i < spheres().size(); ++i)
        for (uint32_t c = 0; c < 3; ++c)
            for (const auto& image : e.images)
                CHECK(image[3 * (i * cell) + c] == doctest::Approx(environment[c]).epsilon(1e-6));
    CHECK(e.counters.depth_limit == 0);
}
