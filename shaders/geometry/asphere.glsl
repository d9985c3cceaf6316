// A lens surface about the z axis with its vertex at the origin, seen from +z: z = c r² / (1 + √(1 - (1 + K) c² r²)) + a₄ r⁴ + a₆ r⁶ + …
// up to the aperture, on the sheet that holds the vertex, with a hole about it if wanted. u runs around the axis, v from it to the rim.
//
// Example:
//     {"nodes": [{"name": "asphere", "translation": [0, 0.45, 0], "rotation": [-0.2588, 0, 0, 0.9659], "extensions": {"ETD_optics": {
//         "geometry": {"class": "asphere", "curvature": -2, "conic": -1, "coefficients": [3], "aperture": 0.45, "material": 1}}}}]}
#include "lib/accurate_math.glsl"
#include "lib/warps.glsl"

struct AsphereCoefficients {
    vec4 low, high;  // of r⁴ to r¹⁰, of r¹² to r¹⁸
};

struct Asphere {
    float curvature;                   //: 0 in (-inf, inf) 1/m. Of the vertex: 1 / radius; above 0 the rim lies at +z.
    float conic;                       //: 0 in (-inf, inf). Conic constant K: 0 sphere, -1 paraboloid, below -1 hyperboloid.
    AsphereCoefficients coefficients;  //: []. Of r^4, r^6, … r^18, in 1/m^3, 1/m^5, …
    float aperture;                    //: required in (0, inf) m. Radius of the rim; of spheres and ellipsoids at most where they are widest.
    float hole;                        //: 0 in [0, inf) m. Radius of a hole about the axis, less than that.
};

bool asphere_is_conic(Asphere r) { return r.coefficients.low == vec4(0) && r.coefficients.high == vec4(0); }

// a₄ r⁴ + …, of w = r².
float asphere_polynomial(AsphereCoefficients a, float w) {
    float high = ((a.high.w * w + a.high.z) * w + a.high.y) * w + a.high.x;
    return ((((high * w + a.low.w) * w + a.low.z) * w + a.low.y) * w + a.low.x) * w * w;
}

// The root in the formula; 0 beyond where there is a surface.
float asphere_root(Asphere r, float w) { return sqrt(max(1.0 - (1.0 + r.conic) * r.curvature * r.curvature * w, 0.0)); }

float asphere_sag(Asphere r, float w) {
    return r.curvature * w / (1.0 + asphere_root(r, w)) + asphere_polynomial(r.coefficients, w);
}

// dz/dw. Finite at the equator, too: there it is as steep as 1e4.
float asphere_slope(Asphere r, float w) {
    AsphereCoefficients a = r.coefficients;
    float high = ((9.0 * a.high.w * w + 8.0 * a.high.z) * w + 7.0 * a.high.y) * w + 6.0 * a.high.x;
    float polynomial = ((((high * w + 5.0 * a.low.w) * w + 4.0 * a.low.z) * w + 3.0 * a.low.y) * w + 2.0 * a.low.x) * w;
    return 0.5 * r.curvature / max(asphere_root(r, w), 1e-4) + polynomial;
}

// Heights of the rim and the vertex, and what the polynomial may add on the way. No numbers where the rim is wider than the conic.
void asphere_bounds(Asphere r, out vec3 lo, out vec3 hi) {
    float w = r.aperture * r.aperture;
    float conic = r.curvature * w / (1.0 + asphere_root(r, w));
    if ((1.0 + r.conic) * r.curvature * r.curvature * w > 1.000001) conic = INFINITY;
    AsphereCoefficients a = r.coefficients;
    AsphereCoefficients up = AsphereCoefficients(max(a.low, 0.0), max(a.high, 0.0));
    AsphereCoefficients down = AsphereCoefficients(min(a.low, 0.0), min(a.high, 0.0));
    lo = vec3(-r.aperture, -r.aperture, min(conic, 0.0) + asphere_polynomial(down, w));
    hi = vec3(r.aperture, r.aperture, max(conic, 0.0) + asphere_polynomial(up, w));
}

bool is_on_asphere(Asphere r, vec3 p) {
    float w = dot(p.xy, p.xy);
    return w <= r.aperture * r.aperture && w >= r.hole * r.hole;
}

// c (r² + (1 + K) z²) - 2 z = 0 along the ray, a t² + 2 b t + e = 0, without a difference of near numbers. On the vertex sheet
// 1 - c (1 + K) z, the root of the formula, is not negative.
bool asphere_meet_conic(Asphere r, vec3 o, vec3 d, float t_min, float t_max, out float t) {
    float c = r.curvature, k = 1.0 + r.conic;
    vec3 weights = vec3(1, 1, k);
    float a = c * dot(d * d, weights), b = c * dot(o * d, weights) - d.z, e = c * dot(o * o, weights) - 2.0 * o.z;
    float discriminant = b * b - a * e;
    t = INFINITY;
    if (!(discriminant >= 0.0)) return false;
    float q = b >= 0.0 ? -b - sqrt(discriminant) : -b + sqrt(discriminant);
    for (int i = 0; i < 2; ++i) {
        float divisor = i == 0 ? q : a;
        float at = divisor != 0.0 ? (i == 0 ? e : q) / divisor : INFINITY;
        vec3 p = o + at * d;
        bool met = at > t_min && at < min(t_max, t) && is_on_asphere(r, p) && 1.0 - c * k * p.z >= 0.0;
        if (met) t = at;
    }
    return t < INFINITY;
}

// Height above the surface along the ray, and its derivative.
vec2 asphere_height(Asphere r, vec3 o, vec3 d, float t) {
    vec3 p = o + t * d;
    float w = dot(p.xy, p.xy);
    return vec2(p.z - asphere_sag(r, w), d.z - 2.0 * asphere_slope(r, w) * dot(p.xy, d.xy));
}

// Where the height changes its sign between t0 and t1: Newton's steps as long as they stay between, else halves.
float asphere_solve(Asphere r, vec3 o, vec3 d, float t0, float t1, bool rises) {
    float t = 0.5 * (t0 + t1);
    for (int i = 0; i < 32; ++i) {
        vec2 f = asphere_height(r, o, d, t);
        if (f.x == 0.0) return t;
        if ((f.x > 0.0) == rises) t1 = t;
        else t0 = t;
        float next = t - f.x / f.y;
        if (!(next > t0 && next < t1) || i > 12) next = 0.5 * (t0 + t1);
        if (next == t) return t;
        t = next;
    }
    return t;
}

// The first crossing of the part of the ray that lies within the rim, in steps; where a step comes nearer to the surface and leaves it
// again, its nearest point is asked, too.
bool asphere_meet(Asphere r, vec3 o, vec3 d, float t_min, float t_max, out float t) {
    const int steps = 16;
    t = INFINITY;
    vec3 lo, hi;
    asphere_bounds(r, lo, hi);
    float margin = gamma(64.0) * (hi.z - lo.z + r.aperture);
    // Between the planes, then within the cylinder.
    vec2 ends = vec2(t_min, t_max);
    if (d.z != 0.0) {
        vec2 planes = (vec2(lo.z - margin, hi.z + margin) - o.z) / d.z;
        ends = vec2(max(ends.x, min(planes.x, planes.y)), min(ends.y, max(planes.x, planes.y)));
    } else if (o.z < lo.z - margin || o.z > hi.z + margin) return false;
    float a = dot(d.xy, d.xy);
    if (a > 0.0) {
        float middle = -dot(o.xy, d.xy) / a;
        float nearest = abs(o.x * d.y - o.y * d.x) / sqrt(a);
        float half2 = (r.aperture - nearest) * (r.aperture + nearest) / a;
        if (!(half2 >= 0.0)) return false;
        ends = vec2(max(ends.x, middle - sqrt(half2)), min(ends.y, middle + sqrt(half2)));
    } else if (dot(o.xy, o.xy) > r.aperture * r.aperture) return false;
    if (!(ends.x < ends.y)) return false;

    float t0 = ends.x;
    vec2 f0 = asphere_height(r, o, d, t0);
    for (int i = 1; i <= steps; ++i) {
        float t1 = mix(ends.x, ends.y, float(i) / float(steps));
        vec2 f1 = asphere_height(r, o, d, t1);
        float side = f0.x > 0.0 ? 1.0 : -1.0;
        bool crossed = side * f1.x <= 0.0;
        float end = t1;
        if (!crossed && side * f0.y < 0.0 && side * f1.y > 0.0) {
            float before = t0, behind = t1;
            for (int k = 0; k < 24 && !crossed; ++k) {
                end = 0.5 * (before + behind);
                vec2 f = asphere_height(r, o, d, end);
                crossed = side * f.x <= 0.0;
                if (side * f.y < 0.0) before = end;
                else behind = end;
            }
        }
        if (crossed) {
            t = asphere_solve(r, o, d, t0, end, side < 0.0);
            if (is_on_asphere(r, o + t * d)) return t > t_min && t < t_max;
            t = INFINITY;  // through the hole
        }
        t0 = t1, f0 = f1;
    }
    return false;
}

bool asphere_intersect(Asphere r, vec3 origin, vec3 direction, float t_max, out GeometryHit hit) {
    hit = GeometryHit(INFINITY, vec2(0));
    // From the point of the ray that is nearest to the vertex, if that lies ahead: starts may be far away.
    float shift = max(-dot(origin, direction) / dot(direction, direction), 0.0);
    bool is_far = shift * length(direction) > 4.0 * r.aperture;
    shift = is_far ? shift : 0.0;
    vec3 o = origin + shift * direction;
    float t;
    bool met = asphere_is_conic(r) ? asphere_meet_conic(r, o, direction, -shift, t_max - shift, t)
                                   : asphere_meet(r, o, direction, -shift, t_max - shift, t);
    hit.t = shift + t;
    return met && hit.t > 0.0;
}

vec3 asphere_normal(Asphere r, vec2 p) { return normalize(vec3(-2.0 * asphere_slope(r, dot(p, p)) * p, 1.0)); }

LocalPoint asphere_locate(Asphere r, vec3 origin, vec3 direction, GeometryHit hit) {
    vec2 p = origin.xy + hit.t * direction.xy;
    float w = min(dot(p, p), r.aperture * r.aperture);
    float root = asphere_root(r, w);
    // On the surface, but for the roundings of its formula; those of w count most where it is steep.
    AsphereCoefficients a = AsphereCoefficients(abs(r.coefficients.low), abs(r.coefficients.high));
    float error = gamma(12.0) * (abs(asphere_sag(r, w)) + 3.0 * asphere_polynomial(a, w)) + gamma(6.0) * abs(r.curvature) * w / max(root, 1e-4);
    float turn = accurate_atan2(p.y, p.x) * (0.5 * INV_PI);
    return LocalPoint(vec3(p, asphere_sag(r, w)), vec3(0, 0, error), asphere_normal(r, p),
                      w > 0.0 ? vec3(-p.y, p.x, 0.0) : vec3(1, 0, 0), vec2(turn < 0.0 ? turn + 1.0 : turn, sqrt(w) / r.aperture));
}

// Area by q, with r² = R² (1 - (1 - q)²): even where the rim is the equator. In panels, by Gauss' three points.
const int ASPHERE_PANELS = 16;
float asphere_area_density(Asphere r, float q) {
    float w = r.aperture * r.aperture * q * (2.0 - q);
    float slope = asphere_slope(r, w);
    return 2.0 * PI * r.aperture * r.aperture * (1.0 - q) * sqrt(1.0 + 4.0 * w * slope * slope);
}
float asphere_area_between(Asphere r, float q0, float q1) {
    float middle = 0.5 * (q0 + q1), reach = 0.3872983 * (q1 - q0);  // √(3/5) / 2
    return (q1 - q0) * (5.0 * (asphere_area_density(r, middle - reach) + asphere_area_density(r, middle + reach)) +
                        8.0 * asphere_area_density(r, middle)) / 18.0;
}

float asphere_panel(Asphere r, int i) {
    float hole = r.hole / r.aperture, inner = hole * hole / (1.0 + sqrt((1.0 - hole) * (1.0 + hole)));
    return mix(inner, 1.0, float(i) / float(ASPHERE_PANELS));
}

float asphere_area(Asphere r) {
    float area = 0.0;
    for (int i = 0; i < ASPHERE_PANELS; ++i) area += asphere_area_between(r, asphere_panel(r, i), asphere_panel(r, i + 1));
    return area;
}

GeometrySample asphere_sample(Asphere r, vec2 u) {
    float area = asphere_area(r), wanted = u.x * area, q0 = 0.0, q1 = 0.0;
    for (int i = 0; i < ASPHERE_PANELS; ++i) {
        q0 = asphere_panel(r, i), q1 = asphere_panel(r, i + 1);
        float panel = asphere_area_between(r, q0, q1);
        if (wanted < panel || i == ASPHERE_PANELS - 1) break;
        wanted -= panel;
    }
    float q = 0.5 * (q0 + q1);
    for (int i = 0; i < 4; ++i)
        q = clamp(q + (wanted - asphere_area_between(r, q0, q)) / max(asphere_area_density(r, q), 1e-30), q0, q1);
    vec2 p = r.aperture * sqrt(q * (2.0 - q)) * cos_sin_turns(u.y);
    return GeometrySample(vec3(p, asphere_sag(r, dot(p, p))), asphere_normal(r, p), 1.0 / area);
}

GeometrySample asphere_sample_towards(Asphere r, vec3 reference, vec2 u) { return asphere_sample(r, u); }

float asphere_pdf_towards(Asphere r, vec3 reference, vec3 position, vec3 normal) { return 1.0 / asphere_area(r); }
