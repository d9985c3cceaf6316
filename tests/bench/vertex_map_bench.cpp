// Nanoseconds a light vertex to store, sort and find: vertices spread over the faces of a box, radii of five
// neighbours on average. Queries are also counted in processor time, which holds on a busy machine, too.
//
//     vertex_map_bench [VERTICES...]        default 10000 100000 1000000
#include <fmt/format.h>

#include <ctime>
#include <random>

#include "host/error.h"
#include "tests/support/vertex_map_probe.h"

using namespace etendue;

namespace {

std::vector<GridPoint> points_on_box(uint32_t count, float radius, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<GridPoint> points(count);
    for (uint32_t i = 0; i < count; ++i) {
        glm::vec3 p(uniform(random), uniform(random), uniform(random));
        p[int(random() % 3)] = random() % 2 ? 1.0f : -1.0f;
        points[i] = {p, radius, i};
    }
    return points;
}

void run(Device& device, uint32_t count) {
    const float radius = std::sqrt(5.0f * 24.0f / (3.14159265f * float(count)));  // the box has 24 m²
    VertexMapProbe probe(device, count);
    const std::vector<GridPoint> points = points_on_box(count, radius, 1);
    KernelTimings timings;
    double processor = 1e30;
    for (int i = 0; i < 3; ++i) {
        probe.store(points, std::max(2u, count / 1024), count, &timings);
        processor = std::min(processor, probe.processor_seconds);
    }
    double build = 0;
    fmt::print("{} vertices, {} buckets, {:.1f} MiB\n", count, probe.map.buckets(),
               double(probe.map.bytes()) / 1048576);
    for (const auto& [name, timing] : timings) {
        if (name != "store_points") build += timing.seconds;
        fmt::print("  {:20} {:7.1f} ns a vertex\n", name, timing.seconds / 3 / count * 1e9);
    }
    fmt::print("  {:20} {:7.1f} ns a vertex\n", "build", build / 3 / count * 1e9);
    fmt::print("  {:20} {:7.1f} ns a vertex\n", "all, processor", processor / count * 1e9);
    const std::vector<GridPoint> queries = points_on_box(std::max(count, 100000u), radius, 2);
    for (const float factor : {1.0f, 0.72f}) {  // the least and nearly the most cells to a radius
        std::vector<GridPoint> scaled = queries;
        for (GridPoint& p : scaled) p.radius *= factor;
        if (factor != 1.0f) {
            std::vector<GridPoint> stored = points;
            for (GridPoint& p : stored) p.radius *= factor;
            probe.store(stored, std::max(2u, count / 1024), count);
        }
        KernelTimings query;
        const double neighbours = probe.merge(scaled, &query);
        const double share = 1e9 / double(scaled.size());
        fmt::print("  query, {:.2f} r         {:7.1f} ns, {:7.1f} of the processor, {:.2f} neighbours\n",
                   factor, query.at("merge_points").seconds * share, probe.processor_seconds * share,
                   neighbours);
    }
}

// The worst that can be: all vertices in one bucket.
void run_crowd(Device& device, uint32_t count) {
    VertexMapProbe probe(device, count);
    std::vector<GridPoint> points(count, {glm::vec3(0.3f), 0.1f});
    for (uint32_t i = 0; i < count; ++i) points[i].key = (i * 2654435761u) % count;
    KernelTimings timings;
    probe.store(points, std::max(2u, count / 1024), count, &timings);
    fmt::print("{} vertices in one point: {:.1f} ms to order them\n", count,
               timings.at("order_large_buckets").seconds * 1e3);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        auto device = create_device();
        fmt::print("{}, {}\n", device->description.name, device->description.driver);
        std::vector<uint32_t> counts;
        for (int i = 1; i < argc; ++i) counts.push_back(uint32_t(std::stoul(argv[i])));
        if (counts.empty()) counts = {10000, 100000, 1000000};
        for (const uint32_t count : counts) run(*device, count);
        for (const uint32_t count : {10000u, 1000000u}) run_crowd(*device, count);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return int(error.code);
    }
    return 0;
}
