// From radiance to what a screen shows: white balance, exposure, a tone curve or false colours. One function,
// view_color; tests/preview/tone_curves_test.cpp has its twin in double precision.
const uint CURVE_LINEAR = 0u;  // none: values are shown as they are, which screens darken
const uint CURVE_SRGB = 1u;    // IEC 61966-2-1, clipped
const uint CURVE_ACES = 2u;    // Narkowicz 2015, "ACES Filmic Tone Mapping Curve", then sRGB
const uint CURVE_AGX = 3u;     // Sobotka's AgX, as Wrensch 2023 fits it ("Minimal AgX Implementation")
const uint CURVE_FALSE = 4u;   // luminance in false colours, on a logarithmic scale

struct ViewTransform {
    mat3 white_balance;      // linear Rec.709 to linear Rec.709
    float exposure;          // factor
    uint curve;
    float lowest, highest;   // cd/m², ends of the false colours; 0 < lowest < highest
};

vec3 encode_srgb(vec3 linear) {
    vec3 x = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 aces_curve(vec3 x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

// Inset, logarithm from 2^-12.47393 to 2^4.026069, sigmoid as a polynomial, outset. The result is encoded for the screen.
vec3 agx_curve(vec3 linear) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772,
                            0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417,
                             -0.0980434501171241, -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float low = -12.47393, high = 4.026069;
    vec3 x = clamp((log2(max(inset * linear, vec3(1e-10))) - low) / (high - low), 0.0, 1.0);
    vec3 y = -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    return clamp(outset * y, 0.0, 1.0);
}

// Turbo by its polynomial (Mikhailov & Ruiz Ivanov 2019): x in [0, 1] from dark blue to dark red.
vec3 turbo(float x) {
    const vec3 c0 = vec3(0.13572138, 0.09140261, 0.10667330), c1 = vec3(4.61539260, 2.19418839, 12.64194608),
               c2 = vec3(-42.66032258, 4.84296658, -60.58204836), c3 = vec3(132.13108234, -14.18503333, 110.36276771),
               c4 = vec3(-152.94239396, 4.27729857, -89.90310912), c5 = vec3(59.28637943, 2.82956604, 27.34824973);
    return clamp(c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5)))), 0.0, 1.0);
}

// What a screen is sent, in [0, 1]. Radiance that is not finite shows as magenta.
vec3 view_color(ViewTransform view, vec3 radiance) {
    if (!all(lessThan(abs(radiance), vec3(3e38)))) return vec3(1, 0, 1);
    if (view.curve == CURVE_FALSE) {
        float y = dot(radiance, vec3(0.2126, 0.7152, 0.0722));  // BT.709: luminance
        if (!(y > 0.0)) return vec3(0);
        return turbo(clamp(log2(y / view.lowest) / log2(view.highest / view.lowest), 0.0, 1.0));
    }
    vec3 color = max(view.white_balance * radiance * view.exposure, vec3(0));
    if (view.curve == CURVE_AGX) return agx_curve(color);
    if (view.curve == CURVE_LINEAR) return clamp(color, 0.0, 1.0);
    return encode_srgb(view.curve == CURVE_ACES ? aces_curve(color) : color);
}
