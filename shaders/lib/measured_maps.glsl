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

layout(scalar, set = 0) readonly buffer MeasuredPoints { vec2 measured_points[]; };

// Slices around a fixed direction: MEASURED_SLICES of them.
struct MeasuredSlices {
    uvec4 index;
    vec4 weight;  // sums to one
};

uint map_slice(MeasuredMap m, uint index) { return m.first + index * m.height * (m.width + 1u); }

// Loops are kept as loops: unrolled, their code takes a minute to compile. Searches make the same number of steps in all
// lanes, since values that leave a loop at different times cannot be relied on (features/light_selection.glsl).

// Where x stands among numbers that rise, points [first, first + count): as far from one to the next.
float list_place(uint first, uint count, float x) {
    uint below = 0u;
    [[dont_unroll]] for (uint step = 512u; step > 0u; step >>= 1)
        if (below + step + 1u < count && measured_points[first + below + step].x <= x) below += step;
    float a = measured_points[first + below].x, b = measured_points[first + min(below + 1u, count - 1u)].x;
    return float(below) + (b > a ? clamp((x - a) / (b - a), 0.0, 1.0) : 0.0);
}
float list_number(uint first, float place, uint count) {
    uint below = min(uint(place), count - 2u);
    return mix(measured_points[first + below].x, measured_points[first + below + 1u].x, place - float(below));
}

// The cell between points that a place is in.
uvec2 map_cell(MeasuredMap m, vec2 place) { return min(uvec2(max(place, vec2(0))), uvec2(m.width, m.height) - 2u); }

float map_slice_value(MeasuredMap m, uint index, vec2 place) {
    uvec2 cell = map_cell(m, place);
    vec2 f = place - vec2(cell);
    uint p = map_slice(m, index) + m.height + cell.y * m.width + cell.x;
    return mix(mix(measured_points[p].x, measured_points[p + 1u].x, f.x),
               mix(measured_points[p + m.width].x, measured_points[p + m.width + 1u].x, f.x), f.y);
}

float map_value(MeasuredMap m, MeasuredSlices s, vec2 place) {
    float value = 0.0;
    [[dont_unroll]] for (uint k = 0u; k < MEASURED_SLICES; ++k)
        value += s.weight[k] * map_slice_value(m, s.index[k], place);
    return value;
}

// The point that stands `offset` behind the beginning of a slice, over all of them; `step` points on, `f` of the way there.
vec2 map_mix(MeasuredMap m, MeasuredSlices s, uint offset, uint step, float f) {
    vec2 sums = vec2(0);
    [[dont_unroll]] for (uint k = 0u; k < MEASURED_SLICES; ++k) {
        uint p = map_slice(m, s.index[k]) + offset;
        sums += s.weight[k] * mix(measured_points[p], measured_points[p + step], f);
    }
    return sums;
}
// Integral over the rows before this one, and along it.
vec2 map_row(MeasuredMap m, MeasuredSlices s, uint row) { return map_mix(m, s, row, 0u, 0.0); }
float map_integral(MeasuredMap m, MeasuredSlices s) { return map_row(m, s, m.height - 1u).x; }
// Value at a column, `f` of the way from one row to the next, and integral up to there.
vec2 map_column(MeasuredMap m, MeasuredSlices s, uint row, float f, uint column) {
    return map_mix(m, s, m.height + row * m.width + column, m.width, f);
}

// How much of the way from integral a to b is behind at x.
float integral_part(float a, float b, float x) { return b > a ? clamp((x - a) / (b - a), 0.0, 1.0) : 0.5; }

// The place that `u`, even on the unit square, is warped to: density value / integral.
vec2 map_sample(MeasuredMap m, MeasuredSlices s, vec2 u) {
    // First the row, then the column: each by its integral and the values on both sides of what is found.
    uint row = 0u;
    float f = 0.0;
    vec2 place = vec2(0);
    [[dont_unroll]] for (uint axis = 0u; axis < 2u; ++axis) {
        bool rows = axis == 0u;
        uint count = rows ? m.height : m.width, first = rows ? 0u : m.height + row * m.width, step_on = rows ? 0u : m.width;
        // Points are (integral before, value) of rows, (value, integral before) of columns.
        vec2 last = map_mix(m, s, first + count - 1u, step_on, f);
        float wanted = rows ? u.y * last.x : u.x * last.y;
        uint at = 0u;
        [[dont_unroll]] for (uint step = 512u; step > 0u; step >>= 1) {
            if (at + step + 1u >= count) continue;
            vec2 p = map_mix(m, s, first + at + step, step_on, f);
            if ((rows ? p.x : p.y) <= wanted) at += step;
        }
        vec2 a = map_mix(m, s, first + at, step_on, f), b = map_mix(m, s, first + at + 1u, step_on, f);
        if (!rows) a = a.yx, b = b.yx;
        float part = sample_linear(a.y, b.y, integral_part(a.x, b.x, wanted));
        if (rows) row = at, f = part, place.y = float(at) + part;
        else place.x = float(at) + part;
    }
    return place;
}

// Part of the integral of mix(a, b, x) over [0, 1] that lies below x: undoes sample_linear.
float linear_part(float a, float b, float x) { return a + b > 0.0 ? x * (2.0 * a + (b - a) * x) / (a + b) : x; }

// The u that map_sample warps to this place, for slices that integrate to one; and the value there.
vec2 map_invert(MeasuredMap m, MeasuredSlices s, vec2 place, out float value) {
    uvec2 cell = map_cell(m, place);
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
