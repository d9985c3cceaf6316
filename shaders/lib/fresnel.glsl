// Fresnel's equations for unpolarized light at an interface between two media.
//
// eta is always relative: the refractive index on the far side over that on the side where the ray is.

// Reflected part at a dielectric; cos_o >= 0. 1 beyond the critical angle. With g = eta cos_t the amplitudes
//   r_s = (c - g) / (c + g),   r_p = (eta² c - g) / (eta² c + g)
// are written as quotients whose numerators hold the small factor eta² - 1, so that nearly matched media keep
// their digits and matched ones give 0.
float fresnel_dielectric(float cos_o, float eta) {
    float c = min(abs(cos_o), 1.0);
    float eta2 = eta * eta;
    float difference = (eta - 1.0) * (eta + 1.0);
    float g2 = difference + c * c;
    if (g2 <= 0.0) return difference < 0.0 ? 1.0 : 0.0;
    float g = sqrt(g2);
    float s = c + g, p = eta2 * c + g;
    float r_s = difference / (s * s);
    float r_p = difference * (c * c * (eta2 + 1.0) - 1.0) / (p * p);
    return min(0.5 * (r_s * r_s + r_p * r_p), 1.0);
}

// Reflected part at an absorbing medium with relative index eta - i k (Born & Wolf 14.2), per channel. a + i
// b is sqrt((eta - i k)² - sin²); each of a² and b² is taken from the form that does not cancel.
Spectrum fresnel_conductor(float cos_o, Spectrum eta, Spectrum k) {
    float c = clamp(abs(cos_o), 0.0, 1.0);
    float c2 = c * c, s2 = (1.0 - c) * (1.0 + c);
    eta = min(eta, Spectrum(1e8)), k = min(k, Spectrum(1e8));  // squares of squares stay finite
    Spectrum t = (eta - k) * (eta + k) - s2;
    Spectrum q = 2.0 * eta * k;
    Spectrum a2_b2 = sqrt(t * t + q * q);
    Spectrum larger = 0.5 * (a2_b2 + abs(t));
    Spectrum smaller = 0.25 * q * q / max(larger, Spectrum(1e-30));
    Spectrum a2 = mix(smaller, larger, greaterThan(t, Spectrum(0)));
    Spectrum b2 = mix(larger, smaller, greaterThan(t, Spectrum(0)));
    Spectrum a = sqrt(a2);
    Spectrum minus = a - c, plus = a + c;
    Spectrum r_s = (minus * minus + b2) / max(plus * plus + b2, Spectrum(1e-30));
    minus = a * c - s2, plus = a * c + s2;
    Spectrum r_p_over_r_s = (minus * minus + b2 * c2) / max(plus * plus + b2 * c2, Spectrum(1e-30));
    return min(0.5 * r_s * (1.0 + r_p_over_r_s), Spectrum(1));
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
