// Polynomials of u and v in [0, 1] in Bernstein's form: values lie among the coefficients' (Farouki 2012,
// "The Bernstein polynomial basis: A centennial retrospective").
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace etendue {

inline double binomial(int n, int k) {
    double value = 1;
    for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
    return value;
}

template <class T>
struct Bernstein {
    int degree_u = 0, degree_v = 0;
    std::vector<T> coefficients;  // u running fastest

    Bernstein(int u, int v) : degree_u(u), degree_v(v), coefficients(size_t((u + 1) * (v + 1)), T(0)) {}
    T& at(int i, int j) { return coefficients[size_t(j * (degree_u + 1) + i)]; }
    const T& at(int i, int j) const { return coefficients[size_t(j * (degree_u + 1) + i)]; }
};

template <class T>
Bernstein<T> derivative_u(const Bernstein<T>& p) {
    Bernstein<T> result(p.degree_u - 1, p.degree_v);
    for (int j = 0; j <= p.degree_v; ++j)
        for (int i = 0; i < p.degree_u; ++i)
            result.at(i, j) = double(p.degree_u) * (p.at(i + 1, j) - p.at(i, j));
    return result;
}

template <class T>
Bernstein<T> derivative_v(const Bernstein<T>& p) {
    Bernstein<T> result(p.degree_u, p.degree_v - 1);
    for (int j = 0; j < p.degree_v; ++j)
        for (int i = 0; i <= p.degree_u; ++i)
            result.at(i, j) = double(p.degree_v) * (p.at(i, j + 1) - p.at(i, j));
    return result;
}

// a * b - scale * c * d, the products having the same degrees.
template <class T>
Bernstein<T> product_difference(const Bernstein<T>& a, const Bernstein<double>& b, const Bernstein<T>& c,
                                const Bernstein<double>& d, double scale = 1) {
    Bernstein<T> result(a.degree_u + b.degree_u, a.degree_v + b.degree_v);
    const auto add = [&](const Bernstein<T>& p, const Bernstein<double>& q, double factor) {
        for (int j = 0; j <= p.degree_v; ++j)
            for (int i = 0; i <= p.degree_u; ++i) {
                const T x = factor * binomial(p.degree_u, i) * binomial(p.degree_v, j) * p.at(i, j);
                for (int l = 0; l <= q.degree_v; ++l)
                    for (int k = 0; k <= q.degree_u; ++k)
                        result.at(i + k, j + l) +=
                            (binomial(q.degree_u, k) * binomial(q.degree_v, l) * q.at(k, l)) * x;
            }
    };
    add(a, b, 1), add(c, d, -scale);
    for (int j = 0; j <= result.degree_v; ++j)
        for (int i = 0; i <= result.degree_u; ++i)
            result.at(i, j) /= binomial(result.degree_u, i) * binomial(result.degree_v, j);
    return result;
}

}  // namespace etendue
