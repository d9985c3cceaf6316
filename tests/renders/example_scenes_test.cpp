// The scenes in scenes/ show what their own words (scenes[0].extras.expected) and scenes/README.md say.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "host/gltf/gltf.h"
#include "host/measure/figures.h"
#include "host/measure/measurement.h"
#include "tests/support/render_probe.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

std::filesystem::path example(const std::string& name) { return source_path("scenes/" + name + ".gltf"); }

Estimates render_example(const std::string& name, uint32_t width, uint32_t height, uint32_t passes) {
    RenderPlan plan;
    plan.width = width, plan.height = height, plan.passes = passes, plan.seeds = 2;
    return render_estimates(import_gltf(example(name)), plan);
}

void check_uniform(const std::string& name, uint32_t passes, double value, double tolerance) {
    const WindowMean mean = window_mean(render_example(name, 96, 64, passes));
    MESSAGE(name, ": ", mean.mean, " +- ", mean.standard_error);
    CHECK(mean.mean == doctest::Approx(value).epsilon(tolerance));
}

// What a meter of the example reads, by the name of a figure.
Interval measure_example(const std::string& name, const std::string& meter, const std::string& figure,
                         uint64_t passes) {
    Scene scene = compile_test_scene(import_gltf(example(name)));
    std::vector<const Receiver*> receivers;
    for (const Receiver& receiver : scene.receivers)
        if (receiver.name == meter) receivers.push_back(&receiver);
    REQUIRE(receivers.size() == 1);
    MeasurementRun run(test_device(), scene, receivers, {});
    REQUIRE(run.add({0, passes}, [] { return false; }));
    for (const Figure& found : figures_of(run.measurement().meters[0], {}))
        if (found.name == figure) return found.interval;
    FAIL("no figure ", figure);
    return {};
}

}  // namespace

TEST_CASE("every example scene is read without a warning") {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(source_path("scenes"))) {
        if (entry.path().extension() != ".gltf") continue;
        const SceneDescription scene = import_gltf(entry.path());
        CHECK_MESSAGE(scene.warnings.empty(), entry.path().string());
        CHECK_MESSAGE(!scene.receivers.empty(), entry.path().string());
        ++count;
    }
    CHECK(count >= 9);
}

TEST_CASE("example furnace_closed: 2 in every direction of a closed sphere that emits 1 and reflects half") {
    check_uniform("furnace_closed", 32, 2, 0.003);
}

TEST_CASE("example cloud: bright above, grey below, and its shadow on the plain") {
    const Estimates e = render_example("cloud", 240, 160, 32);
    const auto mean = [&](uint32_t x, uint32_t y) { return window_mean(e, {x - 5, y - 3, 10, 6}, 1).mean; };
    const double sunlit = mean(135, 40), base = mean(110, 65), plain = mean(30, 148), shadow = mean(205, 148);
    MESSAGE("sunlit ", sunlit, ", base ", base, ", plain ", plain, ", shadow ", shadow);
    CHECK(sunlit > 1.25 * base);
    CHECK(base > shadow);
    CHECK(plain > 2 * shadow);
    CHECK(e.counters.depth_limit == 0);
}

TEST_CASE("example fogbow: a white bow at 38 degrees that is polarized along itself, and a glory") {
    RenderPlan plan;
    plan.width = plan.height = 160, plan.passes = 64, plan.seeds = 2, plan.stokes = true;
    const Estimates e = render_estimates(import_gltf(example("fogbow")), plan);
    // To the right and to the left of the middle, the median of which no rare bright pixel moves; S1 < 0
    // swings along the bow there.
    const auto at = [&](double degrees, uint32_t layer) {
        std::vector<double> found;
        const double radius = 80 * std::tan(degrees * 0.0174533) / std::tan(46 * 0.0174533);
        for (int y = -12; y <= 12; ++y)
            for (const int side : {-1, 1}) {
                const double x = std::sqrt(std::max(0.0, radius * radius - y * y));
                found.push_back(e.at(uint32_t(80 + side * x), layer * 160 + uint32_t(80 + y), 1));
            }
        std::nth_element(found.begin(), found.begin() + found.size() / 2, found.end());
        return found[found.size() / 2];
    };
    const double bow = at(38, 0), inside = at(33, 0), outside = at(44, 0), second = at(30, 0),
                 between = at(24, 0);
    MESSAGE("bow ", bow, ", inside ", inside, ", outside ", outside, ", second ", second, ", within it ",
            between);
    CHECK(bow > 1.5 * inside);
    CHECK(bow > 1.5 * outside);
    CHECK(second > 1.04 * inside);
    MESSAGE("S1 of the bow: ", at(38, 1) / bow);
    CHECK(at(38, 1) / bow == doctest::Approx(-0.65).epsilon(0.12));
    CHECK(e.at(80, 80, 1) > 1.5 * at(8, 0));
}

TEST_CASE("example lamps: the floor below a spot, below the same behind a pane, and below a square lamp") {
    const Estimates e = render_example("lamps", 240, 135, 16);
    const auto below = [&](uint32_t x) { return window_mean(e, {x - 2, 92, 5, 3}, 1).mean; };
    const double spot = below(52), behind_pane = below(120), square = below(187);
    MESSAGE("spot ", spot, ", behind the pane ", behind_pane, ", square lamp ", square);
    // What the bay returns adds up to 6 %.
    CHECK(spot > 0.79);
    CHECK(spot < 0.85);
    CHECK(behind_pane / spot == doctest::Approx(0.923).epsilon(0.03));
    CHECK(square > 0.78);
    CHECK(square < 0.86);
}

TEST_CASE("example grin: rods of a quarter, a half and a whole pitch, and a Luneburg lens") {
    const Estimates e = render_example("grin", 240, 160, 4);
    const auto mean = [&](uint32_t x, uint32_t y, int channel) {
        return window_mean(e, {x - 2, y - 2, 4, 4}, channel).mean;
    };
    const auto is_yellow = [&](uint32_t x, uint32_t y) { return mean(x, y, 1) > 0.5; };
    // 0.8 pixels a mm; the letters are 20 x 36 mm, columns 72 pixels apart, rows 80.
    const double passes =
        2 * 1.6 / (1 + 1.6 * 1.6);  // of all light, through both faces, with what is reflected between them
    for (const double x :
         {48 - 16.0, 48 + 16.0})  // all of the rod shows what touches the middle of its far face
        CHECK(mean(uint32_t(x), 40, 0) == doctest::Approx(0.9 * passes).epsilon(0.02));
    CHECK(mean(120 - 16, 120 + 10, 0) == doctest::Approx(0.9).epsilon(0.01));
    for (const auto& [column, row, turned] :
         {std::tuple{120, 40, true}, {192, 40, false}, {48, 120, false}}) {
        const int sign = turned ? -1 : 1;
        CHECK(is_yellow(uint32_t(column - sign * 8), uint32_t(row - sign * 8)));  // the stem
        CHECK(is_yellow(uint32_t(column - sign * 8), uint32_t(row + sign * 10)));
        CHECK(is_yellow(uint32_t(column + sign * 6), uint32_t(row - sign * 11)));   // the upper bar
        CHECK(!is_yellow(uint32_t(column + sign * 6), uint32_t(row + sign * 11)));  // nothing opposite
        CHECK(!is_yellow(uint32_t(column + sign * 14), uint32_t(row)));
    }
}

TEST_SUITE("long") {
    TEST_CASE("example furnace_smooth: lossless things are invisible") {
        check_uniform("furnace_smooth", 128, 1, 0.002);
    }

    TEST_CASE("example furnace_rough: rough surfaces that keep all light are invisible") {
        check_uniform("furnace_rough", 128, 1, 0.005);
    }

    TEST_CASE("example spheres: metals show the reflectance of their refractive indices") {
        const Estimates e = render_example("spheres", 270, 180, 64);
        const double expected[3][3] = {{0.988, 0.983, 0.980}, {0.945, 0.777, 0.374}, {0.939, 0.618, 0.554}};
        for (uint32_t i = 0; i < 3; ++i)
            for (int c = 0; c < 3; ++c) {
                const double value = window_mean(e, {133 - 80 + 80 * i, 128, 5, 5}, c).mean;
                CHECK(value == doctest::Approx(expected[i][c]).epsilon(i == 1 ? 0.02 : 0.003));
            }
    }
}

TEST_CASE("examples to be measured: what their meters read") {
    struct Stated {
        const char *scene, *meter, *figure;
        double value, rounding;
    };
    for (const Stated& s :
         {Stated{"office", "desks", "mean", 508, 0.5}, Stated{"office", "faces", "mean", 246, 0.5},
          Stated{"street", "carriageway", "mean", 10.6, 0.05},
          Stated{"street", "carriageway", "U0 = minimum / mean", 0.67, 0.005},
          Stated{"street", "walkers", "mean", 6.1, 0.05}, Stated{"led_lens", "spot", "flux", 59.0, 0.05},
          Stated{"office", "eye", "UGR, sources above 500 cd/m²", 18.5, 0.05}}) {
        CAPTURE(s.scene);
        CAPTURE(s.meter);
        const Interval found = measure_example(s.scene, s.meter, s.figure, 256);
        CAPTURE(found.low);
        CAPTURE(found.high);
        CHECK(found.low - 0.002 * s.value < s.value + s.rounding);
        CHECK(found.high + 0.002 * s.value > s.value - s.rounding);
        CHECK(found.high - found.low < 0.05 * s.value);
    }
}

// 0.688 of 1 lm, over the square that the fibre's meter is.
TEST_CASE("example ball_lens: what gets into the second fibre") {
    const Interval found = measure_example("ball_lens", "fibre", "mean", 64);
    const double area = 0.0443e-3 * 0.0443e-3;
    CHECK(found.value * area == doctest::Approx(0.6876).epsilon(0.003));
}

TEST_CASE("example spectrometer: its lines stand where the grating's equation and the focal length say") {
    RenderPlan plan;
    plan.width = 512, plan.height = 8, plan.passes = 256, plan.seeds = 2;
    plan.receiver = "sensor", plan.algorithm = Algorithm::forward;
    const Estimates e = render_estimates(import_gltf(example("spectrometer")), plan);
    for (const double nm : {436, 546, 577, 579}) {
        const double turn = std::asin(nm * 6e-4) - std::asin(0.33),
                     column = 256 + 512 / 24.0 * 100.28 * std::tan(turn);
        double sum = 0, moment = 0;
        for (uint32_t x = uint32_t(column) - 1; x <= uint32_t(column) + 1; ++x)
            for (uint32_t y = 0; y < 8; ++y) {
                const double light = 0.2126 * e.at(x, y, 0) + 0.7152 * e.at(x, y, 1) + 0.0722 * e.at(x, y, 2);
                sum += light, moment += light * (x + 0.5);
            }
        CAPTURE(nm);
        CHECK(sum > 0);
        CHECK(moment / sum == doctest::Approx(column).epsilon(0.6 / column));
    }
}

// The closed forms of an integrating sphere: E = flux / area / (1 - reflectance (1 - open part)).
TEST_CASE("example integrating_sphere: wall, port and spot") {
    const double wall = 1000 / std::numbers::pi / (1 - 0.95 * 0.99);
    for (const auto& [meter, figure, expected] :
         {std::tuple{"wall", "mean", wall}, std::tuple{"port", "flux", 0.01 * std::numbers::pi * wall},
          std::tuple{"spot", "mean", 0.95 * wall / std::numbers::pi}}) {
        CAPTURE(meter);
        const Interval found = measure_example("integrating_sphere", meter, figure, 65536);
        CAPTURE(found.value);
        CHECK(found.low - 0.002 * expected < expected);  // the sphere is a mesh
        CHECK(found.high + 0.002 * expected > expected);
        CHECK(found.high - found.low < 0.02 * expected);
    }
}
