// Sums that do not depend on the order: of values from 1e-12 to 1e12, in any order and grouping, the same
// bits, and the right ones.
#include "host/render/exact_sum.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace etendue;

namespace {

using Random = std::mt19937;

// Magnitudes 10^a to 10^b, evenly in the logarithm; a part of them negative, some zero.
std::vector<glm::vec3> values_between(Random& random, size_t count, double a, double b) {
    std::uniform_real_distribution<double> exponent(a, b), uniform;
    std::vector<glm::vec3> values(count);
    for (glm::vec3& v : values)
        for (int c = 0; c < 3; ++c) {
            const double u = uniform(random);
            v[c] = u < 0.1 ? 0.0f : float((u < 0.3 ? -1 : 1) * std::pow(10, exponent(random)));
        }
    return values;
}

ExactSum sum_of(const std::vector<glm::vec3>& values) {
    ExactSum sum;
    for (const glm::vec3& v : values) add_exactly(sum, v);
    return sum;
}

// Cut into parts at random, which are merged in random pairs.
ExactSum merged_at_random(Random& random, std::vector<glm::vec3> values) {
    std::shuffle(values.begin(), values.end(), random);
    std::vector<ExactSum> parts;
    for (size_t first = 0; first < values.size();) {
        const size_t end = std::min(values.size(), first + random() % 40);
        parts.push_back(sum_of({values.begin() + long(first), values.begin() + long(end)}));
        first = end;
    }
    while (parts.size() > 1) {
        const size_t i = random() % parts.size();
        const ExactSum part = parts[i];
        parts.erase(parts.begin() + long(i));
        merge(parts[random() % parts.size()], part);
    }
    return parts[0];
}

}  // namespace

TEST_CASE("an exact sum has the same bits in any order and however it is parted") {
    for (uint32_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        for (const auto& [a, b] : {std::pair{-6.0, 6.0}, {-12.0, 12.0}, {-3.0, 0.0}, {-37.0, 38.0}}) {
            const std::vector<glm::vec3> values = values_between(random, 1000, a, b);
            const ExactSum expected = sum_of(values);
            for (int i = 0; i < 10; ++i) CHECK(merged_at_random(random, values) == expected);
        }
    }
}

TEST_CASE("an exact sum is right to 2^-24 of the largest value, and exact where values are alike") {
    Random random(1);
    for (const auto& [a, b] :
         {std::pair{-6.0, 6.0}, {-12.0, 12.0}, {-37.0, -30.0}, {30.0, 38.0}, {0.0, 2.0}}) {
        const std::vector<glm::vec3> values = values_between(random, 1000, a, b);
        const glm::dvec3 sum = value(sum_of(values));
        for (int c = 0; c < 3; ++c) {
            long double expected = 0;  // 64 bits
            float largest = 0;
            for (const glm::vec3& v : values)
                expected += v[c],
                    largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
            CHECK(std::fabs(double(sum[c] - expected)) <= 1000 * std::ldexp(double(largest), -24));
            if (a == 0) CHECK(sum[c] == double(expected));
        }
    }
    ExactSum constant;  // no float holds this sum
    for (int i = 0; i < 1000000; ++i) add_exactly(constant, {0.1f, -0.09f, 0.4f});
    CHECK(value(constant) == 1e6 * glm::dvec3(0.1f, -0.09f, 0.4f));
}

TEST_CASE("an exact sum of one value is that value; of none it is nothing") {
    CHECK(value(ExactSum()) == glm::dvec3(0));
    for (int e = -119; e < 128; ++e)
        for (const float v : {std::ldexp(1.0f, e), std::ldexp(-1.9999999f, e)})
            CHECK(value(sum_of({glm::vec3(v, 0, -v)})) == glm::dvec3(double(v), 0, -double(v)));
}
