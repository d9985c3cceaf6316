// Particles much smaller than the wavelength (Rayleigh 1871): 3 (1 + cos²) / (16 pi). Light scattered sideways is polarized.
//
// Example:
//     {"extensions": {"ETD_optics": {"media": [
//         {"name": "fog", "class": "homogeneous", "scattering": 0.4, "phase": {"class": "rayleigh"}}]}}}
struct Rayleigh {
    uint unused;  // a record holds at least one member
};

Spectrum rayleigh_value(Rayleigh r, float cosine) { return Spectrum((3.0 / 16.0 * INV_PI) * (1.0 + cosine * cosine)); }

// The cosine c with (c³ + 3 c + 4) / 8 = u, by Cardano's formula (Frisvad 2011, "Importance sampling the Rayleigh phase
// function"); the larger of the two roots first, so that no digits cancel.
float rayleigh_sample(Rayleigh r, float u) {
    float v = 4.0 * u - 2.0;
    float root = pow(abs(v) + sqrt(v * v + 1.0), 1.0 / 3.0);
    float cosine = root - 1.0 / root;
    return clamp(v < 0.0 ? -cosine : cosine, -1.0, 1.0);
}

// Chandrasekhar 1960, "Radiative Transfer", section 16, with x across the plane.
Mueller rayleigh_mueller(Rayleigh r, float cosine) {
    float inverse = 1.0 / (1.0 + cosine * cosine);
    return phase_plate(vec3(1, 0, 0), Spectrum((1.0 - cosine * cosine) * inverse), Spectrum(2.0 * cosine * inverse), Spectrum(0));
}
