// What kernels know of the wavelengths of the passes they work at (shaders/features/spectrum.glsl).
#pragma once
#include <cstdint>

#include "host/gpu/kernel.h"
#include "host/scene/scene.h"

namespace etendue {

class SpectralPasses {
  public:
    // Of a scene in colours it is empty, and costs nothing.
    SpectralPasses(Device& device, const Scene& scene);
    BufferTable buffers() const;
    uint32_t capacity() const;  // passes at once; of a scene in colours any number
    // The passes [first, first + count) of a run, at most as many as the capacity: their wavelengths, and the
    // scene's spectra there.
    void write(uint64_t first, uint32_t count, uint32_t seed);

  private:
    const Scene& scene_;
    Buffer wavelengths_, values_, colors_;
    bool has_colors_ = false;  // written into colors_, once a kernel reads them
};

}  // namespace etendue
