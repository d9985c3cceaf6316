// A VertexMap filled and asked by small kernels.
#pragma once
#include <glm/glm.hpp>

#include "host/render/vertex_map.h"

namespace etendue {

// Twin of LightVertex in shaders/lib/light_vertices.glsl.
struct LightVertex {
    glm::vec3 position;
    float vcm;
    glm::vec3 throughput;
    float vc;
    glm::vec2 direction;
    uint32_t normal, instance;
    glm::vec2 uv;
    uint32_t primitive, previous;
};
constexpr uint32_t no_light_vertex = 0x0FFFFFFF, light_vertex_merges = 0x10000000;

struct GridPoint {
    glm::vec3 position;
    float radius;  // r(position), m
    uint32_t key = 0;
    uint32_t flags = light_vertex_merges;
};

class VertexMapProbe {
  public:
    VertexMapProbe(Device& device, uint32_t capacity);

    // Clears the map, stores the points, some lanes several in turn, and builds the grid.
    void store(const std::vector<GridPoint>& points, uint32_t groups, uint32_t expected,
               KernelTimings* timings = nullptr);
    // Keys of the vertices within the radius of each point, in the order of the walk.
    std::vector<std::vector<uint32_t>> neighbours(const std::vector<GridPoint>& points, uint32_t room = 256);
    // The same walk with the work of a simple merge for each neighbour; returns neighbours a point.
    double merge(const std::vector<GridPoint>& points, KernelTimings* timings);

    VertexMap map;
    double processor_seconds = 0;               // of the last store, of the best of five runs of merge
    std::vector<LightVertex> vertices() const;  // all of the capacity
    std::vector<glm::vec4> entries() const;     // of the grid
    Kernel kernel(const std::string& name, const std::string& text, BufferTable buffers);

  private:
    Device& device_;
};

}  // namespace etendue
