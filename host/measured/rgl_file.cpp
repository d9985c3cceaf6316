// Files of the RGL material database: Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient
// Material Acquisition and Rendering". Angles of directions and half vectors are warped to the unit square:
// theta = u² pi/2 (columns), phi = (2 v - 1) pi (rows).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/error.h"
#include "host/measured/maps.h"
#include "host/measured/tensor_file.h"

namespace etendue {
namespace {

using std::numbers::pi;

// A field over [slices…][rows][columns], with at least two of both.
struct Grid {
    std::vector<float> values;
    size_t slices = 1, rows = 0, columns = 0;
};

void widen(Grid& grid) {
    if (grid.rows > 1 && grid.columns > 1) return;
    const size_t rows = std::max<size_t>(grid.rows, 2), columns = std::max<size_t>(grid.columns, 2);
    std::vector<float> values;
    for (size_t s = 0; s < grid.slices; ++s)
        for (size_t y = 0; y < rows; ++y)
            for (size_t x = 0; x < columns; ++x)
                values.push_back(grid.values[(s * grid.rows + std::min(y, grid.rows - 1)) * grid.columns +
                                             std::min(x, grid.columns - 1)]);
    grid = {std::move(values), grid.slices, rows, columns};
}

Grid read_grid(const TensorFile& file, const std::string& name, size_t dimensions) {
    const std::vector<uint64_t>& shape = file.field(name, TensorType::float32, dimensions).shape;
    if (shape[dimensions - 1] > most_map_points || shape[dimensions - 2] > most_map_points)
        fail_input("{}: field {} has the shape [{}]; allowed: at most {} rows and columns", file.name(), name,
                   shape_text(shape), most_map_points);
    Grid grid{file.floats(name, dimensions), 1, shape[dimensions - 2], shape[dimensions - 1]};
    for (size_t d = 0; d + 2 < dimensions; ++d) grid.slices *= shape[d];
    // Noise of a measurement may be negative; light is not.
    for (float& v : grid.values) v = std::max(v, 0.0f);
    return grid;
}

MeasuredMap add_grid(MeasuredBsdf& bsdf, Grid grid, bool normalize) {
    widen(grid);
    return add_map(bsdf, grid.values, even_coordinates(grid.columns), even_coordinates(grid.rows), normalize);
}

void require_slices(const TensorFile& file, const std::string& name, size_t found, size_t wanted) {
    if (found != wanted)
        fail_input("{}: field {} has {} tables; allowed: {}, one a direction of phi_i and theta_i",
                   file.name(), name, found, wanted);
}

// Keeps the tables of the first azimuth alone.
void keep_first_azimuth(Grid& grid, size_t azimuths) {
    grid.slices /= azimuths;
    grid.values.resize(grid.slices * grid.rows * grid.columns);
}

}  // namespace

MeasuredBsdf read_rgl_file(const std::filesystem::path& path) {
    const TensorFile file(path);
    const bool is_spectral = file.has("wavelengths");
    const std::string values_name = is_spectral ? "spectra" : "rgb";
    std::vector<double> phi = file.rising("phi_i", 1, -2 * pi - 1e-3, 2 * pi + 1e-3, most_map_points);
    const std::vector<double> theta = file.rising("theta_i", 1, 0, pi / 2 + 1e-3, most_map_points);
    const std::vector<double> wavelengths =
        is_spectral ? file.rising("wavelengths", 1, 1, 1e6, most_map_points) : std::vector<double>();
    const bool jacobian = file.read<uint8_t>(file.field("jacobian", TensorType::uint8, 1), 0, 1)[0] != 0;

    Grid normals = read_grid(file, "ndf", 2), area = read_grid(file, "sigma", 2);
    Grid visible = read_grid(file, "vndf", 4), density = read_grid(file, "luminance", 4);
    Grid values = read_grid(file, values_name, 5);
    const size_t azimuths = phi.size(), directions = azimuths * theta.size();
    const size_t channels = is_spectral ? wavelengths.size() : 3;
    require_slices(file, "vndf", visible.slices, directions);
    require_slices(file, "luminance", density.slices, directions);
    require_slices(file, values_name, values.slices, directions * channels);
    if (values.rows != density.rows || values.columns != density.columns)
        fail_input("{}: fields luminance and {} differ in their rows or columns", file.name(), values_name);
    if (values.rows < 2 || values.columns < 2)
        fail_input("{}: field {} has {} rows and {} columns; allowed: at least 2 of both", file.name(),
                   values_name, values.rows, values.columns);

    MeasuredBsdf bsdf;
    bsdf.ref.kind = measured_halfway;
    uint32_t symmetry = 1;
    if (azimuths <= 2) {  // so the format marks isotropic surfaces
        keep_first_azimuth(visible, azimuths), keep_first_azimuth(density, azimuths);
        keep_first_azimuth(values, azimuths);
        phi.resize(1);
    } else {
        bsdf.ref.kind |= measured_anisotropic;
        const double parts = std::min(2 * pi / (phi.back() - phi.front()), 1e6);
        symmetry = uint32_t(std::lround(parts));
        if (std::abs(parts - symmetry) > 0.02 * parts || (symmetry != 1 && symmetry != 2 && symmetry != 4))
            fail_input("{}: field phi_i covers {:.4g} of a turn; allowed: the whole, a half or a quarter",
                       file.name(), 1 / parts);
        if (std::abs(phi.front() + pi) > 0.02)
            fail_input("{}: field phi_i begins at {:.4g}; allowed: -pi", file.name(), phi.front());
    }
    bsdf.ref.kind |= symmetry << measured_symmetry;
    bsdf.ref.theta_first = add_numbers(bsdf, theta), bsdf.ref.theta_count = uint32_t(theta.size());
    bsdf.ref.phi_first = add_numbers(bsdf, phi), bsdf.ref.phi_count = uint32_t(phi.size());
    if (!jacobian) {  // the values are f cos themselves: ndf / (4 sigma) is to be 1
        std::fill(normals.values.begin(), normals.values.end(), 4.0f);
        std::fill(area.values.begin(), area.values.end(), 1.0f);
    }
    // Sampling must be able to reach whatever scatters, also where the luminance was too small to be
    // measured.
    const size_t points = density.rows * density.columns;
    for (size_t first = 0; first < density.values.size(); first += points) {
        double sum = 0;
        for (size_t i = first; i < first + points; ++i) sum += density.values[i];
        const float least = float(0.01 * sum / double(points));
        for (size_t i = first; i < first + points; ++i)
            density.values[i] = std::max(density.values[i], least);
    }
    bsdf.ref.density = add_grid(bsdf, std::move(density), true);
    bsdf.ref.visible = add_grid(bsdf, std::move(visible), true);
    bsdf.ref.normals = add_grid(bsdf, std::move(normals), false);
    bsdf.ref.area = add_grid(bsdf, std::move(area), false);

    // [direction][channel][point] becomes [direction][point][channel].
    std::vector<float> by_point(values.values.size());
    for (size_t d = 0; d < values.slices / channels; ++d)
        for (size_t c = 0; c < channels; ++c)
            for (size_t p = 0; p < points; ++p)
                by_point[(d * points + p) * channels + c] = values.values[(d * channels + c) * points + p];
    values = {};
    add_channels(bsdf, by_point, wavelengths);
    return bsdf;
}

MeasuredBsdf read_measured_bsdf(const std::filesystem::path& path) {
    return path.extension() == ".bsdf" ? read_rgl_file(path) : read_bsdf_table(path);
}

}  // namespace etendue
