// Functions of two variables that were tabulated for a list of fixed directions: a slice each. Bilinear within a slice and
// linear between slices, and drawn from exactly: a row by the integrals along the rows, then a place in it (Dupuy & Jakob
// 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", supplemental material).
//
// Places are counted in points: (0, 0) is the first, (width - 1, height - 1) the last. A slice of a map holds
//   height points: x: integral over the rows before this one, y: integral along this row,
//   height rows of width points: x: value, y: integral along the row up to here.
#include "lib/warps.glsl"

struct MeasuredMap {
    uint first;  // of measured_points
    uint width, height;
};

#include "lib/large_arrays.glsl"
#if MEASURED_POINTS_BY_ADDRESS
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MeasuredPointsAt { vec2 entries[]; };
#define measured_point_at(i) MeasuredPointsAt(measured_points_address).entries[i]
#else
layout(scalar, set = 0) readonly buffer MeasuredPoints { vec2 measured_points[]; };
#define measured_point_at(i) measured_points[i]
#endif

// Slices around a fixed direction: two, or four where its azimuth counts, too.
#ifndef MEASURED_SLICES
#define MEASURED_SLICES 4
#endif
struct MeasuredSlices {
    uvec4 index;
    vec4 weight;  // sums to one
};

uint map_slice(MeasuredMap m, uint index) { return m.first + index * m.height * (m.width + 1u); }

// Where x stands among numbers that rise, points [first, first + count): as far from one to the next. The number of steps
// is the same for all, since values that leave a loop at different times cannot be relied on (lib/light_selection.glsl).
float list_place(uint first, uint count, float x) {
    uint below = 0u;
    for (uint step = 512u; step > 0u; step >>= 1)
        if (below + step + 1u < count && measured_point_at(first + below + step).x <= x) below += step;
    float a = measured_point_at(first + below).x, b = measured_point_at(first + min(below + 1u, count - 1u)).x;
    return float(below) + (b > a ? clamp((x - a) / (b - a), 0.0, 1.0) : 0.0);
}
float list_number(uint first, float place, uint count) {
    uint below = min(uint(place), count - 2u);
    return mix(measured_point_at(first + below).x, measured_point_at(first + below + 1u).x, place - float(below));
}

// The interval of two points that a place is in, of `count` points.
uint map_cell(float place, uint count) { return min(uint(max(place, 0.0)), count - 2u); }

float map_slice_value(MeasuredMap m, uint index, vec2 place) {
    uvec2 cell = uvec2(map_cell(place.x, m.width), map_cell(place.y, m.height));
    vec2 f = place - vec2(cell);
    uint p = map_slice(m, index) + m.height + cell.y * m.width + cell.x;
    return mix(mix(measured_point_at(p).x, measured_point_at(p + 1u).x, f.x),
               mix(measured_point_at(p + m.width).x, measured_point_at(p + m.width + 1u).x, f.x), f.y);
}

float map_value(MeasuredMap m, MeasuredSlices s, vec2 place) {
    float value = 0.0;
    for (uint k = 0u; k < MEASURED_SLICES; ++k) value += s.weight[k] * map_slice_value(m, s.index[k], place);
    return value;
}

// Integral over the rows before this one, and along it.
vec2 map_row(MeasuredMap m, MeasuredSlices s, uint row) {
    vec2 sums = vec2(0);
    for (uint k = 0u; k < MEASURED_SLICES; ++k) sums += s.weight[k] * measured_point_at(map_slice(m, s.index[k]) + row);
    return sums;
}
float map_integral(MeasuredMap m, MeasuredSlices s) { return map_row(m, s, m.height - 1u).x; }

// Value at a column, `f` of the way from one row to the next, and integral up to there.
vec2 map_column(MeasuredMap m, MeasuredSlices s, uint row, float f, uint column) {
    vec2 sums = vec2(0);
    for (uint k = 0u; k < MEASURED_SLICES; ++k) {
        uint p = map_slice(m, s.index[k]) + m.height + row * m.width + column;
        sums += s.weight[k] * mix(measured_point_at(p), measured_point_at(p + m.width), f);
    }
    return sums;
}

// How much of the way from integral a to b is behind at x.
float integral_part(float a, float b, float x) { return b > a ? clamp((x - a) / (b - a), 0.0, 1.0) : 0.5; }

// The place that `u`, even on the unit square, is warped to: density value / integral.
vec2 map_sample(MeasuredMap m, MeasuredSlices s, vec2 u) {
    float wanted = u.y * map_integral(m, s);
    uint row = 0u;
    for (uint step = 512u; step > 0u; step >>= 1)
        if (row + step + 1u < m.height && map_row(m, s, row + step).x <= wanted) row += step;
    vec2 a = map_row(m, s, row), b = map_row(m, s, row + 1u);
    float y = sample_linear(a.y, b.y, integral_part(a.x, b.x, wanted));

    wanted = u.x * mix(a.y, b.y, y);
    uint column = 0u;
    for (uint step = 512u; step > 0u; step >>= 1)
        if (column + step + 1u < m.width && map_column(m, s, row, y, column + step).y <= wanted) column += step;
    a = map_column(m, s, row, y, column), b = map_column(m, s, row, y, column + 1u);
    float x = sample_linear(a.x, b.x, integral_part(a.y, b.y, wanted));
    return vec2(float(column) + x, float(row) + y);
}

// Part of the integral of mix(a, b, x) over [0, 1] that lies below x: undoes sample_linear.
float linear_part(float a, float b, float x) { return a + b > 0.0 ? x * (2.0 * a + (b - a) * x) / (a + b) : x; }

// The u that map_sample warps to this place, for slices that integrate to one; and the value there.
vec2 map_invert(MeasuredMap m, MeasuredSlices s, vec2 place, out float value) {
    uvec2 cell = uvec2(map_cell(place.x, m.width), map_cell(place.y, m.height));
    vec2 f = place - vec2(cell);
    vec2 a = map_row(m, s, cell.y), b = map_row(m, s, cell.y + 1u);
    float along = mix(a.y, b.y, f.y);
    vec2 u;
    u.y = mix(a.x, b.x, linear_part(a.y, b.y, f.y));
    a = map_column(m, s, cell.y, f.y, cell.x), b = map_column(m, s, cell.y, f.y, cell.x + 1u);
    u.x = along > 0.0 ? mix(a.y, b.y, linear_part(a.x, b.x, f.x)) / along : 0.5;
    value = mix(a.x, b.x, f.x);
    return clamp(u, vec2(0), vec2(1));
}
