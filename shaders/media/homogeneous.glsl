// A medium that is the same everywhere: refractive index and absorption (Beer-Lambert).
struct Homogeneous {
    SpectrumRef ior;         //: 1 in [0.1, 100] ior. Real refractive index.
    SpectrumRef absorption;  //: 0 in [0, inf) 1/m. Absorption coefficient.
};

Spectrum homogeneous_ior(Homogeneous r) { return spectrum_value(r.ior); }

Spectrum homogeneous_transmittance(Homogeneous r, float distance) {
    return exp(-spectrum_value(r.absorption) * distance);
}

bool homogeneous_is_clear(Homogeneous r) { return is_black(spectrum_value(r.absorption)); }
