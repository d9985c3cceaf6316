// Fresnel's equations at an interface between two media, for unpolarized light and (NAME_mueller) for all other.
//
// eta is always relative: the refractive index on the far side over that on the side where the ray is.
#include "lib/stokes.glsl"

// Reflected part at a dielectric; cos_o >= 0. 1 beyond the critical angle. With g = eta cos_t the amplitudes
//   r_s = (c - g) / (c + g),   r_p = (eta² c - g) / (eta² c + g)
// are written as quotients whose numerators hold the small factor eta² - 1, so that nearly matched media keep
// their digits and matched ones give 0.
vec2 fresnel_dielectric_parts(float cos_o, float eta) {  // of s and p
    float c = min(abs(cos_o), 1.0);
    float eta2 = eta * eta;
    float difference = (eta - 1.0) * (eta + 1.0);
    float g2 = difference + c * c;
    if (g2 <= 0.0) return vec2(difference < 0.0 ? 1.0 : 0.0);
    float g = sqrt(g2);
    float s = c + g, p = eta2 * c + g;
    float r_s = difference / (s * s);
    float r_p = difference * (c * c * (eta2 + 1.0) - 1.0) / (p * p);
    return vec2(r_s * r_s, r_p * r_p);
}
float fresnel_dielectric(float cos_o, float eta) {
    vec2 parts = fresnel_dielectric_parts(cos_o, eta);
    return min(0.5 * (parts.x + parts.y), 1.0);
}

// a² and b² of a - i b = sqrt((eta - i k)² - s2); each is taken from the form that does not cancel.
void conductor_root_squares(Spectrum eta, Spectrum k, float s2, out Spectrum a2, out Spectrum b2) {
    Spectrum t = (eta - k) * (eta + k) - s2;
    Spectrum q = 2.0 * eta * k;
    Spectrum a2_b2 = sqrt(t * t + q * q);
    Spectrum larger = 0.5 * (a2_b2 + abs(t));
    Spectrum smaller = 0.25 * q * q / max(larger, Spectrum(1e-30));
    a2 = mix(smaller, larger, greaterThan(t, Spectrum(0)));
    b2 = mix(larger, smaller, greaterThan(t, Spectrum(0)));
}

// Reflected part at an absorbing medium with relative index eta - i k (Born & Wolf 14.2), per channel.
Spectrum fresnel_conductor(float cos_o, Spectrum eta, Spectrum k) {
    float c = clamp(abs(cos_o), 0.0, 1.0);
    float c2 = c * c, s2 = (1.0 - c) * (1.0 + c);
    eta = min(eta, Spectrum(1e8)), k = min(k, Spectrum(1e8));  // squares of squares stay finite
    Spectrum a2, b2;
    conductor_root_squares(eta, k, s2, a2, b2);
    Spectrum a = sqrt(a2);
    Spectrum minus = a - c, plus = a + c;
    Spectrum r_s = (minus * minus + b2) / max(plus * plus + b2, Spectrum(1e-30));
    minus = a * c - s2, plus = a * c + s2;
    Spectrum r_p_over_r_s = (minus * minus + b2 * c2) / max(plus * plus + b2 * c2, Spectrum(1e-30));
    return min(0.5 * r_s * (1.0 + r_p_over_r_s), Spectrum(1));
}

// Of the two amplitudes, real ones or their ratio p : s, complex where light is reflected by metals or totally.
Mueller amplitudes_mueller(vec3 axis, float s, float p) {
    float inverse = 1.0 / max(s * s + p * p, 1e-30);
    return phase_plate(axis, Spectrum((s * s - p * p) * inverse), Spectrum(2.0 * s * p * inverse), Spectrum(0));
}
Mueller ratio_mueller(vec3 axis, Spectrum re, Spectrum im) {
    Spectrum inverse = 1.0 / (1.0 + re * re + im * im);
    return phase_plate(axis, (1.0 - re * re - im * im) * inverse, 2.0 * re * inverse, 2.0 * im * inverse);
}

// cos_o >= 0 on the side that eta is seen from; `axis`: across the plane of incidence.
Mueller fresnel_dielectric_mueller(vec3 axis, float cos_o, float eta, bool reflects) {
    float c = clamp(cos_o, 1e-7, 1.0);
    float eta2 = eta * eta;
    float difference = (eta - 1.0) * (eta + 1.0);
    float g2 = difference + c * c;
    if (g2 <= 0.0) {  // total reflection: p is ahead of s by twice the angle of tangent t
        float g = sqrt(-g2);
        float t = -g * c * difference / (eta2 * c * c - g2);
        float inverse = 1.0 / (1.0 + t * t);
        return phase_plate(axis, Spectrum(0), Spectrum((1.0 - t * t) * inverse), Spectrum(2.0 * t * inverse));
    }
    float g = sqrt(g2);
    float s = c + g, p = eta2 * c + g;
    if (!reflects) return amplitudes_mueller(axis, p, eta * s);  // 2 c / s and 2 eta c / p
    // Both over eta² - 1: what is left of them between media that match.
    return amplitudes_mueller(axis, -p * p, (c * c * (eta2 + 1.0) - 1.0) * s * s);
}

// With q = sqrt((eta - i k)² - sin²) = a - i b: r_p / r_s = (sin² - q cos) / (sin² + q cos).
Mueller fresnel_conductor_mueller(vec3 axis, float cos_o, Spectrum eta, Spectrum k) {
    float c = clamp(cos_o, 0.0, 1.0);
    float s2 = (1.0 - c) * (1.0 + c);
    eta = min(eta, Spectrum(1e8)), k = min(k, Spectrum(1e8));
    Spectrum a, b;
    conductor_root_squares(eta, k, s2, a, b);
    a = sqrt(a) * c, b = sqrt(b) * c;
    Spectrum inverse = 1.0 / max((s2 + a) * (s2 + a) + b * b, Spectrum(1e-30));
    return ratio_mueller(axis, (s2 * s2 - a * a - b * b) * inverse, 2.0 * s2 * b * inverse);
}

// Schlick 1994's approximation is f0 + (1 - f0) times this.
float schlick_weight(float cos_o) {
    float m = clamp(1.0 - cos_o, 0.0, 1.0);
    return square(square(m)) * m;
}

// Refracts wo at a facet with normal h on its side, cos_o = dot(wo, h) >= 0. Both directions point away from
// the facet. False beyond the critical angle.
bool refract_direction(vec3 wo, vec3 h, float cos_o, float eta, out vec3 wi) {
    float inv_eta = 1.0 / eta;
    vec3 tangential = (cos_o * h - wo) * inv_eta;  // the part of wi along the facet
    float sin2 = dot(tangential, tangential);
    wi = tangential - sqrt(max(0.0, 1.0 - sin2)) * h;
    return sin2 < 1.0;
}
