// Separates two media and nothing else: light passes straight on, whatever the media's refractive indices.
//
// Example:
//     {"materials": [{"name": "border of the mist", "extensions": {"ETD_optics": {
//         "surface": {"class": "boundary"}, "inside": "mist"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "mist", "class": "homogeneous", "scattering": [1.5, 2, 3]}]}}}
struct Boundary {
    uint unused;  // a record holds at least one member
};

Boundary boundary_resolve(Boundary r, SurfaceContext c) { return r; }

SurfacePair boundary_evaluate(Boundary r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }

BsdfSample boundary_sample(Boundary r, SurfaceContext c, vec3 wo, vec3 u) {
    return BsdfSample(-wo, Spectrum(1), 1.0, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT);
}

Spectrum boundary_transparency(Boundary r, SurfaceContext c, vec3 wo) { return Spectrum(1); }
bool boundary_is_delta(Boundary r, SurfaceContext c) { return true; }
bool boundary_is_opaque(Boundary r, SurfaceContext c) { return false; }
