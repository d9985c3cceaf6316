// Rays per second through the hierarchy of a procedural interior: primary rays and diffuse bounces, nearest
// and any hit, quantised and float nodes.
//
//     find_hits_bench [TRIANGLES=400000] [RAYS=1000000] [REPEATS=3]
//
// LP_NUM_THREADS=1 with lavapipe gives the figures of one core; per second of processor time they hold on a
// busy machine, too.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>

#include "host/error.h"
#include "host/gpu/kernel.h"
#include "host/geometry/bvh.h"
#include "tests/bench/interior.h"

using namespace etendue;

namespace {

struct TriangleRecord {
    glm::vec3 v0;
    uint32_t material = 0;
    glm::vec3 v1;
    uint32_t light = 0xFFFFFFFFu;
    glm::vec3 v2;
    uint32_t attributes = 0;
};

struct Rays {
    std::vector<glm::vec4> origins, directions;
};

Rays primary_rays(uint32_t count) {
    Rays rays;
    const auto width = static_cast<uint32_t>(std::sqrt(double(count)));
    for (uint32_t i = 0; i < count; i++) {  // in 8 x 8 tiles, as a film hands them out
        const uint32_t tile = i / 64, x = tile % (width / 8) * 8 + i % 8,
                       y = tile / (width / 8) * 8 + i / 8 % 8;
        const float u = 2 * (float(x) + 0.5f) / float(width) - 1,
                    v = 2 * (float(y) + 0.5f) / float(width) - 1;
        rays.origins.emplace_back(7.5f, 1.6f, 5.5f, 0);
        rays.directions.emplace_back(
            glm::normalize(glm::vec3(-1 + 0.7f * u, -0.15f - 0.6f * v, -0.75f - 0.7f * u)), 1e30f);
    }
    return rays;
}

// Cosine-weighted directions from where the given rays have hit.
Rays bounce_rays(const Rays& rays, const std::vector<glm::vec4>& hits,
                 const std::vector<TriangleRecord>& triangles) {
    Rays result;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (size_t i = 0; i < hits.size(); i++) {
        const auto primitive = std::bit_cast<uint32_t>(hits[i].w);
        if (primitive == 0xFFFFFFFFu) continue;
        const TriangleRecord& t = triangles[primitive];
        const glm::vec3 d(rays.directions[i]);
        glm::vec3 n = glm::cross(t.v1 - t.v0, t.v2 - t.v0);
        if (!(glm::dot(n, n) > 0)) continue;
        n = glm::normalize(n);
        if (glm::dot(n, d) > 0) n = -n;
        const glm::vec3 p = t.v0 + hits[i].y * (t.v1 - t.v0) + hits[i].z * (t.v2 - t.v0);
        const float z = 1 - 2 * uniform(random), phi = 6.2831853f * uniform(random), r = std::sqrt(1 - z * z);
        const glm::vec3 direction = n * 1.0001f + glm::vec3(r * std::cos(phi), r * std::sin(phi), z);
        result.origins.emplace_back(p + n * 1e-5f, 0);
        result.directions.emplace_back(glm::normalize(direction), 1e30f);
    }
    return result;
}

void run(size_t triangle_count, uint32_t ray_count, int repeats) {
    const TriangleSoup soup = interior(triangle_count);
    std::vector<Box> boxes(soup.size());
    for (size_t i = 0; i < soup.size(); i++)
        for (int k = 0; k < 3; k++) boxes[i].grow(soup.vertices[3 * i + k]);
    const Bvh bvh = build_bvh(boxes, std::max(1u, std::thread::hardware_concurrency()));
    fmt::print("{} triangles: hierarchy in {:.2f} s, SAH cost {:.1f}, depth {}, {:.1f} % of leaves coarse\n",
               soup.size(), bvh.statistics.seconds, bvh.statistics.sah_cost, bvh.statistics.depth,
               100 * coarse_share(bvh));
    std::vector<TriangleRecord> triangles(soup.size());
    for (size_t i = 0; i < soup.size(); i++) {
        const glm::vec3* v = &soup.vertices[3 * size_t(bvh.order[i])];
        triangles[i] = {v[0], 0, v[1], 0xFFFFFFFFu, v[2], bvh.order[i]};
    }

    auto device = create_device();
    fmt::print("{}, {}\n", device->description.name, device->description.driver);
    const Buffer primitives = create_buffer(*device, triangles, "Primitives");
    ShaderSources sources;
    if (const char* folder = std::getenv("ETENDUE_SHADERS")) sources.folder = folder;
    sources.generated["generated/geometry_classes.glsl"] = "#define GEOMETRY_CLASSES(CASE)\n";

    Rays bounces;
    for (const NodeFormat format : {NodeFormat::quantised, NodeFormat::floats}) {
        if (std::getenv("QUICK") && format == NodeFormat::floats) break;
        std::vector<glm::uvec4> entries;
        encode_bvh(bvh, format, 0, entries);
        const Buffer nodes = create_buffer(*device, entries, "Nodes");
        const std::string defines = fmt::format(
            "#define HAS_TRIANGLES 1\n#define HAS_SHAPES 0\n#define HAS_INSTANCES 0\n#define HAS_FLOAT_NODES "
            "{}\n"
            "#define BVH_STACK_SIZE {}\n",
            int(format == NodeFormat::floats), bvh.statistics.depth + 2);
        for (const bool any_hit : {false, true}) {
            CompileOptions options;
            options.defines = defines + fmt::format("#define ANY_HIT {}\n", int(any_hit));
            const CompiledShader shader = compile_shader(sources, "kernels/find_hits.comp", options);
            const auto trace = [&](const Rays& rays, const char* name) {
                const auto count = static_cast<uint32_t>(rays.origins.size());
                const Buffer origins = create_buffer(*device, rays.origins, "RayOrigins");
                const Buffer directions = create_buffer(*device, rays.directions, "RayDirections");
                Buffer hits(*device, count * sizeof(glm::vec4), "Hits");
                const Kernel kernel(*device, shader,
                                    {{"Nodes", &nodes},
                                     {"Primitives", &primitives},
                                     {"RayOrigins", &origins},
                                     {"RayDirections", &directions},
                                     {"Hits", &hits}});
                CommandList commands(*device);
                double best = 1e30, best_cpu = 1e30;
                for (int i = 0; i <= repeats; i++) {
                    KernelTimings timings;
                    commands.dispatch(kernel, std::max(1u, count / 64 / 64), {{"ray_count", count}});
                    const std::clock_t start = std::clock();
                    commands.run(&timings);
                    if (i == 0) continue;  // compiles
                    best = std::min(best, timings.begin()->second.seconds);
                    best_cpu = std::min(best_cpu, double(std::clock() - start) / CLOCKS_PER_SEC);
                }
                std::vector<glm::vec4> result = hits.read_array<glm::vec4>(count);
                double distance = 0;
                size_t found = 0;
                for (const glm::vec4& hit : result)
                    if (std::bit_cast<uint32_t>(hit.w) != 0xFFFFFFFFu) found++, distance += hit.x;
                fmt::print(
                    "{:9} nodes  {:11} {:8} {:7.3f} Mrays/s, {:7.3f} per processor second"
                    "   ({} of {} hit, mean distance {:.6f})\n",
                    format == NodeFormat::floats ? "float" : "quantised", any_hit ? "any hit" : "nearest hit",
                    name, count / best * 1e-6, count / best_cpu * 1e-6, found, count,
                    distance / double(found));
                std::fflush(stdout);
                return result;
            };
            const Rays primary = primary_rays(ray_count);
            const std::vector<glm::vec4> hits = trace(primary, "primary");
            if (bounces.origins.empty()) bounces = bounce_rays(primary, hits, triangles);
            trace(bounces, "bounce");
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(argc > 1 ? std::stoul(argv[1]) : 400000, argc > 2 ? uint32_t(std::stoul(argv[2])) : 1000000,
            argc > 3 ? std::stoi(argv[3]) : 3);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return int(error.code);
    }
    return 0;
}
