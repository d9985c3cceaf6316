// The rays that kernels/find_hits.comp traces: all there are, or those of a queue (lib/wavefront.glsl).
#ifdef HAS_RAY_QUEUE
layout(scalar) readonly buffer RayQueue { uint ray_queue[]; };
layout(scalar) readonly buffer QueueCounts { uint queue_counts[]; };
layout(push_constant, scalar) uniform Push { uint counter, read_queue; };  // which count; where the queue starts
uint queued_rays() { return queue_counts[counter]; }
uint queued_ray(uint i) { return ray_queue[read_queue + i]; }
#else
layout(push_constant, scalar) uniform Push { uint ray_count; };
uint queued_rays() { return ray_count; }
uint queued_ray(uint i) { return i; }
#endif
