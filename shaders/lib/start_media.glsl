// The media that paths start in, found once by kernels/find_start_media.comp: that of the receiver, then those in front of and
// behind each light. Scenes without media have no such buffer.
#include "lib/bodies.glsl"
#include "lib/records.glsl"

#if HAS_PRIORITIES
layout(scalar, set = 0) readonly buffer StartMedia { Bodies start_bodies[]; };
Bodies receiver_start_bodies() { return start_bodies[0]; }
Bodies light_start_bodies(uint light, bool front) { return start_bodies[2u * light + (front ? 1u : 2u)]; }
uint receiver_start_medium() { return medium_among(receiver_start_bodies()); }
uint light_start_medium(uint light, bool front) { return medium_among(light_start_bodies(light, front)); }
#elif HAS_INTERFACES
layout(scalar, set = 0) readonly buffer StartMedia { uint start_media[]; };
uint receiver_start_medium() { return start_media[0]; }
uint light_start_medium(uint light, bool front) { return start_media[2u * light + (front ? 1u : 2u)]; }
#else
uint receiver_start_medium() { return NO_RECORD; }
uint light_start_medium(uint light, bool front) { return NO_RECORD; }
#endif
