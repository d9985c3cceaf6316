// The media that paths start in, which the scene's boundaries tell (shaders/kernels/find_start_media.comp).
#pragma once
#include "host/gpu/kernel.h"
#include "host/scene/scene.h"

namespace etendue {

// RecordRefs: at the receiver, for an image of that aspect ratio (width / height), and if `of_lights` in
// front of and behind each light. Empty where the scene has no media.
Buffer find_start_media(Device& device, Scene& scene, uint32_t receiver, float film_aspect, bool of_lights);

}  // namespace etendue
