#include "host/scene/mueller_matrix.h"

#include <cmath>
#include <complex>

namespace etendue {
namespace {

using Complex = std::complex<double>;
constexpr double tolerance = 1e-6;  // of the first element: numbers in files are rounded

constexpr Complex one = 1, i = {0, 1};
const Complex pauli[4][2][2] = {
    {{one, 0}, {0, one}}, {{one, 0}, {0, -one}}, {{0, one}, {one, 0}}, {{0, -i}, {i, 0}}};

// Has a Hermitian matrix no negative eigenvalue? By Cholesky's decomposition.
bool is_positive(std::array<std::array<Complex, 4>, 4> h) {
    for (int k = 0; k < 4; ++k) {
        const double pivot = h[k][k].real();
        if (!(pivot > 0)) return false;
        for (int r = k + 1; r < 4; ++r)
            for (int c = k + 1; c < 4; ++c) h[r][c] -= h[r][k] * std::conj(h[c][k]) / pivot;
    }
    return true;
}

}  // namespace

std::string flaw_of(const MuellerMatrix& m) {
    if (!(m[0] >= 0)) return "its first number is negative";
    if (m[0] == 0)
        for (double number : m)
            if (number != 0) return "its first number is 0 and others are not";
    if (m[0] == 0) return "";
    for (const double most : {m[0] + std::hypot(m[1], m[2], m[3]), m[0] + std::hypot(m[4], m[8], m[12])})
        if (most > 1 + tolerance) return "it lets through more of some light than there is";
    std::array<std::array<Complex, 4>, 4> h{};
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < 4; ++b)
                    h[r][c] +=
                        0.25 * m[4 * a + b] * pauli[a][r / 2][c / 2] * std::conj(pauli[b][r % 2][c % 2]);
    for (int k = 0; k < 4; ++k) h[k][k] += tolerance * m[0];
    return is_positive(h) ? "" : "it makes more polarization than there is light";
}

}  // namespace etendue
