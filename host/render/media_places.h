// Places of a scene's media in an array on the device that says something of each: by tag and index of their
// RecordRefs.
#pragma once
#include <algorithm>

#include "host/scene/scene.h"

namespace etendue {

struct MediaPlaces {
    uint32_t stride = 1, tags = 1;
    explicit MediaPlaces(const Scene& scene) {
        for (const auto& [ref, name] : scene.medium_names) {
            stride = std::max(stride, (ref & 0xFFFFFF) + 1);
            tags = std::max(tags, (ref >> 24) + 1);
        }
    }
    size_t count() const { return size_t(stride) * tags; }
    size_t of(uint32_t ref) const { return size_t(ref >> 24) * stride + (ref & 0xFFFFFF); }
};

}  // namespace etendue
