#include "host/preview/isolines.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

double mark(int step) {
    return std::pow(10.0, std::floor(step / 3.0)) * (step % 3 == 0 ? 1 : (step % 3 + 3) % 3 == 1 ? 2 : 5);
}

// The last mark at or below the value, but for rounding.
int step_below(double value) {
    int step = 3 * int(std::floor(std::log10(value))) + 3;
    while (mark(step) > value * (1 + 1e-9)) --step;
    return step;
}

bool is_narrow(double lowest, double highest) { return highest < 10 * lowest * (1 - 1e-9); }
double even_step(double span) { return mark(step_below(span / 5)); }

}  // namespace

std::vector<double> scale_marks(double lowest, double highest) {
    std::vector<double> marks;
    if (is_narrow(lowest, highest)) {
        const double step = even_step(highest - lowest);
        for (double k = std::ceil(lowest / step - 1e-9); k * step <= highest * (1 + 1e-9); ++k)
            marks.push_back(k * step);
        return marks;
    }
    int step = step_below(lowest);
    if (mark(step) < lowest * (1 - 1e-9)) ++step;
    for (; mark(step) <= highest * (1 + 1e-9); ++step) marks.push_back(mark(step));
    return marks;
}

ValueGrid value_grid(std::span<const glm::vec3> picture, uint32_t width, uint32_t height) {
    ValueGrid grid{std::min(width, most_cells), std::min(height, most_cells), {}};
    grid.values.assign(size_t(grid.columns) * grid.rows, 0);
    std::vector<uint32_t> counts(grid.values.size(), 0);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const glm::vec3& p = picture[size_t(y) * width + x];
            const double value = 0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z;
            if (!std::isfinite(value)) continue;
            const size_t cell =
                size_t(uint64_t(y) * grid.rows / height) * grid.columns + uint64_t(x) * grid.columns / width;
            grid.values[cell] += value, ++counts[cell];
        }
    for (size_t i = 0; i < counts.size(); ++i) grid.values[i] /= std::max(1u, counts[i]);
    return grid;
}

std::optional<std::pair<double, double>> scale_range(const ValueGrid& grid) {
    double greatest = 0;
    for (double value : grid.values) greatest = std::max(greatest, value);
    if (!(greatest > 1e-30)) return {};
    double least = greatest;
    for (double value : grid.values)
        if (value > 1e-3 * greatest) least = std::min(least, value);
    if (is_narrow(least, greatest)) {
        const double step = even_step(std::max(greatest - least, 0.02 * greatest));
        const double low = std::max(std::floor(least / step), 1.0) * step,
                     high = std::ceil(greatest / step) * step;
        return std::pair(low, std::max(high, low + step));
    }
    int top = step_below(greatest);
    if (mark(top) < greatest * (1 - 1e-9)) ++top;
    return std::pair(mark(step_below(least)), mark(top));
}

std::vector<LinePiece> isoline(const ValueGrid& grid, double value) {
    std::vector<LinePiece> pieces;
    const auto at = [&](uint32_t x, uint32_t y) { return grid.values[size_t(y) * grid.columns + x]; };
    const glm::vec2 cells(grid.columns, grid.rows);
    for (uint32_t y = 0; y + 1 < grid.rows; ++y)
        for (uint32_t x = 0; x + 1 < grid.columns; ++x) {
            // Around the square; where the line crosses its sides.
            const glm::uvec2 corners[] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
            glm::vec2 crossings[4];
            int count = 0;
            for (int side = 0; side < 4; ++side) {
                const glm::uvec2 a = corners[side], b = corners[(side + 1) % 4];
                const double from = at(a.x, a.y), to = at(b.x, b.y);
                if ((from < value) == (to < value)) continue;
                const float t = float((value - from) / (to - from));
                crossings[count++] = (glm::mix(glm::vec2(a), glm::vec2(b), t) + 0.5f) / cells;
            }
            // At a saddle the middle says which corners belong together.
            const double middle = 0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1));
            const bool turned = count == 4 && (middle < value) == (at(x, y) < value);
            if (count == 2) pieces.push_back({crossings[0], crossings[1]});
            if (count == 4) {
                pieces.push_back({crossings[0], crossings[turned ? 1 : 3]});
                pieces.push_back({crossings[2], crossings[turned ? 3 : 1]});
            }
        }
    return pieces;
}

}  // namespace etendue
