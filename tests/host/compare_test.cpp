// Image comparison against values worked out by hand, and the z-test against its own false-alarm rate.
#include "host/image/compare.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "host/commands.h"
#include "host/error.h"
#include "host/image/exr.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

Image rgb(uint32_t width, uint32_t height, std::vector<float> pixels) {
    Image image{.width = width, .height = height};
    add_channels(image, {"R", "G", "B"}, pixels, 3);
    return image;
}

// The mean of `passes` samples of noise around `mean`, with its estimated standard error.
Image noisy(uint32_t size, double mean, double sigma, int passes, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, sigma);
    std::vector<float> values, errors;
    for (size_t i = 0; i < size_t(size) * size * 3; ++i) {
        double sum = 0, squares = 0;
        for (int p = 0; p < passes; ++p) {
            double x = mean + noise(random);
            sum += x, squares += x * x;
        }
        double average = sum / passes;
        values.push_back(float(average));
        errors.push_back(float(std::sqrt((squares / passes - average * average) / (passes - 1))));
    }
    Image image = rgb(size, size, values);
    add_channels(image, {"error.R", "error.G", "error.B"}, errors, 3);
    image.attributes["passes"] = double(passes);
    return image;
}

}  // namespace

TEST_CASE("relMSE, RMSE and bias are those of the formulas") {
    // R = 1 everywhere but 3 in the last value, I = R + 0.5 in the first: mean(R) = 8/6.
    Image reference = rgb(2, 1, {1, 1, 1, 1, 1, 3}), image = rgb(2, 1, {1.5f, 1, 1, 1, 1, 3});
    Comparison c = compare_images(image, reference);
    double mean = 8.0 / 6.0;
    CHECK(c.relmse == doctest::Approx(0.25 / (1 + 0.01 * mean * mean) / 6).epsilon(1e-12));
    CHECK(c.rmse == doctest::Approx(std::sqrt(0.25 / 6)).epsilon(1e-12));
    CHECK(c.bias == doctest::Approx(0.5 / 8).epsilon(1e-12));
    CHECK(c.channel_bias[0] == doctest::Approx(0.25).epsilon(1e-12));
    CHECK(c.channel_bias[1] == 0);
}

TEST_CASE("Stokes vectors are compared in units of the mean intensity") {
    const auto with = [](float s0, float s1, float error) {
        Image image = rgb(2, 2, std::vector<float>(12, s0));
        for (const char* layer : {"S1.", "S2.", "S3."}) {
            const std::string name = layer;
            const float value = name == "S1." ? s1 : 0.25f;
            add_channels(image, {name + "R", name + "G", name + "B"}, std::vector<float>(12, value), 3);
            add_channels(image, {"error." + name + "R", "error." + name + "G", "error." + name + "B"},
                         std::vector<float>(12, error), 3);
        }
        return image;
    };
    const Comparison c = compare_images(with(2, 0.5f, 0.1f), with(2, 0.3f, 0.1f));
    CHECK(c.channels.size() == 3);
    CHECK(c.relmse == 0);
    REQUIRE(c.stokes);
    CHECK(c.stokes->rms[0] == doctest::Approx(0.1));
    CHECK(c.stokes->bias[0] == doctest::Approx(0.1));
    CHECK(c.stokes->rms[1] == 0);
    REQUIRE(c.stokes->z_test);
    CHECK(c.stokes->z_test->max_z == doctest::Approx(std::sqrt(2.0)));
    CHECK(c.stokes->z_test->passes);
    CHECK(!compare_images(with(2, 0.5f, 0.01f), with(2, 0.3f, 0.01f)).stokes->z_test->passes);
    CHECK(!compare_images(rgb(1, 1, {1, 1, 1}), rgb(1, 1, {1, 1, 1})).stokes);
}

TEST_CASE("spectra are compared bin by bin, where the bins are the same") {
    Image a = rgb(2, 1, {1, 1, 1, 1, 1, 1}), b = a, c = a;
    const std::vector<std::string> bins = {"S0.400,000000nm", "S0.600,000000nm"};
    add_channels(a, bins, std::vector<float>{1.1f, 2, 3, 4}, 2);
    add_channels(b, bins, std::vector<float>{1, 2, 3, 4}, 2);
    add_channels(c, {"S0.500,000000nm"}, std::vector<float>{1, 2}, 1);
    const SpectraComparison s = *compare_images(a, b).spectra;
    CHECK(s.bins == 2);
    CHECK(s.bias == doctest::Approx(0.01).epsilon(1e-5));
    CHECK(s.worst_bin == bins[0]);
    CHECK(s.worst_bias == doctest::Approx(0.1 / 4).epsilon(1e-5));
    CHECK(s.relmse == doctest::Approx(0.01 / (1 + 0.01 * 2.5 * 2.5) / 4).epsilon(1e-5));
    CHECK(compare_images(a, a).spectra->relmse == 0);
    CHECK(compare_images(a, c).spectra->bins == 0);
    CHECK(compare_images(a, rgb(2, 1, {1, 1, 1, 1, 1, 1})).spectra->bins == 0);
    CHECK(!compare_images(rgb(1, 1, {1, 1, 1}), rgb(1, 1, {1, 1, 1})).spectra);
}

TEST_CASE("the worst pixels come worst first with their place and values") {
    std::vector<float> values(3 * 12, 1.0f), changed = values;
    changed[3 * 7 + 1] = 2.0f;
    changed[3 * 10 + 2] = 5.0f;
    Comparison c = compare_images(rgb(4, 3, changed), rgb(4, 3, values));
    REQUIRE(c.worst.size() == 2);
    CHECK(c.worst[0].x == 2);
    CHECK(c.worst[0].y == 2);
    CHECK(c.worst[0].image[2] == 5.0f);
    CHECK(c.worst[1].x == 3);
    CHECK(c.worst[1].y == 1);
}

TEST_CASE("pixels that are not finite are counted and left out of the means") {
    Image reference = rgb(2, 1, {1, 1, 1, 2, 2, 2}), image = rgb(2, 1, {1, NAN, 1, 2, 2, 3});
    Comparison c = compare_images(image, reference);
    CHECK(c.nonfinite_image == 1);
    CHECK(c.nonfinite_reference == 0);
    CHECK(c.rmse == doctest::Approx(std::sqrt(1.0 / 3)));
}

TEST_CASE("black equals black") {
    Image black = rgb(1, 1, {0, 0, 0});
    Comparison c = compare_images(black, black);
    CHECK(c.relmse == 0);
    CHECK(c.bias == 0);
    CHECK(std::isinf(compare_images(rgb(1, 1, {1, 0, 0}), black).relmse));
}

TEST_CASE("images of other size or channels cannot be compared") {
    Image a = rgb(2, 1, {1, 1, 1, 1, 1, 1}), b = rgb(1, 2, {1, 1, 1, 1, 1, 1});
    CHECK_THROWS_WITH_AS(compare_images(a, b, "a.exr", "b.exr"),
                         "a.exr is 2 x 1 pixels, b.exr is 1 x 2: the sizes must be equal", Error);
    Image gray{.width = 2, .height = 1};
    add_channels(gray, {"Y"}, std::vector<float>{1, 1}, 1);
    CHECK_THROWS_AS(compare_images(a, gray), Error);
    CHECK_NOTHROW(compare_images(gray, gray));
}

TEST_CASE("Student's t has the textbook quantiles and tends to the normal distribution") {
    CHECK(student_two_sided(2.2281388520, 10) == doctest::Approx(0.05).epsilon(1e-8));
    CHECK(student_two_sided(636.61924943, 1) == doctest::Approx(0.001).epsilon(1e-8));
    CHECK(student_two_sided(6.0, 63) == doctest::Approx(1.0546e-7).epsilon(2e-3));
    CHECK(student_two_sided(1.9599639845, INFINITY) == doctest::Approx(0.05).epsilon(1e-8));
    CHECK(student_two_sided(4.0, 9e6) == doctest::Approx(student_two_sided(4.0, INFINITY)).epsilon(1e-4));
}

TEST_CASE("the z-test accepts images that differ by noise alone, with few passes as with many") {
    int alarms = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        int passes = seed % 2 ? 4 : 32;
        auto c = compare_images(noisy(24, 1, 0.5, passes, 2 * seed), noisy(24, 1, 0.5, passes, 2 * seed + 1));
        REQUIRE(c.z_test.has_value());
        alarms += !c.z_test->passes;
    }
    CHECK(alarms <= 3);  // 0.4 expected at 1 %; 4 or more happen once in 1000
}

TEST_CASE("the z-test finds one wrong pixel, and over tiles a small shift of all") {
    Image a = noisy(32, 1, 0.5, 64, 1), b = noisy(32, 1, 0.5, 64, 2);
    plane(b, 1)[32 * 5 + 9] += 1.0f;
    ZTest test = *compare_images(a, b).z_test;
    CHECK(!test.passes);
    CHECK(test.x == 9);
    CHECK(test.y == 5);
    Image shifted = noisy(32, 1.03, 0.5, 64, 3);
    CHECK(compare_images(a, shifted).z_test->passes);
    CHECK(!z_test(a, shifted, {"R", "G", "B"}, 16)->passes);
}

TEST_CASE("without error layers there is no z-test; without noise equal images pass and others fail") {
    Image a = rgb(1, 1, {1, 1, 1}), b = rgb(1, 1, {1, 1, 1.001f});
    CHECK(!compare_images(a, a).z_test.has_value());
    for (Image* image : {&a, &b})
        add_channels(*image, {"error.R", "error.G", "error.B"}, std::vector<float>(3), 3);
    CHECK(compare_images(a, a).z_test->passes);
    CHECK(!compare_images(b, a).z_test->passes);
}

TEST_CASE("the compare command exits with 1 beyond the limit and where a pixel is not finite") {
    TemporaryFolder folder;
    write_exr(folder / "a.exr", rgb(1, 1, {1, 1, 1.1f}));
    write_exr(folder / "b.exr", rgb(1, 1, {1, 1, 1}));
    write_exr(folder / "nan.exr", rgb(1, 1, {1, 1, NAN}));
    CHECK(compare_command({folder / "a.exr", folder / "b.exr", {}}) == 0);
    CHECK(compare_command({folder / "a.exr", folder / "b.exr", 1.0}) == 0);
    CHECK(compare_command({folder / "a.exr", folder / "b.exr", 1e-6}) == 1);
    CHECK(compare_command({folder / "nan.exr", folder / "b.exr", 1.0}) == 1);
    CHECK_THROWS_AS(compare_command({folder / "none.exr", folder / "b.exr", {}}), Error);
}
