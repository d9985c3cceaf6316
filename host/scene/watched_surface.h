// Meshes on whose surfaces meters lie (shaders/receivers/surface.glsl).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/description.h"

namespace etendue {

struct World;

// Twin of the struct in shaders/receivers/surface.glsl, where the layout of the words is described.
struct WatchedSurface {
    uint32_t first = 0, count = 0;
    uint32_t columns = 0, rows = 0;
    float area = 0;  // m², of one side
};
static_assert(sizeof(WatchedSurface) == 20);

// The parts of a surface meter's picture, from the top.
constexpr const char* surface_parts[] = {"front, illuminance", "back, illuminance", "front, exitance",
                                         "back, exitance"};
constexpr uint32_t most_watched_triangles = 4'000'000;

// Instances of scene.instances, in their order: of the node or mesh called `mesh`, or where it is empty of
// the node that the receiver stands at, by its JSON pointer.
std::vector<uint32_t> watched_instances(const SceneDescription& scene, const std::string& mesh,
                                        const std::string& where);
// Of all surface meters of the scene, for each instance.
std::vector<bool> all_watched(const SceneDescription& scene);

// Appends the words of a meter. `instances`: not empty.
WatchedSurface append_watched(std::vector<uint32_t>& words, const World& world,
                              const std::vector<uint32_t>& instances);

}  // namespace etendue
