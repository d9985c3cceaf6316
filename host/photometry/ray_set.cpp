#include "host/photometry/ray_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "host/error.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"

namespace etendue {
namespace {

constexpr double lumens_a_watt = 683;
constexpr size_t most_words = size_t(1) << 30;
constexpr double last_threshold = 1 << 24;  // of random numbers of 24 bits

// lm/W at that wavelength.
double efficacy_at(double nm) {
    static const SpectralTable y = library_table("CIE 1931 y", Outside::zero);
    return nm < first_nm || nm > last_nm ? 0 : lumens_a_watt * y.at(nm);
}

// What passes see of a spectrum on the average over wavelengths, where it and the observer are linear between
// nanometres.
glm::dvec3 seen_rgb(const SpectralTable& s) {
    const auto& w = rgb_weights();
    glm::dvec3 sum(0);
    for (int i = 0; i + 1 < spectrum_samples; ++i) {
        const double a = s.values[i], b = s.values[i + 1];
        sum += (w[i] * (2 * a + b) + w[i + 1] * (a + 2 * b)) / 6.0;
    }
    return sum;
}

// A spectrum scaled to that luminance; its colour keeps it where channels that would be negative are cut.
SpectralValue of_luminance(const SpectralTable& shape, double wanted) {
    const glm::dvec3 seen = seen_rgb(shape), rgb = glm::max(seen, 0.0);
    return {glm::vec3(rgb * (wanted / luminance(rgb))), shape * (wanted / luminance(seen))};
}

SpectralTable band(int center) {
    return tabulate([&](double nm) { return std::max(0.0, 1 - std::abs(nm - center) / band_nm); });
}

// Colours of single wavelengths, by the nearest nanometre.
class Bands {
  public:
    explicit Bands(std::vector<SpectralValue>& colors) : colors_(colors) {}
    uint32_t color_of(double nm, bool of_lumens) {
        const int center = std::clamp(int(std::lround(nm)), first_nm, last_nm);
        const auto [known, is_new] = known_.try_emplace(center, uint32_t(colors_.size()));
        if (is_new) colors_.push_back(of_luminance(band(center), of_lumens ? 1 : efficacy_at(center)));
        return known->second;
    }

  private:
    std::vector<SpectralValue>& colors_;
    std::map<int, uint32_t> known_;
};

// Colours of rays that have tristimulus values: the mean of each of those whose chromaticities are near each
// other. Returns which ray has which.
std::vector<uint32_t> collect_colors(const RayFile& file, std::vector<SpectralValue>& colors) {
    constexpr double cells = 100;  // along each of x and y
    std::map<std::pair<int, int>, uint32_t> known;
    std::vector<glm::dvec3> sums;
    std::vector<uint32_t> color_of;
    for (size_t i = 0; i < file.rays.size(); ++i) {
        const double y = file.rays[i].flux;
        const glm::dvec3 xyz(file.tristimulus[i].x, y, file.tristimulus[i].y);
        const double sum = xyz.x + xyz.y + xyz.z;
        const glm::dvec3 part = y > 0 && sum > 0 ? xyz / sum : glm::dvec3(1.0 / 3);
        const std::pair cell(int(std::lround(cells * part.x)), int(std::lround(cells * part.y)));
        const auto [place, is_new] = known.try_emplace(cell, uint32_t(sums.size()));
        if (is_new) sums.emplace_back(0);
        sums[place->second] += xyz;
        color_of.push_back(place->second);
    }
    for (const glm::dvec3& xyz : sums) {
        const glm::dvec3 rgb = glm::max(rgb_of_xyz(xyz), 0.0);
        const double y = luminance(rgb);
        colors.push_back({y > 0 ? glm::vec3(rgb / y) : glm::vec3(1), {}});
    }
    return color_of;
}

double weight_at(const RaySpectrum& s, double nm) {
    const auto next = size_t(std::upper_bound(s.nm.begin(), s.nm.end(), float(nm)) - s.nm.begin());
    if (next == 0 || (next == s.nm.size() && nm > s.nm.back())) return 0;
    if (next == s.nm.size()) return s.weights.back();
    return std::lerp(double(s.weights[next - 1]), double(s.weights[next]),
                     (nm - s.nm[next - 1]) / (double(s.nm[next]) - s.nm[next - 1]));
}

// lm/W of a table, over all that it holds.
double efficacy_of(const RaySpectrum& s) {
    if (s.nm.size() == 1) return efficacy_at(s.nm[0]);
    double watts = 0, lumens = 0;
    for (size_t i = 0; i + 1 < s.nm.size(); ++i) {
        const double from = s.nm[i], width = double(s.nm[i + 1]) - from;
        const int steps = int(std::clamp(std::ceil(width * 4), 1.0, 4096.0));
        for (int k = 0; k < steps; ++k) {
            const double t = (k + 0.5) / steps,
                         w = std::lerp(double(s.weights[i]), double(s.weights[i + 1]), t) * width / steps;
            watts += w, lumens += w * efficacy_at(from + t * width);
        }
    }
    return watts > 0 ? lumens / watts : 0;
}

// By the nanometre, each the mean over a triangle around it: lines that are narrower are not missed. The
// greatest weight counts as 1. A table of one wavelength is a band.
SpectralTable tabulated(const RaySpectrum& s) {
    if (s.nm.size() == 1) return band(std::clamp(int(std::lround(s.nm[0])), first_nm, last_nm));
    constexpr int fine = 16;
    const double greatest = *std::max_element(s.weights.begin(), s.weights.end());
    return tabulate([&](double nm) {
        double sum = 0;
        for (int k = 1 - fine; k < fine; ++k)
            sum += weight_at(s, nm + double(k) / fine) * (fine - std::abs(k));
        return sum / (fine * fine * greatest);
    });
}

// Vose 1991. Pairs of a threshold in 2^24 and the ray that stands in above it.
void append_alias_table(std::vector<uint32_t>& words, const std::vector<float>& weights, double sum) {
    const size_t n = weights.size(), first = words.size();
    words.resize(first + 2 * n);
    std::vector<float> left(n);
    std::vector<uint32_t> small, large;
    for (size_t i = 0; i < n; ++i) {
        left[i] = float(weights[i] / sum * double(n));
        (left[i] < 1 ? small : large).push_back(uint32_t(i));
    }
    const auto set = [&](uint32_t i, double part, uint32_t alias) {
        words[first + 2 * size_t(i)] = uint32_t(std::lround(part * last_threshold));
        words[first + 2 * size_t(i) + 1] = alias;
    };
    while (!small.empty() && !large.empty()) {
        const uint32_t s = small.back(), l = large.back();
        small.pop_back();
        set(s, left[s], l);
        left[l] -= 1 - left[s];
        if (left[l] < 1) large.pop_back(), small.push_back(l);
    }
    for (const uint32_t i : large) set(i, 1, i);
    // Rounding leaves some that are nearly full, and never one that is dark.
    const auto brightest = uint32_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
    for (const uint32_t i : small) set(i, weights[i] > 0 ? 1 : 0, weights[i] > 0 ? i : brightest);
}

std::string unit_name(const RayFile& file) { return file.unit == RayFile::Unit::watt ? "W" : "lm"; }

}  // namespace

double luminous_efficacy(const SpectralValue& color) {
    const SpectralTable table = color.as_table(SpectralKind::radiance);
    double watts = 0;
    for (const float v : table.values) watts += v;
    return watts > 0 ? xyz_of_radiance(table).y / watts : 0;
}

RaySet append_ray_set(std::vector<uint32_t>& words, const RayFile& file) {
    const size_t n = file.rays.size();
    const bool in_lumens = file.unit == RayFile::Unit::lumen;
    const bool has_wavelengths = !file.wavelengths.empty(), has_tables = !file.spectra.empty();
    RaySet set;
    set.warnings = file.warnings;

    // What each ray carries, in the file's unit, of which each has `lumens_of` its colour.
    std::vector<float> weights(n);
    std::vector<uint32_t> color_of;
    std::vector<double> lumens_of;
    if (has_wavelengths || (has_tables && !file.spectrum_of.empty())) color_of.resize(n);
    if (has_tables)
        for (const RaySpectrum& table : file.spectra) {
            lumens_of.push_back(in_lumens ? 1 : efficacy_of(table));
            const SpectralTable shape = tabulated(table);
            if (luminance(seen_rgb(shape)) < 1e-12) lumens_of.back() = 0;
            set.colors.push_back(lumens_of.back() > 0 ? of_luminance(shape, lumens_of.back())
                                                      : SpectralValue{});
        }
    if (!file.tristimulus.empty()) color_of = collect_colors(file, set.colors);
    Bands bands(set.colors);
    double sum = 0, lumens = 0, dark = 0;
    size_t dark_rays = 0;
    for (size_t i = 0; i < n; ++i) {
        double flux = file.rays[i].flux;
        if (!has_wavelengths && !has_tables && !file.lumens.empty()) flux = file.lumens[i];
        double each = 1;  // lm in a unit of flux
        if (has_wavelengths) {
            const double nm = file.wavelengths[i];
            each = efficacy_at(nm) > 0 ? (in_lumens ? 1 : efficacy_at(nm)) : 0;
            color_of[i] = each > 0 ? bands.color_of(nm, in_lumens) : 0;
        } else if (has_tables) {
            const uint32_t table = file.spectrum_of.empty() ? 0 : file.spectrum_of[i];
            each = lumens_of[table];
            if (!color_of.empty()) color_of[i] = table;
        }
        if (!(each > 0) && flux > 0) dark += flux, ++dark_rays, flux = 0;
        weights[i] = float(flux);
        sum += flux, lumens += flux * each;
    }
    if (dark_rays > 0)
        set.warnings.push_back(
            fmt::format("{} of {} rays, {:.6g} {}, lie outside of 360 to 830 nm and bring no light",
                        dark_rays, n, dark, unit_name(file)));
    if (!in_lumens) set.watts = file.flux();
    const bool knows_lumens = in_lumens || has_wavelengths || has_tables || !file.lumens.empty();
    if (knows_lumens) {
        set.lumens = lumens;
        if (file.stated_lumens > 0 && !in_lumens && std::abs(lumens / file.stated_lumens - 1) > 0.03)
            set.warnings.push_back(
                fmt::format("its rays carry {:.6g} lm, the header states {:.6g} lm: the rays count", lumens,
                            file.stated_lumens));
    } else if (file.stated_lumens > 0) {
        set.lumens = file.stated_lumens;
    }

    // So that the mean luminance of what is drawn is 1. Wavelengths were rounded: the sum is exact again.
    if (!set.colors.empty() && lumens > 0) {
        double seen = 0;
        for (size_t i = 0; i < n; ++i)
            if (weights[i] > 0) {
                const uint32_t c = color_of.empty() ? 0 : color_of[i];
                seen += weights[i] * luminance(glm::dvec3(set.colors[c].rgb));
            }
        for (SpectralValue& color : set.colors) {
            color.rgb *= float(sum / seen);
            if (color.table) color.table = *color.table * (sum / seen);
        }
    }

    RayFileRef& ref = set.ref;
    const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
    ref.first = uint32_t(words.size()), ref.count = uint32_t(n);
    ref.uneven = *least < *most;
    if (color_of.empty() && !set.colors.empty()) set.colors.resize(1);
    if (set.colors.size() < 2) color_of.clear();
    ref.colors = uint32_t(set.colors.size());
    if (!(sum > 0)) set.lumens = 0;
    ref.flux = float(set.lumens.value_or(0));
    ref.polarized = !file.polarization.empty();
    const size_t words_a_ray = ref.polarized ? 12 : 6;
    if (words.size() + n * (words_a_ray + 2 * ref.uneven + !color_of.empty()) > most_words)
        fail_input("ray files with more than 2^30 numbers together");
    if (ref.uneven && sum > 0) append_alias_table(words, weights, sum);
    words.insert(words.end(), color_of.begin(), color_of.end());
    glm::vec3 lo(std::numeric_limits<float>::max()), hi(-lo);
    words.reserve(words.size() + words_a_ray * n);
    const auto append = [&](const glm::vec3& v) {
        for (int k = 0; k < 3; ++k) words.push_back(std::bit_cast<uint32_t>(v[k]));
    };
    for (size_t i = 0; i < n; ++i) {
        const SourceRay& ray = file.rays[i];
        const glm::vec3 p = ray.position * 0.001f;
        lo = glm::min(lo, p), hi = glm::max(hi, p);
        append(p), append(ray.direction);
        if (ref.polarized) append(file.polarization[i].stokes), append(file.polarization[i].axis);
    }
    ref.lo = lo, ref.hi = hi;

    std::string carries = in_lumens ? "" : fmt::format(", {:.6g} W", set.watts);
    if (set.lumens) carries += fmt::format(", {:.6g} lm", *set.lumens);
    const std::string spectra = has_wavelengths ? fmt::format(", {} wavelengths", set.colors.size())
                                : file.spectra.size() == 1 ? ", one spectrum"
                                : has_tables               ? fmt::format(", {} spectra", file.spectra.size())
                                : set.colors.size() > 1    ? fmt::format(", {} colours", set.colors.size())
                                                           : "";
    set.summary =
        fmt::format("{}, {} rays{}{}{}, from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) mm",
                    file.format, n, carries, spectra, ref.polarized ? ", polarized" : "", 1000 * lo.x,
                    1000 * lo.y, 1000 * lo.z, 1000 * hi.x, 1000 * hi.y, 1000 * hi.z);
    return set;
}

}  // namespace etendue
