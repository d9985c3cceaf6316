// Unit vectors as points of a square: the octahedron around the origin, its lower half folded outward (Meyer et al. 2010,
// "On Floating-Point Normal Vectors"; survey by Cigolle et al. 2014). As floats a direction comes back within 1e-6 rad, as
// 2 x 16 bits within 6.6e-5 rad; the axes come back exactly.

vec2 octahedral_fold(vec2 p) { return (1.0 - abs(p.yx)) * mix(vec2(-1), vec2(1), greaterThanEqual(p, vec2(0))); }

vec2 encode_octahedral(vec3 direction) {
    vec2 p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return direction.z < 0.0 ? octahedral_fold(p) : p;
}

vec3 decode_octahedral(vec2 p) {
    vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (v.z < 0.0) v.xy = octahedral_fold(p);
    return v / sqrt(dot(v, v));
}

uint encode_octahedral_16(vec3 direction) { return packSnorm2x16(encode_octahedral(direction)); }
vec3 decode_octahedral_16(uint bits) { return decode_octahedral(unpackSnorm2x16(bits)); }
