// The order of a ray's hits, for bodies whose faces coincide (features/faces.glsl): by distance, and by what is hit where distances
// are the same to the last bit.
#if HAS_PRIORITIES
bool comes_after(Hit a, Hit b) {
    if (a.t != b.t) return a.t > b.t;
    return a.instance > b.instance || (a.instance == b.instance && a.primitive > b.primitive);
}
// The end of a ray that has met `hit`: hits of the same distance are still of interest.
float hit_limit(Hit hit) {
    return hit.primitive == NO_RECORD ? hit.t : uintBitsToFloat(floatBitsToUint(hit.t) + 1u);
}
// Whether a hit comes after one and before another.
bool lies_between(Hit hit, Hit after, Hit before) { return comes_after(hit, after) && comes_after(before, hit); }
#else
#define hit_limit(hit) hit.t
#define lies_between(hit, after, before) true
#endif
