// Scattering by spheres: published values, limits, energy, and the table against direct computation.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/mie/mie_table.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

// Of Bohren & Huffman's matrix, over S11.
struct Published {
    double angle, s11, s12, s33, s34;
};

void check_published(double x, double m, const Published& p) {
    CAPTURE(p.angle);
    const MieElements e = mie_elements(mie_coefficients(x, m), std::cos(p.angle * degree));
    CHECK(e.s11 == doctest::Approx(p.s11).epsilon(1e-6));
    CHECK(-e.b / e.s11 == doctest::Approx(p.s12).scale(1).epsilon(1e-5));
    CHECK(e.c / e.s11 == doctest::Approx(p.s33).scale(1).epsilon(1e-5));
    CHECK(-e.d / e.s11 == doctest::Approx(p.s34).scale(1).epsilon(1e-5));
}

// By Simpson's rule over the angle; `steps` is even.
double integral_of_s11(const MieCoefficients& c, int steps) {
    double sum = 0;
    for (int i = 1; i < steps; ++i) {
        const double angle = pi * i / steps;
        sum += (i % 2 == 0 ? 2 : 4) * mie_elements(c, std::cos(angle)).s11 * std::sin(angle);
    }
    return 2 * pi * sum * pi / (3 * steps);
}

MieParameters water(double radius, double variance, double ior = 1.33) {
    return {radius, variance, constant_spectrum(ior), constant_spectrum(0), constant_spectrum(1)};
}

// The elements that stand in a table at a cosine, and what of light is scattered at less of an angle.
MieElements tabulated(const MieTable& t, int wavelength, double cosine) {
    const double v = std::cbrt(1 - std::abs(cosine)) * t.cells;
    const uint32_t k = std::min(uint32_t(v), t.cells - 1);
    const double from = std::pow(double(k) / t.cells, 3), to = std::pow((k + 1.0) / t.cells, 3);
    const double f = (1 - std::abs(cosine) - from) / (to - from);
    const glm::vec4* values = &t.values[size_t(wavelength) * (2 * t.cells + 1)];
    const glm::dvec4 e = glm::mix(glm::dvec4(values[cosine < 0 ? 2 * t.cells - k : k]),
                                  glm::dvec4(values[cosine < 0 ? 2 * t.cells - k - 1 : k + 1]), f);
    return {e.x, e.y, e.z, e.w};
}

// Greatest error of the table, over S11 there.
double table_error(const MieParameters& p, int wavelength) {
    const MieTable table = make_mie_table(p, 1);
    double worst = 0;
    for (int i = 0; i <= 200; ++i) {
        const double u = i / 200.0, side = u < 0.5 ? 2 * u : 2 - 2 * u;  // dense at both ends
        const double turn = side * side * side, cosine = u < 0.5 ? 1 - turn : turn - 1;
        const MieElements e = tabulated(table, wavelength, cosine),
                          r = direct_mie_elements(p, mie_first_nm + wavelength * mie_step_nm, cosine);
        for (const double error : {e.s11 - r.s11, e.b - r.b, e.c - r.c, e.d - r.d})
            worst = std::max(worst, std::abs(error) / r.s11);
    }
    return worst;
}

}  // namespace

TEST_CASE("spheres scatter as published") {
    const MieCoefficients c = mie_coefficients(10, 1.5);
    CHECK(extinction_efficiency(c, 10) == doctest::Approx(2.881999).epsilon(1e-6));  // Wiscombe 1980
    CHECK(scattering_efficiency(c, 10) == doctest::Approx(2.881999).epsilon(1e-6));
    for (const Published& p : {Published{30, 76.807125, 0.000483, 0.820434, -0.571742},
                               Published{60, 34.156739, -0.016315, 0.826403, 0.562843},
                               Published{90, 9.175214, -0.026914, 0.762508, -0.646418},
                               Published{140, 6.757131, 0.628249, -0.628302, -0.458846}})
        check_published(10, 1.5, p);
    check_published(3, 1.33, {90, 0.393641, -0.204286, 0.638983, -0.741598});
}

TEST_CASE("spheres: all that is scattered is in the integral of S11, and what absorbs loses the rest") {
    for (const double x : {0.1, 1.0, 10.0, 100.0})
        for (const std::complex<double> m :
             {std::complex(1.33, 0.0), std::complex(1.5, -0.1), std::complex(0.2, -3.4)}) {
            CAPTURE(x);
            CAPTURE(m.imag());
            const MieCoefficients c = mie_coefficients(x, m);
            const double scattering = scattering_efficiency(c, x), extinction = extinction_efficiency(c, x);
            CHECK(integral_of_s11(c, 4000) == doctest::Approx(pi * x * x * scattering).epsilon(1e-5));
            // The optical theorem.
            const MieElements forward = mie_elements(c, 1);
            CHECK(4 * forward.s11 >= doctest::Approx(std::pow(extinction * x * x / 2, 2)));
            if (m.imag() == 0)
                CHECK(scattering == doctest::Approx(extinction).epsilon(1e-8));
            else
                CHECK(scattering < 0.999 * extinction);
        }
    // Large ones take from light twice what meets them; black ones scatter half of that.
    const MieCoefficients large = mie_coefficients(1900, {1.33, -0.1});
    CHECK(extinction_efficiency(large, 1900) == doctest::Approx(2).epsilon(0.02));
    CHECK(scattering_efficiency(large, 1900) == doctest::Approx(1.05).epsilon(0.05));
}

TEST_CASE("small spheres scatter as Rayleigh says") {
    const double x = 0.01, m = 1.5, polarizability = (m * m - 1) / (m * m + 2);
    const MieCoefficients c = mie_coefficients(x, m);
    CHECK(extinction_efficiency(c, x) ==
          doctest::Approx(8.0 / 3 * std::pow(x, 4) * polarizability * polarizability).epsilon(1e-3));
    for (const double cosine : {1.0, 0.6, 0.0, -0.3, -1.0}) {
        const MieElements e = mie_elements(c, cosine);
        const double sum = 1 + cosine * cosine;
        CHECK(e.s11 ==
              doctest::Approx(std::pow(x, 6) * polarizability * polarizability * sum / 2).epsilon(1e-3));
        CHECK(e.b / e.s11 == doctest::Approx((1 - cosine * cosine) / sum).scale(1).epsilon(1e-4));
        CHECK(e.c / e.s11 == doctest::Approx(2 * cosine / sum).scale(1).epsilon(1e-4));
        CHECK(e.d / e.s11 == doctest::Approx(0).scale(1).epsilon(1e-4));
    }
}

TEST_CASE("tables of spheres: between nodes as computed there, and sampled as they are") {
    CHECK(table_error(water(1e-7, 0), 10) < 1e-3);
    CHECK(table_error(water(1e-6, 0.1), 10) < 2e-3);
    CHECK(table_error(water(5e-6, 0.05), 20) < 4e-2);
    for (const MieParameters& p :
         {water(2e-6, 0), water(3e-6, 0.02), water(2e-5, 0), water(1e-6, 0.3, 0.7)}) {
        const MieTable t = make_mie_table(p, 2);
        REQUIRE(t.values.size() == size_t(mie_wavelengths) * (2 * t.cells + 1));
        const MieTable again = make_mie_table(p, 1);
        CHECK(again.values == t.values);
        for (int w = 0; w < mie_wavelengths; ++w) {
            const float* sums = &t.sums[size_t(w) * (2 * t.cells + 1)];
            CHECK(sums[0] == 0);
            CHECK(sums[2 * t.cells] == doctest::Approx(1).epsilon(1e-6));
            CHECK(std::is_sorted(sums, sums + 2 * t.cells + 1));
            // No more polarization than light.
            for (uint32_t i = 0; i <= 2 * t.cells; ++i) {
                const glm::dvec4 e = t.values[size_t(w) * (2 * t.cells + 1) + i];
                CHECK(e.y * e.y + e.z * e.z + e.w * e.w <= e.x * e.x * (1 + 1e-6));
            }
        }
    }
}

TEST_CASE("the table's scale is that of the integral over all angles") {
    for (const MieParameters& p : {water(1e-7, 0), water(2e-6, 0), water(5e-6, 0.05), water(2e-5, 0.1)}) {
        CAPTURE(p.radius);
        // Straight on and at 60 degrees, against the scattering cross section, which no sum over angles
        // enters.
        const MieTable t = make_mie_table(p, 2);
        for (const double cosine : {1.0, 0.5})
            CHECK(tabulated(t, 20, cosine).s11 ==
                  doctest::Approx(direct_mie_elements(p, 560, cosine).s11).epsilon(0.01));
    }
}

TEST_CASE("what surrounds spheres makes them larger and fainter") {
    MieParameters p = water(1e-6, 0.1, 1.6);
    p.surrounding = constant_spectrum(1.33);
    const MieParameters q = water(1.33e-6, 0.1, 1.6 / 1.33);
    CHECK(largest_mie_size(p) == doctest::Approx(largest_mie_size(q)).epsilon(1e-6));
    CHECK(direct_mie_elements(p, 520, 0.3).s11 ==
          doctest::Approx(direct_mie_elements(q, 520, 0.3).s11).epsilon(1e-5));
}
