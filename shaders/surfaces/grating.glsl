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
// Wavelengths part in every order but 0. Without wavelengths (--color rgb) all light is diffracted as that of 587.6 nm. What an order
// does to polarization nothing is said of: light is depolarized unless it passes straight on.
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

struct Grating {
    float period;          //: required in (0, inf) m. From groove to groove.
    float axis;            //: 0 in (-inf, inf) rad. Of the grooves.
    GratingOrders orders;  //: required. [{"order": m, "reflected": part, "reflected_below": part, "transmitted": part}, …]
    uint evanescent;       //: "zero_order" of zero_order|absorbed. What takes the parts of orders that do not propagate.
};

Grating grating_resolve(Grating r, SurfaceContext c) { return r; }

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

// 1 where a wave with this vector along the surface is evanescent in a medium.
Spectrum grating_evanescent(Spectrum across, float along, float index) {
    return Spectrum(greaterThan(across * across, Spectrum(index * index - along * along)));
}

struct GratingParts {
    Spectrum reflected, transmitted;
};

// Of order 0, with what it takes of evanescent orders.
GratingParts grating_zero_order(Grating r, GratingView v) {
    GratingParts zero = GratingParts(Spectrum(0), Spectrum(0));
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
    bool passes = dot(v.wave, v.wave) <= v.far * v.far;
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
    GratingParts zero = grating_zero_order(r, v);
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
            Spectrum carried = back ? grating_reflected(v, o) : untinted_value(o.transmitted);
            if (is_zero) carried = back ? zero.reflected : zero.transmitted;
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
    return grating_zero_order(r, grating_view(r, c, wo)).transmitted;
}

bool grating_is_delta(Grating r, SurfaceContext c) { return true; }

bool grating_is_opaque(Grating r, SurfaceContext c) {
    Spectrum transmitted = Spectrum(0);
    for (uint i = 0u; i < r.orders.count; ++i) transmitted += untinted_value(grating_orders[r.orders.first + i].transmitted);
    return c.ior_above != c.ior_below || is_black(transmitted);
}
