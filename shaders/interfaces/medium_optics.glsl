// MediumOptics: what happens between surfaces. A class NAME defines, for its record R:
//
//   Spectrum NAME_ior(R r)                          real refractive index
//   Spectrum NAME_transmittance(R r, float distance)   part that is left after `distance` metres
//   bool     NAME_is_clear(R r)                     all of it is left, whatever the distance
//
// No medium (NO_RECORD) is vacuum: ior 1, nothing absorbed.
#include "lib/constants.glsl"
#include "lib/spectrum.glsl"
#include "lib/records.glsl"

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
