// Spectral images: the spectra of pixels in bins, W / (m² sr nm).
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "host/scene/spectral_value.h"
#include "host/spectra/color.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr uint32_t bins = 10;

SpectralTable table_of(const json& value, SpectralKind kind) {
    return spectral_value(value, {}, "/test", kind).as_table(kind);
}

// Of a table, over each bin.
std::array<double, bins> bin_means(const SpectralTable& table) {
    std::array<double, bins> means{};
    const double width = double(last_nm - first_nm) / bins;
    constexpr int steps = 1000;
    for (uint32_t bin = 0; bin < bins; ++bin)
        for (int i = 0; i < steps; ++i)
            means[bin] += table.at(first_nm + width * (bin + (i + 0.5) / steps)) / steps;
    return means;
}

RenderSettings settings_of(const Scene& scene, uint32_t width, uint32_t height, Algorithm algorithm) {
    RenderSettings settings;
    settings.width = width, settings.height = height;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = algorithm;
    settings.spectral_bins = bins;
    return settings;
}

Image develop(const Renderer& renderer) {
    Image image = renderer.develop();
    renderer.add_spectra(image);
    return image;
}

std::span<const float> channel(const Image& image, const std::string& name) {
    const int index = find_channel(image, name);
    REQUIRE(index >= 0);
    return plane(image, size_t(index));
}

// Of a bin, over the image.
double mean_of(const Image& image, uint32_t bin) {
    double sum = 0;
    for (const float v : channel(image, spectral_channel(bin, bins))) sum += v;
    return sum / double(pixel_count(image));
}

const json paint = {{"wavelengths", {380, 480, 520, 600, 700}}, {"values", {0.1, 0.7, 0.05, 0.9, 0.3}}};

// A lamp of spectrum F11 beside a painted floor that the camera sees.
SceneBuilder painted_floor() {
    SceneBuilder s;
    s.rectangle(2, 2, s.lambertian(paint), at(0, 0, 0));
    s.rectangle(1, 1, s.black_emitter({{"illuminant", "F11"}}),
                {{1.5, 0, 0.5}, {0, -0.70710678118654752, 0, 0.70710678118654752}});
    s.orthographic(0.8, at(0, 0, 2));
    return s;
}

}  // namespace

TEST_CASE("a lamp has its spectrum in a spectral image, and the luminance that belongs to it") {
    const std::vector<json> lamps = {
        {{"illuminant", "A"}}, {{"illuminant", "F11"}}, {{"blackbody", 1800}}, {3, 1, 0.25}};
    SceneBuilder s;
    for (size_t i = 0; i < lamps.size(); ++i)
        s.rectangle(2.5, 2.5, s.black_emitter(lamps[i]), at(4 * double(i), 0, 0));  // a pixel, a gap, …
    s.orthographic(1, at(2 * double(lamps.size()) - 1, 0, 1));
    Scene scene = compile_test_scene(s.import());
    Renderer renderer(test_device(), scene,
                      settings_of(scene, 2 * uint32_t(lamps.size()), 1, Algorithm::backward));
    for (int i = 0; i < 256; ++i) renderer.render_passes(64);
    const Image image = develop(renderer);
    CHECK(std::get<std::string>(image.attributes.at("emissiveUnits")) == "W.m^-2.sr^-1.nm^-1");
    CHECK(find_channel(image, "S0.383,500000nm") >= 0);
    CHECK(find_channel(image, "S0.806,500000nm") >= 0);
    for (size_t i = 0; i < lamps.size(); ++i) {
        CAPTURE(i);
        const SpectralTable lamp = table_of(lamps[i], SpectralKind::radiance);
        const auto expected = bin_means(lamp);
        for (uint32_t bin = 0; bin < bins; ++bin) {
            CAPTURE(bin);
            const double value = channel(image, spectral_channel(bin, bins))[2 * i];
            if (expected[bin] == 0)  // beyond the table of a lamp
                CHECK(value == 0);
            else
                CHECK(value / expected[bin] == doctest::Approx(1).epsilon(0.01));
        }
        const glm::dvec3 rgb = {channel(image, "R")[2 * i], channel(image, "G")[2 * i],
                                channel(image, "B")[2 * i]};
        CHECK(luminance(rgb) / luminance(rgb_of_radiance(lamp)) == doctest::Approx(1).epsilon(0.005));
    }
}

TEST_CASE("a spectral image of Stokes vectors: bins of S1 to S3 are those of the light") {
    SceneBuilder s;
    s.rectangle(
        4, 4,
        s.material({{"surface", {{"class", "absorber"}}},
                    {"emission", {{"radiance", {{"illuminant", "A"}}}, {"stokes", {1, 0.5, -0.25, 0.75}}}}}),
        at(0, 0, 0));
    s.orthographic(1, at(0, 0, 1));
    Scene scene = compile_test_scene(s.import());
    RenderSettings settings = settings_of(scene, 2, 2, Algorithm::backward);
    settings.stokes = true;
    Renderer renderer(test_device(), scene, settings);
    renderer.render_passes(64);
    const Image image = develop(renderer);
    CHECK(std::get<std::string>(image.attributes.at("polarisationHandedness")) == "right");
    const double expected[] = {1, 0.5, -0.25, 0.75};
    for (uint32_t bin = 0; bin < bins; ++bin)
        for (uint32_t k = 1; k < 4; ++k)
            for (size_t pixel = 0; pixel < 4; ++pixel)
                CHECK(channel(image, spectral_channel(bin, bins, k))[pixel] ==
                      doctest::Approx(expected[k] * channel(image, spectral_channel(bin, bins))[pixel])
                          .epsilon(1e-5));
}

TEST_CASE("forward, bidirectional and backward rays give the same spectral image, in every schedule") {
    Scene scene = compile_test_scene(painted_floor().import());
    const auto render = [&](Algorithm algorithm, Schedule schedule) {
        RenderSettings settings = settings_of(scene, 16, 16, algorithm);
        settings.schedule = schedule;
        Renderer renderer(test_device(), scene, settings);
        for (int i = 0; i < 16; ++i) renderer.render_passes(64);
        return std::pair(develop(renderer), renderer.state().bins);
    };
    const auto [expected, expected_bits] = render(Algorithm::backward, Schedule::fused);
    CHECK(expected_bits == render(Algorithm::backward, Schedule::wavefront).second);
    // The paint in the light of the lamp.
    const auto spectrum = bin_means(table_of(paint, SpectralKind::factor) *
                                    table_of({{"illuminant", "F11"}}, SpectralKind::radiance));
    const double scale = mean_of(expected, 4) / spectrum[4];
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::forward, Algorithm::bidirectional}) {
        const std::string name = algorithm_name(algorithm);
        CAPTURE(name);
        const auto [image, bits] = render(algorithm, Schedule::fused);
        for (uint32_t bin = 1; bin < 8; ++bin) {
            CAPTURE(bin);
            CHECK(mean_of(image, bin) / (scale * spectrum[bin]) == doctest::Approx(1).epsilon(0.02));
        }
        if (algorithm == Algorithm::bidirectional)
            CHECK(bits == render(algorithm, Schedule::wavefront).second);
    }
}

TEST_CASE("a spectral image goes on from its state bit for bit") {
    Scene scene = compile_test_scene(painted_floor().import());
    const RenderSettings settings = settings_of(scene, 8, 8, Algorithm::backward);
    Renderer first(test_device(), scene, settings), second(test_device(), scene, settings);
    first.render_passes(24);
    second.restore(first.state());
    first.render_passes(40);
    second.render_passes(40);
    CHECK(first.state().bins.size() == 8 * 8 * ((bins + 2) / 3));
    CHECK(first.state().bins == second.state().bins);
    first.restart(7);
    first.render_passes(64);
    CHECK(first.state().bins != second.state().bins);
}
