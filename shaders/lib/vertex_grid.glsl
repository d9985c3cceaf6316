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

// Vertices that merge with rays (lib/beam_query.glsl) lie in cells as if their radius were so many times as large, since most
// cells of a ray are empty. 8 was the fastest of 2, 4, 8 and 16.
const float BEAM_CELL_SCALE = 8.0;

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

// A walk over the vertices around a point. A lane has one at a time: its lists are not in the struct.
struct GridQuery {
    vec3 position;
    float radius2;      // m²
    uint next, end;     // candidates of the cell being walked: places in grid_entries
    uint cells;         // to be walked after it: in grid_query_cells
    uint found, given;  // in grid_query_found; how many of them the caller has had
};
const uint GRID_QUERY_ROOM = 16u;
uvec2 grid_query_cells[16];             // where the candidates of a cell start and end; of two levels at most
uint grid_query_found[GRID_QUERY_ROOM];  // vertices within the radius: places in grid_entries

// Lists those of the 2 x 2 x 2 cells of a level that the sphere of the query reaches, unless they are empty. All lanes do
// this together, before they go separate ways.
void list_cells(inout GridQuery q, int level) {
    vec3 p = q.position * cells_a_metre(level);
    vec3 own = floor(p), f = p - own;
    ivec3 cell = ivec3(own), other = cell + mix(ivec3(1), ivec3(-1), lessThan(f, vec3(0.5)));
    vec3 d = min(f, 1.0 - f) * cell_side(level);  // to the faces that part the two cells of each axis
    d *= d;
    float limit = q.radius2 * 1.00001;  // rounding never loses a cell
    for (uint k = 0u; k < 8u; ++k) {
        bvec3 aside = bvec3(k & 1u, k & 2u, k & 4u);
        vec3 e = mix(vec3(0), d, aside);
        if (e.x + e.y + e.z <= limit) {
            uint bucket = grid_bucket(mix(cell, other, aside), level);
            uint first = bucket_starts[bucket], end = bucket_starts[bucket + 1u];
            grid_query_cells[q.cells] = uvec2(first, end);
            q.cells += end > first ? 1u : 0u;
        }
    }
}

// All light vertices of the grid within `radius` = r(position), in m.
void begin_query(out GridQuery q, vec3 position, float radius) {
    float extent = largest_coordinate(position);
    float reach = radius * 1.00001;
    q.position = position;
    q.radius2 = radius * radius;
    q.next = q.end = q.cells = q.found = q.given = 0u;
    int lower = grid_level(0.95 * radius, max(extent - reach, 0.0));
    int upper = grid_level(1.05 * radius, extent + reach);
    for (int level = 0; level < 2; ++level)  // no loop that lanes leave one by one (see features/light_selection.glsl)
        if (lower + level <= upper) list_cells(q, lower + level);
}

// Walks on until the list of what is found is full or no candidates are left. A step of the loop enters at most one cell and
// looks at one candidate, and the lanes leave it together.
void find_vertices(inout GridQuery q, bool wanted) {
    bool walking = wanted;
    do {
        if (walking) {
            if (q.next == q.end && q.cells > 0u) {
                q.cells--;
                q.next = grid_query_cells[q.cells].x;
                q.end = grid_query_cells[q.cells].y;
            }
            walking = q.next < q.end;
            if (walking) {
                vec3 d = grid_entries[q.next].xyz - q.position;
                precise float d2 = d.x * d.x + d.y * d.y + d.z * d.z;
                grid_query_found[q.found] = q.next;
                q.found += d2 <= q.radius2 ? 1u : 0u;
                q.next++;
                walking = q.found < GRID_QUERY_ROOM;
            }
        }
    } while (subgroupAny(walking));
}

// The next vertex within the radius; false when there are no more. Each comes once, in an order that does not depend on other
// lanes. Vertices are found ahead of their use, so that lanes whose neighbours come late do not hold up the caller's work.
bool next_candidate(inout GridQuery q, out uint vertex, out vec3 position) {
    vertex = NO_LIGHT_VERTEX;
    position = q.position;
    bool wanted = q.given == q.found;
    if (subgroupAny(wanted)) {
        if (wanted) q.given = q.found = 0u;
        find_vertices(q, wanted);
    }
    if (q.given == q.found) return false;
    vec4 entry = grid_entries[grid_query_found[q.given]];
    q.given++;
    vertex = floatBitsToUint(entry.w);
    position = entry.xyz;
    return true;
}
