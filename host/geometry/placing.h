// Where the scene and the contents of its optical elements have their objects, and the boundaries of
// elements.
#pragma once
#include <array>
#include <vector>

#include "host/geometry/world.h"

namespace etendue {

inline glm::dvec3 corner_of(const Box& box, int corner) {
    return {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
            corner & 4 ? box.hi.z : box.lo.z};
}

class Placing {
  public:
    // `shape_bounds`, `mesh_bounds`: local boxes of the scene's shapes and meshes.
    Placing(const SceneDescription& scene, const std::vector<Box>& shape_bounds,
            const std::vector<Box>& mesh_bounds);

    // What stands in a content: indices into the scene's lists. 0 = the scene.
    const std::vector<uint32_t>& instances(uint32_t content) const { return held_[content].instances; }
    const std::vector<uint32_t>& shapes(uint32_t content) const { return held_[content].shapes; }

    glm::dvec3 center() const;  // of everything that is placed in the scene
    // Appends the boundaries that rays meet in a content: its own, and those of the elements in it.
    void add_boundaries(uint32_t content, const glm::dmat4& recentre,
                        std::vector<PrimitiveRecord>& primitives, std::vector<uint32_t>& placed) const;

  private:
    using Corners = std::array<glm::dvec3, 3>;
    struct Extent {
        glm::dvec3 lo{INFINITY}, hi{-INFINITY};
        void grow(const glm::dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
        bool empty() const { return !(lo.x <= hi.x); }
    };
    struct Held {
        std::vector<uint32_t> instances, shapes, elements;
        Extent extent;
        std::vector<Corners> boundary;  // in the content's frame, facing outward
    };
    std::vector<Corners> mesh_boundary(const ElementContent& content) const;
    static std::vector<Corners> box_around(const Extent& extent);

    const SceneDescription& scene_;
    std::vector<Held> held_;
};

}  // namespace etendue
