// The boundaries of optical elements (features/elements.glsl): what rays meet there, and how paths pass them.
//
// For light sampling, connections and their weights a boundary is a smooth surface that light has passed, so that an element is an
// event at which nothing is connected, whatever happens within; the densities of its events stay those of paths both ways, so
// the weights of what lies behind are right. Within, paths connect to the lamps and receivers of the same element; they do
// not meet each other there. Light that comes out merges, as behind a lens.
#include "features/beams.glsl"
#include "features/bending.glsl"
#include "features/elements.glsl"
#include "features/polarization.glsl"
#include "lib/path.glsl"
#include "lib/primitives.glsl"

#if HAS_ELEMENTS
bool meets_boundary(Hit hit) { return is_boundary(primitives[hit.primitive].attributes); }

// Has the ray been in the element from the start?
bool starts_within(Hit hit, SurfacePoint p, vec3 direction) {
    return attributes_index(primitives[hit.primitive].attributes) != OWN_BOUNDARY && dot(direction, p.geometric_normal) > 0.0;
}

// By how much rays have gone on from surfaces that lie on a boundary, at most: they begin so much further back behind it.
float boundary_margin(vec3 origin, uint element) {
    vec3 a = abs(origin) + abs(elements[element].parent_from_local[3]);
    return 64.0 * EPSILON * max(a.x, max(a.y, a.z));
}

// A ray passes the boundary at p. It goes on from so little before that it meets, in the other frame, what lies on the boundary.
// Returns the way to that frame; the origin is that in the old one.
mat4x3 cross_boundary(inout vec3 origin, vec3 direction, inout uint location, Hit hit, SurfacePoint p) {
    uint leads_to = attributes_index(primitives[hit.primitive].attributes);
    bool leaves = leads_to == OWN_BOUNDARY;
    uint element = leaves ? element_at(location) : leads_to;
    if (starts_within(hit, p, direction)) {
        origin -= boundary_margin(origin, element) * direction;
    } else {
        vec3 a = abs(p.position) + abs(origin) + abs(elements[element].parent_from_local[3]), n = p.geometric_normal;
        float margin = dot(abs(n), p.error) + 32.0 * EPSILON * max(a.x, max(a.y, a.z));
        margin /= max(abs(dot(direction, n)), 1e-3);
        origin += max(dot(p.position - origin, direction) - margin, 0.0) * direction;
    }
    location = leaves ? element | JUST_LEFT : element;
    if (leaves) return elements[element].parent_from_local;
    return elements[element].local_from_parent;
}

// … of a ray that is no path.
void go_through_boundary(inout vec3 origin, inout vec3 direction, inout uint location, Hit hit, SurfacePoint p) {
    mat4x3 m = cross_boundary(origin, direction, location, hit, p);
    origin = m * vec4(origin, 1.0);
    direction = normalize(mat3(m) * direction);
}

void move_to_frame(inout Path path, mat4x3 m) {
    vec3 direction = normalize(mat3(m) * path.direction);
    turn_frame(path, mat3(m), direction);
    path.origin = m * vec4(path.origin, 1.0);
    path.direction = direction;
#if BEAMS && FORWARD
    if (comes_from_beam(path)) path.pending /= max(passage_of(path), 1e-30);
#endif
    path.flags &= ~PATH_AFTER_BEAM;
    forget_event(path);
}

// `carried`: by the path before its ray.
void pass_boundary(inout Path path, Spectrum carried, Hit hit, SurfacePoint p) {
    if (starts_within(hit, p, path.direction)) path.throughput = carried;
    move_to_frame(path, cross_boundary(path.origin, path.direction, path.location, hit, p));
}

// The ray has found no way out: it is outside already, since it has left a surface that lies on the boundary, or by rounding at an
// edge.
void miss_boundary(inout Path path) {
    uint element = element_at(path.location);
    path.origin -= boundary_margin(path.origin, element) * path.direction;
    move_to_frame(path, elements[element].parent_from_local);
    path.location = element | JUST_LEFT | LEFT_BY_CHANCE;
}

bool count_boundary(inout Path path, inout Counters counters) {
    if (++path.depth < MAX_DEPTH) return true;
    cut_path(path, counters);
    return false;
}
#else
#define meets_boundary(hit) false
#define starts_within(hit, p, direction) false
#define go_through_boundary(origin, direction, location, hit, p)
#define pass_boundary(path, carried, hit, p)
#define miss_boundary(path)
#define count_boundary(path, counters) true
#endif
