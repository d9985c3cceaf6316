// Which light a point asks: lights are chosen in proportion to an estimate of their illuminance there.
//
// Lights are numbered so that those at infinity come first. These share LIGHTS_AT_INFINITY / (LIGHTS_AT_INFINITY + 1) of the
// choices equally; the rest goes to the finite ones. Up to a few of them are compared one by one; more are found by a
// stochastic descent of a binary tree whose nodes bound position, intensity and directions (Conty Estévez & Kulla 2018,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting"; host/scene/light_tree.h builds it). The receiving
// normal is left out, so that a ray that hits a light later can tell the probability from its origin alone.
//
// The host defines LIGHT_COUNT, INFINITE_LIGHT_COUNT and HAS_LIGHT_TREE (0: the nodes are a list, to be read in order).

#include "lib/constants.glsl"
#include "lib/records.glsl"

layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };  // RecordRefs

const uint FINITE_LIGHT_COUNT = uint(LIGHT_COUNT - INFINITE_LIGHT_COUNT);
const float INFINITE_LIGHT_PROBABILITY = 
    1.0 / float(max(1, INFINITE_LIGHT_COUNT + (LIGHT_COUNT > INFINITE_LIGHT_COUNT ? 1 : 0)));
const float FINITE_LIGHTS_PROBABILITY = INFINITE_LIGHT_COUNT > 0 ? INFINITE_LIGHT_PROBABILITY : 1.0;

// Takes the first of two outcomes with probability p and stretches u in [0,1) anew over the outcome's part.
bool choose_first(float p, inout float u) {
    bool first = u < p;
    u = min(first ? u / p : (u - p) / (1.0 - p), 1.0 - EPSILON);
    return first;
}

#if LIGHT_COUNT > 1 && LIGHT_COUNT > INFINITE_LIGHT_COUNT
// A set of finite lights. Two clusters make a node of 64 bytes.
struct LightCluster {
    vec3 center;      // m
    float radius;     // m, of a sphere around all its lights
    float intensity;  // cd, largest over directions
    uint axis;        // octahedral, 2 x 16 bits
    uint cosines;     // of the angles of LightCone, 2 x 16 bits: normals lower, emission upper; never too narrow
    uint child;       // index of a node, or LIGHT_LEAF + the light's number; NO_RECORD = empty
};
const uint LIGHT_LEAF = 0x80000000u;

layout(scalar, set = 0) readonly buffer LightNodes { uvec4 light_nodes[]; };  // 4 a node: two LightClusters
// Per light: bit k = child taken at depth k; without a tree: its position in the list.
layout(scalar, set = 0) readonly buffer LightTrails { uint light_trails[]; };

vec3 octahedral_direction(uint packed_axis) {
    vec2 p = unpackSnorm2x16(packed_axis);
    vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-v.z, 0.0);
    v.x += v.x >= 0.0 ? -fold : fold;
    v.y += v.y >= 0.0 ? -fold : fold;
    return normalize(v);
}

// Bound of the illuminance that a cluster can cause at a point that faces it: intensity * cos(max(0, w - n - b)) / d², with
// w the angle between its axis and the direction to the point, n the spread of its normals, b the half angle under which
// it appears (equations 1 to 3 of the paper). Zero where no light of the cluster shines.
float cluster_importance(uvec4 a, uvec4 b, vec3 point) {
    vec4 sphere = uintBitsToFloat(a);
    vec3 d = point - sphere.xyz;
    float d2 = dot(d, d), r2 = sphere.w * sphere.w;
    vec2 cosines = unpackSnorm2x16(b.z);
    float cos_n = cosines.x, cos_e = cosines.y;
    float sin_n = sqrt(max(0.0, 1.0 - cos_n * cos_n));
    // x = w - n, then y = x - b; angles below zero count as zero.
    float cos_w = clamp(dot(octahedral_direction(b.y), d) * inversesqrt(max(d2, 1e-36)), -1.0, 1.0);
    float sin_w = sqrt(1.0 - cos_w * cos_w);
    bool within = cos_w >= cos_n;
    float cos_x = within ? 1.0 : cos_w * cos_n + sin_w * sin_n;
    float sin_x = within ? 0.0 : sin_w * cos_n - cos_w * sin_n;
    float sin_b2 = min(r2 / max(d2, 1e-36), 1.0);
    float cos_b = sqrt(1.0 - sin_b2);
    bool seen = cos_x >= cos_b || d2 <= r2;
    float cos_y = seen ? 1.0 : cos_x * cos_b + sin_x * sqrt(sin_b2);
    float importance = uintBitsToFloat(b.x) * max(cos_y, 0.0) / max(max(d2, r2), 1e-36);
    return cos_y >= cos_e && b.w != NO_RECORD ? min(importance, INFINITY) : 0.0;
}

// Importance of the two clusters of a node, and where they lead.
vec2 node_importances(uint node, vec3 point, out uvec2 children) {
    uvec4 a0 = light_nodes[4u * node], b0 = light_nodes[4u * node + 1u];
    uvec4 a1 = light_nodes[4u * node + 2u], b1 = light_nodes[4u * node + 3u];
    children = uvec2(b0.w, b1.w);
    return vec2(cluster_importance(a0, b0, point), cluster_importance(a1, b1, point));
}

// Among the finite lights.
uint select_finite_light(vec3 point, inout float u, out float probability) {
    uvec2 children;
#if HAS_LIGHT_TREE
    probability = 1.0;
    uint node = 0u;
    do {
        vec2 w = node_importances(node, point, children);
        float sum = w.x + w.y;
        bool first = choose_first(sum > 0.0 ? w.x / sum : 0.5, u);
        probability = sum > 0.0 ? probability * ((first ? w.x : w.y) / sum) : 0.0;
        node = first ? children.x : children.y;
    } while (node < LIGHT_LEAF);
    return node - LIGHT_LEAF;
#else
    // One pass: each cluster replaces the choice so far with probability importance / sum so far.
    float sum = 0.0, chosen = 0.0;
    uint light = uint(INFINITE_LIGHT_COUNT);
    for (uint node = 0u; 2u * node < FINITE_LIGHT_COUNT; node++) {
        vec2 w = node_importances(node, point, children);
        for (int i = 0; i < 2; i++) {
            float importance = i == 0 ? w.x : w.y;
            sum += importance;
            bool take = importance > 0.0 && choose_first(importance / sum, u);
            light = take ? (i == 0 ? children.x : children.y) - LIGHT_LEAF : light;
            chosen = take ? importance : chosen;
        }
    }
    probability = sum > 0.0 ? chosen / sum : 0.0;
    return light;
#endif
}

float finite_light_probability(uint light, vec3 point) {
    uint trail = light_trails[light];
    uvec2 children;
#if HAS_LIGHT_TREE
    float probability = 1.0;
    uint node = 0u;
    do {
        vec2 w = node_importances(node, point, children);
        float sum = w.x + w.y;
        bool first = (trail & 1u) == 0u;
        trail >>= 1;
        probability = sum > 0.0 ? probability * ((first ? w.x : w.y) / sum) : 0.0;
        node = first ? children.x : children.y;
    } while (node < LIGHT_LEAF);
    return probability;
#else
    float sum = 0.0, own = 0.0;
    for (uint node = 0u; 2u * node < FINITE_LIGHT_COUNT; node++) {
        vec2 w = node_importances(node, point, children);
        sum += w.x + w.y;
        own = trail == 2u * node ? w.x : trail == 2u * node + 1u ? w.y : own;
    }
    return sum > 0.0 ? own / sum : 0.0;
#endif
}

#endif

// A light for `point`; `u_remapped` is u stretched anew for further use. Probability 0: no light reaches the point.
uint select_light(vec3 point, float u, out float probability, out float u_remapped) {
    u_remapped = u;
    probability = 1.0;
#if LIGHT_COUNT <= 1
    return 0u;
#elif LIGHT_COUNT == INFINITE_LIGHT_COUNT
    u_remapped *= float(LIGHT_COUNT);
    uint light = min(uint(u_remapped), uint(LIGHT_COUNT) - 1u);
    u_remapped = min(u_remapped - float(light), 1.0 - EPSILON);
    probability = INFINITE_LIGHT_PROBABILITY;
    return light;
#else
    uint light = 0u;
    bool finite = choose_first(FINITE_LIGHTS_PROBABILITY, u_remapped);
    if (finite) {
        light = select_finite_light(point, u_remapped, probability);
    } else {
        u_remapped *= float(INFINITE_LIGHT_COUNT);
        light = min(uint(u_remapped), uint(max(INFINITE_LIGHT_COUNT, 1)) - 1u);
        u_remapped = min(u_remapped - float(light), 1.0 - EPSILON);
    }
    probability *= FINITE_LIGHTS_PROBABILITY;  // of each light at infinity, too
    return light;
#endif
}

// The probability with which select_light chooses `light` for `point`.
float light_selection_probability(uint light, vec3 point) {
#if LIGHT_COUNT <= 1
    return 1.0;
#elif LIGHT_COUNT == INFINITE_LIGHT_COUNT
    return INFINITE_LIGHT_PROBABILITY;
#else
    if (light < uint(INFINITE_LIGHT_COUNT)) return INFINITE_LIGHT_PROBABILITY;
    return FINITE_LIGHTS_PROBABILITY * finite_light_probability(light, point);
#endif
}
