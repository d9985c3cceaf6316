// Shading normals that are not those of the surface. About them light may be scattered to the other side of the surface: it is
// mirrored there, back to its own side, so that none is lost and none gained. Backward rays scatter into a direction and what is
// mirrored to it; forward rays come from a direction or from what it mirrors, so both carry light the same ways. (Others bend the
// normal until the reflection lies at the horizon, which forward rays cannot undo, or add facets: Schüssler et al. 2017,
// "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing".)
//
// Included by interfaces/surface_optics.glsl. Directions are local; the surface's normal is c.level.

#if HAS_SHADING_NORMALS
#define keep_level(context, normal) context.level = normal
bool is_beyond_surface(SurfaceContext c, vec3 w) { return w.z * dot(w, c.level) < 0.0; }
vec3 mirrored_at_surface(SurfaceContext c, vec3 w) { return w - 2.0 * dot(w, c.level) * c.level; }

// Whether something is mirrored to w, a direction where both normals agree.
bool receives_mirrored(SurfaceContext c, vec3 w) {
    vec3 m = mirrored_at_surface(c, w);
    return !is_beyond_surface(c, w) && is_beyond_surface(c, m) && m.z * w.z > 0.0;
}

// The directions of one evaluation of `evaluate`, of two at most.
struct Way {
    vec3 wo, wi;
};
uint count_ways(SurfaceContext c, vec3 wo, vec3 wi) { return receives_mirrored(c, c.importance ? wo : wi) ? 2u : 1u; }
Way nth_way(SurfaceContext c, vec3 wo, vec3 wi, uint n) {
    if (n == 1u) {
        if (c.importance) wo = mirrored_at_surface(c, wo);
        else wi = mirrored_at_surface(c, wi);
    }
    return Way(wo, wi);
}

// Forward rays take each of two ways with probability 1/2. What they carry is per cosine of the light, which depends on the way:
// adjoint_correction() leaves it out.
void add_way(inout SurfacePair sum, SurfaceContext c, SurfacePair pair, Way way, uint ways) {
    float half_of_two = ways == 2u ? 0.5 : 1.0;
    sum.value += c.importance ? pair.value * abs(way.wo.z) : pair.value;
    sum.pdf += pair.pdf * (c.importance ? half_of_two : 1.0);
    sum.pdf_reverse += pair.pdf_reverse * (c.importance ? 1.0 : half_of_two);
}

#define EVALUATE(name, r, c, from, to, pair)                                \
    SurfacePair pair = no_surface_pair();                                   \
    uint ways = count_ways(c, from, to);                                    \
    for (uint n = 0u; n < ways; ++n) {                                      \
        Way way = nth_way(c, from, to, n);                                  \
        add_way(pair, c, name##_evaluate(r, c, way.wo, way.wi), way, ways); \
    }

// For the class to be sampled with: where the light comes from, as far as it matters; u.z is stretched anew.
vec3 choose_way(SurfaceContext c, vec3 wo, inout vec3 u, out float scale) {
    scale = 1.0;
    if (!c.importance) return wo;
    vec3 chosen = wo;
    if (receives_mirrored(c, wo)) {
        scale = 2.0;
        bool second = u.z >= 0.5;
        u.z = second ? 2.0 * u.z - 1.0 : 2.0 * u.z;
        if (second) chosen = mirrored_at_surface(c, wo);
    }
    scale *= abs(chosen.z);
    return chosen;
}

// What becomes of it. Delta events have their weight already; what passes straight on is not mirrored.
void end_way(inout BsdfSample b, SurfaceContext c, vec3 wo, vec3 way_wo, float scale) {
    if ((b.event & EVENT_STRAIGHT) != 0u && any(notEqual(way_wo, wo))) b = no_bsdf_sample();
    if (c.importance) b.weight *= scale;
    else if (is_beyond_surface(c, b.wi)) b.wi = mirrored_at_surface(c, b.wi);
}

#define SAMPLE(name, r, c, wo, u, result)                       \
    float way_scale;                                            \
    vec3 way_u = u, way_wo = choose_way(c, wo, way_u, way_scale); \
    result = name##_sample(r, c, way_wo, way_u);                \
    end_way(result, c, wo, way_wo, way_scale)
#else
#define keep_level(context, normal)
#define EVALUATE(name, r, c, from, to, pair) SurfacePair pair = name##_evaluate(r, c, from, to)
#define SAMPLE(name, r, c, wo, u, result) result = name##_sample(r, c, wo, u)
#endif
