// Surfaces whose Mueller matrices were measured over directions and wavelengths (Baek et al. 2020, "Image-based acquisition and
// modeling of polarimetric reflectance"); made from files by host/measured/mueller_table. Isotropic; the upper side reflects.
//
// Where a matrix stands follows from the half vector h of the directions i, where light comes from, and o, where it goes to
// (Rusinkiewicz 1998, "A New Change of Variables for Efficient BRDF Representation"): from the angles theta_h of h to the normal n,
// theta_d of i to h, and phi_d of i about h, from (n x h) x h towards n x h. Between nodes, of wavelengths too, matrices are linear;
// beyond the ends the last holds. x of the frames of both directions is that of i x o, across the plane of incidence.
#include "lib/accurate_math.glsl"
#include "lib/records.glsl"
#include "lib/stokes.glsl"
#include "lib/warps.glsl"

// Twin in host/measured/mueller_table.h, where the lists are described.
struct MuellerTable {
    uvec3 axes, nodes;  // of phi_d, theta_d, theta_h: first of their numbers, and how many there are
    uint matrices, wavelengths;
    uint lobe, lobe_nodes;
    float cosine_part;
    SpectrumRef place;  // of each wavelength among those of the table
};
layout(scalar, set = 0) readonly buffer MuellerTables { MuellerTable mueller_tables[]; };
layout(scalar, set = 0) readonly buffer MuellerNumbers { float mueller_numbers[]; };
layout(scalar, set = 0) readonly buffer MuellerIntensities { float mueller_intensities[]; };
layout(scalar, set = 0) readonly buffer MuellerRatios { uvec4 mueller_ratios[]; };

// The node before x among `count` numbers that rise, and as far as x is on the way to the next; beyond the ends, at them.
uint number_before(uint first, uint count, float x, out float part) {
    uint below = 0u;
    [[dont_unroll]] for (uint step = 512u; step > 0u; step >>= 1)
        if (below + step + 1u < count && mueller_numbers[first + below + step] <= x) below += step;
    float a = mueller_numbers[first + below], b = mueller_numbers[first + below + 1u];
    part = b > a ? clamp((x - a) / (b - a), 0.0, 1.0) : 0.5;
    return below;
}

struct MuellerCell {
    uvec3 node;  // of phi_d, theta_d, theta_h
    vec3 part;   // of the way to the next
};

// Angles by atan2 of lengths keep the digits of small ones.
MuellerCell mueller_cell(MuellerTable t, vec3 from, vec3 to) {
    vec3 sum = from + to;
    float along = length(sum);
    vec3 angles = vec3(accurate_atan2(2.0 * (to.x * from.y - to.y * from.x), along * (to.z - from.z)),
                       accurate_atan2(length(from - to), along), accurate_atan2(length(sum.xy), sum.z));
    float first_phi = mueller_numbers[t.axes.x], turn = (angles.x - first_phi) * (0.5 * INV_PI);
    angles.x = first_phi + 2.0 * PI * (turn - floor(turn));
    MuellerCell cell = MuellerCell(uvec3(0), vec3(0));
    [[dont_unroll]] for (uint axis = 0u; axis < 3u; ++axis) {
        float part;
        cell.node[axis] = number_before(t.axes[axis], t.nodes[axis], angles[axis], part);
        cell.part[axis] = part;
    }
    return cell;
}

// The first matrix at one of the eight corners of a cell, and the corner's weight.
uint corner_matrix(MuellerTable t, MuellerCell cell, uint corner, out float weight) {
    uvec3 next = uvec3(corner & 1u, (corner >> 1) & 1u, corner >> 2), node = cell.node + next;
    vec3 parts = mix(1.0 - cell.part, cell.part, vec3(next));
    weight = parts.x * parts.y * parts.z;
    return t.matrices + ((node.x * t.nodes.y + node.y) * t.nodes.z + node.z) * t.wavelengths;
}

// The share of the table's wavelength `k` in each lane.
Spectrum share_of_wavelength(MuellerTable t, uint k) { return max(1.0 - abs(untinted_value(t.place) - float(k)), Spectrum(0)); }

// f of unpolarized light, 1/sr.
Spectrum mueller_table_value(MuellerTable t, vec3 from, vec3 to) {
    MuellerCell cell = mueller_cell(t, from, to);
    Spectrum value = Spectrum(0);
    [[dont_unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
        float weight;
        uint first = corner_matrix(t, cell, corner, weight);
        [[dont_unroll]] for (uint k = 0u; k < t.wavelengths; ++k)
            value += share_of_wavelength(t, k) * (weight * mueller_intensities[first + k]);
    }
    return value;
}

Mueller mueller_table_matrix(MuellerTable t, vec3 from, vec3 to) {
    Mueller m = depolarizing();
    m.from = m.to = facet_axis(to, normalize(from + to));
    for (int i = 0; i < 16; ++i) m.m[i] = Spectrum(0);
    MuellerCell cell = mueller_cell(t, from, to);
    [[dont_unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
        float weight;
        uint first = corner_matrix(t, cell, corner, weight);
        [[dont_unroll]] for (uint k = 0u; k < t.wavelengths; ++k) {
            Spectrum share = share_of_wavelength(t, k);
            if (is_black(share)) continue;
            share *= weight * mueller_intensities[first + k];
            uvec4 a = mueller_ratios[2u * (first + k)], b = mueller_ratios[2u * (first + k) + 1u];
            for (int i = 0; i < 8; ++i) {
                vec2 two = unpackSnorm2x16(i < 4 ? a[i] : b[i - 4]);
                m.m[2 * i] += share * two.x, m.m[2 * i + 1] += share * two.y;
            }
        }
    }
    m.m[0] = mix(m.m[0], Spectrum(1), lessThanEqual(m.m[0], Spectrum(0)));  // where nothing is reflected
    return m;
}

// Density over solid angle with which samples for half vectors go along h, 1/sr: sin² theta_h has a piecewise linear one.
float half_vector_pdf(MuellerTable t, vec3 h) {
    float part;
    uint density = t.lobe + t.lobe_nodes + number_before(t.lobe, t.lobe_nodes, dot(h.xy, h.xy), part);
    return mix(mueller_numbers[density], mueller_numbers[density + 1u], part) * h.z * INV_PI;
}

vec3 sample_half_vector(MuellerTable t, vec2 u) {
    float part;
    uint before = number_before(t.lobe + 2u * t.lobe_nodes, t.lobe_nodes, u.x, part);
    uint x = t.lobe + before, density = x + t.lobe_nodes;
    part = sample_linear(mueller_numbers[density], mueller_numbers[density + 1u], part);
    float sine_square = mix(mueller_numbers[x], mueller_numbers[x + 1u], part);
    return vec3(cos_sin_turns(u.y) * sqrt(sine_square), sqrt(max(1.0 - sine_square, 0.0)));
}

SurfacePair mueller_table_pair(MuellerTable t, bool importance, vec3 wo, vec3 wi) {
    vec3 sum = wo + wi;
    if (wo.z <= 0.0 || wi.z <= 0.0 || !(dot(sum, sum) > 1e-12)) return no_surface_pair();  // opposite ones at the horizon have no h
    vec3 h = normalize(sum);
    float halfway = (1.0 - t.cosine_part) * half_vector_pdf(t, h) / (4.0 * dot(wo, h));
    vec2 even = t.cosine_part * INV_PI * vec2(wi.z, wo.z);
    return SurfacePair(mueller_table_value(t, importance ? wo : wi, importance ? wi : wo) * wi.z, halfway + even.x, halfway + even.y);
}

BsdfSample mueller_table_sample(MuellerTable t, vec3 wo, vec3 u) {
    vec3 wi = warp_cosine_hemisphere(u.xy);
    if (u.z >= t.cosine_part) {
        vec3 h = sample_half_vector(t, u.xy);
        wi = 2.0 * dot(wo, h) * h - wo;
    }
    if (wi.z <= 0.0) return no_bsdf_sample();
    return scattered(wi, EVENT_REFLECT);
}
