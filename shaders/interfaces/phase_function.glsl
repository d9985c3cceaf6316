// PhaseFunction: into which directions a point of a medium scatters light. It depends on nothing but the angle by which light is
// turned and the wavelength, and is sampled exactly. A class NAME defines, for its record R:
//
//   Spectrum NAME_value(R r, float cosine)   1/sr, for light that is turned by an angle of that cosine (1 = it goes straight on);
//                                            its integral over the sphere is 1 in every lane
//   float NAME_sample(R r, float u)          a cosine, for u in [0,1) spread evenly, with the mean of the lanes as its density:
//                                            lane_mean(value); directions around are equally likely
//   Mueller NAME_mueller(R r, float cosine)   may be left out: what that does to polarization, with x across the plane of both
//                                         directions (lib/stokes.glsl). Without it light is depolarized
#include "lib/constants.glsl"
#include "lib/records.glsl"
#include "lib/stokes.glsl"

#include "generated/phase_classes.glsl"

// The density of phase_sample(), and of the way back, is lane_mean() of that.
Spectrum phase_value(uint ref, float cosine) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_value(name##_record(record_index(ref)), cosine); break;
        PHASE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float phase_sample(uint ref, float u) {
    float result = 1.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_sample(name##_record(record_index(ref)), u); break;
        PHASE_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// Of light that comes from `from` and goes to `to`, both away from the point.
Mueller phase_mueller(uint ref, vec3 from, vec3 to) {
    Mueller result = depolarizing();
    float cosine = -dot(from, to);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_mueller(name##_record(record_index(ref)), cosine); break;
        PHASE_CLASSES(CASE)
#undef CASE
    }
    result.from = result.to = facet_axis(to, from);
    return result;
}
