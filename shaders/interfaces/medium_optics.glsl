// MediumOptics: what happens between surfaces. A class NAME defines, for its record R:
//
//   Spectrum NAME_ior(R r, vec3 position)           real refractive index
//   Passage  NAME_pass(R r, MediumRay ray, uint seed)   part that is left at the end of the ray, neither absorbed nor scattered
//   bool     NAME_is_clear(R r)                     all of it is left, whatever the distance
//   bool     NAME_scatters(R r)                     some of it is scattered. Only then are asked:
//   FreePath NAME_free_path(R r, MediumRay ray, Spectrum carried, vec2 u, uint seed)   where on the ray light that carries so
//                                                   much scatters, by two numbers spread evenly over [0,1)
//   bool     NAME_is_even(R r)                      it scatters and absorbs the same everywhere
//   float    NAME_mean_extinction(R r, vec3 position)   extinction coefficient of an average lane, 1/m
//   Spectrum NAME_scattering(R r, vec3 position)    scattering coefficient, 1/m
//   uint     NAME_phase(R r)                        RecordRef of the phase function
//   bool     NAME_bends(R r)                        its index varies in space: rays are bent, and it does not scatter. Only then:
//   vec3     NAME_bending(R r, vec3 position)       half the gradient of the squared index of the hero wavelength, 1/m
//   StepLimits NAME_step_limits(R r)                how long steps may be (lib/bent_step.glsl)
//   Crystal  NAME_crystal(R r)                      may be left out: it refracts doubly, with these indices of the hero wavelength
//                                                   (lib/crystal_waves.glsl); then it neither scatters nor bends rays, and its
//                                                   NAME_pass knows the ray's mode
//
// Rays and positions are in world space. `seed`: for classes that need any number of random numbers; right in the mean over
// all seeds. Passage.mean, FreePath.passage and the mean extinction serve to weigh ways to make a path against each other
// (features/mis.glsl): they are the same for every path, whatever its lanes carry and whatever the seed, and in both directions.
// No medium (NO_RECORD) is vacuum: ior 1, nothing absorbed, nothing scattered.
#include "lib/constants.glsl"
#include "features/spectrum.glsl"
#include "lib/records.glsl"
#include "lib/bent_step.glsl"
#include "lib/crystal_waves.glsl"
#include "lib/free_path.glsl"
#include "interfaces/phase_function.glsl"

#include "generated/medium_classes.glsl"

Spectrum medium_spectral_ior(uint ref, vec3 position) {
    Spectrum result = Spectrum(1);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_ior(name##_record(record_index(ref)), position); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// Of the hero wavelength; colours have one index.
float medium_ior(uint ref, vec3 position) { return of_hero(medium_spectral_ior(ref, position)); }

Passage medium_pass(uint ref, MediumRay ray, uint seed) {
    Passage result = Passage(Spectrum(1), 1.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_pass(name##_record(record_index(ref)), ray, seed); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// Isotropic without an axis, and then without indices.
Crystal medium_crystal(uint ref) {
    Crystal result = isotropic_medium(1.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_crystal(name##_record(record_index(ref))); break;
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

bool medium_bends(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_bends(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool medium_is_even(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_is_even(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

FreePath medium_free_path(uint ref, MediumRay ray, Spectrum carried, vec2 u, uint seed) {
    FreePath result = FreePath(false, ray.distance, Spectrum(1), 1.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_free_path(name##_record(record_index(ref)), ray, carried, u, seed); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float medium_mean_extinction(uint ref, vec3 position) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_mean_extinction(name##_record(record_index(ref)), position); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

Spectrum medium_scattering(uint ref, vec3 position) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_scattering(name##_record(record_index(ref)), position); break;
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

vec3 medium_bending(uint ref, vec3 position) {
    vec3 result = vec3(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_bending(name##_record(record_index(ref)), position); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}

StepLimits medium_step_limits(uint ref) {
    StepLimits result = StepLimits(INFINITY, INFINITY);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_step_limits(name##_record(record_index(ref))); break;
        MEDIUM_CLASSES(CASE)
#undef CASE
    }
    return result;
}
