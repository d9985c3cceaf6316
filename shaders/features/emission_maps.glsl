// Where on a light: in proportion to how bright its parts are, where textures or alpha make them differ, by trees that the host
// builds (host/lights/emission_map.h).
//
// A tree divides the triangle into four parts of equal area, and these again. Numbers are stretched anew at each step, the first by the
// choice between pairs of parts, the second within the pair, so that points stay stratified.
#include "features/defaults.glsl"

#if HAS_EMISSION_MAPS
#include "lib/primitives.glsl"

// A cell and its four parts: those at its corners, then the one between them, which is turned around.
struct EmissionNode {
    vec4 shares;  // probabilities of the parts
    uvec4 parts;  // the node of each; NO_RECORD = even
};
struct EmissionRoot {
    uint node;   // of the whole; NO_RECORD = even
    float part;  // of the material's emission, before textures and alpha, that the surface sends out, by luminance
};
layout(scalar, set = 0) readonly buffer EmissionNodes { EmissionNode emission_nodes[]; };
layout(scalar, set = 0) readonly buffer EmissionRoots { EmissionRoot emission_roots[]; };  // of each primitive

float emitted_part(uint primitive) { return emission_roots[primitive].part; }

// A number below `a` of a + b; stretched anew over its part.
bool chooses_second(float a, float b, inout float u) {
    float x = u * (a + b);
    bool second = b > 0.0 && !(x < a);
    u = clamp(second ? (x - a) / b : x / a, 0.0, 1.0 - EPSILON);
    return second;
}

// Uniform numbers to those by which points are sampled evenly; `density` is that of the points, relative to even ones.
// (The loops: see features/light_selection.glsl.)
vec2 map_emission(uint primitive, vec2 u, out float density) {
    uint node = emission_roots[primitive].node;
    density = 1.0;
    if (node == NO_RECORD) return u;
    vec2 corner = vec2(0);
    float size = 1.0;
    bool done = false;
    do {
        EmissionNode n = emission_nodes[done ? 0u : node];
        vec2 v = u;
        bool upper = chooses_second(n.shares.x + n.shares.y, n.shares.z + n.shares.w, v.x);
        bool right = chooses_second(upper ? n.shares.z : n.shares.x, upper ? n.shares.w : n.shares.y, v.y);
        uint k = (upper ? 2u : 0u) + (right ? 1u : 0u);
        float half_size = 0.5 * size;
        corner = done ? corner : corner + half_size * vec2(right, upper);
        size = done ? size : k == 3u ? -half_size : half_size;
        density = done ? density : density * 4.0 * n.shares[k];
        u = done ? u : v;
        node = done ? node : n.parts[k];
        done = node == NO_RECORD;
    } while (subgroupAny(!done));
    return unwarp_triangle(corner + size * warp_triangle(u));
}

// That density at a point.
float emission_density(uint primitive, vec3 position) {
    uint node = emission_roots[primitive].node;
    if (node == NO_RECORD) return 1.0;
    vec2 b = triangle_weights(primitives[primitive], position).yz;
    float density = 1.0;
    bool done = false;
    do {
        EmissionNode n = emission_nodes[done ? 0u : node];
        b *= 2.0;
        uint k = b.x > 1.0 ? 1u : b.y > 1.0 ? 2u : b.x + b.y < 1.0 ? 0u : 3u;
        b -= vec2(k == 1u || k == 3u, k >= 2u);
        if (k == 3u) b = -b;
        density = done ? density : density * 4.0 * n.shares[k];
        node = done ? node : n.parts[k];
        done = node == NO_RECORD;
    } while (subgroupAny(!done));
    return density;
}

// From the density of even points.
#define by_emission(density, factor) density *= factor
#else
#define by_emission(density, factor)
#define emitted_part(primitive) 1.0
#define map_emission(primitive, u, density) u
#endif
