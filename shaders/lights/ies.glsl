// A lamp as its maker publishes it: a photometric file, IES LM-63 (.ies) or EULUMDAT (.ldt), says its luminous intensity in every
// direction. It hangs at its node and shines down -z: gamma = 0 is -z, the plane C0 lies towards +x, C90 towards +y; of types B and A,
// V = H = 0 is -z, positive V lie towards +x, H towards +y. Of the node's transform only position and directions count.
//
// Light comes from all of its luminous opening, as the file has it (`etendue inspect` tells), with its centre at the node: every part
// of it sends light as the file says of the whole lamp. A rectangle or disk so has the radiance I / (A cos); boxes, tubes and balls
// shine evenly from within. Such an opening is no surface: nothing of the lamp itself is seen, in mirrors neither.
// With a rectangle or disk at the same node and `opening` true that is the luminous opening instead of the file's, and is seen as
// it shines, with the radiance I / (A cos); its material says what it reflects.
//
// Intensity is bilinear in both angles of the table and 0 beyond its ends. Directions are sampled exactly in proportion to it: the
// angle from the pole by its integral, then the longitude within that.
//
// Example:
//     {"nodes": [{"name": "wall washer", "translation": [0, 1.9, 0.3], "rotation": [-0.7071, 0, 0, 0.7071], "extensions": {"ETD_optics": {
//         "light": {"class": "ies", "file": "washer.ies", "turn": 1.57, "flux": 40}}}}]}
#include "lib/primitives.glsl"

// A table on the device, twin in host/photometry/photometric_table.h. Layout of photometric_values from `first`, with M angles and
// N planes:
//   M angles, rad; M parts of the flux up to the angle, 0 to 1; N planes, rad from the first one
//   N x M intensities, cd, those of the first angle first
//   N x M integrals of these over the planes up to the plane, cd rad
struct PhotometryRef {
    uint first;
    uint planes, angles;
    uint type;       // 0, 1, 2: C, B, A
    float start;     // longitude of the first plane, rad
    float flux;      // lm
    float cos_lit;   // of the angle from -z within which all light goes
    uint shape;      // of the opening: 0 a point, 1 a box, 2 round about an axis, 3 a ball
    uint axis;       // 0 to 2: C0, C90, z
    vec3 size;       // m, along C0, C90 and z
};

// The primitive of a shape at the light's own node; NO_RECORD = none.
struct OwnShape {
    uint primitive;
};

struct IesLight {
    Placement placement;
    PhotometryRef file;  //: required. Photometric file, .ies or .ldt.
    float flux;          //: 0 in [0, inf) lm. Luminous flux that the lamp is scaled to; 0: as the file says.
    float scale;         //: 1 in [0, inf). Multiplies the intensity.
    SpectrumRef color;   //: 1 in [0, inf). Multiplies the intensity.
    float turn;          //: 0 rad. Turns the lamp about -z, from C0 to C90: makers differ in where C0 is.
    bool point;          //: false. All light comes from the node, whatever the luminous opening.
    OwnShape opening;    //: false. The rectangle or disk of the node is the luminous opening, and is seen.
};

layout(scalar, set = 0) readonly buffer PhotometricValues { float photometric_values[]; };

// C0, C90 and the lamp's back, in the world.
mat3 ies_frame(IesLight r) {
    mat3 f = node_frame(r.placement.world_from_local);
    vec2 t = cos_sin_turns(r.turn * (0.5 * INV_PI));
    return mat3(t.x * f[0] + t.y * f[1], t.x * f[1] - t.y * f[0], f[2]);
}

// The pole of the table and its longitudes 0 and 90, in the world.
mat3 ies_axes(IesLight r) {
    mat3 f = ies_frame(r);
    return r.file.type == 0u ? mat3(-f[2], f[0], f[1]) : r.file.type == 1u ? mat3(f[1], -f[2], f[0]) : mat3(f[0], -f[2], f[1]);
}

bool ies_is_point(IesLight r) { return r.point || r.file.shape == 0u; }
bool ies_is_seen(IesLight r) { return r.opening.primitive != NO_RECORD; }

// What of an area A is seen along the direction, m².
float ies_seen_area(IesLight r, vec3 normal, vec3 direction) {
    return primitive_area(r.opening.primitive) * max(abs(dot(normal, direction)), 1e-6);
}

// A point of the opening, evenly: a lower part of u serves as a third number.
vec3 ies_position(IesLight r, vec2 u) {
    vec3 center = r.placement.world_from_local[3];
    if (ies_is_point(r)) return center;
    float third = fract(1024.0 * u.x);
    vec3 p;
    if (r.file.shape == 1u) {
        p = vec3(u, third) - 0.5;
    } else if (r.file.shape == 2u) {
        vec2 across = 0.5 * warp_disk(u);
        float along = third - 0.5;
        p = r.file.axis == 0u ? vec3(along, across) : r.file.axis == 1u ? vec3(across.x, along, across.y) : vec3(across, along);
    } else {
        p = 0.5 * pow(third, 1.0 / 3.0) * warp_sphere(u);
    }
    return center + ies_frame(r) * (p * r.file.size);
}

float ies_scale(IesLight r) { return r.flux > 0.0 ? r.scale * r.flux / max(r.file.flux, 1e-30) : r.scale; }

// The last of `count` rising numbers, but for the very last, that is at most `value`.
uint photometric_search(uint first, uint count, float value) {
    uint low = 0u, high = count - 1u;
    [[dont_unroll]] while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (photometric_values[first + middle] <= value)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// cd, of the file itself, along a unit direction away from the lamp.
float ies_table(IesLight r, vec3 direction) {
    PhotometryRef f = r.file;
    vec3 d = direction * ies_axes(r);
    float angle = accurate_atan2(length(d.yz), d.x);
    float longitude = accurate_atan2(d.z, d.y) - f.start;
    longitude -= 2.0 * PI * floor(longitude * (0.5 * INV_PI));
    uint sums = f.first + f.angles, planes = sums + f.angles, values = planes + f.planes;
    float last_angle = photometric_values[f.first + f.angles - 1u], last_plane = photometric_values[planes + f.planes - 1u];
    const float slack = 2e-6;  // what rounding may make of the outermost angles
    if (angle < photometric_values[f.first] - slack || angle > last_angle + slack || longitude > last_plane + slack) return 0.0;
    uint j = photometric_search(f.first, f.angles, angle), i = photometric_search(planes, f.planes, longitude);
    float a = photometric_values[f.first + j], b = photometric_values[f.first + j + 1u];
    float c = photometric_values[planes + i], e = photometric_values[planes + i + 1u];
    float y = clamp((angle - a) / (b - a), 0.0, 1.0), x = clamp((longitude - c) / (e - c), 0.0, 1.0);
    uint at = values + j * f.planes + i, next = at + f.planes;
    return mix(mix(photometric_values[at], photometric_values[at + 1u], x),
               mix(photometric_values[next], photometric_values[next + 1u], x), y);
}

// Density of directions, 1/sr.
float ies_density(IesLight r, vec3 direction) { return r.file.flux > 0.0 ? ies_table(r, direction) / r.file.flux : 0.0; }

// The integral of (a + b t) sin(start + t) over t in [0, d], of which `ends` are the cosine and sine of `start`.
float ies_row_integral(float a, float b, vec2 ends, float d) {
    vec2 half_turn = cos_sin_turns(d * (0.25 * INV_PI));
    float versed = 2.0 * square(half_turn.y), s = 2.0 * half_turn.x * half_turn.y, z = d * d;
    // sin d - d cos d: small ones by their series
    float turned = d < 0.5 ? d * z * ((1.0 / 3.0) - z * ((1.0 / 30.0) - z * (1.0 / 840.0))) : s - d * (1.0 - versed);
    return ends.y * (a * s + b * (d * s - versed)) + ends.x * (a * versed + b * turned);
}

// Undoes it: a bracket that halves or follows the tangent. `width`: of the row, rad.
float ies_row_inverse(float a, float b, float start, float width, float integral) {
    vec2 ends = cos_sin_turns(start * (0.5 * INV_PI));
    float low = 0.0, high = width;
    float d = 0.5 * width;
    [[dont_unroll]] for (uint k = 0u; k < 14u; ++k) {
        float off = ies_row_integral(a, b, ends, d) - integral;
        if (off > 0.0)
            high = d;
        else
            low = d;
        float slope = (a + b * d) * cos_sin_turns((start + d) * (0.5 * INV_PI)).y;
        float next = d - off / slope;
        d = slope > 0.0 && next > low && next < high ? next : 0.5 * (low + high);
    }
    return d;
}

// A point of the opening is drawn here and in emit alike, so that what is left to say of both is what is said of a point.
LightSample ies_sample_towards(IesLight r, vec3 point, vec2 u) {
    GeometrySample g = GeometrySample(vec3(0), vec3(0, 0, 1), 0.0);
    vec3 error;
    if (ies_is_seen(r)) g = primitive_sample(r.opening.primitive, u, error);
    else g.position = ies_position(r, u);
    vec3 d = g.position - point;
    float distance = length(d);
    if (!(distance > 0.0)) return no_light_sample();
    vec3 direction = d / distance;
    float candela = ies_table(r, -direction);
    if (!(candela > 0.0)) return no_light_sample();
    float area = ies_is_seen(r) ? ies_seen_area(r, g.normal, direction) : 1.0;
    return LightSample(direction, distance, untinted_value(r.color) * (candela * ies_scale(r) / area), square(distance) / area,
                       candela / (r.file.flux * area), !ies_is_seen(r));
}

float ies_pdf_towards(IesLight r, vec3 point, vec3 direction, LightHit hit) {
    vec3 d = hit.position - point;
    return dot(d, d) / (ies_is_seen(r) ? ies_seen_area(r, hit.normal, direction) : 1.0);
}

Spectrum ies_radiance(IesLight r, vec3 direction, LightHit hit) {
    if (!ies_is_seen(r)) return Spectrum(0);
    return untinted_value(r.color) * (ies_table(r, -direction) * ies_scale(r) / ies_seen_area(r, hit.normal, direction));
}

EmittedRay ies_emit(IesLight r, SceneBounds bounds, vec2 u_position, vec2 u_direction) {
    PhotometryRef f = r.file;
    if (!(f.flux > 0.0)) return no_emitted_ray();
    uint sums = f.first + f.angles, planes = sums + f.angles, values = planes + f.planes, integrals = values + f.planes * f.angles;
    u_direction = max(u_direction, vec2(0.5 * EPSILON));

    uint j = photometric_search(sums, f.angles, u_direction.x);
    float start = photometric_values[f.first + j], width = photometric_values[f.first + j + 1u] - start;
    uint row = integrals + j * f.planes, next = row + f.planes;
    float a = photometric_values[row + f.planes - 1u], b = photometric_values[next + f.planes - 1u];
    float angle = ies_row_inverse(a, (b - a) / width, start, width, (u_direction.x - photometric_values[sums + j]) * f.flux);
    float y = clamp(angle / width, 0.0, 1.0);

    float wanted = u_direction.y * mix(a, b, y);
    uint low = 0u, high = f.planes - 1u;
    [[dont_unroll]] while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (mix(photometric_values[row + middle], photometric_values[next + middle], y) <= wanted)
            low = middle;
        else
            high = middle;
    }
    uint at = values + j * f.planes + low, below = at + f.planes;
    float from = mix(photometric_values[at], photometric_values[below], y),
          to = mix(photometric_values[at + 1u], photometric_values[below + 1u], y);
    float here = photometric_values[planes + low], step = photometric_values[planes + low + 1u] - here;
    float rest = max(wanted - mix(photometric_values[row + low], photometric_values[next + low], y), 0.0) / step;
    float x = clamp(2.0 * rest / max(from + sqrt(max(from * from + 2.0 * (to - from) * rest, 0.0)), 1e-30), 0.0, 1.0);

    float candela = mix(from, to, x);
    if (!(candela > 0.0)) return no_emitted_ray();
    vec2 polar = cos_sin_turns((start + angle) * (0.5 * INV_PI));
    vec2 around = cos_sin_turns((f.start + here + x * step) * (0.5 * INV_PI));
    vec3 direction = normalize(ies_axes(r) * vec3(polar.x, polar.y * around));
    Spectrum intensity = untinted_value(r.color) * (candela * ies_scale(r));
    if (!ies_is_seen(r))
        return EmittedRay(ies_position(r, u_position), vec3(0), direction, direction, intensity, candela / f.flux, true, true);
    vec3 error;
    GeometrySample g = primitive_sample(r.opening.primitive, u_position, error);
    float area = ies_seen_area(r, g.normal, direction);
    bool front = dot(g.normal, direction) > 0.0;
    return EmittedRay(g.position, error, front ? g.normal : -g.normal, direction, intensity / area, candela / (f.flux * area), false, front);
}

float ies_pdf_emit(IesLight r, SceneBounds bounds, vec3 direction, LightHit hit) {
    return ies_density(r, -direction) / (ies_is_seen(r) ? ies_seen_area(r, hit.normal, direction) : 1.0);
}

float ies_power(IesLight r, SceneBounds bounds) { return r.file.flux * ies_scale(r) * luminance(untinted_value(r.color)); }

void ies_bounds(IesLight r, out vec3 lo, out vec3 hi) {
    lo = hi = r.placement.world_from_local[3];
    if (ies_is_seen(r)) {
        primitive_bounds(r.opening.primitive, lo, hi);
        return;
    }
    if (ies_is_point(r)) return;
    mat3 f = ies_frame(r);
    vec3 extent = 0.5 * (abs(f[0]) * r.file.size.x + abs(f[1]) * r.file.size.y + abs(f[2]) * r.file.size.z);
    lo -= extent, hi += extent;
}

LightCone ies_cone(IesLight r) { return LightCone(-normalize(r.placement.world_from_local[2]), r.file.cos_lit, 0.99); }
