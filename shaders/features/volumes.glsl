// Points within media where light scatters, made to look like points of a surface (lib/scattering.glsl).
#include "features/weights.glsl"
#include "interfaces/medium_optics.glsl"
#include "lib/light_vertices.glsl"
#include "lib/primitives.glsl"

#if HAS_SCATTERING
bool in_volume(ScatteringPoint s) { return s.phase != NO_RECORD; }
bool is_in_volume(LightVertex v) { return v.primitive == NO_RECORD; }

// Where a ray through a medium scatters, as if it had hit something there.
SurfacePoint volume_point(vec3 position, vec3 direction) {
    SurfacePoint p;
    p.position = position;
    p.error = vec3(0);
    p.geometric_normal = p.shading_normal = direction;
    p.tangent = p.color = vec4(1);
    p.uv0 = p.uv1 = vec2(0);
    p.material = p.light = NO_RECORD;
    return p;
}

ScatteringPoint volume_scattering_point(vec3 position, vec3 direction, Surroundings around, bool importance) {
    ScatteringPoint s;
    s.frame = frame_around(direction);
    s.normal = s.shading_normal = direction;
    s.wo = vec3(0, 0, -1);
    s.surface = s.material = NO_RECORD;
    s.sides = no_crossing(around);
    s.context = unbent_context(vec2(0), vec2(0), vec4(1), 1.0, 1.0, importance);
    s.disperses = false;
    s.phase = medium_phase(around.medium);
    s.extinction = medium_mean_extinction(around.medium, position);
    return s;
}

Scattering phase_pair(ScatteringPoint s, vec3 wi) {
    Spectrum value = phase_value(s.phase, wi.z);
    float pdf = lane_mean(value);
    Scattering result = scattering_of(SurfacePair(value, pdf, pdf));
    keep_mueller(result.mueller, phase_mueller(s.phase, s.context.importance ? s.wo : wi, s.context.importance ? wi : s.wo));
    return result;
}

BsdfSample phase_event(ScatteringPoint s, vec2 u) {
    float cosine = phase_sample(s.phase, u.x);
    vec2 around = cos_sin_turns(u.y) * sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    Spectrum value = phase_value(s.phase, cosine);
    float pdf = lane_mean(value);
    return BsdfSample(vec3(around, cosine), value / max(pdf, 1e-30), pdf, EVENT_TRANSMIT);
}

bool scatters_rays(uint medium) { return medium_scatters(medium); }

// Takes the path through its medium, to hit.t or to where it scatters before: then that is where.
bool scatter_within(inout Path path, inout Hit hit, MediumRay ray) {
    vec2 u = sample_2d(path.random);
    FreePath free = medium_free_path(path.around.medium, ray, path.throughput, u, sample_seed(path.random));
    path.throughput *= free.weight;
    lessen_passage(path, free.passage);
    // Never on the other side of what it would have hit, by rounding.
    if (free.scatters) hit.t = min(free.distance, max(0.0, shadow_t_max(path.origin, hit.t)));
    return free.scatters;
}
#else
#define in_volume(s) false
#define is_in_volume(v) false
#define volume_point(position, direction) SurfacePoint(vec3(0), vec3(0), vec3(0), vec3(0), vec4(0), vec2(0), vec2(0), vec4(0), 0u, 0u)
#define phase_pair(s, wi) no_scattering()
#define phase_event(s, u) no_bsdf_sample()
#define scatters_rays(medium) false
#define scatter_within(path, hit, ray) false
ScatteringPoint volume_scattering_point(vec3 position, vec3 direction, Surroundings around, bool importance) {
    ScatteringPoint s;
    return s;
}
#endif
