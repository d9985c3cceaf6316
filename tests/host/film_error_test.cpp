// The error told from a film whose samples are made here, with a known variance and a known bias.
#include "host/render/film_error.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace etendue;

namespace {

constexpr uint32_t size = 64;
using Random = std::mt19937;

FilmSums film_of(uint32_t passes, const std::function<glm::dvec3(uint32_t pixel, uint32_t pass)>& sample,
                 const std::function<glm::dvec3(uint32_t pixel, uint32_t pass)>& bias = {}) {
    FilmSums film{size, size, (passes + 1) / 2, passes / 2, std::vector<FilmPixel>(size * size), {}};
    if (bias) film.bias.resize(film.pixels.size());
    for (uint32_t i = 0; i < film.pixels.size(); ++i) {
        glm::dvec3 sums[2] = {}, squares[2] = {}, biases[2] = {};
        for (uint32_t pass = 0; pass < passes; ++pass) {
            const glm::dvec3 x = sample(i, pass), d = bias ? bias(i, pass) : glm::dvec3(0);
            sums[pass % 2] += x, squares[pass % 2] += x * x, biases[pass % 2] += d;
        }
        film.pixels[i] = {{sums[0], sums[1]}, {squares[0], squares[1]}};
        if (bias) film.bias[i] = {{biases[0], biases[1]}};
    }
    return film;
}

struct Coverage {
    double rms = 0, within_one = 0, within_two = 0;  // of (mean - truth) / error
};
Coverage coverage(const FilmSums& film, const std::function<glm::dvec3(uint32_t)>& truth) {
    const std::vector<glm::vec3> errors = estimate_errors(film);
    Coverage result;
    const double count = 3.0 * double(errors.size());
    for (uint32_t i = 0; i < errors.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double z = (mean(film, film.pixels[i])[c] - truth(i)[c]) / double(errors[i][c]);
            result.rms += z * z / count;
            result.within_one += std::fabs(z) <= 1 ? 1 / count : 0;
            result.within_two += std::fabs(z) <= 2 ? 1 / count : 0;
        }
    result.rms = std::sqrt(result.rms);
    MESSAGE(film.passes(), " passes: rms z ", result.rms, ", within 1 error ", result.within_one,
            ", within 2 ", result.within_two);
    return result;
}

double root_mean_square(const std::vector<glm::vec3>& values) {
    double sum = 0;
    for (const glm::vec3& v : values) sum += glm::dot(glm::dvec3(v), glm::dvec3(v)) / 3;
    return std::sqrt(sum / double(values.size()));
}

// 64² pixels of three channels: the fractions vary by 0.01 at most between seeds, the rms by a little more
// where few passes make the error itself uncertain.
void check_honest(const Coverage& c, double rms_tolerance) {
    CHECK(std::fabs(c.rms - 1) < rms_tolerance);
    CHECK(std::fabs(c.within_one - 0.683) < 0.05);
    CHECK(std::fabs(c.within_two - 0.954) < 0.02);
}

}  // namespace

TEST_CASE("the error of independent samples, from two passes on") {
    for (const uint32_t passes : {2u, 3u, 4u, 5u, 16u, 65u}) {
        Random random(passes);
        std::normal_distribution<double> normal;
        // The noise grows a hundredfold from left to right.
        const auto scale = [](uint32_t pixel) { return std::pow(100.0, double(pixel % size) / size); };
        const FilmSums film = film_of(passes, [&](uint32_t pixel, uint32_t) {
            return glm::dvec3(10, 20, 30) +
                   scale(pixel) * glm::dvec3(normal(random), normal(random), normal(random));
        });
        check_honest(coverage(film, [](uint32_t) { return glm::dvec3(10, 20, 30); }), 0.05);
    }
}

TEST_CASE("samples that are stratified are more accurate than their spread, and the error says so") {
    for (const uint32_t passes : {4u, 32u, 33u}) {
        Random random(passes);
        std::uniform_real_distribution<double> uniform;
        // Each half in itself has one uniform number in every stratum, in any order.
        std::vector<double> strata(passes);
        const auto stratify = [&] {
            for (uint32_t half = 0; half < 2; ++half) {
                const uint32_t count = (passes + 1 - half) / 2;
                for (uint32_t i = 0; i < count; ++i) strata[2 * i + half] = (i + uniform(random)) / count;
                for (uint32_t i = count; i-- > 1;)
                    std::swap(strata[2 * i + half], strata[2 * (random() % (i + 1)) + half]);
            }
        };
        const FilmSums film = film_of(passes, [&](uint32_t, uint32_t pass) {
            if (pass == 0) stratify();
            return glm::dvec3(1, 2, 3) * (strata[pass] + 0.3 * uniform(random));
        });
        check_honest(coverage(film, [](uint32_t) { return glm::dvec3(1, 2, 3) * 0.65; }), 0.05);
        // Independent samples would have this error.
        const double independent = std::sqrt((1 + 0.09) / 12 * 14 / 3 / passes);
        CHECK(root_mean_square(estimate_errors(film)) < (passes == 4 ? 0.8 : 0.5) * independent);
    }
}

TEST_CASE("where a bright sample is rare, pixels that have not met it know of it from their neighbours") {
    const double p = 1.0 / 100;
    for (const uint32_t passes : {4u, 16u, 64u, 256u}) {
        Random random(passes);
        std::uniform_real_distribution<double> uniform;
        const FilmSums film = film_of(passes, [&](uint32_t, uint32_t) {
            return glm::dvec3(uniform(random) < p ? 1 / p : 0.0) + glm::dvec3(0.5 + uniform(random));
        });
        const Coverage c = coverage(film, [](uint32_t) { return glm::dvec3(2); });
        CHECK(c.rms < (passes == 4 ? 1.6 : 1.1));
        CHECK(c.rms > 0.9);
        // Means of few events are not normally distributed, so only the bound on large errors is meant.
        CHECK(c.within_two > 0.88);
    }
}

TEST_CASE("what does not vary has no error; before the second pass nothing is known") {
    Random random(1);
    for (const uint32_t passes : {1u, 2u, 3u, 8u, 65u, 1000u}) {
        const FilmSums film = film_of(passes, [&](uint32_t, uint32_t) { return glm::dvec3(0, 0.1, 7); });
        for (const glm::vec3& e : estimate_errors(film))
            for (int c = 0; c < 3; ++c)
                if (passes < 2)
                    REQUIRE(std::isinf(e[c]));
                else
                    REQUIRE(e[c] <= 1e-6f * 7);  // float sums
        const RelativeError relative = estimate_relative_error(film);
        CHECK((passes < 2 ? std::isinf(relative.bound()) : relative.bound() < 1e-5));
    }
}

TEST_CASE("merging: bias adds to the error, its noise does not") {
    for (const double d : {0.0, 0.03, 0.1})
        for (const uint32_t passes : {2u, 8u, 64u}) {
            const double bias_noise = 0.8;  // a half multiplied by itself would show
            CAPTURE(d);
            CAPTURE(passes);
            Random random(passes);
            std::normal_distribution<double> normal;
            const FilmSums film = film_of(
                passes, [&](uint32_t, uint32_t) { return glm::dvec3(1 + 2 * d + normal(random)); },
                [&](uint32_t, uint32_t) { return glm::dvec3(d + bias_noise * normal(random)); });
            const double wanted = std::sqrt(1.0 / passes + 4 * d * d);
            CHECK(root_mean_square(estimate_errors(film)) == doctest::Approx(wanted).epsilon(0.03));
            if (passes == 64)
                CHECK(estimate_relative_error(film).value() * (1 + 2 * d) ==
                      doctest::Approx(wanted / std::sqrt(1.01)).epsilon(0.1));
        }
}

TEST_CASE("the true relative error lies below its bound as often as stated") {
    for (const uint32_t passes : {64u, 256u}) {
        Random random(passes);
        std::uniform_real_distribution<double> uniform;
        const uint32_t films = 100;
        double covered = 0, estimate = 0, truth = 0;
        for (uint32_t f = 0; f < films; ++f) {
            const FilmSums film = film_of(passes, [&](uint32_t, uint32_t) {
                return glm::dvec3(uniform(random) < 0.05 ? 10 : 0.0) + glm::dvec3(0.5 + uniform(random));
            });
            double squares = 0;
            for (const FilmPixel& p : film.pixels) squares += std::pow(mean(film, p).x - 1.5, 2);
            const double relmse = squares / double(film.pixels.size()) / (1.01 * 2.25);
            const RelativeError error = estimate_relative_error(film);
            covered += std::sqrt(relmse) <= error.bound() ? 1.0 / films : 0;
            estimate += error.mean_square / films, truth += relmse / films;
        }
        MESSAGE(passes, " passes: covered ", covered, ", estimated relMSE ", estimate, ", true ", truth);
        CHECK(covered >= 0.88);  // 0.95 of 100 films, less three standard deviations
        CHECK(estimate == doctest::Approx(truth).epsilon(0.25));
    }
}
