// The media that paths start in, which the scene's boundaries tell (shaders/kernels/find_start_media.comp).
#pragma once
#include "host/gpu/kernel.h"
#include "host/scene/scene.h"

namespace etendue {

// RecordRefs: at the receiver, and if `of_lights` in front of and behind each light. Empty where the scene
// has no media.
class StartMedia {
  public:
    StartMedia(Device& device, Scene& scene, bool of_lights);
    const Buffer& buffer() const { return media_; }
    // Asks for all of them, or for that of the receiver alone; `film_aspect`: of the image, width / height.
    // find() fails where one of them is a crystal.
    void find(uint32_t receiver, float film_aspect);
    void find_of_receiver(uint32_t receiver, float film_aspect);

  private:
    void ask(uint32_t count, uint32_t receiver, float film_aspect);
    Device& device_;
    const Scene& scene_;
    uint32_t count_ = 0;
    uint64_t element_words_ = 0;
    Buffer media_;
    Kernel kernel_;
};

}  // namespace etendue
