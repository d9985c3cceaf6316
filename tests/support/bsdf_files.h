// Files of measured surfaces, made from formulas.
#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace etendue {

struct TensorData {
    uint8_t type = 10;  // of host/measured/tensor_file.h
    std::vector<uint64_t> shape;
    std::vector<uint8_t> bytes;
};
using TensorFields = std::vector<std::pair<std::string, TensorData>>;

TensorData float_tensor(std::vector<uint64_t> shape, const std::vector<float>& values);
std::string tensor_file_bytes(const TensorFields& fields);

// A metal with the GGX distribution and independent masking (Walter et al. 2007).
struct GgxMetal {
    double alpha_x = 0.3, alpha_y = 0.3;
    // Part that a facet reflects, at a cosine, of a channel.
    std::function<double(double cosine, size_t channel)> reflectance;
};
double conductor_reflectance(double cosine, double eta, double k);  // unpolarized, from vacuum

struct RglResolution {
    std::vector<double> theta_i = {0, 0.1, 0.25, 0.45, 0.65, 0.85, 1.05, 1.2, 1.3, 1.4, 1.48, 1.54};
    std::vector<double> phi_i = {0};  // more than two: anisotropic
    size_t points = 64;               // along the sides of the tables over half vectors
    size_t value_points = 32;         // … of the values
};

// Fields of an RGL file of that metal: in wavelengths, or where there are none in the colours of three
// channels.
TensorFields rgl_fields(const GgxMetal& metal, const std::vector<double>& wavelengths,
                        const RglResolution& resolution = {});

// Mueller matrices of a metal with the GGX distribution, whose facets reflect after Fresnel.
struct PolarizedMetal {
    double alpha = 0.4;
    std::function<std::complex<double>(double nm)> index;  // n - ik
};
// 1/sr, rows first; x across the plane of both directions, which point away from the surface.
std::array<double, 16> metal_matrix(const PolarizedMetal& metal, double nm, const glm::dvec3& from,
                                    const glm::dvec3& to);

struct MuellerNodes {  // rad; phi_d once around
    std::vector<double> phi_d, theta_d, theta_h;
};
MuellerNodes even_nodes(size_t phi_d, size_t theta_d, size_t theta_h);
// The directions that light comes from and goes to, of one point of such a table (Rusinkiewicz 1998).
std::pair<glm::dvec3, glm::dvec3> half_difference(double phi_d, double theta_d, double theta_h);
// Fields of a file of Baek et al. 2020; what is below the horizon is not a number, so not measured.
using MatrixOfDirections =
    std::function<std::array<double, 16>(double nm, const glm::dvec3& from, const glm::dvec3& to)>;
TensorFields mueller_fields(const MuellerNodes& nodes, const std::vector<uint16_t>& wavelengths,
                            const MatrixOfDirections& matrix);

// A table of our own; angles in degrees, `value` is a number or an array.
using TableValue = std::function<nlohmann::json(double theta_i, double theta_r, double phi)>;
nlohmann::json table_side(const nlohmann::json& table, const TableValue& value);  // for its three lists
std::vector<double> even_angles(double first, double last, size_t count);

// BSDF of that metal, 1/sr, for one channel; angles in degrees, phi between the two azimuths. Isotropic.
double ggx_bsdf(const GgxMetal& metal, size_t channel, double theta_i, double theta_r, double phi);

}  // namespace etendue
