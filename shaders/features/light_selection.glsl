// Which light a point asks: lights are chosen in proportion to an estimate of their illuminance there.
//
// Lights are numbered so that those at infinity come first. These share LIGHTS_AT_INFINITY /
// (LIGHTS_AT_INFINITY + 1) of the choices equally; the rest goes to the finite ones. A few of them are
// compared one by one; more are found by a stochastic descent of a tree whose nodes bound position, intensity
// and directions of four sets each (Conty Estévez & Kulla 2018, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting", where it is binary: with four, half as many choices are made from coarse bounds
// for the same work). host/lights/light_tree.h builds it. The receiving normal is left out, so that a ray that
// hits a light later can tell the probability from its origin alone.
//
// Lights within optical elements come last. There, one of the same element is chosen, all with the same probability.
//
// The host defines LIGHT_COUNT, SCENE_LIGHT_COUNT (those that are in no element), INFINITE_LIGHT_COUNT and HAS_LIGHT_TREE (0: the
// nodes are a list, to be read in order).
#include "features/elements.glsl"

#include "lib/constants.glsl"
#include "lib/records.glsl"

layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };  // RecordRefs

const bool HAS_LIGHTS = LIGHT_COUNT > 0;
const uint FINITE_LIGHT_COUNT = uint(SCENE_LIGHT_COUNT - INFINITE_LIGHT_COUNT);
const float INFINITE_LIGHT_PROBABILITY = 
    1.0 / float(max(1, INFINITE_LIGHT_COUNT + (SCENE_LIGHT_COUNT > INFINITE_LIGHT_COUNT ? 1 : 0)));
const float FINITE_LIGHTS_PROBABILITY = INFINITE_LIGHT_COUNT > 0 ? INFINITE_LIGHT_PROBABILITY : 1.0;

// Takes the first of two outcomes with probability p and stretches u in [0,1) anew over the outcome's part.
bool choose_first(float p, inout float u) {
    bool first = u < p;
    u = min(first ? u / p : (u - p) / (1.0 - p), 1.0 - EPSILON);
    return first;
}

#if SCENE_LIGHT_COUNT > 1 && SCENE_LIGHT_COUNT > INFINITE_LIGHT_COUNT
// Four sets of finite lights, component by component; 128 bytes.
struct LightNode {
    vec4 x, y, z;      // m, centre of a sphere around all lights of the set
    vec4 radius;       // m
    vec4 intensity;    // cd, largest over directions
    uvec4 axes;        // of the set's LightCone: octahedral, 2 x 16 bits
    uvec4 cosines;     // 2 x 16 bits: of its normals lower, of its emission upper; never too narrow
    uvec4 children;    // index of a node, or LIGHT_LEAF + the light's number; NO_RECORD = empty
};
const uint LIGHT_LEAF = 0x80000000u;

layout(scalar, set = 0) readonly buffer LightNodes { LightNode light_nodes[]; };
// Per light: bits 2k and 2k + 1 are the child taken at depth k; without a tree its place in the list.
layout(scalar, set = 0) readonly buffer LightTrails { uint light_trails[]; };

vec4 lower_snorm(uvec4 v) { return max(vec4(ivec4(v << 16) >> 16) * (1.0 / 32767.0), -1.0); }
vec4 upper_snorm(uvec4 v) { return max(vec4(ivec4(v) >> 16) * (1.0 / 32767.0), -1.0); }

// Estimate of the illuminance that each set of lights causes at a point that faces it: intensity * cosine /
// d². With w the angle between the axis and the direction to the point, n the spread of the normals and b the
// half angle under which the set appears, no light of it leaves at less than w - n - b (equations 1 to 3 of
// the paper): the set counts as dark only where that exceeds the angle of emission. The cosine itself is that
// of w - n, as if all lights stood in the centre, which halves the variance beside the paper's bound, and a
// part of the bound where that is larger. Distances below half the radius are taken as that: the set
// surrounds the point. (A quarter of the squared radius, not all of it, takes away two thirds of the variance
// with ten thousand lights; for a single surface it is its largest illuminance, within 4 / pi.)
vec4 node_importances(uint node, vec3 point, out uvec4 children) {
    LightNode n = light_nodes[node];
    children = n.children;
    vec4 dx = point.x - n.x, dy = point.y - n.y, dz = point.z - n.z;
    vec4 d2 = dx * dx + dy * dy + dz * dz, r2 = n.radius * n.radius;

    vec4 ax = lower_snorm(n.axes), ay = upper_snorm(n.axes), az = 1.0 - abs(ax) - abs(ay);
    vec4 fold = max(-az, 0.0);
    ax += mix(fold, -fold, greaterThanEqual(ax, vec4(0)));
    ay += mix(fold, -fold, greaterThanEqual(ay, vec4(0)));
    vec4 scale = (ax * ax + ay * ay + az * az) * d2;
    vec4 cos_w = clamp((ax * dx + ay * dy + az * dz) * inversesqrt(max(scale, 1e-36)), -1.0, 1.0);
    vec4 sin_w = sqrt(1.0 - cos_w * cos_w);
    vec4 cos_n = lower_snorm(n.cosines), cos_e = upper_snorm(n.cosines);
    vec4 sin_n = sqrt(1.0 - cos_n * cos_n);

    // x = w - n, then y = x - b; angles below zero count as zero.
    bvec4 within = greaterThanEqual(cos_w, cos_n);
    vec4 cos_x = mix(cos_w * cos_n + sin_w * sin_n, vec4(1), within);
    vec4 sin_x = mix(sin_w * cos_n - cos_w * sin_n, vec4(0), within);
    vec4 sin_b2 = min(r2 / max(d2, 1e-36), 1.0);
    vec4 cos_b = mix(sqrt(1.0 - sin_b2), vec4(-1), lessThanEqual(d2, r2));
    vec4 cos_y = mix(cos_x * cos_b + sin_x * sqrt(sin_b2), vec4(1), greaterThanEqual(cos_x, cos_b));

    vec4 cosine = max(cos_x, 0.3 * cos_y);
    vec4 importance = min(n.intensity * cosine / max(max(d2, 0.25 * r2), 1e-36), INFINITY);
    return mix(vec4(0), importance, greaterThan(cos_y, max(cos_e, 0.0)));
}

// One of four with probability in proportion to `w`, whose sum must be positive; u in [0,1) is stretched
// anew.
uint choose_of_four(vec4 w, inout float u, out float weight) {
    float a = w.x, b = a + w.y, c = b + w.z;
    float x = u * (c + w.w);
    uint k = x < a ? 0u : x < b ? 1u : x < c ? 2u : 3u;
    weight = k == 0u ? w.x : k == 1u ? w.y : k == 2u ? w.z : w.w;
    float start = k == 0u ? 0.0 : k == 1u ? a : k == 2u ? b : c;
    u = clamp((x - start) / weight, 0.0, 1.0 - EPSILON);
    return k;
}
float sum_of_four(vec4 w) { return w.x + w.y + w.z + w.w; }
uint pick(uvec4 v, uint k) { return k == 0u ? v.x : k == 1u ? v.y : k == 2u ? v.z : v.w; }
float pick(vec4 v, uint k) { return k == 0u ? v.x : k == 1u ? v.y : k == 2u ? v.z : v.w; }

// Among the finite lights. The lanes of a subgroup leave the loop together: values carried out of a loop that
// lanes leave one by one come out wrong on SwiftShader and on Mesa 22.3.
uint select_finite_light(vec3 point, inout float u, out float probability) {
    uvec4 children;
    float weight;
#if HAS_LIGHT_TREE
    probability = 1.0;
    uint node = 0u;
    bool done = false;
    do {
        vec4 w = node_importances(done ? 0u : node, point, children);
        float sum = sum_of_four(w);
        bool dark = !(sum > 0.0);
        float v = u;
        uint next = pick(children, choose_of_four(dark ? vec4(1, 0, 0, 0) : w, v, weight));
        u = done ? u : v;
        probability = done ? probability : dark ? 0.0 : probability * (weight / sum);
        node = done ? node : next;
        done = node >= LIGHT_LEAF || !(probability > 0.0);
    } while (subgroupAny(!done));
    return probability > 0.0 ? node - LIGHT_LEAF : uint(INFINITE_LIGHT_COUNT);
#else
    // One pass: each node takes the place of the one chosen so far with probability its sum / sum so far.
    float sum = 0.0;
    vec4 chosen = vec4(0);
    uvec4 chosen_children = uvec4(LIGHT_LEAF + uint(INFINITE_LIGHT_COUNT));
    for (uint node = 0u; 4u * node < FINITE_LIGHT_COUNT; node++) {
        vec4 w = node_importances(node, point, children);
        float part = sum_of_four(w);
        sum += part;
        bool take = part > 0.0 && choose_first(part / sum, u);
        chosen = take ? w : chosen;
        chosen_children = take ? children : chosen_children;
    }
    bool dark = !(sum > 0.0);
    uint k = choose_of_four(dark ? vec4(1, 0, 0, 0) : chosen, u, weight);
    probability = dark ? 0.0 : weight / sum;
    return pick(chosen_children, k) - LIGHT_LEAF;
#endif
}

float finite_light_probability(uint light, vec3 point) {
    uint trail = light_trails[light];
    uvec4 children;
#if HAS_LIGHT_TREE
    float probability = 1.0;
    uint node = 0u;
    bool done = false;
    do {
        vec4 w = node_importances(done ? 0u : node, point, children);
        float sum = sum_of_four(w);
        uint k = trail & 3u;
        trail >>= 2;
        probability = done ? probability : sum > 0.0 ? probability * (pick(w, k) / sum) : 0.0;
        node = done ? node : pick(children, k);
        done = node >= LIGHT_LEAF || !(probability > 0.0);
    } while (subgroupAny(!done));
    return probability;
#else
    float sum = 0.0, own = 0.0;
    for (uint node = 0u; 4u * node < FINITE_LIGHT_COUNT; node++) {
        vec4 w = node_importances(node, point, children);
        sum += sum_of_four(w);
        own = trail >> 2 == node ? pick(w, trail & 3u) : own;
    }
    return sum > 0.0 ? own / sum : 0.0;
#endif
}
#endif

// A light for `point`; `u_remapped` is u stretched anew for further use. Probability 0: no light reaches the
// point.
uint select_light(vec3 point, float u, out float probability, out float u_remapped) {
    u_remapped = u;
    probability = 1.0;
#if SCENE_LIGHT_COUNT <= 1
    return 0u;
#elif SCENE_LIGHT_COUNT == INFINITE_LIGHT_COUNT
    u_remapped *= float(SCENE_LIGHT_COUNT);
    uint light = min(uint(u_remapped), uint(SCENE_LIGHT_COUNT) - 1u);
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

#if HAS_ELEMENTS
#define SELECTS_LIGHTS true
// … where the point is in an element, or in the scene.
uint select_light_at(uint element, vec3 point, float u, out float probability) {
    float unused;
    Element e = elements[element];
    bool is_scene = element == NOT_IN_ELEMENT;
    probability = 0.0;
    if (is_scene && SCENE_LIGHT_COUNT > 0) return select_light(point, u, probability, unused);
    if (is_scene || e.light_count == 0u) return 0u;
    probability = 1.0 / float(e.light_count);
    return e.first_light + min(uint(u * float(e.light_count)), e.light_count - 1u);
}
#else
#define SELECTS_LIGHTS (LIGHT_COUNT > 1)
uint select_light_at(uint element, vec3 point, float u, out float probability) {
    float unused;
    return select_light(point, u, probability, unused);
}
#endif

// The probability with which select_light_at chooses `light` for `point`, where it is.
float light_selection_probability(uint light, vec3 point) {
#if HAS_ELEMENTS
    if (light >= uint(SCENE_LIGHT_COUNT)) return 1.0 / float(elements[light_elements[light]].light_count);
#endif
#if SCENE_LIGHT_COUNT <= 1
    return 1.0;
#elif SCENE_LIGHT_COUNT == INFINITE_LIGHT_COUNT
    return INFINITE_LIGHT_PROBABILITY;
#else
    if (light < uint(INFINITE_LIGHT_COUNT)) return INFINITE_LIGHT_PROBABILITY;
    return FINITE_LIGHTS_PROBABILITY * finite_light_probability(light, point);
#endif
}
