// A hit made ready to scatter: the shading frame, the media on both sides, and the checks that keep shading normals from
// letting light through. Classes of SurfaceOptics see none of this.
#include "interfaces/medium_optics.glsl"
#include "interfaces/surface_optics.glsl"
#include "lib/frames.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"

struct ScatteringPoint {
    mat3 frame;           // columns: tangent, bitangent, normal to scatter about, in world space
    vec3 normal;          // geometric, unit
    vec3 shading_normal;  // unit; that of the frame unless it is flat
    vec3 wo;              // towards where the ray came from, in the frame
    uint surface;         // RecordRef
    uint material;
    uint medium_above;    // media on the side of the normal and below it
    uint medium_below;
    SurfaceContext context;
#if HAS_DISPERSION
    bool disperses;       // wavelengths part here
#endif
};

// The shading normal, bent by a normal map where there is one.
mat3 shading_frame(SurfacePoint p, Material m) {
    vec3 normal = p.shading_normal;
#if HAS_VERTEX_ATTRIBUTES || defined(SURFACES_HAVE_TANGENTS)
    mat3 frame = frame_along(normal, p.tangent.xyz, p.tangent.w);
#else
    mat3 frame = frame_around(normal);
#endif
#if HAS_NORMAL_MAPS
    if (m.normal_texture.index != NO_RECORD) {
        vec3 t = texture_value(m.normal_texture, p.uv0, p.uv1).xyz * 2.0 - 1.0;
        t.xy *= m.normal_scale;
        normal = normalize(frame * t);
        frame = frame_along(normal, frame[0], p.tangent.w);
    }
#endif
    return frame;
}

// Do the two normals agree on which side of the surface a direction is?
bool is_consistent(ScatteringPoint s, vec3 direction) { return dot(direction, s.shading_normal) * dot(direction, s.normal) > 0.0; }

// `direction` is that of the ray that hit p, `medium` the one it came through. The frame is that of the shading normal.
ScatteringPoint shaded_point(SurfacePoint p, vec3 direction, uint medium, bool importance) {
    Material m = materials[p.material];
    ScatteringPoint s;
    s.normal = p.geometric_normal;
    s.surface = m.surface;
    s.material = p.material;
    s.frame = shading_frame(p, m);
    s.shading_normal = s.frame[2];
    s.wo = -direction * s.frame;
    bool separates = (m.flags & MATERIAL_SEPARATES_MEDIA) != 0u;
    s.medium_above = separates ? m.outside : medium;
    s.medium_below = separates ? m.inside : medium;
    s.context = SurfaceContext(p.uv0, p.uv1, p.color, 1.0, 1.0, importance);
#if HAS_INTERFACES
    Spectrum above = medium_spectral_ior(s.medium_above), below = medium_spectral_ior(s.medium_below);
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
    float denominator = abs(dot(light_direction, s.normal) * dot(direction, n));
    return denominator > 0.0 ? abs(dot(light_direction, n) * dot(direction, s.normal)) / denominator : 0.0;
}

// The medium that a ray is in after it leaves in a world direction.
uint scattering_medium(ScatteringPoint s, vec3 direction) {
    return dot(direction, s.normal) > 0.0 ? s.medium_above : s.medium_below;
}
