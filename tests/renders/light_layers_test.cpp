// Layers that hold only light which has come a certain way: their sum is the image, one of a lamp is the
// image by that lamp alone, one of light that has not met an object the image with that object black, and
// light that has been scattered once is as bright as its integral; by rays of every kind.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/gltf/gltf.h"
#include "host/gltf/light_layers.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/phase_cases.h"
#include "tests/support/source_path.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
const Algorithm all_algorithms[] = {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional};

std::vector<LightLayer> layers_of(const json& list) {
    const std::string place = "layers";
    return read_layers({&list, "", &place});
}

int named(SceneBuilder& s, const std::string& name, const json& optics) {
    return s.material(optics, {{"name", name}});
}
json surface(const json& of) { return {{"surface", of}}; }
void name_last(SceneBuilder& s, const std::string& name) { s.document["nodes"].back()["name"] = name; }

// The image of the layer `index` of those that stand one below the other; 0 = of all light.
Estimates image_of(const Estimates& all, uint32_t index, uint32_t height) {
    Estimates one = all;
    one.height = height;
    const size_t values = 3 * size_t(height) * all.width, first = values * index;
    const auto cut = [&](auto& list) {
        list = {list.begin() + ptrdiff_t(first), list.begin() + ptrdiff_t(first + values)};
    };
    cut(one.mean);
    for (auto& image : one.images) cut(image);
    return one;
}

struct Lamps {
    bool ceiling = true, ball = true;
};

// In haze, over a diffuse floor: a mirror and a ball of glass behind a pane, under a lamp and beside a ball
// of light.
SceneBuilder two_lamps(const Lamps& lamps, bool black_mirror = false, bool black_glass = false) {
    SceneBuilder s;
    s.medium("haze", {{"scattering", 0.1}, {"absorption", 0.02}, {"phase", lobe_phase(0.4).record}});
    s.medium("glass", {{"ior", 1.5}});
    const json absorber = surface({{"class", "absorber"}});
    s.rectangle(4, 4, s.lambertian({0.7, 0.6, 0.5}), at(0, 0, 0));
    add_box(s, {5, 5, 4}, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "haze"}}), false,
            at(0, 0, 1.5));
    name_last(s, "haze box");
    s.rectangle(
        1, 1,
        named(s, "mirror", black_mirror ? absorber : surface({{"class", "conductor"}, {"reflectance", 0.9}})),
        facing_x(-1, 0, 0.5));
    s.sphere(
        0.35,
        named(s, "ball",
              black_glass
                  ? absorber
                  : json{{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}, {"outside", "haze"}}),
        at(0.6, 0.1, 0.4));
    name_last(s, "glass ball");
    s.rectangle(0.7, 0.7, named(s, "pane", surface({{"class", "thin_dielectric"}})), facing_x(0.1, 0, 0.5));
    const auto lamp = [&](const json& radiance, const char* name) {
        return named(s, name, {{"surface", {{"class", "absorber"}}}, {"emission", {{"radiance", radiance}}}});
    };
    if (lamps.ceiling) s.rectangle(0.5, 0.5, lamp({6, 5, 4}, "ceiling"), facing_down(0, 0.3, 2.4));
    if (lamps.ball) s.sphere(0.15, lamp({3, 6, 9}, "beside"), at(0.3, -0.9, 0.9));
    if (lamps.ball) name_last(s, "ball lamp");
    s.orthographic(1.2, at(0, 0, 3));
    return s;
}

RenderPlan plan_of(Algorithm algorithm, uint32_t first_seed, const std::vector<LightLayer>& layers = {}) {
    RenderPlan plan;
    plan.width = 16, plan.height = 16, plan.seeds = 8, plan.first_seed = first_seed;
    plan.algorithm = algorithm, plan.layers = layers, plan.merge_radius = 0.2f;
    plan.passes = algorithm == Algorithm::backward ? 128 : 64;
    return plan;
}

// With these tiny images that are mostly noise free in layers without light, tiles say more than pixels.
void check_same(const Estimates& layer, const Estimates& expected, const std::string& what) {
    CAPTURE(what);
    const Agreement tiles = agreement(layer, expected, 4), all = agreement(layer, expected, 16);
    MESSAGE(what, ": tiles ", describe(tiles));
    CHECK(tiles.holds);
    CHECK(all.holds);
    const WindowMean mean = window_mean(expected);
    CHECK(mean.mean > 0);
    CHECK(mean.standard_error < 0.03 * mean.mean);
}

// Every value of the images, of all light and then of the layers.
std::vector<std::vector<float>> render_once(Scene& scene, const RenderPlan& plan, Schedule schedule) {
    RenderPlan once = plan;
    once.seeds = 1, once.schedule = schedule;
    const Estimates e = render_estimates(scene, once);
    std::vector<std::vector<float>> images;
    const size_t values = 3 * size_t(plan.width) * plan.height;
    for (size_t first = 0; first < e.images[0].size(); first += values)
        images.emplace_back(e.images[0].begin() + ptrdiff_t(first),
                            e.images[0].begin() + ptrdiff_t(first + values));
    return images;
}

}  // namespace

TEST_CASE("layers of light sum up to the image, which is the same as without them") {
    const std::vector<LightLayer> layers = layers_of(json::parse(R"([
        {"name": "twice reflected", "events": ["reflected"], "times": 2},
        {"name": "refracted", "events": ["refracted"]},
        {"name": "scattered or seen", "events": ["scattered", "emitted"], "most": 2}])"));
    for (const char* name : {"caustic_box", "glass_in_fog", "prism"}) {
        Scene scene = compile_test_scene(import_gltf(source_path("scenes/" + std::string(name) + ".gltf")));
        for (const Algorithm algorithm : all_algorithms) {
            RenderPlan plan = plan_of(algorithm, 1);
            plan.passes = 8;
            const auto plain = render_once(scene, plan, Schedule::fused);
            plan.layers = layers;
            const auto fused = render_once(scene, plan, Schedule::fused);
            CAPTURE(name);
            const std::string by = algorithm_name(algorithm);
            CAPTURE(by);
            REQUIRE(fused.size() == 5);  // with the rest
            double difference = 0, remainder = 0, whole = 0;
            for (size_t i = 0; i < plain[0].size(); ++i) {
                double sum = 0, unit = 1e-9;  // colours of wavelengths may be negative
                for (size_t layer = 1; layer < fused.size(); ++layer) {
                    sum += double(fused[layer][i]);
                    unit += std::fabs(double(fused[layer][i]));
                }
                difference = std::max(difference, std::fabs(double(fused[0][i]) - plain[0][i]) / unit);
                remainder = std::max(remainder, std::fabs(sum - fused[0][i]) / unit);
                whole += fused[0][i];
            }
            MESSAGE(std::string(name), " ", by, ": sum off by ", remainder, ", image by ", difference);
            CHECK(whole > 0);
            CHECK(remainder < 1e-5);
            CHECK(difference < 1e-5);
            CHECK(render_once(scene, plan, Schedule::wavefront) == fused);
            if (algorithm == Algorithm::bidirectional)  // which has all that its kernels do alone
                CHECK(render_once(scene, plan, Schedule::by_class) == fused);
        }
    }
}

TEST_CASE("the layer of a lamp is the image by that lamp alone") {
    Scene both = compile_test_scene(two_lamps({}).import()),
          ceiling = compile_test_scene(two_lamps({true, false}).import()),
          ball = compile_test_scene(two_lamps({false, true}).import());
    const std::vector<LightLayer> groups = light_groups(both);
    REQUIRE(groups.size() == 2);
    CHECK(groups[0].name == "ball lamp");  // in alphabetical order
    for (const Algorithm algorithm : all_algorithms) {
        const Estimates layers = render_estimates(both, plan_of(algorithm, 1, groups));
        REQUIRE(layers.height == 3 * 16);  // and no rest
        const std::string by = algorithm_name(algorithm);
        check_same(image_of(layers, 2, 16), render_estimates(ceiling, plan_of(algorithm, 1001)),
                   by + ", ceiling");
        check_same(image_of(layers, 1, 16), render_estimates(ball, plan_of(algorithm, 2001)), by + ", ball");
    }
}

TEST_CASE("light that has not met an object is the image with that object black") {
    Scene scene = compile_test_scene(two_lamps({}).import()),
          no_mirror = compile_test_scene(two_lamps({}, true).import()),
          no_glass = compile_test_scene(two_lamps({}, false, true).import());
    // By the name of a material, and by that of a node.
    const std::vector<LightLayer> mirror =
        layers_of(json::parse(R"([{"name": "by mirror", "events": ["reflected"], "objects": ["mirror"]}])"));
    const std::vector<LightLayer> glass =
        layers_of(json::parse(R"([{"name": "without", "without": ["glass ball"]}])"));
    for (const Algorithm algorithm : all_algorithms) {
        const std::string by = algorithm_name(algorithm);
        const Estimates by_mirror = render_estimates(scene, plan_of(algorithm, 1, mirror));
        REQUIRE(by_mirror.height == 3 * 16);
        CHECK(window_mean(image_of(by_mirror, 1, 16)).mean >
              0.02 * window_mean(image_of(by_mirror, 0, 16)).mean);
        check_same(image_of(by_mirror, 2, 16), render_estimates(no_mirror, plan_of(algorithm, 1001)),
                   by + ", mirror");
        const Estimates without = render_estimates(scene, plan_of(algorithm, 3001, glass));
        CHECK(window_mean(image_of(without, 2, 16)).mean > 0.02 * window_mean(image_of(without, 0, 16)).mean);
        check_same(image_of(without, 1, 16), render_estimates(no_glass, plan_of(algorithm, 2001)),
                   by + ", glass");
    }
}

TEST_CASE("light that a slab has scattered once is as bright as its integral") {
    SceneBuilder s;
    const double scattering = 0.8, absorption = 0.4, sun = 3, extinction = scattering + absorption;
    s.medium("haze", {{"scattering", scattering}, {"absorption", absorption}});
    add_box(s, {5, 4, 1},
            s.material({{"surface", {{"class", "boundary"}}}, {"inside", "haze"}}, {{"name", "skin"}}), false,
            at(0, 0, -0.5));
    s.light({{"type", "directional"}, {"intensity", sun}},
            {{0, 0, 0}, {0, std::sin(-pi / 12), 0, std::cos(pi / 12)}});
    s.orthographic(0.5, at(0, 0, 2));
    Scene scene = compile_test_scene(s.import());
    const std::vector<LightLayer> layers = layers_of(json::parse(R"([
        {"name": "never", "events": ["scattered"], "times": 0},
        {"name": "unskinned", "events": ["straight"], "objects": ["skin"], "most": 1},
        {"name": "once", "events": ["scattered"], "objects": ["haze"], "times": 1},
        {"name": "twice", "events": ["scattered"], "times": 2},
        {"name": "further", "events": ["scattered"], "least": 3}])"));
    const double cosine = std::cos(pi / 6), both = extinction * (1 + 1 / cosine);
    const double expected = sun / (4 * pi) * scattering * (1 - std::exp(-both)) / both;
    double twice[3] = {};
    for (size_t a = 0; a < 3; ++a) {
        RenderPlan plan = plan_of(all_algorithms[a], 1, layers);
        plan.passes = 64, plan.forward_paths = all_algorithms[a] == Algorithm::forward ? 64 : 4;
        const Estimates all = render_estimates(scene, plan);
        const auto mean = [&](uint32_t layer) { return window_mean(image_of(all, layer, 16)); };
        const WindowMean once = mean(3);
        const std::string by = algorithm_name(all_algorithms[a]);
        CAPTURE(by);
        MESSAGE(by, ": ", once.mean / expected, " +- ", once.standard_error / expected);
        REQUIRE(all.height == 7 * 16);
        for (const uint32_t none : {1u, 2u, 6u}) CHECK(mean(none).mean == 0);  // and the rest
        CHECK(std::fabs(once.mean - expected) < 4 * once.standard_error);
        CHECK(once.standard_error < 0.01 * expected);
        twice[a] = mean(4).mean;
        CHECK(twice[a] > 0.1 * expected);
        CHECK(std::fabs(twice[a] - twice[0]) < 0.03 * twice[0]);
    }
}

// A ball of light over a white disk that lies about the lower directions.
TEST_CASE("receivers far away have layers, too, and receptors of meters are no objects") {
    SceneBuilder s;
    const double radius = 0.1, radiance = 5, intensity = radiance * pi * radius * radius;
    s.sphere(radius, s.black_emitter(radiance), at(0, 0, 0.5));
    s.shape({{"class", "disk"}, {"radius", 1}},
            named(s, "disk", surface({{"class", "lambertian"}, {"reflectance", 1}})), at(0, 0, 0));
    s.placed("receiver", {{"class", "intensity"}, {"resolution", {8, 9}}}, facing_down(0, 0, 0));
    name_last(s, "gonio");
    s.placed("receiver", {{"class", "illuminance"}, {"size", {0.01, 0.01}}, {"resolution", {1, 1}}},
             at(0, 0, 0.1));
    name_last(s, "meter");
    Scene scene = compile_test_scene(s.import());
    const std::vector<LightLayer> layers = layers_of(
        json::parse(R"([{"name": "direct", "events": ["reflected", "refracted", "straight"], "times": 0},
                                  {"name": "by disk", "objects": ["disk"], "times": 1}])"));
    for (const Algorithm algorithm : all_algorithms) {
        const std::string by = algorithm_name(algorithm);
        CAPTURE(by);
        RenderPlan plan = plan_of(algorithm, 1, layers);
        plan.receiver = "gonio", plan.width = 8, plan.height = 9, plan.forward_paths = 16;
        const Estimates far = render_estimates(scene, plan);
        if (algorithm != Algorithm::backward) {  // rays seldom hit a lamp from afar
            // Upwards all is direct; nearly level directions have the disk's light, too.
            const Estimates direct = image_of(far, 1, 9), by_disk = image_of(far, 2, 9);
            const Window upper{0, 1, 8, 2};
            const WindowMean all = window_mean(image_of(far, 0, 9), upper),
                             alone = window_mean(direct, upper);
            CHECK(alone.mean == doctest::Approx(intensity).epsilon(0.02));
            CHECK(window_mean(by_disk, upper).mean == doctest::Approx(all.mean - alone.mean).epsilon(1e-4));
            CHECK(window_mean(by_disk, upper).mean > 0.05 * alone.mean);
            CHECK(window_mean(image_of(far, 3, 9)).mean == 0);
        }
        plan.receiver = "meter", plan.width = plan.height = 1, plan.forward_paths = 4096;
        const Estimates near = render_estimates(scene, plan);
        const WindowMean lit = window_mean(image_of(near, 1, 1));
        // A sphere that is seen as a whole, from its centre's distance: E = pi L (r / d)².
        CHECK(std::fabs(lit.mean - pi * radiance * std::pow(radius / 0.4, 2)) <
              4 * lit.standard_error + 1e-4);
        CHECK(window_mean(image_of(near, 2, 1)).mean == 0);
    }
}

// A lamp above and one below a floor, whose meter tells illuminance of front and back, exitance of front and
// back.
TEST_CASE("what leaves a surface has layers, as what comes to it") {
    SceneBuilder s;
    s.mesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3}, s.lambertian(0.6),
           at(0, 0, 0));
    name_last(s, "floor");
    for (const double z : {1.0, -1.0}) {
        s.sphere(0.2, s.black_emitter(5), at(0, 0, z));
        name_last(s, z > 0 ? "upper" : "lower");
    }
    s.placed("receiver", {{"class", "surface"}, {"mesh", "floor"}}, at(0, 0, 0));
    name_last(s, "meter");
    Scene scene = compile_test_scene(s.import());
    const std::vector<LightLayer> layers = layers_of(
        json::parse(R"([{"name": "upper", "objects": ["upper"]}, {"name": "lower", "objects": ["lower"]}])"));
    for (const Algorithm algorithm : all_algorithms) {
        const std::string by = algorithm_name(algorithm);
        CAPTURE(by);
        RenderPlan plan = plan_of(algorithm, 1, layers);
        plan.receiver = "meter", plan.width = 2, plan.height = 4, plan.forward_paths = 1024;
        const Estimates all = render_estimates(scene, plan);
        for (const uint32_t lamp : {1u, 2u}) {
            CAPTURE(lamp);
            const Estimates layer = image_of(all, lamp, 4);
            const auto part = [&](uint32_t row) { return window_mean(layer, {0, row, 2, 1}); };
            const WindowMean comes = part(lamp - 1), leaves = part(lamp + 1);
            CHECK(comes.mean > 0.1);
            CHECK(leaves.mean / comes.mean == doctest::Approx(0.6).epsilon(0.03));
            CHECK(part(2 - lamp).mean == 0);
            CHECK(part(4 - lamp).mean == 0);
        }
    }
}

TEST_CASE("algorithms agree in every layer of a caustic" * doctest::test_suite("long")) {
    Comparison c;
    c.width = c.height = 16, c.seeds = 8, c.backward = 512, c.largest_error = 0.1, c.tolerance = 0.01;
    c.layers = layers_of(json::parse(R"([
        {"name": "caustic", "all": [{"events": ["refracted"], "objects": ["glass sphere"], "times": 2},
                                    {"events": ["reflected"], "times": 1}]},
        {"name": "mirror", "objects": ["mirror"], "without": ["glass"]}])"));
    Scene scene = compile_test_scene(import_gltf(source_path("scenes/caustic_box.gltf")));
    check_against_backward(scene, c);
}

// Under a ball of glass, seen in a mirror: both ways together the light gets there by merging for the most
// part.
TEST_CASE("algorithms agree in the layer of a caustic that is seen in a mirror") {
    SceneBuilder s;
    s.medium("glass", {{"ior", 1.5}});
    s.rectangle(2, 2, named(s, "floor", surface({{"class", "lambertian"}, {"reflectance", 0.7}})),
                at(0, 0, 0));
    s.sphere(0.2, named(s, "ball", {{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
             at(0, 0, 0.45));
    s.sphere(0.3, s.black_emitter(20), at(0, 0, 1.7));
    const double half =
        -0.5 * std::atan2(0.8, 0.4);  // it turns -z to (-0.8, 0, -0.6), where the ball's shadow is
    s.rectangle(1, 1, named(s, "mirror", surface({{"class", "conductor"}, {"reflectance", 0.9}})),
                {{1.6, 0, 1.2}, {0, std::sin(half), 0, std::cos(half)}});
    s.orthographic(0.1, at(1.6, 0, 3));
    Scene scene = compile_test_scene(s.import());
    Comparison c;
    c.width = c.height = 16, c.seeds = 8, c.forward = 0, c.backward = 4096, c.bidirectional = 512;
    c.largest_error = 0.03, c.tolerance = 0.01;
    c.layers =
        layers_of(json::parse(R"([{"name": "floorless", "without": ["floor"]}, {"name": "caustic", "all": [
        {"events": ["refracted"], "objects": ["ball"], "times": 2},
        {"events": ["reflected"], "objects": ["floor"], "times": 1},
        {"events": ["reflected"], "objects": ["mirror"], "times": 1}]}])"));
    for (const Algorithm algorithm : all_algorithms) {
        const Estimates all = render_estimates(scene, plan_of(algorithm, 1, c.layers));
        CHECK(window_mean(image_of(all, 1, 16)).mean == 0);  // there is nothing else to see in the mirror
        CHECK(window_mean(image_of(all, 2, 16)).mean > 0);
    }
    c.layers.erase(c.layers.begin());
    check_against_backward(scene, c);
}
