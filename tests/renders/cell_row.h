// A row of cells, 2 m wide, with black walls between them, seen straight from above by one camera at z =
// 0.05: many small scenes with one kernel. Each cell is compared with a closed form.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/render_probe.h"

namespace etendue {

inline constexpr uint32_t cell_pixels = 16;
inline constexpr double cell_size = 2, reflectance = 0.5, eye_height = 0.05;  // m

struct Cell {
    std::string name;
    std::function<void(SceneBuilder&, double x)> build;  // x: of the cell's middle
    std::function<double(double x, double y)>
        radiance;       // that a point of the floor sends up; x, y from the middle
    bool seen = false;  // `radiance` is of whole pixels, as the camera sees the emitter itself
};

inline const glm::dvec3 up(0, 0, 1);

inline double floor_radiance(double irradiance) { return reflectance / std::numbers::pi * irradiance; }

inline double point_light(double x, double y, double h, double intensity) {
    const double d2 = x * x + y * y + h * h;
    return floor_radiance(intensity * h / (d2 * std::sqrt(d2)));
}

inline void add_floor(SceneBuilder& scene, double x) {
    scene.rectangle(cell_size, cell_size, scene.lambertian(reflectance), at(x, 0, 0));
}

// The mean over a pixel's square, by 4 x 4 points.
inline double pixel_mean(const std::function<double(double, double)>& f, double x, double y, double pixel) {
    double sum = 0;
    for (int i = 0; i < 16; ++i)
        sum += f(x + pixel * ((i % 4 + 0.5) / 4 - 0.5), y + pixel * ((i / 4 + 0.5) / 4 - 0.5)) / 16;
    return sum;
}

inline void check_row(
    const std::vector<Cell>& row, RenderPlan plan,
    const std::function<void(SceneBuilder&)>& prepare = [](SceneBuilder&) {}) {
    SceneBuilder scene;
    prepare(scene);
    const int black = scene.surface({{"class", "absorber"}});
    for (size_t i = 0; i < row.size(); ++i) {
        row[i].build(scene, cell_size * (double(i) + 0.5));
        // Walls from below the floor to above the lights; the light of a cell reaches no other.
        if (i > 0) scene.rectangle(20, 4, black, facing_x(cell_size * double(i), 0, 5));
    }
    scene.orthographic(cell_size / 2, at(cell_size * double(row.size()) / 2, 0, eye_height));
    plan.width = cell_pixels * uint32_t(row.size()), plan.height = cell_pixels;
    const Estimates e = render_estimates(scene.import(), plan);

    std::vector<double> expected(e.mean.size());
    constexpr double pixel = cell_size / cell_pixels;
    for (size_t i = 0; i < row.size(); ++i)
        for (uint32_t y = 0; y < cell_pixels; ++y)
            for (uint32_t x = 0; x < cell_pixels; ++x) {
                const double px = (x + 0.5) * pixel - cell_size / 2, py = cell_size / 2 - (y + 0.5) * pixel;
                const double value =
                    row[i].seen ? row[i].radiance(px, py) : pixel_mean(row[i].radiance, px, py, pixel);
                for (int c = 0; c < 3; ++c)
                    expected[3 * (size_t(y) * plan.width + i * cell_pixels + x) + size_t(c)] = value;
            }
    for (size_t i = 0; i < row.size(); ++i) {
        CAPTURE(row[i].name);
        const Window window = {uint32_t(i) * cell_pixels, 0, cell_pixels, cell_pixels};
        const double wanted = window_mean(expected, plan.width, window);
        const WindowMean m = window_mean(e, window);
        CAPTURE(m.mean);
        CAPTURE(wanted);
        CAPTURE(m.standard_error);
        if (wanted == 0) {
            CHECK(m.mean == 0);
            continue;
        }
        CHECK(std::fabs(m.mean - wanted) < 0.001 * wanted + 4 * m.standard_error);
        CHECK(m.standard_error < 0.003 * wanted);  // otherwise the check above says little
        // Pixel by pixel, with what is left of the pixel means' own error.
        std::vector<double> sd(expected.size());
        for (size_t k = 0; k < sd.size(); ++k) sd[k] = 0.001 * expected[k];
        const Agreement a = agreement(e, expected, 1, sd, window);
        CHECK_MESSAGE(a.holds, describe(a));
    }
}

}  // namespace etendue
