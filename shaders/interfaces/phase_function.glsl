// PhaseFunction: into which directions a point of a medium scatters light. It is the same for all wavelengths, depends on nothing
// but the angle by which light is turned, and is sampled exactly. A class NAME defines, for its record R:
//
//   float NAME_value(R r, float cosine)   1/sr, for light that is turned by an angle of that cosine (1 = it goes straight on);
//                                         its integral over the sphere is 1
//   float NAME_sample(R r, float u)       a cosine, for u in [0,1) spread evenly; directions around are equally likely
#include "lib/constants.glsl"
#include "lib/records.glsl"

#include "generated/phase_classes.glsl"

float phase_value(uint ref, float cosine) {
    float result = 0.0;
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
