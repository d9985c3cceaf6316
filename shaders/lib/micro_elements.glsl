// The elements of a microstructure: which there are in a cell, where they stand, and where rays meet them. Of the class of that name.
#include "features/textures.glsl"
#include "lib/accurate_math.glsl"
#include "lib/cell_mesh.glsl"
#include "lib/hash.glsl"
#include "lib/micro_places.glsl"
#include "lib/micro_shapes.glsl"
#include "lib/two_floats.glsl"

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
        if (r.bend != 0.0) g.reach.x *= 1.2;
        return g;
    }
    if (in_row) g.pitch.y = r.size.y;
    vec2 cells = r.size / g.pitch;
    if (r.placement == MICRO_STAGGERED && !in_row) cells.x -= 0.5;
    g.cells = max(ivec2(cells + 1e-3), ivec2(0));
    if (r.bend != 0.0) g.reach.x = 0.1 * g.pitch.x;
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
    vec2 axes;            // of a sheet that is bent: (cos, sin) of the angle that the element is turned by, about y
    float scale, turn;
};

vec3 microstructure_center(MicroElement e) { return e.cell + vec3(e.offset, 0.0); }

// The elements of a cell are numbered: the first, and the one behind the last.
uvec2 microstructure_elements(Microstructure r, MicroGrid g, ivec2 cell) {
    bool is_inside = all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, g.cells));
    if (r.placement != MICRO_FILE) return uvec2(0u, is_inside ? 1u : 0u);
    return is_inside ? micro_places_of(r.file, uint(cell.y) * uint(g.cells.x) + uint(cell.x)) : uvec2(0);
}

MicroElement microstructure_flat_element(Microstructure r, MicroGrid g, ivec2 cell, uint number) {
    MicroElement e;
    vec3 n = vec3(vec2(cell) + 0.5 - 0.5 * vec2(g.cells) + vec2(microstructure_shift(r, cell.y), 0.0), 0.0);
    e.cell = exact_product_of(n, vec3(g.pitch, 0.0), e.cell_low);
    e.cell_low.xy += n.xy * g.pitch_low;
    e.offset = vec2(0);
    e.axes = vec2(1, 0);
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

// … in its place on the cylinder.
MicroElement microstructure_wrapped(Microstructure r, MicroElement e) {
    if (r.bend == 0.0) return e;
    float turns = (e.cell.x + (e.offset.x + e.cell_low.x)) / (2.0 * PI * r.bend), half_sine = cos_sin_turns(0.5 * turns).y;
    e.axes = cos_sin_turns(turns);
    e.cell = vec3(r.bend * e.axes.y, e.cell.y, -2.0 * r.bend * half_sine * half_sine);
    e.cell_low.x = e.offset.x = 0.0;
    return e;
}
MicroElement microstructure_element(Microstructure r, MicroGrid g, ivec2 cell, uint number) {
    return microstructure_wrapped(r, microstructure_flat_element(r, g, cell, number));
}

vec3 microstructure_to_element(Microstructure r, MicroElement e, vec3 v) {
    if (r.bend == 0.0) return v;
    return vec3(e.axes.x * v.x - e.axes.y * v.z, v.y, e.axes.y * v.x + e.axes.x * v.z);
}
vec3 microstructure_from_element(Microstructure r, MicroElement e, vec3 v) {
    if (r.bend == 0.0) return v;
    return vec3(e.axes.x * v.x + e.axes.y * v.z, v.y, e.axes.x * v.z - e.axes.y * v.x);
}

// A point of the ray in the frame of an element.
vec3 microstructure_from(Microstructure r, MicroElement e, vec3 origin, vec3 direction, float t) {
    return microstructure_to_element(r, e, place_from(origin, direction, t, e.cell, e.cell_low) - vec3(e.offset, 0.0));
}

// Of a point in such a frame: how far it is beyond the sheet, up to its square over the bend; and what it changes by along d.
float microstructure_height(Microstructure r, vec3 q) {
    return r.bend == 0.0 ? q.z : q.z + 0.5 / r.bend * dot(q.xz, q.xz);
}
float microstructure_climb(Microstructure r, vec3 q, vec3 d) { return r.bend == 0.0 ? d.z : d.z + dot(q.xz, d.xz) / r.bend; }

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
    vec3 way = direction, there = microstructure_center(e) - origin;
    if (micro_runs_along(r.shape)) way.y = 0.0;
    float start = max(dot(there, way) / max(dot(way, way), 1e-30), 0.0);
    if (start * length(way) < 1.01 * (radius + depth)) start = 0.0;
    vec3 o = microstructure_from(r, e, origin, direction, start);
    vec3 d = microstructure_to_element(r, e, direction);
    vec3 turned_o = vec3(microstructure_turned(r, e, o.xy, 1.0), up * o.z);
    vec3 turned_d = vec3(microstructure_turned(r, e, d.xy, 1.0), up * d.z);
    vec2 t = micro_crossings(r.shape, radius, depth, turned_o, turned_d);
    hit = GeometryHit(INFINITY, vec2(0));
    for (uint i = 0u; i < 2u; ++i) {
        float here = i == 0u ? t.x : t.y;
        // A hair below the plane, too, so that no ray slips through at the foot.
        vec3 q = o + here * d;
        bool counts = here > -start && here + start < end && up * microstructure_height(r, q) >= -4e-6 * depth;
        if (counts && here + start < hit.t) hit = GeometryHit(here + start, q.xy);
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
    vec3 o = microstructure_from(r, e, origin, direction, start);
    uint triangle;
    hit = GeometryHit(INFINITY, vec2(0));
    if (!cell_mesh_meet(r.cell, o, direction, end - start, t, triangle)) return false;
    // Once more from where it is met.
    CellTriangle c = cell_triangles[r.cell.first_triangle + triangle];
    vec3 n = cell_normal(c);
    float there = start + t;
    float slope = dot(n, direction), lacks = dot(n, c.v0 - microstructure_from(r, e, origin, direction, there));
    vec3 low, sum = exact_sum_of(vec3(there), vec3(slope != 0.0 ? lacks / slope : 0.0), low);
    if (!(sum.x > 0.0 && sum.x < end)) return false;
    hit = GeometryHit(sum.x, vec2(float(4u * triangle + uint(cell.x & 1) + 2u * uint(cell.y & 1)), low.x));
    return true;
}
