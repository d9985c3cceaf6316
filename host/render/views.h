// The views of a render: receivers, each with a film of its own, that the same forward rays serve
// (shaders/features/views.glsl). Their pixels stand one after another, view by view.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/kernel.h"
#include "host/scene/scene.h"

namespace etendue {

// What a film shows, and in how many pixels.
struct FilmView {
    uint32_t receiver = no_record;  // RecordRef
    uint32_t width = 0, height = 0;
    uint64_t pixels() const { return uint64_t(width) * height; }
    bool operator==(const FilmView&) const = default;
};
uint64_t pixel_count(std::span<const FilmView> views);

// A forward path remembers in its flags which receptors it has passed (PATH_PASSED_SHIFT of
// shaders/lib/path.glsl).
constexpr size_t most_views = 22;

// The views on the device.
class Views {
  public:
    // At least one, at most most_views.
    Views(Device& device, const Scene& scene, std::vector<FilmView> views);
    void set(std::vector<FilmView> views);  // as many as before
    const std::vector<FilmView>& all() const { return views_; }
    uint32_t count() const { return uint32_t(views_.size()); }
    uint64_t first_pixel(size_t view) const;
    uint64_t pixels() const { return pixel_count(views_); }
    BufferTable buffers() const { return {{"Views", &buffer_}}; }
    // What kernels that read them are compiled with.
    std::string defines() const { return views_.size() > 1 ? "#define SEVERAL_VIEWS 1\n" : ""; }

  private:
    const Scene& scene_;
    std::vector<FilmView> views_;
    Buffer buffer_;
};

}  // namespace etendue
