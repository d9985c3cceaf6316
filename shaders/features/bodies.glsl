// What a ray is in: a medium, and with priorities the bodies whose meshes overlap there (Schmidt & Budge 2002, "Simple Nested
// Dielectrics in Ray Traced Images"). Rays count the bodies that they are inside; the medium is that of the body with the highest
// priority, and a face that does not change which body that is, is not there. What has no priority comes after all that have one.
#include "lib/member_if.glsl"
#include "lib/records.glsl"

struct Surroundings {
    uint medium;                              // RecordRef of the medium that a ray is in; NO_RECORD = vacuum
    MEMBER_IF(HAS_PRIORITIES, uint outer;)    // … of the one around the bodies: of what has no priority
    MEMBER_IF(HAS_PRIORITIES, uvec2 counts;)  // four bits a material of the list, the first lowest: how many of its bodies it is in
};

#if HAS_PRIORITIES
// Media of the materials with a priority, the highest first: materials[…].body is the place in this list, of 16 at most.
layout(scalar, set = 0) readonly buffer BodyMedia { uint body_media[]; };
const uint BODIES = uint(BODY_COUNT);
const uint NO_BODY = 16u;

// Without bodies.
Surroundings surroundings_of(uint medium) { return Surroundings(medium, medium, uvec2(0)); }

// The body with the highest priority, or NO_BODY.
uint first_body(Surroundings s) {
    if (s.counts.x != 0u) return uint(findLSB(s.counts.x)) / 4u;
    return s.counts.y != 0u ? 8u + uint(findLSB(s.counts.y)) / 4u : NO_BODY;
}

// After a change of the bodies, or of what is around them.
void find_medium(inout Surroundings s) {
    uint body = first_body(s);
    s.medium = body == NO_BODY ? s.outer : body_media[body];
}

uint count_shift(uint body) { return 4u * (body & 7u); }
uint body_count(Surroundings s, uint body) { return ((body < 8u ? s.counts.x : s.counts.y) >> count_shift(body)) & 15u; }

void add_to_count(inout Surroundings s, uint body, uint n) {
    uint bits = n << count_shift(body);
    s.counts += body < 8u ? uvec2(bits, 0u) : uvec2(0u, bits);
}

// Counts end at 15 and at 0: meshes that are not closed may make the medium wrong, and nothing else.
void enter_body(inout Surroundings s, uint body) {
    if (body_count(s, body) < 15u) add_to_count(s, body, 1u);
}
void leave_body(inout Surroundings s, uint body) {
    if (body_count(s, body) > 0u) add_to_count(s, body, ~0u);
}

// Puts the bodies into another medium.
void surround(inout Surroundings s, uint medium) {
    s.outer = medium;
    find_medium(s);
}

// Adds the bodies to `held` that a ray is inside `before` a crossing without having entered them `since` it started.
void count_bodies_left(inout Surroundings held, Surroundings since, Surroundings before) {
    for (uint i = 0u; i < BODIES; ++i)
        if (body_count(before, i) > body_count(since, i)) enter_body(held, i);
}

// The medium of the body at this place of the list.
uint body_medium(uint body) { return body_media[body]; }

#else
const uint BODIES = 0u;
Surroundings surroundings_of(uint medium) { return Surroundings(medium); }
#define find_medium(s)
void surround(inout Surroundings s, uint medium) { s.medium = medium; }
#define count_bodies_left(held, since, before)
uint body_medium(uint body) { return NO_RECORD; }
#endif
