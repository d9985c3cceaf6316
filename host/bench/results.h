// What a bench measured, its files, and the curves that the points make.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/bench/statistics.h"
#include "host/image/image.h"

namespace etendue {

// What images are measured against.
struct Reference {
    Image image;
    // Expected relMSE of this image against one without noise. An image that is independent of it measures
    // its own relMSE and this one together, so this one is subtracted.
    double relmse = 0;
    std::string origin;  // a line for readers
};

// The mean of two independent images of equal expectation and variance. Each differs from the mean by half of
// their difference, whose variance is the mean's: so the relMSE of one against the mean is `relmse`, whatever
// the samples within an image have to do with each other.
Reference average_reference(const Image& a, const Image& b);

// One render of its own: no two points share samples.
struct BenchPoint {
    std::string scene, algorithm;
    uint64_t seed = 0, passes = 0;
    double seconds = 0;  // of rendering alone
    uint64_t rays_backward = 0, rays_shadow = 0, rays_forward = 0;
    double relmse = 0;           // without the reference's
    double relmse_measured = 0;  // with it
    double bias = 0;             // (mean - reference's mean) / reference's mean
};
double rays(const BenchPoint& point);  // of all kinds; 0 where they were not counted

// Measures an image against a reference: relmse, relmse_measured and bias of a point.
void compare_with_reference(const Image& image, const Reference& reference, BenchPoint& point);

struct BenchScene {
    std::string name;  // letters, digits, . _ -
    std::string file, device, reference;
    uint32_t width = 0, height = 0;
    double reference_relmse = 0;
    std::vector<std::string> notes;  // what was left out, and why
};

struct BenchResults {
    std::vector<BenchScene> scenes;
    std::vector<BenchPoint> points;
};

// bench.csv holds the points, bench.json the scenes. Reading fails with one line where they are none.
void write_results(const std::filesystem::path& folder, const BenchResults& results);
BenchResults read_results(const std::filesystem::path& folder);

// The renders of an algorithm with the same number of passes: means over seeds.
struct BenchLevel {
    double passes = 0, seconds = 0, rays = 0, relmse = 0;
};

struct BenchCurve {
    std::string algorithm;
    std::vector<BenchLevel> levels;  // by passes, of those whose error is measured well
    // Lines through log10(relMSE) of the points against log10 of their passes and of their seconds.
    std::optional<LineFit> by_passes, by_seconds;
    Mean bias;  // of all points, by their passes
    double rays_per_second = 0;
    size_t left_out = 0;  // levels with an error below the reference's
};

// An error counts as measured well where it is at least the reference's: half of the measure is the image's.
std::vector<BenchCurve> curves(const BenchResults& results, const BenchScene& scene);

}  // namespace etendue
