// Parts of lines behind what a picture shows.
#include "host/preview/hidden_lines.h"

#include <doctest/doctest.h>

using namespace etendue;

namespace {

constexpr uint32_t width = 60, height = 40;
constexpr double aspect = 1.5, step = 0.01;

// The camera stands at the origin; a wall at z = -2 covers the left half of what it sees.
std::vector<float> wall_depths(const CameraLens& lens) {
    std::vector<float> depth(width * height, 0.0f);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width / 2; ++x) {
            const glm::dvec2 at((x + 0.5) / height - aspect / 2, 0.5 - (y + 0.5) / height);
            const glm::dvec3 ray(at * lens.height, -1);
            depth[y * width + x] = float(lens.parallel ? 2.0 : 2 * glm::length(ray));
        }
    return depth;
}

std::vector<LinePart> parts_of(const CameraLens& lens, const glm::dvec3& from, const glm::dvec3& to) {
    const auto line = seen_line(CameraPose{}, lens, aspect, from, to);
    REQUIRE(line);
    const std::vector<float> depth = wall_depths(lens);
    return part_by_depth(*line, lens, aspect, {width, height, depth}, step);
}

}  // namespace

TEST_CASE("a line is hidden where it lies behind the picture's surfaces") {
    for (const CameraLens lens : {CameraLens{false, 1}, CameraLens{true, 3}}) {
        CAPTURE(lens.parallel);
        const auto behind = parts_of(lens, {-1, 0.1, -4}, {1, 0.1, -4});
        REQUIRE(behind.size() == 2);  // comes out from behind the wall in the middle
        CHECK(behind[0].hidden);
        CHECK(!behind[1].hidden);
        CHECK(behind[0].to.x == doctest::Approx(aspect / 2).epsilon(0.05));
        CHECK(behind[0].to == behind[1].from);
        const auto before = parts_of(lens, {-1, 0.1, -1.5}, {1, 0.1, -1.5});
        REQUIRE(before.size() == 1);
        CHECK(!before[0].hidden);
        // Through the wall, whose surface it crosses at z = -2.
        const glm::dvec3 from(-0.4, 0, -1), to(-0.4, 0.2, -5);
        const auto through = parts_of(lens, from, to);
        REQUIRE(through.size() == 2);
        CHECK(!through[0].hidden);
        CHECK(through[1].hidden);
        const auto crossing = seen_line(CameraPose{}, lens, aspect, glm::mix(from, to, 0.25), to);
        CHECK(glm::length(through[0].to - crossing->at[0]) < 0.05);
    }
}

TEST_CASE("a line on a surface and one outside of the picture are not hidden") {
    const CameraLens lens{false, 1};
    const auto on = parts_of(lens, {-0.8, -0.3, -2}, {-0.1, 0.4, -2});
    REQUIRE(on.size() == 1);
    CHECK(!on[0].hidden);
    const auto outside = parts_of(lens, {-9, 5, -4}, {-9, -5, -4});
    REQUIRE(outside.size() == 1);
    CHECK(!outside[0].hidden);
}
