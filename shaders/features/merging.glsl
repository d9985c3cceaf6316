// Where vertices of backward and forward paths merge, and with what density (stages/merge_vertices.glsl).
#include "interfaces/receiver.glsl"
#include "lib/forward_pass.glsl"
#include "lib/materials.glsl"

// Of the receiver's image.
float film_aspect() { return float(forward_pass.width) / float(forward_pass.height); }
float pixel_count() { return float(forward_pass.width) * float(forward_pass.height); }
uint pixel_of(vec2 film) {
    uvec2 size = uvec2(forward_pass.width, forward_pass.height);
    uvec2 pixel = min(uvec2(film * vec2(size)), size - 1u);
    return pixel.y * size.x + pixel.x;
}

bool is_narrow(uint material) {
    bool is_medium = HAS_SCATTERING == 1 && material == NO_RECORD;
    return !is_medium && (materials[material].flags & MATERIAL_NARROW) != 0u;
}

#if MERGE_VERTICES
// Radii in footprints of the receiver. Images of few pixels and wide angles get less than they ask for: lib/vertex_grid.glsl wants
// radii that change slowly.
float merge_scale(float slope) { return min(forward_pass.merge_scale, 0.05 / max(slope, 1e-6)); }
float merge_radius(vec3 position, out float slope) {
    float footprint = receiver_footprint(forward_pass.receiver, position, film_aspect(), slope);
    float scale = merge_scale(slope);
    slope *= scale;
    return scale * footprint;
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
    float slope;
    return distance(merging, next) < forward_pass.short_scale * receiver_footprint(forward_pass.receiver, merging, film_aspect(), slope);
}
#else
#define merge_radius(position) 0.0
#define merge_density(in_volume, position) 0.0
#define is_short_edge(merging, next) false
#endif
