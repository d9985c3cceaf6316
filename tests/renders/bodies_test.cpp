// Which medium a ray is in among bodies with priorities, by what absorbing slabs leave of it.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/error.h"
#include "host/render/start_media.h"
#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

// Media named by what they absorb, in 1/m, a third of it of green and none of blue.
struct Slab {
    double sigma;
    int priority;  // 0 = none: an explicit boundary to vacuum
    double lo, hi;
};
struct Column {
    std::string name;
    std::vector<Slab> slabs;
    double depth;                      // expected, of red
    int repeat_lo = 1, repeat_hi = 1;  // how often the lower and the upper face of the first slab are there
    double depth_from_below = -1;      // to infinity, where it is not the same
};

std::vector<Column> columns() {
    return {{"one", {{1, 1, 1, 2}}, 1},
            {"the higher priority takes what both claim", {{1, 1, 1, 3}, {2, 2, 2, 4}}, 1 + 4},
            {"the other way round", {{1, 2, 1, 3}, {2, 1, 2, 4}}, 2 + 2},
            {"of equal priorities the first", {{1, 5, 1, 3}, {2, 5, 2, 4}}, 2 + 2},
            {"one within another of lower priority", {{1, 1, 1, 4}, {2, 2, 2, 3}}, 2 + 2},
            {"one within another of higher priority", {{1, 2, 1, 4}, {2, 1, 2, 3}}, 3},
            {"three", {{1, 1, 1, 3}, {2, 2, 1.5, 3.5}, {0.5, 3, 2, 2.5}}, 0.5 + 1 + 0.25 + 2},
            {"two of the same material", {{1, 1, 1, 3}, {1, 1, 2, 4}}, 3},
            {"one that touches another of the same", {{1, 1, 1, 2}, {1, 1, 2, 3}}, 2},
            {"one that touches another", {{1, 1, 1, 2}, {2, 2, 2, 3}}, 1 + 2},
            {"a face that coincides with one inside", {{1, 1, 1, 3}, {2, 2, 2, 3}}, 1 + 2},
            {"and with one of higher priority around", {{1, 2, 1, 3}, {2, 1, 2, 3}}, 2},
            {"what has none gives way, and holds beyond", {{1, 0, 1, 3}, {2, 1, 2, 4}}, 1 + 4},
            {"what has none within one that has", {{1, 0, 2, 3}, {2, 1, 1, 4}}, 6},
            {"more than can be counted", {{0.5, 1, 1, 3}}, 1, 20, 20},
            {"not closed above", {{0.5, 1, 1, 3}}, 0, 1, 0, INFINITY},
            {"not closed below", {{0.5, 1, 1, 3}}, 0.5 * 3, 0, 1, 0}};
}

// Column i at x = i, a metre wide; everything is met by vertical rays.
void add_columns(SceneBuilder& s) {
    std::vector<std::pair<std::pair<double, int>, int>> known;
    int number = 0;
    const auto material = [&](double sigma, int priority) {
        for (const auto& [key, index] : known)
            if (key == std::pair(sigma, priority)) return index;
        const std::string name = "medium " + std::to_string(number++);
        s.medium(name, {{"absorption", {sigma, sigma / 3, 0}}});
        json optics = {{"surface", {{"class", "boundary"}}}, {"inside", name}};
        if (priority > 0) optics["priority"] = priority;
        known.push_back({{sigma, priority}, s.material(optics)});
        return known.back().second;
    };
    const auto all = columns();
    for (size_t i = 0; i < all.size(); ++i)
        for (size_t k = 0; k < all[i].slabs.size(); ++k) {
            const Slab& slab = all[i].slabs[k];
            const int m = material(slab.sigma, slab.priority);
            for (int n = 0; n < (k ? 1 : all[i].repeat_lo); ++n)
                s.rectangle(1, 2, m, facing_down(double(i), 0, slab.lo + n * 1e-4));
            for (int n = 0; n < (k ? 1 : all[i].repeat_hi); ++n)
                s.rectangle(1, 2, m, at(double(i), 0, slab.hi - n * 1e-4));
        }
}

void check_columns(const Estimates& e, double unattenuated, bool from_below) {
    const auto all = columns();
    REQUIRE(e.width == all.size());
    for (size_t i = 0; i < all.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            CAPTURE(all[i].name);
            const bool other = from_below && all[i].depth_from_below >= 0;
            const double red = other ? all[i].depth_from_below : all[i].depth;
            const double depth = channel == 0 ? red : channel == 1 ? red / 3 : 0;
            // The faces that are there twenty times lie 2 mm apart.
            CHECK(
                e.at(uint32_t(i), 0, channel) ==
                doctest::Approx(unattenuated * std::exp(-depth)).epsilon(all[i].repeat_lo > 1 ? 4e-3 : 2e-5));
        }
}

// Sees a pixel of each column from above or below.
void add_camera(SceneBuilder& s, double z) {
    const double n = double(columns().size());
    s.orthographic(0.5, at((n - 1) / 2, 0, z));
    s.document["cameras"][0]["orthographic"]["xmag"] = n / 2;
}

RenderPlan one_row() {
    RenderPlan plan;
    plan.width = uint32_t(columns().size()), plan.height = 1, plan.passes = 1, plan.seeds = 1;
    return plan;
}

}  // namespace

TEST_CASE("bodies with priorities: the medium is that of the highest, along a ray and along a shadow ray") {
    SceneBuilder seen, lit;
    add_columns(seen), add_columns(lit);
    seen.rectangle(100, 10, seen.black_emitter(2), at(0, 0, 0));
    add_camera(seen, 6);
    Scene scene = compile_test_scene(seen.import());
    for (const Schedule schedule : {Schedule::fused, Schedule::wavefront, Schedule::by_class}) {
        RenderPlan plan = one_row();
        plan.schedule = schedule;
        check_columns(render_estimates(scene, plan), 2, false);
    }
    lit.rectangle(100, 10, lit.lambertian(0.5), at(0, 0, 0));
    lit.light({{"type", "directional"}, {"intensity", 3}}, at(0, 0, 0));
    add_camera(lit, 0.5);
    check_columns(render_estimates(lit.import(), one_row()), 0.5 * 3 / std::numbers::pi, true);
}

TEST_CASE("paths start among the bodies that hold their start, whose faces may coincide") {
    SceneBuilder s;
    for (const char* name : {"fog", "glass", "water", "ice"}) s.medium(name, {{"absorption", 1}});
    const auto body = [&](const char* inside, int priority) {
        return s.material({{"surface", {{"class", "boundary"}}}, {"inside", inside}, {"priority", priority}});
    };
    const int water = body("water", 1), ice = body("ice", 2), glass = body("glass", 3);  // places 2, 1, 0
    // A cube of glass around one of water that fits it to the last bit, two balls of ice in it, in a cloud of
    // fog.
    add_box(s, {4, 4, 4}, glass, false, at(0, 0, 0));
    add_box(s, {2, 2, 2}, glass, true, at(0, 0, 0));
    add_box(s, {2, 2, 2}, water, false, at(0, 0, 0));
    s.sphere(0.6, ice, at(-0.2, 0, 0)), s.sphere(0.6, ice, at(0.2, 0, 0));
    add_box(s, {9, 9, 9}, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "fog"}}), false,
            at(0, 0, 0));
    add_box(s, {20, 20, 20}, s.lambertian(0.5), true, at(0, 0, 0));
    struct Expected {
        uint32_t counts;
        bool in_fog;
    };
    std::vector<Expected> expected;
    const auto light = [&](double x, double y, uint32_t counts, bool in_fog) {
        s.light({{"type", "point"}, {"intensity", 1}}, at(x, y, 0.01));
        expected.push_back({counts, in_fog});
    };
    light(0, 0, 0x120, true);  // a digit each: of water, of ice, of glass
    light(0.7, 0.1, 0x110, true), light(0.9, 0.8, 0x100, true), light(1.5, 0.2, 0x001, true);
    light(3, 0.4, 0, true), light(7, 0.3, 0, false);
    s.perspective(1, at(0.75, 0, 0));
    Scene scene = compile_test_scene(s.import());
    const Views views(test_device(), scene, {{scene.receivers[0].ref, 1, 1}});
    StartMedia media(test_device(), scene, views, true);
    media.find();
    struct Surroundings {  // twin of the struct in shaders/features/bodies.glsl
        uint32_t medium, outer;
        glm::uvec2 counts;
    };
    const auto found = media.buffer().read_array<Surroundings>(1 + 2 * scene.lights);
    CHECK(found[0].counts == glm::uvec2(0x110, 0));
    const uint32_t fog = found[0].outer;
    CHECK(fog != no_record);
    for (size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        const Surroundings& around = found[1 + 2 * i];
        CHECK(around.counts == glm::uvec2(expected[i].counts, 0));
        CHECK(around.outer == (expected[i].in_fog ? fog : no_record));
        if (expected[i].counts == 0)
            CHECK(around.medium == around.outer);
        else
            CHECK(around.medium != around.outer);
    }
}

TEST_CASE("sixteen materials may have a priority, and all are told apart") {
    for (const int number : {16, 17}) {
        SceneBuilder s;
        double depth = 0;
        for (int i = 0; i < number; ++i) {
            const std::string name = std::to_string(i);
            const double sigma = 0.05 * (1 + (7 * i) % 16);
            s.medium(name, {{"absorption", {sigma, 0, 0}}});
            const int m = s.material(
                {{"surface", {{"class", "boundary"}}}, {"inside", name}, {"priority", 1 + (i * 5) % 16}});
            // Each within the next lower in priority, so that half a metre of each is seen above and below.
            const double z = 17 - (i * 5) % 16;
            add_box(s, {float(z), float(z), float(z)}, m, false, at(0, 0, 0));
            depth += sigma * (z > 2 ? 1 : 2);
        }
        s.rectangle(100, 100, s.black_emitter(2), at(0, 0, -10));
        s.orthographic(0.1, at(0, 0, 10));
        if (number > 16) {
            CHECK_THROWS_WITH_AS(compile_test_scene(s.import()),
                                 doctest::Contains("17 materials have a priority; allowed: 16"), Error);
            continue;
        }
        RenderPlan plan;
        plan.width = plan.height = plan.passes = plan.seeds = 1;
        const Estimates e = render_estimates(s.import(), plan);
        CHECK(e.at(0, 0, 0) == doctest::Approx(2 * std::exp(-depth)).epsilon(2e-5));
        CHECK(e.at(0, 0, 2) == doctest::Approx(2).epsilon(1e-6));
    }
}
