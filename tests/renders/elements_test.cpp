// Optical elements against the same objects without, in all algorithms, and what must not change by them.
#include <doctest/doctest.h>

#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

const json turned = {0.2, 0.3, -0.1, 0.9273618495495703};  // a quaternion of length 1

// A room with a lamp, a red block and a camera, without what the tests put into it.
SceneBuilder room(bool with_lamp = true) {
    SceneBuilder s;
    add_box(s, {2, 2, 2}, s.lambertian({0.7, 0.7, 0.7}), true, at(0, 0, 0));
    add_box(s, {0.5f, 0.7f, 0.5f}, s.lambertian({0.7, 0.2, 0.1}), false, at(-0.6, -0.65, -0.4));
    if (with_lamp) s.rectangle(1.2, 1.2, s.black_emitter({3, 2.5, 2}), facing_down(0, 0.96, 0));
    s.perspective(0.9, at(0, 0, 0.97));
    s.medium("glass", {{"ior", 1.5}, {"absorption", {0.2, 0.4, 1}}});
    return s;
}
int glass(SceneBuilder& s) {
    return s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
}

json subscene(int scene) { return {{"class", "subscene"}, {"scene", scene}}; }

Estimates backward(const SceneDescription& description, uint32_t passes = 256, uint32_t first_seed = 501) {
    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.passes = passes, plan.first_seed = first_seed;
    return render_estimates(description, plan);
}

// An image without noise.
void check_uniform(const Estimates& e, double value) {
    double least = INFINITY, most = 0;
    for (const double v : e.mean) least = std::min(least, v), most = std::max(most, v);
    CHECK(least == doctest::Approx(value).epsilon(1e-5));
    CHECK(most == doctest::Approx(value).epsilon(1e-5));
}

}  // namespace

TEST_CASE("a ball of glass in an element, ten deep, is as it is without") {
    SceneBuilder plain = room();
    plain.sphere(0.3, glass(plain), at(0.35, -0.3, -0.1));

    SceneBuilder s = room();
    const int material = glass(s);
    const int ball = s.scene([&] { s.sphere(0.3, material, at(0.01, 0.02, 0)); });
    int held = s.scene([&] { s.placed("element", subscene(ball), at(-0.01, -0.02, 0)); });
    for (int depth = 2; depth < 9; ++depth) {
        const int inner = held;
        held = s.scene([&] { s.placed("element", subscene(inner), at(0, 0, 0)); });
    }
    const int last = held;
    held = s.scene([&] { s.placed("element", subscene(last), {{0, 0, 0}, turned}); });
    s.placed("element", subscene(held), at(0.35, -0.3, -0.1));
    Scene scene = compile_test_scene(s.import());
    CHECK(scene.features.elements);

    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.passes = 64;
    plan.merge_radius = 0.1f;
    const Estimates expected = backward(plain.import(), 256);
    check_agreement("backward", render_estimates(scene, plan), expected, 0.002, 0.01);
    plan.algorithm = Algorithm::bidirectional, plan.passes = 32;
    const Estimates both = render_estimates(scene, plan);
    check_agreement("bidirectional", both, expected, 0.002, 0.01);
    const RenderCounters& c = both.counters;
    CHECK(c.emitted ==
          doctest::Approx(c.absorbed + c.forward_escaped + c.roulette + c.forward_depth_limit_lost)
              .epsilon(1e-4));
    plan.algorithm = Algorithm::forward, plan.passes = 64;
    check_agreement("forward", render_estimates(scene, plan), expected, 0.002, 0.01);
}

TEST_CASE("lamps and a camera within elements") {
    SceneBuilder s = room(false);
    s.document["nodes"][0]["children"].erase(2);  // the camera
    const int lamp = s.black_emitter({10, 9, 8});
    const int white = s.lambertian({0.8, 0.8, 0.8});
    const int lamps = s.scene([&] {
        s.rectangle(0.4, 0.4, lamp, facing_down(0, 0.1, 0));
        add_box(s, {0.1f, 0.1f, 0.1f}, white, false, at(0.1, -0.05, 0.05));
    });
    const int mirror = s.surface({{"class", "conductor"}, {"eta", {0.2, 0.9, 1.2}}, {"k", {3.9, 2.4, 2.2}}});
    const int camera = s.scene([&] {
        s.perspective(0.9, at(0, 0, 0.05));
        s.rectangle(0.1, 0.05, mirror, {{0, 0.03, -0.1}, {0.6, 0, 0, 0.8}});
        add_box(s, {0.3f, 0.01f, 0.3f}, white, false, at(0, -0.1, 0));
    });
    s.placed("element", subscene(lamps), at(0.1, 0.7, -0.2));
    s.placed("element", subscene(camera), {{-0.05, 0, 0.7}, {0, 0.1, 0, 0.99498743710662}});
    Scene scene = compile_test_scene(s.import());
    Comparison c;
    c.backward = 256, c.forward = 256, c.bidirectional = 64;
    c.largest_error = 0.01;
    check_against_backward(scene, c);
}

// What happens within has the digits of the element's own frame.
TEST_CASE("an element is the same wherever it stands") {
    std::vector<std::vector<float>> images;
    for (const double metres : {0.0, 1.0, 100.0}) {
        SceneBuilder s = room();
        s.document["nodes"][0]["children"].erase(3);  // the camera
        s.document["nodes"][0]["children"].erase(0);  // the room
        const int white = s.lambertian({0.8, 0.8, 0.8}), lamp = s.black_emitter({10, 9, 8}), clear = glass(s);
        const int inner = s.scene([&] {
            s.perspective(0.9, at(0, 0, 0.4));
            add_box(s, {1, 1, 1}, white, true, at(0, 0, 0));
            s.sphere(0.1, clear, at(0.1, -0.1, 0));
            s.rectangle(0.4, 0.4, lamp, facing_down(0, 0.49, 0));
        });
        s.placed("element", subscene(inner), {{metres, -metres, metres}, turned});
        RenderPlan plan;
        plan.width = 32, plan.height = 24, plan.seeds = 2, plan.passes = 16;
        const Estimates e = render_estimates(s.import(), plan);
        images.push_back(e.images.at(0));
    }
    CHECK(images[0] == images[1]);
    CHECK(images[0] == images[2]);
}

// No ray meets it by chance, and no light is sampled through a boundary: forward rays alone bring its light.
TEST_CASE("a point lamp within an element") {
    const auto build = [](bool element) {
        SceneBuilder s = room(false);
        const auto lamp = [&](const Place& place) {
            s.light({{"type", "point"}, {"intensity", 0.2}}, place);
        };
        const auto place = [&](double x, double y, double z) {
            return element ? at(x, y, z) : at(x, y + 0.8, z + 0.85);
        };
        const int white = s.lambertian({0.8, 0.8, 0.8});
        const auto fill = [&] {
            add_box(s, {0.1f, 0.1f, 0.1f}, white, false, place(0.1, 0, 0.05)), lamp(place(-0.1, 0, 0));
        };
        if (element)
            s.placed("element", subscene(s.scene(fill)), at(0, 0.8, 0.85));
        else
            fill();
        return s.import();
    };
    Scene scene = compile_test_scene(build(true));
    CHECK(scene.unmet_lights.size() == 1);
    RenderPlan plan;
    plan.width = 32, plan.height = 24, plan.seeds = 16, plan.passes = 64, plan.merge_radius = 0.1f;
    plan.algorithm = Algorithm::bidirectional;
    check_agreement("bidirectional", render_estimates(scene, plan), backward(build(false), 128), 0.003, 0.01);
}

TEST_CASE("elements without a surface are invisible, whatever their boundaries touch") {
    SceneBuilder s;
    s.environment({1, 1, 1});
    const int none = s.lambertian({0, 0, 0});
    s.scene([&] { add_box(s, {0.2f, 0.2f, 0.2f}, none, false, at(0, 0, 0)); });  // in no element: mesh 0
    const int empty = s.scene([] {});
    json element = subscene(empty);
    element["boundary"] = 0;
    for (int i = -2; i <= 2; ++i) s.placed("element", element, at(0.2 * i, 0, 0));  // they share faces
    s.placed("element", element, {{0, 0.5, 0}, turned});
    s.perspective(0.9, at(0, 0.1, 1));
    const SceneDescription description = s.import();
    CHECK(description.contents.size() == 1);
    check_uniform(backward(description, 4), 1);
}

// The cube fills its element to the brim, and stands on a plate that touches it.
TEST_CASE("glass that touches the boundary of its element from both sides") {
    const auto build = [](bool element) {
        SceneBuilder s = room();
        const int material = glass(s);
        // Without an element the two must stand apart, or rays could not tell their faces from each other.
        add_box(s, {0.4f, 0.1f, 0.4f}, material, false, at(0.3, element ? -0.6 : -0.6003, 0));
        const auto cube = [&](const Place& place) { add_box(s, {0.4f, 0.4f, 0.4f}, material, false, place); };
        if (!element) {
            cube(at(0.3, -0.35, 0));
        } else {
            json object = subscene(s.scene([&] { cube(at(0, 0, 0)); }));
            object["boundary"] = s.document["meshes"].size() - 1;
            s.placed("element", object, at(0.3, -0.35, 0));
        }
        return s.import();
    };
    check_agreement("touching", backward(build(true), 128, 1), backward(build(false), 128), 0.002, 0.01);
}

TEST_CASE("polarized light and fog pass into an element and out of it") {
    const auto build = [](bool element) {
        SceneBuilder s;
        s.rectangle(3, 3, s.material({{"surface", {{"class", "linear_polarizer"}, {"axis", 0.4}}}}),
                    {{0, 0, -1}, turned});
        s.rectangle(8, 8, s.black_emitter({3, 2, 1}), at(0, 0, -3));
        s.medium("fog", {{"scattering", 0.8}, {"absorption", 0.3}});
        const int cloud = s.material({{"surface", {{"class", "boundary"}}}, {"inside", "fog"}});
        const int retarder =
            s.material({{"surface", {{"class", "retarder"}, {"axis", 0.9}, {"retardance", 1.2}}}});
        const auto fill = [&](const json& turn) {
            s.rectangle(0.5, 0.5, retarder, {{0, 0, 0}, turn});
            s.sphere(0.4, cloud, {{0, 0, 0}, turn});
        };
        if (element)
            s.placed("element", subscene(s.scene([&] { fill({0, 0, 0, 1}); })), {{0, 0, 0}, turned});
        else
            fill(turned);
        s.perspective(0.9, at(0, 0, 1.2));
        s.document["nodes"].back()["extensions"]["ETD_optics"]["receiver"] = {{"stokes", true}};
        return s.import();
    };
    RenderPlan plan;
    plan.width = 16, plan.height = 16, plan.seeds = 16, plan.passes = 128, plan.stokes = true;
    const Estimates expected = render_estimates(build(false), plan);
    plan.first_seed = 701;
    check_agreement("Stokes images", render_estimates(build(true), plan), expected, 0.003, 0.02, 4);
}
