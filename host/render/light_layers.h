// Layers of images that hold only light which has come a certain way (shaders/features/light_layers.glsl):
// each path belongs to the first whose conditions it meets, and to the layer "rest" where it meets those of
// none. So their sum is the whole image.
#pragma once
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace etendue {

// Of a film, all told: each takes as much memory as the image itself.
constexpr size_t most_light_layers = 16;

// A layer for each lamp, in alphabetical order: by the name of its shape or node, else of its material or
// light.
std::vector<LightLayer> light_groups(const Scene& scene);

class LightLayers {
  public:
    // None where there are no `layers`. Fails with one line where they name what the scene has not, or ask
    // for more than a path can carry.
    LightLayers(Device& device, const Scene& scene, const std::vector<LightLayer>& layers);

    // In the order of the film's layers; the last is "rest", unless no light can be left for it.
    const std::vector<std::string>& names() const { return names_; }
    // What kernels that trace are compiled with.
    std::string defines() const;
    BufferTable buffers() const;

  private:
    std::vector<std::string> names_;
    uint32_t lowest_bits_ = 0, field_bits_ = 1;  // of histories
    Buffer tests_, lights_, objects_, events_, media_;
};

}  // namespace etendue
