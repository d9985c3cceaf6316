// Statistics of a bench, on data of known slopes, errors and crossings.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "host/bench/report.h"
#include "host/bench/results.h"
#include "host/error.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

// Small numbers, too: doctest::Approx takes its epsilon of 1 + the value.
bool close(double value, double expected, double relative) {
    return std::abs(value - expected) <= relative * std::abs(expected);
}

// `count` pixels of 1 to 2 in three channels, plus Gaussian noise.
Image noisy_image(double sigma, uint32_t seed, uint32_t size = 256) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> noise(0, sigma);
    Image image;
    image.width = image.height = size;
    std::vector<float> pixels;
    for (uint32_t i = 0; i < size * size * 3; ++i)
        pixels.push_back(float(1.0 + double(i) / double(size * size * 3) + noise(generator)));
    add_channels(image, {"R", "G", "B"}, pixels, 3);
    return image;
}

BenchPoint point(const char* algorithm, uint64_t passes, double seconds, double relmse) {
    BenchPoint p;
    p.scene = "box", p.algorithm = algorithm;
    p.passes = passes, p.seconds = seconds;
    p.rays_backward = 10 * passes, p.rays_shadow = 5 * passes, p.rays_forward = passes;
    p.relmse = relmse, p.relmse_measured = relmse + 1e-4;
    return p;
}

BenchResults power_law() {
    BenchResults results;
    results.scenes.push_back({"box", "box.gltf", "a device", "a reference", 64, 32, 1e-4, {"a note"}});
    for (uint64_t n = 1; n <= 1024; n *= 2)
        results.points.push_back(point("backward", n, 0.01 * double(n), 1.0 / double(n)));
    return results;
}

}  // namespace

TEST_CASE("a line is fitted, and its slope's standard error is the spread of slopes") {
    const std::vector<double> x = {0, 1, 2, 3, 4, 5, 6, 7};
    std::mt19937 generator(1);
    std::normal_distribution<double> noise(0, 0.3);
    const int trials = 4000;
    double sum = 0, squares = 0, variance = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> y;
        for (double v : x) y.push_back(2.0 - 1.5 * v + noise(generator));
        const auto fit = fit_line(x, y);
        REQUIRE(fit);
        sum += fit->slope, squares += fit->slope * fit->slope;
        variance += fit->slope_error * fit->slope_error / trials;
    }
    const double mean = sum / trials, spread = squares / trials - mean * mean;
    CHECK(std::abs(mean + 1.5) < 0.003);
    CHECK(close(spread, 0.3 * 0.3 / 42.0, 0.07));  // 42 = sum (x - mean)²
    CHECK(close(variance, spread, 0.1));
    CHECK(!fit_line(std::vector<double>{1, 2}, std::vector<double>{1, 2}));
    CHECK(!fit_line(std::vector<double>{1, 1, 1}, std::vector<double>{1, 2, 3}));
}

TEST_CASE("a weighted mean has the standard error of its spread") {
    std::mt19937 generator(2);
    std::normal_distribution<double> noise(0, 1);
    const std::vector<double> weights = {1, 2, 4, 8, 16};
    const int trials = 4000;
    double squares = 0, variance = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> values;
        for (double w : weights) values.push_back(noise(generator) / std::sqrt(w));
        const Mean mean = weighted_mean(values, weights);
        squares += mean.value * mean.value / trials;
        variance += mean.error * mean.error / trials;
    }
    CHECK(close(squares, 1.0 / 31.0, 0.07));
    CHECK(close(variance, 1.0 / 31.0, 0.07));
    CHECK(std::isinf(weighted_mean(std::vector<double>{3}, std::vector<double>{1}).error));
}

TEST_CASE("a crossing is exact on a power law, and counts from where the curve stays below") {
    std::vector<CurvePoint> curve;
    for (double x : {1.0, 2.0, 4.0, 8.0, 16.0}) curve.push_back({x, 3.0 * std::pow(x, -1.25)});
    const Crossing crossing = find_crossing(curve, 0.5);
    CHECK(crossing.kind == Crossing::Kind::between);
    CHECK(crossing.x == doctest::Approx(std::pow(6.0, 1 / 1.25)));
    CHECK(find_crossing(curve, 5).kind == Crossing::Kind::before_first);
    CHECK(find_crossing(curve, 5).x == 1);
    CHECK(find_crossing(curve, 1e-3).kind == Crossing::Kind::after_last);
    CHECK(find_crossing(curve, 1e-3).x == 16);
    // A lucky render in the middle is no arrival.
    const std::vector<CurvePoint> lucky = {{1, 1}, {2, 0.1}, {4, 0.25}, {8, 0.0625}};
    CHECK(find_crossing(lucky, 0.125).x == doctest::Approx(4 * std::sqrt(2.0)));
}

TEST_CASE("the noise of a reference is known from its halves, and leaves the measured errors") {
    // Images of values 1 to 2 with noise of variance v have a relMSE of about v mean(1 / (x² + 0.01 mean²)).
    double inverse = 0;
    for (int i = 0; i < 1000; ++i) inverse += 1e-3 / (std::pow(1.0005 + 1e-3 * i, 2) + 0.01 * 1.5 * 1.5);
    const double half_sigma = 0.04, sigma = 0.02;
    const Reference reference = average_reference(noisy_image(half_sigma, 1), noisy_image(half_sigma, 2));
    CHECK(close(reference.relmse, 0.5 * half_sigma * half_sigma * inverse, 0.05));
    BenchPoint p;
    compare_with_reference(noisy_image(sigma, 3), reference, p);
    CHECK(close(p.relmse_measured, p.relmse + reference.relmse, 1e-9));
    CHECK(close(p.relmse, sigma * sigma * inverse, 0.1));
    CHECK(p.relmse_measured > 2 * p.relmse);
    CHECK(std::abs(p.bias) < 0.002);
}

TEST_CASE("levels whose error drowns in the reference's are left out") {
    BenchResults results = power_law();
    for (uint64_t n : {32768, 65536}) results.points.push_back(point("backward", n, 600, 3e-5));
    const auto all = curves(results, results.scenes[0]);
    REQUIRE(all.size() == 1);
    CHECK(all[0].left_out == 2);
    CHECK(all[0].levels.size() == 11);
    REQUIRE(all[0].by_passes);
    CHECK(all[0].by_passes->slope == doctest::Approx(-1));
    CHECK(all[0].by_seconds->slope == doctest::Approx(-1));
    CHECK(all[0].by_passes->slope_error < 1e-6);
    // 11 levels of 16 rays and 0.01 s a pass, and the two that took 600 s.
    CHECK(all[0].rays_per_second == doctest::Approx(16 * (2047.0 + 98304.0) / (20.47 + 1200)));
}

TEST_CASE("a level is the mean of its seeds, and a curve belongs to its scene and algorithm") {
    BenchResults results = power_law();
    results.points.push_back(point("backward", 1024, 30, 3.0 / 1024));
    results.points.push_back(point("forward", 4, 1, 0.5));
    results.points.push_back(point("backward", 2048, 1, 1e-3));
    results.points.back().scene = "elsewhere";
    const auto all = curves(results, results.scenes[0]);
    REQUIRE(all.size() == 2);
    CHECK(all[0].levels.back().passes == 1024);
    CHECK(close(all[0].levels.back().relmse, 2.0 / 1024, 1e-6));
    CHECK(all[0].levels.back().seconds == doctest::Approx(20.12));
    CHECK(all[1].algorithm == "forward");
    CHECK(!all[1].by_passes);
}

TEST_CASE("the table tells the time to an error, and what was not reached") {
    const BenchResults results = power_law();
    const Table table = summary_table(curves(results, results.scenes[0]));
    REQUIRE(table.size() == 2);
    REQUIRE(table[0].size() == table[1].size());
    const auto cell = [&](const std::string& column) {
        for (size_t c = 0; c < table[0].size(); ++c)
            if (table[0][c] == column) return table[1][c];
        return std::string("no such column");
    };
    CHECK(cell("passes") == "1024");
    CHECK(cell("to 0.1") == "0.1 s");
    CHECK(cell("to 0.001") == "10 s");
    CHECK(cell("slope by passes") == "-1.00 ± 0.00");
    CHECK(cell("Mrays/s") == "0.00");
    BenchResults one = results;
    one.points = {point("backward", 1, 2.0, 0.03)};
    const Table sparse = summary_table(curves(one, one.scenes[0]));
    CHECK(sparse[1][8] == "<2 s");
    CHECK(sparse[1].back() == ">2 s");
    CHECK(as_text(sparse).find("backward") != std::string::npos);
}

TEST_CASE("results come back from their files, and other files are refused in one line") {
    const TemporaryFolder folder;
    const BenchResults results = power_law();
    write_results(folder.path, results);
    const BenchResults again = read_results(folder.path);
    REQUIRE(again.points.size() == results.points.size());
    CHECK(again.points[3].algorithm == "backward");
    CHECK(again.points[3].passes == 8);
    CHECK(again.points[3].relmse == doctest::Approx(0.125));
    CHECK(again.points[3].rays_forward == 8);
    CHECK(again.scenes.at(0).notes == std::vector<std::string>{"a note"});
    CHECK(again.scenes[0].height == 32);
    const std::string csv = read_text(folder / "bench.csv");
    for (const std::string& bad :
         {std::string("a,b\n1,2\n"), csv + "box,backward,1\n", csv + "box,b,x,1,1,1,1,1,1,1,1\n",
          csv + csv.substr(csv.find('\n') + 1) + ",\n"}) {
        write_text(folder / "bench.csv", bad);
        CHECK_THROWS_AS(read_results(folder.path), Error);
    }
    write_text(folder / "bench.csv", csv);
    write_text(folder / "bench.json", "{}");
    CHECK_THROWS_AS(read_results(folder.path), Error);
}
