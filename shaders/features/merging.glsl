// Where vertices of backward and forward paths merge, and with what density (stages/merge_vertices.glsl).
#include "features/views.glsl"
#include "lib/forward_pass.glsl"
#include "lib/materials.glsl"

bool is_narrow(uint material) {
    bool is_medium = HAS_SCATTERING == 1 && material == NO_RECORD;
    return !is_medium && (materials[material].flags & MATERIAL_NARROW) != 0u;
}

#if MERGE_VERTICES
// Square root of the area that a pixel covers there, m, and by how much it changes over a metre.
float pixel_footprint(View v, vec3 position, out float slope) {
    float width = inversesqrt(pixel_count(v));
    float footprint = receiver_footprint(v.receiver, position, film_aspect(v), slope);
    slope *= width;
    return footprint * width;
}
// Radii in footprints of pixels, of the view that has the finest. Images of few pixels and wide angles get less than they ask
// for: lib/vertex_grid.glsl wants radii that change slowly.
float merge_radius(vec3 position, out float slope) {
    float radius = INFINITY;
    slope = 0.0;
    for (uint v = 0u; v < VIEW_COUNT; ++v) {
        float slope_here;
        float footprint = pixel_footprint(views[v], position, slope_here);
        float scale = min(forward_pass.merge_scale, 0.05 / max(slope_here, 1e-6));
        if (scale * footprint >= radius) continue;
        radius = scale * footprint;
        slope = scale * slope_here;
    }
    return radius;
}
float merge_radius(vec3 position) {
    float slope;
    return merge_radius(position, slope);
}
// Within it vertices merge: a disk of a surface, m², or a ball of a medium, m³.
float merge_size(bool in_volume, float radius) { return PI * square(radius) * (in_volume ? 4.0 / 3.0 * radius : 1.0); }
float merge_density(bool in_volume, vec3 position) {
    return merge_size(in_volume, merge_radius(position)) * float(forward_pass.count);
}

// Whether the edge between a vertex that merges and the next one towards the receiver is short enough to ask for merging.
bool is_short_edge(vec3 merging, vec3 next) {
    float slope, footprint = INFINITY;
    for (uint v = 0u; v < VIEW_COUNT; ++v) footprint = min(footprint, pixel_footprint(views[v], merging, slope));
    return distance(merging, next) < forward_pass.short_scale * footprint;
}
#else
#define merge_radius(position) 0.0
#define merge_density(in_volume, position) 0.0
#define is_short_edge(merging, next) false
#endif
