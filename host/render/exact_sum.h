// Sums whose bits do not depend on the order of the additions: twin of shaders/lib/exact_sum.glsl, which says
// how and why.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace etendue {

struct ExactSum {
    uint32_t window = 0;
    std::array<uint32_t, 3> upper{}, lower{}, upper_high{}, lower_high{};
    bool operator==(const ExactSum&) const = default;
};
static_assert(sizeof(ExactSum) == 52);

// Adds what another sum has come to: the same bits as if all its values had been added to this one.
void merge(ExactSum& sum, const ExactSum& other);

// One a pixel and quantity, side by side; as many in both.
void merge(std::span<ExactSum> sums, std::span<const ExactSum> others);

// Each correctly rounded once.
glm::dvec3 value(const ExactSum& sum);

// The device's addition, for tests and for whatever sums on the host.
void add_exactly(ExactSum& sum, const glm::vec3& value);

}  // namespace etendue
