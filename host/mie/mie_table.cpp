#include "host/mie/mie_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/parallel_for.h"

namespace etendue {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double narrow = 1e-4;  // variance below which wavelengths a step apart matter more than sizes

double wave_number(const MieParameters& p, double nm) { return 2e9 * pi * p.surrounding.at(nm) / nm; }
Complex relative_index(const MieParameters& p, double nm) {
    return Complex(p.ior.at(nm), -p.absorption.at(nm)) / double(p.surrounding.at(nm));
}
double node_nm(int wavelength) { return mie_first_nm + wavelength * mie_step_nm; }

// Logarithm of the cross sections of the spheres of a radius, which is given in effective radii, over that of
// the most frequent: a gamma distribution of the shape 1 / variance.
double log_share(double variance, double r) {
    const double shape = 1 / variance - 1, mode = 1 - variance;
    return shape * std::log(r / mode) - (r - mode) / variance;
}

// Where log_share is -9, between a radius where it is less and the most frequent one.
double end_of_sizes(double variance, double beyond) {
    double inside = 1 - variance;
    for (int i = 0; i < 50; ++i) {
        const double r = (beyond + inside) / 2;
        (log_share(variance, r) < -9 ? beyond : inside) = r;
    }
    return inside;
}

// Size parameters in light of one wavelength, in units of that of the effective radius.
struct Range {
    double least, greatest;
};
Range sizes(double variance, double nm) {
    if (variance >= narrow) return {end_of_sizes(variance, 1e-9), end_of_sizes(variance, 60)};
    return {nm / (nm + mie_step_nm), nm / (nm - mie_step_nm)};
}

// How much there is of light scattered by spheres of the size parameter x, in units of 1 / k²; `at`: that of
// the effective radius. Of spheres that are all the same: in light of the wavelengths around, by the hat
// function of linear interpolation.
double density_of_size(double variance, double nm, double x, double at) {
    if (variance >= narrow) {
        const double share = log_share(variance, x / at);
        return share < -9 ? 0 : std::exp(share) / (x * x);
    }
    return std::max(0.0, 1 - std::abs(at / x - 1) * nm / mie_step_nm) / (x * x * x * x);
}

// Steps between size parameters that are summed up: as fine as the distribution wants it, and as the
// resonances of spheres do, but for large ones, which have so many that they even out. `at`: the least of
// effective radii.
double step_of_size(double variance, double at, double greatest) {
    const double width = variance >= narrow ? std::sqrt(variance) : double(mie_step_nm) / last_nm;
    return std::min(width * at / 4, std::clamp(greatest / 1000, 0.05, 0.5));
}

// The wavelengths of the table whose indices stand for all: between them these are as good as linear, and
// change so little that what is scattered is linear, too. A rainbow is turned by 2.4 rad times the change,
// and about 2 x^(-2/3) rad wide.
std::vector<int> index_anchors(const MieParameters& p) {
    const double most = 0.2 * std::pow(wave_number(p, first_nm) * p.radius, -2.0 / 3);
    std::vector<int> anchors{0};
    const auto index = [&](int wavelength) { return relative_index(p, node_nm(wavelength)); };
    const auto is_linear = [&](int from, int to) {
        const Complex all = index(to) - index(from);
        bool result = std::abs(all) < most;
        for (int i = from; i <= to; ++i)
            result = result &&
                     std::abs(index(i) - index(from) - all * (double(i - from) / (to - from))) < most / 10;
        return result;
    };
    while (anchors.back() < mie_wavelengths - 1) {
        int next = anchors.back() + 1;
        while (next < mie_wavelengths - 1 && is_linear(anchors.back(), next + 1)) ++next;
        anchors.push_back(next);
    }
    return anchors;
}

// What of the light of wavelength `w` the anchor `i` stands for.
double part_of_anchor(const MieParameters& p, const std::vector<int>& anchors, size_t i, int w) {
    const size_t next = size_t(std::upper_bound(anchors.begin(), anchors.end() - 1, w) - anchors.begin());
    const int from = anchors[next - 1], to = anchors[next];
    // One index for all wavelengths is summed up once.
    const bool constant = relative_index(p, node_nm(from)) == relative_index(p, node_nm(to));
    const double f = constant ? 0 : double(w - from) / (to - from);
    return i + 1 == next ? 1 - f : i == next ? f : 0;
}

double cosine_of_node(uint32_t cells, uint32_t node) {
    const double v = std::min(node, 2 * cells - node) / double(cells);
    return node <= cells ? 1 - v * v * v : v * v * v - 1;
}

// Angles that are summed up together, so that sums stay in registers; blocks of them that a thread takes at
// once; and spheres that share the functions of the angles.
constexpr size_t lanes = 8, blocks = 4, batch = 256;

// π + τ and π - τ of Bohren & Huffman, equation 4.47, for n = 1, 2, …
struct AngleFunctions {
    std::vector<std::array<double, lanes>> plus, minus;
    AngleFunctions(const std::array<double, lanes>& cosines, size_t terms) : plus(terms), minus(terms) {
        for (size_t i = 0; i < lanes; ++i) {
            double before = 0, pi_n = 1;
            for (size_t n = 1; n <= terms; ++n) {
                const double k = double(n), tau = k * cosines[i] * pi_n - (k + 1) * before;
                plus[n - 1][i] = pi_n + tau, minus[n - 1][i] = pi_n - tau;
                before = std::exchange(pi_n, ((2 * k + 1) * cosines[i] * pi_n - (k + 1) * before) / k);
            }
        }
    }
};

// A sphere: (2n + 1) / (n (n + 1)) times a + b and a - b, and what it counts at each wavelength from the
// first.
struct Sphere {
    double x;
    Complex m;
    int first;
    std::vector<double> weights;
    std::vector<std::array<double, 4>> terms;

    void find_terms() {
        const MieCoefficients c = mie_coefficients(x, m);
        for (size_t n = 1; n <= c.a.size(); ++n) {
            const double factor = (2.0 * double(n) + 1) / (double(n) * double(n + 1));
            const Complex sum = factor * (c.a[n - 1] + c.b[n - 1]),
                          difference = factor * (c.a[n - 1] - c.b[n - 1]);
            terms.push_back({sum.real(), sum.imag(), difference.real(), difference.imag()});
        }
    }
};

// Sums over the spheres at nodes [first, first + lanes * blocks), into elements[wavelength * nodes + node].
void add_elements(const std::vector<Sphere>& spheres, uint32_t cells, uint32_t first,
                  std::vector<MieElements>& elements) {
    const uint32_t nodes = 2 * cells + 1;
    size_t most = 0;
    for (const Sphere& s : spheres) most = std::max(most, s.terms.size());
    for (uint32_t block = first; block < std::min<size_t>(first + lanes * blocks, nodes); block += lanes) {
        std::array<double, lanes> cosines;
        for (uint32_t i = 0; i < lanes; ++i)
            cosines[i] = cosine_of_node(cells, std::min(block + i, nodes - 1));
        const AngleFunctions f(cosines, most);
        for (const Sphere& s : spheres) {
            double sum_re[lanes] = {}, sum_im[lanes] = {}, difference_re[lanes] = {},
                   difference_im[lanes] = {};
            for (size_t n = 0; n < s.terms.size(); ++n)
                for (size_t i = 0; i < lanes; ++i) {
                    sum_re[i] += s.terms[n][0] * f.plus[n][i], sum_im[i] += s.terms[n][1] * f.plus[n][i];
                    difference_re[i] += s.terms[n][2] * f.minus[n][i];
                    difference_im[i] += s.terms[n][3] * f.minus[n][i];
                }
            for (uint32_t i = 0; i < lanes && block + i < nodes; ++i) {
                const MieElements e =
                    elements_of({sum_re[i], sum_im[i]}, {difference_re[i], difference_im[i]});
                for (size_t w = 0; w < s.weights.size(); ++w)
                    elements[(size_t(s.first) + w) * nodes + block + i] += e * s.weights[w];
            }
        }
    }
}

// Spheres with the index of anchor `i`: the same sizes at all wavelengths that it stands for.
std::vector<Sphere> spheres_of_anchor(const MieParameters& p, const std::vector<int>& anchors, size_t i) {
    std::vector<double> parts, at;
    double least = 1e300, greatest = 0, least_at = 1e300;
    int first = 0;
    for (int w = 0; w < mie_wavelengths; ++w) {
        const double part = part_of_anchor(p, anchors, i, w);
        if (part == 0) continue;
        if (parts.empty()) first = w;
        parts.push_back(part), at.push_back(wave_number(p, node_nm(w)) * p.radius);
        const Range range = sizes(p.variance, node_nm(w));
        least = std::min(least, range.least * at.back());
        greatest = std::max(greatest, range.greatest * at.back());
        least_at = std::min(least_at, at.back());
    }
    std::vector<Sphere> result;
    if (parts.empty()) return result;
    // Where two anchors share each wavelength, the resonances that one hits even out.
    const double step =
        step_of_size(p.variance, least_at, greatest) / (parts.size() == mie_wavelengths ? 2 : 1);
    for (double x = least + step / 2; x < greatest; x += step) {
        Sphere s{x, relative_index(p, node_nm(anchors[i])), first, {}, {}};
        for (size_t w = 0; w < parts.size(); ++w)
            s.weights.push_back(parts[w] * density_of_size(p.variance, node_nm(first + int(w)), x, at[w]));
        result.push_back(s);
    }
    return result;
}

void fill_wavelength(MieTable& table, int wavelength, const MieElements* elements) {
    const uint32_t nodes = 2 * table.cells + 1;
    const auto step = [&](uint32_t node) {
        return cosine_of_node(table.cells, node) - cosine_of_node(table.cells, node + 1);
    };
    double integral = 0;
    for (uint32_t i = 0; i + 1 < nodes; ++i)
        integral += pi * step(i) * (elements[i].s11 + elements[i + 1].s11);
    glm::vec4* values = &table.values[size_t(wavelength) * nodes];
    float* sums = &table.sums[size_t(wavelength) * nodes];
    for (uint32_t i = 0; i < nodes; ++i) {
        const MieElements e = elements[i] * (1 / integral);
        values[i] = {e.s11, e.b, e.c, e.d};
    }
    double sum = 0;
    for (uint32_t i = 0; i < nodes; ++i) {
        sums[i] = float(sum);
        if (i + 1 < nodes) sum += pi * step(i) * (double(values[i].x) + double(values[i + 1].x));
    }
}

}  // namespace

double largest_mie_size(const MieParameters& p) {
    double k = 0;
    for (int nm = first_nm; nm <= last_nm; ++nm) k = std::max(k, wave_number(p, nm));
    return k * p.radius * (p.variance >= narrow ? sizes(p.variance, first_nm).greatest : 1);
}

MieTable make_mie_table(const MieParameters& p, unsigned threads) {
    MieTable table{p, 0, {}, {}};
    // Ten for each fringe that equal spheres have at 90 degrees; where more would be needed, means over sizes
    // or wavelengths have none.
    table.cells = uint32_t(100 + std::min(10 * wave_number(p, mie_first_nm) * p.radius, 1000.0));
    const size_t nodes = 2 * table.cells + 1, groups = (nodes + lanes * blocks - 1) / (lanes * blocks);
    std::vector<MieElements> elements(mie_wavelengths * nodes);
    const std::vector<int> anchors = index_anchors(p);
    for (size_t anchor = 0; anchor < anchors.size(); ++anchor) {
        const std::vector<Sphere> all = spheres_of_anchor(p, anchors, anchor);
        for (size_t first = 0; first < all.size(); first += batch) {
            std::vector<Sphere> part(all.begin() + ptrdiff_t(first),
                                     all.begin() + ptrdiff_t(std::min(first + batch, all.size())));
            parallel_for(part.size(), threads, [&](size_t i) { part[i].find_terms(); });
            parallel_for(groups, threads, [&](size_t i) {
                add_elements(part, table.cells, uint32_t(i * lanes * blocks), elements);
            });
        }
    }
    table.values.resize(elements.size()), table.sums.resize(elements.size());
    for (int w = 0; w < mie_wavelengths; ++w) fill_wavelength(table, w, &elements[size_t(w) * nodes]);
    return table;
}

MieElements direct_mie_elements(const MieParameters& p, double nm, double cosine) {
    const double at = wave_number(p, nm) * p.radius;
    const Range range = sizes(p.variance, nm);
    const double step = step_of_size(p.variance, at, range.greatest * at) / 4;
    MieElements sum;
    double scattered = 0;
    for (double x = range.least * at + step / 2; x < range.greatest * at; x += step) {
        const MieCoefficients c = mie_coefficients(x, relative_index(p, nm));
        const double weight = density_of_size(p.variance, nm, x, at);
        sum += mie_elements(c, cosine) * weight;
        scattered += weight * pi * x * x * scattering_efficiency(c, x);
    }
    return sum * (1 / scattered);
}

}  // namespace etendue
