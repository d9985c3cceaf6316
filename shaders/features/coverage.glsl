// Surfaces that emit and of which a part is not there, because of alpha: that part emits nothing (glTF 2.0, section 3.9.4: alpha
// covers all of a material). How much is there the classes know.
#include "features/defaults.glsl"

#if HAS_COVERAGE
#include "interfaces/surface_optics.glsl"
#include "lib/materials.glsl"
#include "lib/primitives.glsl"

// Part that is there of a point of a primitive.
float coverage_at(uint primitive, vec3 position, vec2 uv0, vec2 uv1) {
    Triangle r = primitives[primitive];
    vec4 color = vec4(1);
    if (is_triangle(r.attributes)) color = triangle_color(r, position);
    return surface_coverage(materials[r.material].surface, unbent_context(uv0, uv1, color, 1.0, 1.0, false));
}

#define cover(radiance, primitive, position, uv0, uv1) radiance *= coverage_at(primitive, position, uv0, uv1)
#else
#define cover(radiance, primitive, position, uv0, uv1)
#endif
