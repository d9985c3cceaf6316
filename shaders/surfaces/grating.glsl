// A diffraction grating: straight grooves at even distances, on the border of two media or with the same on both sides. Light leaves it
// in orders m, reflected and transmitted: along the surface the wave vector of each is that of the light plus m times 2 pi / period,
// at right angles to the grooves, at any incidence (R. Petit, ed., 1980, "Electromagnetic Theory of Gratings", Springer). The media say
// the refractive indices. Order m > 0 turns light, from either side, towards the direction a quarter turn counter-clockwise from the
// grooves' axis, seen from the side of the normal.
//
// With wo and wi away from the surface n wo + n' wi = m wavelength / period along it. That stays if both are exchanged: the way back is
// of the same order m, and has the same efficiency (reciprocity theorem, there). An efficiency is the part of the power that an order
// carries; what all of them lack to 1 is absorbed. An order beyond 90 degrees is evanescent and carries nothing. By "zero_order" its
// part goes to order 0, transmitted if it was to be, else reflected, but no more than goes there of light that comes back along it, and
// what the transmitted one leaves of its own to the reflected one: scaling all orders up instead would let more through one way than
// the other. So all light is kept where orders m and -m carry the same; what is left otherwise is absorbed, by "absorbed" all of it.
//
// Wavelengths part in every order but 0. Without wavelengths (--color rgb) all light is diffracted as that of 587.6 nm.
//
// Efficiencies may be a table over wavelength and incidence instead, for light polarized across the plane of incidence (s) and in it (p).
// They are those of the light, whichever way a path goes: its own incidence counts, so that algorithms agree on any table. The table
// says all orders; what it gives evanescent ones is absorbed. Nothing is known of the phase between s and p, which keep in step, as at
// a perfect mirror and in clear glass. Without a table, or without s and p in it, light is depolarized unless it passes straight on.
//
// Example:
//     {"materials": [{"name": "grating of 600 lines a millimetre", "extensions": {"ETD_optics": {
//         "surface": {"class": "grating", "period": 1.6667e-6, "orders": [
//             {"order": 0, "reflected": 0.3}, {"order": 1, "reflected": 0.4}, {"order": -1, "reflected": 0.2}]}}}}]}
#include "lib/sheets.glsl"
#define GRATING_DISPERSES

// Rows of grating_orders. Twin in host/scene/records.h.
struct GratingOrders {
    uint first, count;
};

// Twin in host/scene/grating_orders.h.
struct GratingOrder {
    float order;
    SpectrumRef reflected, reflected_below, transmitted;  // of the power that comes
};
layout(scalar, set = 0) readonly buffer GratingOrderRows { GratingOrder grating_orders[]; };

// Twin in host/scene/grating_table.h, which has the layout of the numbers.
struct GratingTable {
    uint first;  // number; NO_RECORD = none
    uint wavelengths, sines;
    uint polarizes, transmits;
    GratingOrders orders;  // rows that say which they are, no more
};
layout(scalar, set = 0) readonly buffer GratingNumbers { float grating_numbers[]; };

struct Grating {
    float period;               //: required in (0, inf) m. From groove to groove.
    float axis;                 //: 0 in (-inf, inf) rad. Of the grooves.
    GratingOrders orders;       //: none. [{"order": m, "reflected": part, "reflected_below": part, "transmitted": part}, …]
    GratingTable efficiencies;  //: none. In place of orders: [{"order": m, "side", "wavelength", "angle", "polarization", "reflected", "transmitted"}, …] or {"file": CSV}
    uint evanescent;            //: "zero_order" of zero_order|absorbed. What takes the parts of orders that do not propagate.
};

bool grating_has_table(Grating r) { return r.efficiencies.first != NO_RECORD; }

Grating grating_resolve(Grating r, SurfaceContext c) {
    if (grating_has_table(r)) r.orders = r.efficiencies.orders;
    return r;
}

// The grating as a ray along wo sees it. Tangential vectors are in units of the wave number in vacuum, and x is across the grooves.
struct GratingView {
    vec2 across;     // the grooves, unit, in the surface's frame
    vec2 wave;       // index times wo along the surface
    float near, far; // indices on the side of wo and beyond
    Spectrum pitch;  // wavelength / period
    bool below;      // wo is
};

GratingView grating_view(Grating r, SurfaceContext c, vec3 wo) {
    GratingView v;
    vec2 axis = sheet_axis(r.axis).xy;
    v.across = vec2(-axis.y, axis.x);
    v.below = wo.z < 0.0;
    v.near = v.below ? c.ior_below : c.ior_above;
    v.far = v.below ? c.ior_above : c.ior_below;
    v.wave = v.near * vec2(dot(wo.xy, v.across), dot(wo.xy, axis));
    v.pitch = parting_wavelengths() * (1e-9 / r.period);
    return v;
}

Spectrum grating_reflected(GratingView v, GratingOrder o) {
    SpectrumRef part = o.reflected;
    if (v.below) part = o.reflected_below;
    return untinted_value(part);
}

// Where x lies among rising numbers: the one below it and the part of the way to the next. Beyond the ends the last holds.
uint grating_interval(uint first, uint count, float x, out float part) {
    uint lo = 0u, hi = count - 1u;
    part = 0.0;
    if (hi == 0u) return 0u;
    while (hi - lo > 1u) {
        uint middle = (lo + hi) / 2u;
        if (x < grating_numbers[first + middle]) hi = middle;
        else lo = middle;
    }
    float a = grating_numbers[first + lo], b = grating_numbers[first + hi];
    part = clamp((x - a) / (b - a), 0.0, 1.0);
    return lo;
}

// Of the table: efficiencies of order `row` for light from a side; `sine` is that of incidence, of each lane. s, then p.
void grating_efficiencies(GratingTable t, uint row, bool below, bool reflects, Spectrum sine, out Spectrum s, out Spectrum p) {
    uint values = t.first + t.wavelengths + t.sines;
    uint block = ((row * 2u + uint(below)) * 2u + uint(!reflects)) * t.sines;
    Spectrum nm = lane_wavelengths();
    s = p = Spectrum(0);
    for (uint lane = 0u; lane < LANES; ++lane) {
        vec2 part;
        uint j = grating_interval(t.first, t.wavelengths, nm[lane], part.x);
        uint i = grating_interval(t.first + t.wavelengths, t.sines, sine[lane], part.y);
        for (uint k = 0u; k < 4u; ++k) {
            uint at_i = min(i + (k >> 1), t.sines - 1u), at_j = min(j + (k & 1u), t.wavelengths - 1u);
            uint at = values + 2u * ((block + at_i) * t.wavelengths + at_j);
            vec2 weight = mix(1.0 - part, part, vec2(k & 1u, k >> 1));
            s[lane] += weight.x * weight.y * grating_numbers[at];
            p[lane] += weight.x * weight.y * grating_numbers[at + 1u];
        }
    }
}

// What an order carries, reflected or not, of light that goes against the path or along it.
Spectrum grating_carried(Grating r, GratingView v, SurfaceContext c, uint row, bool reflects) {
    GratingOrder o = grating_orders[r.orders.first + row];
    if (grating_has_table(r)) {
        Spectrum s, p, sine = Spectrum(-v.wave.x / v.near);
        if (!c.importance) sine = (v.wave.x - o.order * v.pitch) / (reflects ? v.near : v.far);
        bool below = c.importance || reflects ? v.below : !v.below;
        grating_efficiencies(r.efficiencies, row, below, reflects, sine, s, p);
        return 0.5 * (s + p);
    }
    return reflects ? grating_reflected(v, o) : untinted_value(o.transmitted);
}

// 1 where a wave with this vector along the surface is evanescent in a medium.
Spectrum grating_evanescent(Spectrum across, float along, float index) {
    return Spectrum(greaterThan(across * across, Spectrum(index * index - along * along)));
}

struct GratingParts {
    Spectrum reflected, transmitted;
};

// Of order 0, with what it takes of evanescent orders.
GratingParts grating_zero_order(Grating r, GratingView v, SurfaceContext c) {
    GratingParts zero = GratingParts(Spectrum(0), Spectrum(0));
    bool passes = dot(v.wave, v.wave) <= v.far * v.far;
    if (grating_has_table(r)) {
        for (uint i = 0u; i < 2u * r.orders.count; ++i) {
            if (grating_orders[r.orders.first + i / 2u].order != 0.0) continue;
            Spectrum carried = grating_carried(r, v, c, i / 2u, (i & 1u) == 0u);
            if ((i & 1u) == 0u) zero.reflected = carried;
            else if (passes) zero.transmitted = carried;
        }
        return zero;
    }
    // Evanescent, of light from wo and from where order 0 goes: mirrored, or beyond the surface.
    GratingParts here = zero, mirrored = zero;
    Spectrum beyond = Spectrum(0), beyond_mirrored = Spectrum(0);  // transmitted
    for (uint i = 0u; i < r.orders.count; ++i) {
        GratingOrder o = grating_orders[r.orders.first + i];
        Spectrum reflected = grating_reflected(v, o), transmitted = untinted_value(o.transmitted);
        if (o.order == 0.0) zero = GratingParts(reflected, transmitted);
        Spectrum onward = o.order * v.pitch - v.wave.x, backward = o.order * v.pitch + v.wave.x;
        here.reflected += reflected * grating_evanescent(onward, v.wave.y, v.near);
        here.transmitted += transmitted * grating_evanescent(onward, v.wave.y, v.far);
        mirrored.reflected += reflected * grating_evanescent(backward, v.wave.y, v.near);
        mirrored.transmitted += transmitted * grating_evanescent(backward, v.wave.y, v.far);
        beyond += transmitted * grating_evanescent(backward, v.wave.y, v.near);
        beyond_mirrored += transmitted * grating_evanescent(onward, v.wave.y, v.near);
    }
    if (!passes) zero.transmitted = beyond = beyond_mirrored = Spectrum(0);
    if (r.evanescent == 0u) {
        Spectrum through = min(here.transmitted, beyond);
        Spectrum through_mirrored = min(mirrored.transmitted, beyond_mirrored);
        zero.transmitted += through;
        zero.reflected += min(here.reflected + here.transmitted - through,
                              mirrored.reflected + mirrored.transmitted - through_mirrored);
    }
    return zero;
}

SurfacePair grating_evaluate(Grating r, SurfaceContext c, vec3 wo, vec3 wi) { return no_surface_pair(); }

// An order is drawn by what it carries, of the hero where it parts wavelengths.
BsdfSample grating_sample(Grating r, SurfaceContext c, vec3 wo, vec3 u) {
    GratingView v = grating_view(r, c, wo);
    GratingParts zero = grating_zero_order(r, v, c);
    float pitch = of_parting(v.pitch), target = INFINITY, sum = 0.0;
    float weight = 0.0, order = 0.0;  // of the order that is drawn
    Spectrum part = Spectrum(0);
    vec2 wave = vec2(0);
    bool reflects = true;
    for (uint turn = 0u; turn < 2u; ++turn) {  // adds up, draws
        if (turn == 1u) target = u.z * sum;
        sum = 0.0;
        for (uint i = 0u; i < 2u * r.orders.count; ++i) {
            GratingOrder o = grating_orders[r.orders.first + i / 2u];
            bool back = (i & 1u) == 0u, is_zero = o.order == 0.0;
            Spectrum carried = Spectrum(0);
            if (!is_zero) carried = grating_carried(r, v, c, i / 2u, back);
            else carried = back ? zero.reflected : zero.transmitted;
            vec2 towards = vec2(o.order * pitch, 0.0) - v.wave;
            float index = back ? v.near : v.far;
            float w = is_zero ? brightness(carried) : of_parting(carried);
            if (!(w > 0.0) || dot(towards, towards) >= index * index) continue;
            if (sum <= target) weight = w, order = o.order, part = carried, wave = towards, reflects = back;
            sum += w;
        }
    }
    if (!(weight > 0.0)) return no_bsdf_sample();
    float pdf = weight / sum, index = reflects ? v.near : v.far;
    uint event = EVENT_DELTA | (reflects ? EVENT_REFLECT : EVENT_TRANSMIT);
    // Vectors along the surface are kept but for the shift, so that radiance over squared index is, as where light is refracted.
    if (!reflects && !c.importance) part *= v.near * v.near / (v.far * v.far);
    vec2 along = wave / index;
    along = along.x * v.across + along.y * vec2(v.across.y, -v.across.x);
    vec3 wi = vec3(along, sqrt(max(1.0 - dot(along, along), 0.0)));
    if (reflects == v.below) wi.z = -wi.z;
    if (order != 0.0) event |= EVENT_PARTS;
    else if (reflects) wi = vec3(-wo.xy, wo.z);
    else if (v.near == v.far) wi = -wo, event |= EVENT_STRAIGHT;
    return BsdfSample(wi, part / pdf, pdf, event);
}

Spectrum grating_transparency(Grating r, SurfaceContext c, vec3 wo) {
    if (c.ior_above != c.ior_below) return Spectrum(0);
    return grating_zero_order(r, grating_view(r, c, wo), c).transmitted;
}

// Across the plane of a direction and the normal; along the grooves where that is the normal.
vec3 grating_s_axis(Grating r, vec3 w) { return dot(w.xy, w.xy) > 1e-12 ? normalize(vec3(-w.y, w.x, 0.0)) : sheet_axis(r.axis); }

// The order is that which leads from the one direction to the other.
Mueller grating_mueller(Grating r, SurfaceContext c, vec3 from, vec3 to, uint event) {
    if (!grating_has_table(r) || r.efficiencies.polarizes == 0u) return unsaid_mueller(to, event);
    GratingView v = grating_view(r, c, from);
    bool reflects = (event & EVENT_REFLECT) != 0u;
    float shift = v.wave.x + (reflects ? v.near : v.far) * dot(to.xy, v.across);
    float order = (event & EVENT_PARTS) != 0u ? round(shift / of_parting(v.pitch)) : 0.0;
    uint row = 0u;
    for (uint i = 0u; i < r.orders.count; ++i)
        if (grating_orders[r.orders.first + i].order == order) row = i;
    Spectrum s, p;
    grating_efficiencies(r.efficiencies, row, v.below, reflects, Spectrum(-v.wave.x / v.near), s, p);
    Spectrum inverse = 1.0 / max(s + p, Spectrum(1e-30));
    Spectrum kept = 2.0 * sqrt(s * p) * inverse;
    return blocks(grating_s_axis(r, from), grating_s_axis(r, to), (s - p) * inverse, Spectrum(1),
                  reflects ? -kept : kept, Spectrum(0));
}

bool grating_is_delta(Grating r, SurfaceContext c) { return true; }

bool grating_is_opaque(Grating r, SurfaceContext c) {
    if (grating_has_table(r)) return c.ior_above != c.ior_below || r.efficiencies.transmits == 0u;
    Spectrum transmitted = Spectrum(0);
    for (uint i = 0u; i < r.orders.count; ++i) transmitted += untinted_value(grating_orders[r.orders.first + i].transmitted);
    return c.ior_above != c.ior_below || is_black(transmitted);
}
