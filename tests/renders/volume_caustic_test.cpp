// A caustic within a medium: a glass ball throws the light of a point, which no ray meets, into haze. Seen
// straight, forward rays bring it; seen through a plate of glass only merging does, or, where the plate is
// not quite smooth, connections at the plate, too. The plate stands behind the camera or before it, and
// parallel rays that meet it upright lose what Fresnel's equations say: all that sets the two images apart.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"
#include "tests/support/density_field.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr uint32_t pixels = 24;
constexpr double view = 1.6;  // m
// Below the ball, in which forward rays alone cannot show the caustic, by more than the radius of merging.
const Window window = {0, pixels / 2 + 2, pixels, pixels / 2 - 2};

struct Haze {
    json medium;
    double alpha = 0;  // of ball and plate
    bool connect = true;
};

json coloured_haze() {
    return {{"scattering", {1.2, 0.8, 0.5}},
            {"absorption", {0.05, 0.1, 0.4}},
            {"phase", {{"class", "henyey_greenstein"}, {"g", 0.4}}}};
}

SceneBuilder ball_in_haze(const Haze& haze, bool behind_plate) {
    SceneBuilder s;
    s.medium("haze", haze.medium);
    s.medium("lens", {{"ior", 1.2}});  // the light narrows towards a focus beyond what is seen
    s.medium("plate", {{"ior", 1.5}});
    add_box(s, {2, 2, 1.2f}, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "haze"}}), false,
            at(0, 0, 0));
    s.sphere(0.5,
             s.material({{"surface", {{"class", "dielectric"}, {"alpha", haze.alpha}}},
                         {"inside", "lens"},
                         {"outside", "haze"}}),
             at(0, 0.45, 0));
    add_box(s, {4, 4, 0.2f},
            s.material({{"surface", {{"class", "dielectric"}, {"alpha", haze.alpha}}}, {"inside", "plate"}}),
            false, at(0, 0, 1.4));
    s.light(
        {{"type", "spot"}, {"intensity", 50}, {"spot", {{"innerConeAngle", 0.08}, {"outerConeAngle", 0.1}}}},
        hanging(0, 6, 0));
    s.document["nodes"].back()["rotation"] = {-0.70710678118654752, 0, 0, 0.70710678118654752};
    s.orthographic(view / 2, at(0, 0, behind_plate ? 2.0 : 1.2));
    return s;
}

Estimates render(const SceneBuilder& s, const std::filesystem::path& file, Algorithm algorithm, double radius,
                 uint32_t passes, bool connect = true) {
    RenderPlan plan;
    plan.connect = connect;
    plan.width = plan.height = pixels;
    plan.seeds = 12, plan.passes = passes, plan.algorithm = algorithm;
    plan.first_seed = algorithm == Algorithm::forward ? 1 : 1001;
    plan.forward_paths = algorithm == Algorithm::forward ? 32 : 6;
    plan.merge_radius = float(radius * pixels / view);
    return render_estimates(s.import(file), plan);
}

// `radius`: of merging in the first pass, m. `loss`: that a ball which reaches out of the haze may cause.
void check_caustic(const Haze& haze, double radius, double loss,
                   const std::filesystem::path& file = "scene.gltf") {
    const double r = 0.04, plate = (1 - r) / (1 + r);
    const Estimates expected = render(ball_in_haze(haze, false), file, Algorithm::forward, radius, 12);
    for (const bool behind_plate : {false, true}) {
        const Estimates seen = render(ball_in_haze(haze, behind_plate), file, Algorithm::bidirectional,
                                      radius, behind_plate ? 64 : 12, haze.connect);
        const double factor = behind_plate ? plate : 1;
        for (int c = 0; c < 3; ++c) {
            const WindowMean theirs = window_mean(expected, window, c), ours = window_mean(seen, window, c);
            const double wanted = factor * theirs.mean;
            const double error = std::hypot(ours.standard_error, factor * theirs.standard_error) / wanted;
            CAPTURE(behind_plate);
            CAPTURE(c);
            MESSAGE("plate ", behind_plate, ": ", 100 * (ours.mean / wanted - 1), " % +- ", 100 * error,
                    " % off forward rays");
            CHECK(std::fabs(ours.mean / wanted - 1) < loss + 4 * error);
            CHECK(error < 0.01);
        }
    }
}

}  // namespace

TEST_CASE("a caustic in haze, through smooth glass: merging brings what forward rays bring") {
    check_caustic({coloured_haze()}, 0.05, 0.005);
}

TEST_CASE("a caustic in haze, through glass that is nearly smooth: connections and merging share it") {
    check_caustic({coloured_haze(), 0.02}, 0.05, 0.005);
    check_caustic({coloured_haze(), 0.02, false}, 0.05, 0.005);
}

TEST_CASE("a caustic in haze whose density varies" * doctest::test_suite("long")) {
    TemporaryFolder folder;
    DensityField({24, 24, 24}, glm::dvec3(-1), glm::dvec3(1), [](glm::dvec3 p) {
        return 1.5 - 0.5 * p.y + 0.8 * std::sin(9 * p.x) * std::cos(7 * p.z);
    }).write(folder / "haze.nrrd");
    json haze = coloured_haze();
    haze["class"] = "grid", haze["file"] = "haze.nrrd";
    check_caustic({haze}, 0.05, 0.005, folder / "scene.gltf");
}
