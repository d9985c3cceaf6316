// A perfectly diffuse reflector: the same radiance in every direction (Lambert 1760). Both sides reflect.
struct Lambertian {
    SpectrumRef reflectance;         //: 0.5 in [0, 1]. Reflected part of the incident flux.
    TextureRef reflectance_texture;  //: none. Multiplies the reflectance.
};

Lambertian lambertian_resolve(Lambertian r, SurfaceContext c) {
    scale_spectrum(r.reflectance, texture_value(r.reflectance_texture, c.uv0, c.uv1).rgb);
    return r;
}

Spectrum lambertian_eval(Lambertian r, SurfaceContext c, vec3 wo, vec3 wi) {
    return wo.z * wi.z > 0.0 ? spectrum_value(r.reflectance) * (INV_PI * abs(wi.z)) : Spectrum(0);
}

float lambertian_pdf(Lambertian r, SurfaceContext c, vec3 wo, vec3 wi) {
    return wo.z * wi.z > 0.0 ? INV_PI * abs(wi.z) : 0.0;
}

BsdfSample lambertian_sample(Lambertian r, SurfaceContext c, vec3 wo, vec3 u) {
    vec3 wi = warp_cosine_hemisphere(u.xy);
    float pdf = INV_PI * wi.z;
    if (pdf <= 0.0) return no_bsdf_sample();
    if (wo.z < 0.0) wi.z = -wi.z;
    return BsdfSample(wi, spectrum_value(r.reflectance), pdf, EVENT_REFLECT);
}

Spectrum lambertian_transparency(Lambertian r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool lambertian_is_delta(Lambertian r, SurfaceContext c) { return false; }
bool lambertian_is_opaque(Lambertian r, SurfaceContext c) { return true; }
