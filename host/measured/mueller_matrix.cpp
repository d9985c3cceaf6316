#include "host/measured/mueller_matrix.h"

#include <cmath>
#include <complex>

namespace etendue {
namespace {

using Complex = std::complex<double>;
using Hermitian = std::array<std::array<Complex, 4>, 4>;
constexpr double tolerance = 1e-6;  // of the first element: numbers in files are rounded

constexpr Complex one = 1, i = {0, 1};
const Complex pauli[4][2][2] = {
    {{one, 0}, {0, one}}, {{one, 0}, {0, -one}}, {{0, one}, {one, 0}}, {{0, -i}, {i, 0}}};

// Calls function(a, b, r, c, p): elements of the matrices p = pauli[a] x pauli[b]* that are not zero.
template <class Function>
void for_products(Function function) {
    const auto column = [](int matrix, int row) { return matrix < 2 ? row : 1 - row; };
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
            for (int row = 0; row < 4; ++row) {
                const int ra = row / 2, rb = row % 2, ca = column(a, ra), cb = column(b, rb);
                function(a, b, row, 2 * ca + cb, pauli[a][ra][ca] * std::conj(pauli[b][rb][cb]));
            }
}

// Its trace is the first element of m.
Hermitian coherency(const MuellerMatrix& m) {
    Hermitian h{};
    for_products([&](int a, int b, int r, int c, const Complex& p) { h[r][c] += 0.25 * m[4 * a + b] * p; });
    return h;
}

MuellerMatrix mueller_of(const Hermitian& h) {
    MuellerMatrix m{};
    for_products([&](int a, int b, int r, int c, const Complex& p) {
        m[4 * a + b] += (h[r][c] * std::conj(p)).real();
    });
    return m;
}

// Has h no eigenvalue below -tolerance times its trace? By Cholesky's decomposition.
bool is_positive(Hermitian h, double trace) {
    for (int k = 0; k < 4; ++k) h[k][k] += tolerance * trace;
    for (int k = 0; k < 4; ++k) {
        const double pivot = h[k][k].real();
        if (!(pivot > 0)) return false;
        for (int r = k + 1; r < 4; ++r)
            for (int c = k + 1; c < 4; ++c) h[r][c] -= h[r][k] * std::conj(h[c][k]) / pivot;
    }
    return true;
}

// Jacobi's rotations: h becomes diagonal, the columns of the result are the eigenvectors.
Hermitian diagonalize(Hermitian& h) {
    Hermitian vectors{};
    for (int k = 0; k < 4; ++k) vectors[k][k] = 1;
    const double least = 1e-14 * (h[0][0] + h[1][1] + h[2][2] + h[3][3]).real();
    constexpr int most_sweeps = 16;
    bool is_diagonal = false;
    for (int sweep = 0; sweep < most_sweeps && !is_diagonal; ++sweep) {
        is_diagonal = true;
        for (int p = 0; p < 4; ++p)
            for (int q = p + 1; q < 4; ++q) {
                const double size = std::abs(h[p][q]);
                if (size <= least) continue;
                is_diagonal = false;
                const double tau = (h[q][q] - h[p][p]).real() / (2 * size);
                const double t = (tau < 0 ? -1 : 1) / (std::abs(tau) + std::hypot(1, tau));
                const double c = 1 / std::hypot(1, t);
                const Complex phase = h[p][q] / size;
                const auto turn = [&](Complex& x, Complex& y, const Complex& f) {
                    const Complex old = x;
                    x = c * (old - t * f * y), y = c * (t * old + f * y);
                };
                for (int k = 0; k < 4; ++k) {
                    turn(h[k][p], h[k][q], std::conj(phase));
                    turn(vectors[k][p], vectors[k][q], std::conj(phase));
                }
                for (int k = 0; k < 4; ++k) turn(h[p][k], h[q][k], phase);
            }
    }
    return vectors;
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
    return is_positive(coherency(m), m[0]) ? "" : "it makes more polarization than there is light";
}

MuellerMatrix without_excess(const MuellerMatrix& m) {
    Hermitian h = coherency(m);
    if (!(m[0] > 0)) return {};
    if (is_positive(h, m[0])) return m;
    const Hermitian vectors = diagonalize(h);
    Hermitian kept{};
    double trace = 0;
    for (int k = 0; k < 4; ++k) {
        const double value = h[k][k].real();
        if (!(value > 0)) continue;
        trace += value;
        for (int r = 0; r < 4; ++r)
            for (int c = 0; c < 4; ++c) kept[r][c] += value * vectors[r][k] * std::conj(vectors[c][k]);
    }
    MuellerMatrix result = mueller_of(kept);
    for (double& x : result) x *= m[0] / trace;
    return result;
}

}  // namespace etendue
