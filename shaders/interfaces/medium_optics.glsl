// MediumOptics: what happens between surfaces. A class NAME defines, for its record R:
//
//   Spectrum NAME_ior(R r)                          real refractive index
//   Spectrum NAME_transmittance(R r, float distance)   part that is left after `distance` metres, neither absorbed nor scattered
//   bool     NAME_is_clear(R r)                     all of it is left, whatever the distance
//   bool     NAME_scatters(R r)                     some of it is scattered. Only then are asked:
//   FreePath NAME_free_path(R r, float distance, Spectrum carried, vec2 u)   where light that carries so much scatters on a way
//                                                   of `distance`, by two numbers spread evenly over [0,1)
//   float    NAME_passage(R r, float distance)      transmittance of an average lane
//   float    NAME_mean_extinction(R r)              extinction coefficient of an average lane, 1/m
//   Spectrum NAME_scattering(R r)                   scattering coefficient, 1/m
//   uint     NAME_phase(R r)                        RecordRef of the phase function
//
// Passage and mean extinction serve to weigh ways to make a path against each other (lib/mis.glsl): they are the same for every
// path, whatever its lanes carry, and in both directions.
// No medium (NO_RECORD) is vacuum: ior 1, nothing absorbed, nothing scattered.
#include "lib/constants.glsl"
#include "lib/spectrum.glsl"
#include "lib/records.glsl"
#include "lib/free_path.glsl"
#if HAS_SCATTERING
#include "interfaces/phase_function.glsl"
#endif

#include "generated/medium_classes.glsl"

Spectrum medium_spectral_ior(uint ref) {
    Spectrum result = Spectrum(1);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_ior(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// Of the hero wavelength; colours have one index.
float medium_ior(uint ref) { return medium_spectral_ior(ref).x; }

Spectrum medium_transmittance(uint ref, float distance) {
    Spectrum result = Spectrum(1);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_transmittance(name##_record(record_index(ref)), distance); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool medium_is_clear(uint ref) {
    bool result = true;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_is_clear(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool medium_scatters(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_scatters(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

#if HAS_SCATTERING
FreePath medium_free_path(uint ref, float distance, Spectrum carried, vec2 u) {
    FreePath result = FreePath(false, distance, Spectrum(1), 1.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_free_path(name##_record(record_index(ref)), distance, carried, u); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float medium_passage(uint ref, float distance) {
    float result = 1.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_passage(name##_record(record_index(ref)), distance); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float medium_mean_extinction(uint ref) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_mean_extinction(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

Spectrum medium_scattering(uint ref) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_scattering(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

uint medium_phase(uint ref) {
    uint result = NO_RECORD;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_phase(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}
#endif
