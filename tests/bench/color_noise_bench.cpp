// The noise of colours at equal time: a scene of colours rendered in RGB and in wavelengths, which differ in
// nothing else. Prints the noise of luminance Y and of the colour differences R - Y, G - Y, B - Y, root mean
// squares over pixels and seeds relative to the mean luminance, after the same processor time for both.
//
//     color_noise_bench [SCENE.gltf [SECONDS]]        default scenes/cornell_box.gltf 4
//
// One thread: LP_NUM_THREADS=1.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <vector>

#include "host/error.h"
#include "host/image/compare.h"
#include "host/render/renderer.h"
#include "host/gltf/gltf.h"
#include "host/scene/scene_compiler.h"
#include "host/spectra/color.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

constexpr uint32_t seeds = 8, pixels = 128;

struct Noise {
    uint32_t passes = 0;
    double seconds = 0, mean = 0, luminance = 0, color = 0;
};

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

std::vector<glm::dvec3> colors(const Image& image) {
    std::vector<glm::dvec3> result(pixel_count(image));
    for (int c = 0; c < 3; ++c) {
        const auto values = plane(image, size_t(find_channel(image, std::string(1, "RGB"[c]))));
        for (size_t i = 0; i < values.size(); ++i) result[i][c] = values[i];
    }
    return result;
}

Noise measure(Device& device, const std::string& file, ColorMode color, double seconds) {
    SceneOptions options;
    options.shaders = source_path("shaders");
    options.cache_folder = default_cache_folder();
    options.color = color;
    Scene scene = compile_scene(device, import_gltf(file), options);
    RenderSettings settings;
    settings.width = settings.height = pixels;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = Algorithm::backward;
    Renderer renderer(device, scene, settings);
    renderer.render_passes(16);
    const double before = processor_seconds();
    renderer.render_passes(64);
    Noise noise;
    noise.passes = uint32_t(std::lround(64 * seconds / (processor_seconds() - before)));

    std::vector<glm::dvec3> sum(size_t(pixels) * pixels), squares(sum.size());
    std::vector<double> y_sum(sum.size()), y_squares(sum.size());
    const double start = processor_seconds();
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        renderer.restart(1 + seed);
        for (uint32_t done = 0; done < noise.passes; done += 64)
            renderer.render_passes(std::min(64u, noise.passes - done));
        const auto image = colors(renderer.develop());
        for (size_t i = 0; i < image.size(); ++i) {
            const double y = luminance(image[i]);
            const glm::dvec3 difference = image[i] - y;
            sum[i] += difference, squares[i] += difference * difference;
            y_sum[i] += y, y_squares[i] += y * y;
        }
    }
    noise.seconds = (processor_seconds() - start) / seeds;
    for (size_t i = 0; i < sum.size(); ++i) {
        const glm::dvec3 variance = (squares[i] - sum[i] * sum[i] / double(seeds)) / double(seeds - 1);
        noise.color += (variance.x + variance.y + variance.z) / 3 / double(sum.size());
        noise.luminance += (y_squares[i] - y_sum[i] * y_sum[i] / seeds) / (seeds - 1) / double(sum.size());
        noise.mean += y_sum[i] / seeds / double(sum.size());
    }
    noise.color = std::sqrt(noise.color) / noise.mean;
    noise.luminance = std::sqrt(noise.luminance) / noise.mean;
    return noise;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        auto device = create_device();
        fmt::print("{}, {}\n", device->description.name, device->description.driver);
        const std::string file = argc > 1 ? argv[1] : source_path("scenes/cornell_box.gltf");
        const double seconds = argc > 2 ? std::stod(argv[2]) : 4;
        const Noise rgb = measure(*device, file, ColorMode::rgb, seconds);
        const Noise spectral = measure(*device, file, ColorMode::spectral, seconds);
        fmt::print("{:12} {:>7} {:>8} {:>10} {:>10} {:>10}\n", "", "passes", "seconds", "mean Y",
                   "noise of Y", "of colour");
        for (const auto& [name, n] : {std::pair("rgb", rgb), std::pair("spectral", spectral)})
            fmt::print("{:12} {:7} {:8.2f} {:10.4f} {:10.5f} {:10.5f}\n", name, n.passes, n.seconds, n.mean,
                       n.luminance, n.color);
        fmt::print("{:12} {:7.2f} {:8.2f} {:10.4f} {:10.3f} {:10.3f}\n", "ratio",
                   double(spectral.passes) / rgb.passes, spectral.seconds / rgb.seconds,
                   spectral.mean / rgb.mean, spectral.luminance / rgb.luminance, spectral.color / rgb.color);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return int(error.code);
    }
    return 0;
}
