// Uniform numbers for the estimators: the first two dimensions of Sobol's sequence, Owen-scrambled, one pair
// after another with a fresh shuffle and scramble for each ("padded"; Burley 2020, "Practical Hash-based Owen
// Scrambling").
//
// Every pair of every pixel is a (0,2)-sequence over the sample index, so any 2^k consecutive samples that
// start at a multiple of 2^k are stratified in all elementary intervals; pairs and pixels are independent of
// one another. Numbers are multiples of 2^-24 in [0, 1).
//
// INDEPENDENT_SAMPLES: hashes in place of the points, for whoever wants errors to fall exactly as 1 / sqrt(samples).
#include "features/defaults.glsl"
#include "lib/hash.glsl"

struct Sampler {
    uint index;       // of the sample in its pixel
    uint pixel_hash;  // of pixel and seed
    uint dimension;   // pairs drawn so far
};

// Nested uniform scramble of a number whose bits stand in reverse order: every bit is flipped by a hash of
// the bits below it. The form is that of Laine & Karras 2011; the constants are Vegdahl's (2021, "Building a
// Better LK Hash").
uint scramble_reversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Sobol's second dimension of `index`, bits in reverse order. Its matrix is Pascal's triangle modulo 2, where
// (i, j) is 1 when the bits of i are among those of j (Lucas 1878): a sum over supersets, done in log2(32)
// butterfly steps.
uint sobol_second_reversed(uint index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= index >> 16;
    return index;
}

// Of a pass of a pixel. Even and odd passes are two sequences, each stratified in itself and independent of the other, so
// that the difference of their means tells the error of the whole (lib/film.glsl).
Sampler start_sampler(uvec2 pixel, uint pass, uint seed) {
    uvec3 hashes = hash_3d(uvec3(pixel, seed));
    return Sampler(pass >> 1, (pass & 1u) == 0u ? hashes.x : hashes.y, 0u);
}

// For the path `index` of the `count` forward paths of a pass: all paths of all passes share one sequence.
Sampler start_forward_sampler(uint pass, uint index, uint count, uint seed) {
    return Sampler((pass >> 1) * count + index, hash_3d(uvec3(~0u, pass & 1u, seed)).x, 0u);
}

// The hashes of the next pair.
uvec3 next_hashes(inout Sampler s) {
    return hash_3d(uvec3(s.pixel_hash, s.dimension++, INDEPENDENT_SAMPLES == 1 ? s.index : 0u));
}

vec2 sample_2d(inout Sampler s) {
    uvec3 seeds = next_hashes(s);
    if (INDEPENDENT_SAMPLES == 1) return vec2(seeds.xy >> 8) * (1.0 / 16777216.0);
    uint index = bitfieldReverse(scramble_reversed(bitfieldReverse(s.index), seeds.x));
    uvec2 reversed = uvec2(scramble_reversed(index, seeds.y), scramble_reversed(sobol_second_reversed(index), seeds.z));
    return vec2(bitfieldReverse(reversed) >> 8) * (1.0 / 16777216.0);
}

float sample_1d(inout Sampler s) {
    uvec3 seeds = next_hashes(s);
    if (INDEPENDENT_SAMPLES == 1) return float(seeds.x >> 8) * (1.0 / 16777216.0);
    uint index = bitfieldReverse(scramble_reversed(bitfieldReverse(s.index), seeds.x));
    return float(bitfieldReverse(scramble_reversed(index, seeds.y)) >> 8) * (1.0 / 16777216.0);
}

// To start a generator of its own with, for estimators that need any number of numbers: another one after every pair drawn.
uint sample_seed(Sampler s) { return hash_3d(uvec3(s.pixel_hash ^ 0x9E3779B9u, s.dimension, s.index)).x; }

// A pair that is stratified together, and one number more.
vec3 sample_3d(inout Sampler s) {
    vec2 pair = sample_2d(s);
    return vec3(pair, sample_1d(s));
}
