// Which hits of elements' boundaries count (features/elements.glsl).
#if HAS_ELEMENTS
// What lies on a boundary comes before it: a hit of it counts as a little further, by what rounding may make of two that coincide.
void judge_boundary(Traversal w, Triangle primitive, inout bool met, inout GeometryHit found) {
    if (!met || !is_boundary(primitive.attributes)) return;
    vec3 n = cross(primitive.v1 - primitive.v0, primitive.v2 - primitive.v0), a = abs(w.origin);
    float cosine = dot(normalize(n), w.direction);
    uint leads_to = attributes_index(primitive.attributes);
    bool has_left = (ray_location & JUST_LEFT) != 0u && (ray_location & LEFT_INDEX) == leads_to;
    if (leads_to == OWN_BOUNDARY) met = cosine > 0.0;
    else if (has_left) met = cosine < 0.0 && (ray_location & LEFT_BY_CHANCE) == 0u;
    found.t += 16.0 * EPSILON * (max(a.x, max(a.y, a.z)) + found.t) / max(abs(cosine), 1e-3);
    met = met && found.t < hit_limit(w.hit);
}
#else
#define judge_boundary(w, primitive, met, found)
#endif
