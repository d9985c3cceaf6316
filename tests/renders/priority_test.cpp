// Bodies whose meshes overlap, by priority, against the same bodies cut to shape by hand, with interfaces
// that name their media.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/error.h"
#include "host/render/start_media.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/renders/cell_row.h"

using namespace etendue;
using nlohmann::json;

namespace {

struct Block {
    std::array<double, 3> lo, hi;
};

// A rectangle across an axis at `at`, whose normal runs up the axis or down it; lo and hi of the two others.
void add_rectangle(SceneBuilder& s, int axis, bool up, double at, const Block& b, int material) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<glm::vec3> corners(4);
    for (int i = 0; i < 4; ++i) {
        corners[size_t(i)][axis] = float(at);
        corners[size_t(i)][u] = float(i == 1 || i == 2 ? b.hi[size_t(u)] : b.lo[size_t(u)]);
        corners[size_t(i)][v] = float(i > 1 ? b.hi[size_t(v)] : b.lo[size_t(v)]);
    }
    s.mesh(corners, up ? std::vector<uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<uint32_t>{0, 2, 1, 0, 3, 2},
           material, {});
}

// All faces but the one across x whose normal runs up or down it, if one is to be left out.
void add_block(SceneBuilder& s, const Block& b, int material, int left_out = 0) {
    for (size_t axis = 0; axis < 3; ++axis)
        for (const bool up : {false, true})
            if (axis > 0 || left_out != (up ? 1 : -1))
                add_rectangle(s, int(axis), up, up ? b.hi[axis] : b.lo[axis], b, material);
}

int body(SceneBuilder& s, const json& surface, const char* inside, int priority) {
    return s.material({{"surface", surface}, {"inside", inside}, {"priority", priority}});
}
int interface(SceneBuilder& s, const json& surface, const char* inside, const char* outside = "") {
    json optics = {{"surface", surface}, {"inside", inside}};
    if (*outside) optics["outside"] = outside;
    return s.material(optics);
}

// A block of glass and a smaller one of ice that stands in it, and a bubble in the glass. Seen from +z.
struct Blocks {
    json surface;
    std::string glass = "glass", ice = "ice", air = "air";
};
const Block glass_block{{-0.9, -0.7, -0.5}, {0.1, 0.5, 0.5}}, ice_block{{-0.2, -0.5, -0.3}, {1.0, 0.3, 0.3}};

void add_overlapping(SceneBuilder& s, const Blocks& b) {
    const int ice = body(s, b.surface, b.ice.c_str(), 10), air = body(s, b.surface, b.air.c_str(), 30);
    add_block(s, glass_block, body(s, b.surface, b.glass.c_str(), 20));
    Block left = ice_block, right = ice_block;  // of which the one overlaps the other, and the glass
    left.hi[0] = 0.6, right.lo[0] = 0.4;
    add_block(s, left, ice);
    add_block(s, right, ice);
    s.sphere(0.3, air, at(-0.4, -0.1, 0));
}

void add_cut(SceneBuilder& s, const Blocks& b) {
    const int glass = interface(s, b.surface, b.glass.c_str());
    add_block(s, glass_block, glass, 1);
    const double x = glass_block.hi[0];
    Block part = glass_block;
    part.hi[1] = ice_block.lo[1];
    add_rectangle(s, 0, true, x, part, glass);
    part = glass_block, part.lo[1] = ice_block.hi[1];
    add_rectangle(s, 0, true, x, part, glass);
    for (const bool up : {false, true}) {
        part = ice_block;
        (up ? part.lo : part.hi)[2] = (up ? ice_block.hi : ice_block.lo)[2];
        (up ? part.hi : part.lo)[2] = (up ? glass_block.hi : glass_block.lo)[2];
        add_rectangle(s, 0, true, x, part, glass);
    }
    add_rectangle(s, 0, true, x, ice_block, interface(s, b.surface, b.glass.c_str(), b.ice.c_str()));
    part = ice_block, part.lo[0] = x;
    add_block(s, part, interface(s, b.surface, b.ice.c_str()), -1);
    s.sphere(0.3, interface(s, b.surface, b.air.c_str(), b.glass.c_str()), at(-0.4, -0.1, 0));
}

// The same scene twice, each with its own way to say what is where.
template <class Add>
std::pair<Scene, Scene> both(Add add) {
    std::array<SceneBuilder, 2> s;
    for (int cut = 0; cut < 2; ++cut) add(s[size_t(cut)], cut == 1);
    return {compile_test_scene(s[0].import()), compile_test_scene(s[1].import())};
}

struct Passes {
    uint32_t backward, forward, bidirectional;  // 0 = none
};

void check_same(Scene& scene, Scene& expected, const Passes& passes, double largest_error = 0.005) {
    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.merge_radius = 0.1f;
    RenderPlan other = plan;
    other.passes = passes.backward, other.first_seed = 5001;
    const Estimates reference = render_estimates(expected, other);
    const auto check = [&](Algorithm algorithm, uint32_t count, uint32_t first_seed) {
        if (count == 0) return;
        plan.algorithm = algorithm, plan.passes = count, plan.first_seed = first_seed;
        check_agreement(algorithm_name(algorithm), render_estimates(scene, plan), reference, 0.002,
                        largest_error);
    };
    check(Algorithm::backward, passes.backward, 1);
    check(Algorithm::forward, passes.forward, 1001);
    check(Algorithm::bidirectional, passes.bidirectional, 2001);
}

void add_media(SceneBuilder& s) {
    s.medium("glass", {{"ior", 1.5}, {"absorption", {1.0, 0.2, 0.4}}});
    s.medium("ice", {{"ior", 1.31}, {"absorption", {0.2, 0.1, 1.0}}});
    s.medium("air", {{"ior", 1.0}});
}

void add_dispersive_media(SceneBuilder& s) {
    s.medium("glass", {{"ior", {{"name", "SF11 ior"}}}});
    s.medium("ice", {{"ior", {{"name", "BK7 ior"}}}, {"absorption", {0.2, 0.1, 1.0}}});
    s.medium("air", {{"ior", 1.0}});
}

}  // namespace

TEST_CASE("overlapping bodies look as those cut to shape: rough glass and ice with a bubble") {
    auto [scene, expected] = both([](SceneBuilder& s, bool cut) {
        add_media(s);
        add_room(s), add_lamp(s, 1.5);
        const Blocks blocks{{{"class", "dielectric"}, {"alpha", 0.3}}};
        cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
    });
    CHECK(scene.features.body_count == 3);
    CHECK(expected.features.body_count == 0);
    check_same(scene, expected, {64, 96, 16});
}

TEST_CASE("overlapping bodies look as those cut to shape: seen and lit from within, in fog and milk") {
    const Place towards_x{{-0.7, 0.2, 0.2}, {0, -0.70710678118654752, 0, 0.70710678118654752}};
    auto [scene, expected] = both([&](SceneBuilder& s, bool cut) {
        s.medium("glass", {{"ior", 1.5}, {"scattering", {0.6, 0.4, 0.2}}, {"absorption", 0.2}});
        s.medium("ice", {{"ior", 1.31}, {"scattering", {0.2, 0.4, 0.8}}});
        s.medium("air", {{"ior", 1.0}, {"absorption", 0.5}});
        add_box(s, {4, 4, 4}, s.lambertian({0.7, 0.5, 0.3}), true, at(0, 0, 0));
        s.perspective(1.4, towards_x);
        s.rectangle(0.2, 0.2, s.black_emitter(8), at(-0.05, 0.1, 0.1));  // in glass, and in the ice's mesh
        s.rectangle(0.2, 0.2, s.black_emitter(12), facing_x(0.5, -0.1, 0));
        s.rectangle(0.2, 0.2, s.black_emitter(10),
                    {{-0.4, -0.3, 0}, {-0.70710678118654752, 0, 0, 0.70710678118654752}});
        const Blocks blocks{{{"class", "dielectric"}, {"alpha", 0.3}}};
        cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
    });
    check_same(scene, expected, {96, 0, 24}, 0.008);
}

TEST_CASE("overlapping bodies look as those cut to shape: flint in crown glass, by wavelengths") {
    auto [scene, expected] = both([](SceneBuilder& s, bool cut) {
        add_dispersive_media(s);
        add_room(s), add_lamp(s, 2);
        const Blocks blocks{{{"class", "dielectric"}}};
        cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
    });
    CHECK(scene.features.spectral);
    check_same(scene, expected, {192, 0, 0});
}

TEST_CASE("the layers albedo, normal and depth show overlapping bodies as those cut to shape") {
    auto [scene, expected] = both([](SceneBuilder& s, bool cut) {
        add_media(s);
        add_room(s), add_lamp(s, 1.5);
        const Blocks blocks{{{"class", "dielectric"}, {"alpha", 0.3}}};
        cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
    });
    const auto layers = [](Scene& of) {
        RenderSettings settings;
        settings.width = 64, settings.height = 48;
        settings.receiver = of.receivers.front().ref;
        settings.algorithm = Algorithm::backward;
        Renderer renderer(test_device(), of, settings);
        renderer.render_passes(1);
        Image image = renderer.develop();
        renderer.add_aovs(image, 64);
        return image;
    };
    const Image seen = layers(scene), wanted = layers(expected);
    for (const char* name : {"albedo.R", "albedo.G", "normal.X", "normal.Y", "normal.Z", "depth.Z"}) {
        CAPTURE(name);
        const auto a = plane(seen, size_t(find_channel(seen, name)));
        const auto b = plane(wanted, size_t(find_channel(wanted, name)));
        size_t other = 0;
        for (size_t i = 0; i < a.size(); ++i) other += std::fabs(a[i] - b[i]) > 1e-3f;
        CHECK(other <= a.size() / 200);  // samples that pass an edge by a hair
        CHECK(*std::max_element(b.begin(), b.end()) > *std::min_element(b.begin(), b.end()));
    }
}

// What forward rays bring, alone and with backward ones; where the bodies scatter, too.
TEST_SUITE("long") {
    TEST_CASE("overlapping bodies look as those cut to shape: smooth, under a small lamp") {
        auto [scene, expected] = both([](SceneBuilder& s, bool cut) {
            add_media(s);
            add_room(s), add_lamp(s, 2);
            const Blocks blocks{{{"class", "dielectric"}}};
            cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
        });
        check_same(scene, expected, {128, 32, 24}, 0.008);
    }

    TEST_CASE("overlapping bodies look as those cut to shape, by forward rays: flint in crown glass") {
        auto [scene, expected] = both([](SceneBuilder& s, bool cut) {
            add_dispersive_media(s);
            add_room(s), add_lamp(s, 2);
            const Blocks blocks{{{"class", "dielectric"}}};
            cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
        });
        // Powers of two, that wavelengths are spread evenly over the passes: what light of one wavelength
        // brings in 40 passes has an error of 4 % a seed, the same in all pixels; in 64 one of 1.5 %, in 256
        // of 0.1 %.
        check_same(scene, expected, {256, 64, 64});
    }

    TEST_CASE("overlapping bodies look as those cut to shape, by forward rays: milky, smooth or rough") {
        for (const double alpha : {0.0, 0.3}) {
            CAPTURE(alpha);
            auto [scene, expected] = both([&](SceneBuilder& s, bool cut) {
                s.medium("glass", {{"ior", 1.5}, {"scattering", {1.2, 0.8, 0.4}}, {"absorption", 0.2}});
                s.medium(
                    "ice",
                    {{"ior", 1.31}, {"scattering", {0.4, 0.8, 1.6}}, {"phase", {{"class", "rayleigh"}}}});
                s.medium("air", {{"ior", 1.0}, {"absorption", 0.5}});
                add_room(s), add_lamp(s, 1.5);
                const Blocks blocks{{{"class", "dielectric"}, {"alpha", alpha}}};
                cut ? add_cut(s, blocks) : add_overlapping(s, blocks);
            });
            check_same(scene, expected, {48, 64, 16}, 0.015);
        }
    }
}

namespace {

// A tumbler of smooth glass, seen from its side, with water up to the cavity's walls: `overlap` metres into
// them, and `first` says which mesh stands first. Boxes are stretched by their nodes, so that faces that
// coincide differ by rounding.
void add_tumbler(SceneBuilder& s, bool cut, double overlap, bool water_first) {
    add_media(s);
    s.medium("water", {{"ior", 1.33}, {"absorption", {0.9, 0.3, 0.1}}});
    add_room(s), add_lamp(s, 2);
    const json smooth = {{"class", "dielectric"}};
    const glm::dvec3 cavity(1.3, 1.1, 0.9), outer(1.7, 1.5, 1.3);
    const Place place{{0.1, -0.3, 0.2}, {0, 0.2588190451025208, 0, 0.9659258262890683}};
    const auto stretched = [&](const glm::dvec3& size, int material, bool inward) {
        add_box(s, {1, 1, 1}, material, inward, place);
        s.scale_last(size);
    };
    if (cut) {
        stretched(outer, interface(s, smooth, "glass"), false);
        stretched(cavity, interface(s, smooth, "water", "glass"), false);
        return;
    }
    const int glass = body(s, smooth, "glass", 2), water = body(s, smooth, "water", 1);
    const auto add_water = [&] {
        add_box(s, {0.65f, 0.55f, 0.45f}, water, false, place);
        s.scale_last((cavity + overlap) / glm::dvec3(0.65, 0.55, 0.45));
    };
    if (water_first) add_water();
    stretched(outer, glass, false);
    stretched(cavity, glass, true);
    if (!water_first) add_water();
}

}  // namespace

TEST_CASE("water that reaches into its glass, or coincides with its walls, looks as an interface of both") {
    SceneBuilder cut;
    add_tumbler(cut, true, 0, false);
    Scene expected = compile_test_scene(cut.import());
    struct Case {
        double overlap;
        bool water_first;
        Passes passes;
    };
    for (const Case& c : {Case{1e-3, false, {128, 0, 0}}, {0, false, {128, 0, 24}}, {0, true, {128, 0, 0}}}) {
        CAPTURE(c.overlap);
        CAPTURE(c.water_first);
        SceneBuilder s;
        add_tumbler(s, false, c.overlap, c.water_first);
        Scene scene = compile_test_scene(s.import());
        check_same(scene, expected, c.passes);
    }
}
