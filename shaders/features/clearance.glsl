// How far above a triangle rays start that are sure to hit it, m: the straight code for few primitives (features/unrolled.glsl) asks for
// 8e-7 of the greatest coordinate, which is within the scene's radius (host/geometry/unrolled_traversal.cpp).
#include "features/defaults.glsl"
#include "lib/bvh.glsl"

#if HAS_UNROLLED_TRAVERSAL
float clearance(Triangle r, vec3 point) { return triangle_clearance(r, point) + 2e-6 * SCENE_RADIUS; }
#else
float clearance(Triangle r, vec3 point) { return triangle_clearance(r, point); }
#endif
