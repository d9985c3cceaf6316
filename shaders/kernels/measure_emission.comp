// How bright parts of emissive surfaces are, for the host to sample them by (host/lights/emission_map.h): luminance over that of the
// material's emission, without textures and alpha. One lane a part. Reads: emission_cells, materials, primitives. Writes:
// emission_samples. Barrier expected: after the dispatch.
#include "interfaces/light_source.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint first, count; };

// Twins of structs in host/lights/emission_map.h. A size of 0: all of a shape.
struct EmissionCell {
    uint primitive;
    float size;
    vec2 corner;
};
struct EmissionSample {
    float mean, mean_square;
    float greatest;
};
layout(scalar, set = 0) readonly buffer EmissionCells { EmissionCell emission_cells[]; };
layout(scalar, set = 0) writeonly buffer EmissionSamples { EmissionSample emission_samples[]; };

const uint INNER = 16u, OUTER = 6u;

// Points of a triangle, in its coordinates: the middles of its 16 parts; corners and middles of the sides of one that is larger by half.
vec2 cell_point(uint i) {
    if (i < 10u) {
        uint row = i < 4u ? 0u : i < 7u ? 1u : i < 9u ? 2u : 3u;
        uint column = i - (row == 0u ? 0u : row == 1u ? 4u : row == 2u ? 7u : 9u);
        return (vec2(column, row) + 1.0 / 3.0) * 0.25;
    }
    if (i < INNER) {
        uint row = i < 13u ? 0u : i < 15u ? 1u : 2u;
        uint column = i - (row == 0u ? 10u : row == 1u ? 13u : 15u);
        return (vec2(column, row) + 2.0 / 3.0) * 0.25;
    }
    uint k = i - INNER;
    vec2 around = k < 3u ? vec2(k == 1u, k == 2u) : vec2(k == 4u ? 0.0 : 0.5, k == 3u ? 0.0 : 0.5);
    return mix(vec2(1.0 / 3.0), around, 1.5);
}

void main() {
    uint i = first + gl_GlobalInvocationID.x;
    if (i >= count) return;
    EmissionCell cell = emission_cells[i];
    Triangle r = primitives[cell.primitive];
    AreaLight light = AreaLight(cell.primitive, r.material);
    float unit = luminance(untinted_value(materials[r.material].emission));
    bool is_whole_shape = cell.size == 0.0;
    uint inner = is_whole_shape ? 256u : INNER, points = is_whole_shape ? inner : INNER + OUTER;
    EmissionSample s = EmissionSample(0.0, 0.0, 0.0);
    for (uint k = 0u; k < points; ++k) {
        vec3 position, error;
        if (is_whole_shape) {
            position = primitive_sample(cell.primitive, (vec2(k & 15u, k >> 4) + 0.5) / 16.0, error).position;
        } else {
            vec2 b = cell.corner + cell.size * cell_point(k);
            position = (1.0 - b.x - b.y) * r.v0 + b.x * r.v1 + b.y * r.v2;
        }
        float value = luminance(area_emission(light, true, position)) / unit;
        if (k < inner) s.mean += value / float(inner), s.mean_square += value * value / float(inner);
        s.greatest = max(s.greatest, value);
    }
    emission_samples[i] = s;
}
