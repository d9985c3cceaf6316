// The noise of colours at equal time: a scene of colours rendered in RGB and in wavelengths, which differ in
// nothing else. Prints the noise of luminance Y and of the colour differences R - Y, G - Y, B - Y, root mean
// squares over pixels and seeds relative to the mean luminance, after the same processor time for both.
// Beside that of pixels stands the noise of their means over tiles of 8 x 8, of colours that the eye sees
// flicker.
//
//     color_noise_bench [SCENE.gltf [SECONDS [ALGORITHM]]]    default scenes/cornell_box.gltf 4 backward
//
// One thread: LP_NUM_THREADS=1.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <vector>

#include "host/cli/values.h"
#include "host/error.h"
#include "host/image/compare.h"
#include "host/render/renderer.h"
#include "host/gltf/gltf.h"
#include "host/scene/scene_compiler.h"
#include "host/spectra/color.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

constexpr uint32_t seeds = 8, pixels = 128, tile = 8;

struct Noise {
    double luminance = 0, color = 0;
};
struct Measurement {
    uint32_t passes = 0;
    double seconds = 0, mean = 0;
    Noise of_pixels, of_tiles;
};

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

using Colors = std::vector<glm::dvec3>;

Colors colors(const Image& image) {
    Colors result(pixel_count(image));
    for (int c = 0; c < 3; ++c) {
        const auto values = plane(image, size_t(find_channel(image, std::string(1, "RGB"[c]))));
        for (size_t i = 0; i < values.size(); ++i) result[i][c] = values[i];
    }
    return result;
}

Colors tiles_of(const Colors& image) {
    Colors result(image.size() / (tile * tile));
    for (uint32_t y = 0; y < pixels; ++y)
        for (uint32_t x = 0; x < pixels; ++x)
            result[y / tile * (pixels / tile) + x / tile] += image[y * pixels + x] / double(tile * tile);
    return result;
}

// Over the seeds' images, relative to their mean luminance, which is returned, too.
Noise noise_of(const std::vector<Colors>& images, double& mean) {
    const size_t count = images.front().size();
    const double all = double(images.size());
    Noise variance;
    mean = 0;
    for (size_t i = 0; i < count; ++i) {
        glm::dvec4 sum(0), squares(0);  // colour differences, luminance
        for (const Colors& image : images) {
            const double y = luminance(image[i]);
            const glm::dvec4 value(image[i] - y, y);
            sum += value, squares += value * value;
        }
        const glm::dvec4 v = (squares - sum * sum / all) / (all - 1) / double(count);
        variance.color += (v.x + v.y + v.z) / 3;
        variance.luminance += v.w;
        mean += sum.w / all / double(count);
    }
    return {std::sqrt(variance.luminance) / mean, std::sqrt(variance.color) / mean};
}

Measurement measure(Device& device, const std::string& file, ColorMode color, double seconds,
                    Algorithm algorithm) {
    SceneOptions options;
    options.shaders = source_path("shaders");
    options.cache_folder = default_cache_folder();
    options.color = color;
    Scene scene = compile_scene(device, import_gltf(file), options);
    RenderSettings settings;
    settings.width = settings.height = pixels;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = algorithm;
    Renderer renderer(device, scene, settings);
    renderer.render_passes(16);
    const double before = processor_seconds();
    renderer.render_passes(64);
    Measurement result;
    result.passes = uint32_t(std::max(1l, std::lround(64 * seconds / (processor_seconds() - before))));

    std::vector<Colors> images, tiled;
    const double start = processor_seconds();
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        renderer.restart(1 + seed);
        for (uint32_t done = 0; done < result.passes; done += 64)
            renderer.render_passes(std::min(64u, result.passes - done));
        images.push_back(colors(renderer.develop()));
        tiled.push_back(tiles_of(images.back()));
    }
    result.seconds = (processor_seconds() - start) / seeds;
    result.of_tiles = noise_of(tiled, result.mean);
    result.of_pixels = noise_of(images, result.mean);
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        auto device = create_device();
        fmt::print("{}, {}\n", device->description.name, device->description.driver);
        const std::string file = argc > 1 ? argv[1] : source_path("scenes/cornell_box.gltf");
        const double seconds = argc > 2 ? std::stod(argv[2]) : 4;
        const Algorithm algorithm = argc > 3 ? parse_algorithm(argv[3], "ALGORITHM") : Algorithm::backward;
        const Measurement rgb = measure(*device, file, ColorMode::rgb, seconds, algorithm);
        const Measurement spectral = measure(*device, file, ColorMode::spectral, seconds, algorithm);
        fmt::print("{:32} {:>22} {:>22}\n", "", "noise of pixels", "of tiles");
        fmt::print("{:9} {:>6} {:>7} {:>8} {:>11} {:>10} {:>11} {:>10}\n", "", "passes", "seconds", "mean Y",
                   "Y", "colour", "Y", "colour");
        for (const auto& [name, m] : {std::pair("rgb", rgb), std::pair("spectral", spectral)})
            fmt::print("{:9} {:6} {:7.2f} {:8.4f} {:11.5f} {:10.5f} {:11.5f} {:10.5f}\n", name, m.passes,
                       m.seconds, m.mean, m.of_pixels.luminance, m.of_pixels.color, m.of_tiles.luminance,
                       m.of_tiles.color);
        fmt::print("{:9} {:6.2f} {:7.2f} {:8.4f} {:11.3f} {:10.3f} {:11.3f} {:10.3f}\n", "ratio",
                   double(spectral.passes) / rgb.passes, spectral.seconds / rgb.seconds,
                   spectral.mean / rgb.mean, spectral.of_pixels.luminance / rgb.of_pixels.luminance,
                   spectral.of_pixels.color / rgb.of_pixels.color,
                   spectral.of_tiles.luminance / rgb.of_tiles.luminance,
                   spectral.of_tiles.color / rgb.of_tiles.color);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return int(error.code);
    }
    return 0;
}
