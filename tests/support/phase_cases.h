// Phase functions as a scene names them, with their values in double precision.
#pragma once
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

namespace etendue {

struct PhaseCase {
    nlohmann::json record;
    std::function<double(double)> value;  // of the cosine of the angle of turning, 1/sr
};

inline PhaseCase isotropic_phase() {
    return {{{"class", "isotropic"}}, [](double) { return 1 / (4 * std::numbers::pi); }};
}

inline PhaseCase rayleigh_phase() {
    return {{{"class", "rayleigh"}}, [](double c) { return 3 / (16 * std::numbers::pi) * (1 + c * c); }};
}

// Henyey & Greenstein 1941, equation 2; g is the mean cosine.
inline PhaseCase lobe_phase(double g) {
    return {{{"class", "henyey_greenstein"}, {"g", g}}, [=](double c) {
                return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * c, 1.5));
            }};
}

}  // namespace etendue
