// A perfectly diffuse reflector: the same radiance in every direction (Lambert 1760). Both sides reflect.
//
// Example:
//     {"materials": [{"name": "red clay", "extensions": {"ETD_optics": {
//         "surface": {"class": "lambertian", "reflectance": [0.6, 0.11, 0.07]}}}}]}
struct Lambertian {
    SpectrumRef reflectance;         //: 0.5 in [0, 1]. Reflected part of the incident flux.
    TextureRef reflectance_texture;  //: none. Multiplies the reflectance.
};

Lambertian lambertian_resolve(Lambertian r, SurfaceContext c) {
    scale_spectrum(r.reflectance, texture_value(r.reflectance_texture, c.uv0, c.uv1).rgb);
    return r;
}

SurfacePair lambertian_evaluate(Lambertian r, SurfaceContext c, vec3 wo, vec3 wi) {
    if (!(wo.z * wi.z > 0.0)) return no_surface_pair();
    float pdf = INV_PI * abs(wi.z);
    return SurfacePair(spectrum_value(r.reflectance) * pdf, pdf, INV_PI * abs(wo.z));
}

BsdfSample lambertian_sample(Lambertian r, SurfaceContext c, vec3 wo, vec3 u) {
    vec3 wi = warp_cosine_hemisphere(u.xy);
    if (wo.z < 0.0) wi.z = -wi.z;
    return scattered(wi, EVENT_REFLECT);
}

Spectrum lambertian_transparency(Lambertian r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool lambertian_is_delta(Lambertian r, SurfaceContext c) { return false; }
bool lambertian_is_opaque(Lambertian r, SurfaceContext c) { return true; }
