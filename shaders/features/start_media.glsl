// What paths start in, found once by kernels/find_start_media.comp: around the receiver, then in front of and behind each light.
// Scenes whose surfaces separate no media have no such buffer.
#include "features/bodies.glsl"
#include "lib/records.glsl"

#if HAS_INTERFACES
layout(scalar, set = 0) readonly buffer StartMedia { Surroundings start_media[]; };
Surroundings around_receiver() { return start_media[0]; }
Surroundings around_light(uint light, bool front) { return start_media[2u * light + (front ? 1u : 2u)]; }
#else
Surroundings around_receiver() { return surroundings_of(NO_RECORD); }
Surroundings around_light(uint light, bool front) { return surroundings_of(NO_RECORD); }
#endif
