// Light vertices along a ray: those of the grid whose own merging radius reaches it (lib/vertex_grid.glsl).
//
// A level of the grid is walked in slabs of cells across the axis that the ray follows most; of a slab all cells that the ray,
// as wide as radii of the level can be, passes. Each bucket's vertices are met once a cell and level, as there.
#include "lib/vertex_grid.glsl"

// Axes in an order in which the one that the ray follows most is the last.
vec3 major_last(vec3 v, int axis) { return axis == 0 ? v.yzx : axis == 1 ? v.zxy : v; }
vec3 in_world_order(vec3 v, int axis) { return axis == 0 ? v.zxy : axis == 1 ? v.yzx : v; }

const float LARGEST_RADIUS = 1.0 / (2.125 * BEAM_CELL_SCALE);  // of a vertex, in sides of its cell

struct BeamQuery {
    vec3 origin, direction;  // major_last; the last of the direction is positive
    float extent;            // m, its length
    float slope;             // of the radius over distance
    int axis, level, last_level;
    float slab, last_slab;   // numbers of cells, as are the following
    vec2 cell, first_cell, last_cell;
    float radius2;           // m², of the slab's vertices at most
    uint next, end;          // candidates in grid_entries
    bool done;
    uint found, given;
};

void start_level(inout BeamQuery q) {
    float inverse = cells_a_metre(q.level);
    float aside = LARGEST_RADIUS * sqrt(max(0.0, 1.0 - q.direction.z * q.direction.z));
    q.slab = floor(q.origin.z * inverse - aside) - 1.0;
    q.last_slab = floor((q.origin.z + q.extent * q.direction.z) * inverse + aside);
    q.cell = q.first_cell = q.last_cell = vec2(0);  // at the end of a slab
}

void enter_slab(inout BeamQuery q) {
    float inverse = cells_a_metre(q.level), side = cell_side(q.level);
    float z0 = q.origin.z * inverse, aside = LARGEST_RADIUS * sqrt(max(0.0, 1.0 - q.direction.z * q.direction.z));
    float a = max(q.slab, z0 - aside) - z0, b = min(q.slab + 1.0, (q.origin.z + q.extent * q.direction.z) * inverse + aside) - z0;
    vec2 turn = q.direction.xy / q.direction.z, start = q.origin.xy * inverse;
    // Radii and levels near the middle of it.
    vec3 middle = in_world_order(vec3(start + (0.5 * (a + b)) * turn, z0 + 0.5 * (a + b)) * side, q.axis);
    float radius = merge_radius(middle), farthest = largest_coordinate(middle);
    float change = q.slope * 1.5 * side;
    int lower = grid_level(0.9999 * BEAM_CELL_SCALE * max(radius - change, 0.0), max(farthest - 1.5 * side, 0.0));
    int upper = grid_level(1.0001 * BEAM_CELL_SCALE * (radius + change), farthest + 1.5 * side);
    q.cell = q.first_cell = q.last_cell = vec2(0);
    if (q.level < lower || q.level > upper) {  // over what cannot hold vertices of this level
        float skip = q.level < lower ? radius - LARGEST_RADIUS * side : 0.5 * LARGEST_RADIUS * side - radius;
        float slabs = floor(skip / max(q.slope, 1e-9) * q.direction.z * inverse) - 2.0;
        q.slab += clamp(slabs, 0.0, max(q.last_slab - q.slab, 0.0));
    } else {  // and no return above: what lanes carry past it would be wrong on Mesa 22.3
        float widest = min(LARGEST_RADIUS, 1.0001 * (radius + change) * inverse);
        vec2 around = widest * sqrt(1.0 + turn * turn);
        q.radius2 = square(widest * side);
        vec2 one = start + a * turn, other = start + b * turn;
        q.first_cell = floor(min(one, other) - around);
        q.last_cell = floor(max(one, other) + around);
        q.cell = q.first_cell - vec2(1, 0);
    }
}

bool has_cells(BeamQuery q) { return q.cell.x < q.last_cell.x || q.cell.y < q.last_cell.y; }

void enter_next_slab(inout BeamQuery q) {
    q.slab += max(1.0, abs(q.slab) * 2e-7);  // of levels too fine for floats, which hold no vertices there
    if (q.slab > q.last_slab) {
        q.level++;
        q.done = q.level > q.last_level;
        start_level(q);
        q.slab += 1.0;
    }
    enter_slab(q);
}

void enter_next_cell(inout BeamQuery q) {
    q.cell.x += 1.0;
    if (q.cell.x > q.last_cell.x) q.cell = vec2(q.first_cell.x, q.cell.y + 1.0);
    uint bucket = grid_bucket(ivec3(in_world_order(vec3(q.cell, q.slab), q.axis)), q.level);
    q.next = bucket_starts[bucket];
    q.end = bucket_starts[bucket + 1u];
}

// `slope`: the largest change of merge_radius over distance.
void begin_beam(out BeamQuery q, vec3 origin, vec3 direction, float length, float slope) {
    vec3 a = abs(direction);
    q.axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    q.extent = length;
    q.slope = slope;
    vec3 end = origin + length * direction;
    float r0 = merge_radius(origin), r1 = merge_radius(end), way = slope * length;
    vec3 lo = min(origin, end), hi = max(origin, end);
    vec3 nearest = max(max(lo, -hi), vec3(0));
    float least = max(0.5 * (r0 + r1 - way), 0.0), largest = 0.5 * (r0 + r1 + way), reach = 1.1 * largest;
    float farthest = max(largest_coordinate(lo), largest_coordinate(hi));
    q.level = grid_level(0.9999 * BEAM_CELL_SCALE * least, max(largest_coordinate(nearest) - reach, 0.0));
    q.last_level = grid_level(1.0001 * BEAM_CELL_SCALE * largest, farthest + reach);
    bool backward = (q.axis == 0 ? direction.x : q.axis == 1 ? direction.y : direction.z) < 0.0;
    q.origin = major_last(backward ? end : origin, q.axis);
    q.direction = major_last(backward ? -direction : direction, q.axis);
    q.next = q.end = q.found = q.given = 0u;
    q.done = !(length > 0.0);
    start_level(q);
}

// Whether a candidate is of the cell that is being walked, not of another that the hash has put into the same bucket and that may
// lie on the ray, too; and is reached by its own radius.
bool is_of_cell(BeamQuery q, vec3 position, vec3 aside) {
    float radius = merge_radius(position);
    bool same_level = grid_level(BEAM_CELL_SCALE * radius, largest_coordinate(position)) == q.level;
    vec3 cell = in_world_order(vec3(q.cell, q.slab), q.axis);
    return same_level && floor(position * cells_a_metre(q.level)) == cell && dot(aside, aside) <= square(radius);
}

// As find_vertices, slab by slab.
void find_on_beam(inout BeamQuery q, bool wanted) {
    vec3 origin = in_world_order(q.origin, q.axis), direction = in_world_order(q.direction, q.axis);
    bool walking = wanted && !q.done;
    do {
        if (walking && q.next == q.end && !has_cells(q)) enter_next_slab(q);
        bool here = walking && !q.done;
        do {
            if (here) {
                if (q.next == q.end && has_cells(q)) enter_next_cell(q);
                if (q.next < q.end) {
                    vec3 position = grid_entries[q.next].xyz, d = position - origin;
                    float t = dot(d, direction);
                    vec3 aside = d - t * direction;
                    if (t >= 0.0 && t <= q.extent && dot(aside, aside) <= q.radius2 && is_of_cell(q, position, aside)) {
                        grid_query_found[q.found] = q.next;
                        q.found++;
                    }
                    q.next++;
                }
                here = q.found < GRID_QUERY_ROOM && (q.next < q.end || has_cells(q));
            }
        } while (subgroupAny(here));
        walking = walking && !q.done && q.found < GRID_QUERY_ROOM;
    } while (subgroupAny(walking));
}

bool next_on_beam(inout BeamQuery q, out uint vertex) {
    vertex = NO_LIGHT_VERTEX;
    bool wanted = q.given == q.found;
    if (subgroupAny(wanted)) {
        if (wanted) q.given = q.found = 0u;
        find_on_beam(q, wanted);
    }
    if (q.given == q.found) return false;
    vertex = floatBitsToUint(grid_entries[grid_query_found[q.given]].w);
    q.given++;
    return true;
}
