// A surface as it was measured, from a file: a table of reflection and transmission in JSON (scenes/FORMAT.md, "Measured surfaces"), or a
// file of the RGL material database (.bsdf; Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material
// Acquisition and Rendering"). Both sides alike.
//
// Measurements keep one direction fixed while the other is swept. Here the fixed one is where the receiver is, so that data
// which is not quite reciprocal means the same for forward and for backward rays; its slices also say where samples go. Where
// the media on the sides differ, what is transmitted is what the table says from the less dense side; the denser side
// loses what refraction turns back.
//
// Example:
//     {"materials": [{"name": "lacquer", "extensions": {"ETD_optics": {
//         "surface": {"class": "measured", "file": "paint.json"}}}}]}
#include "lib/accurate_math.glsl"
#ifndef MEASURED_SLICES
#define MEASURED_SLICES 4  // around a fixed direction: two, or four where its azimuth counts, too
#endif
#include "lib/measured_maps.glsl"

// Bits of `kind`.
const uint MEASURED_HALFWAY = 1u;       // an RGL file: over half vectors; else over directions
const uint MEASURED_ANISOTROPIC = 2u;
const uint MEASURED_TRANSMITS = 4u;     // slices for the far side follow those for the near one
const uint MEASURED_SYMMETRY = 4u;      // shift of the number of parts of a turn that are alike: 1, 2 or 4

struct MeasuredRef {  // a file; twin of host/measured/measured_bsdf.h
    uint kind;
    uint theta_first, theta_count;  // fixed directions, among measured_points: theta (halfway), or sin² theta
    uint phi_first, phi_count;      // their azimuths
    uint swept_first, turn_first;   // sin² theta of the columns of `density`, azimuths of its rows in turns (not halfway)
    MeasuredMap density;            // that samples have before they are warped
    MeasuredMap visible;            // of half vectors that the fixed direction sees; this and the next: halfway
    MeasuredMap normals;            // of half vectors
    MeasuredMap area;               // projected
    uint colors;                    // linear Rec.709, three numbers a point of `density`, from here in measured_colors
    uint spectra, channels;         // `channels` numbers a point in measured_spectra; 0 channels: colors alone
    SpectrumRef place;              // of each wavelength among the channels
};

struct Measured {
    MeasuredRef file;  //: required. Table (.json) or RGL file (.bsdf).
};

#if MEASURED_SLICES == 4
#define SURFACES_HAVE_TANGENTS  // lib/scattering.glsl: frames follow the surface's tangent
#endif

layout(scalar, set = 0) readonly buffer MeasuredColors { float measured_colors[]; };
#if SPECTRAL
layout(scalar, set = 0) readonly buffer MeasuredSpectra { float measured_spectra[]; };
#endif

bool measured_has(Measured r, uint bit) { return (r.file.kind & bit) != 0u; }

Measured measured_resolve(Measured r, SurfaceContext c) { return r; }

// Angles by atan2 of lengths keep the digits of small ones.
float polar_angle(vec3 w) { return accurate_atan2(length(w.xy), w.z); }
float azimuth(vec3 w) { return accurate_atan2(w.y, w.x); }
float folded_azimuth(MeasuredRef r, vec3 w) {  // at most 0 where the file holds a part of a turn alone
    float phi = azimuth(w);
    return r.kind >> MEASURED_SYMMETRY > 1u && phi > 0.0 ? -phi : phi;
}

MeasuredSlices measured_slices(MeasuredRef r, float phi, float theta) {
    float place = list_place(r.theta_first, r.theta_count, theta);
    uint below = min(uint(place), r.theta_count - 1u), above = min(below + 1u, r.theta_count - 1u);
    float f = place - float(below);
    MeasuredSlices s = MeasuredSlices(uvec4(below, above, 0u, 0u), vec4(1.0 - f, f, 0.0, 0.0));
#if MEASURED_SLICES == 4
    float turn = list_place(r.phi_first, r.phi_count, phi);
    uint before = min(uint(turn), r.phi_count - 1u), behind = min(before + 1u, r.phi_count - 1u);
    float g = turn - float(before);
    s.index = uvec4(before, before, behind, behind) * r.theta_count + s.index.xyxy;
    s.weight = vec4(s.weight.xy * (1.0 - g), s.weight.xy * g);
#endif
    return s;
}

// What stands at a place of the map `density`.
Spectrum measured_spectrum(MeasuredRef r, MeasuredSlices s, vec2 place) {
    uvec2 size = uvec2(r.density.width, r.density.height), cell = map_cell(r.density, place);
    vec2 f = place - vec2(cell);
    vec3 rgb = vec3(0);
#if SPECTRAL
    vec4 channel = spectrum_value(r.place);
    uvec4 below = min(uvec4(channel), uvec4(max(r.channels, 1u) - 1u));
    uvec4 above = min(below + 1u, uvec4(max(r.channels, 1u) - 1u));
    vec4 between = channel - vec4(below);
    Spectrum value = Spectrum(0);
#endif
    [[dont_unroll]] for (uint i = 0u; i < 4u * MEASURED_SLICES; ++i) {
        uvec2 corner = uvec2(i & 1u, (i >> 1) & 1u);
        vec2 part = mix(1.0 - f, f, vec2(corner));
        float weight = s.weight[i >> 2] * part.x * part.y;
        uint point = (s.index[i >> 2] * size.y + cell.y + corner.y) * size.x + cell.x + corner.x;
#if SPECTRAL
        if (r.channels > 0u) {
            uint first = r.spectra + point * r.channels;
            uvec4 a = first + below, b = first + above;
            value += weight * mix(vec4(measured_spectra[a.x], measured_spectra[a.y], measured_spectra[a.z],
                                       measured_spectra[a.w]),
                                  vec4(measured_spectra[b.x], measured_spectra[b.y], measured_spectra[b.z],
                                       measured_spectra[b.w]), between);
            continue;
        }
#endif
        uint first = r.colors + 3u * point;
        rgb += weight * vec3(measured_colors[first], measured_colors[first + 1u], measured_colors[first + 2u]);
    }
#if SPECTRAL
    if (r.channels > 0u) return value;
#endif
    return factor_of_rgb(rgb);
}

// Seen from a fixed direction: where the other one stands in the tables, and with which density it is drawn.
struct MeasuredWay {
    MeasuredSlices slices;
    vec2 place;    // of the map `density`
    float factor;  // f |cos| of what the tables have there
    float pdf;     // of the other direction, 1/sr
};

MeasuredWay no_measured_way() { return MeasuredWay(MeasuredSlices(uvec4(0), vec4(0)), vec2(0), 0.0, 0.0); }

// An RGL file has theta = u² pi/2 along the columns of its maps and phi = (2 v - 1) pi along the rows.
vec2 halfway_place(MeasuredMap m, float theta, float phi) {
    float turn = phi * (0.5 * INV_PI) + 0.5;
    return vec2(sqrt(theta * (2.0 * INV_PI)), turn - floor(turn)) * vec2(m.width - 1u, m.height - 1u);
}

// Into the part of a turn that the file holds, [-pi, 0] or [-pi, -pi/2].
vec2 measured_fold(MeasuredRef r, vec3 fixed_direction) {
    uint parts = r.kind >> MEASURED_SYMMETRY;
    vec2 fold = mix(vec2(1), vec2(-1), greaterThan(fixed_direction.xy, vec2(0)));
    return parts == 4u ? fold : parts == 2u ? fold.yy : vec2(1);
}

// Paper's equations 3 and 7: f |cos| = values ndf / (4 sigma), and half vectors are seen with the density of `visible`, which
// the warp from the square has, times that of `density` on it.
MeasuredWay measured_halfway_way(MeasuredRef r, vec3 w, vec3 v) {
    vec2 fold = measured_fold(r, w);
    w.xy *= fold, v.xy *= fold;
    vec3 h = w + v;
    float l2 = dot(h, h);
    if (!(w.z > 0.0 && v.z > 0.0 && l2 > 1e-14)) return no_measured_way();
    h *= inversesqrt(l2);
    float theta = polar_angle(w), phi = folded_azimuth(r, w), theta_h = polar_angle(h), phi_h = azimuth(h);
    if ((r.kind & MEASURED_ANISOTROPIC) == 0u) phi_h -= phi;
    MeasuredWay way;
    way.slices = measured_slices(r, phi, theta);
    float visible;
    vec2 u = map_invert(r.visible, way.slices, halfway_place(r.visible, theta_h, phi_h), visible);
    way.place = u * vec2(r.density.width - 1u, r.density.height - 1u);
    float area = 4.0 * map_slice_value(r.area, 0u, halfway_place(r.area, theta, phi));
    float normals = map_slice_value(r.normals, 0u, halfway_place(r.normals, theta_h, phi_h));
    way.factor = area > 0.0 ? normals / area : 0.0;
    // Solid angle of half vectors over the square, and of directions over half vectors.
    float angle = 2.0 * PI * PI * sqrt(theta_h * (2.0 * INV_PI)) * length(h.xy) * 4.0 * dot(w, h);
    way.pdf = angle > 0.0 ? visible * map_value(r.density, way.slices, way.place) / angle : 0.0;
    return way;
}

float measured_sine_square(vec3 w) { return min(dot(w.xy, w.xy), 1.0); }
vec2 unit_azimuth(vec3 w) {
    float across = length(w.xy);
    return across > 0.0 ? w.xy / across : vec2(1, 0);
}

MeasuredSlices far_slices(MeasuredRef r, MeasuredSlices s) {
    s.index += r.theta_count;
    return s;
}

MeasuredWay measured_direct_way(MeasuredRef r, vec3 w, vec3 v) {
    bool passes = v.z < 0.0, transmits = (r.kind & MEASURED_TRANSMITS) != 0u;
    MeasuredWay way;
    way.slices = measured_slices(r, 0.0, measured_sine_square(w));
    float integral = map_integral(r.density, way.slices);
    if (transmits) integral += map_integral(r.density, far_slices(r, way.slices));
    if (!(integral > 0.0) || (passes && !transmits)) return no_measured_way();
    if (passes) way.slices = far_slices(r, way.slices);
    vec2 along = unit_azimuth(w);
    float turn = accurate_atan2(along.x * v.y - along.y * v.x, dot(along, v.xy)) * (0.5 * INV_PI);
    way.place = vec2(list_place(r.swept_first, r.density.width, measured_sine_square(v)),
                     list_place(r.turn_first, r.density.height, turn - floor(turn)));
    way.factor = abs(v.z);
    // d(sin² theta) = 2 cos theta sin theta d(theta).
    way.pdf = map_value(r.density, way.slices, way.place) / integral * abs(v.z) * INV_PI;
    return way;
}

// The direction `w` is the fixed one. Both mirrored so that it is above.
MeasuredWay measured_way(Measured r, vec3 w, vec3 v) {
    if (w.z < 0.0) w.z = -w.z, v.z = -v.z;
    if (measured_has(r, MEASURED_HALFWAY)) return measured_halfway_way(r.file, w, v);
    return measured_direct_way(r.file, w, v);
}

// Transmission between media: (index on the side of wi over that of wo)² of the flux at most, and radiance over it.
float measured_index_scale(SurfaceContext c, vec3 wo, vec3 wi) {
    if (wo.z * wi.z > 0.0) return 1.0;
    float eta = wo.z < 0.0 ? c.ior_above / c.ior_below : c.ior_below / c.ior_above;
    return min(eta * eta, 1.0) / (c.importance ? 1.0 : eta * eta);
}

SurfacePair measured_evaluate(Measured r, SurfaceContext c, vec3 wo, vec3 wi) {
    SurfacePair pair = no_surface_pair();
    MeasuredWay seen = no_measured_way();
    // From wo, then from wi where that is asked for; in a loop so that the code stands once. Values are seen from the
    // receiver: from wo by backward rays, from wi by forward ones.
    uint ways = BIDIRECTIONAL != 0 || c.importance ? 2u : 1u;
    [[dont_unroll]] for (uint i = 0u; i < ways; ++i) {
        MeasuredWay way = measured_way(r, i == 0u ? wo : wi, i == 0u ? wi : wo);
        if (i == 0u) pair.pdf = way.pdf;
        else pair.pdf_reverse = way.pdf;
        if ((i == 1u) == c.importance) seen = way;
    }
    if (!(seen.factor > 0.0)) return pair;
    // Seen from wi its value has the cosine of wo.
    float cosines = c.importance ? abs(wo.z) > 0.0 ? abs(wi.z) / abs(wo.z) : 0.0 : 1.0;
    pair.value = measured_spectrum(r.file, seen.slices, seen.place) * (seen.factor * cosines * measured_index_scale(c, wo, wi));
    return pair;
}

vec3 measured_halfway_direction(MeasuredRef r, vec3 w, vec2 u) {
    vec2 fold = measured_fold(r, w);
    w.xy *= fold;
    float phi = folded_azimuth(r, w);
    MeasuredSlices s = measured_slices(r, phi, polar_angle(w));
    MeasuredMap m = r.density;
    [[dont_unroll]] for (uint i = 0u; i < 2u; ++i) {
        u = map_sample(m, s, u) / vec2(m.width - 1u, m.height - 1u);
        m = r.visible;
    }
    float turn = u.y - 0.5;
    if ((r.kind & MEASURED_ANISOTROPIC) == 0u) turn += phi * (0.5 * INV_PI);
    vec2 polar = cos_sin_turns(0.25 * u.x * u.x);
    vec3 h = vec3(cos_sin_turns(turn) * polar.y, polar.x);
    vec3 v = 2.0 * dot(w, h) * h - w;
    v.xy *= fold;
    return v;
}

vec3 measured_direct_direction(MeasuredRef r, vec3 w, vec3 u) {
    MeasuredSlices s = measured_slices(r, 0.0, measured_sine_square(w));
    float near = map_integral(r.density, s), far = 0.0;
    if ((r.kind & MEASURED_TRANSMITS) != 0u) far = map_integral(r.density, far_slices(r, s));
    bool passes = far > 0.0 && u.z * (near + far) >= near;
    if (passes) s = far_slices(r, s);
    vec2 place = map_sample(r.density, s, u.xy);
    float sine_square = list_number(r.swept_first, place.x, r.density.width);
    vec2 around = cos_sin_turns(list_number(r.turn_first, place.y, r.density.height)) * sqrt(sine_square);
    vec2 along = unit_azimuth(w);
    float height = sqrt(max(1.0 - sine_square, 0.0));
    return vec3(along * around.x + vec2(-along.y, along.x) * around.y, passes ? -height : height);
}

BsdfSample measured_sample(Measured r, SurfaceContext c, vec3 wo, vec3 u) {
    vec3 w = vec3(wo.xy, abs(wo.z));
    vec3 wi;
    if (measured_has(r, MEASURED_HALFWAY)) {
        wi = measured_halfway_direction(r.file, w, u.xy);
        if (wi.z <= 0.0) return no_bsdf_sample();
    } else {
        wi = measured_direct_direction(r.file, w, u);
    }
    bool passes = wi.z < 0.0;
    if (wo.z < 0.0) wi.z = -wi.z;
    return scattered(wi, passes ? EVENT_TRANSMIT : EVENT_REFLECT);
}

Spectrum measured_transparency(Measured r, SurfaceContext c, vec3 wo) { return Spectrum(0); }
bool measured_is_delta(Measured r, SurfaceContext c) { return false; }
bool measured_is_opaque(Measured r, SurfaceContext c) { return true; }
