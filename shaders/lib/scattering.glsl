// A hit made ready to scatter: the shading frame, the media on both sides, and the checks that keep shading normals from
// letting light through. Classes of SurfaceOptics see none of this. A point within a medium is made to look like one, so that
// what follows need not tell them apart.
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/accurate_math.glsl"
#include "lib/frames.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"
#include "lib/faces.glsl"

struct ScatteringPoint {
    mat3 frame;           // columns: tangent, bitangent, normal to scatter about, in world space; within a medium the last is the
                          // direction of the ray
    vec3 normal;          // geometric, unit
    vec3 shading_normal;  // unit; that of the frame unless it is flat
    vec3 wo;              // towards where the ray came from, in the frame
    uint surface;         // RecordRef; NO_RECORD within a medium, as is the material
    uint material;
    uint medium_above;    // media on the side of the normal and below it
    uint medium_below;
#if HAS_PRIORITIES
    Bodies bodies_above;
    Bodies bodies_below;
#endif
    SurfaceContext context;
#if HAS_DISPERSION
    bool disperses;       // wavelengths part here
#endif
#if HAS_SCATTERING
    uint phase;           // RecordRef; NO_RECORD at a surface
    float extinction;     // of an average lane, 1/m
#endif
};

bool in_volume(ScatteringPoint s) {
#if HAS_SCATTERING
    return s.phase != NO_RECORD;
#else
    return false;
#endif
}

// Around the interpolated normal.
mat3 mesh_frame(SurfacePoint p) {
#if HAS_VERTEX_ATTRIBUTES || defined(SURFACES_HAVE_TANGENTS)
    return frame_along(p.shading_normal, p.tangent.xyz, p.tangent.w);
#else
    return frame_around(p.shading_normal);
#endif
}

#if HAS_NORMAL_MAPS
// That frame, bent by a normal map where there is one.
mat3 bent_frame(mat3 frame, SurfacePoint p, Material m) {
    if (m.normal_texture.index == NO_RECORD) return frame;
    vec3 t = texture_value(m.normal_texture, p.uv0, p.uv1).xyz * 2.0 - 1.0;
    t.xy *= m.normal_scale;
    return frame_along(normalize(frame * t), frame[0], p.tangent.w);
}
#endif

// Do the two normals agree on which side of the surface a direction is?
bool is_consistent(ScatteringPoint s, vec3 direction) {
    return in_volume(s) || dot(direction, s.shading_normal) * dot(direction, s.normal) > 0.0;
}

// … and the frame that s now has, in which the direction is `local`?
bool is_on_one_side(ScatteringPoint s, vec3 direction, vec3 local) { return in_volume(s) || local.z * dot(direction, s.normal) > 0.0; }

// `direction` is that of the ray that hit p, `medium` the one it came through; of a body with a priority the one around it. The
// frame is that of the shading normal.
ScatteringPoint shaded_point(SurfacePoint p, vec3 direction, uint medium, bool importance) {
    Material m = materials[p.material];
    ScatteringPoint s;
    s.normal = p.geometric_normal;
    s.surface = m.surface;
    s.material = p.material;
    s.frame = mesh_frame(p);
#if HAS_NORMAL_MAPS
    mat3 unbent = s.frame;
    s.frame = bent_frame(unbent, p, m);
#endif
    s.shading_normal = s.frame[2];
    s.wo = -direction * s.frame;
    bool separates = (m.flags & MATERIAL_SEPARATES_MEDIA) != 0u;
#if HAS_PRIORITIES
    s.medium_above = separates && m.body == NO_RECORD ? m.outside : medium;
#else
    s.medium_above = separates ? m.outside : medium;
#endif
    s.medium_below = separates ? m.inside : medium;
    s.context = unbent_context(p.uv0, p.uv1, p.color, 1.0, 1.0, importance);
#if HAS_NORMAL_MAPS && defined(SURFACES_USE_MESH_FRAME)
    s.context.mesh_frame = transpose(s.frame) * unbent;
#endif
#if HAS_SCATTERING
    s.phase = NO_RECORD;
    s.extinction = 0.0;
#endif
#if HAS_INTERFACES
    Spectrum above = medium_spectral_ior(s.medium_above, p.position), below = medium_spectral_ior(s.medium_below, p.position);
    s.context.ior_above = above.x;
    s.context.ior_below = below.x;
#if HAS_DISPERSION
    s.disperses = separates && (above != Spectrum(above.x) || below != Spectrum(below.x));
#endif
#endif
    return s;
}

void flatten(inout ScatteringPoint s, vec3 direction) {
    s.frame = frame_around(s.normal);
    s.wo = -direction * s.frame;
#if HAS_NORMAL_MAPS
    s.context.mesh_frame = mat3(1);
#endif
}

// Of a backward ray. Seen from a side that the shading normal faces away from, the surface is taken as flat.
ScatteringPoint scattering_point(SurfacePoint p, vec3 direction, uint medium) {
    ScatteringPoint s = shaded_point(p, direction, medium, false);
    if (!is_consistent(s, -direction)) flatten(s, direction);
    return s;
}

// Forward rays must scatter into every direction as they would be seen from there: about the shading normal into
// directions where both normals agree, about the geometric one into the others. Which of the two is drawn; this is the
// probability of the flat one for light from a direction (towards it). Light that arrives where the normals do not agree has only
// the flat one.
float flat_probability(ScatteringPoint s, vec3 light_direction) {
    return is_consistent(s, light_direction) ? min(distance(s.shading_normal, s.normal) * INV_PI, 0.5) : 1.0;
}

// The probability of the frame in which light from a direction is scattered into `direction`.
float frame_probability(ScatteringPoint s, vec3 light_direction, vec3 direction) {
    float flat_part = flat_probability(s, light_direction);
    return is_consistent(s, direction) ? 1.0 - flat_part : flat_part;
}

// Whether light is scattered into `direction` in the frame that s now has.
bool is_seen_from(ScatteringPoint s, vec3 direction) {
    bool is_flat = any(notEqual(s.frame[2], s.shading_normal));
    return is_flat != is_consistent(s, direction) || all(equal(s.shading_normal, s.normal));
}

// What a shading normal does to light that goes on (Veach 1997, section 5.3.2): with it, a surface seen from `direction` is
// as bright by forward rays as by backward ones.
float adjoint_correction(ScatteringPoint s, vec3 light_direction, vec3 direction) {
    vec3 n = s.frame[2];
    if (in_volume(s)) return 1.0;
    float denominator = abs(dot(light_direction, s.normal) * dot(direction, n));
    return denominator > 0.0 ? abs(dot(light_direction, n) * dot(direction, s.normal)) / denominator : 0.0;
}

// The medium that a ray is in after it leaves in a world direction.
uint scattering_medium(ScatteringPoint s, vec3 direction) {
    return dot(direction, s.normal) > 0.0 ? s.medium_above : s.medium_below;
}

#if HAS_PRIORITIES
void set_bodies(inout ScatteringPoint s, Crossing c, vec3 direction) {
    bool leaves = dot(direction, s.normal) > 0.0;
    s.bodies_above = leaves ? c.after : c.before;
    s.bodies_below = leaves ? c.before : c.after;
}

// Those that a ray is inside after it leaves in a world direction.
Bodies scattering_bodies(ScatteringPoint s, vec3 direction) {
    return dot(direction, s.normal) > 0.0 ? s.bodies_above : s.bodies_below;
}
#endif

// What of the rays along a direction meets the point, per area or volume: the cosine, or the extinction coefficient.
float catch_density(ScatteringPoint s, vec3 direction) {
#if HAS_SCATTERING
    if (in_volume(s)) return s.extinction;
#endif
    return abs(dot(direction, s.normal));
}

#if HAS_SCATTERING
// Where a ray through `medium` scatters, as if it had hit something there.
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

ScatteringPoint volume_scattering_point(vec3 position, vec3 direction, uint medium, bool importance) {
    ScatteringPoint s;
    s.frame = frame_around(direction);
    s.normal = s.shading_normal = direction;
    s.wo = vec3(0, 0, -1);
    s.surface = s.material = NO_RECORD;
    s.medium_above = s.medium_below = medium;
    s.context = unbent_context(vec2(0), vec2(0), vec4(1), 1.0, 1.0, importance);
#if HAS_DISPERSION
    s.disperses = false;
#endif
    s.phase = medium_phase(medium);
    s.extinction = medium_mean_extinction(medium, position);
    return s;
}
#endif

// Scattering at a point of either kind, with directions in its frame (interfaces/surface_optics.glsl).

bool is_delta_point(ScatteringPoint s) { return !in_volume(s) && surface_is_delta(s.surface, s.context); }

#if HAS_SCATTERING
SurfacePair phase_pair(ScatteringPoint s, vec3 wi) {
    float value = phase_value(s.phase, wi.z);
    return SurfacePair(Spectrum(value), value, value);
}

BsdfSample phase_event(ScatteringPoint s, vec2 u) {
    float cosine = phase_sample(s.phase, u.x);
    vec2 around = cos_sin_turns(u.y) * sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    return BsdfSample(vec3(around, cosine), Spectrum(1), phase_value(s.phase, cosine), EVENT_TRANSMIT);
}
#endif

// Of a surface of any class, in a kernel for one class too.
SurfacePair scattering_pair(ScatteringPoint s, vec3 wi) {
#if HAS_SCATTERING
    if (in_volume(s)) return phase_pair(s, wi);
#endif
    return surface_pair(s.surface, s.context, s.wo, wi);
}

// See surface_event(): scattering towards one or two directions, and a sample.
SurfaceEvent scattering_event(ScatteringPoint s, vec3 wi, vec3 second, uint asked, vec3 u) {
    SurfaceEvent event = surface_event(s.surface, s.context, s.wo, wi, second, asked, u);
#if HAS_SCATTERING
    if (in_volume(s)) {
        event.pair = phase_pair(s, wi);
        event.second = phase_pair(s, second);
        event.next = phase_event(s, u.xy);
        event.next_pdf_reverse = event.next.pdf;
    }
#endif
    return event;
}
