// Rays per second through the hierarchy of a procedural interior: primary rays and diffuse bounces, nearest
// and any hit; beside them Embree, ray by ray on one core, where it was there when this was built (package
// libembree-dev).
//
//     find_hits_bench [TRIANGLES=400000] [RAYS=1000000] [REPEATS=3]
//
// EMBREE_CONFIG is handed to Embree: isa=avx2 compares with processors that have no AVX-512.
// LP_NUM_THREADS=1 with lavapipe gives the figures of one core; per second of processor time they hold on a
// busy machine, too.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>

#include "host/error.h"
#include "host/gpu/kernel.h"
#include "host/geometry/bvh.h"
#include "tests/bench/interior.h"

#ifdef HAS_EMBREE
#include <embree3/rtcore.h>
#endif

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

struct Hit {  // twin of the struct in shaders/lib/traversal.glsl
    float t;
    glm::vec2 uv;
    uint32_t primitive, instance;
    bool is_there() const { return primitive != 0xFFFFFFFFu; }
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
Rays bounce_rays(const Rays& rays, const std::vector<Hit>& hits,
                 const std::vector<TriangleRecord>& triangles) {
    Rays result;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (size_t i = 0; i < hits.size(); i++) {
        if (!hits[i].is_there()) continue;
        const TriangleRecord& t = triangles[hits[i].primitive];
        const glm::vec3 d(rays.directions[i]);
        glm::vec3 n = glm::cross(t.v1 - t.v0, t.v2 - t.v0);
        if (!(glm::dot(n, n) > 0)) continue;
        n = glm::normalize(n);
        if (glm::dot(n, d) > 0) n = -n;
        const glm::vec3 p = t.v0 + hits[i].uv.x * (t.v1 - t.v0) + hits[i].uv.y * (t.v2 - t.v0);
        const float z = 1 - 2 * uniform(random), phi = 6.2831853f * uniform(random), r = std::sqrt(1 - z * z);
        const glm::vec3 direction = n * 1.0001f + glm::vec3(r * std::cos(phi), r * std::sin(phi), z);
        result.origins.emplace_back(p + n * 1e-5f, 0);
        result.directions.emplace_back(glm::normalize(direction), 1e30f);
    }
    return result;
}

// Million rays a second; by the wall and by the processor's time.
struct Speed {
    double wall = 0, processor = 0;
};

// Of the fastest of some runs of `trace`, which returns seconds by the wall.
template <class Trace>
Speed measure(size_t rays, int repeats, const Trace& trace) {
    double wall = 1e30, processor = 1e30;
    for (int i = 0; i <= repeats; i++) {
        const std::clock_t start = std::clock();
        const double seconds = trace();
        if (i == 0) continue;  // compiles
        wall = std::min(wall, seconds);
        processor = std::min(processor, double(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return {double(rays) * 1e-6 / wall, double(rays) * 1e-6 / processor};
}

void print(const char* what, const char* kind, const char* rays, const Speed& speed,
           const std::vector<Hit>& hits) {
    double distance = 0;
    size_t found = 0;
    for (const Hit& hit : hits)
        if (hit.is_there()) found++, distance += hit.t;
    fmt::print(
        "{:8} {:11} {:8} {:7.3f} Mrays/s, {:7.3f} per processor second   ({} of {} hit, mean distance "
        "{:.6f})\n",
        what, kind, rays, speed.wall, speed.processor, found, hits.size(), distance / double(found));
    std::fflush(stdout);
}

// The kernel find_hits over the hierarchy.
class DeviceTracer {
  public:
    DeviceTracer(Device& device, const Bvh& bvh, const std::vector<TriangleRecord>& triangles)
        : device_(device), primitives_(create_buffer(device, triangles, "Primitives")) {
        std::vector<glm::uvec4> entries;
        encode_bvh(bvh, 0, entries);
        nodes_ = create_buffer(device, entries, "Nodes");
        stack_ = bvh.statistics.depth + 2;
        if (const char* folder = std::getenv("ETENDUE_SHADERS")) sources_.folder = folder;
        sources_.generated["generated/geometry_classes.glsl"] = "#define GEOMETRY_CLASSES(CASE)\n";
    }

    Speed trace(const Rays& rays, bool any_hit, int repeats, std::vector<Hit>& result) {
        const auto count = uint32_t(rays.origins.size());
        const Buffer origins = create_buffer(device_, rays.origins, "RayOrigins");
        const Buffer directions = create_buffer(device_, rays.directions, "RayDirections");
        const Buffer hits(device_, count * sizeof(Hit), "Hits");
        CompileOptions options;
        options.defines = fmt::format(
            "#define HAS_TRIANGLES 1\n#define ANY_HIT {:d}\n#define BVH_STACK_SIZE {}\n", any_hit, stack_);
        const Kernel kernel(device_, compile_shader(sources_, "kernels/find_hits.comp", options),
                            {{"Nodes", &nodes_},
                             {"Primitives", &primitives_},
                             {"RayOrigins", &origins},
                             {"RayDirections", &directions},
                             {"Hits", &hits}});
        CommandList commands(device_);
        const Speed speed = measure(count, repeats, [&] {
            KernelTimings timings;
            commands.dispatch(kernel, std::max(1u, count / 64 / 64), {{"ray_count", count}});
            commands.run(&timings);
            return timings.begin()->second.seconds;
        });
        result = hits.read_array<Hit>(count);
        return speed;
    }

  private:
    Device& device_;
    Buffer primitives_, nodes_;
    uint32_t stack_ = 0;
    ShaderSources sources_;
};

#ifdef HAS_EMBREE
// The yardstick: robust, as our triangles are.
class EmbreeTracer {
  public:
    explicit EmbreeTracer(const std::vector<TriangleRecord>& triangles)
        : device_(rtcNewDevice(std::getenv("EMBREE_CONFIG"))), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * triangles.size()));
        auto* indices = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()));
        for (size_t i = 0; i < triangles.size(); i++) {
            vertices[3 * i] = triangles[i].v0, vertices[3 * i + 1] = triangles[i].v1;
            vertices[3 * i + 2] = triangles[i].v2;
            for (size_t k = 3 * i; k < 3 * i + 3; k++) indices[k] = uint32_t(k);
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
    }
    EmbreeTracer(const EmbreeTracer&) = delete;
    ~EmbreeTracer() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    Speed trace(const Rays& rays, bool any_hit, int repeats, std::vector<Hit>& result) {
        result.resize(rays.origins.size());
        return measure(rays.origins.size(), repeats, [&] {
            const auto start = std::chrono::steady_clock::now();
            for (size_t i = 0; i < result.size(); i++)
                result[i] = any_hit ? occluded(rays.origins[i], rays.directions[i])
                                    : nearest(rays.origins[i], rays.directions[i]);
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        });
    }

  private:
    static RTCRay ray(const glm::vec4& o, const glm::vec4& d) {
        return {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, d.w, ~0u, 0, 0};
    }
    Hit nearest(const glm::vec4& origin, const glm::vec4& direction) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit hit{ray(origin, direction), {}};
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &hit);
        const bool met = hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        return {hit.ray.tfar, {hit.hit.u, hit.hit.v}, met ? hit.hit.primID : ~0u, ~0u};
    }
    Hit occluded(const glm::vec4& origin, const glm::vec4& direction) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay r = ray(origin, direction);
        rtcOccluded1(scene_, &context, &r);
        return {0, {}, r.tfar < 0 ? 0 : ~0u, ~0u};
    }

    RTCDevice device_;
    RTCScene scene_;
};
#endif

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
    DeviceTracer tracer(*device, bvh, triangles);
    const Rays primary = primary_rays(ray_count);
    std::vector<Hit> hits;
    tracer.trace(primary, false, 0, hits);
    const Rays bounces = bounce_rays(primary, hits, triangles);
#ifdef HAS_EMBREE
    EmbreeTracer yardstick(triangles);
#endif
    for (const bool any_hit : {false, true})
        for (const auto& [rays, name] : {std::pair(&primary, "primary"), std::pair(&bounces, "bounce")}) {
            const char* kind = any_hit ? "any hit" : "nearest hit";
            const Speed own = tracer.trace(*rays, any_hit, repeats, hits);
            print("etendue", kind, name, own, hits);
#ifdef HAS_EMBREE
            const Speed embree = yardstick.trace(*rays, any_hit, repeats, hits);
            print("Embree", kind, name, embree, hits);
            fmt::print("         {:.2f} times as fast per processor second\n",
                       embree.processor / own.processor);
#endif
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
