#include "host/measured/mueller_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "host/error.h"
#include "host/measured/maps.h"
#include "host/measured/mueller_matrix.h"
#include "host/measured/tensor_file.h"
#include "host/parallel_for.h"
#include "host/spectra/wavelengths.h"

namespace etendue {
namespace {

using std::numbers::pi;

constexpr size_t most_nodes = 1024;          // of an axis; lib/mueller_table.glsl searches no further
constexpr double given_up = 1e-4;            // of the polarization: no rounding makes more of it than light
constexpr float least_intensity = 1e-20f;    // below which it is black, 1/sr
constexpr uint32_t no_source = 0xFFFFFFFFu;  // nothing was measured

// The axes and wavelengths of a file, checked.
struct Layout {
    std::vector<double> phi_d, theta_d, theta_h, wavelengths;
    bool repeats_first = false;  // phi_d has the first node again as its last

    explicit Layout(const TensorFile& file)
        : phi_d(file.rising("phi_d", 2, -2 * pi - 1e-3, 2 * pi + 1e-3, most_nodes)),
          theta_d(file.rising("theta_d", 2, 0, pi / 2 + 1e-3, most_nodes)),
          theta_h(file.rising("theta_h", 2, 0, pi / 2 + 1e-3, most_nodes)) {
        for (const auto& [name, axis] :
             {std::pair("phi_d", &phi_d), {"theta_d", &theta_d}, {"theta_h", &theta_h}})
            if (axis->size() < 2)
                fail_input("{}: field {} has one number; allowed: at least 2", file.name(), name);
        double widest = 0;
        for (size_t i = 1; i < phi_d.size(); ++i) widest = std::max(widest, phi_d[i] - phi_d[i - 1]);
        const double gap = 2 * pi - (phi_d.back() - phi_d.front());
        repeats_first = std::abs(gap) < 1e-3;
        if (gap < -1e-3 || gap > 1.5 * widest)
            fail_input("{}: field phi_d goes from {:.4g} to {:.4g}; allowed: once around, 2 pi in all",
                       file.name(), phi_d.front(), phi_d.back());
        const TensorField& field = file.field("wvls", TensorType::uint16, 1);
        if (field.shape[0] > most_nodes)
            fail_input("{}: field wvls has {} numbers; allowed: at most {}", file.name(), field.shape[0],
                       most_nodes);
        for (const uint16_t nm : file.read<uint16_t>(field, 0, field.shape[0])) {
            if (nm == 0 || (!wavelengths.empty() && nm <= wavelengths.back()))
                fail_input("{}: field wvls: number {} is {}; allowed: numbers that rise, nm", file.name(),
                           wavelengths.size(), nm);
            wavelengths.push_back(nm);
        }
        const std::vector<uint64_t> wanted = {
            phi_d.size(), theta_d.size(), theta_h.size(), wavelengths.size(), 4, 4};
        const std::vector<uint64_t>& found = file.field("M", TensorType::float32, 6).shape;
        if (found != wanted)
            fail_input(
                "{}: field M has the shape [{}]; allowed: [{}], as phi_d, theta_d, theta_h and wvls say",
                file.name(), shape_text(found), shape_text(wanted));
    }
};

// Which entry of [theta_d][theta_h] takes the place of each.
std::vector<uint32_t> nearest_measured(const std::vector<bool>& measured, size_t rows, size_t columns) {
    std::vector<uint32_t> source(measured.size(), no_source);
    const auto nearest = [](size_t at, size_t count, const auto& is_there) -> std::optional<size_t> {
        for (size_t away = 0; away < count; ++away) {
            if (away <= at && is_there(at - away)) return at - away;
            if (at + away < count && is_there(at + away)) return at + away;
        }
        return {};
    };
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = 0; column < columns; ++column)
            if (const auto found =
                    nearest(column, columns, [&](size_t c) { return measured[row * columns + c]; }))
                source[row * columns + column] = uint32_t(row * columns + *found);
    const std::vector<uint32_t> along = source;
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = 0; column < columns; ++column)
            if (const auto found =
                    nearest(row, rows, [&](size_t r) { return along[r * columns + column] != no_source; }))
                source[row * columns + column] = along[*found * columns + column];
    return source;
}

// What is left of a measured matrix: its first element, and the others over it, packed.
float pack(const float* m, glm::uvec4* packed) {
    const float intensity = m[0] >= least_intensity ? m[0] : 0.0f;
    MuellerMatrix ratios{1};
    for (size_t i = 1; i < 16 && intensity > 0; ++i) ratios[i] = double(m[i]) / intensity;
    ratios = without_excess(ratios);
    for (int i = 0; i < 16; ++i) {
        const double x = i == 0 ? 1 : (1 - given_up) * ratios[size_t(i)];
        const uint32_t bits = uint32_t(uint16_t(int16_t(std::lround(32767 * std::clamp(x, -1.0, 1.0)))));
        uint32_t& word = packed[i / 8][(i % 8) / 2];
        word = i % 2 == 0 ? bits : word | bits << 16;
    }
    return intensity;
}

// Half the ways to both neighbours of each node.
std::vector<double> widths(const std::vector<double>& nodes) {
    std::vector<double> result(nodes.size(), 0.0);
    for (size_t i = 1; i < nodes.size(); ++i)
        for (const size_t k : {i - 1, i}) result[k] += 0.5 * (nodes[i] - nodes[i - 1]);
    return result;
}

// How much light facets of each theta_h reflect, of light that comes evenly from everywhere, a solid angle of
// half vectors; and what a surface of the same intensity 1 everywhere would.
struct Reflected {
    std::vector<double> table, even;

    explicit Reflected(size_t nodes) : table(nodes, 0.0), even(nodes, 0.0) {}
    // `intensities`: [theta_d][theta_h][channel], of one phi_d.
    void add(const Layout& l, size_t phi, double phi_width, const std::vector<double>& theta_widths,
             std::span<const float> intensities) {
        const size_t channels = intensities.size() / (l.theta_d.size() * l.theta_h.size());
        for (size_t d = 0; d < l.theta_d.size(); ++d)
            for (size_t h = 0; h < l.theta_h.size(); ++h) {
                // Cosines of both directions to the normal; 4 cos(theta_d) between solid angles of half
                // vectors and directions.
                const double middle = std::cos(l.theta_d[d]) * std::cos(l.theta_h[h]);
                const double apart = std::sin(l.theta_d[d]) * std::sin(l.theta_h[h]) * std::cos(l.phi_d[phi]);
                const double weight = std::max(middle - apart, 0.0) * std::max(middle + apart, 0.0) *
                                      std::sin(2 * l.theta_d[d]) * theta_widths[d] * phi_width;
                double sum = 0;
                for (size_t k = 0; k < channels; ++k)
                    sum += intensities[(d * l.theta_h.size() + h) * channels + k];
                table[h] += weight * sum / double(channels), even[h] += weight;
            }
    }
};

// Half vectors are drawn by what they reflect; what a Lambertian surface as dark as the darkest theta_h would
// reflect is left to samples that follow the cosine, between a tenth and nine tenths of them.
void add_lobe(const Layout& l, const Reflected& r, MuellerTable& table, std::vector<float>& numbers) {
    const size_t nodes = l.theta_h.size();
    const std::vector<double> angles = widths(l.theta_h);
    const double most = *std::max_element(r.even.begin(), r.even.end());
    double least = INFINITY, all = 0, all_even = 0;
    for (size_t h = 0; h < nodes; ++h) {
        if (r.even[h] > 1e-3 * most) least = std::min(least, r.table[h] / r.even[h]);
        const double angle = angles[h] * std::sin(l.theta_h[h]);
        all += angle * r.table[h], all_even += angle * r.even[h];
    }
    if (all > 0) table.cosine_part = float(std::clamp(least * all_even / all, 0.1, 0.9));

    // Over sin² theta_h, from 0 to 1, there are pi / cos(theta_h) times as many.
    std::vector<double> x = {0}, density, sums = {0};
    for (size_t h = 0; h < nodes; ++h) {
        const double sine = std::sin(l.theta_h[h]);
        const double value = all > 0 ? r.table[h] / std::max(std::cos(l.theta_h[h]), 1e-3) : 1;
        if (h == 0) density.push_back(value);
        if (float(sine * sine) > float(x.back())) x.push_back(sine * sine), density.push_back(value);
    }
    if (float(x.back()) < 1) x.push_back(1), density.push_back(density.back());
    for (size_t i = 1; i < x.size(); ++i)
        sums.push_back(sums.back() + 0.5 * (density[i - 1] + density[i]) * (x[i] - x[i - 1]));
    table.lobe = uint32_t(numbers.size()), table.lobe_nodes = uint32_t(x.size());
    for (const double v : x) numbers.push_back(float(v));
    for (const double v : density) numbers.push_back(float(v / sums.back()));
    for (const double v : sums) numbers.push_back(float(v / sums.back()));
}

}  // namespace

MuellerFile read_mueller_file(const std::filesystem::path& path, unsigned threads, MuellerTables& all) {
    const TensorFile file(path);
    const Layout l(file);
    const auto [first_channel, end_channel] = visible_channels(l.wavelengths);
    const std::span<const double> wavelengths =
        std::span(l.wavelengths).subspan(first_channel, end_channel - first_channel);
    const size_t rows = l.theta_d.size(), columns = l.theta_h.size(), entries = rows * columns;
    const size_t channels = wavelengths.size(), of_slice = entries * channels;
    const size_t slices = l.phi_d.size() + (l.repeats_first ? 0 : 1);
    if (all.intensities.size() + slices * of_slice > 0x7FFFFFFFu)
        fail_input("{}: too many measured matrices: with those of other files they exceed 2^31", file.name());

    MuellerFile result;
    MuellerTable& table = result.table;
    std::vector<double> phi_nodes = l.phi_d;
    if (l.repeats_first)
        phi_nodes.back() = phi_nodes.front() + 2 * pi;
    else
        phi_nodes.push_back(phi_nodes.front() + 2 * pi);
    const std::vector<double>* axes[3] = {&phi_nodes, &l.theta_d, &l.theta_h};
    for (int a = 0; a < 3; ++a) {
        table.axes[a] = uint32_t(all.numbers.size()), table.nodes[a] = uint32_t(axes[a]->size());
        all.numbers.insert(all.numbers.end(), axes[a]->begin(), axes[a]->end());
    }
    table.matrices = uint32_t(all.intensities.size()), table.wavelengths = uint32_t(channels);
    all.intensities.resize(all.intensities.size() + slices * of_slice);
    all.ratios.resize(2 * all.intensities.size());

    const TensorField& field = file.field("M", TensorType::float32, 6);
    const size_t in_file = entries * l.wavelengths.size();  // matrices of a slice
    const std::vector<double> phi_widths = widths(phi_nodes), theta_widths = widths(l.theta_d);
    Reflected reflected(columns);
    for (size_t phi = 0; phi < slices; ++phi) {
        const size_t from = phi % l.phi_d.size();
        const std::vector<float> values = file.read<float>(field, from * in_file * 16, in_file * 16);
        const auto matrix = [&](size_t entry, size_t channel) {
            return &values[(entry * l.wavelengths.size() + first_channel + channel) * 16];
        };
        float* intensities = &all.intensities[table.matrices + phi * of_slice];
        glm::uvec4* ratios = &all.ratios[2 * (table.matrices + phi * of_slice)];
        for (size_t k = 0; k < channels; ++k) {
            std::vector<bool> measured(entries);
            for (size_t e = 0; e < entries; ++e)
                measured[e] =
                    std::all_of(matrix(e, k), matrix(e, k) + 16, [](float x) { return std::isfinite(x); });
            const std::vector<uint32_t> source = nearest_measured(measured, rows, columns);
            parallel_for(rows, threads, [&](size_t row) {
                for (size_t e = row * columns; e < (row + 1) * columns; ++e) {
                    static constexpr float black[16] = {};
                    const size_t place = e * channels + k;
                    intensities[place] =
                        pack(source[e] == no_source ? black : matrix(source[e], k), &ratios[2 * place]);
                }
            });
        }
        reflected.add(l, from, phi_widths[phi], theta_widths, {intensities, of_slice});
    }
    add_lobe(l, reflected, table, all.numbers);
    result.place.table = channel_places(wavelengths);
    for (int k = 0; k < 3; ++k) result.place.rgb[k] = float(result.place.table->at(dominant_nm[k]));
    return result;
}

}  // namespace etendue
