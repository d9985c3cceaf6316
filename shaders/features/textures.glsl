// Image textures, filtered in linear light. Texel centres stand at half-integers, v runs down from the top row, as in
// glTF. Packed by host/scene/texture_pack.h: 8-bit images keep their bytes and are decoded here.
//
// Macros that may be set in front: HAS_TEXTURES (0: every texture_value is one), TEXTURE_FORMATS (the formats to
// compile, a bit each).

#if !HAS_TEXTURES

vec4 texture_value(TextureRef ref, vec2 uv0, vec2 uv1) { return vec4(1); }

#else

// One use of an image by a material. The host fills TextureRecord, its twin.
struct Texture {
    uint first;            // word of its first texel
    uint width, height;
    uint format_and_wrap;  // bits 0-1 format, 2-3 wrap of u, 4-5 wrap of v, 6 nearest
    vec4 uv_matrix;        // rows: u' = dot(xy, uv) + offset.x, v' = dot(zw, uv) + offset.y
    vec2 uv_offset;
    uint uv_set;           // 0 or 1
    uint padding;
};

const uint TEXTURE_DATA8 = 0u;   // a word a texel, linear
const uint TEXTURE_SRGB8 = 1u;   // a word a texel, colors encoded as sRGB, alpha linear
const uint TEXTURE_FLOAT = 2u;   // four words a texel, linear
const uint WRAP_REPEAT = 0u;
const uint WRAP_CLAMP = 1u;
const uint WRAP_MIRROR = 2u;

#ifndef TEXTURE_FORMATS
#define TEXTURE_FORMATS 7
#endif
#define HAS_TEXTURE_FORMAT(format) (((TEXTURE_FORMATS >> format) & 1u) != 0u)

layout(scalar, set = 0) readonly buffer Textures { Texture texture_records[]; };
layout(scalar, set = 0) readonly buffer Texels { uint texels[]; };

// sRGB to linear (IEC 61966-2-1): t^2.4 as t² t^0.4, the latter a polynomial in the fourth root of t. Relative error
// 2e-6 for the 256 values that occur; drivers' pow is worse and dearer.
vec3 linear_from_srgb(vec3 c) {
    vec3 t = (c + 0.055) * (1.0 / 1.055);
    vec3 q = sqrt(sqrt(t));
    vec3 p = -0.0206792997 + q * (0.299815802 + q * (0.906143084 + q * (-0.229116813 + q * 0.0438372272)));
    return mix(t * t * p, c * (1.0 / 12.92), lessThanEqual(c, vec3(0.04045)));
}

vec4 texel_value(Texture t, uint x, uint y) {
    uint format = t.format_and_wrap & 3u;
    uint texel = y * t.width + x;
    if (HAS_TEXTURE_FORMAT(TEXTURE_FLOAT) && format == TEXTURE_FLOAT) {
        uint at = t.first + 4u * texel;
        return uintBitsToFloat(uvec4(texels[at], texels[at + 1u], texels[at + 2u], texels[at + 3u]));
    }
    vec4 value = vec4(1);
    if (HAS_TEXTURE_FORMAT(TEXTURE_DATA8) || HAS_TEXTURE_FORMAT(TEXTURE_SRGB8))
        value = unpackUnorm4x8(texels[t.first + texel]);
    if (HAS_TEXTURE_FORMAT(TEXTURE_SRGB8) && format == TEXTURE_SRGB8) value.rgb = linear_from_srgb(value.rgb);
    return value;
}

// The two texels beside coordinates u on each axis of `size` texels (`low` and `high`), and the weight of the second. Coordinates are
// brought into [0, 1] first; at the ends the neighbour is the other end's texel (repeat) or the same one again.
void texel_pairs(vec2 u, ivec2 size, uvec2 wrap, bool nearest, out ivec2 low, out ivec2 high, out vec2 weight) {
    bvec2 repeats = equal(wrap, uvec2(WRAP_REPEAT));
    vec2 folded = 1.0 - abs(u - 2.0 * floor(0.5 * u) - 1.0);
    vec2 inside = mix(mix(clamp(u, 0.0, 1.0), folded, equal(wrap, uvec2(WRAP_MIRROR))), u - floor(u), repeats);
    // A coordinate that overflowed to NaN is taken for 0.
    inside = mix(vec2(0), min(inside, 1.0), greaterThanEqual(inside, vec2(0)));
    vec2 x = inside * vec2(size) - (nearest ? 0.0 : 0.5);
    ivec2 last = size - 1;
    low = clamp(ivec2(floor(x)), ivec2(-1), last);
    high = nearest ? low : low + 1;
    weight = nearest ? vec2(0) : x - vec2(low);
    low = mix(low, mix(ivec2(0), last, repeats), lessThan(low, ivec2(0)));
    high = mix(high, mix(last, ivec2(0), repeats), greaterThan(high, last));
}

// RGBA of a texture at a surface point with texture coordinates uv0 and uv1; one where there is no texture.
vec4 texture_value(TextureRef ref, vec2 uv0, vec2 uv1) {
    if (ref.index == NO_RECORD) return vec4(1);
    Texture t = texture_records[ref.index];
    vec2 set = t.uv_set == 0u ? uv0 : uv1;
    vec2 uv = vec2(dot(t.uv_matrix.xy, set), dot(t.uv_matrix.zw, set)) + t.uv_offset;
    ivec2 low, high;
    vec2 weight;
    texel_pairs(uv, ivec2(t.width, t.height), (uvec2(t.format_and_wrap) >> uvec2(2, 4)) & 3u,
                (t.format_and_wrap & 64u) != 0u, low, high, weight);
    vec4 left = vec4(0), row = vec4(0), upper = vec4(0);
    for (uint i = 0u; i < 4u; ++i) {  // a loop, so that the code of a texel stands once
        bool is_right = (i & 1u) != 0u, is_lower = i > 1u;
        vec4 texel = texel_value(t, uint(is_right ? high.x : low.x), uint(is_lower ? high.y : low.y));
        if (is_right) row = mix(left, texel, weight.x);
        if (i == 1u) upper = row;
        left = texel;
    }
    return mix(upper, row, weight.y);
}

#endif
