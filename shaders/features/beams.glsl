// Media where whole rays merge with the vertices of forward paths, not only the points where they scatter (stages/merge_along.glsl).
#include "features/merging.glsl"
#include "interfaces/medium_optics.glsl"
#include "lib/path.glsl"

#if BEAMS
// From the scene's centre, m: a medium without end is left alone beyond it.
const float BEAM_REACH = 2.0 * SCENE_RADIUS;

// In media so dense that light scatters many times before it leaves there are many points, too, and rays cost more than they bring.
// Optical depth across the scene's radius. For glass_in_fog behind a pane rays were 1.4 times as efficient at 1.1, points at 4.4.
const float DENSEST_FOR_BEAMS = 3.5;
bool merges_along(uint medium) {
    return medium_is_even(medium) && medium_mean_extinction(medium, vec3(0)) * SCENE_RADIUS < DENSEST_FOR_BEAMS;
}

// As merge_density, of a vertex with a ray (the estimator P-B2D of Křivánek et al. 2014). A point merges with density
// p sigma T N 4/3 pi r³, where p is the density of the ray's direction per area at the vertex, T its passage to there, sigma the
// extinction coefficient, N the number of forward paths. A ray needs neither to get there nor to scatter there, and its disk is
// perpendicular to it: p N pi r². Paths count in units of p sigma T, so that this takes N pi r² / (sigma T); T is left to the
// caller.
float beam_density(float extinction, vec3 position) {
    if (dot(position, position) > square(BEAM_REACH)) return 0.0;
    return PI * square(merge_radius(position)) * float(forward_pass.count) / max(extinction, 1e-30);
}

bool comes_from_beam(Path path) { return (path.flags & PATH_AFTER_BEAM) != 0u; }
#else
#define merges_along(medium) false
#define beam_density(extinction, position) 0.0
#define comes_from_beam(path) false
#endif
