// A sheet that scatters light evenly, part of it back and part of it through: paper, leaves, milk glass. Both sides alike.
//
// Where the media on its sides differ, what comes from the denser side leaves with 1 / n² of the transmittance, and the
// rest is reflected: radiance over squared index is kept, both ways (Veach 1997, section 5.2).
//
// Example:
//     {"materials": [{"name": "paper lantern", "extensions": {"ETD_optics": {
//         "surface": {"class": "diffuse_transmitter", "reflectance": [0.55, 0.5, 0.4], "transmittance": [0.4, 0.3, 0.15]}}}}],
//      "nodes": [{"name": "bulb", "translation": [0, 0.45, 0], "extensions": {"ETD_optics": {
//         "light": {"class": "point", "intensity": 0.2}}}}]}
struct DiffuseTransmitter {
    SpectrumRef reflectance;           //: 0.5 in [0, 1]. Reflected part. With transmittance at most 1, or both are scaled.
    SpectrumRef transmittance;         //: 0.5 in [0, 1]. Part of the flux that goes through, from the less dense side.
    TextureRef reflectance_texture;    //: none. Multiplies reflectance.
    TextureRef transmittance_texture;  //: none. Multiplies transmittance.
};

DiffuseTransmitter diffuse_transmitter_resolve(DiffuseTransmitter r, SurfaceContext c) {
    scale_spectrum(r.reflectance, texture_value(r.reflectance_texture, c.uv0, c.uv1).rgb);
    scale_spectrum(r.transmittance, texture_value(r.transmittance_texture, c.uv0, c.uv1).rgb);
    return r;
}

// Index on the far side over that on the side of w.
float diffuse_transmitter_eta(SurfaceContext c, vec3 w) {
    return w.z < 0.0 ? c.ior_above / c.ior_below : c.ior_below / c.ior_above;
}

// Parts of the flux.
void diffuse_transmitter_parts(DiffuseTransmitter r, float eta, out Spectrum reflected, out Spectrum transmitted) {
    reflected = spectrum_value(r.reflectance), transmitted = spectrum_value(r.transmittance);
    Spectrum scale = 1.0 / max(reflected + transmitted, Spectrum(1));
    float passes = min(eta * eta, 1.0);
    reflected = (reflected + (1.0 - passes) * transmitted) * scale;
    transmitted *= passes * scale;
}

float diffuse_transmitter_through(Spectrum reflected, Spectrum transmitted) {
    float r = brightness(reflected), t = brightness(transmitted);
    return r + t > 0.0 ? t / (r + t) : 0.5;
}

// Density of scattering to the other side, or to the same, with |cos| to the normal.
float diffuse_transmitter_density(DiffuseTransmitter r, float eta, bool passes, float cosine) {
    Spectrum reflected, transmitted;
    diffuse_transmitter_parts(r, eta, reflected, transmitted);
    float through = diffuse_transmitter_through(reflected, transmitted);
    return INV_PI * cosine * (passes ? through : 1.0 - through);
}

SurfacePair diffuse_transmitter_evaluate(DiffuseTransmitter r, SurfaceContext c, vec3 wo, vec3 wi) {
    float eta = diffuse_transmitter_eta(c, wo);
    bool passes = wo.z * wi.z < 0.0;
    Spectrum reflected, transmitted;
    diffuse_transmitter_parts(r, eta, reflected, transmitted);
    if (!c.importance) transmitted /= eta * eta;
    return SurfacePair((passes ? transmitted : reflected) * (INV_PI * abs(wi.z)),
                       diffuse_transmitter_density(r, eta, passes, abs(wi.z)),
                       diffuse_transmitter_density(r, passes ? 1.0 / eta : eta, passes, abs(wo.z)));
}

BsdfSample diffuse_transmitter_sample(DiffuseTransmitter r, SurfaceContext c, vec3 wo, vec3 u) {
    Spectrum reflected, transmitted;
    diffuse_transmitter_parts(r, diffuse_transmitter_eta(c, wo), reflected, transmitted);
    bool passes = u.z < diffuse_transmitter_through(reflected, transmitted);
    vec3 wi = warp_cosine_hemisphere(u.xy);
    if ((wo.z < 0.0) != passes) wi.z = -wi.z;
    return scattered(wi, passes ? EVENT_TRANSMIT : EVENT_REFLECT);
}

Spectrum diffuse_transmitter_transparency(DiffuseTransmitter r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool diffuse_transmitter_is_delta(DiffuseTransmitter r, SurfaceContext c) { return false; }
bool diffuse_transmitter_is_opaque(DiffuseTransmitter r, SurfaceContext c) { return true; }
