// Spheres of any size, by the theory of Lorenz (1890) and Mie (1908): droplets of fog and clouds with their bows, glory and corona,
// aerosols, beads in paint. Around them is what the medium has as its index. How much they scatter and absorb the medium says, not
// this class.
//
// Sizes have a gamma distribution (Hansen & Travis 1974, "Light scattering in planetary atmospheres", equation 2.56). The host
// tabulates the scattering matrix (host/mie/mie_table.h) for wavelengths 10 nm apart; between them, and between cosines, it is
// linear here, and sampled exactly. Without wavelengths each channel has that of its dominant one (lane_wavelengths). The largest
// spheres may have a size parameter, 2 pi radius / wavelength, of 2000: a radius of 114 µm in air where all are the same, 40 µm at
// a variance of 0.1.
//
// Example:
//     {"extensions": {"ETD_optics": {"media": [
//         {"name": "fog", "class": "homogeneous", "scattering": 0.4,
//          "phase": {"class": "mie", "radius": 1e-6, "variance": 0.1}}]}}}
struct MieRef {  // twin in host/mie/mie_table.h
    uint first;  // node, of mie_values and mie_sums
    uint cells;  // in either half
};

struct Mie {
    float radius;                  //: 1e-5 in [1e-9, 1e-3] m. Effective radius of the spheres: the mean, weighted by cross section.
    float variance;                //: 0.1 in [0, 0.3]. Effective variance of their radii, in radius squared; 0: all the same.
    SpectrumRef ior;               //: 1.33 in [0.1, 10] ior. Real refractive index of the spheres.
    SpectrumRef absorption_index;  //: 0 in [0, 10]. Imaginary part of it, k of n - ik.
    MieRef table;                  // made from the parameters before it
};

// For each wavelength 2 cells + 1 nodes, from light that goes straight on to light that comes back.
layout(scalar, set = 0) readonly buffer MieValues { vec4 mie_values[]; };  // S11; b, c, d of a Mueller times S11. 1/sr
layout(scalar, set = 0) readonly buffer MieSums { float mie_sums[]; };     // integral of S11 up to the node, 0 to 1

const float MIE_FIRST = 360.0, MIE_STEP = 10.0;  // nm
const uint MIE_WAVELENGTHS = 48u;

// x: the wavelength of the table before nm, y: as far it is to the next.
vec2 mie_wavelength(float nm) {
    float place = clamp((nm - MIE_FIRST) / MIE_STEP, 0.0, float(MIE_WAVELENGTHS - 1u));
    float before = min(floor(place), float(MIE_WAVELENGTHS - 2u));
    return vec2(before, place - before);
}
uint mie_first(Mie r, float wavelength) { return r.table.first + uint(wavelength) * (2u * r.table.cells + 1u); }

// 1 - |cosine| at the `k`th node from the nearer end.
float mie_turn(Mie r, uint k) {
    float v = float(k) / float(r.table.cells);
    return v * v * v;
}

// The matrix: S11, and b, c, d times it.
Stokes mie_elements(Mie r, float cosine) {
    float turn = clamp(1.0 - abs(cosine), 0.0, 1.0);
    uint k = min(uint(pow(turn, 1.0 / 3.0) * float(r.table.cells)), r.table.cells - 1u);
    float from = mie_turn(r, k), f = clamp((turn - from) / (mie_turn(r, k + 1u) - from), 0.0, 1.0);
    bool back = cosine < 0.0;
    uint node = back ? 2u * r.table.cells - k : k, next = back ? node - 1u : node + 1u;
    Stokes elements = Stokes(0);
    [[dont_unroll]] for (uint lane = 0u; lane < LANES; ++lane) {
        vec2 w = mie_wavelength(lane_wavelengths()[lane]);
        uint a = mie_first(r, w.x), b = mie_first(r, w.x + 1.0);
        vec4 e = mix(mix(mie_values[a + node], mie_values[a + next], f), mix(mie_values[b + node], mie_values[b + next], f), w.y);
        elements[0][lane] = e.x, elements[1][lane] = e.y, elements[2][lane] = e.z, elements[3][lane] = e.w;
    }
    return elements;
}

Spectrum mie_value(Mie r, float cosine) { return mie_elements(r, cosine)[0]; }

// Of a lane and then one of the wavelengths beside it, chosen by u, whose rest goes on to the cell between two nodes, and to the
// inverse of the parabola that the integral is there.
float mie_sample(Mie r, float u) {
    u *= float(LANES);
    uint lane = min(uint(u), LANES - 1u);
    vec2 w = mie_wavelength(lane_wavelengths()[lane]);
    u -= float(lane);
    bool is_next = u >= 1.0 - w.y;
    u = is_next ? (u - (1.0 - w.y)) / w.y : u / (1.0 - w.y);
    uint first = mie_first(r, w.x + (is_next ? 1.0 : 0.0)), count = 2u * r.table.cells, node = 0u;
    [[dont_unroll]] for (uint step = 2048u; step > 0u; step >>= 1)
        if (node + step < count && mie_sums[first + node + step] <= u) node += step;
    bool back = node >= r.table.cells;
    float from = mie_turn(r, back ? count - node : node), to = mie_turn(r, back ? count - node - 1u : node + 1u);
    float a = mie_values[first + node].x, b = mie_values[first + node + 1u].x;
    float rest = (u - mie_sums[first + node]) / (2.0 * PI * abs(to - from));
    float f = clamp(2.0 * rest / (a + sqrt(max(a * a + 2.0 * (b - a) * rest, 0.0))), 0.0, 1.0);
    float turn = mix(from, to, f);
    return back ? turn - 1.0 : 1.0 - turn;
}

Mueller mie_mueller(Mie r, float cosine) {
    Stokes e = mie_elements(r, cosine);
    Spectrum inverse = 1.0 / max(e[0], Spectrum(1e-30));
    return phase_plate(vec3(1, 0, 0), e[1] * inverse, e[2] * inverse, e[3] * inverse);
}
