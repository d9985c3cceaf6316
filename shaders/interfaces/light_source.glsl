// LightSource: where light comes from. A class NAME defines, for its record R:
//
//   LightSample NAME_sample_towards(R r, vec3 point, vec2 u)           a direction from `point` towards the light
//   float       NAME_pdf_towards(R r, vec3 point, vec3 direction, LightHit hit)  of sample_towards, 1/sr; 0 for delta lights
//   Spectrum    NAME_radiance(R r, vec3 direction, LightHit hit)       radiance that a ray along `direction` meets:
//                                     on the emitting surface (hit), or where it leaves the scene (lights at infinity)
//   float       NAME_power(R r, SceneBounds bounds)                    luminous flux sent into the scene, lm (radiant flux
//                                     for an image in radiometric units); guides light selection and the power balance
//   void        NAME_bounds(R r, out vec3 lo, out vec3 hi)             world box; lo > hi for a light at infinity
//   LightCone   NAME_cone(R r)                                     directions into which it sends light
//
// All in world space.
#include "lib/accurate_math.glsl"
#include "lib/constants.glsl"
#include "lib/spectrum.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"
#include "lib/frames.glsl"

struct LightSample {
    vec3 direction;     // unit, from the point to the light
    float distance;     // m; INFINITY for lights at infinity
    Spectrum radiance;  // arriving along the direction; for delta lights the irradiance on a plane that faces the light
    float pdf;          // 1/sr; 1 for delta lights; 0 = no light this way
    bool is_delta;      // rays can never hit the light
};

LightSample no_light_sample() { return LightSample(vec3(0, 0, 1), 0.0, Spectrum(0), 0.0, true); }

// The point of a surface light that a ray has hit; unused by lights at infinity.
struct LightHit {
    vec3 position;
    vec3 normal;      // geometric, unit
    vec2 uv0, uv1;
};

struct SceneBounds { vec3 center; float radius; };

// Normals lie within an angle n of the axis; light leaves within an angle e of some normal, strongest along it. Both as
// cosines; may be too wide, never too narrow.
struct LightCone {
    vec3 axis;            // unit
    float cos_normals;    // cos n; -1 = all directions
    float cos_emission;   // cos e; 0 for a surface
};

LightCone whole_sphere_cone() { return LightCone(vec3(0, 0, 1), -1.0, 0.0); }

#include "generated/light_classes.glsl"

LightSample light_sample_towards(uint ref, vec3 point, vec2 u) {
    LightSample result = no_light_sample();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_sample_towards(name##_record(record_index(ref)), point, u); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float light_pdf_towards(uint ref, vec3 point, vec3 direction, LightHit hit) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_pdf_towards(name##_record(record_index(ref)), point, direction, hit); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return result;
}

Spectrum light_radiance(uint ref, vec3 direction, LightHit hit) {
    Spectrum result = Spectrum(0);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_radiance(name##_record(record_index(ref)), direction, hit); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float light_power(uint ref, SceneBounds bounds) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_power(name##_record(record_index(ref)), bounds); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return result;
}

void light_bounds(uint ref, out vec3 lo, out vec3 hi) {
    lo = vec3(1), hi = vec3(-1);
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: name##_bounds(name##_record(record_index(ref)), lo, hi); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
}

LightCone light_cone(uint ref) {
    LightCone result = whole_sphere_cone();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_cone(name##_record(record_index(ref))); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return result;
}
