// Geometry: a shape in its own frame. Node transforms are applied by the callers (lib/primitives.glsl), so a class
// never sees them; they may be any invertible affine map. A class NAME defines, for its record R:
//
//   bool           NAME_intersect(R r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit)
//                                                            nearest hit with 0 < t < t_max; direction is not unit
//   LocalPoint     NAME_locate(R r, vec3 origin, vec3 direction, GeometryHit hit)
//   GeometrySample NAME_sample(R r, vec2 u)                  a point, uniform by area; per axis within SAMPLE_ROUNDINGS
//                                                            roundings of the box's reach from the exact surface
//   GeometrySample NAME_sample_towards(R r, vec3 reference, vec2 u)   a point as seen from `reference`
//   float          NAME_pdf_towards(R r, vec3 reference, vec3 position, vec3 normal)   of sample_towards, 1/m²
//   float          NAME_area(R r)                            m²
//   void           NAME_bounds(R r, out vec3 lo, out vec3 hi)
//
// Sampling is over the side(s) that can emit; pdfs are per area of the local frame (1/m²), which stay right under
// any affine map after division by its area factor.
#include "lib/constants.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"

struct GeometryHit {
    float t;     // along direction
    vec2 uv;     // the class's own parameters of the hit
};

struct LocalPoint {
    vec3 position;
    vec3 error;     // bound of |position - exact point|, per axis, m
    vec3 normal;    // unit, geometric; the side that emits
    vec3 tangent;   // along increasing u; not unit
    vec2 uv;        // texture coordinates
};

const float SAMPLE_ROUNDINGS = 8.0;

struct GeometrySample {
    vec3 position;
    vec3 normal;  // unit, geometric
    float pdf;    // 1/m²
};

#include "generated/geometry_classes.glsl"

bool geometry_intersect(uint ref, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    bool result = false;
    hit = GeometryHit(INFINITY, vec2(0));
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_intersect(name##_record(record_index(ref)), origin, direction, t_max, hit); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
    return result;
}

LocalPoint geometry_locate(uint ref, vec3 origin, vec3 direction, GeometryHit hit) {
    LocalPoint result = LocalPoint(vec3(0), vec3(0), vec3(0, 0, 1), vec3(1, 0, 0), vec2(0));
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_locate(name##_record(record_index(ref)), origin, direction, hit); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
    return result;
}

GeometrySample geometry_sample(uint ref, vec2 u) {
    GeometrySample result = GeometrySample(vec3(0), vec3(0, 0, 1), 0.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_sample(name##_record(record_index(ref)), u); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
    return result;
}

GeometrySample geometry_sample_towards(uint ref, vec3 reference, vec2 u) {
    GeometrySample result = GeometrySample(vec3(0), vec3(0, 0, 1), 0.0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_sample_towards(name##_record(record_index(ref)), reference, u); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float geometry_pdf_towards(uint ref, vec3 reference, vec3 position, vec3 normal) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_pdf_towards(name##_record(record_index(ref)), reference, position, normal); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float geometry_area(uint ref) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_area(name##_record(record_index(ref))); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
    return result;
}

void geometry_bounds(uint ref, out vec3 lo, out vec3 hi) {
    lo = vec3(0), hi = vec3(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: name##_bounds(name##_record(record_index(ref)), lo, hi); break;
        GEOMETRY_CLASSES(CASE)
#undef CASE
    }
}
