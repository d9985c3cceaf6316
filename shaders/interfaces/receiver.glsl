// Receiver: where light is measured. A class NAME defines, for its record R:
//
//   CameraRay NAME_emit(R r, vec2 film, float film_aspect)   the backward ray through a point of the film
//
// `film` runs over [0,1]², x to the right, y down; film_aspect = width / height of the image. World space.
#include "lib/constants.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"

struct CameraRay {
    vec3 origin;
    vec3 direction;   // unit
    float weight;     // of the radiance it collects; 0 = this point of the film sees nothing
};

#include "generated/receiver_classes.glsl"

CameraRay receiver_emit(uint ref, vec2 film, float film_aspect) {
    CameraRay result = CameraRay(vec3(0), vec3(0, 0, 1), 0.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_emit(name##_record(record_index(ref)), film, film_aspect); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}
