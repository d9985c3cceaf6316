// What paths start in, found once by kernels/find_start_media.comp: around the receivers of the views, then in front of and behind each light.
// Scenes whose surfaces separate no media have no such buffer.
#include "features/bodies.glsl"
#include "features/views.glsl"
#include "lib/records.glsl"

#if HAS_INTERFACES
layout(scalar, set = 0) readonly buffer StartMedia { Surroundings start_media[]; };
Surroundings around_receiver(View view) { return start_media[view.index]; }
Surroundings around_light(uint light, bool front) { return start_media[VIEW_COUNT + 2u * light + (front ? 0u : 1u)]; }
#else
Surroundings around_receiver(View view) { return surroundings_of(NO_RECORD); }
Surroundings around_light(uint light, bool front) { return surroundings_of(NO_RECORD); }
#endif
