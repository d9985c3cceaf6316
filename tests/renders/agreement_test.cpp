// Forward, backward and bidirectional rays give the same image: at any scale, of true instances, and through
// textures of alpha.
#include <doctest/doctest.h>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

// Glass that absorbs, a mirror and a rough metal in a room with two lights, of which every length is `scale`
// times as large.
SceneBuilder scaled_room(double scale) {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1.5);
    // On the wall behind, past glass and mirror: backward rays never find what these make of such a light.
    s.light({{"type", "spot"},
             {"intensity", 4 * scale * scale},
             {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
            at(1.2, 0.8, 0.5));
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.1 / scale, 0.2 / scale, 0.4 / scale}}});  // 1/m
    s.sphere(0.6, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
             at(-0.9, -1.2, 0.2));
    s.sphere(0.5, s.surface(metal(0)), at(0.2, -1.3, -0.7));
    s.sphere(0.5, s.surface(metal(0.2)), at(1.1, -1.4, 0.1));
    s.transform({0, 0, 0}, scale);
    return s;
}

// In the order of the scene's nodes.
struct Copy {
    Place place;
    glm::dvec3 scale{1};
};
void add_copies(SceneBuilder& s, const std::vector<Copy>& copies) {
    for (size_t i = 0; i < copies.size(); ++i) {
        if (i > 0) s.mesh_copy(copies[i].place);
        s.scale_last(copies[i].scale);
    }
}

// Alpha of the texel whose centre is (u, v). Images hold none yet: SceneBuilder's textures are opaque.
template <class F>
void set_alpha(ImageDescription& image, F alpha) {
    REQUIRE(image.rgba8.size() == size_t(image.width) * image.height * 4);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            image.rgba8[4 * (size_t(y) * image.width + x) + 3] =
                uint8_t(255 * alpha((x + 0.5) / image.width, (y + 0.5) / image.height) + 0.5);
}

}  // namespace

TEST_SUITE("long") {
    TEST_CASE("algorithms agree: a scene a thousandth and a thousand times as large") {
        RenderPlan plan;
        plan.width = 32, plan.height = 24, plan.seeds = 16;
        plan.merge_radius = 0.1f;
        plan.passes = 256;
        const Estimates expected = render_estimates(scaled_room(1).import(), plan);
        for (const double scale : {1e-3, 1e3}) {
            CAPTURE(scale);
            Scene scene = compile_test_scene(scaled_room(scale).import());
            plan.algorithm = Algorithm::backward, plan.passes = 256, plan.first_seed = 101;
            check_agreement("backward", render_estimates(scene, plan), expected, 0.002);
            plan.algorithm = Algorithm::forward, plan.passes = 128, plan.first_seed = 1001;
            check_agreement("forward", render_estimates(scene, plan), expected, 0.002);
            plan.algorithm = Algorithm::bidirectional, plan.passes = 64, plan.first_seed = 2001;
            check_agreement("bidirectional", render_estimates(scene, plan), expected, 0.002);
        }
    }

    TEST_CASE("algorithms agree: instances, mirrored and scaled by axis, and the same merged") {
        SceneBuilder s;
        add_room(s);
        add_lamp(s, 1.5);
        // So many triangles that the copies stay instances (host/geometry/world.cpp: 65536).
        add_sphere_mesh(s, 0.5f, 128, 66, s.surface(metal(0.2)), at(1.2, -1.5, 0.3));
        add_copies(s, {{{}, {1, 1, 1}},
                       {at(0.1, -1.6, -0.9), {-1, 0.7, 1.2}},
                       {{{-1.3, -1.2, -0.9}, {0.1, 0.2, 0.3, 0.927}}, {1.3, 0.6, 0.9}},
                       {{{1.3, -0.3, -0.6}, {0.3, -0.2, 0.1, 0.927}}, {0.7, 1, -0.5}}});
        s.medium("glass", {{"ior", 1.5}, {"absorption", {0.1, 0.2, 0.4}}});
        add_sphere_mesh(s, 0.5f, 182, 94,
                        s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                        at(-1, -1.4, 0.5));
        add_copies(s, {{{}, {1.1, 1, 0.9}}, {{{0.2, -1.5, 0.6}, {0.2, 0.1, 0.2, 0.954}}, {0.8, -0.6, 1}}});
        SceneDescription description = s.import();
        Scene scene = compile_test_scene(description);
        REQUIRE(scene.instances == 6);
        check_against_backward(scene, {});

        // Each copy as a mesh of its own: the same seeds go the same ways, but for rounding.
        std::vector<bool> used(description.meshes.size());
        for (MeshInstance& instance : description.instances)
            if (used[instance.mesh]) {
                description.meshes.push_back(MeshDescription(description.meshes[instance.mesh]));
                instance.mesh = uint32_t(description.meshes.size()) - 1;
            } else {
                used[instance.mesh] = true;
            }
        Scene merged = compile_test_scene(description);
        REQUIRE(merged.instances == 0);
        RenderPlan plan;
        plan.width = 32, plan.height = 24, plan.seeds = 16, plan.passes = 64;
        const Estimates ours = render_estimates(scene, plan), theirs = render_estimates(merged, plan);
        const Agreement tiles = agreement(ours, theirs, 8);
        const WindowMean a = window_mean(ours), b = window_mean(theirs);
        MESSAGE("instances and merged: ", a.mean, " and ", b.mean, "; tiles ", describe(tiles));
        CHECK(tiles.holds);
        CHECK(tiles.rms_z < 1.4);
        CHECK(a.mean == doctest::Approx(b.mean).epsilon(0.001));
        // Normals are interpolated before the scale or after it, so where the noise is the same in both,
        // facets of 3 degrees leave a difference.
        for (size_t i = 0; i < ours.mean.size(); ++i)
            CHECK(ours.mean[i] == doctest::Approx(theirs.mean[i]).epsilon(0.1));
    }

    TEST_CASE("algorithms agree: foils with holes and shades by textures of alpha") {
        const TemporaryFolder folder;
        SceneBuilder s;
        add_room(s);
        add_lamp(s, 1.2);
        // No point: backward rays must meet it in glass and mirror.
        s.sphere(0.3, s.black_emitter({6, 4, 3}), at(1.2, 1.2, 0.6));
        const auto foil = [&](const char* name, const char* mode) {
            const int texture =
                add_texture(s, folder, name, 16, [](float u, float v) { return glm::vec3(u, v, 0.5f); });
            return s.material(json::object(), {{"alphaMode", mode},
                                               {"doubleSided", true},
                                               {"pbrMetallicRoughness",
                                                {{"baseColorTexture", {{"index", texture}}},
                                                 {"metallicFactor", 0.0},
                                                 {"roughnessFactor", 0.6}}}});
        };
        const int holes = foil("holes", "MASK"), shades = foil("shades", "BLEND");
        s.rectangle(2.2, 2.2, holes, hanging(-0.6, 0.7, 0));
        s.rectangle(2.2, 2.2, shades, hanging(0.7, 0.2, -0.4));
        s.rectangle(1, 1, shades, at(-0.5, -0.3, 1));  // before the camera
        s.rectangle(0.8, 0.8, holes, at(0.5, -0.5, 0.9));
        s.sphere(0.6, s.surface(metal(0)), at(-0.9, -1.3, -0.3));
        s.medium("glass", {{"ior", 1.5}});
        s.sphere(0.5, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                 at(0.8, -1.4, 0));
        SceneDescription description = s.import(folder / "scene.gltf");
        REQUIRE(description.images.size() == 2);
        set_alpha(description.images[0], [](double u, double v) {  // checks, blurred at their edges
            return 0.5 + 0.5 * std::sin(20 * u) * std::sin(20 * v);
        });
        set_alpha(description.images[1], [](double u, double v) { return u * (1 - v); });
        Scene scene = compile_test_scene(description);
        check_against_backward(scene, {});
    }
}
