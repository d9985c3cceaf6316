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

constexpr float beam_cell_scale = 8;  // BEAM_CELL_SCALE in shaders/lib/vertex_grid.glsl

class VertexMapProbe {
  public:
    VertexMapProbe(Device& device, uint32_t capacity);

    // Clears the map, stores the points, some lanes several in turn, and builds the grid.
    void store(const std::vector<GridPoint>& points, uint32_t groups, uint32_t expected,
               KernelTimings* timings = nullptr);
    // Keys of the vertices within the radius of each point, in the order of the walk.
    std::vector<std::vector<uint32_t>> neighbours(const std::vector<GridPoint>& points, uint32_t room = 256);
    // Keys of the vertices whose own radius a ray reaches; `ends`: of rays, in pairs, the first with the
    // slope of the radius. Vertices must have been stored with a radius of beam_cell_scale times theirs;
    // `radius`: GLSL for theirs at vec3 p.
    std::vector<std::vector<uint32_t>> along(const std::vector<GridPoint>& ends, const std::string& radius,
                                             uint32_t room = 256);
    // The same walk with the work of a simple merge for each neighbour; returns neighbours a point.
    double merge(const std::vector<GridPoint>& points, KernelTimings* timings);

    VertexMap map;
    double processor_seconds = 0;               // of the last store, of the best of five runs of merge
    std::vector<LightVertex> vertices() const;  // all of the capacity
    std::vector<glm::vec4> entries() const;     // of the grid
    Kernel kernel(const std::string& name, const std::string& text, BufferTable buffers);

  private:
    std::vector<std::vector<uint32_t>> found_by(const std::string& name, const std::string& text,
                                                const std::vector<GridPoint>& points, uint32_t count,
                                                uint32_t room);
    Device& device_;
};

}  // namespace etendue
