// The twin of shaders/view/tone_curves.glsl in double precision.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "host/preview/view_transform.h"

namespace etendue {

inline double srgb_encoded(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

inline glm::dvec3 agx_encoded(const glm::dvec3& color) {
    const double inset[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                {0.0423756549057051, 0.0784336, 0.879142973793104}};
    const double outset[3][3] = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                 {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                 {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
    double curve[3];
    glm::dvec3 result;
    for (int r = 0; r < 3; ++r) {
        const double v = inset[r][0] * color.x + inset[r][1] * color.y + inset[r][2] * color.z;
        const double x =
            std::clamp((std::log2(std::max(v, 1e-10)) + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0);
        curve[r] = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) -
                   6.868 * std::pow(x, 3) + 0.4298 * x * x + 0.1191 * x - 0.00232;
    }
    for (int r = 0; r < 3; ++r)
        result[r] =
            std::clamp(outset[r][0] * curve[0] + outset[r][1] * curve[1] + outset[r][2] * curve[2], 0.0, 1.0);
    return result;
}

inline glm::dvec3 turbo_color(double x) {
    const double c[3][6] = {{0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943},
                            {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
                            {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973}};
    glm::dvec3 result(0);
    for (int r = 0; r < 3; ++r) {
        for (int i = 0; i < 6; ++i) result[r] += c[r][i] * std::pow(x, i);
        result[r] = std::clamp(result[r], 0.0, 1.0);
    }
    return result;
}

// What the screen shows, in [0, 1].
inline glm::dvec3 shown_color(const ViewSettings& s, const glm::dvec3& radiance) {
    if (!std::isfinite(radiance.x + radiance.y + radiance.z)) return {1, 0, 1};
    if (s.curve == ToneCurve::false_colors) {
        const double y = 0.2126 * radiance.x + 0.7152 * radiance.y + 0.0722 * radiance.z;
        if (!(y > 0)) return glm::dvec3(0);
        return turbo_color(std::clamp(std::log(y / s.lowest) / std::log(s.highest / s.lowest), 0.0, 1.0));
    }
    glm::dvec3 color = std::exp2(s.exposure) * radiance;
    if (s.temperature) color = white_balance(*s.temperature) * color;
    color = glm::max(color, glm::dvec3(0));
    if (s.curve == ToneCurve::agx) return agx_encoded(color);
    for (int c = 0; c < 3; ++c) {
        double& x = color[c];
        if (s.curve == ToneCurve::aces) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
        x = s.curve == ToneCurve::linear ? std::clamp(x, 0.0, 1.0) : srgb_encoded(x);
    }
    return color;
}

}  // namespace etendue
