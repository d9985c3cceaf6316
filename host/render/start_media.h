// The media that paths start in, which the scene's boundaries tell (shaders/kernels/find_start_media.comp).
#pragma once
#include "host/gpu/kernel.h"
#include "host/render/views.h"
#include "host/scene/scene.h"

namespace etendue {

// RecordRefs: at the receivers of the views, and if `of_lights` in front of and behind each light. Empty
// where the scene has no media.
class StartMedia {
  public:
    // `views` live longer.
    StartMedia(Device& device, Scene& scene, const Views& views, bool of_lights);
    const Buffer& buffer() const { return media_; }
    // Asks for all of them, or for those of the receivers alone. find() fails where one of them is a crystal.
    void find();
    void find_of_receivers();

  private:
    void ask(uint32_t count);
    Device& device_;
    const Scene& scene_;
    const Views& views_;
    uint32_t count_ = 0;
    uint64_t element_words_ = 0;
    Buffer media_;
    Kernel kernel_;
};

}  // namespace etendue
