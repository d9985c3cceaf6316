// What only some classes of receivers have: receptors, of which some record rays, a place far away, or on a surface.
#include "features/defaults.glsl"
#include "interfaces/receiver.glsl"

#if HAS_RECEPTORS
bool has_receptor(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_HAS_RECEPTOR == 1; break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

ReceptorHit receiver_receptor(uint ref, vec3 origin, vec3 direction) {
    ReceptorHit result = no_receptor_hit();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_receptor(name##_record(record_index(ref)), origin, direction); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

vec4 receiver_pupil(uint ref) {
    vec4 result = vec4(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_pupil(name##_record(record_index(ref))); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

bool records_rays(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_RECORDS_RAYS == 1; break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}
#else
#define has_receptor(ref) false
#endif

#if HAS_SURFACE_METERS
bool on_surface(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_ON_SURFACE == 1; break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

ReceiverSample receiver_at_surface(uint ref, uint primitive, vec3 point, bool front, bool leaves) {
    ReceiverSample result = no_receiver_sample();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_at_surface(name##_record(record_index(ref)), primitive, point, front, leaves); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

uint receiver_face(uint ref, vec2 film, out bool front) {
    uint result = 0u;
    front = true;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_face(name##_record(record_index(ref)), film, front); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}
#else
#define on_surface(ref) false
#endif

#if HAS_FAR_RECEIVERS
bool is_far(uint ref) {
    bool result = false;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_IS_FAR == 1; break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

ReceiverSample receiver_far(uint ref, vec3 direction, float film_aspect) {
    ReceiverSample result = no_receiver_sample();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_far(name##_record(record_index(ref)), direction, film_aspect); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}
#else
#define is_far(ref) false
#endif
