// Mueller matrices measured as a polarimeter does (Azzam 1978, "Photopolarimetric measurement of the Mueller
// matrix by Fourier analysis of a single detected signal"): light passes a polarizer, a quarter-wave plate
// that turns five times as fast as a second one behind the sample, and a polarizer across the first. Of 36
// images all 16 numbers follow. Sheets, frames, signs and surfaces have to agree for that.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/renders/sheets.h"
#include "tests/support/source_path.h"

using namespace etendue;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;
constexpr int images = 36;

using Matrix = std::array<std::array<double, 4>, 4>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k) m[i][j] += a[i][k] * b[k][j];
    return m;
}
// Turned counter-clockwise, as the receiver sees it.
Matrix turned(const Matrix& m, double angle) {
    const double c = std::cos(2 * angle), s = std::sin(2 * angle);
    return product({{{1, 0, 0, 0}, {0, c, -s, 0}, {0, s, c, 0}, {0, 0, 0, 1}}},
                   product(m, {{{1, 0, 0, 0}, {0, c, s, 0}, {0, -s, c, 0}, {0, 0, 0, 1}}}));
}
const Matrix polarizer_along_x = {{{0.5, 0.5, 0, 0}, {0.5, 0.5, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}};
// The slow axis along x.
const Matrix quarter_wave = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, -1}, {0, 0, 1, 0}}};

// Of a mirror, x across the plane of incidence (conventions: shaders/lib/stokes.glsl).
Matrix mirror(double rs, double rp, double phase) {
    const double sum = (rs + rp) / 2, difference = (rs - rp) / 2, c = std::sqrt(rs * rp) * std::cos(phase),
                 s = std::sqrt(rs * rp) * std::sin(phase);
    return {{{sum, difference, 0, 0}, {difference, sum, 0, 0}, {0, 0, c, -s}, {0, 0, s, c}}};
}

// Least squares, by the normal equations.
std::array<double, 16> solve(const std::vector<std::array<double, 16>>& rows,
                             const std::vector<double>& values) {
    std::array<std::array<double, 17>, 16> a{};
    for (size_t r = 0; r < rows.size(); ++r)
        for (int i = 0; i < 16; ++i) {
            for (int j = 0; j < 16; ++j) a[i][j] += rows[r][i] * rows[r][j];
            a[i][16] += rows[r][i] * values[r];
        }
    for (int c = 0; c < 16; ++c) {
        int pivot = c;
        for (int r = c + 1; r < 16; ++r)
            if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
        std::swap(a[c], a[pivot]);
        for (int r = 0; r < 16; ++r)
            if (r != c)
                for (int k = 16; k >= c; --k) a[r][k] -= a[r][c] / a[c][c] * a[c][k];
    }
    std::array<double, 16> x;
    for (int i = 0; i < 16; ++i) x[i] = a[i][16] / a[i][i];
    return x;
}

// `add_sample` puts the sample at (0, 0, -1), where light comes along `in` and leaves along +z.
template <class AddSample>
void check_measured(const dvec3& in, const Matrix& expected, AddSample add_sample) {
    std::vector<std::array<double, 16>> rows;
    std::vector<double> values;
    for (int i = 0; i < images; ++i) {
        const double f = pi * i / images;
        SceneBuilder s;
        s.perspective(1e-3, at(0, 0, 0));
        const auto beside = [&](double z, const nlohmann::json& sheet) {
            s.rectangle(0.1, 0.1, s.surface(sheet), at(0, 0, z));
        };
        beside(-0.1, polarizer(pi / 2));
        beside(-0.2, wave_plate(f, pi / 2));
        const auto before = [&](double distance, int material) {
            s.rectangle(0.1, 0.1, material, facing(dvec3(0, 0, -1) - distance * in, in, {1, 0, 0}));
        };
        before(0.2, s.surface(wave_plate(5 * f, pi / 2)));
        before(0.3, s.surface(polarizer(0)));
        before(0.4, s.black_emitter(1));
        add_sample(s);
        RenderPlan plan;
        plan.width = plan.height = 8, plan.seeds = 2, plan.passes = 1024;
        SceneOptions options = test_options();
        options.color = ColorMode::rgb;
        options.varying = {"places", "surface/linear_polarizer/axis", "surface/retarder/axis"};
        Scene scene = compile_test_scene(s.import(), options);
        values.push_back(window_mean(render_estimates(scene, plan)).mean);
        const Matrix receiving = product(turned(polarizer_along_x, pi / 2), turned(quarter_wave, f)),
                     sending = product(turned(quarter_wave, 5 * f), polarizer_along_x);
        rows.emplace_back();
        for (int k = 0; k < 16; ++k) rows.back()[k] = receiving[0][k / 4] * sending[k % 4][0];
    }
    const auto measured = solve(rows, values);
    for (int k = 0; k < 16; ++k) {
        CAPTURE(k / 4);
        CAPTURE(k % 4);
        CAPTURE(measured[k]);
        CAPTURE(expected[k / 4][k % 4]);
        CHECK(std::fabs(measured[k] - expected[k / 4][k % 4]) < 6e-3);
    }
}

// A mirror turns light that comes down along `in` towards the camera.
Place mirror_place(const dvec3& in) { return facing({0, 0, -1}, dvec3(0, 0, 1) - in, {1, 0, 0}); }
// … under an angle of incidence, in the plane of y and z.
dvec3 coming(double incidence) { return {0, -std::sin(2 * incidence), -std::cos(2 * incidence)}; }

}  // namespace

TEST_CASE("a polarimeter measures nothing where nothing is, and a wave plate") {
    const Matrix one = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    check_measured({0, 0, 1}, one, [](SceneBuilder&) {});
    const double c = std::cos(1.1), s = std::sin(1.1);
    const Matrix plate = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, c, -s}, {0, 0, s, c}}};
    check_measured({0, 0, 1}, turned(plate, 0.5), [](SceneBuilder& b) {
        b.rectangle(0.2, 0.2, b.surface(wave_plate(0.5, 1.1)), at(0, 0, -1));
    });
}

TEST_CASE("a polarimeter measures glass at 60 degrees, gold at 45, and total reflection") {
    const dvec3 slanted = coming(60 * degree), upright = coming(45 * degree);
    check_measured(slanted, mirror(0.176571488, 0.001801938, 0), [&](SceneBuilder& s) {
        s.medium("ink", {{"ior", 1.5}, {"absorption", 1e7}});
        s.rectangle(0.4, 0.4, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "ink"}}),
                    mirror_place(slanted));
    });
    check_measured(upright, mirror(0.961149192, 0.923807768, 157.224604 * degree), [&](SceneBuilder& s) {
        s.rectangle(0.4, 0.4, s.surface({{"class", "conductor"}, {"eta", 0.183}, {"k", 3.43}}),
                    mirror_place(upright));
    });
    // All stands in glass, before a void.
    check_measured(upright, mirror(1, 1, 36.869898 * degree), [&](SceneBuilder& s) {
        s.medium("glass", {{"ior", 1.5}});
        s.rectangle(0.4, 0.4, s.material({{"surface", {{"class", "dielectric"}}}, {"outside", "glass"}}),
                    mirror_place(upright));
    });
}

// A crystal of one index is glass, whose phases are known: amplitudes of crystals, of waves that are drawn
// with their polarization lost, have them at faces to isotropic media only.
TEST_CASE("a polarimeter measures crystals whose two indices are one like glass") {
    const auto crystal = [](double index, double absorption) {
        return nlohmann::json{{"class", "uniaxial"},
                              {"ior_ordinary", index},
                              {"ior_extraordinary", index},
                              {"axis", {0.3, 0.5, 0.8}},
                              {"absorption_ordinary", absorption},
                              {"absorption_extraordinary", absorption}};
    };
    const dvec3 slanted = coming(60 * degree), upright = coming(45 * degree);
    check_measured(slanted, mirror(0.176571488, 0.001801938, 0), [&](SceneBuilder& s) {
        s.medium("ink", crystal(1.5, 1e7));
        s.rectangle(0.4, 0.4, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "ink"}}),
                    mirror_place(slanted));
    });
    check_measured(upright, mirror(1, 1, 36.869898 * degree), [&](SceneBuilder& s) {
        s.medium("glass", {{"ior", 1.5}});
        s.medium("void", crystal(1, 0));
        s.rectangle(
            0.4, 0.4,
            s.material({{"surface", {{"class", "dielectric"}}}, {"outside", "glass"}, {"inside", "void"}}),
            mirror_place(upright));
    });
}
