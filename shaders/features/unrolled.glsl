// How rays find what they hit: scenes of few primitives come as straight code (host/geometry/unrolled_traversal.h), others as a
// hierarchy that is walked. Either way there are find_hit(), find_occlusion(), and a Traversal that is begun and stepped until it is
// done, for kernels whose lanes go on with the next ray as one ends.
#include "features/elements.glsl"
#include "features/hit_order.glsl"

#if HAS_UNROLLED_TRAVERSAL
#include "generated/unrolled_traversal.glsl"

struct Traversal {
    Hit hit;
};
void traversal_begin(out Traversal w, vec3 origin, vec3 direction, float t_max, const bool any_hit) {
    if (any_hit)
        w.hit = Hit(t_max, vec2(0), find_occlusion(origin, direction, t_max) ? 0u : NO_RECORD, NO_RECORD);
    else
        w.hit = find_hit(origin, direction, t_max);
}
#define traversal_end(w)
#define is_done(w) true
#define traversal_step(w, any_hit)
#else
#include "lib/hierarchy_walk.glsl"
#endif
