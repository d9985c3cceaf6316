// Light vertices of a pass on the device, and the grid that finds those near a point
// (shaders/lib/vertex_grid.glsl).
#pragma once
#include <functional>
#include <string>

#include "host/gpu/kernel.h"

namespace etendue {

class VertexMap {
  public:
    // How its kernels are compiled: file under shaders/ and buffers; and what an element of a buffer takes in
    // memory, as a kernel declares it.
    struct Shaders {
        std::function<Kernel(const std::string& file, const BufferTable& buffers)> make;
        std::function<uint64_t(const std::string& file, const std::string& buffer)> element_bytes;
    };

    static uint64_t bytes_a_vertex(const Shaders& shaders);  // with its part of the grid

    // Room for `capacity` light vertices, 1 to 2^28 - 2, and a bucket for each, up to 2^22.
    VertexMap(Device& device, uint32_t capacity, const Shaders& shaders);

    // Of kernels that include lib/light_vertices.glsl or lib/vertex_grid.glsl.
    BufferTable buffers() const;

    // Before the first vertex of a pass.
    void clear(CommandList& commands) const;
    // After the last: makes the grid ready for queries. `expected` vertices, by which the dispatches are
    // sized: the result does not depend on it.
    void build(CommandList& commands, uint32_t expected) const;

    struct Counts {
        uint32_t wanted = 0, stored = 0;  // wanted > stored: the map was full
    };
    Counts counts() const;  // of the submissions that have run

    uint32_t capacity() const { return capacity_; }
    uint32_t buckets() const { return buckets_; }
    uint64_t bytes() const;  // of device memory

  private:
    uint32_t capacity_, buckets_;
    bool cpu_;
    Buffer vertices_, counts_, places_, bucket_starts_, bucket_sums_, items_, large_buckets_, entries_;
    Kernel scan_buckets_, sort_vertices_, order_vertices_, order_large_buckets_;
};

}  // namespace etendue
