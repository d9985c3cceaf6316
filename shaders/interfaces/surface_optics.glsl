// SurfaceOptics: how a surface scatters light. Directions are unit vectors in the local shading frame, both pointing
// away from the surface; +z is the shading normal, on the side of the geometric normal. A class NAME defines, for
// its record R:
//
//   R          NAME_resolve(R r, SurfaceContext c)                  the record at this point: textures applied. The functions
//                                                                   below but the last see resolved records only
//   Spectrum   NAME_eval(R r, SurfaceContext c, vec3 wo, vec3 wi)    f * |cos wi|, 1/sr, without delta parts
//   float      NAME_pdf(R r, SurfaceContext c, vec3 wo, vec3 wi)     of `sample` choosing wi given wo, 1/sr, without delta parts
//   BsdfSample NAME_sample(R r, SurfaceContext c, vec3 wo, vec3 u)   wi with weight f * |cos wi| / pdf
//   Spectrum   NAME_transparency(R r, SurfaceContext c, vec3 wo)     part that passes straight on, unscattered
//   bool       NAME_is_delta(R r, SurfaceContext c)                  eval is zero for every pair of directions; may say
//                                                                   false where only a texture makes it so
//   bool       NAME_is_opaque(R r, SurfaceContext c)                 transparency is zero in every direction, whatever the
//                                                                   textures and colors
//
// wo is the direction where the path comes from, wi where it goes. c.importance tells the transport direction: false
// carries radiance (backward rays: transmission scales by (ior on the side of wo / ior on the side of wi)², Veach 1997 eq. 5.12), true carries power.
// Corrections for shading normals are made by the callers (lib/scattering.glsl), once for all classes.
#include "lib/constants.glsl"
#include "lib/spectrum.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"
#include "lib/textures.glsl"

struct SurfaceContext {
    vec2 uv0, uv1;          // texture coordinates
    vec4 color;             // vertex color, linear
    float ior_above;        // real refractive index of the medium on the side of +z
    float ior_below;
    bool importance;
};

const uint EVENT_NONE = 0u;      // absorbed
const uint EVENT_REFLECT = 1u;
const uint EVENT_TRANSMIT = 2u;
const uint EVENT_DELTA = 4u;     // pdf is the probability of the discrete direction, not a density
const uint EVENT_STRAIGHT = 8u;  // passes on unscattered (the part that `transparency` gives); implies DELTA | TRANSMIT

struct BsdfSample {
    vec3 wi;
    Spectrum weight;
    float pdf;
    uint event;
};

BsdfSample no_bsdf_sample() { return BsdfSample(vec3(0, 0, 1), Spectrum(0), 0.0, EVENT_NONE); }

#include "generated/surface_classes.glsl"

Spectrum surface_eval(uint ref, SurfaceContext c, vec3 wo, vec3 wi) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_eval(name##_resolve(name##_record(record_index(ref)), c), c, wo, wi); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float surface_pdf(uint ref, SurfaceContext c, vec3 wo, vec3 wi) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_pdf(name##_resolve(name##_record(record_index(ref)), c), c, wo, wi); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

BsdfSample surface_sample(uint ref, SurfaceContext c, vec3 wo, vec3 u) {
    BsdfSample result = no_bsdf_sample();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_sample(name##_resolve(name##_record(record_index(ref)), c), c, wo, u); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// Scattering between two directions: eval, pdf, and the pdf of the way back. The class is visited and its textures are read once.
struct SurfacePair {
    Spectrum value;
    float pdf;          // of wi given wo
    float pdf_reverse;  // of wo given wi
};

#define PAIR_CASE(tag, Struct, name)                                            \
    case tag: {                                                                \
        Struct r = name##_resolve(name##_record(record_index(ref)), c);        \
        result.value = name##_eval(r, c, wo, wi);                              \
        result.pdf = name##_pdf(r, c, wo, wi);                                 \
        result.pdf_reverse = name##_pdf(r, c, wi, wo);                         \
        break;                                                                 \
    }
SurfacePair surface_pair(uint ref, SurfaceContext c, vec3 wo, vec3 wi) {
    SurfacePair result = SurfacePair(Spectrum(0), 0.0, 0.0);
    switch (record_tag(ref)) { SURFACE_CLASSES(PAIR_CASE) }
    return result;
}
// Of a surface of any class, in a kernel for one class too.
#ifdef ONLY_SURFACE_CLASS
SurfacePair surface_pair_of_any(uint ref, SurfaceContext c, vec3 wo, vec3 wi) {
    SurfacePair result = SurfacePair(Spectrum(0), 0.0, 0.0);
    switch (record_tag(ref)) { ALL_SURFACE_CLASSES(PAIR_CASE) }
    return result;
}
#else
#define surface_pair_of_any surface_pair
#endif
#undef PAIR_CASE

// All of an event at once: scattering towards wi, and a sample. The pdfs of the way back only where paths need them.
struct SurfaceEvent {
    SurfacePair pair;
    BsdfSample next;
    float next_pdf_reverse;
};
#if BIDIRECTIONAL
#define IF_BIDIRECTIONAL(x) x
#else
#define IF_BIDIRECTIONAL(x)
#endif

SurfaceEvent surface_event(uint ref, SurfaceContext c, vec3 wo, vec3 wi, vec3 u) {
    SurfaceEvent result = SurfaceEvent(SurfacePair(Spectrum(0), 0.0, 0.0), no_bsdf_sample(), 0.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name)                                                         \
    case tag: {                                                                        \
        Struct r = name##_resolve(name##_record(record_index(ref)), c);                \
        result.pair.value = name##_eval(r, c, wo, wi);                                 \
        result.pair.pdf = name##_pdf(r, c, wo, wi);                                    \
        result.next = name##_sample(r, c, wo, u);                                      \
        IF_BIDIRECTIONAL(result.pair.pdf_reverse = name##_pdf(r, c, wi, wo);           \
                         result.next_pdf_reverse = name##_pdf(r, c, result.next.wi, wo);) \
        break;                                                                         \
    }
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

Spectrum surface_transparency(uint ref, SurfaceContext c, vec3 wo) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_transparency(name##_resolve(name##_record(record_index(ref)), c), c, wo); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool surface_is_delta(uint ref, SurfaceContext c) {
    bool result = true;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_is_delta(name##_record(record_index(ref)), c); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool surface_is_opaque(uint ref, SurfaceContext c) {
    bool result = true;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_is_opaque(name##_record(record_index(ref)), c); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}
