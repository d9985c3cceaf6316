// The paths that kernels/scatter_paths.comp takes: all of a bounce, or with SCATTER_CLASS those that kernels/sort_hits.comp has dealt to
// that class of surfaces.
#include "lib/wavefront.glsl"

#ifdef SCATTER_CLASS
uint paths_to_scatter(uint bounce) { return class_counts[bounce * SCATTER_CLASS_COUNT + SCATTER_CLASS]; }
uint path_to_scatter(uint i) { return class_queues[i]; }
#else
uint paths_to_scatter(uint bounce) { return queue_counts[COUNTS_A_BOUNCE * bounce]; }
uint path_to_scatter(uint i) { return ray_queue[i]; }
#endif
