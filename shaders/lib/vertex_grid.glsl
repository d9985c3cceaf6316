// Light vertices by place: which of them lie within a merging radius of a point. A spatial hash (Teschner et al. 2003) of cells
// whose side follows the radius, with the vertices of a bucket side by side in memory.
//
// The radius is a function r of position alone with |r(y) - r(x)| <= 0.05 |y - x|. A vertex at y lies in the cell of side
// s = 2^level, the least power of two with s >= 2.125 r(y). If |y - x| <= r(x) then r(y) >= 0.95 r(x) and s / 2 > r(x): of the
// cells of a level only those 2 x 2 x 2 nearest x can hold vertices within r(x), and only one level or two neighbouring ones.
// Parities of cell and level are the low bits of a bucket's number. So the cells of a query lie in different buckets, and none of
// its candidates is met twice, whatever else the hash has put there.
//
// Order of work: enter_grid while light paths are traced (counts the vertices of every bucket); then the kernels scan_buckets,
// sort_vertices, order_vertices, order_large_buckets (host/render/vertex_map); then queries. The order within a bucket is
// that of the keys, whatever the order in which vertices were stored.
#include "lib/light_vertices.glsl"

struct GridPlace {
    uint bucket, rank;  // rank: entered before it in the same bucket
    uint key;
};
layout(scalar, set = 0) buffer GridPlaces { GridPlace grid_places[]; };  // of every light vertex that merges
// Until the scan the number of vertices of each bucket, then the place of its first in grid_entries; one more for the end.
layout(scalar, set = 0) buffer BucketStarts { uint bucket_starts[]; };
layout(scalar, set = 0) buffer GridEntries { vec4 grid_entries[]; };  // position, index of the light vertex as bits

// Between sort_vertices and order_vertices: a vertex at the place of its bucket, in no certain order.
struct GridItem {
    vec3 position;
    uint vertex, key, bucket;
};
const uint LARGE_BUCKET = 512u;  // vertices from which a workgroup sorts a bucket; twin in host/render/vertex_map.cpp

// Sides are 2^(level - 127): the exponent as floats store it. Far from the origin cells are so large that their numbers stay
// below 2^23, which a float holds; that, too, is a function of position, and within r(x) it takes neighbouring levels at most.
// `extent`: largest absolute coordinate.
int grid_level(float radius, float extent) {
    int by_radius = int((floatBitsToUint(2.125 * radius) + 0x7FFFFFu) >> 23);
    int by_extent = int(floatBitsToUint(extent) >> 23) - 22;
    return clamp(max(by_radius, by_extent), 64, 190);
}
float largest_coordinate(vec3 p) { return max(max(abs(p.x), abs(p.y)), abs(p.z)); }
float cell_side(int level) { return uintBitsToFloat(uint(level) << 23); }
float cells_a_metre(int level) { return uintBitsToFloat(uint(254 - level) << 23); }

uint grid_bucket(ivec3 cell, int level) {
    uvec3 block = uvec3(cell >> 1), parity = uvec3(cell & 1);
    // A linear combination with random odd factors, mixed by lowbias32 (Wellons 2018).
    uint h = block.x * 0x8DA6B343u + block.y * 0xD8163841u + block.z * 0xCB1AB31Fu + uint(level >> 1) * 0x9E3779B1u;
    h ^= h >> 16;
    h *= 0x7FEB352Du;
    h ^= h >> 15;
    h *= 0x846CA68Bu;
    h ^= h >> 16;
    return (h << 4 | uint(level & 1) << 3 | parity.z << 2 | parity.y << 1 | parity.x) & bucket_mask;
}

// Of a vertex that append_light_vertex has stored with the flag LIGHT_VERTEX_MERGES. `radius` is r(position), in m; `key` is
// different for all vertices of a pass, and the same whenever the pass is repeated.
void enter_grid(uint vertex, vec3 position, float radius, uint key) {
    int level = grid_level(radius, largest_coordinate(position));
    uint bucket = grid_bucket(ivec3(floor(position * cells_a_metre(level))), level);
    grid_places[vertex] = GridPlace(bucket, atomicAdd(bucket_starts[bucket], 1u), key);
}

struct GridQuery {
    vec3 position;
    float radius2;   // m²
    uint next, end;  // candidates of the cell being walked: places in grid_entries
    uint cells;      // yet to be walked, a bit each: 8 of the lower level, then 8 of the upper. Bits x, y, z of its number: the
                     // neighbour on the nearer side along that axis instead of the cell of `position`
    int level;       // the lower
};

// Those of the 2 x 2 x 2 cells that the sphere of the query reaches; rounding never loses one.
uint reached_cells(vec3 position, float radius2, int level) {
    vec3 p = position * cells_a_metre(level);
    vec3 f = p - floor(p);
    vec3 d = min(f, 1.0 - f) * cell_side(level);  // to the faces that part the two cells of each axis
    d *= d;
    float limit = radius2 * 1.00001;
    uint cells = 1u | (d.x <= limit ? 2u : 0u) | (d.y <= limit ? 4u : 0u) | (d.z <= limit ? 16u : 0u);
    cells |= (d.x + d.y <= limit ? 8u : 0u) | (d.x + d.z <= limit ? 32u : 0u) | (d.y + d.z <= limit ? 64u : 0u);
    return cells | (d.x + d.y + d.z <= limit ? 128u : 0u);
}

// All light vertices of the grid within `radius` = r(position), in m.
void begin_query(out GridQuery q, vec3 position, float radius) {
    float extent = largest_coordinate(position);
    float reach = radius * 1.00001;
    q.position = position;
    q.radius2 = radius * radius;
    q.next = q.end = 0u;
    q.level = grid_level(0.95 * radius, max(extent - reach, 0.0));
    q.cells = reached_cells(position, q.radius2, q.level);
    int upper = grid_level(1.05 * radius, extent + reach);
    if (upper != q.level) q.cells |= reached_cells(position, q.radius2, upper) << 8;
}

void enter_next_cell(inout GridQuery q) {
    uint cell = uint(findLSB(q.cells));
    q.cells &= q.cells - 1u;
    int level = q.level + int(cell >> 3);
    vec3 p = q.position * cells_a_metre(level);
    vec3 own = floor(p);
    ivec3 aside = ivec3(cell, cell >> 1, cell >> 2) & 1;
    aside = mix(aside, -aside, lessThan(p - own, vec3(0.5)));
    uint bucket = grid_bucket(ivec3(own) + aside, level);
    q.next = bucket_starts[bucket];
    q.end = bucket_starts[bucket + 1u];
}

// The next vertex within the radius; false when there are no more. Each vertex comes once, in an order that is certain.
// A step of the loop enters at most one cell and looks at one candidate. The lanes leave it together (see lib/light_selection),
// so that what the caller does with a vertex is done for as many of them as possible at a time.
bool next_candidate(inout GridQuery q, out uint vertex, out vec3 position) {
    vertex = NO_LIGHT_VERTEX;
    position = q.position;
    bool searching = true;
    do {
        if (searching) {
            if (q.next >= q.end && q.cells != 0u) enter_next_cell(q);
            if (q.next < q.end) {
                vec4 entry = grid_entries[q.next];
                q.next++;
                vec3 d = entry.xyz - q.position;
                precise float d2 = d.x * d.x + d.y * d.y + d.z * d.z;
                if (d2 <= q.radius2) {
                    vertex = floatBitsToUint(entry.w);
                    position = entry.xyz;
                    searching = false;
                }
            } else if (q.cells == 0u) {
                searching = false;
            }
        }
    } while (subgroupAny(searching));
    return vertex != NO_LIGHT_VERTEX;
}
