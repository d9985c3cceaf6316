// Gratings in whole renders: spectral lines where the grating equation puts them, order 0 that leaves
// wavelengths together, power that adds up, and forward rays that bring the same as backward ones.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "host/scene/spectral_value.h"
#include "host/spectra/color.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/stokes_means.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double degree = std::numbers::pi / 180;

json order(int m, double reflected, double transmitted) {
    return {{"order", m}, {"reflected", reflected}, {"transmitted", transmitted}};
}

// As much to either side, all of it kept.
json even_grating(double period, double axis) {
    return {{"class", "grating"},
            {"period", period},
            {"axis", axis},
            {"orders", {order(0, 0.15, 0.25), order(1, 0.15, 0.15), order(-1, 0.15, 0.15)}}};
}

json line_at(int nm) { return {{"wavelengths", {nm - 3, nm, nm + 3}}, {"values", {0, 1e6, 0}}}; }

// A camera looks along -z at a grating that is turned by `turn` about y.
struct Mount {
    double period, turn, axis;
    int order;
    bool reflected;
};

// Where the light of an order comes from that goes on along +z: n wo + n' wi = m λ / period across the
// grooves.
glm::dvec3 towards_light(const Mount& m, double nm) {
    const glm::dvec3 normal(std::sin(m.turn), 0, std::cos(m.turn)), x(std::cos(m.turn), 0, -std::sin(m.turn)),
        y(0, 1, 0);
    const glm::dvec3 across = -std::sin(m.axis) * x + std::cos(m.axis) * y, wo(0, 0, 1);
    const glm::dvec3 along = m.order * nm * 1e-9 / m.period * across - (wo - glm::dot(wo, normal) * normal);
    REQUIRE(glm::dot(along, along) < 1);
    return along + (m.reflected ? 1.0 : -1.0) * std::sqrt(1 - glm::dot(along, along)) * normal;
}

}  // namespace

TEST_CASE("a grating sends each line along its orders, in the plane and out of it") {
    const Mount mounts[] = {{1e-6, 0, -90 * degree, 1, false},
                            {1e-6, 25 * degree, -90 * degree, -1, true},
                            {1.2e-6, 40 * degree, 0.3, -1, true},
                            {2.5e-6, -20 * degree, 1.1, 2, false}};
    for (const Mount& mount : mounts)
        for (const auto& [emitted, placed] : {std::pair(486, 486), {656, 656}, {486, 656}}) {
            CAPTURE(mount.axis);
            CAPTURE(mount.order);
            CAPTURE(emitted);
            CAPTURE(placed);
            SceneBuilder s;
            const json grating = {
                {"class", "grating"},
                {"period", mount.period},
                {"axis", mount.axis},
                {"orders",
                 json::array({order(mount.order, mount.reflected ? 0.3 : 0, mount.reflected ? 0 : 0.2)})},
                {"evanescent", "absorbed"}};
            s.rectangle(0.01, 0.01, s.surface(grating),
                        {{0, 0, 0}, {0, std::sin(mount.turn / 2), 0, std::cos(mount.turn / 2)}});
            // The line is 6 nm wide, 8e-3 rad of it at most.
            const glm::dvec3 at_lamp = towards_light(mount, placed);
            s.rectangle(0.1, 0.1, s.black_emitter(line_at(emitted)),
                        facing(10.0 * at_lamp, -at_lamp, {0, 1, 0}));
            s.orthographic(2e-5, at(0, 0, 0.1));
            RenderPlan plan;
            plan.width = plan.height = 2, plan.passes = 16384, plan.seeds = 2;
            Scene scene = compile_test_scene(s.import());
            REQUIRE(scene.features.dispersion);
            const WindowMean seen = window_mean(render_estimates(scene, plan));
            const glm::dvec3 rgb =
                (mount.reflected ? 0.3 : 0.2) *
                rgb_of_radiance(spectral_value(line_at(emitted), {}, "/test", SpectralKind::radiance)
                                    .as_table(SpectralKind::radiance));
            if (emitted == placed)
                CHECK(seen.mean == doctest::Approx((rgb.x + rgb.y + rgb.z) / 3).epsilon(0.1));
            else
                CHECK(seen.mean == 0);
        }
}

// In colours all light goes as that of 587.6 nm.
TEST_CASE("without wavelengths a grating diffracts all light as that of the d line") {
    const Mount mount{1e-6, 0, -90 * degree, 1, true};
    SceneOptions options = test_options();
    options.color = ColorMode::rgb;
    for (const double nm : {587.6, 610.0}) {
        SceneBuilder s;
        json orders = json::array({order(1, 0.3, 0)});
        orders[0]["reflected"] = {0.1, 0.2, 0.4};
        s.rectangle(
            0.01, 0.01,
            s.surface({{"class", "grating"}, {"period", 1e-6}, {"axis", mount.axis}, {"orders", orders}}),
            at(0, 0, 0));
        const glm::dvec3 at_lamp = towards_light(mount, nm);
        s.rectangle(0.02, 0.02, s.black_emitter(1), facing(10.0 * at_lamp, -at_lamp, {0, 1, 0}));
        s.orthographic(2e-5, at(0, 0, 0.1));
        Scene scene = compile_test_scene(s.import(), options);
        REQUIRE(!scene.features.spectral);
        const Estimates e = render_estimates(scene, {.width = 1, .height = 1, .passes = 64, .seeds = 2});
        const double expected[] = {0.1, 0.2, 0.4};
        for (int c = 0; c < 3; ++c)
            CHECK(e.at(0, 0, c) == doctest::Approx(nm == 587.6 ? expected[c] : 0).epsilon(1e-5));
    }
}

// One path a pixel: as many hues as there are heroes, but for what keeps its direction.
TEST_CASE("wavelengths part in every order of a grating but 0") {
    for (const auto& [m, below, hues] : {std::tuple(0, 1.0, 1), {1, 1.0, 4}, {0, 1.5, 1}, {-1, 1.5, 4}}) {
        CAPTURE(m);
        CAPTURE(below);
        SceneBuilder s;
        s.medium("below", {{"ior", below}});
        const json orders = json::array({order(m, 0, 0.5)});
        s.rectangle(2, 2,
                    s.material({{"surface", {{"class", "grating"}, {"period", 2e-6}, {"orders", orders}}},
                                {"inside", "below"}}),
                    at(0, 0, 0));
        s.environment(1);
        s.orthographic(0.5, at(0, 0, 5));
        const Estimates e =
            render_estimates(s.import(), {.width = 16, .height = 16, .passes = 1, .seeds = 1});
        std::vector<double> found;
        for (size_t i = 0; i < e.mean.size(); i += 3) {
            const double hue =
                e.mean[i] / (std::abs(e.mean[i]) + std::abs(e.mean[i + 1]) + std::abs(e.mean[i + 2]));
            if (std::none_of(found.begin(), found.end(),
                             [&](double other) { return std::abs(other - hue) < 1e-3; }))
                found.push_back(hue);
        }
        CHECK(int(found.size()) == hues);
    }
}

// Evanescent orders and total reflection included: what is scattered one way is scattered the other, so that
// no direction sends out more or less than comes in.
TEST_CASE("gratings that keep all light are as bright as the white sky around them") {
    for (const double period : {0.3e-6, 0.5e-6, 0.9e-6, 3e-6})
        for (const bool glass : {false, true}) {
            CAPTURE(period);
            CAPTURE(glass);
            SceneBuilder s;
            s.environment(1);
            s.perspective(0.5, at(0, 0, 3));
            s.medium("glass", {{"ior", 1.5}});
            json material = {{"surface", even_grating(period, 0.6)}};
            if (glass) material["inside"] = "glass";
            s.sphere(0.4, s.material(material), at(0, 0, 0));
            RenderPlan plan;
            plan.width = plan.height = 16, plan.passes = 256;
            const WindowMean mean = window_mean(render_estimates(s.import(), plan));
            CHECK(std::fabs(mean.mean - 1) < 1e-5 + 5 * mean.standard_error);
            CHECK(mean.standard_error < 5e-3);
        }
}

// A beam on a grating in a black box: what its orders send, the walls absorb.
TEST_CASE("power: the orders of a grating and what it absorbs are all that comes") {
    struct Case {
        double period, absorbed;
        const char* evanescent;
    };
    // Orders 1 and -1 are evanescent at 0.3 µm for every wavelength that is seen, and at 5 µm for none. Of
    // their 0.6 order 0 takes all: light comes back along it the same way.
    for (const Case& c :
         {Case{5e-6, 0.1, "absorbed"}, {0.3e-6, 0.7, "absorbed"}, {0.3e-6, 0.1, "zero_order"}}) {
        CAPTURE(c.period);
        SceneBuilder s;
        const json orders = {order(0, 0.1, 0.2), order(1, 0.15, 0.15), order(-1, 0.2, 0.1)};
        s.rectangle(0.5, 0.5,
                    s.material({{"surface",
                                 {{"class", "grating"},
                                  {"period", c.period},
                                  {"orders", orders},
                                  {"evanescent", c.evanescent}}}},
                               {{"name", "grating"}}),
                    at(0, 0, 0));
        add_box(s, {2, 2, 2}, s.material({{"surface", {{"class", "absorber"}}}}, {{"name", "walls"}}), true,
                at(0, 0, 0));
        s.placed("light", {{"class", "collimated"}, {"radius", 0.1}, {"power", 1}}, at(0, 0, 0.5));
        s.orthographic(0.5, at(0, 0, 0.9));
        Scene scene = compile_test_scene(s.import());
        RenderSettings settings;
        settings.width = settings.height = 16;
        settings.receiver = scene.receivers.front().ref;
        settings.algorithm = Algorithm::forward;
        settings.forward_paths = 16;
        settings.ledger = true;
        Renderer renderer(test_device(), scene, settings);
        renderer.render_passes(64);
        const RenderCounters counters = renderer.counters();
        double told = 0;
        for (const auto& [name, power] : counters.absorbed_by) told += power;
        CHECK(told == doctest::Approx(counters.emitted).epsilon(1e-5));
        CHECK(counters.absorbed_by.at("material grating") ==
              doctest::Approx(c.absorbed * counters.emitted).epsilon(0.01));
    }
}

// Grooves and s lie along y, down in the picture; light comes across them from an even sky.
TEST_CASE("a table that tells s from p polarizes light, reflected and let through") {
    for (const bool reflects : {true, false}) {
        SceneBuilder s;
        s.environment(1);
        const char* const kind = reflects ? "reflected" : "transmitted";
        const json rows = {{{"order", 1}, {"polarization", "s"}, {kind, 0.6}},
                           {{"order", 1}, {"polarization", "p"}, {kind, 0.2}}};
        s.rectangle(
            2, 2,
            s.surface(
                {{"class", "grating"}, {"period", 2e-6}, {"axis", -90 * degree}, {"efficiencies", rows}}),
            {{0, 0, 0}, {0, std::sin(0.1), 0, std::cos(0.1)}});
        s.orthographic(0.5, at(0, 0, 5));
        RenderPlan plan;
        plan.width = plan.height = 8, plan.passes = 64, plan.stokes = true;
        SceneOptions options = test_options();
        options.polarization = PolarizationMode::on;
        Scene scene = compile_test_scene(s.import(), options);
        check_stokes(stokes_means(render_estimates(scene, plan)), {0.4, -0.2, 0, 0}, 0.01);
    }
}

// What it gives one way is not what it gives the other, as no grating does; all the more algorithms must
// agree.
TEST_CASE("algorithms agree: a table of efficiencies, in an element and on glass") {
    SceneBuilder s;
    s.medium("flint", {{"ior", 1.7}});
    add_room(s);
    add_lamp(s, 1);
    json rows = json::array();
    for (int m = -1; m <= 1; ++m)
        for (const double angle : {-1.0, 0.0, 1.0})
            rows.push_back({{"order", m},
                            {"angle", angle},
                            {"wavelength", {400, 700}},
                            {"reflected", {0.1 + 0.05 * m * angle, 0.05}},
                            {"transmitted", {0.1 + 0.05 * angle, 0.15 - 0.05 * m}}});
    const json lined = {{"class", "grating"}, {"period", 2e-6}, {"axis", 0.5}, {"efficiencies", rows}};
    add_box(s, {1.2f, 0.3f, 1.2f}, s.material({{"surface", lined}, {"inside", "flint"}}), false,
            at(0.5, 0.3, -0.5));
    json plate = lined;
    plate["size"] = {1.2, 1.2};
    s.placed("element", plate, facing({-0.8, -0.4, -0.8}, {0.3, 0.6, 1}, {1, 0, 0}));
    Comparison c;
    c.backward = 256, c.forward = 64, c.bidirectional = 32, c.largest_error = 0.02;
    check_against_backward(s, c);
}

// A lamp that is seen and shines through a slab whose faces are gratings, and by one that reflects.
TEST_CASE("algorithms agree: gratings that reflect and that let light into glass and out of it") {
    SceneBuilder s;
    s.medium("flint", {{"ior", {{"name", "SF11 ior"}}}});
    add_room(s);
    add_lamp(s, 1);
    const json lined = {
        {"class", "grating"},
        {"period", 2e-6},
        {"axis", 0.5},
        {"orders", {order(0, 0.05, 0.5), order(1, 0.05, 0.2), order(-1, 0.02, 0.05), order(2, 0, 0.05)}}};
    add_box(s, {1.2f, 0.3f, 1.2f}, s.material({{"surface", lined}, {"inside", "flint"}}), false,
            at(0.5, 0.3, -0.5));
    s.rectangle(1.2, 1.2,
                s.surface({{"class", "grating"},
                           {"period", 1.5e-6},
                           {"orders", {order(0, 0.2, 0.1), order(1, 0.5, 0), order(-1, 0.1, 0.05)}}}),
                facing({-0.8, -0.4, -0.8}, {0.3, 0.6, 1}, {1, 0, 0}));
    Comparison c;
    c.backward = 512, c.forward = 128, c.bidirectional = 64, c.largest_error = 0.01;
    check_against_backward(s, c);
}

// A lamp of spectral lines shines through a grating in a black wall onto a screen: each line has a patch of
// its own beside that of order 0.
TEST_CASE("algorithms agree: the spectrum that a grating throws on a screen") {
    SceneBuilder s;
    const int black = s.surface({{"class", "absorber"}});
    s.rectangle(0.3, 1, s.black_emitter({{"illuminant", "F11"}}), facing({0, 0, 2}, {0, 0, -1}, {1, 0, 0}));
    const json orders = {order(0, 0, 0.3), order(1, 0, 0.6)};
    s.rectangle(
        0.8, 0.8,
        s.surface({{"class", "grating"}, {"period", 1.2e-6}, {"axis", -90 * degree}, {"orders", orders}}),
        at(0, 0, 0));
    for (const double side : {-1.0, 1.0}) {
        s.rectangle(2, 4, black, at(side * 1.4, 0, 0));
        s.rectangle(0.8, 2, black, at(0, side * 1.4, 0));
    }
    s.rectangle(2, 1, s.lambertian(0.8), at(0.4, 0, -1));
    s.orthographic(0.5, at(0.4, 0, -0.1));
    Scene scene = compile_test_scene(s.import());
    Comparison c;
    c.width = 40, c.height = 20;
    c.backward = 2048, c.forward = 128, c.bidirectional = 128, c.largest_error = 0.01;
    check_against_backward(scene, c);
}
