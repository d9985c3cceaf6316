// Scenes with known images, made with another renderer: pixel by pixel within the noise of both.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "host/image/exr.h"
#include "host/gltf/gltf.h"
#include "host/spectra/color.h"
#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

struct Reference {
    std::string name;
    double relmse;     // residual noise of the reference, as its page states it
    double scale = 1;  // of our unit to that of the reference
};

struct Result {
    Agreement pixels, tiles;
    double bias, bias_error;  // of the mean of all pixels and channels, relative to the reference
};

// A failed comparison leaves both images behind, and where.
void keep(const Reference& reference, const Estimates& e, Image expected) {
    expected.attributes.clear();
    Image image;
    image.width = e.width, image.height = e.height;
    std::vector<float> values(e.mean.begin(), e.mean.end());
    add_channels(image, {"R", "G", "B"}, values, 3);
    const auto folder = std::filesystem::temp_directory_path() / "etendue-failed" / reference.name;
    std::filesystem::create_directories(folder);
    write_exr(folder / "image.exr", image);
    write_exr(folder / "reference.exr", expected);
    MESSAGE("image and reference are left in ", folder.string());
}

std::optional<Result> compare_with(const Reference& reference, uint32_t passes, uint32_t seeds) {
    const auto scene = shared_file(fmt::format("reference/{}/scene.gltf", reference.name));
    const auto file = shared_file(fmt::format("reference/{}/reference.exr", reference.name));
    if (!scene || !file) return std::nullopt;
    const Image expected = read_exr(*file);
    RenderPlan plan;
    plan.width = expected.width, plan.height = expected.height, plan.passes = passes, plan.seeds = seeds;
    const Estimates e = render_estimates(import_gltf(*scene), plan);

    std::vector<double> values(e.mean.size()), sd(e.mean.size());
    double mean = 0;
    for (int c = 0; c < 3; ++c) {
        const auto channel = plane(expected, size_t(find_channel(expected, std::string(1, "RGB"[c]))));
        for (size_t i = 0; i < channel.size(); ++i) values[3 * i + size_t(c)] = reference.scale * channel[i];
    }
    for (const double v : values) mean += v / double(values.size());
    for (size_t i = 0; i < values.size(); ++i)
        sd[i] = std::sqrt(reference.relmse * (values[i] * values[i] + 0.01 * mean * mean));
    Result result;
    result.pixels = agreement(e, values, 1, sd);
    result.tiles = agreement(e, values, 8, sd);
    const WindowMean ours = window_mean(e);
    result.bias = ours.mean / mean - 1;
    result.bias_error =
        std::hypot(ours.standard_error / mean, std::sqrt(reference.relmse / double(values.size())));
    MESSAGE(reference.name, ", pixels: ", describe(result.pixels));
    MESSAGE(reference.name, ", tiles:  ", describe(result.tiles));
    MESSAGE(reference.name, ", bias ", 100 * result.bias, " % +- ", 100 * result.bias_error, " %");
    if (!result.pixels.holds || !result.tiles.holds || result.tiles.rms_z > 1.2 ||
        std::fabs(result.bias) > 0.003)
        keep(reference, e, expected);
    return result;
}

void check_noise(const Result& result) {
    CHECK(result.pixels.holds);
    CHECK(result.tiles.holds);
    // 1 or less by chance alone, to a few hundredths: small differences in many places show here first.
    CHECK(result.pixels.rms_z < 1.1);
    CHECK(result.tiles.rms_z < 1.2);
}

void check_reference(const Reference& reference, uint32_t passes, uint32_t seeds) {
    const auto result = compare_with(reference, passes, seeds);
    if (!result) return;
    check_noise(*result);
    CHECK(std::fabs(result->bias) < 0.003);
}

void check_mean(const Reference& reference, uint32_t passes, uint32_t seeds, double allowed_bias) {
    const auto result = compare_with(reference, passes, seeds);
    if (!result) return;
    check_noise(*result);
    CHECK(std::fabs(result->bias) < allowed_bias + 4 * result->bias_error);
}

const Reference cornell = {"cornell_rgb", 4.4e-4}, plates = {"veach_mis", 2.0e-4},
                furnace = {"furnace", 1.9e-5}, cloud = {"media_iso", 2.1e-4};
// Its unit of spectral radiance is that of an even spectrum of luminance 1.
const Reference spectral_cornell = {"cornell_spectral", 1.1e-3, even_luminance()};

}  // namespace

TEST_CASE("the Cornell box looks as its reference") { check_reference(cornell, 16, 16); }
TEST_CASE("the Cornell box with its measured spectra looks as its reference") {
    check_reference(spectral_cornell, 16, 16);
}
TEST_CASE("glossy plates under lights of all sizes look as their reference") {
    check_reference(plates, 128, 16);
}
TEST_CASE("a cube of cloud looks as its reference") { check_reference(cloud, 64, 16); }
TEST_CASE("spheres in a furnace look as their reference") { check_reference(furnace, 64, 16); }

TEST_SUITE("long") {
    TEST_CASE("the mean of the Cornell box is that of its reference within 0.1 %") {
        check_mean(cornell, 128, 16, 0.001);
    }
    TEST_CASE("the mean of the glossy plates is that of their reference within 0.1 %") {
        check_mean(plates, 512, 16, 0.001);
    }
    TEST_CASE("the mean of the cloud is that of its reference within 0.1 %") {
        check_mean(cloud, 512, 16, 0.001);
    }
    TEST_CASE("the mean of the furnace is that of its reference within 0.02 %") {
        check_mean(furnace, 512, 16, 0.0002);
    }
}
