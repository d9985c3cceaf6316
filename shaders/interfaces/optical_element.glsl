// OpticalElement: a black box with its own records, frame and hierarchy. A ray enters at one place of its boundary and
// may leave at another. A class NAME defines, for its record R:
//
//   bool NAME_enter(R r, inout ElementRay ray)    takes a ray at the boundary, in the element's frame; false = it is not
//                                                 let in, and goes on outside
//   bool NAME_leave(R r, inout ElementRay ray)    brings it to where it leaves; false = it is absorbed
//
// Nothing inside is imaged: no luminance is computed on its parts. No class is registered yet, and scenes with elements
// are refused by the host.
#include "lib/constants.glsl"
#include "lib/records.glsl"
#include "features/spectrum.glsl"

struct ElementRay {
    vec3 origin;          // m, in the element's frame
    vec3 direction;       // unit
    Spectrum throughput;  // what is left of the ray
};

#include "generated/element_classes.glsl"

bool element_enter(uint ref, inout ElementRay ray) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_enter(name##_record(record_index(ref)), ray); break;
        ELEMENT_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool element_leave(uint ref, inout ElementRay ray) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_leave(name##_record(record_index(ref)), ray); break;
        ELEMENT_CLASSES(CASE)
#undef CASE
    }
    return result;
}
