// Free paths: where light scatters, and what is left of every lane.
#include <algorithm>
#include <cmath>

#include "tests/support/statistics.h"
#include "tests/support/surface_probe.h"

using namespace etendue;

namespace {

struct FreePaths {
    struct Path {
        float distance;
        uint32_t scatters;
        glm::vec3 weight;
        float passage;
    };
    Buffer paths{test_device(), uint64_t(1 << 20) * sizeof(Path), "Paths"};
    Kernel kernel = make_test_kernel("sample_free_path.comp", test_kernel_text("sample_free_path.comp"),
                                     {{"Paths", &paths}});
    std::vector<Path> sample(uint32_t count, uint32_t steps, glm::vec3 extinction, glm::vec3 scattering,
                             glm::vec3 carried, float distance) {
        CommandList commands(test_device());
        commands.dispatch(kernel, (count + 63) / 64,
                          {{"count", count},
                           {"seed", 11u},
                           {"steps", steps},
                           {"extinction_r", extinction.x},
                           {"extinction_g", extinction.y},
                           {"extinction_b", extinction.z},
                           {"scattering_r", scattering.x},
                           {"scattering_g", scattering.y},
                           {"scattering_b", scattering.z},
                           {"carried_r", carried.x},
                           {"carried_g", carried.y},
                           {"carried_b", carried.z},
                           {"distance", distance}});
        commands.run();
        return paths.read_array<Path>(count);
    }
};

}  // namespace

TEST_CASE("free paths: of every lane what Beer and Lambert say is left, and scatters in every layer") {
    FreePaths probe;
    constexpr uint32_t count = 1 << 20, layers = 16;
    const glm::vec3 extinction(0.3f, 2, 8), scattering(0.3f, 1.5f, 2), carried(0.7f, 0.2f, 1.1f);
    constexpr float distance = 1.5f;
    const auto paths = probe.sample(count, 0, extinction, scattering, carried, distance);
    double share[3], worst = 0;
    for (int c = 0; c < 3; ++c) share[c] = carried[c] / double(carried.x + carried.y + carried.z);
    std::vector<double> observed(layers + 1), expected(layers + 1);
    Moments scattered[3][layers], passed[3];
    for (const auto& p : paths) {
        const uint32_t layer =
            p.scatters ? std::min(layers - 1, uint32_t(p.distance / distance * layers)) : layers;
        REQUIRE(p.distance <= distance);
        observed[layer]++;
        double sum = 0, left = 0;
        const double luminance[3] = {0.2126, 0.7152, 0.0722};
        for (int c = 0; c < 3; ++c) {
            for (uint32_t k = 0; k < layers; ++k) scattered[c][k].add(k == layer ? p.weight[c] : 0);
            passed[c].add(layer == layers ? p.weight[c] : 0);
            sum += share[c] * p.weight[c];
            left += luminance[c] * std::exp(-double(extinction[c]) * p.distance);
        }
        worst = std::max(worst, sum);
        CHECK(p.passage == doctest::Approx(left).epsilon(1e-5));
    }
    CHECK(worst < 1 + 1e-5);  // what the lanes carry together never grows
    const auto left = [&](int c, uint32_t k) {
        return std::exp(-double(extinction[c]) * distance * k / layers);
    };
    for (int c = 0; c < 3; ++c) {
        CHECK(std::fabs(passed[c].mean - left(c, layers)) < 5 * passed[c].standard_error());
        for (uint32_t k = 0; k < layers; ++k) {
            const double part = left(c, k) - left(c, k + 1);
            expected[k] += count * share[c] * part;
            CHECK(std::fabs(scattered[c][k].mean - part * scattering[c] / extinction[c]) <
                  5 * scattered[c][k].standard_error());
        }
        expected[layers] += count * share[c] * left(c, layers);
    }
    CHECK(chi_squared_test(observed, expected).p_value > 1e-4);
}

TEST_CASE("free paths: thin media scatter as seldom as they should, thick ones at once") {
    FreePaths probe;
    // Of 2^24 values of the second number, 1e-6 * 2^24 = 16.777 lead to an event: 16 of the first 17 and a
    // part of the last.
    constexpr uint32_t steps = 17, count = steps << 15;
    size_t events = 0;
    for (const auto& p : probe.sample(count, steps, glm::vec3(1e-6f), glm::vec3(1e-6f), glm::vec3(1), 1))
        events += p.scatters;
    CHECK(std::fabs(double(events) / count * steps - 16.777216) <
          5 * std::sqrt(0.777 * 0.223 / (count / steps)));
    // A lane that nothing happens to, one that passes nothing.
    for (const auto& p : probe.sample(4096, 0, {0, 1e4f, 1e4f}, {0, 9999, 1e4f}, {0, 1, 1}, 1)) {
        CHECK(p.scatters == 1);
        CHECK(p.distance < 2e-3f);
        CHECK(p.weight.y == doctest::Approx(0.9999).epsilon(1e-5));
    }
    for (const auto& p : probe.sample(4096, 0, {0, 1e4f, 1e4f}, {0, 9999, 1e4f}, {1, 0, 0}, 1)) {
        CHECK(p.scatters == 0);
        CHECK(p.weight.x == doctest::Approx(1));
    }
}
