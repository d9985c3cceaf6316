// Bodies whose meshes overlap, by priority (Schmidt & Budge 2002, "Simple Nested Dielectrics in Ray Traced Images"). Rays count
// the bodies that they are inside; the medium is that of the body with the highest priority, and a face that does not change
// which body that is, is not there. What has no priority comes after all that have one.
#include "lib/records.glsl"

#if HAS_PRIORITIES
// Media of the materials with a priority, the highest first: materials[…].body is the place in this list, of 16 at most.
layout(scalar, set = 0) readonly buffer BodyMedia { uint body_media[]; };
const uint NO_BODY = 16u;

// Where a ray is.
struct Bodies {
    uvec2 counts;  // four bits a material of the list, the first lowest: how many of its bodies the ray is inside
    uint medium;   // around them: of what has no priority
};

Bodies no_bodies() { return Bodies(uvec2(0), NO_RECORD); }

// The one with the highest priority, or NO_BODY.
uint first_body(Bodies b) {
    if (b.counts.x != 0u) return uint(findLSB(b.counts.x)) / 4u;
    return b.counts.y != 0u ? 8u + uint(findLSB(b.counts.y)) / 4u : NO_BODY;
}

uint medium_among(Bodies b) {
    uint body = first_body(b);
    return body == NO_BODY ? b.medium : body_media[body];
}

uint count_shift(uint body) { return 4u * (body & 7u); }
uint body_count(Bodies b, uint body) { return ((body < 8u ? b.counts.x : b.counts.y) >> count_shift(body)) & 15u; }

void add_to_count(inout Bodies b, uint body, uint n) {
    uint bits = n << count_shift(body);
    b.counts += body < 8u ? uvec2(bits, 0u) : uvec2(0u, bits);
}

// Counts end at 15 and at 0: meshes that are not closed may make the medium wrong, and nothing else.
void enter_body(inout Bodies b, uint body) {
    if (body_count(b, body) < 15u) add_to_count(b, body, 1u);
}
void leave_body(inout Bodies b, uint body) {
    if (body_count(b, body) > 0u) add_to_count(b, body, ~0u);
}
#endif
