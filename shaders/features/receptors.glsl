// Receptors: planes at which receivers catch light. Backward paths start at theirs as if they had come to a white diffuse surface (or
// one of small bodies: features/receptor_shapes.glsl), so
// that lights are sampled there and vertices connected; forward rays leave light there on their way, which goes on as if nothing
// had happened. Nothing merges at receptors, since no vertices are stored there.
//
// Where a receptor coincides with a surface it lies on top: a forward ray is caught a margin before.
#include "features/bending.glsl"
#include "features/surface_meters.glsl"
#include "features/views.glsl"
#include "lib/forward_pass.glsl"
#include "lib/frames.glsl"
#include "lib/hits.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

#if HAS_RECEPTORS
float receptor_margin(vec3 origin, float t) {
    vec3 a = abs(origin);
    return 16.0 * EPSILON * (max(a.x, max(a.y, a.z)) + t);
}

#if FORWARD
// The view whose receptor the ray meets next, and where.
uint next_receptor(Path path, out ReceptorHit nearest) {
    uint view = 0u;
    nearest = no_receptor_hit();
    for (uint v = 0u; v < VIEW_COUNT; ++v) {
        if ((path.flags >> (PATH_PASSED_SHIFT + v) & 1u) != 0u) continue;
        if (!same_element(path, views[v])) continue;
        ReceptorHit r = receiver_receptor(views[v].receiver, path.origin, path.direction);
        if (!(r.t < nearest.t)) continue;
        nearest = r;
        view = v;
    }
    return view;
}
// The view that has caught the path.
uint catching_view(Path path, Hit hit) {
    if (hit.primitive != NO_RECORD) return watching_view(path, hit);
    ReceptorHit r;
    return next_receptor(path, r);
}
#endif

// Readies the path for its next ray and returns where that ends at the latest.
float begin_ray(inout Path path) {
    if (leaves_watched(path)) return 0.0;
    float end = begin_step(path);
#if FORWARD
    path.flags &= ~PATH_TO_RECEPTOR;
    ReceptorHit r;
    next_receptor(path, r);
    if (!(r.t < end)) return end;
    path.flags |= PATH_TO_RECEPTOR;
    return max(r.t - receptor_margin(path.origin, r.t), 0.0);
#else
    return (path.flags & PATH_TO_RECEPTOR) != 0u ? 0.0 : end;
#endif
}

bool is_caught(Path path, Hit hit, bool scatters) {
    if (scatters) return false;
    if (hit.primitive != NO_RECORD) return watching_view(path, hit) != NO_RECORD;
    return (path.flags & PATH_TO_RECEPTOR) != 0u;
}

// Where the path is caught.
SurfacePoint receptor_point(Path path, Hit hit) {
    SurfacePoint p;
    p.position = path.origin;
    p.error = vec3(0);
    p.geometric_normal = -path.direction;
#if FORWARD
    ReceptorHit r;
    uint view = next_receptor(path, r);
    uint shape = r.shape;
    p.position += r.t * path.direction;
    p.geometric_normal = r.normal;
    if (HAS_SURFACE_METERS == 1)
        if (hit.primitive != NO_RECORD) {
            p = locate(hit, path.origin, path.direction);
            if (dot(p.geometric_normal, path.direction) > 0.0) p.geometric_normal = -p.geometric_normal;
        }
#else
    uint shape = path.flags >> PATH_SHAPE_SHIFT & 7u, view = path.flags >> PATH_VIEW_SHIFT;
#endif
    p.shading_normal = p.geometric_normal;
    p.error = max(p.error, vec3(receptor_margin(p.position, 0.0)));
    p.tangent = vec4(frame_around(p.geometric_normal)[0], 1.0);
    p.color = vec4(1);
    p.uv0 = p.uv1 = vec2(0);
    if (HAS_RECEPTOR_SHAPES == 1 && shape == SHAPE_WINDOW) place_window(p, receiver_pupil(views[view].receiver));
    p.material = RECEPTOR_MATERIAL + (HAS_RECEPTOR_SHAPES == 1 ? shape : 0u);
    p.light = NO_RECORD;
    return p;
}

void leave_receptor(inout Path path) { path.flags &= ((1u << PATH_PASSED_SHIFT) - 1u) & ~PATH_TO_RECEPTOR; }

#if FORWARD
// In vacuum the same ray goes on: what lies right behind the receptor it meets as it would have without. What it has crossed of a
// medium lies behind it: there it goes on from so little before that a surface at the same place is still apart from it.
void pass_receptor(inout Path path, SurfacePoint p, Hit hit) {
    path.flags |= 1u << (PATH_PASSED_SHIFT + catching_view(path, hit));
    if (path.around.medium == NO_RECORD) return;
    float way = distance(p.position, path.origin);
    float height = hit.primitive == NO_RECORD ? 2.0 * receptor_margin(p.position, way) + 2e-6 * SCENE_RADIUS : height_above(p, hit);
    float cosine = max(abs(dot(path.direction, p.geometric_normal)), 1e-3);
    path.origin = p.position - min(height / cosine, 0.5 * way) * path.direction;
}

// The end of an event at a receptor: the shadow ray has no way to go, the path goes on. A macro, since it returns.
#define RETURN_IF_CAUGHT(a, path, hit, shadow) \
    if (a.caught) {                            \
        shadow.t_max = ALREADY_THERE;          \
        pass_receptor(path, a.p, hit);         \
        return true;                           \
    }
#endif
bool goes_to_receptor(Path path) { return (path.flags & PATH_TO_RECEPTOR) != 0u; }

#else
#define RECEPTOR_MATERIAL 0u
#define RETURN_IF_CAUGHT(a, path, hit, shadow)
#define goes_to_receptor(path) false
#define begin_ray(path) begin_step(path)
#define is_caught(path, hit, scatters) false
#define receptor_point(path, hit) volume_point(vec3(0), vec3(0))
#define leave_receptor(path)
#define catching_view(path, hit) 0u
#endif
