#include "host/render/vertex_map.h"

#include <algorithm>
#include <bit>

#include "host/error.h"

namespace etendue {
namespace {

constexpr uint32_t max_capacity = (1u << 28) - 2;
constexpr uint32_t min_buckets = 16, max_buckets = 1 << 22;
constexpr const char* sort_file = "kernels/sort_vertices.comp";
constexpr const char* order_file = "kernels/order_vertices.comp";
constexpr uint32_t run = 64;            // of buckets: RUN in kernels/scan_buckets.comp
constexpr uint32_t large_bucket = 512;  // LARGE_BUCKET in lib/vertex_grid.glsl

// Twin of LightVertexCounts in shaders/lib/light_vertices.glsl.
struct LightVertexCounts {
    uint32_t capacity, bucket_mask, wanted, large_buckets;
};

uint32_t bucket_count(uint32_t capacity) {
    return std::bit_ceil(std::clamp(capacity, min_buckets, max_buckets));
}

}  // namespace

uint64_t VertexMap::bytes_a_vertex(const Shaders& shaders) {
    const uint64_t buckets = 2 * 4;  // at most
    return shaders.element_bytes(sort_file, "LightVertices") +
           shaders.element_bytes(sort_file, "GridPlaces") + shaders.element_bytes(sort_file, "GridItems") +
           shaders.element_bytes(order_file, "GridEntries") + buckets;
}

VertexMap::VertexMap(Device& device, uint32_t capacity, const Shaders& shaders)
    : capacity_(capacity), buckets_(bucket_count(capacity)), cpu_(device.description.type == "CPU") {
    if (capacity == 0 || capacity > max_capacity)
        fail_input("{} light vertices; allowed: 1 to {}", capacity, max_capacity);
    const auto room = [&](const char* file, const char* buffer) {
        return Buffer(device, capacity * shaders.element_bytes(file, buffer), buffer);
    };
    vertices_ = room(sort_file, "LightVertices");
    counts_ = create_buffer(device, std::vector<LightVertexCounts>{{capacity, buckets_ - 1, 0, 0}},
                            "LightVertexCounts");
    places_ = room(sort_file, "GridPlaces");
    bucket_starts_ = Buffer(device, (buckets_ + 1) * uint64_t(4), "BucketStarts");
    bucket_sums_ = Buffer(device, (buckets_ + run - 1) / run * 4, "BucketSums");
    items_ = room(sort_file, "GridItems");
    large_buckets_ = Buffer(device, (capacity / large_bucket + 1) * 4, "LargeBuckets");
    entries_ = room(order_file, "GridEntries");
    BufferTable table = buffers();
    table["BucketSums"] = &bucket_sums_;
    table["GridItems"] = &items_;
    table["LargeBuckets"] = &large_buckets_;
    scan_buckets_ = shaders.make("kernels/scan_buckets.comp", table);
    sort_vertices_ = shaders.make(sort_file, table);
    order_vertices_ = shaders.make(order_file, table);
    order_large_buckets_ = shaders.make("kernels/order_large_buckets.comp", table);
}

BufferTable VertexMap::buffers() const {
    return {{"LightVertices", &vertices_},
            {"LightVertexCounts", &counts_},
            {"GridPlaces", &places_},
            {"BucketStarts", &bucket_starts_},
            {"GridEntries", &entries_}};
}

void VertexMap::clear(CommandList& commands) const {
    commands.fill(counts_, 0, offsetof(LightVertexCounts, wanted), 8);
    commands.fill(bucket_starts_, 0);
}

void VertexMap::build(CommandList& commands, uint32_t expected) const {
    // A few items a lane keep a CPU driver's groups busy; a GPU wants all lanes it can have.
    const auto groups = [&](const Kernel& kernel, uint64_t items) {
        const uint64_t size = kernel.group_size() * (cpu_ ? 8 : 1);
        return uint32_t(std::clamp<uint64_t>((items + size - 1) / size, 2, max_groups));
    };
    const uint32_t vertices = std::min(expected, capacity_);
    for (uint32_t stage = 0; stage < 3; ++stage)
        commands.dispatch(scan_buckets_, stage == 1 ? 1 : groups(scan_buckets_, buckets_ / run),
                          {{"stage", stage}});
    commands.dispatch(sort_vertices_, groups(sort_vertices_, vertices));
    commands.dispatch(order_vertices_, groups(order_vertices_, vertices));
    commands.dispatch(order_large_buckets_, std::clamp(vertices / large_bucket, 1u, cpu_ ? 8u : 256u));
}

VertexMap::Counts VertexMap::counts() const {
    const uint32_t wanted = counts_.read_array<LightVertexCounts>(1)[0].wanted;
    return {wanted, std::min(wanted, capacity_)};
}

uint64_t VertexMap::bytes() const {
    uint64_t sum = 0;
    for (const Buffer* buffer : {&vertices_, &counts_, &places_, &bucket_starts_, &bucket_sums_, &items_,
                                 &large_buckets_, &entries_})
        sum += buffer->bytes();
    return sum;
}

}  // namespace etendue
