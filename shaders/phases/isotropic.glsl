// Scatters equally into all directions.
//
// Example:
//     {"extensions": {"ETD_optics": {"media": [
//         {"name": "fog", "class": "homogeneous", "scattering": 0.4, "phase": {"class": "isotropic"}}]}}}
struct Isotropic {
    uint unused;  // a record holds at least one member
};

Spectrum isotropic_value(Isotropic r, float cosine) { return Spectrum(0.25 * INV_PI); }
float isotropic_sample(Isotropic r, float u) { return 1.0 - 2.0 * u; }
