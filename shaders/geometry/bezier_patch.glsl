// Bicubic Bézier patches, with weights if they are rational, so that spheres and tori are exact; the host makes them of splines, too
// (`nurbs_patch`). Seen from the side that du x dv points to. Borders that fall together at a point are allowed.
//
// The host cuts patches into pieces, a record each (host/geometry/bezier_pieces.h): along a piece the directions of du and dv keep within
// 0.25 rad of their means, in cones that do not overlap, so that it is a graph over a plane, and second derivatives are bounded. A ray is
// sought in the squares of a piece, halved as long as more than one point could lie in a square (Moore 1977, the interval test of
// Newton's method: Krawczyk 1969); a square with one is left to Newton. A point is met where the surface comes as near to the ray as
// numbers are sure of: neighbours agree on their common border to less than that, so that no ray slips through.
//
// Example:
//     {"nodes": [{"name": "patch", "translation": [0, 0.42, 0], "rotation": [-0.5736, 0, 0, 0.8192], "extensions": {"ETD_optics": {
//         "geometry": {"class": "bezier_patch", "material": 1, "control_points": [
//             [-0.5, -0.4, 0], [-0.2, -0.5, 0.3], [0.2, -0.5, -0.3], [0.5, -0.4, 0],
//             [-0.5, -0.15, 0.2], [-0.2, -0.15, 0.5], [0.2, -0.15, -0.1], [0.5, -0.15, 0.2],
//             [-0.5, 0.15, 0.2], [-0.2, 0.15, 0.1], [0.2, 0.15, 0.5], [0.5, 0.15, 0],
//             [-0.5, 0.4, 0], [-0.2, 0.5, -0.3], [0.2, 0.5, 0.3], [0.5, 0.4, 0]]}}}}]}

// Twin in host/geometry/bezier_pieces.h. Column i of row j: weight (x, y, z, 1) of the point i along u, j along v, x, y, z from the origin.
struct BezierPiece {
    mat4 row0, row1, row2, row3;
    mat4 area_density;  // |du x dv|: column i is along u, in Bernstein's polynomials; its mean is the area
    vec3 origin;        // m
    float radius;       // m, of a ball around the origin that holds the piece
    vec3 lo, hi;        // m, in the frame of the patch
    vec3 axis;          // about normal, unit
    vec3 second_along;  // bounds of |duu|, |duv|, |dvv|, m: of their parts across the axis
    vec3 second_out;    // … and along it
    float slack;        // m, bound of what rounding does to places, of any piece of the object
    vec4 domain;        // u and v where the piece begins and ends
};

struct BezierPatch {
    BezierPiece control_points;  //: required. 16 points [x, y, z] or [x, y, z, weight], in m, u running fastest; or a list of such patches, also as {"points", "uv": [u0, v0, u1, v1]}.
};

struct BezierPoint {
    vec3 position, du, dv;  // from the origin
};

vec4 bezier_basis(float x) {
    float y = 1.0 - x;
    return vec4(y * y * y, 3.0 * x * y * y, 3.0 * x * x * y, x * x * x);
}
vec4 bezier_slope(float x) {
    float y = 1.0 - x;
    return 3.0 * vec4(-y * y, y * (y - 2.0 * x), x * (2.0 * y - x), x * x);
}

BezierPoint bezier_point(BezierPiece p, vec2 q) {
    vec4 u = bezier_basis(q.x), slope = bezier_slope(q.x), v = bezier_basis(q.y);
    mat4 along = mat4(p.row0 * u, p.row1 * u, p.row2 * u, p.row3 * u);
    vec4 h = along * v, hv = along * bezier_slope(q.y);
    vec4 hu = mat4(p.row0 * slope, p.row1 * slope, p.row2 * slope, p.row3 * slope) * v;
    vec3 position = h.xyz / h.w;
    return BezierPoint(position, (hu.xyz - hu.w * position) / h.w, (hv.xyz - hv.w * position) / h.w);
}

float bezier_slack(BezierPiece p, vec3 at) {
    vec3 far = abs(at) + abs(p.origin);
    return p.slack + gamma(8.0) * max(far.x, max(far.y, far.z));
}

// Newton's step for a(q) = 0 with derivatives du, dv within a box; where it would leave that, along its side.
vec2 bezier_step(vec2 q, vec2 a, vec2 du, vec2 dv, vec2 lo, vec2 hi) {
    float det = du.x * dv.y - du.y * dv.x;
    vec2 next = det != 0.0 ? q - vec2(dv.y * a.x - dv.x * a.y, du.x * a.y - du.y * a.x) / det : q;
    vec2 inside = clamp(next, lo, hi);
    float along_u = q.x - dot(du, a + (inside.y - q.y) * dv) / max(dot(du, du), 1e-37);
    float along_v = q.y - dot(dv, a + (inside.x - q.x) * du) / max(dot(dv, dv), 1e-37);
    if (det == 0.0) return clamp(vec2(q.x, along_v), lo, hi);
    if (inside.x != next.x) inside.y = clamp(along_v, lo.y, hi.y);
    else if (inside.y != next.y) inside.x = clamp(along_u, lo.x, hi.x);
    return inside;
}

const uint BEZIER_LEVELS = 5u;    // a square of the last is left to Newton, from either end
const uint BEZIER_TURNS = 1024u;  // points asked for a ray

bool bezier_patch_intersect(BezierPatch r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(0));
    BezierPiece p = r.control_points;
    float speed = length(direction);
    vec3 d = direction / speed, o = origin - p.origin;
    // From the point of the ray that is nearest to the origin, if that lies ahead: starts may be far away.
    float shift = -dot(o, d);
    if (shift < -p.radius) return false;
    if (shift < 4.0 * p.radius) shift = 0.0;
    o += shift * d;
    float slack = bezier_slack(p, origin) + gamma(8.0) * shift, limit = t_max * speed - shift;
    // The ray's own frame: along z, x across the normal.
    vec3 x = cross(p.axis, d);
    // Second derivatives as the ray sees them: what lies along it is foreshortened.
    vec3 second = p.second_along + p.second_out, across = p.second_along + p.second_out * min(1.0001 * length(x), 1.0);
    if (dot(x, x) < 1e-12) x = abs(d.x) < 0.7 ? cross(d, vec3(1, 0, 0)) : cross(d, vec3(0, 1, 0));
    x = normalize(x);
    mat3 to_ray = transpose(mat3(x, cross(d, x), d));

    uvec2 square = uvec2(0), flip = uvec2(0);  // flipped so that the first lies nearest
    uint level = 0u, steps = 0u, starts = 0u;
    vec2 q = vec2(0.5), center = q, far = q;
    bool found = false;
    for (uint turn = 0u; turn < BEZIER_TURNS; ++turn) {
        BezierPoint at = bezier_point(p, q);
        vec3 a = to_ray * (at.position - o), du = to_ray * at.du, dv = to_ray * at.dv;
        float h = 0.5 / float(1u << level);
        vec2 lo = max(center - 1.25 * h, 0.0), hi = min(center + 1.25 * h, 1.0);
        vec2 next = bezier_step(q, a.xy, du.xy, dv.xy, lo, hi);
        if (steps == 0u) {
            // The surface in the square is flat within `bent`, along the ray within `deep`.
            float bent = (0.5 * across.x + across.y + 0.5 * across.z) * h * h + slack;
            float deep = (0.5 * second.x + second.y + 0.5 * second.z) * h * h + slack;
            vec3 reach = (abs(du) + abs(dv)) * h + vec3(bent, bent, deep);
            bool meets = all(lessThanEqual(abs(a.xy), reach.xy)) && a.z + reach.z > -shift && a.z - reach.z < limit;
            float signed_det = du.x * dv.y - du.y * dv.x, det = abs(signed_det), inverse = max(length(du.xy), length(dv.xy));
            bool sure = inverse * (across.x + 2.0 * across.y + across.z) * h <= 0.5 * det;
            if (sure) {
                vec2 root = vec2(dv.y * a.x - dv.x * a.y, du.x * a.y - du.y * a.x);
                // The point's place along the ray, within what these may change.
                float z = a.z * det - dot(vec2(du.z, dv.z), signed_det < 0.0 ? -root : root);
                float off = deep * det + bent * inverse * (abs(du.z) + abs(dv.z));
                meets = meets && all(lessThanEqual(abs(root), vec2(h * det + inverse * bent))) && z + off > -shift * det &&
                        z - off < limit * det;
            }
            if (meets && (sure || level == BEZIER_LEVELS)) {
                starts = sure ? 1u : 2u;
                steps = 10u;
                q = next;
                if (sure) continue;
                // Below the ray, on its way through the square: from either end the point next to it is found.
                vec2 along = vec2(dv.x, -du.x), middle = center - a.x * vec2(du.x, dv.x) / max(dot(along, along), 1e-37);
                along *= 1.25 * h / max(max(abs(along.x), abs(along.y)), 1e-37);
                if (along.x * du.z + along.y * dv.z < 0.0) along = -along;
                q = clamp(middle - along, lo, hi), far = clamp(middle + along, lo, hi);
                continue;
            }
            if (meets) {
                if (level == 0u) flip = uvec2(lessThan(vec2(du.z, dv.z), vec2(0)));
                level++, square *= 2u, h *= 0.5;
                center = (vec2(square ^ (flip * ((1u << level) - 1u))) + 0.5) / float(1u << level);
                q = center;
                continue;
            }
        } else {
            if (--steps > 0u && any(greaterThan(abs(next - q), vec2(1e-7)))) {
                q = next;
                continue;
            }
            // Near to the ray, and crossed by it: one that leaves the surface is near to where it began, too.
            vec3 n = cross(du, dv);
            bool crosses = n.z * (dot(n, a) + shift * n.z) >= 0.0;
            if (crosses && length(a.xy) <= slack && a.z > -shift && a.z < limit) {
                found = true, limit = a.z;
                hit = GeometryHit((shift + a.z) / speed, q);
            } else if (starts == 2u) {
                starts = 1u, steps = 10u, q = far;
                continue;
            }
            steps = 0u;
        }
        // The next square.
        while (level > 0u && (square.x & square.y & 1u) == 1u) level--, square /= 2u;
        if (level == 0u) break;
        square += (square.x & 1u) == 0u ? uvec2(1, 0) : uvec2(-1, 1);
        center = (vec2(square ^ (flip * ((1u << level) - 1u))) + 0.5) / float(1u << level);
        q = center;
    }
    return found;
}

// At a border that is a point, and close to it, as a little further within.
vec3 bezier_normal(BezierPiece p, vec2 q, BezierPoint at, float area) {
    vec3 n = cross(at.du, at.dv);
    if (dot(n, n) < square(3e-3 * area)) {
        at = bezier_point(p, mix(q, vec2(0.5), 6e-3));
        n = cross(at.du, at.dv);
    }
    return normalize(n);
}

float bezier_area(BezierPiece p) {
    vec4 rows = p.area_density * vec4(0.25);
    return dot(rows, vec4(0.25));
}

LocalPoint bezier_patch_locate(BezierPatch r, vec3 origin, vec3 direction, GeometryHit hit) {
    BezierPiece p = r.control_points;
    BezierPoint at = bezier_point(p, hit.uv);
    vec3 position = p.origin + at.position;
    return LocalPoint(position, vec3(2.5 * bezier_slack(p, position)), bezier_normal(p, hit.uv, at, bezier_area(p)), at.du,
                      mix(p.domain.xy, p.domain.zw, hit.uv));
}

float bezier_patch_area(BezierPatch r) { return bezier_area(r.control_points); }

// Where the integral of a cubic, given in Bernstein's polynomials, reaches the part u of the whole.
float bezier_quantile(vec4 density, float u) {
    vec4 sums = vec4(density.x, density.x + density.y, density.x + density.y + density.z, dot(density, vec4(1)));
    float lo = 0.0, hi = 1.0, x = u;
    for (int i = 0; i < 12; ++i) {
        float y = 1.0 - x;
        float rest = x * (4.0 * y * y * y * sums.x + x * (6.0 * y * y * sums.y + x * (4.0 * y * sums.z + x * sums.w))) - u * sums.w;
        if (rest > 0.0) hi = x;
        else lo = x;
        float next = x - rest / (4.0 * dot(bezier_basis(x), density));
        x = next > lo && next < hi ? next : 0.5 * (lo + hi);
    }
    return x;
}

GeometrySample bezier_patch_sample(BezierPatch r, vec2 u) {
    BezierPiece p = r.control_points;
    vec2 q;
    q.y = bezier_quantile(vec4(0.25) * p.area_density, u.y);
    q.x = bezier_quantile(bezier_basis(q.y) * p.area_density, u.x);
    BezierPoint at = bezier_point(p, q);
    float area = bezier_area(p);
    return GeometrySample(p.origin + at.position, bezier_normal(p, q, at, area), 1.0 / area);
}

GeometrySample bezier_patch_sample_towards(BezierPatch r, vec3 reference, vec2 u) { return bezier_patch_sample(r, u); }

float bezier_patch_pdf_towards(BezierPatch r, vec3 reference, vec3 position, vec3 normal) { return 1.0 / bezier_area(r.control_points); }

void bezier_patch_bounds(BezierPatch r, out vec3 lo, out vec3 hi) {
    lo = r.control_points.lo, hi = r.control_points.hi;
}
