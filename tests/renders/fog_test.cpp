// Light scattered once in thin fog, against quadrature in double precision, whichever way rays go: a point
// light within the fog, and a constant sky above it. The fog lies in a row of boxes with different phase
// functions.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/phase_cases.h"
#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
// A cell of the row is 2 m wide and 16 pixels; the box takes 14 of them and reaches from z = -1 to 0.
constexpr uint32_t cell_pixels = 16;
constexpr double half = 0.875, lamp_z = -0.5, lamp_intensity = 3, sky = 2;
// So little scatters that what does so twice is below 1e-4 of what does so once.
constexpr double scattering[3] = {1e-4, 2e-4, 0.5e-4}, absorption[3] = {1, 0.5, 2};

std::vector<PhaseCase> phases() { return {isotropic_phase(), lobe_phase(0.6), lobe_phase(-0.4)}; }

// What arrives at a point of the box from all directions and leaves upward: the sum of radiance times phase
// function, per unit of scattering coefficient, for the three channels' extinction in 1/m.
using Source = std::function<glm::dvec3(const PhaseCase&, const glm::dvec3&, const glm::dvec3& extinction)>;

glm::dvec3 from_lamp(const PhaseCase& phase, const glm::dvec3& p, const glm::dvec3& extinction) {
    const glm::dvec3 d = p - glm::dvec3(0, 0, lamp_z);
    const double r = glm::length(d);
    return lamp_intensity * phase.value(d.z / r) / (r * r) * glm::exp(-extinction * r);
}

// Through the top alone: walls and floor are black.
glm::dvec3 from_sky(const PhaseCase& phase, const glm::dvec3& p, const glm::dvec3& extinction) {
    constexpr int n = 40, turns = 64;
    glm::dvec3 sum(0);
    for (int i = 0; i < n; ++i) {
        // Denser towards the zenith and the horizon: midpoints of mu = (1 - cos t) / 2.
        const double t = pi * (i + 0.5) / n, mu = 0.5 * (1 - std::cos(t));
        const double solid_angle = 0.5 * std::sin(t) * pi / n * 2 * pi / turns;
        const double reach = -p.z * std::sqrt(1 - mu * mu) / mu;
        int open = 0;
        for (int k = 0; k < turns; ++k) {
            const double phi = 2 * pi * (k + 0.5) / turns;
            open += std::fabs(p.x + reach * std::cos(phi)) < half &&
                    std::fabs(p.y + reach * std::sin(phi)) < half;
        }
        if (open > 0) sum += open * solid_angle * sky * phase.value(-mu) * glm::exp(extinction * p.z / mu);
    }
    return sum;
}

std::vector<double> expected_image(const Source& source) {
    const std::vector<PhaseCase> all = phases();
    const uint32_t width = cell_pixels * uint32_t(all.size());
    constexpr int over = 2, steps = 24;  // points of a pixel on each axis, and of its ray
    const glm::dvec3 coefficient(scattering[0], scattering[1], scattering[2]);
    const glm::dvec3 extinction = coefficient + glm::dvec3(absorption[0], absorption[1], absorption[2]);
    std::vector<double> image(3 * size_t(width) * cell_pixels);
    for (uint32_t y = 0; y < cell_pixels; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            glm::dvec3 sum(0);
            for (int i = 0; i < over * over; ++i)
                for (int k = 0; k < steps; ++k) {
                    const glm::dvec3 p = {2 * (x % cell_pixels + (i % over + 0.5) / over) / cell_pixels - 1,
                                          1 - 2 * (y + (i / over + 0.5) / over) / cell_pixels,
                                          -(k + 0.5) / steps};
                    if (std::fabs(p.x) > half || std::fabs(p.y) > half) continue;
                    sum += source(all[x / cell_pixels], p, extinction) * glm::exp(extinction * p.z);
                }
            sum *= coefficient / double(over * over * steps);
            for (int c = 0; c < 3; ++c) image[3 * (size_t(y) * width + x) + size_t(c)] = sum[c];
        }
    return image;
}

SceneBuilder boxes_of_fog() {
    SceneBuilder s;
    const std::vector<PhaseCase> all = phases();
    for (size_t i = 0; i < all.size(); ++i) {
        const std::string name = "fog " + std::to_string(i);
        s.medium(name, {{"scattering", scattering}, {"absorption", absorption}, {"phase", all[i].record}});
        const int skin = s.material({{"surface", {{"class", "boundary"}}}, {"inside", name}});
        add_box(s, {2 * float(half), 2 * float(half), 1}, skin, false, at(2 * double(i) + 1, 0, -0.5));
    }
    s.orthographic(1, at(double(all.size()), 0, 1));
    return s;
}

void check_fog(const SceneBuilder& s, const Source& source, uint32_t backward, uint32_t both) {
    Scene scene = compile_test_scene(s.import());
    const std::vector<double> expected = expected_image(source);
    const std::vector<PhaseCase> all = phases();
    RenderPlan plan;
    plan.height = cell_pixels, plan.width = cell_pixels * uint32_t(all.size()), plan.seeds = 16;
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        plan.algorithm = algorithm;
        plan.passes = algorithm == Algorithm::backward ? backward : both;
        plan.forward_paths = algorithm == Algorithm::forward ? 16 : 4;
        const Estimates e = render_estimates(scene, plan);
        for (uint32_t i = 0; i < all.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                // Beside the lamp, which would be seen, and away from the edges.
                const Window w = {cell_pixels * i + 2, 2, 12, 4};
                const WindowMean m = window_mean(e, w, c);
                const double wanted = window_mean(expected, plan.width, w, c);
                CAPTURE(algorithm_name(algorithm));
                CAPTURE(i);
                CAPTURE(c);
                CAPTURE(m.mean / wanted);
                CHECK(std::fabs(m.mean - wanted) < 1e-3 * wanted + 4 * m.standard_error);
                CHECK(m.standard_error < 0.01 * wanted);
            }
    }
}

}  // namespace

TEST_CASE("fog around a point light is as bright as the integral of what it scatters once") {
    SceneBuilder s = boxes_of_fog();
    const int black = s.surface({{"class", "absorber"}});
    for (size_t i = 0; i < phases().size(); ++i) {
        s.light({{"type", "point"}, {"intensity", lamp_intensity}}, at(2 * double(i) + 1, 0, lamp_z));
        if (i > 0) s.rectangle(4, 4, black, facing_x(2 * double(i), 0, 0));
    }
    check_fog(s, from_lamp, 96, 32);
}

TEST_CASE("fog under a constant sky is as bright as the integral of what it scatters once") {
    SceneBuilder s = boxes_of_fog();
    const int black = s.surface({{"class", "absorber"}});
    for (size_t i = 0; i < phases().size(); ++i) {
        const double x = 2 * double(i) + 1;
        s.rectangle(2, 2, black, at(x, 0, -1));
        for (const double side : {-1.0, 1.0}) {
            s.rectangle(1, 2 * half, black, facing_x(x + side * half, 0, -0.5));
            s.rectangle(2 * half, 1, black,
                        {{x, side * half, -0.5}, {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}});
        }
    }
    s.environment(sky);
    check_fog(s, from_sky, 192, 64);
}
