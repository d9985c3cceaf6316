// A medium whose squared refractive index is a polynomial of the distance from an axis and of the place along it, as that of
// rods and fibres that focus. With r and z, these two,
//   n² = ior² (1 + radial · (r², r⁴, r⁶) + axial · (z, z², z³))
// A rod of the focusing constant g has radial [-g², …] (Gomez-Reino, Perez & Bao 2002, "Gradient-Index Optics", section 1.2);
// Luneburg's lens of radius a has ior √2, radial [-1 / (2 a²), …] and axial [0, -1 / (2 a²), 0]. It absorbs along the bent path.
//
// Example:
//     {"materials": [{"name": "Luneburg's lens", "extensions": {"ETD_optics": {
//         "surface": {"class": "dielectric"}, "inside": "Luneburg's lens"}}}],
//      "extensions": {"ETD_optics": {"media": [
//         {"name": "Luneburg's lens", "class": "gradient_index", "ior": 1.41421356, "center": [0, 0.5, 0],
//          "radial": [-2, 0, 0], "axial": [0, -2, 0], "tolerance": 1e-3}]}}}
#include "lib/free_path.glsl"
#include "lib/plain_media.glsl"
#include "lib/records.glsl"

struct GradientIndex {
    SpectrumRef ior;         //: 1.5 in [0.1, 100] ior. Real refractive index at the centre.
    SpectrumRef absorption;  //: 0 in [0, inf) 1/m. Absorption coefficient.
    vec3 radial;             //: [0, 0, 0] 1/m², 1/m⁴, 1/m⁶. Coefficients of r², r⁴, r⁶, r being the distance from the axis.
    vec3 axial;              //: [0, 0, 0] 1/m, 1/m², 1/m³. Coefficients of z, z², z³, z running along the axis from the centre.
    WorldPoint center;       //: [0, 0, 0] m. A point of the axis, in the world.
    Direction axis;          //: [0, 0, 1]. Its direction, of any length.
    float tolerance;         //: 1e-6 in (0, inf) m. By which a bent ray may leave the chords that stand for it.
};

const float LEAST_INDEX = 0.1;  // of what the polynomial says, where it is no index

// n² / ior², and what half its gradient is along the radius, over r, and along the axis.
vec3 gradient_index_profile(GradientIndex r, float radius2, float z) {
    vec3 c = r.radial, a = r.axial;
    float squared = 1.0 + radius2 * (c.x + radius2 * (c.y + radius2 * c.z)) + z * (a.x + z * (a.y + z * a.z));
    return vec3(squared, c.x + radius2 * (2.0 * c.y + 3.0 * radius2 * c.z), 0.5 * a.x + z * (a.y + 1.5 * z * a.z));
}

Spectrum gradient_index_ior(GradientIndex r, vec3 position) {
    vec3 d = position - r.center.position;
    float z = dot(d, r.axis.unit);
    vec3 across = d - z * r.axis.unit;
    float squared = gradient_index_profile(r, dot(across, across), z).x;
    return max(untinted_value(r.ior) * sqrt(max(squared, 0.0)), Spectrum(LEAST_INDEX));
}

bool gradient_index_bends(GradientIndex r) { return r.radial != vec3(0) || r.axial != vec3(0); }

vec3 gradient_index_bending(GradientIndex r, vec3 position) {
    vec3 d = position - r.center.position;
    float z = dot(d, r.axis.unit), ior = of_hero(untinted_value(r.ior));
    vec3 across = d - z * r.axis.unit;
    vec3 profile = gradient_index_profile(r, dot(across, across), z);
    return ior * ior * (profile.y * across + profile.z * r.axis.unit);
}

StepLimits gradient_index_step_limits(GradientIndex r) {
    vec3 c = abs(r.radial), a = abs(r.axial);
    float fastest = max(max(max(sqrt(c.x), pow(c.y, 0.25)), max(pow(c.z, 1.0 / 6.0), a.x)), max(sqrt(a.y), pow(a.z, 1.0 / 3.0)));
    return StepLimits(r.tolerance, 0.5 / max(fastest, 1e-30));
}

bool gradient_index_is_clear(GradientIndex r) { return is_black(untinted_value(r.absorption)); }

Passage gradient_index_pass(GradientIndex r, MediumRay ray, uint seed) {
    Spectrum left = exp(-untinted_value(r.absorption) * ray.distance);
    return Passage(left, brightness(left));
}

NEVER_SCATTERS(GradientIndex, gradient_index)
