#include "tests/support/bsdf_files.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>

namespace etendue {
namespace {

using std::numbers::pi;

template <class T>
void put(std::string& out, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out.append(bytes, sizeof(T));
}

glm::dvec3 spherical(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double ggx_density(const GgxMetal& m, const glm::dvec3& h) {
    const double q = h.x * h.x / (m.alpha_x * m.alpha_x) + h.y * h.y / (m.alpha_y * m.alpha_y) + h.z * h.z;
    return 1 / (pi * m.alpha_x * m.alpha_y * q * q);
}

// Projected area of the facets that a direction sees: |cos| / G1.
double ggx_area(const GgxMetal& m, const glm::dvec3& w) {
    return 0.5 * (w.z + std::sqrt(w.z * w.z + m.alpha_x * m.alpha_x * w.x * w.x +
                                  m.alpha_y * m.alpha_y * w.y * w.y));
}

double ggx_masking(const GgxMetal& m, const glm::dvec3& w) { return w.z > 0 ? w.z / ggx_area(m, w) : 0; }

// One bilinear table over the unit square, and the warp that draws from it. Sums by midpoints of cells are
// exact.
struct Warp {
    size_t n;
    std::vector<double> values;  // [row][column]
    double at(size_t row, size_t column) const { return values[row * n + column]; }
    // The part of [0, 1] below which `part` of the integral of a piecewise linear function lies.
    static double place(const std::vector<double>& f, double part) {
        double total = 0, before = 0;
        for (size_t i = 1; i < f.size(); ++i) total += 0.5 * (f[i - 1] + f[i]);
        for (size_t i = 1; i < f.size(); ++i) {
            const double cell = 0.5 * (f[i - 1] + f[i]);
            if (before + cell >= part * total && cell > 0) {
                const double wanted = std::max(part * total - before, 0.0), a = f[i - 1], b = f[i];
                const double x =
                    2 * wanted / (a + std::sqrt(std::max(a * a + 2 * (b - a) * wanted, 0.0)) + 1e-300);
                return (double(i - 1) + std::min(x, 1.0)) / double(f.size() - 1);
            }
            before += cell;
        }
        return 1;
    }
    std::vector<double> row_sums() const {
        std::vector<double> rows(n, 0.0);
        for (size_t y = 0; y < n; ++y)
            for (size_t x = 1; x < n; ++x) rows[y] += 0.5 * (at(y, x - 1) + at(y, x));
        return rows;
    }
    glm::dvec2 warp(const std::vector<double>& rows, const glm::dvec2& u) const {
        std::vector<double> across(n);
        const double v = place(rows, u.y), position = v * double(n - 1);
        const size_t y = std::min(size_t(position), n - 2);
        for (size_t x = 0; x < n; ++x) across[x] = std::lerp(at(y, x), at(y + 1, x), position - double(y));
        return {place(across, u.x), v};
    }
};

double theta_at(double u) { return u * u * pi / 2; }
double phi_at(double v) { return (2 * v - 1) * pi; }

}  // namespace

TensorData float_tensor(std::vector<uint64_t> shape, const std::vector<float>& values) {
    TensorData data{10, std::move(shape), std::vector<uint8_t>(values.size() * 4)};
    std::memcpy(data.bytes.data(), values.data(), data.bytes.size());
    return data;
}

std::string tensor_file_bytes(const TensorFields& fields) {
    size_t place = 18;
    for (const auto& [name, data] : fields) place += 13 + name.size() + 8 * data.shape.size();
    std::string out("tensor_file", 12);
    put<uint8_t>(out, 1), put<uint8_t>(out, 0), put<uint32_t>(out, uint32_t(fields.size()));
    for (const auto& [name, data] : fields) {
        put<uint16_t>(out, uint16_t(name.size()));
        out += name;
        put<uint16_t>(out, uint16_t(data.shape.size())), put<uint8_t>(out, data.type),
            put<uint64_t>(out, place);
        for (const uint64_t size : data.shape) put<uint64_t>(out, size);
        place += data.bytes.size();
    }
    for (const auto& [name, data] : fields)
        out.append(reinterpret_cast<const char*>(data.bytes.data()), data.bytes.size());
    return out;
}

namespace {

// Amplitudes of s and p, Verdet's signs.
std::pair<std::complex<double>, std::complex<double>> conductor_amplitudes(double cosine,
                                                                           const std::complex<double>& n) {
    const std::complex<double> inner = std::sqrt(n * n - (1 - cosine * cosine));
    return {(cosine - inner) / (cosine + inner), (n * n * cosine - inner) / (n * n * cosine + inner)};
}

}  // namespace

double conductor_reflectance(double cosine, double eta, double k) {
    const auto [s, p] = conductor_amplitudes(cosine, {eta, -k});
    return 0.5 * (std::norm(s) + std::norm(p));
}

std::array<double, 16> metal_matrix(const PolarizedMetal& metal, double nm, const glm::dvec3& from,
                                    const glm::dvec3& to) {
    const glm::dvec3 h = glm::normalize(from + to);
    const GgxMetal ggx{metal.alpha, metal.alpha, {}};
    const double f = ggx_density(ggx, h) / (4 * ggx_area(ggx, from) * ggx_area(ggx, to));
    const auto [s, p] = conductor_amplitudes(glm::dot(from, h), metal.index(nm));
    const double a = 0.5 * f * (std::norm(s) + std::norm(p)), b = 0.5 * f * (std::norm(s) - std::norm(p));
    const std::complex<double> coherent = f * p * std::conj(s);  // its argument is the phase of p before s
    const double c = coherent.real(), d = coherent.imag();
    return {a, b, 0, 0, b, a, 0, 0, 0, 0, c, -d, 0, 0, d, c};
}

MuellerNodes even_nodes(size_t phi_d, size_t theta_d, size_t theta_h) {
    return {even_angles(-pi, pi, phi_d), even_angles(0, pi / 2, theta_d), even_angles(0, pi / 2, theta_h)};
}

std::pair<glm::dvec3, glm::dvec3> half_difference(double phi_d, double theta_d, double theta_h) {
    const glm::dvec3 h = spherical(theta_h, 0), down(h.z, 0, -h.x), across(0, 1, 0);
    const glm::dvec3 middle = std::cos(theta_d) * h,
                     apart = std::sin(theta_d) * (std::cos(phi_d) * down + std::sin(phi_d) * across);
    return {middle + apart, middle - apart};
}

TensorFields mueller_fields(const MuellerNodes& nodes, const std::vector<uint16_t>& wavelengths,
                            const MatrixOfDirections& matrix) {
    std::vector<float> values;
    for (const double phi_d : nodes.phi_d)
        for (const double theta_d : nodes.theta_d)
            for (const double theta_h : nodes.theta_h)
                for (const uint16_t nm : wavelengths) {
                    const auto [from, to] = half_difference(phi_d, theta_d, theta_h);
                    const bool above = from.z > 1e-9 && to.z > 1e-9;
                    const auto m = above ? matrix(nm, from, to) : std::array<double, 16>{std::nan("")};
                    values.insert(values.end(), m.begin(), m.end());
                }
    const auto axis = [](const std::vector<double>& angles) {
        return float_tensor({1, angles.size()}, std::vector<float>(angles.begin(), angles.end()));
    };
    TensorData nm{3, {wavelengths.size()}, std::vector<uint8_t>(2 * wavelengths.size())};
    std::memcpy(nm.bytes.data(), wavelengths.data(), nm.bytes.size());
    const uint64_t a = nodes.phi_d.size(), b = nodes.theta_d.size(), c = nodes.theta_h.size();
    return {{"phi_d", axis(nodes.phi_d)},
            {"theta_d", axis(nodes.theta_d)},
            {"theta_h", axis(nodes.theta_h)},
            {"wvls", nm},
            {"M", float_tensor({a, b, c, wavelengths.size(), 4, 4}, values)}};
}

TensorFields rgl_fields(const GgxMetal& metal, const std::vector<double>& wavelengths,
                        const RglResolution& resolution) {
    const bool isotropic = resolution.phi_i.size() <= 2;
    const size_t n = resolution.points, m = resolution.value_points;
    const size_t channels = wavelengths.empty() ? 3 : wavelengths.size();
    std::vector<float> normals, area, visible, luminance, values;
    for (size_t y = 0; y < n; ++y)
        for (size_t x = 0; x < n; ++x) {
            const double theta = theta_at(double(x) / double(n - 1)), phi = phi_at(double(y) / double(n - 1));
            normals.push_back(float(ggx_density(metal, spherical(theta, phi))));
            area.push_back(float(ggx_area(metal, spherical(theta, phi))));
        }
    for (const double phi_i : resolution.phi_i)
        for (const double theta_i : resolution.theta_i) {
            // Half vectors are given relative to the azimuth where the surface is isotropic.
            const glm::dvec3 w = spherical(theta_i, isotropic ? 0 : phi_i);
            Warp warp{n, {}};
            for (size_t y = 0; y < n; ++y)
                for (size_t x = 0; x < n; ++x) {
                    const double u = double(x) / double(n - 1);
                    const glm::dvec3 h = spherical(theta_at(u), phi_at(double(y) / double(n - 1)));
                    const double angle = 2 * pi * pi * u * std::sin(theta_at(u));
                    warp.values.push_back(ggx_density(metal, h) * std::max(glm::dot(w, h), 0.0) * angle);
                    visible.push_back(float(warp.values.back()));
                }
            const std::vector<double> rows = warp.row_sums();
            const size_t first = values.size();
            values.resize(first + channels * m * m);
            for (size_t y = 0; y < m; ++y)
                for (size_t x = 0; x < m; ++x) {
                    const glm::dvec2 u = warp.warp(rows, glm::dvec2(double(x), double(y)) / double(m - 1));
                    const glm::dvec3 h = spherical(theta_at(u.x), phi_at(u.y));
                    const double cosine = glm::dot(w, h), masking = ggx_masking(metal, 2 * cosine * h - w);
                    double mean = 0;
                    for (size_t c = 0; c < channels; ++c) {
                        const double v = masking * metal.reflectance(std::max(cosine, 0.0), c);
                        values[first + (c * m + y) * m + x] = float(v);
                        mean += v / double(channels);
                    }
                    luminance.push_back(float(mean));
                }
        }
    const std::vector<float> theta(resolution.theta_i.begin(), resolution.theta_i.end());
    const std::vector<float> phi(resolution.phi_i.begin(), resolution.phi_i.end());
    const std::vector<float> nm(wavelengths.begin(), wavelengths.end());
    const uint64_t a = phi.size(), b = theta.size();
    const std::string text = "GGX metal";
    TensorFields fields = {{"description", {1, {text.size()}, {text.begin(), text.end()}}},
                           {"jacobian", {1, {1}, {1}}},
                           {"theta_i", float_tensor({b}, theta)},
                           {"phi_i", float_tensor({a}, phi)},
                           {"ndf", float_tensor({n, n}, normals)},
                           {"sigma", float_tensor({n, n}, area)},
                           {"vndf", float_tensor({a, b, n, n}, visible)},
                           {"luminance", float_tensor({a, b, m, m}, luminance)}};
    fields.push_back({nm.empty() ? "rgb" : "spectra", float_tensor({a, b, channels, m, m}, values)});
    if (!nm.empty()) fields.push_back({"wavelengths", float_tensor({nm.size()}, nm)});
    return fields;
}

nlohmann::json table_side(const nlohmann::json& table, const TableValue& value) {
    nlohmann::json side = nlohmann::json::array();
    for (const double i : table["theta_i"]) {
        nlohmann::json swept = nlohmann::json::array();
        for (const double r : table["theta_r"]) {
            nlohmann::json around = nlohmann::json::array();
            for (const double p : table["phi"]) around.push_back(value(i, r, p));
            swept.push_back(std::move(around));
        }
        side.push_back(std::move(swept));
    }
    return side;
}

std::vector<double> even_angles(double first, double last, size_t count) {
    std::vector<double> angles;
    for (size_t i = 0; i < count; ++i)
        angles.push_back(std::lerp(first, last, double(i) / double(count - 1)));
    return angles;
}

double ggx_bsdf(const GgxMetal& metal, size_t channel, double theta_i, double theta_r, double phi) {
    constexpr double degree = pi / 180;
    const glm::dvec3 a = spherical(theta_i * degree, 0), b = spherical(theta_r * degree, phi * degree);
    const glm::dvec3 h = glm::normalize(a + b);
    return metal.reflectance(glm::dot(a, h), channel) * ggx_density(metal, h) /
           (4 * ggx_area(metal, a) * ggx_area(metal, b));
}

}  // namespace etendue
