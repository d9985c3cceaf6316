// Lines of equal values over a picture, and the range of a scale for it.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

// Round numbers from `lowest` to `highest`, 0 < lowest < highest: 1, 2 and 5 of every decade, within a
// decade even steps.
std::vector<double> scale_marks(double lowest, double highest);

// A picture's values, averaged over blocks so that noise does not tear its lines: at most `most_cells` along
// each side.
struct ValueGrid {
    uint32_t columns = 0, rows = 0;
    std::vector<double> values;  // luminances, or what else a pixel of (1, 1, 1) is one of; rows from the top
};
constexpr uint32_t most_cells = 48;
ValueGrid value_grid(std::span<const glm::vec3> picture, uint32_t width, uint32_t height);

// Between round numbers, around all values above a thousandth of the greatest. Nothing where all is dark.
std::optional<std::pair<double, double>> scale_range(const ValueGrid& grid);

// Pieces of the line along which the grid, bilinear between the middles of its cells, has the value: in parts
// of the picture's width and height from the upper left (marching squares: Lorensen & Cline 1987 in two
// dimensions).
struct LinePiece {
    glm::vec2 from, to;
};
std::vector<LinePiece> isoline(const ValueGrid& grid, double value);

}  // namespace etendue
