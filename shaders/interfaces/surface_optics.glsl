// SurfaceOptics: how a surface scatters light. Directions are unit vectors in the local shading frame, both pointing
// away from the surface; +z is the shading normal, on the side of the geometric normal. A class NAME defines, for
// its record R:
//
//   R          NAME_resolve(R r, SurfaceContext c)                  the record at this point: textures applied. The functions
//                                                                   below but the last see resolved records only
//   SurfacePair NAME_evaluate(R r, SurfaceContext c, vec3 wo, vec3 wi)   scattering between two directions and the pdfs of `sample`
//                                                                   choosing one given the other, without delta parts
//   BsdfSample NAME_sample(R r, SurfaceContext c, vec3 wo, vec3 u)   wi and event; for delta events weight and pdf, too. For the
//                                                                   others `evaluate` says those
//   Spectrum   NAME_transparency(R r, SurfaceContext c, vec3 wo)     part that passes straight on, unscattered
//   bool       NAME_is_delta(R r, SurfaceContext c)                  evaluate gives zero for every pair of directions; may
//                                                                   say false where only a texture makes it so
//   bool       NAME_is_opaque(R r, SurfaceContext c)                 transparency is zero in every direction, whatever the
//                                                                   textures and colors
//   float      NAME_coverage(R r, SurfaceContext c)                  may be left out: part of the surface that is there, of the record as it
//                                                                   is; the rest lets light pass straight on and emits none
//   Mueller    NAME_mueller(R r, SurfaceContext c, vec3 from, vec3 to, uint event)   may be left out: what the event (0: one of
//                                                                   `evaluate`) does to the polarization of light that comes
//                                                                   from `from` and goes to `to`, both away from the surface
//                                                                   (lib/stokes.glsl). Without it light is depolarized, and
//                                                                   what passes straight on stays as it is
//   NAME_POLARIZES, a macro, where light is polarized on purpose: scenes with the class carry polarization unless told otherwise
//
//   NAME_DISPERSES, a macro, where directions depend on the wavelength (EVENT_PARTS): scenes with the class are rendered in wavelengths
//                                                                   unless told otherwise
//
// wo is the direction where the path comes from, wi where it goes. c.importance tells the transport direction: false
// carries radiance (backward rays: transmission scales by (ior on the side of wo / ior on the side of wi)², Veach 1997 eq. 5.12), true carries power.
// Corrections for shading normals are made by the callers (lib/scattering.glsl), once for all classes.
#include "features/defaults.glsl"
#include "features/mueller.glsl"
#include "lib/constants.glsl"
#include "features/spectrum.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"
#include "features/textures.glsl"

struct SurfaceContext {
    vec2 uv0, uv1;          // texture coordinates
    vec4 color;             // vertex color, linear
    float ior_above;        // real refractive index of the medium on the side of +z
    float ior_below;
    bool importance;
    mat3 mesh_frame;        // tangent, bitangent and normal that no map has bent, in the local frame
    MEMBER_IF(HAS_SHADING_NORMALS, vec3 level;)  // normal of the surface itself, in the local frame
};

// Where no map has bent the frame.
SurfaceContext unbent_context(vec2 uv0, vec2 uv1, vec4 color, float ior_above, float ior_below, bool importance) {
    SurfaceContext c;
    c.uv0 = uv0, c.uv1 = uv1, c.color = color, c.ior_above = ior_above, c.ior_below = ior_below, c.importance = importance;
    c.mesh_frame = mat3(1);
    MEMBER_IF(HAS_SHADING_NORMALS, c.level = vec3(0, 0, 1);)
    return c;
}

// A direction about the normal that no map has bent, in the local frame.
vec3 from_mesh_frame(SurfaceContext c, vec3 v) { return HAS_NORMAL_MAPS == 1 ? c.mesh_frame * v : v; }

const uint EVENT_NONE = 0u;      // absorbed
const uint EVENT_REFLECT = 1u;
const uint EVENT_TRANSMIT = 2u;
const uint EVENT_DELTA = 4u;     // pdf is the probability of the discrete direction, not a density
const uint EVENT_STRAIGHT = 8u;  // passes on unscattered (the part that `transparency` gives); implies DELTA | TRANSMIT
const uint EVENT_PARTS = 256u;   // the direction is that of the hero's wavelength alone; with DELTA

struct SurfacePair {
    Spectrum value;     // f * |cos wi|, 1/sr
    float pdf;          // of wi given wo, 1/sr
    float pdf_reverse;  // of wo given wi; asked for only where BIDIRECTIONAL is 1
};

SurfacePair no_surface_pair() { return SurfacePair(Spectrum(0), 0.0, 0.0); }

struct BsdfSample {
    vec3 wi;
    Spectrum weight;  // f * |cos wi| / pdf
    float pdf;
    uint event;
};

BsdfSample no_bsdf_sample() { return BsdfSample(vec3(0, 0, 1), Spectrum(0), 0.0, EVENT_NONE); }

// What a class samples that is no delta event.
BsdfSample scattered(vec3 wi, uint event) { return BsdfSample(wi, Spectrum(0), 0.0, event); }

// Of classes that say nothing of polarization.
Mueller unsaid_mueller(vec3 to, uint event) {
    if ((event & EVENT_STRAIGHT) != 0u) return passing(to);
    return depolarizing();
}

#include "generated/surface_classes.glsl"
#include "features/shading_normals.glsl"

// What the algorithms see of a pair of directions.
struct Scattering {
    Spectrum value;     // as of SurfacePair
    float pdf;
    float pdf_reverse;
    MEMBER_IF(HAS_POLARIZATION, Mueller mueller;)
};

Scattering scattering_of(SurfacePair pair) {
    Scattering s;
    s.value = pair.value, s.pdf = pair.pdf, s.pdf_reverse = pair.pdf_reverse;
    no_mueller(s.mueller);
    return s;
}

Scattering no_scattering() { return scattering_of(no_surface_pair()); }

// Light comes from wo where paths carry power, else from wi.
#define MUELLER_ALONG(name, r, c, wo, wi, event) name##_mueller(r, c, c.importance ? wo : wi, c.importance ? wi : wo, event)

// Of a surface of any class, in a kernel for one class too where that connects vertices.
Scattering surface_pair(uint ref, SurfaceContext c, vec3 wo, vec3 wi) {
    Scattering result = no_scattering();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name)                                                  \
    case tag: {                                                                  \
        Struct r = name##_resolve(name##_record(record_index(ref)), c);          \
        EVALUATE(name, r, c, wo, wi, pair);                                      \
        result = scattering_of(pair);                                            \
        keep_mueller(result.mueller, MUELLER_ALONG(name, r, c, wo, wi, 0u));     \
        break;                                                                   \
    }
        MET_SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// All of an event at once: scattering towards one or two directions, and a sample. The class is visited and its textures are read
// once.
struct SurfaceEvent {
    Scattering pair, second;
    BsdfSample next;
    float next_pdf_reverse;
    MEMBER_IF(HAS_POLARIZATION, Mueller next_mueller;)
    MEMBER_IF(HAS_CRYSTALS, uint mode;)  // of the ray that goes on (features/crystals.glsl)
};

SurfaceEvent no_surface_event() {
    SurfaceEvent event;
    event.pair = event.second = no_scattering();
    event.next = no_bsdf_sample();
    event.next_pdf_reverse = 0.0;
    no_mueller(event.next_mueller);
    return event;
}

// Weight and pdf of a sample, if it is no delta event, by its pair of directions.
void complete(inout SurfaceEvent event, Scattering pair) {
    keep_mueller(event.next_mueller, pair.mueller);
    if (event.next.event == EVENT_NONE || (event.next.event & EVENT_DELTA) != 0u) return;
    event.next.pdf = pair.pdf;
    event.next.weight = pair.pdf > 0.0 ? pair.value / pair.pdf : Spectrum(0);
    event.next_pdf_reverse = pair.pdf_reverse;
    if (!(pair.pdf > 0.0)) event.next = no_bsdf_sample();
}

// `asked` is 1 where nothing is wanted of the second direction, else 2.
SurfaceEvent surface_event(uint ref, SurfaceContext c, vec3 wo, vec3 wi, vec3 second, uint asked, vec3 u) {
    SurfaceEvent result = no_surface_event();
    switch (record_tag(ref)) {
// A loop over all directions, so that the code of `evaluate` stands once.
#define CASE(tag, Struct, name)                                                              \
    case tag: {                                                                             \
        Struct r = name##_resolve(name##_record(record_index(ref)), c);                     \
        SAMPLE(name, r, c, wo, u, result.next);                                             \
        for (uint i = 0u; i <= asked; ++i) {                                                \
            vec3 towards = i == asked ? result.next.wi : i == 0u ? wi : second;             \
            EVALUATE(name, r, c, wo, towards, evaluated);                                   \
            Scattering pair = scattering_of(evaluated);                                     \
            uint event = i == asked ? result.next.event : 0u;                               \
            keep_mueller(pair.mueller, MUELLER_ALONG(name, r, c, wo, towards, event));      \
            if (i == asked) complete(result, pair);                                         \
            else if (i == 0u) result.pair = pair;                                           \
            else result.second = pair;                                                      \
        }                                                                                   \
        break;                                                                              \
    }
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

BsdfSample surface_sample(uint ref, SurfaceContext c, vec3 wo, vec3 u) { return surface_event(ref, c, wo, wo, wo, 1u, u).next; }

Spectrum surface_transparency(uint ref, SurfaceContext c, vec3 wo) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_transparency(name##_resolve(name##_record(record_index(ref)), c), c, wo); break;
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// What that does to polarization; light comes from `from`.
Mueller surface_transparency_mueller(uint ref, SurfaceContext c, vec3 from) {
    Mueller result = depolarizing();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name)                                                          \
    case tag: {                                                                         \
        Struct r = name##_resolve(name##_record(record_index(ref)), c);                 \
        result = name##_mueller(r, c, from, -from, EVENT_TRANSMIT | EVENT_DELTA | EVENT_STRAIGHT); \
        break;                                                                          \
    }
        SURFACE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// Part of the surface that is there.
float surface_coverage(uint ref, SurfaceContext c) {
    float result = 1.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_coverage(name##_record(record_index(ref)), c); break;
        COVERED_SURFACE_CLASSES(CASE)
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
