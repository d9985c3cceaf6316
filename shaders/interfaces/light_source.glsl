// LightSource: where light comes from. A class NAME defines, for its record R:
//
//   LightSample NAME_sample_towards(R r, vec3 point, vec2 u)           a direction from `point` towards the light
//   float       NAME_pdf_towards(R r, vec3 point, vec3 direction, LightHit hit)  of sample_towards, as LightSample.pdf
//   Spectrum    NAME_radiance(R r, vec3 direction, LightHit hit)       radiance that a ray along `direction` meets:
//                                     on the emitting surface (hit), or where it leaves the scene (lights at infinity);
//                                     0 for delta lights, which rays cannot meet
//   EmittedRay  NAME_emit(R r, SceneBounds bounds, vec2 u_position, vec2 u_direction)   a ray that leaves the light
//   float       NAME_pdf_emit(R r, SceneBounds bounds, vec3 direction, LightHit hit)    density of emit sending the ray
//                                     that a ray along `direction` meets, as EmittedRay.pdf; 0 where it never would
//   float       NAME_power(R r, SceneBounds bounds)                    luminous flux sent into the scene, lm (radiant flux
//                                     for an image in radiometric units); guides light selection and the power balance
//   void        NAME_bounds(R r, out vec3 lo, out vec3 hi)             world box; lo > hi for a light at infinity
//   LightCone   NAME_cone(R r)                                     directions into which it sends light
//
// and where rays have polarizations of their own:
//
//   LightStokes NAME_emitted_stokes(R r, vec2 u_position, vec2 u_direction)     of the ray that emit sends by the same numbers
//
// All in world space. Where a function is asked about a direction, it points towards the light. Delta lights are asked only
// about their own light: hit.position is theirs, or the direction is.
//
// Densities of rays are per étendue, projected area times solid angle, so that they are the same for a ray wherever on it
// they are taken, and nothing tells lights at infinity from others (Veach 1997, section 4.1). Delta lights have the
// density over what is left to choose: the solid angle of a point, the area of parallel rays, nothing of single rays.
#include "lib/accurate_math.glsl"
#include "lib/constants.glsl"
#include "features/spectrum.glsl"
#include "lib/records.glsl"
#include "lib/warps.glsl"
#include "lib/frames.glsl"

struct LightSample {
    vec3 direction;     // unit, from the point to the light
    float distance;     // m; INFINITY for lights at infinity
    Spectrum radiance;  // arriving along the direction; delta positions: luminous intensity towards the point; delta
                        // directions: irradiance on a plane that faces the light. Over pdf it is an irradiance in any case
    float pdf;          // 1/sr; delta positions: distance², m²; delta directions: 1; 0 = no light this way
    float emission_pdf; // density of emit sending the light that arrives, as EmittedRay.pdf
    bool is_delta;      // rays can never hit the light
};

LightSample no_light_sample() { return LightSample(vec3(0, 0, 1), 0.0, Spectrum(0), 0.0, 0.0, true); }

struct EmittedRay {
    vec3 origin;        // m; on the surface (not yet offset from it), the point, or outside the scene for lights at infinity
    vec3 error;         // bound of the distance from the exact surface, per axis, m; 0 where there is no surface
    vec3 normal;        // unit, of the surface, on the side that the ray leaves; the direction where there is no surface
    vec3 direction;     // unit, the way the light travels
    Spectrum radiance;  // along the ray; delta positions: luminous intensity; delta directions: irradiance as above; single
                        // rays, which are drawn by their flux: the flux of all
    float pdf;          // density, 1/(m² sr); delta positions: 1/sr; delta directions: 1/m²; single rays: 1; 0 = no ray.
                        // radiance / pdf is the flux that the ray carries
    bool is_delta;      // rays can never hit the light
    bool front;         // leaves on the side of the surface's geometric normal; true where there is no surface
};

// Twin in host/scene/records.h.
struct LightStokes {
    vec3 stokes;  // S1 to S3 over S0
    vec3 axis;    // x of their frame, as far as it lies across the light's direction; unit, in world space
};
LightStokes no_light_stokes() { return LightStokes(vec3(0), vec3(1, 0, 0)); }

EmittedRay no_emitted_ray() {
    return EmittedRay(vec3(0), vec3(0), vec3(0, 0, 1), vec3(0, 0, 1), Spectrum(0), 0.0, true, true);
}

// The point of a surface light that a ray has hit; unused by lights at infinity.
struct LightHit {
    vec3 position;
    vec3 normal;      // geometric, unit
    vec2 uv0, uv1;
};

// A sphere around all geometry, m. The host defines SCENE_RADIUS; world coordinates are relative to its centre.
struct SceneBounds { vec3 center; float radius; };

SceneBounds scene_bounds() { return SceneBounds(vec3(0), SCENE_RADIUS); }

// Rays of one direction into the scene start evenly on a disk across the direction that is as large as the scene and lies
// outside it.
float outer_disk_pdf(SceneBounds bounds) {  // 1/m²; 0 without geometry
    return bounds.radius > 0.0 ? INV_PI / square(bounds.radius) : 0.0;
}
vec3 outer_disk_point(SceneBounds bounds, vec3 direction, vec2 u) {
    vec3 across = frame_around(direction) * vec3(warp_disk(u), 0.0);
    return bounds.center + bounds.radius * (across - 1.01 * direction);
}

// Normals lie within an angle n of the axis; light leaves within an angle e of some normal, strongest along it. Both as
// cosines; may be too wide, never too narrow.
struct LightCone {
    vec3 axis;            // unit
    float cos_normals;    // cos n; -1 = all directions
    float cos_emission;   // cos e; 0 for a surface; 2: see unmet_rays()
};

LightCone whole_sphere_cone() { return LightCone(vec3(0, 0, 1), -1.0, 0.0); }

// Of a light whose rays have one direction each where they start: sample_towards never finds one of them. Forward rays alone bring
// such light, and no point chooses it.
LightCone unmet_rays() { return LightCone(vec3(0, 0, 1), 1.0, 2.0); }

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

EmittedRay light_emit(uint ref, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    EmittedRay result = no_emitted_ray();
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_emit(name##_record(record_index(ref)), bounds, u_position, u_direction); break;
        LIGHT_CLASSES(CASE)
#undef CASE
    }
    return result;
}

float light_pdf_emit(uint ref, SceneBounds bounds, vec3 direction, LightHit hit) {
    float result = 0.0;
    switch (record_tag(ref)) {
#define CASE(tag, Struct, name) case tag: result = name##_pdf_emit(name##_record(record_index(ref)), bounds, direction, hit); break;
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
