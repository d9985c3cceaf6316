// The mean square error of unbiased algorithms falls as 1 / passes.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "host/bench/statistics.h"
#include "tests/renders/agreement_scenes.h"

using namespace etendue;

namespace {

// Of images of one seed each, relative to the mean of all: without bias (which other tests look for) all of
// the error.
double relative_variance(const Estimates& e) {
    double sum = 0;
    for (size_t i = 0; i < e.mean.size(); ++i)
        for (const auto& image : e.images) sum += std::pow(image[i] / e.mean[i] - 1, 2);
    return sum / double(e.mean.size()) / (e.seeds - 1);
}

}  // namespace

// No surface here is smooth, so nothing is merged. Errors of independent samples fall exactly as 1 / passes;
// those of Sobol' points faster, most over the first passes.
TEST_CASE("backward, forward and bidirectional rays converge as 1 / passes" * doctest::test_suite("long")) {
    SceneBuilder s;
    add_room(s);
    add_lamp(s, 1);
    add_box(s, {1, 2, 1}, s.lambertian(0.6), false, {{-0.8, -1, -0.8}, {0, 0.3, 0, 0.954}});
    s.sphere(0.6, s.surface(metal(0.3)), at(0.8, -1.4, 0.2));
    Scene scene = compile_test_scene(s.import());
    for (const bool independent : {false, true})
        for (const Algorithm algorithm :
             {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
            scene.features.independent_samples = independent;
            const std::string name =
                std::string(algorithm_name(algorithm)) + (independent ? ", independent" : ", sobol");
            CAPTURE(name);
            std::vector<double> x, y;
            for (const uint32_t passes : {16u, 64u, 256u, 1024u}) {
                RenderPlan plan;
                plan.width = 24, plan.height = 18, plan.seeds = 16;
                plan.algorithm = algorithm, plan.passes = passes, plan.first_seed = 100 * passes;
                const double variance = relative_variance(render_estimates(scene, plan));
                MESSAGE(name, ", ", passes, " passes: relative variance ", variance);
                x.push_back(std::log(passes)), y.push_back(std::log(variance));
            }
            const auto fit = fit_line(x, y);
            REQUIRE(fit);
            MESSAGE(name, ": slope ", fit->slope, " +- ", fit->slope_error);
            CHECK(fit->slope < -0.95);
            CHECK(fit->slope > (independent ? -1.05 : -1.1));
        }
}
