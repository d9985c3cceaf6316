// A rectangle in the xy plane around the origin, facing +z, with small bumps or dents of one shape in cells side by side: the
// dots of a light guide, an array of lenses, a prism film. Which cell holds one, where and how large follows from the cell's number,
// so that any number of them takes no memory; or a file says it ("placement": {"file": NAME}). Cells lie around the middle; what is left
// of the rectangle beside them is plain. Ridges are open at their ends. Instead of shapes cells may hold triangles: the meshes of another
// scene of the file ("cell": its index) stand in the place of the plane in the cells that hold one. Seen from +z u runs to the right (+x),
// v down (-y).
//
// A ray walks through the cells that it passes while it is within the height of the shapes (Amanatides & Woo 1987, row by row);
// what it costs does not depend on how many there are. It is met in the frame of each element, where it goes on from a point nearby that
// is found without rounding: so places are right to some roundings of a cell, wherever that lies and wherever the ray comes from.
//
// Example:
//     {"nodes": [{"name": "microstructure", "translation": [0, 0.4, 0], "rotation": [-0.2588, 0, 0, 0.9659], "extensions": {"ETD_optics": {
//         "geometry": {"class": "microstructure", "size": [1.1, 0.7], "pitch": [0.1, 0.1], "radius": 0.04, "depth": 0.03, "material": 1}}}}]}
#include "features/textures.glsl"
#include "lib/cell_mesh.glsl"
#include "lib/hash.glsl"
#include "lib/micro_places.glsl"
#include "lib/micro_shapes.glsl"
#include "lib/two_floats.glsl"

struct Microstructure {
    vec2 size;        //: required in (0, inf) m. Width along x and height along y.
    vec2 pitch;       //: required in (0, inf) m. Of the cells; not with a file.
    uint shape;       //: "dome" of dome|cone|prism|groove|lens. A cap of a sphere, a cone, a pyramid of four sides; along all of y: a ridge, a cap of a cylinder.
    float radius;     //: required in (0, inf) m. Of the foot: half its width. An element stays within its cell, but for a file's. Not with a cell.
    float depth;      //: required in (0, inf) m. Height of a bump; of a dome or lens at most the radius. Not with a cell.
    uint operation;   //: "add" of add|remove. Bumps towards +z, or dents.
    float turn;       //: 0 in (-inf, inf) rad. Of pyramids, about z.
    uint placement;   //: "grid" of grid|staggered|jittered|file. In rows; every other row shifted by half a cell; anywhere within the cell; {"file": NAME}: where a file says.
    MicroPlaces file; //: none. Of the placement.
    CellMesh cell;    //: none. Index of a scene of the file: the triangles of an element.
    float density;    //: 1 in [0, 1]. The share of the cells that hold an element.
    TextureRef density_texture;  //: none data. Red multiplies density, at the middle of each cell.
    float spread;     //: 0 in [0, 1). Elements are smaller than radius and depth by up to this share.
    uint seed;        //: 0 in [0, 4294967295]. Which cells, where and how large.
};
#define microstructure_NEVER_EMITS

const uint MICRO_STAGGERED = 1u;
const uint MICRO_JITTERED = 2u;
const uint MICRO_FILE = 3u;

// The cells around the middle.
struct MicroGrid {
    ivec2 cells;
    vec2 pitch, pitch_low;  // m; the second is what the first lacks
    vec2 reach;             // m, that elements come out of their cells
};

// Ridges stand in one row.
MicroGrid microstructure_grid(Microstructure r) {
    bool is_file = r.placement == MICRO_FILE, in_row = micro_runs_along(r.shape);
    MicroGrid g = MicroGrid(ivec2(r.file.columns, r.file.rows), r.pitch, vec2(0), vec2(0));
    if (is_file) {
        vec3 low, n = vec3(g.cells, 1);
        g.pitch = r.size / n.xy;
        vec3 whole = exact_product_of(vec3(g.pitch, 0), n, low);
        g.pitch_low = ((r.size - whole.xy) - low.xy) / n.xy;
        g.reach = vec2(r.radius * (r.shape == MICRO_PRISM ? 1.41422 : 1.00001));
        return g;
    }
    if (in_row) g.pitch.y = r.size.y;
    vec2 cells = r.size / g.pitch;
    if (r.placement == MICRO_STAGGERED && !in_row) cells.x -= 0.5;
    g.cells = max(ivec2(cells + 1e-3), ivec2(0));
    return g;
}

// What a row is moved by, in cells.
float microstructure_shift(Microstructure r, int row) {
    if (r.placement != MICRO_STAGGERED || micro_runs_along(r.shape)) return 0.0;
    return (row & 1) != 0 ? 0.25 : -0.25;
}
int microstructure_row(MicroGrid g, float y) { return int(floor(y / g.pitch.y + 0.5 * float(g.cells.y))); }
int microstructure_column(Microstructure r, MicroGrid g, int row, float x) {
    return int(floor(x / g.pitch.x + (0.5 * float(g.cells.x) - microstructure_shift(r, row))));
}

// An element: its middle is that of its cell and `offset` more.
struct MicroElement {
    bool exists;
    vec3 cell, cell_low;  // m; the second is what the first lacks
    vec2 offset;          // m
    float scale, turn;
};

vec2 microstructure_center(MicroElement e) { return e.cell.xy + e.offset; }

// The elements of a cell are numbered: the first, and the one behind the last.
uvec2 microstructure_elements(Microstructure r, MicroGrid g, ivec2 cell) {
    bool is_inside = all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, g.cells));
    if (r.placement != MICRO_FILE) return uvec2(0u, is_inside ? 1u : 0u);
    return is_inside ? micro_places_of(r.file, uint(cell.y) * uint(g.cells.x) + uint(cell.x)) : uvec2(0);
}

MicroElement microstructure_element(Microstructure r, MicroGrid g, ivec2 cell, uint number) {
    MicroElement e;
    vec3 n = vec3(vec2(cell) + 0.5 - 0.5 * vec2(g.cells) + vec2(microstructure_shift(r, cell.y), 0.0), 0.0);
    e.cell = exact_product_of(n, vec3(g.pitch, 0.0), e.cell_low);
    e.cell_low.xy += n.xy * g.pitch_low;
    e.offset = vec2(0);
    e.turn = r.turn;
    if (r.placement == MICRO_FILE) {
        MicroPlace place = micro_place(number);
        e.exists = true;
        e.offset = place.offset * g.pitch;
        e.scale = place.size;
        e.turn += place.angle;
        if (micro_runs_along(r.shape)) e.offset.y = 0.0;
        return e;
    }
    vec2 uv = 0.5 + vec2(e.cell.x, -e.cell.y) / r.size;
    uvec3 hash = hash_3d(uvec3(cell, r.seed)), more = hash_3d(hash);
    e.exists = float(hash.z >> 8) * (1.0 / 16777216.0) < r.density * texture_value(r.density_texture, uv, uv).r;
    e.scale = 1.0 - r.spread * float(more.x >> 8) * (1.0 / 16777216.0);
    if (r.placement == MICRO_JITTERED) {
        vec2 room = max(g.pitch - 2.0 * r.radius, 0.0);
        e.offset = (vec2(hash.xy >> 8) * (1.0 / 16777216.0) - 0.5) * room;
    }
    return e;
}

// A point of the ray, from the middle of the element.
vec3 microstructure_from(MicroElement e, vec3 origin, vec3 direction, float t) {
    return place_from(origin, direction, t, e.cell, e.cell_low) - vec3(e.offset, 0.0);
}

void microstructure_bounds(Microstructure r, out vec3 lo, out vec3 hi) {
    vec2 z = r.operation == 0u ? vec2(0.0, r.depth) : vec2(-r.depth, 0.0);
    if (r.cell.nodes != 0u) z = vec2(min(r.cell.low, 0.0), max(r.cell.high, 0.0));
    lo = vec3(-0.5 * r.size, z.x);
    hi = vec3(0.5 * r.size, z.y);
}

// To the axes of an element, and back.
vec2 microstructure_turned(Microstructure r, MicroElement e, vec2 v, float way) {
    if (r.shape != MICRO_PRISM) return v;
    float c = cos(e.turn), s = way * sin(e.turn);
    return vec2(c * v.x + s * v.y, c * v.y - s * v.x);
}

// Where a ray meets an element between 0 and `end`: t, and the place relative to the middle.
bool microstructure_meet(Microstructure r, MicroElement e, vec3 origin, vec3 direction, float end, out GeometryHit hit) {
    float radius = e.scale * r.radius, depth = e.scale * r.depth, up = r.operation == 0u ? 1.0 : -1.0;
    // From where the ray is nearest, unless it may start on the element.
    vec3 way = direction, there = vec3(microstructure_center(e), 0.0) - origin;
    if (micro_runs_along(r.shape)) way.y = 0.0;
    float start = max(dot(there, way) / max(dot(way, way), 1e-30), 0.0);
    if (start * length(way) < 1.01 * (radius + depth)) start = 0.0;
    vec3 o = microstructure_from(e, origin, direction, start);
    vec3 turned_o = vec3(microstructure_turned(r, e, o.xy, 1.0), up * o.z);
    vec3 turned_d = vec3(microstructure_turned(r, e, direction.xy, 1.0), up * direction.z);
    vec2 t = micro_crossings(r.shape, radius, depth, turned_o, turned_d);
    hit = GeometryHit(INFINITY, vec2(0));
    for (uint i = 0u; i < 2u; ++i) {
        float here = i == 0u ? t.x : t.y;
        // A hair below the plane, too, so that no ray slips through at the foot.
        bool counts = here > -start && here + start < end && turned_o.z + here * turned_d.z >= -4e-6 * depth;
        if (counts && here + start < hit.t) hit = GeometryHit(here + start, o.xy + here * direction.xy);
    }
    return hit.t < INFINITY;
}

// … the triangles of a cell: t, and `uv` = number of the triangle and what the cell's numbers leave divided by 2; what t lacks.
bool microstructure_meet_cell(Microstructure r, MicroGrid g, MicroElement e, ivec2 cell, vec3 origin, vec3 direction, vec3 inverse,
                              float end, out GeometryHit hit) {
    // From a little before the cell, unless the ray starts there.
    vec3 middle = vec3(e.cell.xy, 0.5 * (r.cell.low + r.cell.high));
    vec3 reach = vec3(0.6 * g.pitch, (0.5 * (r.cell.high - r.cell.low) + 0.1 * g.pitch.x));
    vec3 sides = mix(middle - reach, middle + reach, lessThan(inverse, vec3(0))), near = (sides - origin) * inverse;
    float start = max(max(near.x, near.y), max(near.z, 0.0)), t;
    vec3 o = microstructure_from(e, origin, direction, start);
    uint triangle;
    hit = GeometryHit(INFINITY, vec2(0));
    if (!cell_mesh_meet(r.cell, o, direction, end - start, t, triangle)) return false;
    // Once more from where it is met.
    CellTriangle c = cell_triangles[r.cell.first_triangle + triangle];
    vec3 n = cell_normal(c);
    float there = start + t;
    float slope = dot(n, direction), lacks = dot(n, c.v0 - microstructure_from(e, origin, direction, there));
    vec3 low, sum = exact_sum_of(vec3(there), vec3(slope != 0.0 ? lacks / slope : 0.0), low);
    if (!(sum.x > 0.0 && sum.x < end)) return false;
    hit = GeometryHit(sum.x, vec2(float(4u * triangle + uint(cell.x & 1) + 2u * uint(cell.y & 1)), low.x));
    return true;
}

// Where a ray meets the plane, between 0 and `end`, unless an element stands there.
bool microstructure_meet_plane(Microstructure r, MicroGrid g, vec3 origin, vec3 direction, float end, out float t) {
    t = direction.z != 0.0 ? -origin.z / direction.z : 0.0;
    vec2 p = origin.xy + t * direction.xy;
    if (!(t > 0.0 && t < end && all(lessThanEqual(abs(p), 0.5 * r.size)))) return false;
    bool is_plain = true;
    for (int row = microstructure_row(g, p.y - g.reach.y); row <= microstructure_row(g, p.y + g.reach.y); ++row) {
        int last = microstructure_column(r, g, row, p.x + g.reach.x);
        for (int column = microstructure_column(r, g, row, p.x - g.reach.x); column <= last; ++column) {
            uvec2 elements = microstructure_elements(r, g, ivec2(column, row));
            for (uint i = elements.x; i < elements.y; ++i) {
                MicroElement e = microstructure_element(r, g, ivec2(column, row), i);
                vec3 q = microstructure_from(e, origin, direction, t);
                q.xy -= q.z / direction.z * direction.xy;
                bool covers = r.cell.nodes != 0u || micro_covers(r.shape, e.scale * r.radius, microstructure_turned(r, e, q.xy, 1.0));
                is_plain = is_plain && !(e.exists && covers);
            }
        }
    }
    return is_plain;
}

bool microstructure_intersect(Microstructure r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(t_max, vec2(INFINITY));
    MicroGrid g = microstructure_grid(r);
    float t;
    bool met = microstructure_meet_plane(r, g, origin, direction, t_max, t);
    if (met) hit.t = t;
    // The part of the ray that is within the height of the elements, over the cells; a hair more, by what is rounded here.
    vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
    vec3 lo, hi;
    microstructure_bounds(r, lo, hi);
    float hair = 1e-5 * (hi.z - lo.z) + 8.0 * EPSILON * abs(origin.z);
    lo.z -= hair, hi.z += hair;
    vec3 a = (lo - origin) * inverse, b = (hi - origin) * inverse, near = min(a, b), far = max(a, b);
    float start = max(max(near.x, near.y), max(near.z, 0.0)), end = min(min(far.x, far.y), min(far.z, hit.t));
    if (!(start <= end)) return met;
    vec2 from = origin.xy + start * direction.xy, to = origin.xy + end * direction.xy;
    vec2 reach = g.reach + 1e-4 * g.pitch + 8.0 * EPSILON * (abs(origin.xy) + abs(from) + abs(to));
    ivec2 way = mix(ivec2(1), ivec2(-1), lessThan(inverse.xy, vec2(0)));
    vec2 pad = vec2(way) * reach;
    int row = clamp(microstructure_row(g, from.y - pad.y), 0, max(g.cells.y - 1, 0));
    int last_row = clamp(microstructure_row(g, to.y + pad.y), 0, max(g.cells.y - 1, 0));
    for (; (last_row - row) * way.y >= 0 && g.cells.y > 0; row += way.y) {
        vec2 edges = (float(row) - 0.5 * float(g.cells.y) + vec2(way.y < 0, way.y > 0)) * g.pitch.y + vec2(-pad.y, pad.y);
        vec2 ends = clamp((edges - origin.y) * inverse.y, vec2(start), vec2(max(min(end, hit.t), start)));
        if (ends.x >= hit.t) break;
        vec2 x = origin.x + ends * direction.x + vec2(-pad.x, pad.x);
        int column = microstructure_column(r, g, row, x.x), last = microstructure_column(r, g, row, x.y);
        for (; (last - column) * way.x >= 0; column += way.x) {
            ivec2 cell = ivec2(column, row);
            uvec2 elements = microstructure_elements(r, g, cell);
            for (uint i = elements.x; i < elements.y; ++i) {
                MicroElement e = microstructure_element(r, g, cell, i);
                if (!e.exists) continue;
                GeometryHit found;
                bool here = r.cell.nodes != 0u ? microstructure_meet_cell(r, g, e, cell, origin, direction, inverse, hit.t, found)
                                               : microstructure_meet(r, e, origin, direction, hit.t, found);
                if (!here) continue;
                hit = found;
                met = true;
                if (r.placement != MICRO_FILE) return true;  // others lie in cells that the ray comes to later
            }
        }
    }
    return met;
}

// The element that was hit, of all that stand around there.
MicroElement microstructure_find(Microstructure r, MicroGrid g, vec2 middle) {
    MicroElement best;
    float nearest = INFINITY;
    vec2 slack = r.placement == MICRO_FILE ? 1e-3 * g.pitch + 16.0 * EPSILON * r.size : vec2(0);
    for (int row = microstructure_row(g, middle.y - slack.y); row <= microstructure_row(g, middle.y + slack.y); ++row) {
        int last = microstructure_column(r, g, row, middle.x + slack.x);
        for (int column = microstructure_column(r, g, row, middle.x - slack.x); column <= last; ++column) {
            uvec2 elements = microstructure_elements(r, g, ivec2(column, row));
            for (uint i = elements.x; i < elements.y; ++i) {
                MicroElement e = microstructure_element(r, g, ivec2(column, row), i);
                float distance = length(middle - microstructure_center(e));
                if (distance < nearest) nearest = distance, best = e;
            }
        }
    }
    return best;
}

LocalPoint microstructure_on_element(Microstructure r, MicroGrid g, vec2 p, vec2 q) {
    MicroElement e = microstructure_find(r, g, p - q);
    float z, up = r.operation == 0u ? 1.0 : -1.0;
    vec3 n = normalize(micro_normal(r.shape, e.scale * r.radius, e.scale * r.depth, microstructure_turned(r, e, q, 1.0), z));
    n.xy = up * microstructure_turned(r, e, n.xy, -1.0);
    vec3 place = vec3(e.cell.xy + (e.offset + q + e.cell_low.xy), up * z);
    vec3 error = vec3(gamma(2.0) * abs(place.xy) + gamma(4.0) * abs(q), gamma(8.0) * r.depth);
    return LocalPoint(place, error, n, vec3(1, 0, 0), vec2(0));
}

LocalPoint microstructure_on_triangle(Microstructure r, MicroGrid g, vec2 p, vec3 origin, vec3 direction, GeometryHit hit) {
    uint number = uint(hit.uv.x);
    ivec2 odd = ivec2(number & 1u, (number >> 1) & 1u), cell;
    // Of the cells with such numbers the nearest.
    cell.y = 2 * int(round(p.y / g.pitch.y * 0.5 + (0.25 * float(g.cells.y) - 0.25 - 0.5 * float(odd.y)))) + odd.y;
    float shift = microstructure_shift(r, cell.y);
    cell.x = 2 * int(round(p.x / g.pitch.x * 0.5 + (0.25 * float(g.cells.x) - 0.25 - 0.5 * (float(odd.x) + shift)))) + odd.x;
    MicroElement e = microstructure_element(r, g, cell, 0u);
    vec3 q = microstructure_from(e, origin, direction, hit.t) + hit.uv.y * direction;
    CellTriangle c = cell_triangles[r.cell.first_triangle + (number >> 2)];
    vec3 n = cell_normal(c);
    vec3 size = max(max(abs(c.v0), abs(c.v1)), abs(c.v2));
    q -= dot(n, q - c.v0) * n;
    vec3 error = gamma(3.0) * vec3(abs(e.cell.xy + q.xy), 0.0) + gamma(12.0) * (abs(q) + size);
    return LocalPoint(vec3(e.cell.xy + (q.xy + e.cell_low.xy), q.z), error, n, vec3(1, 0, 0), vec2(0));
}

LocalPoint microstructure_locate(Microstructure r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec2 p = origin.xy + hit.t * direction.xy;
    vec3 error = vec3(gamma(3.0) * (abs(origin.xy) + abs(hit.t * direction.xy)), 0.0);
    LocalPoint point = LocalPoint(vec3(p, 0.0), error, vec3(0, 0, 1), vec3(1, 0, 0), vec2(0));
    MicroGrid g = microstructure_grid(r);
    if (hit.uv.x < INFINITY) {
        if (r.cell.nodes != 0u) point = microstructure_on_triangle(r, g, p, origin, direction, hit);
        else point = microstructure_on_element(r, g, p, hit.uv);
    }
    point.uv = 0.5 + vec2(point.position.x, -point.position.y) / r.size;
    return point;
}

// Nothing is sampled on it.
float microstructure_area(Microstructure r) { return r.size.x * r.size.y; }
GeometrySample microstructure_sample(Microstructure r, vec2 u) { return GeometrySample(vec3(0), vec3(0, 0, 1), 0.0); }
GeometrySample microstructure_sample_towards(Microstructure r, vec3 reference, vec2 u) { return microstructure_sample(r, u); }
float microstructure_pdf_towards(Microstructure r, vec3 reference, vec3 position, vec3 normal) { return 0.0; }
