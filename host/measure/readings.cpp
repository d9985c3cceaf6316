#include "host/measure/readings.h"

#include "host/render/spectral_film.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

std::vector<PixelPlace> pixel_places(Device& device, Scene& scene, const Receiver& receiver, uint32_t columns,
                                     uint32_t rows) {
    const uint32_t pixels = columns * rows;
    const Buffer buffer(device, uint64_t(pixels) * sizeof(PixelPlace), "PixelPlaces");
    const Kernel kernel =
        make_color_kernel(device, scene, "kernels/measure_receivers.comp", {{"PixelPlaces", &buffer}});
    CommandList commands(device);
    commands.dispatch(
        kernel, (pixels + kernel.group_size() - 1) / kernel.group_size(),
        {{"first", 0u}, {"last", pixels}, {"columns", columns}, {"rows", rows}, {"receiver", receiver.ref}});
    commands.run();
    return buffer.read_array<PixelPlace>(pixels);
}

void add_means(Image& image, const Readings& readings, const std::string& prefix) {
    const size_t pixels = readings.meter.pixels();
    std::vector<glm::vec3> means(pixels), errors(pixels);
    for (size_t i = 0; i < pixels; ++i) {
        glm::dvec3 sum(0), squares(0);
        for (uint32_t k = 0; k < replicates; ++k) {
            const glm::dvec3 x = value(readings.sums[i * replicates + k]) / double(readings.passes);
            sum += x, squares += x * x;
        }
        const glm::dvec3 mean = sum / double(replicates);
        const glm::dvec3 spread = glm::max(squares / double(replicates) - mean * mean, glm::dvec3(0));
        means[i] = mean;
        errors[i] = glm::sqrt(spread / double(replicates - 1));
    }
    for (const auto& [values, name] : {std::pair(&means, prefix), std::pair(&errors, "error." + prefix)})
        add_channels(image, {name + "R", name + "G", name + "B"},
                     std::span<const float>(&values->front().x, 3 * pixels), 3);
}

}  // namespace

Meter describe_meter(Device& device, Scene& scene, const Receiver& receiver) {
    const ClassInfo& info = *receiver.info;
    Meter meter{receiver.name,
                info.pixel_unit,
                receiver.columns,
                receiver.rows,
                info.is_far,
                false,
                receiver.watched.count,
                pixel_places(device, scene, receiver, receiver.columns, receiver.rows)};
    meter.has_extent = (info.is_far || info.has_receptor) && meter.places.front().extent > 0;
    for (PixelPlace& place : meter.places) place.position += glm::vec3(scene.center);
    return meter;
}

double c_angle(const Meter& meter, uint32_t column) { return 360.0 * column / meter.columns; }
double gamma_angle(const Meter& meter, uint32_t row) { return 180.0 * row / (meter.rows - 1.0); }

bool has_parts(const Readings& readings) { return readings.meter.triangles > 0 && readings.meter.rows > 1; }

std::vector<ReadingsPart> parts_of(const Readings& readings) {
    std::vector<ReadingsPart> parts;
    if (!has_parts(readings)) return parts;
    const Meter& meter = readings.meter;
    const size_t stride = meter.pixels() / std::size(surface_parts);
    for (const char* name : surface_parts) {
        const size_t first = parts.size() * stride;
        Readings part;
        part.meter = meter;
        part.meter.columns = meter.triangles, part.meter.rows = 1;
        const auto places = meter.places.begin() + std::ptrdiff_t(first);
        part.meter.places.assign(places, places + meter.triangles);
        const auto sums = readings.sums.begin() + std::ptrdiff_t(first * replicates);
        part.sums.assign(sums, sums + std::ptrdiff_t(size_t(meter.triangles) * replicates));
        part.passes = readings.passes;
        part.forward_paths = readings.forward_paths, part.probing_paths = readings.probing_paths;
        parts.push_back({name, std::move(part)});
    }
    return parts;
}

PixelMeans replicate_means(const Readings& readings, uint32_t replicate) {
    PixelMeans means(readings.meter.pixels());
    for (size_t i = 0; i < means.size(); ++i)
        means[i] =
            value(readings.sums[i * replicates + replicate]) / double(std::max<uint64_t>(readings.passes, 1));
    return means;
}

std::vector<double> row_spectrum(const Readings& readings, uint32_t row, uint32_t replicate) {
    const size_t triples = spectral_sums(1, readings.spectral_bins, 1);
    const double samples = double(std::max<uint64_t>(readings.passes, 1)) * readings.meter.columns;
    std::vector<double> bins;
    for (uint32_t bin = 0; bin < readings.spectral_bins; ++bin) {
        const size_t place = (size_t(row) * replicates + replicate) * triples + bin / 3;
        bins.push_back(value(readings.row_spectra[place])[int(bin % 3)] / samples);
    }
    return bins;
}

Readings of_layer(const Readings& readings, const LayerReadings& layer) {
    Readings alone;
    alone.meter = readings.meter, alone.sums = layer.sums, alone.passes = readings.passes;
    return alone;
}

Image to_image(const Readings& readings) {
    Image image;
    image.width = readings.meter.columns, image.height = readings.meter.rows;
    add_means(image, readings, "");
    for (const LayerReadings& layer : readings.layers)
        add_means(image, of_layer(readings, layer), layer.name + ".");
    image.attributes["pixelUnit"] = readings.meter.unit;
    if (readings.spectral_bins > 0) {
        add_spectra(image, readings.spectra, readings.spectral_bins, 1, readings.passes * replicates);
        const std::string& unit = readings.meter.unit;
        if (unit == "lx") image.attributes["emissiveUnits"] = std::string("W.m^-2.nm^-1");
        if (unit == "cd") image.attributes["emissiveUnits"] = std::string("W.sr^-1.nm^-1");
    }
    return image;
}

}  // namespace etendue
