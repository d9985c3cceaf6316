// A rectangle in the xy plane around the origin, facing +z, with small bumps or dents of one shape in cells side by side: the
// dots of a light guide, an array of lenses, a prism film. Which cell holds one, where and how large follows from the cell's number,
// so that any number of them takes no memory. Cells lie around the middle; what is left of the rectangle beside them is plain.
// Ridges are open at their ends. Seen from +z u runs to the right (+x), v down (-y).
//
// A ray walks through the cells that it passes while it is within the height of the shapes (Amanatides & Woo 1987, row by row);
// what it costs does not depend on how many there are. Places are relative to the middle of a cell, as differences of coordinates, so
// that a dot keeps its shape where it stands far from the middle of a sheet.
//
// Example:
//     {"nodes": [{"name": "microstructure", "translation": [0, 0.4, 0], "rotation": [-0.2588, 0, 0, 0.9659], "extensions": {"ETD_optics": {
//         "geometry": {"class": "microstructure", "size": [1.1, 0.7], "pitch": [0.1, 0.1], "radius": 0.04, "depth": 0.03, "material": 1}}}}]}
#include "features/textures.glsl"
#include "lib/hash.glsl"

struct Microstructure {
    vec2 size;        //: required in (0, inf) m. Width along x and height along y.
    vec2 pitch;       //: required in (0, inf) m. Of the cells.
    uint shape;       //: "dome" of dome|cone|prism|groove|lens. A cap of a sphere, a cone, a pyramid of four sides; along all of y: a ridge, a cap of a cylinder.
    float radius;     //: required in (0, inf) m. Of the foot: half its width. An element stays within its cell.
    float depth;      //: required in (0, inf) m. Height of a bump; of a dome or lens at most the radius.
    uint operation;   //: "add" of add|remove. Bumps towards +z, or dents.
    uint placement;   //: "grid" of grid|staggered|jittered. In rows; every other row shifted by half a cell; anywhere within the cell.
    float density;    //: 1 in [0, 1]. The share of the cells that hold an element.
    TextureRef density_texture;  //: none data. Red multiplies density, at the middle of each cell.
    float spread;     //: 0 in [0, 1). Elements are smaller than radius and depth by up to this share.
    float turn;       //: 0 in (-inf, inf) rad. Of pyramids, about z.
    uint seed;        //: 0 in [0, 4294967295]. Which cells, where and how large.
};
#define microstructure_NEVER_EMITS

const uint MICRO_DOME = 0u;
const uint MICRO_CONE = 1u;
const uint MICRO_PRISM = 2u;
const uint MICRO_GROOVE = 3u;
const uint MICRO_LENS = 4u;
const uint MICRO_STAGGERED = 1u;
const uint MICRO_JITTERED = 2u;

// An element, in its cell.
struct MicroElement {
    bool exists;
    vec2 center;  // m
    float scale;
};

bool microstructure_runs_along(Microstructure r) { return r.shape == MICRO_GROOVE || r.shape == MICRO_LENS; }

// Ridges stand in one row.
Microstructure microstructure_in_rows(Microstructure r) {
    if (!microstructure_runs_along(r)) return r;
    r.pitch.y = r.size.y;
    if (r.placement == MICRO_STAGGERED) r.placement = 0u;
    return r;
}

ivec2 microstructure_cells(Microstructure r) {
    vec2 cells = r.size / r.pitch;
    if (r.placement == MICRO_STAGGERED) cells.x -= 0.5;
    return max(ivec2(cells + 1e-3), ivec2(0));
}

// Of a row: where its first cell begins.
float microstructure_row_start(Microstructure r, ivec2 cells, int row) {
    float shift = r.placement != MICRO_STAGGERED ? 0.0 : (row & 1) != 0 ? 0.25 : -0.25;
    return (shift - 0.5 * float(cells.x)) * r.pitch.x;
}
int microstructure_row(Microstructure r, ivec2 cells, float y) { return int(floor(y / r.pitch.y + 0.5 * float(cells.y))); }
int microstructure_column(Microstructure r, ivec2 cells, int row, float x) {
    return int(floor((x - microstructure_row_start(r, cells, row)) / r.pitch.x));
}

MicroElement microstructure_element(Microstructure r, ivec2 cells, ivec2 cell) {
    MicroElement e;
    e.exists = all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, cells));
    e.center = vec2(microstructure_row_start(r, cells, cell.y) + (float(cell.x) + 0.5) * r.pitch.x,
                    (float(cell.y) + 0.5 - 0.5 * float(cells.y)) * r.pitch.y);
    vec2 uv = 0.5 + vec2(e.center.x, -e.center.y) / r.size;
    uvec3 hash = hash_3d(uvec3(cell, r.seed)), more = hash_3d(hash);
    e.exists = e.exists && float(hash.z >> 8) * (1.0 / 16777216.0) < r.density * texture_value(r.density_texture, uv, uv).r;
    e.scale = 1.0 - r.spread * float(more.x >> 8) * (1.0 / 16777216.0);
    if (r.placement == MICRO_JITTERED) {
        vec2 room = max(r.pitch - 2.0 * r.radius, 0.0);
        e.center += (vec2(hash.xy >> 8) * (1.0 / 16777216.0) - 0.5) * room;
    }
    return e;
}

// To the axes of an element, and back.
vec2 microstructure_turned(Microstructure r, vec2 v, float way) {
    if (r.shape != MICRO_PRISM) return v;
    float c = cos(r.turn), s = way * sin(r.turn);
    return vec2(c * v.x + s * v.y, c * v.y - s * v.x);
}

// Is a point of the plane in the foot of the element? `q` in its axes.
bool microstructure_covers(Microstructure r, float radius, vec2 q) {
    if (microstructure_runs_along(r)) return abs(q.x) < radius;
    if (r.shape == MICRO_PRISM) return max(abs(q.x), abs(q.y)) < radius;
    return dot(q, q) < radius * radius;
}

// Radius of the sphere or cylinder that the cap is cut from.
float microstructure_curvature_radius(float radius, float depth) { return (radius * radius + depth * depth) / (2.0 * depth); }

// a t² - 2 b t + c = 0 without cancellation (Goldberg 1991, section 1.4); none: both infinite.
vec2 microstructure_roots(float a, float b, float c, float discriminant) {
    if (!(discriminant >= 0.0)) return vec2(INFINITY);
    float root = sqrt(discriminant);
    float q = b >= 0.0 ? b + root : b - root;
    float t0 = q != 0.0 ? c / q : 0.0, t1 = a != 0.0 ? q / a : INFINITY;
    return vec2(min(t0, t1), max(t0, t1));
}

// Where a ray meets the shape, continued below its foot, which is convex there; in the element's axes, which a bump rises from.
vec2 microstructure_crossings(Microstructure r, float radius, float depth, vec3 o, vec3 d) {
    if (r.shape == MICRO_DOME || r.shape == MICRO_LENS) {
        float curvature = microstructure_curvature_radius(radius, depth);
        o.z -= depth - curvature;
        if (r.shape == MICRO_LENS) o.y = d.y = 0.0;
        float a = dot(d, d), b = -dot(o, d);
        if (!(a > 0.0)) return vec2(INFINITY);
        float nearest = length(o + (b / a) * d), distance = length(o);
        return microstructure_roots(a, b, (distance - curvature) * (distance + curvature),
                                    a * (curvature - nearest) * (curvature + nearest));
    }
    if (r.shape == MICRO_CONE) {
        float slope = radius / depth, w = depth - o.z;
        float a = dot(d.xy, d.xy) - slope * slope * d.z * d.z, b = -(dot(o.xy, d.xy) + slope * slope * w * d.z);
        float c = dot(o.xy, o.xy) - slope * slope * w * w;
        vec2 t = microstructure_roots(a, b, c, b * b - a * c);
        // Not on the other half of the double cone.
        if (o.z + t.x * d.z > depth) t.x = INFINITY;
        if (o.z + t.y * d.z > depth) t.y = INFINITY;
        return t;
    }
    // Faces |x| / radius + z / depth = 1.
    vec2 t = vec2(-INFINITY, INFINITY);
    uint faces = r.shape == MICRO_PRISM ? 4u : 2u;
    for (uint i = 0u; i < faces; ++i) {
        float side = (i & 1u) != 0u ? -1.0 : 1.0;
        vec3 n = vec3(i < 2u ? side : 0.0, i < 2u ? 0.0 : side, radius / depth);
        float towards = dot(n, d), height = radius - dot(n, o);
        if (towards == 0.0 && height < 0.0) return vec2(INFINITY);
        if (towards < 0.0) t.x = max(t.x, height / towards);
        if (towards > 0.0) t.y = min(t.y, height / towards);
    }
    if (t.x > t.y) return vec2(INFINITY);
    if (t.x == -INFINITY) t.x = INFINITY;
    return t;
}

// Outward normal of a bump above q, not unit, and its height there.
vec3 microstructure_normal(Microstructure r, float radius, float depth, vec2 q, out float z) {
    if (r.shape == MICRO_DOME || r.shape == MICRO_LENS) {
        if (r.shape == MICRO_LENS) q.y = 0.0;
        float curvature = microstructure_curvature_radius(radius, depth);
        float up = sqrt(max(curvature * curvature - dot(q, q), 0.0));
        z = up + (depth - curvature);
        return vec3(q, up);
    }
    vec2 away = r.shape == MICRO_CONE ? q : vec2(q.x, 0.0);
    if (r.shape == MICRO_PRISM && abs(q.y) > abs(q.x)) away = vec2(0.0, q.y);
    float distance = length(away);
    z = depth * (1.0 - distance / radius);
    return vec3(distance > 0.0 ? away / distance * depth : vec2(0), radius);
}

// Where a ray meets an element between 0 and `end`, `start` being on the ray: t, and the place relative to the middle.
bool microstructure_meet(Microstructure r, MicroElement e, vec3 origin, vec3 direction, float start, float end, out GeometryHit hit) {
    float radius = e.scale * r.radius, depth = e.scale * r.depth, up = r.operation == 0u ? 1.0 : -1.0;
    vec3 o = vec3(origin.xy - e.center, origin.z) + start * direction;
    vec3 turned_o = vec3(microstructure_turned(r, o.xy, 1.0), up * o.z);
    vec3 turned_d = vec3(microstructure_turned(r, direction.xy, 1.0), up * direction.z);
    vec2 t = microstructure_crossings(r, radius, depth, turned_o, turned_d);
    hit = GeometryHit(INFINITY, vec2(0));
    for (uint i = 0u; i < 2u; ++i) {
        float here = i == 0u ? t.x : t.y;
        // A hair below the plane, too, so that no ray slips through at the foot.
        bool counts = here > -start && here <= end - start && turned_o.z + here * turned_d.z >= -4e-6 * depth;
        if (counts && here + start < hit.t) hit = GeometryHit(here + start, o.xy + here * direction.xy);
    }
    return hit.t < INFINITY;
}

bool microstructure_intersect(Microstructure r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(INFINITY));
    r = microstructure_in_rows(r);
    ivec2 cells = microstructure_cells(r);
    // The plane, where no element stands.
    float t = direction.z != 0.0 ? -origin.z / direction.z : 0.0;
    vec2 p = origin.xy + t * direction.xy;
    if (t > 0.0 && t < t_max && all(lessThanEqual(abs(p), 0.5 * r.size))) {
        int row = microstructure_row(r, cells, p.y);
        MicroElement e = microstructure_element(r, cells, ivec2(microstructure_column(r, cells, row, p.x), row));
        vec2 q = microstructure_turned(r, (origin.xy - e.center) + t * direction.xy, 1.0);
        if (!(e.exists && microstructure_covers(r, e.scale * r.radius, q))) hit.t = t;
    }
    // The part of the ray that is within the height of the elements, over the cells.
    vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
    float reach = r.depth * (1.0 + 1e-5);
    vec3 lo = vec3(-0.5 * r.size, r.operation == 0u ? -1e-5 * r.depth : -reach);
    vec3 hi = vec3(0.5 * r.size, r.operation == 0u ? reach : 1e-5 * r.depth);
    vec3 a = (lo - origin) * inverse, b = (hi - origin) * inverse, near = min(a, b), far = max(a, b);
    float start = max(max(near.x, near.y), max(near.z, 0.0)), end = min(min(far.x, far.y), min(far.z, min(hit.t, t_max)));
    if (!(start <= end)) return hit.t < INFINITY;
    vec2 at = origin.xy + start * direction.xy;
    int row = clamp(microstructure_row(r, cells, at.y), 0, max(cells.y - 1, 0));
    int row_step = direction.y < 0.0 ? -1 : 1, column_step = direction.x < 0.0 ? -1 : 1;
    float here = start;
    while (here <= end && row >= 0 && row < cells.y) {
        float row_edge = (float(row + max(row_step, 0)) - 0.5 * float(cells.y)) * r.pitch.y;
        float row_end = min((row_edge - origin.y) * inverse.y, end);
        float row_start = microstructure_row_start(r, cells, row);
        float x = origin.x + here * direction.x, x_end = origin.x + row_end * direction.x;
        float pad = float(column_step) * (1e-4 * r.pitch.x + 8.0 * EPSILON * (abs(origin.x) + abs(x) + abs(x_end)));
        int column = microstructure_column(r, cells, row, x - pad), last = microstructure_column(r, cells, row, x_end + pad);
        for (int i = column; (last - i) * column_step >= 0; i += column_step) {
            MicroElement e = microstructure_element(r, cells, ivec2(i, row));
            GeometryHit found;
            if (e.exists && microstructure_meet(r, e, origin, direction, start, end, found)) {
                hit = found;
                return true;
            }
        }
        here = row_end;
        row += row_step;
        if (row_end >= end) break;
    }
    return hit.t < INFINITY;
}

LocalPoint microstructure_locate(Microstructure r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec3 p = origin + hit.t * direction, n = vec3(0, 0, 1);
    vec3 error = vec3(gamma(3.0) * (abs(origin.xy) + abs(hit.t * direction.xy)), 0.0);
    if (hit.uv.x < INFINITY) {
        r = microstructure_in_rows(r);
        ivec2 cells = microstructure_cells(r);
        vec2 middle = p.xy - hit.uv;
        int row = microstructure_row(r, cells, middle.y);
        MicroElement e = microstructure_element(r, cells, ivec2(microstructure_column(r, cells, row, middle.x), row));
        float z, up = r.operation == 0u ? 1.0 : -1.0;
        n = normalize(microstructure_normal(r, e.scale * r.radius, e.scale * r.depth, microstructure_turned(r, hit.uv, 1.0), z));
        n.xy = up * microstructure_turned(r, n.xy, -1.0);
        p = vec3(e.center + hit.uv, up * z);
        error = vec3(gamma(2.0) * abs(p.xy) + gamma(4.0) * abs(hit.uv), gamma(8.0) * r.depth);
    } else {
        p.z = 0.0;
    }
    return LocalPoint(p, error, n, vec3(1, 0, 0), 0.5 + vec2(p.x, -p.y) / r.size);
}

// Nothing is sampled on it.
float microstructure_area(Microstructure r) { return r.size.x * r.size.y; }
GeometrySample microstructure_sample(Microstructure r, vec2 u) { return GeometrySample(vec3(0), vec3(0, 0, 1), 0.0); }
GeometrySample microstructure_sample_towards(Microstructure r, vec3 reference, vec2 u) { return microstructure_sample(r, u); }
float microstructure_pdf_towards(Microstructure r, vec3 reference, vec3 position, vec3 normal) { return 0.0; }

void microstructure_bounds(Microstructure r, out vec3 lo, out vec3 hi) {
    lo = vec3(-0.5 * r.size, r.operation == 0u ? 0.0 : -r.depth);
    hi = vec3(0.5 * r.size, r.operation == 0u ? r.depth : 0.0);
}
