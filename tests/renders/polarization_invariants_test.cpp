// What holds for polarized light whatever it meets, asked of every registered class: what a turned camera
// measures turns, a mirrored scene shows S2 and S3 of the other sign, and no sample has more polarization
// than light.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>

#include "host/scene/classes.h"
#include "tests/renders/registered_classes.h"
#include "tests/renders/sheets.h"
#include "tests/renders/stokes_means.h"
#include "tests/support/source_path.h"
#include "tests/support/light_probe.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using glm::dvec3;
using nlohmann::json;

namespace {

constexpr double turn = 0.6;  // rad, of the camera about its view

// How a class stands in the scene; mirrored, its angles are of the other sign.
using Sample = std::function<void(SceneBuilder& s, bool mirrored)>;

dvec3 seen_in_mirror(dvec3 v, bool mirrored) { return mirrored ? dvec3(-v.x, v.y, v.z) : v; }

Place tilted(bool mirrored) {
    return facing({0, 0, -1}, seen_in_mirror({0.3, 0.5, 0.8}, mirrored),
                  seen_in_mirror({1, 0.2, 0}, mirrored));
}

// The camera looks along -z at a sample between lamps of polarized light, one that is mirrored to it by a
// sample of that tilt, and one behind.
SceneBuilder scene_of(const Sample& sample, bool mirrored, double turned) {
    SceneBuilder s;
    s.environment(0.1);
    s.perspective(1e-3, {{0, 0, 0}, {0, 0, std::sin(turned / 2), std::cos(turned / 2)}});
    const double sign = mirrored ? -1 : 1;
    const auto lamp = [&](double s1, double s2, double s3) {
        return s.material({{"surface", {{"class", "absorber"}}},
                           {"emission", {{"radiance", 1}, {"stokes", {1, s1, sign * s2, sign * s3}}}}});
    };
    const dvec3 view(0, 0, -1), n = glm::normalize(dvec3(0.3, 0.5, 0.8)),
                                to = view - 2 * glm::dot(view, n) * n;
    s.rectangle(4, 4, lamp(0.2, 0.5, -0.6),
                facing(seen_in_mirror(view + 2.0 * to, mirrored), seen_in_mirror(-to, mirrored),
                       seen_in_mirror({1, 0, 0}, mirrored)));
    s.rectangle(4, 4, lamp(-0.4, 0.3, 0.7),
                facing({0, 0, -3}, {0, 0, 1}, seen_in_mirror({1, 0, 0}, mirrored)));
    sample(s, mirrored);
    return s;
}

Estimates seen(const SceneBuilder& s, const std::filesystem::path& folder, uint32_t seeds, uint32_t passes) {
    RenderPlan plan;
    plan.width = plan.height = 16, plan.seeds = seeds, plan.passes = passes, plan.stokes = true;
    SceneOptions options = test_options();
    options.polarization = PolarizationMode::on;
    options.color = ColorMode::rgb;
    options.varying = {"places"};  // so that the scenes of a class have the same kernels
    Scene scene = compile_test_scene(s.import(folder / "scene.gltf"), options);
    return render_estimates(scene, plan);
}

void check_same(const StokesMeans& found, const StokesMeans& other, const std::array<double, 4>& expected) {
    for (int i = 0; i < 4; ++i) {
        CAPTURE(i);
        CAPTURE(found[i].mean);
        CAPTURE(expected[i]);
        const double error = std::hypot(found[i].standard_error, other[i].standard_error);
        CHECK(std::fabs(found[i].mean - expected[i]) < 2e-5 + 5 * error);
        CHECK(error < 0.02);
    }
}

// Returns how much is polarized.
double check_invariants(const Sample& sample, const std::filesystem::path& folder) {
    const StokesMeans straight = stokes_means(seen(scene_of(sample, false, 0), folder, 8, 64));
    const StokesMeans turned = stokes_means(seen(scene_of(sample, false, turn), folder, 8, 64));
    const StokesMeans mirrored = stokes_means(seen(scene_of(sample, true, 0), folder, 8, 64));
    const double c = std::cos(2 * turn), s = std::sin(2 * turn);
    const auto at = [&](int i) { return straight[i].mean; };
    INFO("turned");
    check_same(turned, straight, {at(0), c * at(1) + s * at(2), c * at(2) - s * at(1), at(3)});
    INFO("mirrored");
    check_same(mirrored, straight, {at(0), at(1), -at(2), -at(3)});
    const Estimates samples = seen(scene_of(sample, false, 0), folder, 1, 1);
    for (uint32_t y = 0; y < 16; ++y)
        for (uint32_t x = 0; x < 16; ++x) {
            std::array<double, 4> v;
            for (uint32_t i = 0; i < 4; ++i) v[i] = samples.at(x, y + 16 * i, 1);
            CHECK(std::hypot(v[1], v[2], v[3]) <= v[0] * (1 + 1e-4) + 1e-6);
        }
    return std::hypot(at(1), at(2), at(3)) / at(0);
}

// Angles about the normal are not zero, so that a wrong sign shows.
json with_angles(json object, const ClassInfo& info, bool mirrored) {
    for (const Parameter& p : info.parameters)
        for (const char* name : {"axis", "rubbing", "twist", "anisotropy_rotation"})
            if (p.member.name == name && p.default_value.is_number())
                object[name] = (mirrored ? -1 : 1) * (0.3 + double(p.default_value));
    if (object.contains("matrix") && mirrored)
        for (int i = 0; i < 16; ++i)
            if ((i / 4 < 2) != (i % 4 < 2)) object["matrix"][i] = -double(object["matrix"][i]);
    if (object.contains("orders") && mirrored)  // of a grating: they count to the other side
        for (json& order : object["orders"]) order["order"] = -int(order["order"]);
    return object;
}

}  // namespace

TEST_CASE("turned cameras, mirrored scenes and the degree of polarization: every class of surfaces") {
    const TemporaryFolder folder;
    write_metals(folder.path);
    ClassRegistry registry(test_sources());
    for (const ClassInfo& known : registry.classes(Interface::surface)) {
        const ClassInfo& info = *registry.find(Interface::surface, known.name);
        const json surface = surface_of(known.name);
        CAPTURE(surface);
        const double degree = check_invariants(
            [&](SceneBuilder& s, bool mirrored) {
                s.medium("glass", {{"ior", 1.5}});
                json material = {{"surface", with_angles(surface, info, mirrored)}};
                if (info.name == "dielectric") material["inside"] = "glass";
                s.rectangle(0.4, 0.4, s.material(material), tilted(mirrored));
            },
            folder.path);
        MESSAGE(info.name, ": ", degree);
        // Without a word on polarization light is depolarized, or passes straight from the lamp behind.
        if (!info.says_polarization && degree > 1e-5)
            CHECK(std::fabs(degree - std::hypot(0.4, 0.3, 0.7)) < 0.01);
    }
}

TEST_CASE("turned cameras, mirrored scenes and the degree of polarization: every class of media and phases") {
    const TemporaryFolder folder;
    ClassRegistry registry(test_sources());
    const auto check = [&](const json& medium, const json& surface) {
        CAPTURE(medium);
        check_invariants(
            [&](SceneBuilder& s, bool mirrored) {
                json placed = medium;
                if (mirrored && placed.contains("axis")) placed["axis"][0] = -double(placed["axis"][0]);
                s.medium("probed", placed);
                s.sphere(0.3, s.material({{"surface", surface}, {"inside", "probed"}}), at(0, 0, -1));
            },
            folder.path);
    };
    for (const ClassInfo& known : registry.classes(Interface::medium)) {
        const ClassInfo& info = *registry.find(Interface::medium, known.name);
        if (info.name == "grid") continue;  // needs a file, and is a medium of phases like others
        json medium = medium_of(info.name);
        for (const Parameter& p : info.parameters)
            if (p.member.name == "axis") medium["axis"] = {0.3, 0.5, 0.8};
        check(medium, {{"class", "dielectric"}});
    }
    for (const ClassInfo& info : registry.classes(Interface::phase))
        check({{"class", "homogeneous"}, {"scattering", 3}, {"phase", {{"class", info.name}}}},
              {{"class", "boundary"}});
}
