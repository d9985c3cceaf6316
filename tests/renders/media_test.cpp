// Paths that start within media: which medium that is, and what it takes away.
#include <doctest/doctest.h>

#include <cmath>

#include "host/render/start_media.h"
#include "host/scene/scene_compiler.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/cell_row.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double half_turn = 0.70710678118654752;

int boundary(SceneBuilder& s, const char* inside, const char* outside = "") {
    json optics = {{"surface", {{"class", "boundary"}}}, {"inside", inside}};
    if (*outside) optics["outside"] = outside;
    return s.material(optics);
}

// Scenes around probes: point lights, and at the end area lights. What is expected of each is the medium
// inside a material; -1 = vacuum.
struct Probes {
    SceneBuilder scene;
    std::vector<int> front, back;
    void point(double x, double y, double z, int expected) {
        scene.light({{"type", "point"}, {"intensity", 1}}, at(x, y, z));
        front.push_back(expected), back.push_back(-1);
    }
    void area(int material, const Place& place, int expected, int behind) {
        scene.rectangle(0.1, 0.1, material, place);
        front.push_back(expected), back.push_back(behind);
    }
};

}  // namespace

TEST_CASE("paths start in the medium around them, by closed boundaries, nested, touching, and by pools") {
    Probes p;
    SceneBuilder& s = p.scene;
    for (const char* name : {"water", "glass", "ink"}) s.medium(name, {{"absorption", 1}});
    const int water = boundary(s, "water"), glass = boundary(s, "glass"), ink = boundary(s, "ink", "glass");
    const int wall = s.lambertian(0.5);
    s.light({{"type", "directional"}, {"intensity", 1}}, at(0, 0, 0));
    // Ink in glass in water; only the ink says what is around it.
    add_box(s, {4, 4, 4}, water, false, at(0, 0, 0));
    s.sphere(1, glass, at(0, 0, 0));
    s.sphere(0.3, ink, at(0.5, 0, 0));
    p.point(0.5, 0.1, 0, ink), p.point(-0.5, 0.1, 0.1, glass), p.point(-1.5, 0.2, 0.3, water);
    p.point(2.2, 0.1, 0.3, -1);
    // Behind closed walls that name no medium.
    add_box(s, {0.5, 0.5, 0.5}, wall, false, at(1.5, 1.5, 1.5));
    p.point(1.5, 1.6, 1.4, water);
    // A box of glass that shares a face with the water.
    add_box(s, {1, 4, 4}, glass, false, at(-2.5, 0, 0));
    p.point(-2.1, 0.3, 0.1, glass), p.point(-1.9, 0.3, 0.1, water);
    // Pools, one under a roof: walls and floor name no medium.
    for (const double x : {10.0, 20.0}) {
        add_box(s, {4, 4, 4}, wall, true, at(x, 0, 0));
        s.rectangle(4, 4, water, at(x, 0, 0));
        p.point(x, 0.5, -0.3, water), p.point(x + 0.2, 1, 0.4, -1);
    }
    // A box without a lid, and one of whose sides is missing.
    s.rectangle(2, 2, glass, facing_down(30, 0, -1));
    for (const double side : {-1.0, 1.0}) {
        s.rectangle(2, 2, glass, {{30 + side, 0, 0}, {0, side * half_turn, 0, half_turn}});
        s.rectangle(2, 2, glass, {{30, side, 0}, {-side * half_turn, 0, 0, half_turn}});
    }
    p.point(30, 0.1, -0.1, glass);
    // A spot that shines at a wall from close by.
    s.light({{"type", "spot"}, {"spot", {{"outerConeAngle", 0.1}}}}, at(10, 1, -1.9));
    p.front.push_back(water), p.back.push_back(-1);
    // Lights with a surface: one that separates nothing, within glass; one that does, of both sides.
    p.area(s.black_emitter(1), at(-0.4, -0.4, 0.4), glass, -1);
    const int skin = s.material({{"surface", {{"class", "boundary"}}},
                                 {"inside", "ink"},
                                 {"outside", "water"},
                                 {"emission", {{"radiance", 1}}}},
                                {{"doubleSided", true}});
    p.area(skin, at(0, 1.5, 0), water, ink);
    s.perspective(1, at(0.1, -0.7, 0.3));

    Scene scene = compile_test_scene(s.import());
    const uint32_t lights = uint32_t(scene.lights);
    const Views views(test_device(), scene, {{scene.receivers[0].ref, 1, 1}});
    StartMedia of_all(test_device(), scene, views, true);
    of_all.find();
    const auto media = of_all.buffer().read_array<uint32_t>(1 + 2 * lights);
    const auto materials = scene.buffers.at("Materials").read_array<MaterialRecord>(scene.materials);
    const auto medium = [&](int material) {
        return material < 0 ? no_record : materials[size_t(material)].inside;
    };
    CHECK(media[0] == medium(glass));
    CHECK(media[1] == no_record);  // the directional light stands first
    REQUIRE(p.front.size() + 1 == lights);
    for (size_t i = 0; i < p.front.size(); ++i) {
        CAPTURE(i);
        CHECK(media[3 + 2 * i] == medium(p.front[i]));
        CHECK(media[4 + 2 * i] == medium(p.back[i]));
    }
    StartMedia of_receiver(test_device(), scene, views, false);
    of_receiver.find();
    CHECK(of_receiver.buffer().read_array<uint32_t>(1)[0] == medium(glass));
}

namespace {

// The camera of the row looks at the floor from within a slab of fog; each cell's light is within ink.
constexpr double fog = 10, fog_lo = 0.02, fog_hi = 0.1, ink = 1.5, dye = 0.6;  // 1/m, m
constexpr double h = 1.2, radius = 0.4, lamp_size = 0.4;                       // m
const double seen_through_fog = std::exp(-fog * (eye_height - fog_lo));

double cosine_at(double x, double y) { return h / std::sqrt(x * x + y * y + h * h); }
double fog_below(double cosine) { return std::exp(-fog * (fog_hi - fog_lo) / cosine) * seen_through_fog; }
double lit_by_point(double x, double y, double optical_depth) {
    return point_light(x, y, h, 5) * std::exp(-optical_depth) * fog_below(cosine_at(x, y));
}

// A lamp in a slab of ink whose lower face is half a metre below it.
double lit_by_lamp(double x, double y) {
    constexpr int n = 8;
    double sum = 0;
    for (int i = 0; i < n * n; ++i) {
        const double dx = x - lamp_size * ((i % n + 0.5) / n - 0.5),
                     dy = y - lamp_size * ((i / n + 0.5) / n - 0.5);
        const double c = cosine_at(dx, dy), area = lamp_size * lamp_size / (n * n);
        sum += area * c * c * c * c / (h * h) * std::exp(-ink * 0.5 / c) * fog_below(c);
    }
    return floor_radiance(20 * sum);
}

std::vector<Cell> cells() {
    const auto add_spot = [](SceneBuilder& s, double x) {
        s.light({{"type", "spot"},
                 {"intensity", 5},
                 {"spot", {{"innerConeAngle", 1.2}, {"outerConeAngle", 1.3}}}},
                at(x, 0, h));
    };
    return {
        {"point light in a sphere of ink",
         [](SceneBuilder& s, double x) {
             add_floor(s, x);
             s.light({{"type", "point"}, {"intensity", 5}}, at(x, 0, h));
             s.sphere(radius, boundary(s, "ink"), at(x, 0, h));
         },
         [](double x, double y) { return lit_by_point(x, y, ink * radius); }},
        {"spot in a sphere of dye in a sphere of ink",
         [=](SceneBuilder& s, double x) {
             add_floor(s, x), add_spot(s, x);
             s.sphere(radius / 2, boundary(s, "dye", "ink"), at(x, 0, h));
             s.sphere(radius, boundary(s, "ink"), at(x, 0, h));
         },
         [](double x, double y) { return lit_by_point(x, y, (ink + dye) * radius / 2); }},
        {"lamp in a box of ink",
         [](SceneBuilder& s, double x) {
             add_floor(s, x);
             s.rectangle(lamp_size, lamp_size, s.black_emitter(20), facing_down(x, 0, h));
             add_box(s, {1.9f, 3, 1}, boundary(s, "ink"), false, at(x, 0, h));
         },
         lit_by_lamp},
        {"emitter in the fog",
         [](SceneBuilder& s, double x) { s.rectangle(1.99, 4, s.black_emitter(0.05), at(x, 0, 0.03)); },
         [](double x, double) {
             return 0.05 * std::exp(-fog * (eye_height - 0.03)) * (std::fabs(x) > 0.9 ? 0.96 : 1.0);
         },
         true},
    };
}

}  // namespace

TEST_CASE("cameras and lights within absorbing media: what is left is what Beer and Lambert say") {
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        const std::string name = algorithm_name(algorithm);
        CAPTURE(name);
        RenderPlan plan;
        plan.schedule = Schedule::fused, plan.algorithm = algorithm;
        plan.passes = algorithm == Algorithm::forward ? 512 : 128, plan.seeds = 8;
        check_row(cells(), plan, [](SceneBuilder& s) {
            s.medium("fog", {{"absorption", fog}});
            s.medium("ink", {{"absorption", ink}});
            s.medium("dye", {{"absorption", dye}});
            add_box(s, {20, 8, fog_hi - fog_lo}, boundary(s, "fog"), false,
                    at(4, 0, 0.5 * (fog_lo + fog_hi)));
        });
    }
}

TEST_CASE("algorithms agree: a diver's view of a pool, lights in the water and above it" *
          doctest::test_suite("long")) {
    SceneBuilder s;
    s.medium("water", {{"ior", 1.33}, {"absorption", {0.5, 0.2, 0.1}}});
    s.medium("ink", {{"ior", 1.33}, {"absorption", {1, 2, 3}}});
    add_box(s, {4, 4, 4}, s.lambertian({0.7, 0.5, 0.6}), true, at(0, 0, 0));
    s.perspective(1.2, at(0, 0, 1.95));
    // The water stands upright, from the plane z = 0.3 to the camera; rough, else forward rays need far more
    // passes.
    s.rectangle(4, 4,
                s.material({{"surface", {{"class", "dielectric"}, {"alpha", 0.6}}}, {"inside", "water"}}),
                {{0, 0, 0.3}, {0, 1, 0, 0}});
    s.rectangle(1.5, 1.5, s.black_emitter({3, 4, 5}), {{0, 1.95, -1}, {half_turn, 0, 0, half_turn}});
    s.light({{"type", "point"}, {"intensity", 1}}, at(1, 0.5, 1));
    s.sphere(0.3, boundary(s, "ink", "water"), at(1, 0.5, 1));
    add_box(s, {1, 1, 0.6f}, s.lambertian(0.6), false, at(-0.8, -1.5, 0.9));
    add_box(s, {1, 1.6f, 1}, s.lambertian(0.6), false, at(0.7, -1.2, -0.9));
    Comparison c;
    c.forward = 512;  // few of its paths pass the water towards the camera
    check_against_backward(s, c);
}

TEST_CASE("algorithms agree: smooth coats over diffuse bases, and clear foils" *
          doctest::test_suite("long")) {
    SceneBuilder s;
    add_box(s, {4, 4, 4}, s.lambertian({0.7, 0.5, 0.3}), true, at(0, 0, 0));
    s.perspective(1.2, at(0, 0, 1.95));
    s.rectangle(1.5, 1.5, s.black_emitter({3, 4, 5}), {{0, 1.95, 0}, {half_turn, 0, 0, half_turn}});
    const auto coated = [&](double roughness) {
        return s.material(json::object(), {{"pbrMetallicRoughness",
                                            {{"baseColorFactor", {0.3, 0.5, 0.8, 1}},
                                             {"metallicFactor", 0},
                                             {"roughnessFactor", roughness}}}});
    };
    s.sphere(0.6, coated(0), at(-1.1, -1.3, 0.2));
    s.sphere(0.6, coated(0.3), at(1.1, -1.3, 0.2));
    add_box(s, {1, 1.2f, 1}, coated(0), false, {{0, -1.4, -1}, {0, 0.3, 0, 0.954}});
    const int foil = s.surface({{"class", "thin_dielectric"}});
    s.rectangle(1.5, 1.5, foil, {{-1.1, 0.2, 0}, {half_turn, 0.1, 0, half_turn}});
    s.rectangle(1, 1, foil, at(0.6, -0.8, 1));
    check_against_backward(s);
}
