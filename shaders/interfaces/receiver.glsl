// Receiver: where light is measured. A class NAME defines, for its record R:
//
//   CameraRay      NAME_emit(R r, vec2 film, vec2 u, float film_aspect)   a backward ray through a point of the film; u draws it where
//                               there are many, of which `#define NAME_HAS_APERTURE` tells, else it is unused
//   ReceiverSample NAME_connect(R r, vec3 point, vec2 u, float film_aspect)   a way from a point to the receiver. Its density
//                               * weight / pdf is the importance: a point that sends the intensity I (W/sr) that way adds
//                               I * density * weight / pdf to the mean over the film
//   float          NAME_footprint(R r, vec3 point, float film_aspect, out float slope)   square root of the area that the whole
//                               film covers at the point's distance, m; > 0, continuous, also for points out of view; `slope` is the
//                               most by which it changes over a metre, m/m
//
// and where it has them:
//
//   ReceptorHit    NAME_receptor(R r, vec3 origin, vec3 direction)   where light that passes on the ray is caught: all paths of this
//                               receiver end at its receptor, a white diffuse plane, or one of small bodies, that nothing else sees
//                               (features/receptors.glsl)
//   vec4           NAME_pupil(R r)   centre and radius, m, of the disk that light comes through to a receptor with a window
//   ReceiverSample NAME_far(R r, vec3 direction, float film_aspect)   what light that leaves the scene along `direction` adds: the flux F
//                               adds F * density * weight to the mean over the film; pdf is that of `connect` choosing it, 1/sr
//   ReceiverSample NAME_at_surface(R r, uint primitive, vec3 point, bool front, bool leaves)   it lies on this primitive, at the
//                               point: what light adds there that comes to a side or leaves it, as `connect` or `far` would have it; pdf 0 = it does not
//   uint           NAME_face(R r, vec2 film, out bool front)   the primitive, and its side, that a point of the film is of
//
// With `#define NAME_RECORDS_RAYS 1` what passes the receptor is written down (features/ray_record.glsl).
//
// A pixel of a camera is a radiance; that of a meter, which measures and shows no picture, what the words "A pixel: UNIT." of the
// class's comment say.
//
// Every record begins with the Placement of the node.
//
// `film` runs over [0,1]², x to the right, y down; film_aspect = width / height of the image. World space; node transforms
// may scale, shear and mirror.
#include "lib/accurate_math.glsl"
#include "lib/constants.glsl"
#include "lib/frames.glsl"
#include "lib/records.glsl"
#include "lib/stokes.glsl"
#include "lib/warps.glsl"

struct CameraRay {
    vec3 origin;
    vec3 direction;     // unit
    float weight;       // of the radiance it collects; 0 = this point of the film sees nothing
    float density;      // of emit sending this ray for points spread evenly over the film, 1/sr from a pinhole, 1/m² of
                        // parallel rays, across them
    float connect_pdf;  // of `connect` choosing this ray from a point at distance d on it: connect_pdf d², or connect_pdf
    bool is_parallel;   // where this is set
    bool at_receptor;   // the ray starts at the receptor, from above
    uint shape;         // of that (features/receptor_shapes.glsl)
};

struct ReceiverSample {
    vec3 direction;   // unit, from the point to the receiver
    float distance;   // m
    vec2 film;        // [0,1]²
    float density;    // as CameraRay.density, of the ray that arrives
    float weight;     // as CameraRay.weight
    float pdf;        // CameraRay.connect_pdf distance², or of parallel rays connect_pdf; 0 = the receiver does not see the point
};

ReceiverSample no_receiver_sample() { return ReceiverSample(vec3(0, 0, 1), 0.0, vec2(0), 0.0, 1.0, 0.0); }

struct ReceptorHit {
    float t;      // m; INFINITY = the ray does not meet it from the front
    vec3 normal;  // unit
    uint shape;   // of the receptor (features/receptor_shapes.glsl)
};
// Kinds of receptors: a plane is white and diffuse; through a window, a disk before it, all its light comes.
const uint SHAPE_PLANE = 0u, SHAPE_HEMISPHERE = 1u, SHAPE_SPHERE = 2u, SHAPE_CYLINDER = 3u, SHAPE_WINDOW = 4u;

ReceptorHit no_receptor_hit() { return ReceptorHit(INFINITY, vec3(0, 0, 1), 0u); }

// The signed volume that the columns span.
float frame_volume(mat3 m) { return dot(cross(m[0], m[1]), m[2]); }

// `v` in the frame whose axes are the columns of m, times |frame_volume(m)|.
vec3 scaled_local(mat3 m, vec3 v) {
    vec3 x = cross(m[1], m[2]);
    vec3 local = vec3(dot(x, v), dot(cross(m[2], m[0]), v), dot(cross(m[0], m[1]), v));
    return dot(x, m[0]) < 0.0 ? -local : local;
}

#include "generated/receiver_classes.glsl"

CameraRay receiver_emit(uint ref, vec2 film, vec2 u, float film_aspect) {
    CameraRay result = CameraRay(vec3(0), vec3(0, 0, 1), 0.0, 0.0, 1.0, false, false, 0u);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_emit(name##_record(record_index(ref)), film, u, film_aspect); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

ReceiverSample receiver_connect(uint ref, vec3 point, vec2 u, float film_aspect) {
    ReceiverSample result = no_receiver_sample();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_connect(name##_record(record_index(ref)), point, u, film_aspect); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}

// x of the frame of light that arrives against `direction`, a receiver's ray: y of its node, as the ray sees it, stands upright.
vec3 receiver_stokes_axis(uint ref, vec3 direction) {
    vec3 up = vec3(0, 1, 0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: up = name##_record(record_index(ref)).placement.world_from_local[1]; break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    vec3 axis = cross(direction, normalize(up));
    float l = dot(axis, axis);
    return l > 1e-12 ? axis * inversesqrt(l) : stokes_axis(-direction);
}

float receiver_footprint(uint ref, vec3 point, float film_aspect, out float slope) {
    float result = 1.0;
    slope = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_footprint(name##_record(record_index(ref)), point, film_aspect, slope); break;
        RECEIVER_CLASSES(CASE)
#undef CASE
    }
    return result;
}
