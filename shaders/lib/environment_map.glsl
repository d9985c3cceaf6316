// Radiance around a point as an image in latitude and longitude, and directions drawn in proportion to its luminance. The centre of the
// image looks along -z, columns run to the right as seen from inside (at 3/4 of the width: +x), the top row is up (+y).
//
// Texels hold the radiance at their centres. Between centres it is bilinear in azimuth and in the cosine of
// the polar angle; it wraps around in azimuth and is constant between the outermost rows and the poles.
// Directions are sampled exactly in proportion to luminance: a cell between four texel centres by alias
// tables (Walker 1977, Vose 1991), one for the row and one for the column, then a point of the cell by
// inverting its bilinear luminance. With cells of equal solid angle per unit of the two coordinates the pdf
// is luminance / (its integral over the sphere).
#include "lib/accurate_math.glsl"
#include "lib/constants.glsl"
#include "lib/warps.glsl"

// An environment image on the device. Layout of environment_texels from `first`, with H = height, W = width:
//   (H + 2) rows of W texels, the image with its first and last row repeated. rgb: radiance. w: alias entry of
//       the column of the cell whose upper left corner is this texel, the alias in the lower `alias_bits`, the
//       threshold in the bits above.
//   H + 1 rows of cells. x: threshold. y: alias (bits). z: 1 - |cos| at the edge nearer the pole. w: height in cos.
struct EnvironmentMapRef {
    uint first;
    uint width, height;
    uint alias_bits;
    float integral;  // of luminance over the sphere, sr cd/m²
};

// How texels are fetched may be set before this file is included.
layout(scalar, set = 0) readonly buffer EnvironmentTexels { uvec4 environment_texels[]; };  // floats, as bits

// A place between four texel centres.
struct EnvironmentCell {
    uint row, column;   // of the upper left texel; row counts from the repeated first row
    vec2 at;            // in the cell, [0, 1]²; x along the row, y downwards
};

void environment_corners(EnvironmentMapRef map, EnvironmentCell cell, out vec3 corners[4]) {
    uint right = cell.column + 1u < map.width ? cell.column + 1u : 0u;
    uint top = map.first + cell.row * map.width, bottom = top + map.width;
    corners[0] = uintBitsToFloat(environment_texels[top + cell.column].xyz);
    corners[1] = uintBitsToFloat(environment_texels[top + right].xyz);
    corners[2] = uintBitsToFloat(environment_texels[bottom + cell.column].xyz);
    corners[3] = uintBitsToFloat(environment_texels[bottom + right].xyz);
}

vec3 environment_mix(vec3 corners[4], vec2 at) {
    return mix(mix(corners[0], corners[1], at.x), mix(corners[2], corners[3], at.x), at.y);
}

uvec4 environment_row(EnvironmentMapRef map, uint row) {
    return environment_texels[map.first + (map.height + 2u) * map.width + row];
}

// Direction to cell, accurate next to the poles: everything is measured from the nearer one.
EnvironmentCell environment_locate(EnvironmentMapRef map, float rotation, vec3 direction) {
    float around_squared = dot(direction.xz, direction.xz);
    float from_pole = around_squared / (1.0 + min(abs(direction.y), 1.0));  // 1 - |cos|
    float angle = accurate_atan2(sqrt(around_squared), abs(direction.y));
    uint row = min(uint(angle * INV_PI * float(map.height) + 0.5), map.height / 2u);
    vec2 edge = uintBitsToFloat(environment_row(map, row).zw);  // the southern rows mirror the northern ones
    float y = clamp((from_pole - edge.x) / edge.y, 0.0, 1.0);
    bool south = direction.y < 0.0;

    float turns = (accurate_atan2(direction.x, -direction.z) + rotation) * (0.5 * INV_PI) + 0.5;
    float x = (turns - floor(turns)) * float(map.width) - 0.5;
    float left = floor(x);
    uint column = left < 0.0 ? map.width - 1u : min(uint(left), map.width - 1u);
    return EnvironmentCell(south ? map.height - row : row, column, vec2(x - left, south ? 1.0 - y : y));
}

// `rotation`: rad, that the image is turned about +y, counter-clockwise seen from above.
vec3 environment_radiance(EnvironmentMapRef map, float rotation, vec3 direction) {
    EnvironmentCell cell = environment_locate(map, rotation, direction);
    vec3 corners[4];
    environment_corners(map, cell, corners);
    return environment_mix(corners, cell.at);
}

// The entry of an alias table with `count` entries, of which `own` decides: u in [0,1) is stretched anew over
// the result.
uint choose_alias(uint entry, uint other, float threshold, inout float u) {
    bool own = u < threshold;
    u = min(own ? u / threshold : (u - threshold) / (1.0 - threshold), 1.0 - EPSILON);
    return own ? entry : other;
}

struct EnvironmentSample {
    vec3 direction;  // unit; drawn with the density luminance(radiance) / map.integral, 1/sr
    vec3 radiance;
};

// Of a map that is not black.
EnvironmentSample environment_sample(EnvironmentMapRef map, float rotation, vec2 u) {
    // Numbers have 24 bits, of which the choice of row and column takes half. New ones below them keep rare
    // cells' share right.
    uint bits = uint(u.x * 16777216.0) * 747796405u ^ uint(u.y * 16777216.0) * 2891336453u;
    bits = (bits ^ (bits >> 15)) * 277803737u;
    vec2 low = vec2((uvec2(bits, bits >> 8) ^ (bits >> 16)) & 0xFFu) * (1.0 / 256.0 / 16777216.0);

    vec2 count = vec2(map.width, map.height + 1u);
    vec2 cell = min(floor(u * count), count - 1.0);
    vec2 v = min(u * count - cell + low * count, vec2(1.0 - EPSILON));
    uvec4 row_entry = environment_row(map, uint(cell.y));
    uint row = choose_alias(uint(cell.y), row_entry.y, uintBitsToFloat(row_entry.x), v.y);
    uint entry = environment_texels[map.first + row * map.width + uint(cell.x)].w;
    float threshold = float(entry >> map.alias_bits) / float((0xFFFFFFFFu >> map.alias_bits) + 1u);
    uint column = choose_alias(uint(cell.x), entry & ((1u << map.alias_bits) - 1u), threshold, v.x);

    vec3 corners[4];
    environment_corners(map, EnvironmentCell(row, column, vec2(0)), corners);
    vec4 l = vec4(luminance(corners[0]), luminance(corners[1]), luminance(corners[2]), luminance(corners[3]));
    vec2 at;
    at.y = sample_linear(l.x + l.y, l.z + l.w, v.y);
    at.x = sample_linear(mix(l.x, l.z, at.y), mix(l.y, l.w, at.y), v.x);
    vec3 radiance = environment_mix(corners, at);

    bool south = 2u * row > map.height;
    vec2 edge = uintBitsToFloat(environment_row(map, row).zw);
    float from_pole = edge.x + (south ? 1.0 - at.y : at.y) * edge.y;
    float y = south ? from_pole - 1.0 : 1.0 - from_pole;
    vec2 around = cos_sin_turns((float(column) + 0.5 + at.x) / float(map.width) - 0.5 - rotation * (0.5 * INV_PI)) *
                  sqrt(from_pole * (2.0 - from_pole));
    return EnvironmentSample(vec3(around.y, y, -around.x), radiance);
}
