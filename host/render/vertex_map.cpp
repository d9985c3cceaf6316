#include "host/render/vertex_map.h"

#include <algorithm>
#include <bit>

#include "host/error.h"

namespace etendue {
namespace {

constexpr uint32_t max_capacity = (1u << 28) - 2;
constexpr uint32_t min_buckets = 16, max_buckets = 1 << 22;
// Bytes of GridPlace and GridItem (lib/vertex_grid.glsl).
constexpr uint64_t place_bytes = 12, item_bytes = 24, entry_bytes = 16;
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

uint64_t VertexMap::vertex_bytes(const Features& features) {
    return 64 + (features.spectral ? 4 : 0) + (features.body_count > 0 ? 4 : 0);
}

VertexMap::VertexMap(Device& device, uint32_t capacity, uint64_t vertex_bytes, const KernelMaker& make)
    : capacity_(capacity), buckets_(bucket_count(capacity)), cpu_(device.description.type == "CPU") {
    if (capacity == 0 || capacity > max_capacity)
        fail_input("{} light vertices; allowed: 1 to {}", capacity, max_capacity);
    vertices_ = Buffer(device, capacity * vertex_bytes, "LightVertices");
    counts_ = create_buffer(device, std::vector<LightVertexCounts>{{capacity, buckets_ - 1, 0, 0}},
                            "LightVertexCounts");
    places_ = Buffer(device, capacity * place_bytes, "GridPlaces");
    bucket_starts_ = Buffer(device, (buckets_ + 1) * uint64_t(4), "BucketStarts");
    bucket_sums_ = Buffer(device, (buckets_ + run - 1) / run * 4, "BucketSums");
    items_ = Buffer(device, capacity * item_bytes, "GridItems");
    large_buckets_ = Buffer(device, (capacity / large_bucket + 1) * 4, "LargeBuckets");
    entries_ = Buffer(device, capacity * entry_bytes, "GridEntries");
    BufferTable table = buffers();
    table["BucketSums"] = &bucket_sums_;
    table["GridItems"] = &items_;
    table["LargeBuckets"] = &large_buckets_;
    scan_buckets_ = make("kernels/scan_buckets.comp", table);
    sort_vertices_ = make("kernels/sort_vertices.comp", table);
    order_vertices_ = make("kernels/order_vertices.comp", table);
    order_large_buckets_ = make("kernels/order_large_buckets.comp", table);
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
