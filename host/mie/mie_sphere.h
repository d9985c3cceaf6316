// Light that one sphere scatters: Lorenz-Mie theory (Bohren & Huffman 1983, "Absorption and Scattering of
// Light by Small Particles", chapter 4; number of terms and recurrences: Wiscombe 1980, "Improved Mie
// scattering algorithms"). In double precision.
//
// Waves are exp(+iωt), as everywhere here (shaders/lib/stokes.glsl): an index is n - ik. Bohren & Huffman
// have exp(-iωt) and n + ik, so their amplitudes are the complex conjugates of these.
#pragma once
#include <complex>
#include <vector>

namespace etendue {

// Of partial waves n = 1, 2, …: those of an electric (a) and of a magnetic multipole (b).
struct MieCoefficients {
    std::vector<std::complex<double>> a, b;
};

// `x`: size parameter, 2π radius n / λ with n of what surrounds the sphere, above 0. `m`: index of the sphere
// over that one; imaginary part not above 0.
MieCoefficients mie_coefficients(double x, std::complex<double> m);

// Over π radius².
double extinction_efficiency(const MieCoefficients& c, double x);
double scattering_efficiency(const MieCoefficients& c, double x);

// The scattering matrix at one angle, as struct Mueller of shaders/lib/stokes.glsl has it, times s11: x is
// across the plane of both directions. Bohren & Huffman's S12, S33 and S34 are -b, c and -d: their Q counts
// light along the plane, and their S34 = Im(S2 conj(S1)) belongs to exp(-iωt).
struct MieElements {
    double s11 = 0, b = 0, c = 0, d = 0;
    MieElements& operator+=(const MieElements& e) {
        s11 += e.s11, b += e.b, c += e.c, d += e.d;
        return *this;
    }
    MieElements operator*(double f) const { return {s11 * f, b * f, c * f, d * f}; }
};

// S1 + S2 and S1 - S2, amplitudes across and along the plane: all that the elements are made of.
MieElements elements_of(std::complex<double> sum, std::complex<double> difference);

// For light that is turned by an angle of that cosine. s11 integrates over the sphere to π x² times the
// scattering efficiency.
MieElements mie_elements(const MieCoefficients& c, double cosine);

}  // namespace etendue
