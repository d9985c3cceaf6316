// The vertices of light paths, kept for the camera paths of the same pass. A VertexMap of the host owns the buffers.
#include "features/spectrum.glsl"
#include "lib/member_if.glsl"
#include "lib/octahedral.glsl"
#include "lib/records.glsl"

const uint POLARIZATION_WORDS = (3u * LANES + 1u) / 2u;
struct PackedPolarization { uint words[POLARIZATION_WORDS]; };  // features/polarization.glsl

// 64 bytes; 4 more with wavelengths, of which there are four, 4 with bodies that have priorities or with layers of light, 20 or 24 with polarization.
struct LightVertex {
    vec3 position;    // m
    float vcm;        // dVCM of Georgiev 2012, "Implementing Vertex Connection and Merging"
    Spectrum throughput;  // relative flux
    float vc;         // dVC there
    vec2 direction;   // towards where the light came from; encode_octahedral
    uint normal;      // geometric; encode_octahedral_16. Within a medium its RecordRef
    uint instance;    // with uv and primitive: the hit, to locate it again
    vec2 uv;
    uint primitive;   // NO_RECORD within a medium
    uint previous;    // light_vertex_link
    MEMBER_IF(HAS_POLARIZATION, PackedPolarization polarization;)
    MEMBER_IF(HAS_LIGHT_LAYERS, uint history;)     // of the light that arrives
    MEMBER_IF(HAS_PRIORITIES, uint medium_above;)  // on the side of the normal (features/bodies.glsl)
};

const uint NO_LIGHT_VERTEX = 0x0FFFFFFFu;
const uint LIGHT_VERTEX_MERGES = 0x10000000u;  // it is in the grid of lib/vertex_grid.glsl
const uint LIGHT_VERTEX_FLAGS = 0xF0000000u;   // the others are free for the algorithm

// `vertex` before this one on its path, or NO_LIGHT_VERTEX, and flags.
uint light_vertex_link(uint vertex, uint flags) { return (vertex & ~LIGHT_VERTEX_FLAGS) | (flags & LIGHT_VERTEX_FLAGS); }

layout(scalar, set = 0) buffer LightVertices { LightVertex light_vertices[]; };

layout(scalar, set = 0) buffer LightVertexCounts {
    uint light_vertex_capacity;  // below NO_LIGHT_VERTEX
    uint bucket_mask;            // buckets of the grid - 1; their number is a power of two, at least 16
    uint wanted_light_vertices;  // more than the capacity: the rest was not stored
    uint large_bucket_count;     // of lib/vertex_grid.glsl
};

uint stored_light_vertices() { return min(wanted_light_vertices, light_vertex_capacity); }

// Stores a vertex at the next free place, in no certain order, and returns the place; NO_LIGHT_VERTEX where all are taken.
// An atomic for each lane, so that any lanes may call it, wherever they are: with a ballot it takes as long (30 ns, lavapipe).
uint append_light_vertex(LightVertex vertex) {
    uint place = atomicAdd(wanted_light_vertices, 1u);
    if (place >= light_vertex_capacity) return NO_LIGHT_VERTEX;
    light_vertices[place] = vertex;
    return place;
}
