// The media that paths start in, found once by kernels/find_start_media.comp: that of the receiver, then those in front of and
// behind each light. Scenes without media have no such buffer.
#include "lib/records.glsl"

#if HAS_INTERFACES
layout(scalar, set = 0) readonly buffer StartMedia { uint start_media[]; };
uint receiver_start_medium() { return start_media[0]; }
uint light_start_medium(uint light, bool front) { return start_media[2u * light + (front ? 1u : 2u)]; }
#else
uint receiver_start_medium() { return NO_RECORD; }
uint light_start_medium(uint light, bool front) { return NO_RECORD; }
#endif
