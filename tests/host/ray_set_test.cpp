// Ray files as the device has them: lumens, colours, and how often each ray is drawn.
#include <doctest/doctest.h>

#include <cmath>

#include "host/photometry/ray_set.h"
#include "host/spectra/color.h"
#include "host/spectra/library.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

RayFile own(const std::string& name) { return read_ray_file(source_path("tests/host/rays/" + name)); }

// lm/W by sums over whole nanometres.
double efficacy(const RaySpectrum& s) {
    const SpectralTable y = library_table("CIE 1931 y", Outside::zero);
    const SpectralTable table =
        interpolate(std::vector<double>(s.nm.begin(), s.nm.end()),
                    std::vector<double>(s.weights.begin(), s.weights.end()), Outside::zero);
    double lumens = 0, watts = 0;
    for (int i = 0; i < spectrum_samples; ++i)
        lumens += 683.0 * y.values[size_t(i)] * table.values[size_t(i)], watts += table.values[size_t(i)];
    return lumens / watts;
}

// How often each ray is drawn, by the words of the set.
std::vector<double> probabilities(const std::vector<uint32_t>& words, const RayFileRef& ref) {
    std::vector<double> p(ref.count);
    for (uint32_t i = 0; i < ref.count; ++i) {
        const double own = ref.uneven ? words[ref.first + 2 * i] / double(1 << 24) : 1;
        p[i] += own / ref.count;
        if (ref.uneven) p[words[ref.first + 2 * i + 1]] += (1 - own) / ref.count;
    }
    return p;
}

bool mentions(const std::vector<std::string>& warnings, const std::string& word) {
    for (const std::string& line : warnings)
        if (line.find(word) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("ray sets: lumens follow from wavelengths and tables, or are those of the file") {
    std::vector<uint32_t> words;
    // V(λ) at 450, 550 and 650 nm, CIE 1931.
    const RaySet lines = append_ray_set(words, own("own_3rays_wavelength.tm25ray"));
    CHECK(lines.lumens.value() ==
          doctest::Approx(683 * (0.5 * 0.038 + 0.25 * 0.9949501 + 0.25 * 0.107)).epsilon(1e-6));
    CHECK(lines.watts == 1);
    CHECK(lines.colors.size() == 3);

    const RayFile two = own("own_3rays_two_spectra.tm25ray");
    const RaySet tables = append_ray_set(words, two);
    CHECK(tables.ref.first > 0);  // behind the other file
    CHECK(tables.lumens.value() ==
          doctest::Approx(0.5 * efficacy(two.spectra[0]) + 0.5 * efficacy(two.spectra[1])).epsilon(1e-4));

    CHECK(append_ray_set(words, own("own_3rays_lumen_extra_column_text.tm25ray")).lumens.value() == 100);
    CHECK(!append_ray_set(words, own("own_3rays_flux.tm25ray")).lumens);
    RayFile stated = own("own_3rays_flux.tm25ray");
    stated.stated_lumens = 250;
    CHECK(append_ray_set(words, stated).lumens.value() == 250);
    stated.lumens = {1, 2, 3};
    CHECK(append_ray_set(words, stated).lumens.value() == 6);

    RayFile infrared = own("own_3rays_wavelength.tm25ray");
    infrared.wavelengths = {450, 555, 940};
    const RaySet seen = append_ray_set(words, infrared);
    CHECK(seen.lumens.value() == doctest::Approx(683 * (0.5 * 0.038 + 0.25)).epsilon(1e-5));
    CHECK(mentions(seen.warnings, "1 of 3 rays, 0.25 W, lie outside of 360 to 830 nm"));
    infrared.wavelengths = {940, 940, 940};
    CHECK(append_ray_set(words, infrared).ref.flux == 0);
}

TEST_CASE("ray sets: what is drawn has the mean luminance 1, whatever the spectra") {
    for (const char* name : {"own_3rays_wavelength.tm25ray", "own_3rays_two_spectra.tm25ray"}) {
        CAPTURE(name);
        RayFile file = own(name);
        for (float& nm : file.wavelengths) nm += 0.4f;  // is rounded to whole ones
        std::vector<uint32_t> words;
        const RaySet set = append_ray_set(words, file);
        const std::vector<double> p = probabilities(words, set.ref);
        double mean = 0;
        for (uint32_t i = 0; i < set.ref.count; ++i) {
            const SpectralValue& color = set.colors[words[set.ref.first + 2 * set.ref.count + i]];
            CHECK(luminance(glm::dvec3(color.rgb)) ==
                  doctest::Approx(luminance(rgb_of_radiance(color.table.value()))).epsilon(2e-3));
            CHECK(color.rgb == glm::max(color.rgb, glm::vec3(0)));
            mean += p[i] * luminance(glm::dvec3(color.rgb));
        }
        CHECK(mean == doctest::Approx(1).epsilon(1e-6));
    }
}

TEST_CASE("ray sets: each ray is drawn as often as its part of the flux, dark ones never") {
    RayFile file = own("own_lambert_1mm_4k.tm25ray");
    std::vector<uint32_t> words(5);
    const RaySet even = append_ray_set(words, file);
    CHECK(even.ref.first == 5);
    CHECK(even.ref.uneven == 0);
    CHECK(words.size() == 5 + 6 * file.rays.size());
    for (size_t i = 0; i < file.rays.size(); ++i)
        file.rays[i].flux = i % 11 == 4 ? 0.0f : i == 77 ? 1000.0f : float(std::exp(double(i % 17) - 8));
    words.clear();
    const RaySet uneven = append_ray_set(words, file);
    CHECK(uneven.ref.uneven == 1);
    const std::vector<double> p = probabilities(words, uneven.ref);
    double worst = 0;
    for (size_t i = 0; i < p.size(); ++i) {
        worst = std::max(worst, std::abs(p[i] - file.rays[i].flux / file.flux()));
        REQUIRE((p[i] > 0) == (file.rays[i].flux > 0));
    }
    CHECK(worst < 1e-6);
    CHECK(uneven.ref.lo.x < -4.9e-4f);
    CHECK(uneven.ref.hi.x > 4.9e-4f);
    CHECK(uneven.summary.find("TM-25, 4000 rays, ") == 0);
}

TEST_CASE("ray sets: rays have the colours of their tristimulus values, as often as their lumens") {
    RayFile file = own("own_3rays_flux.tm25ray");
    file.unit = RayFile::Unit::lumen;
    const glm::dvec3 colors[] = {{1, 0.2, 0.1}, {0.1, 1, 0.3}, {0.1, 1, 0.3}};
    glm::dvec3 sum(0);
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec3 rgb = colors[i] * double(i + 1), xyz = xyz_of_rgb(rgb);
        sum += rgb;
        file.rays[i].flux = float(xyz.y);
        file.tristimulus.push_back({xyz.x, xyz.z});
    }
    std::vector<uint32_t> words;
    const RaySet set = append_ray_set(words, file);
    CHECK(set.lumens.value() == doctest::Approx(luminance(sum)).epsilon(1e-4));
    REQUIRE(set.colors.size() == 2);
    const std::vector<double> p = probabilities(words, set.ref);
    const glm::dvec3 seen = set.lumens.value() * (p[0] * glm::dvec3(set.colors[0].rgb) +
                                                  (p[1] + p[2]) * glm::dvec3(set.colors[1].rgb));
    for (int c = 0; c < 3; ++c) CHECK(seen[c] == doctest::Approx(sum[c]).epsilon(2e-4));
}
