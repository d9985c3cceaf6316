// The primary rainbow: forward rays through a ball of water, in bins of wavelengths, against Descartes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/spectral_value.h"
#include "host/spectra/color.h"
#include "tests/support/render_probe.h"
#include "tests/support/statistics.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr uint32_t bins = 47, columns = 256, seeds = 4;  // bins of 10 nm, columns of 0.012 degrees
// In radii of the drop, which lies in the origin. A lamp on +z sends a beam to one side of it, and of a
// screen across the z axis a strip along x is seen that catches what comes back.
constexpr double lamp_distance = 200, screen_distance = 100, beam_x = 0.86, beam_radius = 0.17;
constexpr double strip_height = 6, reflectance = 0.01, intensity = 1e6;
const double strip_lo = screen_distance * std::tan(40.2 * degree),
             strip_hi = screen_distance * std::tan(43.2 * degree);

// Angle between the light that falls in and the brightest of what returns: the ray of least deviation after
// one reflection inside has cos² i = (n² - 1) / 3 (Descartes 1637; Born & Wolf 1999, section 4.7).
double bow_angle(double n) {
    const double sine = std::sqrt((4 - n * n) / 3);
    return 4 * std::asin(sine / n) - 2 * std::asin(sine);
}

// What becomes of a ray of the lamp at an angle to the z axis, in its plane; +x is away from where it enters.
struct Return {
    double turned;  // rad, from the way it came
    double x;       // where it meets the screen
    double share;   // of the flux, unpolarized
};
Return follow(double n, double angle) {
    const double sine = lamp_distance * std::sin(angle), i = std::asin(sine), r = std::asin(sine / n);
    const double ci = std::cos(i), cr = std::cos(r);
    const double s = (ci - n * cr) / (ci + n * cr), p = (n * ci - cr) / (n * ci + cr);
    const double reflected = 0.5 * (s * s + p * p);
    const double turned = 4 * r - 2 * i;
    // Angles to +z: of the normal where it leaves, of its direction.
    const double normal = turned + angle + i, out = turned + angle;
    const double d = (screen_distance - std::cos(normal)) / std::cos(out);
    return {turned, std::sin(normal) + d * std::sin(out), (1 - reflected) * (1 - reflected) * reflected};
}

double angle_of_ray(double i) { return std::asin(std::sin(i) / lamp_distance); }

// Of the spot, by the angle to its axis (shaders/lights/spot.glsl).
double falloff(double cosine) {
    const double outer = 1 - std::cos(beam_radius / lamp_distance),
                 inner = 1 - std::cos(0.95 * beam_radius / lamp_distance);
    const double t = std::clamp((outer - (1 - cosine)) / (outer - inner), 0.0, 1.0);
    return t * t;
}

// Radiance of the columns of the strip for an intensity of 1 W / (sr nm).
std::vector<double> strip_radiance(double n) {
    constexpr int steps = 6000, turns = 48;
    constexpr double reach = 0.04;  // rad around z that the strip sees
    const double limit = angle_of_ray(std::numbers::pi / 2), from = 0.6 * limit;  // from there to the rim
    const double axis = std::atan(beam_x / lamp_distance), width = (strip_hi - strip_lo) / columns;
    std::vector<double> flux(columns);
    for (int i = 0; i < steps; ++i) {
        const double angle = from + (limit - from) * (i + 0.5) / steps;
        const Return r = follow(n, angle);
        for (int k = 0; k < turns; ++k) {
            const double phi = reach * (2 * (k + 0.5) / turns - 1);
            const double column = (r.x * std::cos(phi) - strip_lo) / width;
            if (std::fabs(r.x * std::sin(phi)) > strip_height / 2 || !(column >= 0 && column < columns))
                continue;
            const double cosine =
                std::sin(angle) * std::cos(phi) * std::sin(axis) + std::cos(angle) * std::cos(axis);
            flux[size_t(column)] +=
                falloff(cosine) * r.share * std::sin(angle) * (limit - from) / steps * 2 * reach / turns;
        }
    }
    for (double& f : flux) f *= reflectance / std::numbers::pi / (strip_height * width);
    return flux;
}

double sum_of(std::span<const double> values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum;
}

double share_below(std::span<const double> strip, double column) {
    return sum_of(strip.first(size_t(std::clamp(column, 0.0, double(columns))))) / sum_of(strip);
}

// The place below which that share of the strip's light lies, in columns.
double quantile(std::span<const double> strip, double share) {
    double left = share * sum_of(strip);
    size_t k = 0;
    while (k + 1 < strip.size() && left > strip[k]) left -= strip[k++];
    return double(k) + left / strip[k];
}

double column_of_bow(double n) {
    const double x = follow(n, angle_of_ray(std::asin(std::sqrt((4 - n * n) / 3)))).x;
    return (x - strip_lo) / (strip_hi - strip_lo) * columns;
}

SceneBuilder drop() {
    SceneBuilder s;
    s.medium("water", {{"ior", {{"name", "water ior"}}}});
    s.sphere(1, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "water"}}), at(0, 0, 0));
    const double middle = 0.5 * (strip_lo + strip_hi), half = 0.5 * (strip_hi - strip_lo);
    s.rectangle(2 * half + 4, strip_height + 4, s.lambertian(reflectance),
                facing_down(middle, 0, screen_distance));
    const double turn = 0.5 * std::atan(beam_x / lamp_distance);
    s.light({{"type", "spot"},
             {"intensity", intensity},
             {"spot",
              {{"innerConeAngle", 0.95 * beam_radius / lamp_distance},
               {"outerConeAngle", beam_radius / lamp_distance}}}},
            {{0, 0, lamp_distance}, {0, std::sin(turn), 0, std::cos(turn)}});
    s.placed("receiver", {{"class", "orthographic"}, {"ymag", strip_height / 2}},
             facing_down(middle, 0, screen_distance - 50));  // looks along +z, +x to the right
    s.scale_last({half / (columns * strip_height / 2), 1, 1});
    return s;
}

}  // namespace

TEST_CASE("a drop of water throws every wavelength back at its angle: a rainbow at 42 degrees") {
    const SpectralTable water = spectral_value({{"name", "water ior"}}, {}, "/test", SpectralKind::index)
                                    .as_table(SpectralKind::index);
    CHECK(bow_angle(water.at(656)) / degree == doctest::Approx(42.3).epsilon(2e-3));
    CHECK(bow_angle(water.at(405)) / degree == doctest::Approx(40.6).epsilon(2e-3));
    double greatest = 0;
    for (int i = 0; i < 10000; ++i)
        greatest = std::max(greatest, follow(1.333, angle_of_ray(1 + 0.5e-4 * i)).turned);
    CHECK(greatest / bow_angle(1.333) == doctest::Approx(1).epsilon(1e-7));

    Scene scene = compile_test_scene(drop().import());
    REQUIRE(scene.features.dispersion);
    RenderSettings settings;
    settings.width = columns, settings.height = 1;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = Algorithm::forward;
    settings.forward_paths = 16;
    settings.spectral_bins = bins;
    Renderer renderer(test_device(), scene, settings);
    std::vector<Image> images;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        if (seed > 0) renderer.restart(seed);
        for (int i = 0; i < 16; ++i) renderer.render_passes(64);
        images.push_back(renderer.develop());
        renderer.add_spectra(images.back());
    }
    Moments brightness;  // of all bins, relative to what is expected, by seed
    std::vector<double> of_seed(seeds);
    double expected_sum = 0, last_edge = 0;
    for (uint32_t bin = 4; bin < 32; ++bin) {
        const double nm = first_nm + 10 * (bin + 0.5);
        CAPTURE(nm);
        std::vector<double> expected(columns), seen(columns);
        for (const double at : {nm - 10.0 / 3, nm, nm + 10.0 / 3}) {
            const std::vector<double> part = strip_radiance(water.at(at));
            for (uint32_t k = 0; k < columns; ++k)
                expected[k] += intensity * white_light().at(at) * part[k] / 3;
        }
        for (uint32_t seed = 0; seed < seeds; ++seed) {
            const auto values =
                plane(images[seed], size_t(find_channel(images[seed], spectral_channel(bin, bins))));
            for (uint32_t k = 0; k < columns; ++k) seen[k] += values[k] / seeds, of_seed[seed] += values[k];
        }
        expected_sum += sum_of(expected);
        // Nearly all of the light lies below the angle of Descartes, and most of it close to that.
        const double edge = quantile(seen, 0.95);
        CHECK(std::fabs(edge - quantile(expected, 0.95)) < 0.85);  // 0.01 degrees
        CHECK(edge > last_edge);
        last_edge = edge;
        CHECK(1 - share_below(seen, column_of_bow(water.at(nm + 5)) + 1) < 0.01);
        CHECK(share_below(seen, column_of_bow(water.at(nm - 5)) - 1) < 0.95);
    }
    for (const double sum : of_seed) brightness.add(sum / expected_sum);
    MESSAGE("brightness relative to what is expected: ", brightness.mean, " +- ",
            brightness.standard_error());
    CHECK(std::fabs(brightness.mean - 1) < 0.002 + 4 * brightness.standard_error());
    CHECK(brightness.standard_error() < 0.01);
}
