// Under skies: meters read what was asked for, whichever way light is traced.
#include <doctest/doctest.h>

#include <cmath>

#include "host/scene/live_scene.h"
#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

const json facing_up = {-0.70710678118654752, 0, 0, 0.70710678118654752};

json clear_sky() {
    return {{"class", "sky"},        {"type", 12},    {"diffuse", 12000},
            {"direct", 60000},       {"ground", 0.1}, {"sun", {0.6, 0.5, 0.4}},
            {"color", {0.8, 1, 1.4}}};
}

void add_meter(SceneBuilder& s, const json& meter, const Place& place) {
    s.placed("receiver", meter, place);
    s.document["nodes"].back()["name"] = "meter";
}

}  // namespace

TEST_CASE("an unobstructed meter reads the illuminances of sky and sun, by all algorithms") {
    const double elevation = std::asin(0.5 / std::sqrt(0.77));
    struct Case {
        json sky;
        double lux;
    };
    for (const Case& c : {Case{clear_sky(), 12000 + 60000 * std::sin(elevation)},
                          Case{{{"class", "sky"}, {"type", 5}, {"diffuse", 5000}, {"ground", 0}}, 5000}}) {
        SceneBuilder s;
        s.optics()["environment"] = c.sky;
        s.rectangle(2, 2, s.lambertian(0.4), {{0, 0, 0}, facing_up});
        add_meter(s, {{"class", "illuminance"}, {"size", {1, 1}}, {"resolution", {4, 4}}},
                  {{0, 0, 0}, facing_up});
        Scene scene = compile_test_scene(s.import());
        for (const Algorithm algorithm :
             {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
            CAPTURE(algorithm_name(algorithm));
            RenderPlan plan;
            plan.width = plan.height = 4, plan.receiver = "meter", plan.algorithm = algorithm;
            plan.passes = 256, plan.forward_paths = 256;
            const Estimates e = render_estimates(scene, plan);
            double mean = 0,
                   square = 0;  // of the seeds' luminances: the two lights have colours of their own
            for (const auto& image : e.images) {
                double sum = 0;
                for (size_t i = 0; i < image.size(); i += 3)
                    sum += 0.2126 * image[i] + 0.7152 * image[i + 1] + 0.0722 * image[i + 2];
                sum /= double(image.size() / 3);
                mean += sum / e.seeds, square += sum * sum / e.seeds;
            }
            const double error = std::sqrt(std::max(0.0, square - mean * mean) / (e.seeds - 1));
            MESSAGE(mean, " +- ", error, " lx");
            CHECK(std::fabs(mean - c.lux) < 4 * error + 2e-5 * c.lux);
            CHECK(error < 0.003 * c.lux);
        }
    }
}

// A court: walls throw shadows of the sun, and light of it back; a ball of glass gathers it.
TEST_CASE("in a court under sky and sun, backward, forward and both ways agree") {
    SceneBuilder s;
    s.optics()["environment"] = clear_sky();
    s.rectangle(3, 3, s.lambertian({0.5, 0.4, 0.3}), {{0, 0, 0}, facing_up});
    s.rectangle(3, 1.5, s.lambertian(0.7), at(0, 0.75, -1.5));
    add_box(s, {0.6f, 0.8f, 0.3f}, s.lambertian(0.6), false, at(0.5, 0.4, 0.2));
    add_meter(s, {{"class", "illuminance"}, {"size", {2, 1.5}}, {"resolution", {32, 24}}},
              {{0, 0.01, 0}, facing_up});
    Scene scene = compile_test_scene(s.import());
    check_against_backward(scene,
                           {.backward = 256, .forward = 1024, .bidirectional = 64, .receiver = "meter"});
}

TEST_CASE(
    "a sky that is edited shines as one of a file with the new values, and the one before it as before") {
    const auto court = [](const json& sky) {
        SceneBuilder s;
        s.optics()["environment"] = sky;
        s.sphere(0.5, s.lambertian(0.5), at(0, 0, 0));
        add_meter(s, {{"class", "illuminance"}, {"size", {2, 2}}, {"resolution", {8, 8}}},
                  {{0, -0.6, 0}, facing_up});
        return s;
    };
    const auto read = [](Scene& scene) {
        RenderPlan plan;
        plan.width = plan.height = 8, plan.passes = 64, plan.seeds = 2;
        return window_mean(render_estimates(scene, plan)).mean;
    };
    const TemporaryFolder folder;
    json sky = clear_sky();
    write_text(folder / "scene.gltf", court(sky).document.dump());
    LiveScene live(test_device(), folder / "scene.gltf", test_options());
    const std::shared_ptr<Scene> before = live.scene();
    const double lux = read(*before);
    const auto objects = live.objects();
    const auto environment = std::find_if(objects.begin(), objects.end(), [](const LiveObject& o) {
        return o.part == LiveObject::Part::environment;
    });
    REQUIRE(environment != objects.end());
    for (const auto& [name, value] :
         {std::pair<std::string, json>("sun", {-0.2, 0.9, 0.1}), {"type", 3}, {"direct", 0}}) {
        CAPTURE(name);
        sky[name] = value;
        const std::shared_ptr<Scene> next = live.set_parameter(*environment, name, value);
        live.accept();
        Scene fresh = compile_test_scene(court(sky).import());
        const double now = read(*next);
        CHECK(now == doctest::Approx(read(fresh)).epsilon(1e-4));
        CHECK(std::fabs(now - lux) > 0.01 * lux);
    }
    CHECK(read(*before) == doctest::Approx(lux).epsilon(1e-6));
    CHECK_THROWS(live.set_parameter(*environment, "type", 16));
}
