// A density in space from a file: given at the points of a lattice, trilinear between them, zero outside. Bricks of 4 x 4 x 4
// cells know the least, the greatest and the mean density within them, so that what is empty or even costs little; only
// those whose density varies keep its values. Written by host/scene/density_bricks.
#include "lib/constants.glsl"
#include "lib/free_path.glsl"
#include "lib/records.glsl"

struct GridRef { uint index; };  // a file with a density, or where it stands -> index of a DensityGrid

const float BRICK_CELLS = 4.0;  // a side; twin in host/scene/density_bricks.h

// Twins of both structs in host/scene/density_bricks.h.
struct DensityGrid {
    mat4x3 lattice_from_world;  // points of the lattice become whole numbers from 0 on
    uvec3 cells;                // between them, along each axis
    uint first_brick;           // x runs fastest
};
struct DensityBrick {
    float least, greatest, mean;
    uint first_value;  // of 5 x 5 x 5, x runs fastest; NO_RECORD: the density is the same everywhere
};
layout(scalar, set = 0) readonly buffer DensityGrids { DensityGrid density_grids[]; };
layout(scalar, set = 0) readonly buffer DensityBricks { DensityBrick density_bricks[]; };
layout(scalar, set = 0) readonly buffer DensityValues { float density_values[]; };

float least_of(vec3 v) { return min(v.x, min(v.y, v.z)); }
float greatest_of(vec3 v) { return max(v.x, max(v.y, v.z)); }

uvec3 brick_counts(DensityGrid g) { return (g.cells + uint(BRICK_CELLS) - 1u) / uint(BRICK_CELLS); }
DensityBrick brick_of(DensityGrid g, ivec3 brick) {
    uvec3 n = brick_counts(g), b = uvec3(brick);
    return density_bricks[g.first_brick + (b.z * n.y + b.y) * n.x + b.x];
}

// `at`: from the brick's first lattice point, in cells. Never beyond the brick's bounds, by rounding.
float brick_density(DensityBrick b, vec3 at) {
    if (b.first_value == NO_RECORD) return b.least;
    at = clamp(at, vec3(0), vec3(BRICK_CELLS));
    uvec3 cell = min(uvec3(at), uvec3(BRICK_CELLS - 1.0));
    vec3 f = at - vec3(cell);
    const uint side = uint(BRICK_CELLS) + 1u;
    uint i = b.first_value + (cell.z * side + cell.y) * side + cell.x;
    vec4 low = vec4(density_values[i], density_values[i + 1u], density_values[i + side], density_values[i + side + 1u]);
    i += side * side;
    vec4 high = vec4(density_values[i], density_values[i + 1u], density_values[i + side], density_values[i + side + 1u]);
    vec4 v = mix(low, high, f.z);
    vec2 x = mix(v.xz, v.yw, f.x);
    return clamp(mix(x.x, x.y, f.y), b.least, b.greatest);
}

float density_at(GridRef ref, vec3 position) {
    DensityGrid g = density_grids[ref.index];
    vec3 p = g.lattice_from_world * vec4(position, 1.0);
    if (!(least_of(p) >= 0.0) || any(greaterThan(p, vec3(g.cells)))) return 0.0;
    ivec3 brick = min(ivec3(p / BRICK_CELLS), ivec3(brick_counts(g)) - 1);
    return brick_density(brick_of(g, brick), p - vec3(brick) * BRICK_CELLS);
}

// A walk along a ray, brick by brick (Amanatides & Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing").
struct DensityWalk {
    DensityGrid grid;
    vec3 origin, direction;  // in cells, and cells a metre
    float t, end;            // m, how far it is; where the ray leaves the grid, or ends. t >= end: it is over
    ivec3 brick;
    vec3 faces;              // m, where the ray leaves the brick, by axes
    float leaves;            // m, where it does or ends
    DensityBrick here;
};

void enter_brick(inout DensityWalk w) {
    vec3 corner = vec3(w.brick) + vec3(greaterThan(w.direction, vec3(0)));
    w.faces = (corner * BRICK_CELLS - w.origin) / w.direction;
    w.leaves = clamp(least_of(w.faces), w.t, w.end);
    w.here = brick_of(w.grid, w.brick);
}

DensityWalk begin_walk(GridRef ref, MediumRay ray) {
    DensityWalk w;
    w.grid = density_grids[ref.index];
    w.origin = w.grid.lattice_from_world * vec4(ray.origin, 1.0);
    w.direction = mat3(w.grid.lattice_from_world) * ray.direction;
    // Along a face of the lattice: so slightly aslant that no ray notices.
    float slight = 1e-9 * greatest_of(abs(w.direction));
    w.direction = mix(w.direction, vec3(slight), lessThan(abs(w.direction), vec3(slight)));
    vec3 a = -w.origin / w.direction, b = (vec3(w.grid.cells) - w.origin) / w.direction;
    w.t = max(greatest_of(min(a, b)), 0.0);
    w.end = min(least_of(max(a, b)), ray.distance);
    w.brick = ivec3(0);
    if (w.t < w.end) {
        vec3 p = (w.origin + w.t * w.direction) / BRICK_CELLS;
        w.brick = clamp(ivec3(p), ivec3(0), ivec3(brick_counts(w.grid)) - 1);
        enter_brick(w);
    }
    return w;
}

// From the end of a brick into the next one.
void next_brick(inout DensityWalk w) {
    w.t = w.leaves;
    if (w.t >= w.end) return;
    bvec3 crossed = lessThanEqual(w.faces, vec3(w.t));
    w.brick += mix(ivec3(0), mix(ivec3(-1), ivec3(1), greaterThan(w.direction, vec3(0))), crossed);
    if (any(lessThan(w.brick, ivec3(0))) || any(greaterThanEqual(w.brick, ivec3(brick_counts(w.grid))))) w.t = w.end;
    else enter_brick(w);
}

// 1/m. Light that collides more often does so within a 64th of a cell, or what the distance is rounded by, which is less than
// a lattice can say: tracking takes what is thicker for this. So a spike in a file, or a file whose extent is out of proportion,
// costs no more than the bricks on the way, and steps never become too short to be taken.
float walk_greatest_rate(DensityWalk w) {
    return min(64.0 * length(w.direction), 0.5 / (EPSILON * w.end));
}

// Where the walk is.
float walk_density(DensityWalk w) {
    return brick_density(w.here, w.origin + w.t * w.direction - vec3(w.brick) * BRICK_CELLS);
}
