// Isolines and the range of a scale, without a device.
#include "host/preview/isolines.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace etendue;

TEST_CASE("marks of a scale are 1, 2 and 5 of every decade, within one even steps") {
    CHECK(scale_marks(0.01, 1) == std::vector<double>{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1});
    const auto marks = scale_marks(3, 60);
    REQUIRE(marks.size() == 4);
    CHECK(marks.front() == doctest::Approx(5));
    CHECK(marks.back() == doctest::Approx(50));
    const auto even = scale_marks(280, 560);
    REQUIRE(even.size() == 6);
    CHECK(even.front() == doctest::Approx(300));
    CHECK(even.back() == doctest::Approx(550));
}

TEST_CASE("the line of a value in a cone is a circle, closed, whatever the picture's size") {
    for (const uint32_t size : {64u, 640u}) {
        CAPTURE(size);
        std::vector<glm::vec3> picture;
        for (uint32_t y = 0; y < size; ++y)
            for (uint32_t x = 0; x < size; ++x) {
                const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) / double(size) - 0.5;
                picture.push_back(glm::vec3(100 * (1 - glm::length(p))));
            }
        const ValueGrid grid = value_grid(picture, size, size);
        CHECK(grid.columns <= most_cells);
        const auto range = scale_range(grid);
        REQUIRE(range);
        CHECK(range->first == doctest::Approx(30));
        CHECK(range->second >= 99);
        double length = 0;
        for (const LinePiece& piece : isoline(grid, 70)) {
            length += glm::length(piece.to - piece.from);
            CHECK(glm::length(piece.from - 0.5f) == doctest::Approx(0.3).epsilon(0.01));
        }
        CHECK(length == doctest::Approx(2 * 3.14159265 * 0.3).epsilon(0.01));
        CHECK(isoline(grid, 101).empty());
    }
    const auto wide = scale_range({3, 1, {0, 3, 700}}), same = scale_range({2, 1, {5, 5}});
    REQUIRE((wide && same));
    CHECK(wide->first == doctest::Approx(2));
    CHECK(wide->second == doctest::Approx(1000));
    CHECK((same->first < same->second && same->first <= 5 && same->second >= 5));
    CHECK(!scale_range(value_grid(std::vector<glm::vec3>(4, glm::vec3(0)), 2, 2)));
}

TEST_CASE("at a saddle two pieces part what belongs apart") {
    const ValueGrid grid{2, 2, {1, 0, 0, 1}};
    for (const double value : {0.4, 0.6}) {
        const auto pieces = isoline(grid, value);
        REQUIRE(pieces.size() == 2);
        for (const LinePiece& piece : pieces) {
            // Above the middle's value the corners of 1 are cut off each, below it those of 0.
            const glm::vec2 m = 0.5f * (piece.from + piece.to) - 0.5f;
            CHECK((m.x * m.y > 0) == (value > 0.5));
        }
    }
}
