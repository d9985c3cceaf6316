// A hit made ready to scatter: the shading frame, the media on both sides, and the checks that keep shading normals from
// letting light through. Classes of SurfaceOptics see none of this. A point within a medium is made to look like one, so that
// what follows need not tell them apart.
#include "features/dispersion.glsl"
#include "features/faces.glsl"
#include "features/normal_maps.glsl"
#include "features/receptor_shapes.glsl"
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/accurate_math.glsl"
#include "lib/frames.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"

struct ScatteringPoint {
    mat3 frame;           // columns: tangent, bitangent, normal to scatter about, in world space; within a medium the last is the
                          // direction of the ray
    vec3 normal;          // geometric, unit
    vec3 shading_normal;  // unit; that of the frame unless it is flat
    vec3 wo;              // towards where the ray came from, in the frame
    uint surface;         // RecordRef; NO_RECORD within a medium, as is the material
    uint material;
    Crossing sides;       // what is on the side of the normal and below it
    SurfaceContext context;
    bool disperses;       // wavelengths part here
    MEMBER_IF(HAS_CRYSTALS, uint mode;)  // of the ray that comes, within a crystal
    MEMBER_IF(HAS_LIGHT_LAYERS, uint object;)  // into layer_events; of surfaces
    uint phase;           // RecordRef; NO_RECORD at a surface
    float extinction;     // of an average lane, 1/m
};
#include "features/volumes.glsl"
#include "features/crystals.glsl"

// Do the two normals agree on which side of the surface a direction is?
bool is_consistent(ScatteringPoint s, vec3 direction) {
    return in_volume(s) || dot(direction, s.shading_normal) * dot(direction, s.normal) > 0.0;
}

// … and the frame that s now has, in which the direction is `local`?
bool is_on_one_side(ScatteringPoint s, vec3 direction, vec3 local) { return in_volume(s) || local.z * dot(direction, s.normal) > 0.0; }

// `direction` is that of the ray that hit p. The frame is that of the shading normal.
ScatteringPoint shaded_point(SurfacePoint p, vec3 direction, Crossing sides, bool importance) {
    Material m = materials[p.material];
    ScatteringPoint s;
    s.normal = p.geometric_normal;
    s.surface = m.surface;
    s.material = p.material;
    mat3 unbent = mesh_frame(p);
    s.frame = bent_frame(unbent, p, m);
    s.shading_normal = s.frame[2];
    s.wo = -direction * s.frame;
    s.sides = sides;
    s.context = unbent_context(p.uv0, p.uv1, p.color, 1.0, 1.0, importance);
    keep_mesh_frame(s.context, s.frame, unbent);
    keep_level(s.context, s.normal * s.frame);
    keep_mode(s, MODE_NONE);
    s.phase = NO_RECORD;
    s.extinction = 0.0;
    s.disperses = false;
    if (HAS_INTERFACES == 1) {
        Spectrum above = medium_spectral_ior(sides.above.medium, p.position);
        Spectrum below = medium_spectral_ior(sides.below.medium, p.position);
        s.context.ior_above = of_hero(above);
        s.context.ior_below = of_hero(below);
        bool separates = (m.flags & MATERIAL_SEPARATES_MEDIA) != 0u;
        s.disperses = separates && !(has_one_index(above) && has_one_index(below));
    }
    return s;
}

void flatten(inout ScatteringPoint s, vec3 direction) {
    s.frame = frame_around(s.normal);
    s.wo = -direction * s.frame;
    s.context.mesh_frame = mat3(1);
    keep_level(s.context, vec3(0, 0, 1));
}

// Of a backward ray. Seen from a side that the shading normal faces away from, the surface is taken as flat.
ScatteringPoint scattering_point(SurfacePoint p, vec3 direction, Crossing sides) {
    ScatteringPoint s = shaded_point(p, direction, sides, false);
    if (!is_consistent(s, -direction)) flatten(s, direction);
    return s;
}

// Of the ray that a kernel traces; forward rays see to their shading normals themselves.
ScatteringPoint met_point(SurfacePoint p, vec3 direction, Crossing sides) {
#if FORWARD
    return shaded_point(p, direction, sides, true);
#else
    return scattering_point(p, direction, sides);
#endif
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
// as bright by forward rays as by backward ones. With features/shading_normals.glsl what is scattered holds the cosine of the light
// about the shading normal already.
float adjoint_correction(ScatteringPoint s, vec3 light_direction, vec3 direction) {
    vec3 n = s.frame[2];
    if (in_volume(s)) return 1.0;
    float denominator = abs(dot(light_direction, s.normal) * dot(direction, n));
    float light = HAS_SHADING_NORMALS == 1 ? 1.0 : dot(light_direction, n);
    return denominator > 0.0 ? abs(light * dot(direction, s.normal)) / denominator : 0.0;
}

// What a ray is in after it leaves in a world direction.
Surroundings surroundings_towards(ScatteringPoint s, vec3 direction) {
    if (dot(direction, s.normal) > 0.0) return s.sides.above;
    return s.sides.below;
}

// What of the rays along a direction meets the point, per area or volume: the cosine, or the extinction coefficient.
float catch_density(ScatteringPoint s, vec3 direction) {
    return in_volume(s) ? s.extinction : abs(dot(direction, s.normal));
}

// Scattering at a point of either kind, with directions in its frame (interfaces/surface_optics.glsl).

bool is_delta_point(ScatteringPoint s) {
    return !in_volume(s) && (meets_crystal(s.surface, s.sides) || surface_is_delta(s.surface, s.context));
}

// Of a surface of any class, in a kernel for one class too.
Scattering scattering_pair(ScatteringPoint s, vec3 wi) {
    if (in_volume(s)) return phase_pair(s, wi);
    if (is_shaped(s.material)) return shape_pair(shape_of(s.material), s.context, s.wo, wi);
    return surface_pair(s.surface, s.context, s.wo, wi);
}

// See surface_event(): scattering towards one or two directions, and a sample.
SurfaceEvent scattering_event(ScatteringPoint s, vec3 wi, vec3 second, uint asked, vec3 u) {
    SurfaceEvent event = surface_event(s.surface, s.context, s.wo, wi, second, asked, u);
    if (in_volume(s)) {
        event.pair = phase_pair(s, wi);
        event.second = phase_pair(s, second);
        event.next = phase_event(s, u.xy);
        event.next_pdf_reverse = event.next.pdf;
        keep_mueller(event.next_mueller, phase_pair(s, event.next.wi).mueller);
    }
    if (is_shaped(s.material)) event = shape_event(shape_of(s.material), s.context, s.wo, wi, second, u);
    keep_mode(event, s.mode);
    if (meets_crystal(s.surface, s.sides)) cross_crystal(event, s, u.z);
    return event;
}
