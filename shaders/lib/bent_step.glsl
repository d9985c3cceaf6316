// A step of a ray through a medium whose refractive index varies in space (lib/bent_ray.glsl).

// How long the steps of a medium may be.
struct StepLimits {
    float tolerance;  // m, by which the bent ray may leave the chord of a step
    float longest;    // m, of a step: a good part of the length over which the index changes
};

struct BentStep {
    vec3 chord;  // from its start to its end, m
    vec3 start;  // optical direction at the start: of the ray, as long as the index there
    vec3 end;
    vec3 bow;    // where f of the chord is behind, the optical direction is mix(start, end, f) + f (1 - f) bow
};
