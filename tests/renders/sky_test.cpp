// Under skies: meters read what was asked for, whichever way light is traced.
#include <doctest/doctest.h>

#include <cmath>

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
