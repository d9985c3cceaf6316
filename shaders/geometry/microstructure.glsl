// A rectangle in the xy plane around the origin, facing +z, with small bumps or dents of one shape in cells side by side: the
// dots of a light guide, an array of lenses, a prism film. Which cell holds one, where and how large follows from the cell's number,
// so that any number of them takes no memory; or a file says it ("placement": {"file": NAME}). Cells lie around the middle; what is left
// of the rectangle beside them is plain. Ridges are open at their ends. Instead of shapes cells may hold triangles: the meshes of another
// scene of the file ("cell": its index) stand in the place of the plane in the cells that hold one. Seen from +z u runs to the right (+x),
// v down (-y).
//
// A ray walks through the cells that it passes while it is within the height of the shapes (Amanatides & Woo 1987, row by row);
// what it costs does not depend on how many there are. It is met in the frame of each element, where it goes on from a point nearby that
// is found without rounding: so places are right to some roundings of a cell, wherever that lies and wherever the ray comes from.
//
// Example:
//     {"nodes": [{"name": "microstructure", "translation": [0, 0.4, 0], "rotation": [-0.2588, 0, 0, 0.9659], "extensions": {"ETD_optics": {
//         "geometry": {"class": "microstructure", "size": [1.1, 0.7], "pitch": [0.1, 0.1], "radius": 0.04, "depth": 0.03, "material": 1}}}}]}
#include "features/textures.glsl"
#include "lib/cell_mesh.glsl"
#include "lib/micro_bend.glsl"
#include "lib/micro_places.glsl"

struct Microstructure {
    vec2 size;        //: required in (0, inf) m. Width along x and height along y.
    vec2 pitch;       //: required in (0, inf) m. Of the cells; not with a file.
    uint shape;       //: "dome" of dome|cone|prism|groove|lens. A cap of a sphere, a cone, a pyramid of four sides; along all of y: a ridge, a cap of a cylinder.
    float radius;     //: required in (0, inf) m. Of the foot: half its width. An element stays within its cell, but for a file's. Not with a cell.
    float depth;      //: required in (0, inf) m. Height of a bump; of a dome or lens at most the radius. Not with a cell.
    uint operation;   //: "add" of add|remove. Bumps towards +z, or dents.
    float turn;       //: 0 in (-inf, inf) rad. Of pyramids, about z.
    float bend;       //: 0 in (-inf, inf) m. Radius of a cylinder along y that the sheet is wrapped on, x being the way around; +z points away from it, or, where negative, into it. 0: it is flat.
    uint placement;   //: "grid" of grid|staggered|jittered|file. In rows; every other row shifted by half a cell; anywhere within the cell; {"file": NAME}: where a file says.
    MicroPlaces file; //: none. Of the placement.
    CellMesh cell;    //: none. Index of a scene of the file: the triangles of an element.
    float density;    //: 1 in [0, 1]. The share of the cells that hold an element.
    TextureRef density_texture;  //: none data. Red multiplies density, at the middle of each cell.
    float spread;     //: 0 in [0, 1). Elements are smaller than radius and depth by up to this share.
    uint seed;        //: 0 in [0, 4294967295]. Which cells, where and how large.
};
#define microstructure_NEVER_EMITS
#include "lib/micro_elements.glsl"

// From the axis to where elements begin and end.
vec2 microstructure_radii(Microstructure r) {
    bool outward = (r.operation == 0u) == (r.bend > 0.0);
    // Where it is widest a foot lies below its tangent plane; a hair more.
    float sag = 0.5 * r.radius * r.radius / abs(r.bend);
    return abs(r.bend) + (outward ? vec2(-1e-5 * (r.depth + sag), r.depth + sag) : vec2(-r.depth - sag, 1e-5 * (r.depth + sag)));
}

void microstructure_bounds(Microstructure r, out vec3 lo, out vec3 hi) {
    vec2 z = r.operation == 0u ? vec2(0.0, r.depth) : vec2(-r.depth, 0.0);
    if (r.cell.nodes != 0u) z = vec2(min(r.cell.low, 0.0), max(r.cell.high, 0.0));
    lo = vec3(-0.5 * r.size, z.x);
    hi = vec3(0.5 * r.size, z.y);
    if (r.bend == 0.0) return;
    float angle = min(0.5 * r.size.x / abs(r.bend), PI);
    vec2 radii = microstructure_radii(r), end = cos_sin_turns(angle / (2.0 * PI));
    // On a cylinder whose outside is up: the highest point is its top, the lowest at its ends.
    float low = min(radii.x * end.x, radii.y * end.x) - abs(r.bend), high = radii.y - abs(r.bend);
    hi.x = radii.y * (angle > 0.5 * PI ? 1.0 : end.y);
    lo.x = -hi.x;
    lo.z = r.bend > 0.0 ? low : -high;
    hi.z = r.bend > 0.0 ? high : -low;
}

// Do elements leave the sheet as it is where a ray comes to it?
bool microstructure_is_plain(Microstructure r, MicroGrid g, vec2 p, vec3 origin, vec3 direction, float t) {
    float up = r.operation == 0u ? 1.0 : -1.0;
    for (int row = microstructure_row(g, p.y - g.reach.y); row <= microstructure_row(g, p.y + g.reach.y); ++row) {
        int last = microstructure_column(r, g, row, p.x + g.reach.x);
        for (int column = microstructure_column(r, g, row, p.x - g.reach.x); column <= last; ++column) {
            uvec2 elements = microstructure_elements(r, g, ivec2(column, row));
            for (uint i = elements.x; i < elements.y; ++i) {
                MicroElement e = microstructure_element(r, g, ivec2(column, row), i);
                vec3 q = microstructure_from(r, e, origin, direction, t), d = microstructure_to_element(r, e, direction);
                q -= microstructure_height(r, q) / microstructure_climb(r, q, d) * d;
                vec3 turned = vec3(microstructure_turned(r, e, q.xy, 1.0), up * q.z);
                bool covers = r.cell.nodes != 0u || (r.bend == 0.0 ? micro_covers(r.shape, e.scale * r.radius, turned.xy)
                                                                   : micro_holds(r.shape, e.scale * r.radius, e.scale * r.depth, turned));
                if (e.exists && covers) return false;
            }
        }
    }
    return true;
}

// Where a ray meets the sheet itself, between 0 and `end`, unless an element stands there.
bool microstructure_meet_sheet(Microstructure r, MicroGrid g, MicroRound c, vec3 origin, vec3 direction, float end, out float t) {
    vec2 ways = vec2(direction.z != 0.0 ? -origin.z / direction.z : 0.0, 0.0);
    if (r.bend != 0.0) ways = micro_within(c, abs(r.bend));
    for (uint i = 0u; i < (r.bend != 0.0 ? 2u : 1u); ++i) {
        t = i == 0u ? ways.x : ways.y;
        if (!(t > 0.0 && t < end)) continue;
        vec2 p = origin.xy + t * direction.xy;
        if (r.bend != 0.0) p.x = (1.0 - 2e-6) * micro_around(r.bend, c.o + (t - c.start) * c.d);  // closes where the sheet does
        if (all(lessThanEqual(abs(p), 0.5 * r.size)) && microstructure_is_plain(r, g, p, origin, direction, t)) return true;
    }
    return false;
}

// The elements of a cell; shortens the ray to the nearest hit.
bool microstructure_meet_elements(Microstructure r, MicroGrid g, ivec2 cell, vec3 origin, vec3 direction, vec3 inverse, inout GeometryHit hit) {
    bool met = false;
    uvec2 elements = microstructure_elements(r, g, cell);
    for (uint i = elements.x; i < elements.y; ++i) {
        MicroElement e = microstructure_element(r, g, cell, i);
        if (!e.exists) continue;
        GeometryHit found;
        bool here = r.cell.nodes != 0u ? microstructure_meet_cell(r, g, e, cell, origin, direction, inverse, hit.t, found)
                                       : microstructure_meet(r, e, origin, direction, hit.t, found);
        if (here) hit = found, met = true;
    }
    return met;
}

bool microstructure_intersect(Microstructure r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(t_max, vec2(INFINITY));
    MicroGrid g = microstructure_grid(r);
    MicroRound c;
    if (r.bend != 0.0) c = micro_round(r.bend, origin, direction);
    float t;
    bool met = microstructure_meet_sheet(r, g, c, origin, direction, t_max, t);
    if (met) hit.t = t;
    // The part of the ray that is within the height of the elements, over the cells; a hair more, by what is rounded here.
    vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
    vec3 lo, hi;
    microstructure_bounds(r, lo, hi);
    vec3 hair = vec3(0, 0, 1e-5 * (hi.z - lo.z) + 8.0 * EPSILON * abs(origin.z));
    if (r.bend != 0.0) hair.x = hair.z + 8.0 * EPSILON * abs(origin.x);
    vec3 a = (lo - hair - origin) * inverse, b = (hi + hair - origin) * inverse, near = min(a, b), far = max(a, b);
    float from = max(max(near.x, near.y), max(near.z, 0.0)), to = min(min(far.x, far.y), min(far.z, hit.t));
    // Of a cylinder the part before its inner side, and the part behind.
    vec4 parts = vec4(from, to, INFINITY, 0.0);
    if (r.bend != 0.0) {
        vec2 inner = micro_within(c, microstructure_radii(r).x), outer = micro_within(c, microstructure_radii(r).y);
        parts = vec4(max(from, outer.x), min(to, min(outer.y, inner.x)), max(from, inner.y), min(to, outer.y));
        if (!(outer.x < INFINITY)) return met;
        if (!(inner.x < INFINITY)) parts = vec4(max(from, outer.x), min(to, outer.y), INFINITY, 0.0);
    }
    float length_around = 2.0 * PI * abs(r.bend);
    for (uint part = 0u; part < (r.bend != 0.0 ? 2u : 1u); ++part) {
        float start = part == 0u ? parts.x : parts.z, end = part == 0u ? parts.y : parts.w;
        if (!(start <= end)) continue;
        vec2 first = origin.xy + start * direction.xy, second = origin.xy + end * direction.xy;
        vec2 reach = g.reach + 1e-4 * g.pitch + 8.0 * EPSILON * (abs(origin.xy) + abs(first) + abs(second));
        ivec2 way = mix(ivec2(1), ivec2(-1), lessThan(inverse.xy, vec2(0)));
        if (r.bend != 0.0) way.x = int(c.way), reach.x += 1e-6 * abs(r.bend);
        vec2 pad = vec2(way) * reach;
        int row = clamp(microstructure_row(g, first.y - pad.y), 0, max(g.cells.y - 1, 0));
        int last_row = clamp(microstructure_row(g, second.y + pad.y), 0, max(g.cells.y - 1, 0));
        for (; (last_row - row) * way.y >= 0 && g.cells.y > 0; row += way.y) {
            vec2 edges = (float(row) - 0.5 * float(g.cells.y) + vec2(way.y < 0, way.y > 0)) * g.pitch.y + vec2(-pad.y, pad.y);
            vec2 ends = clamp((edges - origin.y) * inverse.y, vec2(start), vec2(max(min(end, hit.t), start)));
            if (ends.x >= hit.t) break;
            vec2 x = origin.x + ends * direction.x;
            if (r.bend != 0.0) {
                x.x = micro_around(r.bend, c.o + (ends.x - c.start) * c.d);
                x.y = micro_around(r.bend, c.o + (ends.y - c.start) * c.d);
                if ((x.y - x.x) * c.way < -0.5 * length_around) x.y += c.way * length_around;
            }
            x += vec2(-pad.x, pad.x);
            // A second time where the way leads over the seam.
            for (uint turn = 0u; turn < (r.bend != 0.0 ? 2u : 1u); ++turn) {
                int column = microstructure_column(r, g, row, x.x), last = microstructure_column(r, g, row, x.y);
                column = way.x > 0 ? max(column, 0) : min(column, g.cells.x - 1);
                last = way.x > 0 ? min(last, g.cells.x - 1) : max(last, 0);
                for (; (last - column) * way.x >= 0; column += way.x) {
                    bool found = microstructure_meet_elements(r, g, ivec2(column, row), origin, direction, inverse, hit);
                    met = met || found;
                    // Others lie in cells that the ray comes to later.
                    if (found && r.placement != MICRO_FILE && r.bend == 0.0) return true;
                }
                if (r.bend != 0.0) x -= c.way * length_around;
            }
        }
    }
    return met;
}

// The element that was hit, of all that stand around there. `middle`: on the sheet as if that were flat.
MicroElement microstructure_find(Microstructure r, MicroGrid g, vec2 middle) {
    MicroElement best;
    float nearest = INFINITY;
    vec2 slack = r.placement == MICRO_FILE ? 1e-3 * g.pitch + 16.0 * EPSILON * r.size : vec2(0);
    for (int row = microstructure_row(g, middle.y - slack.y); row <= microstructure_row(g, middle.y + slack.y); ++row) {
        int last = microstructure_column(r, g, row, middle.x + slack.x);
        for (int column = microstructure_column(r, g, row, middle.x - slack.x); column <= last; ++column) {
            uvec2 elements = microstructure_elements(r, g, ivec2(column, row));
            for (uint i = elements.x; i < elements.y; ++i) {
                MicroElement e = microstructure_flat_element(r, g, ivec2(column, row), i);
                float distance = length(middle - microstructure_center(e).xy);
                if (distance < nearest) nearest = distance, best = e;
            }
        }
    }
    return microstructure_wrapped(r, best);
}

LocalPoint microstructure_on_element(Microstructure r, MicroGrid g, vec3 p, vec2 q) {
    vec2 middle = p.xy - q;
    if (r.bend != 0.0) {
        vec2 from_axis = vec2(p.x, p.z + r.bend);
        middle.x = micro_around(r.bend, from_axis) - r.bend * accurate_asin(q.x / (sign(r.bend) * length(from_axis)));
    }
    MicroElement e = microstructure_find(r, g, middle);
    float z, up = r.operation == 0u ? 1.0 : -1.0;
    vec3 n = normalize(micro_normal(r.shape, e.scale * r.radius, e.scale * r.depth, microstructure_turned(r, e, q, 1.0), z));
    n.xy = up * microstructure_turned(r, e, n.xy, -1.0);
    vec3 place = vec3(e.cell.xy + (e.offset + q + e.cell_low.xy), up * z);
    vec3 error = vec3(gamma(2.0) * abs(place.xy) + gamma(4.0) * abs(q), gamma(8.0) * r.depth);
    if (r.bend != 0.0) {
        place = e.cell + (microstructure_from_element(r, e, vec3(q, up * z)) + vec3(0, e.offset.y + e.cell_low.y, 0));
        // Of the element's frame, too.
        error = gamma(2.0) * abs(place) + vec3(gamma(8.0) * (r.depth + max(abs(q.x), abs(q.y)))) + vec3(6e-7 * abs(r.bend), 0, 6e-7 * abs(r.bend));
    }
    return LocalPoint(place, error, microstructure_from_element(r, e, n), microstructure_from_element(r, e, vec3(1, 0, 0)), vec2(0));
}

LocalPoint microstructure_on_triangle(Microstructure r, MicroGrid g, vec2 p, vec3 origin, vec3 direction, GeometryHit hit) {
    uint number = uint(hit.uv.x);
    ivec2 odd = ivec2(number & 1u, (number >> 1) & 1u), cell;
    // Of the cells with such numbers the nearest.
    cell.y = 2 * int(round(p.y / g.pitch.y * 0.5 + (0.25 * float(g.cells.y) - 0.25 - 0.5 * float(odd.y)))) + odd.y;
    float shift = microstructure_shift(r, cell.y);
    cell.x = 2 * int(round(p.x / g.pitch.x * 0.5 + (0.25 * float(g.cells.x) - 0.25 - 0.5 * (float(odd.x) + shift)))) + odd.x;
    MicroElement e = microstructure_element(r, g, cell, 0u);
    vec3 q = microstructure_from(r, e, origin, direction, hit.t) + hit.uv.y * direction;
    CellTriangle c = cell_triangles[r.cell.first_triangle + (number >> 2)];
    vec3 n = cell_normal(c);
    vec3 size = max(max(abs(c.v0), abs(c.v1)), abs(c.v2));
    q -= dot(n, q - c.v0) * n;
    vec3 error = gamma(3.0) * vec3(abs(e.cell.xy + q.xy), 0.0) + gamma(12.0) * (abs(q) + size);
    return LocalPoint(vec3(e.cell.xy + (q.xy + e.cell_low.xy), q.z), error, n, vec3(1, 0, 0), vec2(0));
}

// … on the sheet itself.
LocalPoint microstructure_on_sheet(Microstructure r, vec3 p, vec3 origin, vec3 direction, float t) {
    vec3 error = gamma(3.0) * (abs(origin) + abs(t * direction));
    if (r.bend == 0.0) return LocalPoint(vec3(p.xy, 0.0), vec3(error.xy, 0.0), vec3(0, 0, 1), vec3(1, 0, 0), vec2(0));
    vec3 n = vec3(p.x, 0.0, p.z + r.bend) / r.bend;
    n /= length(n);
    // Onto the cylinder.
    p.xz = r.bend * n.xz - vec2(0, r.bend);
    return LocalPoint(p, vec3(gamma(8.0) * abs(r.bend), error.y, gamma(8.0) * abs(r.bend)), n, vec3(n.z, 0, -n.x), vec2(0));
}

LocalPoint microstructure_locate(Microstructure r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec3 p = origin + hit.t * direction;
    MicroGrid g = microstructure_grid(r);
    LocalPoint point;
    if (!(hit.uv.x < INFINITY)) point = microstructure_on_sheet(r, p, origin, direction, hit.t);
    else if (r.cell.nodes != 0u) point = microstructure_on_triangle(r, g, p.xy, origin, direction, hit);
    else point = microstructure_on_element(r, g, p, hit.uv);
    point.uv = 0.5 + vec2(point.position.x, -point.position.y) / r.size;
    if (r.bend != 0.0) point.uv.x = 0.5 + micro_around(r.bend, vec2(point.position.x, point.position.z + r.bend)) / r.size.x;
    return point;
}

// Nothing is sampled on it.
float microstructure_area(Microstructure r) { return r.size.x * r.size.y; }
GeometrySample microstructure_sample(Microstructure r, vec2 u) { return GeometrySample(vec3(0), vec3(0, 0, 1), 0.0); }
GeometrySample microstructure_sample_towards(Microstructure r, vec3 reference, vec2 u) { return microstructure_sample(r, u); }
float microstructure_pdf_towards(Microstructure r, vec3 reference, vec3 position, vec3 normal) { return 0.0; }
