// Polarized light seen through sheets and by mirrors, against closed forms.
//
// A camera of a narrow field looks along -z at a white environment, through sheets across its way. What a
// polarizer, with or without a wave plate behind it, lets through tells the Stokes vector that comes to it.
#include <doctest/doctest.h>

#include <array>
#include <functional>

#include "host/gltf/gltf.h"
#include "host/spectra/color.h"
#include "tests/renders/sheets.h"
#include "tests/renders/stokes_means.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

using json = nlohmann::json;
using glm::dvec3, glm::dvec4;

constexpr double pi = std::numbers::pi, degree = pi / 180;

// Sheets are met in their order; the last is the farthest from the camera.
void add_sheets(SceneBuilder& s, const std::vector<json>& sheets, const dvec3& normal = {0, 0, 1},
                const dvec3& x = {1, 0, 0}) {
    for (size_t i = 0; i < sheets.size(); ++i)
        s.rectangle(0.4, 0.4, s.surface(sheets[i]), facing({0, 0, -0.2 - 0.02 * double(i)}, normal, x));
}

Estimates estimates_of(const SceneBuilder& s, PolarizationMode mode, RenderPlan plan) {
    SceneOptions options = test_options();
    options.polarization = mode;
    options.color = ColorMode::rgb;
    // Scenes of the same classes have the same kernels.
    options.varying = {"places",
                       "surface/linear_polarizer/axis",
                       "surface/linear_polarizer/parallel",
                       "surface/linear_polarizer/crossed",
                       "surface/linear_polarizer/kind",
                       "surface/retarder/axis",
                       "surface/retarder/retardance"};
    Scene scene = compile_test_scene(s.import(), options);
    return render_estimates(scene, plan);
}

// Russian roulette makes noise where little is left.
WindowMean seen(const SceneBuilder& s, PolarizationMode mode = PolarizationMode::automatic,
                uint32_t pixels = 32) {
    RenderPlan plan;
    plan.width = plan.height = pixels;
    return window_mean(estimates_of(s, mode, plan));
}

// By a camera of Stokes vectors.
StokesMeans seen_stokes(const SceneBuilder& s, Algorithm algorithm = Algorithm::backward) {
    RenderPlan plan;
    plan.width = plan.height = 32;
    plan.stokes = true, plan.algorithm = algorithm;
    const Estimates e = estimates_of(s, PolarizationMode::on, plan);
    return stokes_means(e);
}

void check_seen(const WindowMean& found, double expected) {
    CAPTURE(found.mean);
    CAPTURE(found.standard_error);
    CAPTURE(expected);
    CHECK(std::fabs(found.mean - expected) < 1e-5 + 5 * found.standard_error);
    CHECK(found.standard_error < 1e-5 + 0.02 * expected);
}

SceneBuilder white() {
    SceneBuilder s;
    s.environment(1);
    s.perspective(1e-3, at(0, 0, 0));
    return s;
}

WindowMean through(const std::vector<json>& sheets) {
    SceneBuilder s = white();
    add_sheets(s, sheets);
    return seen(s);
}

// Six analysers before the camera of a scene.
StokesMeans stokes(const SceneBuilder& scene) {
    const auto analysed = [&](const std::vector<json>& sheets) {
        SceneBuilder s = scene;
        for (size_t i = 0; i < sheets.size(); ++i)
            s.rectangle(0.02, 0.02, s.surface(sheets[i]), at(0, 0, -0.05 - 0.01 * double(i)));
        return seen(s);
    };
    const auto linear = [&](double axis) { return analysed({polarizer(axis)}); };
    // Right-handed light: S3 becomes S2 < 0 where the slow axis is x.
    const auto circular = [&](double axis) { return analysed({polarizer(axis), wave_plate(0, pi / 2)}); };
    const auto sum = [](const WindowMean& a, const WindowMean& b, double sign) {
        return WindowMean{a.mean + sign * b.mean, std::hypot(a.standard_error, b.standard_error)};
    };
    return {sum(linear(0), linear(pi / 2), 1), sum(linear(0), linear(pi / 2), -1),
            sum(linear(pi / 4), linear(-pi / 4), -1), sum(circular(-pi / 4), circular(pi / 4), -1)};
}

// Absorbs at once whatever it refracts.
int glass_mirror(SceneBuilder& s) {
    if (!s.optics().contains("media"))
        s.medium("ink", {{"class", "homogeneous"}, {"ior", 1.5}, {"absorption", 1e7}});
    return s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "ink"}});
}

// The camera sees a mirror that reflects its view from -z to +y, and another that does from there to `out`.
SceneBuilder two_mirrors(const std::function<int(SceneBuilder&)>& mirror, const dvec3& out,
                         double incidence = 45 * degree) {
    SceneBuilder s = white();
    const double turn = pi - 2 * incidence;  // of the view
    const dvec3 in(0, 0, -1), between(0, std::sin(turn), -std::cos(turn));
    s.rectangle(0.3, 0.3, mirror(s), facing({0, 0, -1}, between - in, {1, 0, 0}));
    s.rectangle(0.3, 0.3, mirror(s), facing(dvec3(0, 0, -1) + between, out - between, {1, 0.1, 0}));
    return s;
}

}  // namespace

TEST_CASE("polarizers in a row let through what Malus says") {
    check_seen(through({polarizer(0.3)}), 0.5);
    for (double a : {0.0, 20.0, 45.0, 70.0, 90.0})
        check_seen(through({polarizer(0), polarizer(a * degree)}), 0.5 * std::pow(std::cos(a * degree), 2));
    check_seen(through({polarizer(0), polarizer(pi / 4), polarizer(pi / 2)}), 0.125);
    std::vector<json> fan;
    for (int i = 0; i <= 10; ++i) fan.push_back(polarizer(i * 9 * degree));
    check_seen(through(fan), 0.5 * 0.780546);
    json real = polarizer(0), crossed = polarizer(pi / 2);
    for (json* sheet : {&real, &crossed}) (*sheet)["parallel"] = 0.8, (*sheet)["crossed"] = 0.05;
    check_seen(through({real, real}), 0.5 * (0.64 + 0.0025));
    check_seen(through({real, crossed}), 0.04);
    check_seen(through({polarizer(0), {{"class", "depolarizer"}}, polarizer(pi / 2)}), 0.25);
}

TEST_CASE("crossed polarizers leak at an angle") {
    for (const char* kind : {"absorbing", "transmitting"})
        for (const auto& [angle, leak] : {std::pair{60.0, 0.36}, {45.0, 1.0 / 9}, {30.0, 0.020408}}) {
            json first = polarizer(0), second = polarizer(pi / 2);
            first["kind"] = second["kind"] = kind;
            SceneBuilder s = white();
            // The plane of incidence lies between both axes.
            const dvec3 n(std::sin(angle * degree), 0, std::cos(angle * degree));
            const dvec3 p = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), n));
            add_sheets(s, {first, second}, n, p + glm::dvec3(0, 1, 0));
            CAPTURE(kind);
            CAPTURE(angle);
            check_seen(seen(s), 0.5 * leak);
        }
}

TEST_CASE("wave plates between polarizers") {
    for (double g : {0.5, pi / 2, 2.0, pi, 5.0}) {
        check_seen(through({polarizer(0), wave_plate(pi / 4, g), polarizer(pi / 2)}),
                   0.5 * std::pow(std::sin(g / 2), 2));
        check_seen(through({polarizer(0), wave_plate(pi / 4, g), polarizer(0)}),
                   0.5 * std::pow(std::cos(g / 2), 2));
    }
    // One seen from behind undoes the other: its axis is mirrored, slow becomes fast.
    SceneBuilder s = white();
    add_sheets(s, {polarizer(0), wave_plate(pi / 4, pi / 2)});
    s.rectangle(0.4, 0.4, s.surface(wave_plate(pi / 4, pi / 2)), facing({0, 0, -0.3}, {0, 0, -1}, {1, 0, 0}));
    s.rectangle(0.4, 0.4, s.surface(polarizer(0)), at(0, 0, -0.32));
    check_seen(seen(s), 0.5);
    // A plate of quartz by its thickness; at 30 degrees in the plane of the axis and across it.
    const auto quartz = [](double thickness) {
        return json{{"class", "retarder"},
                    {"ior_ordinary", 1.5443},
                    {"ior_extraordinary", 1.5534},
                    {"thickness", thickness}};
    };
    const double nm = 611, g0 = 2 * pi / nm * 16190 * (1.5534 - 1.5443);  // of the channel red
    for (const auto& [azimuth, ratio] : {std::pair{0.0, 0.94612}, {90.0, 1.0566}}) {
        SceneBuilder tilted = white();
        const dvec3 n(std::sin(30 * degree), 0, std::cos(30 * degree)),
            p = glm::normalize(glm::cross(dvec3(0, 1, 0), n));
        const dvec3 x = azimuth == 0 ? p : dvec3(0, 1, 0);
        add_sheets(tilted, {quartz(16190)}, n, x);
        for (int i = 0; i < 2; ++i)
            tilted.rectangle(0.02, 0.02, tilted.surface(polarizer((i ? -1 : 1) * pi / 4)),
                             at(0, 0, i ? -0.05 : -0.6));
        SceneOptions options = test_options();
        Scene scene = compile_test_scene(tilted.import(), options);
        RenderPlan plan;
        plan.width = plan.height = 32;
        CAPTURE(azimuth);
        const WindowMean red = window_mean(render_estimates(scene, plan), {}, 0);
        CHECK(std::fabs(red.mean - 0.5 * std::pow(std::sin(0.5 * g0 * ratio), 2)) <
              1e-4 + 5 * red.standard_error);
    }
}

TEST_CASE("a circular polarizer before a mirror is black, before white paper it is not") {
    SceneBuilder s = white();
    add_sheets(s, {polarizer(0), wave_plate(pi / 4, pi / 2)});
    SceneBuilder paper = s;
    s.rectangle(0.4, 0.4, s.surface({{"class", "conductor"}}), at(0, 0, -1));
    check_seen(seen(s), 0);
    // The same without the wave plate: light passes the polarizer twice. The mirror is too small to see past
    // the sheets.
    paper.rectangle(0.01, 0.01, paper.surface({{"class", "depolarizer"}}), at(0, 0, -0.9));
    paper.rectangle(0.4, 0.4, paper.surface({{"class", "conductor"}}), at(0, 0, -1));
    check_seen(seen(paper), 0.25);
}

TEST_CASE("example polarizers: what one, two and three let through, and a quarter-wave plate") {
    RenderPlan plan;
    plan.width = 160, plan.height = 100, plan.seeds = 4;
    const Estimates e = render_estimates(import_gltf(source_path("scenes/polarizers.gltf")), plan);
    const auto at_place = [&](double x, double y) {
        const auto column = uint32_t((x / 1.76 + 1) / 2 * 160), row = uint32_t((1 - y / 1.1) / 2 * 100);
        return window_mean(e, {column - 2, row - 2, 5, 5}, 1).mean;
    };
    CHECK(at_place(-1.5, 0.8) == doctest::Approx(100).epsilon(2e-3));
    CHECK(at_place(-1.2, 0) == doctest::Approx(50).epsilon(2e-3));
    CHECK(at_place(0.1, 0) < 1e-3);
    CHECK(at_place(-0.25, 0) == doctest::Approx(12.5).epsilon(5e-3));
    CHECK(at_place(0.4, 0) == doctest::Approx(25).epsilon(0.03));
}

TEST_CASE("example retarders: Michel-Lévy's colours") {
    RenderPlan plan;
    plan.width = 180, plan.height = 90, plan.passes = 256, plan.seeds = 4;
    const Estimates e = render_estimates(import_gltf(source_path("scenes/retarders.gltf")), plan);
    for (int strip : {3, 10, 21}) {  // 200, 550, 1100 nm
        const double g = 50.0 * (strip + 1), x = 0.1 * (strip - 15);
        const glm::dvec3 expected = rgb_of_radiance(
            white_light() * tabulate([&](double nm) { return 50 * std::pow(std::sin(pi * g / nm), 2); }));
        const auto column = uint32_t((x / 1.8 + 1) / 2 * 180);
        CAPTURE(g);
        for (int k = 0; k < 3; ++k)
            CHECK(window_mean(e, {column - 1, 40, 3, 10}, k).mean ==
                  doctest::Approx(expected[k]).epsilon(0.01).scale(40));
    }
}

// Nothing polarizes a Cornell box: S1 to S3 are exactly 0, and the image is that without polarization.
TEST_CASE("a scene that depolarizes everything") {
    RenderPlan plan;
    plan.width = plan.height = 24, plan.seeds = 2, plan.passes = 4;
    plan.algorithm = Algorithm::bidirectional;
    Scene scene = compile_test_scene(import_gltf(source_path("scenes/cornell_box.gltf")));
    CHECK(!scene.features.polarization);
    const Estimates plain = render_estimates(scene, plan);
    scene.features.polarization = true;
    plan.stokes = true;
    const Estimates stokes = render_estimates(scene, plan);
    for (size_t i = 0; i < plain.mean.size(); ++i)
        CHECK(stokes.mean[i] == doctest::Approx(plain.mean[i]).epsilon(1e-5));
    for (size_t i = plain.mean.size(); i < stokes.mean.size(); ++i) CHECK(stokes.mean[i] == 0);
}

TEST_CASE("example fresnel_rhomb: linear light leaves circular") {
    RenderPlan plan;
    plan.width = plan.height = 64, plan.stokes = true;
    const Estimates e = render_estimates(import_gltf(source_path("scenes/fresnel_rhomb.gltf")), plan);
    const auto mean = [&](uint32_t x, uint32_t y, uint32_t layer) {
        return window_mean(e, {x - 4, 64 * layer + y - 4, 8, 8}).mean;
    };
    // (1 - R)² / (1 ∓ R²): what goes to and fro turns to the other side each time.
    const double beside[] = {100, 0, 100, 0}, through[] = {92.308, 0, 0, 92.013};
    for (uint32_t layer = 0; layer < 4; ++layer) {
        CAPTURE(layer);
        CHECK(mean(8, 32, layer) == doctest::Approx(beside[layer]).epsilon(1e-4).scale(100));
        CHECK(mean(32, 32, layer) == doctest::Approx(through[layer]).epsilon(2e-3).scale(100));
    }
}

TEST_CASE("example glass_table: the mirror image is horizontal, a polarizer takes it away") {
    const SceneDescription scene = import_gltf(source_path("scenes/glass_table.gltf"));
    RenderPlan plan;
    plan.width = 96, plan.height = 64, plan.passes = 256, plan.stokes = true;
    const auto centre = [&](const Estimates& e, uint32_t layer) {
        return window_mean(e, {46, 64 * layer + 30, 4, 4}).mean;
    };
    const Estimates e = render_estimates(scene, plan);
    const double s0 = centre(e, 0), s1 = centre(e, 1);
    MESSAGE("S0 ", s0, ", S1 ", s1, ", S2 ", centre(e, 2));
    // A pane reflects 2 r / (1 + r) of s, r = 0.147929, and nothing of p. So it polarizes the card below,
    // too, whose p is all there is.
    const double reflected = 0.257732, card = s0 - s1;
    CHECK(s1 == doctest::Approx(0.5 * reflected * (500 - card)).epsilon(0.01));
    CHECK(std::fabs(centre(e, 2)) < 0.02 * s0);
    plan.stokes = false;
    plan.receiver = "upright";
    CHECK(centre(render_estimates(scene, plan), 0) == doctest::Approx(0.5 * card).epsilon(0.2));
    plan.receiver = "level";
    CHECK(centre(render_estimates(scene, plan), 0) == doctest::Approx(0.5 * (s0 + s1)).epsilon(0.05));
}

TEST_CASE("two mirrors of glass reflect by their planes") {
    check_seen(seen(two_mirrors(glass_mirror, {0, 0, 1}), PolarizationMode::on, 160), 0.004269070);
    check_seen(seen(two_mirrors(glass_mirror, {1, 0, 0}), PolarizationMode::on, 160), 0.000779027);
    check_seen(seen(two_mirrors(glass_mirror, {1, 0, 0}), PolarizationMode::automatic, 160), 0.002524049);
}

TEST_CASE("two mirrors of gold whose planes are turned make light elliptic") {
    const auto gold = [](SceneBuilder& s) {
        return s.surface({{"class", "conductor"}, {"eta", 0.183}, {"k", 3.43}});
    };
    const SceneBuilder s = two_mirrors(gold, dvec3(1, 0, 1) * std::sqrt(0.5));
    check_stokes(stokes(s), {0.888266, 0.017597, 0.016222, -0.006811});
    check_stokes(seen_stokes(s), {0.888266, 0.017597, 0.016222, -0.006811});
}

TEST_CASE("a Stokes camera sees what sheets make") {
    const auto seen_through = [](const std::vector<json>& sheets) {
        SceneBuilder s = white();
        add_sheets(s, sheets);
        return seen_stokes(s);
    };
    for (double a : {0.0, 30.0, 45.0, 100.0}) {
        CAPTURE(a);
        const double angle = 2 * a * degree;
        check_stokes(seen_through({polarizer(a * degree)}),
                     {0.5, 0.5 * std::cos(angle), 0.5 * std::sin(angle), 0});
    }
    // The slow axis upright: light at +45 degrees, which the plate receives, turns left-handed.
    for (double g : {0.4, pi / 2, 4.0})
        check_stokes(seen_through({wave_plate(pi / 2, g), polarizer(pi / 4)}),
                     {0.5, 0, 0.5 * std::cos(g), -0.5 * std::sin(g)});
    check_stokes(seen_through({{{"class", "depolarizer"}}, polarizer(0.3)}), {0.5, 0, 0, 0});
    check_stokes(seen_through({{{"class", "mueller"},
                                {"matrix", {0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5}}}}),
                 {0.5, 0, 0, 0.5});
    // A mirror of gold at 45 degrees turns the view upward: its plane of incidence stands upright, s is x.
    SceneBuilder s = white();
    s.rectangle(0.3, 0.3, s.surface({{"class", "conductor"}, {"eta", 0.183}, {"k", 3.43}}),
                facing({0, 0, -1}, {0, 1, 1}, {1, 0, 0}));
    check_stokes(seen_stokes(s),
                 {0.5 * (0.961149192 + 0.923807768), 0.5 * (0.961149192 - 0.923807768), 0, 0});
    s.rectangle(2, 2, s.surface(polarizer(pi / 4)), facing({0, 1, -1}, {0, -1, 0}, {1, 0, 0}));
    const StokesMeans turned = seen_stokes(s);
    // r_p is r_s turned by 157.224604 degrees, and what the mirror receives swings at +-45 degrees.
    const double c = std::sqrt(0.961149192 * 0.923807768) / 2, sign = turned[2].mean < 0 ? 1 : -1;
    check_stokes(turned,
                 {0.25 * (0.961149192 + 0.923807768), 0.25 * (0.961149192 - 0.923807768),
                  sign * c * std::cos(157.224604 * degree), sign * c * std::sin(157.224604 * degree)});
}

TEST_CASE("polarized lights") {
    const dvec4 state(1, 0.6, 0.3, -0.5);
    const auto turned = [&](double a) {
        const double c = std::cos(2 * a), s = std::sin(2 * a);
        return dvec4(1, c * state[1] - s * state[2], s * state[1] + c * state[2], state[3]);
    };
    // Seen directly: a surface whose node is turned about the view.
    for (double a : {0.0, 30 * degree}) {
        SceneBuilder s;
        s.perspective(1e-3, at(0, 0, 0));
        const int lamp = s.material({{"surface", {{"class", "absorber"}}},
                                     {"emission", {{"radiance", 1}, {"stokes", {1, 0.6, 0.3, -0.5}}}}});
        s.rectangle(0.4, 0.4, lamp, {{0, 0, -1}, {0, 0, std::sin(a / 2), std::cos(a / 2)}});
        for (Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional})
            check_stokes(seen_stokes(s, algorithm), turned(a));
    }
}

// What is measured turns against the camera: S0 and S3 stay, S1 and S2 turn by twice the angle. Mirrored, the
// scene shows S2 and S3 of the other sign.
TEST_CASE("turned cameras and mirrored scenes") {
    const auto scene = [](double turn, bool mirrored) {
        SceneBuilder s;
        s.environment(1);
        s.perspective(1e-3, {{0, 0, 0}, {0, 0, std::sin(turn / 2), std::cos(turn / 2)}});
        const double side = mirrored ? -1 : 1;
        const auto gold = [](SceneBuilder& b) {
            return b.surface({{"class", "conductor"}, {"eta", 0.183}, {"k", 3.43}});
        };
        const dvec3 between = glm::normalize(dvec3(0.3 * side, 1, 0.2)),
                    out = glm::normalize(dvec3(1 * side, 0.5, 0.4));
        s.rectangle(0.3, 0.3, gold(s), facing({0, 0, -1}, between - dvec3(0, 0, -1), {1, 0, 0}));
        s.rectangle(0.3, 0.3, gold(s), facing(dvec3(0, 0, -1) + between, out - between, {1, 0.1, 0}));
        s.rectangle(2, 2, s.surface(polarizer(0)), facing(dvec3(0, 0, -1) + between + out, -out, {0, 1, 0}));
        return seen_stokes(s);
    };
    const StokesMeans reference = scene(0, false);
    CHECK(std::fabs(reference[3].mean) > 0.01);
    for (double a : {20.0, 75.0, 160.0}) {
        const double c = std::cos(2 * a * degree), s = std::sin(2 * a * degree);
        CAPTURE(a);
        check_stokes(scene(a * degree, false),
                     {reference[0].mean, c * reference[1].mean + s * reference[2].mean,
                      c * reference[2].mean - s * reference[1].mean, reference[3].mean});
    }
    check_stokes(scene(0, true),
                 {reference[0].mean, reference[1].mean, -reference[2].mean, -reference[3].mean});
}

TEST_CASE("the intensity of a Stokes image is that of an image") {
    RenderPlan plan;
    plan.width = plan.height = 24, plan.seeds = 2, plan.passes = 4;
    plan.algorithm = Algorithm::bidirectional;
    Scene scene = compile_test_scene(import_gltf(source_path("scenes/polarizers.gltf")));
    const Estimates plain = render_estimates(scene, plan);
    plan.stokes = true;
    const Estimates stokes = render_estimates(scene, plan);
    double worst = 0;
    for (size_t i = 0; i < plain.mean.size(); ++i)
        worst = std::max(worst, std::fabs(plain.mean[i] - stokes.mean[i]) / (1 + plain.mean[i]));
    CHECK(worst < 1e-5);
}
