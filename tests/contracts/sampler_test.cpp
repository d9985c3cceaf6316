// The scrambled Sobol' sampler, on the device: stratification, uniformity, independence, convergence.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/device_fixture.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double false_alarm = 1e-4;

struct Pair {
    float x, y;
};

// pairs[(pixel * samples + sample) * dimensions + dimension]; pixels lie in a row of 256 each. Samples are
// those of the even passes, or of the odd ones.
std::vector<Pair> draw_pairs(uint32_t pixels, uint32_t samples, uint32_t dimensions,
                             uint32_t first_sample = 0, uint32_t seed = 0, uint32_t odd = 0,
                             bool independent = false) {
    Buffer out(test_device(), uint64_t(pixels) * samples * dimensions * sizeof(Pair), "pairs");
    const Kernel kernel = make_test_kernel("draw_pairs",
                                           fmt::format("#define INDEPENDENT_SAMPLES {:d}\n", independent) +
                                               R"(
        #include "lib/sampler.glsl"
        layout(local_size_x = 64) in;
        layout(scalar, set = 0) buffer Pairs { vec2 pairs[]; };
        layout(push_constant) uniform Push { uint pixel_count, sample_count, dimension_count, first_sample, seed, odd; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= pixel_count * sample_count) return;
            uint pixel = i / sample_count;
            Sampler s = start_sampler(uvec2(pixel & 255u, pixel >> 8), 2u * (first_sample + i % sample_count) + odd, seed);
            for (uint d = 0u; d < dimension_count; d++) pairs[i * dimension_count + d] = sample_2d(s);
        }
    )",
                                           {{"Pairs", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, (pixels * samples + 63) / 64,
                  {{"pixel_count", pixels},
                   {"sample_count", samples},
                   {"dimension_count", dimensions},
                   {"first_sample", first_sample},
                   {"seed", seed},
                   {"odd", odd}});
    list.run();
    return out.read_array<Pair>(uint64_t(pixels) * samples * dimensions);
}

// Counts of points over an n x n grid.
struct Grid {
    uint32_t n;
    std::vector<double> counts = std::vector<double>(size_t(n) * n);
    void add(float x, float y) { counts[uint32_t(y * n) * n + uint32_t(x * n)] += 1; }
    double statistic() const {  // Pearson's
        double total = 0, squares = 0;
        for (double c : counts) total += c;
        for (double c : counts) squares += (c - total / counts.size()) * (c - total / counts.size());
        return squares / (total / counts.size());
    }
    double p_value() const { return chi2_survival(statistic(), double(counts.size() - 1)); }
};

// Every elementary interval of area 1 / count holds one of the points.
bool is_net(const Pair* points, size_t stride, uint32_t log_count) {
    const uint32_t count = 1u << log_count;
    for (uint32_t log_x = 0; log_x <= log_count; ++log_x) {
        std::vector<char> taken(count, 0);
        for (uint32_t i = 0; i < count; ++i) {
            const Pair p = points[i * stride];
            const uint32_t x = uint32_t(p.x * float(1u << log_x)), y = uint32_t(p.y * float(count >> log_x));
            char& cell = taken[y << log_x | x];
            if (cell) return false;
            cell = 1;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("sampler: every aligned power of two of a pair's even or odd passes is a (0,2)-net") {
    const uint32_t pixels = 16, samples = 1024, dimensions = 4;
    for (uint32_t odd : {0u, 1u}) {
        const auto pairs = draw_pairs(pixels, samples, dimensions, 0, 7, odd);
        for (uint32_t pixel = 0; pixel < pixels; ++pixel)
            for (uint32_t d = 0; d < dimensions; ++d)
                for (uint32_t log_count = 0; log_count <= 10; ++log_count)
                    for (uint32_t first = 0; first < samples; first += 1u << log_count)
                        REQUIRE(is_net(&pairs[(pixel * samples + first) * dimensions + d], dimensions,
                                       log_count));
    }
}

TEST_CASE("sampler: late samples are stratified like early ones") {
    const auto pairs = draw_pairs(1, 4096, 2, 1u << 20);
    CHECK(is_net(&pairs[0], 2, 12));
    CHECK(is_net(&pairs[1], 2, 12));
}

TEST_CASE("sampler: numbers are multiples of 2^-24 in [0, 1)") {
    for (const Pair& p : draw_pairs(256, 256, 8)) {
        for (float v : {p.x, p.y}) {
            REQUIRE(v >= 0.0f);
            REQUIRE(v < 1.0f);
            REQUIRE(std::floor(v * 16777216.0f) == v * 16777216.0f);
        }
    }
}

TEST_CASE("sampler: over pixels, the numbers of a sample are uniform and independent of their neighbours'") {
    const uint32_t pixels = 65536, dimensions = 3;
    const size_t tests = 2 * (dimensions * 2 + 2);
    for (uint32_t sample : {0u, 1000u}) {
        const auto pairs = draw_pairs(pixels, 1, dimensions, sample);
        const auto at = [&](uint32_t pixel, uint32_t d) { return pairs[pixel * dimensions + d]; };
        for (uint32_t d = 0; d < dimensions; ++d) {
            Grid pair{32}, next_dimension{32};
            for (uint32_t i = 0; i < pixels; ++i) {
                pair.add(at(i, d).x, at(i, d).y);
                next_dimension.add(at(i, d).x, at(i, (d + 1) % dimensions).x);
            }
            CHECK(pair.p_value() > sidak_level(false_alarm, tests));
            CHECK(next_dimension.p_value() > sidak_level(false_alarm, tests));
        }
        Grid right{32}, below{32};
        for (uint32_t i = 0; i + 256 < pixels; ++i) {
            if (i % 256 < 255) right.add(at(i, 0).x, at(i + 1, 0).x);
            below.add(at(i, 0).y, at(i + 256, 0).y);
        }
        CHECK(right.p_value() > sidak_level(false_alarm, tests));
        CHECK(below.p_value() > sidak_level(false_alarm, tests));
    }
}

TEST_CASE(
    "sampler: over a pixel's samples, pairs are independent of one another, of the next pixel's and of the "
    "other half's") {
    // A block of 16 samples puts one point in each row and column of a 16 x 16 table. With independent
    // scrambles each cell's count over the 64 blocks has variance 64 (1/16) (15/16), so Pearson's statistic
    // has the mean 256 * 3.75 / 4 = 240. (Its variance is larger than chi-squared's: the cells that a block
    // can take together depend on one another.)
    const uint32_t pixels = 64, samples = 1024, dimensions = 6;
    const auto pairs = draw_pairs(pixels, samples, dimensions, 0, 3);
    const auto at = [&](uint32_t pixel, uint32_t sample, uint32_t d) {
        return pairs[(pixel * samples + sample) * dimensions + d];
    };
    const auto odd_pairs = draw_pairs(pixels, samples, dimensions, 0, 3, 1);
    Moments xx_moments, xy_moments, pixel_moments, half_moments;
    for (uint32_t pixel = 0; pixel < pixels; ++pixel)
        for (uint32_t d = 0; d + 1 < dimensions; ++d) {
            Grid xx{16}, xy{16}, pixel_to_pixel{16}, half_to_half{16};
            for (uint32_t i = 0; i < samples; ++i) {
                xx.add(at(pixel, i, d).x, at(pixel, i, d + 1).x);
                xy.add(at(pixel, i, d).x, at(pixel, i, d + 1).y);
                pixel_to_pixel.add(at(pixel, i, d).x, at((pixel + 1) % pixels, i, d).x);
                half_to_half.add(at(pixel, i, d).x, odd_pairs[(pixel * samples + i) * dimensions + d].x);
            }
            xx_moments.add(xx.statistic()), xy_moments.add(xy.statistic()),
                pixel_moments.add(pixel_to_pixel.statistic()), half_moments.add(half_to_half.statistic());
        }
    for (const Moments& m : {xx_moments, xy_moments, pixel_moments, half_moments}) {
        CAPTURE(m.mean);
        CHECK(z_test(m.mean, 240.0, m.standard_error()) > sidak_level(false_alarm, 4));
    }
}

TEST_CASE(
    "sampler: independent numbers are uniform, and pairs, pixels and halves independent, as random ones "
    "are") {
    const uint32_t samples = 65536;
    const auto pairs = draw_pairs(2, samples, 2, 0, 5, 0, true),
               odd = draw_pairs(2, samples, 2, 0, 5, 1, true);
    Grid pair{32}, next_dimension{32}, next_pixel{32}, other_half{32}, next_sample{32};
    for (uint32_t i = 0; i < samples; ++i) {
        const Pair p = pairs[2 * i];
        pair.add(p.x, p.y);
        next_dimension.add(p.x, pairs[2 * i + 1].x);
        next_pixel.add(p.x, pairs[2 * (samples + i)].x);
        other_half.add(p.x, odd[2 * i].x);
        if (i % 2 == 0) next_sample.add(p.x, pairs[2 * i + 2].x);
    }
    for (const Grid& grid : {pair, next_dimension, next_pixel, other_half, next_sample}) {
        CHECK(grid.p_value() > sidak_level(false_alarm, 5));
        // Points of a net would fill the cells evenly.
        CHECK(1 - grid.p_value() > sidak_level(false_alarm, 5));
    }
}

TEST_CASE("sampler: a smooth integrand converges faster than with random numbers") {
    // f = exp(x + y) on one pair, and a product over two pairs. Random numbers would give sqrt(variance / n).
    const uint32_t pixels = 256;
    const double e1 = std::exp(1.0) - 1, e2 = (std::exp(2.0) - 1) / 2;
    const double variance_pair = e2 * e2 - e1 * e1 * e1 * e1,
                 variance_two = std::pow(e2, 4) - std::pow(e1, 8);
    for (uint32_t samples : {64u, 1024u}) {
        const auto pairs = draw_pairs(pixels, samples, 2);
        double pair_error = 0, two_error = 0;
        for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
            double pair_sum = 0, two_sum = 0;
            for (uint32_t i = 0; i < samples; ++i) {
                const Pair a = pairs[(pixel * samples + i) * 2], b = pairs[(pixel * samples + i) * 2 + 1];
                pair_sum += std::exp(a.x + a.y);
                two_sum += std::exp(double(a.x) + a.y + b.x + b.y);
            }
            pair_error += std::pow(pair_sum / samples - e1 * e1, 2) / pixels;
            two_error += std::pow(two_sum / samples - std::pow(e1, 4), 2) / pixels;
        }
        const double pair_gain = std::sqrt(variance_pair / samples / pair_error);
        const double two_gain = std::sqrt(variance_two / samples / two_error);
        MESSAGE(samples, " samples: error ", pair_gain, " times smaller than random on one pair, ", two_gain,
                " on two");
        CHECK(pair_gain > (samples == 64 ? 10 : 100));
        CHECK(two_gain > 1.5);
    }
}
