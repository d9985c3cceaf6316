#include "host/scene/watched_surface.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "host/geometry/world.h"
#include "host/scene/records.h"

namespace etendue {

std::vector<uint32_t> watched_instances(const SceneDescription& scene, const std::string& mesh,
                                        const std::string& where) {
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const MeshInstance& instance = scene.instances[i];
        const MeshDescription& description = scene.meshes[instance.mesh];
        const bool is_named = instance.name == mesh || description.name == mesh || instance.where == mesh ||
                              description.where.rfind(mesh + "/", 0) == 0;
        if (mesh.empty() ? where.rfind(instance.where + "/", 0) == 0 : is_named) found.push_back(i);
    }
    return found;
}

std::vector<bool> all_watched(const SceneDescription& scene) {
    std::vector<bool> watched(scene.instances.size());
    for (const PlacedObject& receiver : scene.receivers) {
        if (receiver.object.class_name != "surface") continue;
        const nlohmann::json& p = receiver.object.parameters;
        const std::string mesh = p.contains("mesh") && p["mesh"].is_string() ? p["mesh"].get<std::string>() : "";
        for (const uint32_t i : watched_instances(scene, mesh, receiver.object.where)) watched[i] = true;
    }
    return watched;
}

WatchedSurface append_watched(std::vector<uint32_t>& words, const World& world,
                              const std::vector<uint32_t>& instances) {
    const std::set<uint32_t> wanted(instances.begin(), instances.end());
    std::vector<uint32_t> triangles;
    WatchedSurface surface;
    double area = 0;
    for (uint32_t i = 0; i < world.world_primitives; ++i) {
        const PrimitiveRecord& p = world.primitives[i];
        if (!wanted.count(world.placed->at(i)) || primitive_kind(p) != PrimitiveKind::triangle) continue;
        triangles.push_back(i);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(p.v1 - p.v0), glm::dvec3(p.v2 - p.v0)));
    }
    std::sort(triangles.begin(), triangles.end(),
              [&](uint32_t a, uint32_t b) { return world.sources[a] < world.sources[b]; });
    surface.first = uint32_t(words.size()), surface.count = uint32_t(triangles.size());
    surface.columns = uint32_t(std::ceil(std::sqrt(double(surface.count))));
    surface.rows = surface.count > 0 ? (surface.count - 1) / surface.columns + 1 : 0;
    surface.area = float(area);
    words.insert(words.end(), triangles.begin(), triangles.end());
    words.resize(words.size() + world.world_primitives, no_record);
    for (uint32_t t = 0; t < surface.count; ++t) words[surface.first + surface.count + triangles[t]] = t;
    return surface;
}

}  // namespace etendue
