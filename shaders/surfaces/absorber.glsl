// Absorbs all light that reaches it, on both sides.
//
// Example:
//     {"materials": [{"name": "black hole", "extensions": {"ETD_optics": {
//         "surface": {"class": "absorber"}}}}]}
struct Absorber {
    uint unused;  // a record holds at least one member
};

Absorber absorber_resolve(Absorber r, SurfaceContext c) { return r; }

SurfacePair absorber_evaluate(Absorber r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }
BsdfSample absorber_sample(Absorber r, SurfaceContext c, vec3 wo, vec3 u) { return no_bsdf_sample(); }
Spectrum absorber_transparency(Absorber r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool absorber_is_delta(Absorber r, SurfaceContext c) { return true; }
bool absorber_is_opaque(Absorber r, SurfaceContext c) { return true; }
