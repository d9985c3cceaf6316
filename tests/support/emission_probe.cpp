#include "tests/support/emission_probe.h"

#include <fmt/format.h>

#include "tests/support/source_path.h"

namespace etendue {
namespace {

const char* const text = R"(
    #include "interfaces/light_source.glsl"
    #include "lib/primitives.glsl"
    #include "lib/sampler.glsl"
    layout(local_size_x = 64) in;
    layout(scalar, set = 0) readonly buffer Lights { uint lights[]; };
    struct ProbedRay {
        vec3 origin; float pdf; vec3 direction; float t_hit; vec3 radiance; uint is_delta; vec3 normal; float met_pdf;
        vec3 error; float met_radiance; float sampled_emission_pdf, sampled_met_pdf;
    };
    struct CrossingRay { vec3 exit; float pdf_emit; vec3 direction; float unused; };
    layout(scalar, set = 0) writeonly buffer ProbedRays { ProbedRay probed_rays[]; };
    layout(scalar, set = 0) writeonly buffer CrossingRays { CrossingRay crossing_rays[]; };
    layout(scalar, set = 0) writeonly buffer Numbers { float numbers[]; };
    layout(scalar, set = 0) readonly buffer Directions { vec3 directions[]; };
    layout(push_constant) uniform Push { uint count, rays, seed; float x, y, z, nx, ny, nz, radius; };

    vec2 random(uint i, uint k) { return vec2(hash_3d(hash_3d(uvec3(i, seed, k))).xy >> 8) / 16777216.0; }

    uint light;  // number i asks light i modulo their count

    // The light as a ray meets it. False: it has a surface, which the ray misses.
    bool meet(bool has_surface, vec3 origin, vec3 direction, vec3 otherwise, out LightHit at, out float t) {
        at = LightHit(otherwise, -direction, vec2(0), vec2(0));
        Hit hit = find_hit(origin, direction, INFINITY);
        t = hit.t;
        if (!has_surface) return true;
        if (hit.primitive == NO_RECORD) return false;
        SurfacePoint p = locate(hit, origin, direction);
        at = LightHit(p.position, p.geometric_normal, p.uv0, p.uv1);
        return p.light == light;
    }

    #if MODE == 0
    // Onward from where it starts; back to there from further along; and along what is sampled there. `rays` is 3: with one
    // place that traces the kernel compiles in a third of the time.
    void probe(uint i, bool has_surface) {
        EmittedRay e = light_emit(lights[light], scene_bounds(), random(i, 1u), random(i, 2u));
        ProbedRay r = ProbedRay(e.origin, e.pdf, e.direction, INFINITY, e.radiance, uint(e.is_delta), e.normal, -1.0,
                                e.error, 0.0, -1.0, -1.0);
        has_surface = has_surface && !e.is_delta;  // or what light leaves is nothing that rays meet
        vec3 origin = offset_origin(e.origin, e.error, e.normal, e.direction), direction = e.direction, otherwise = e.origin;
        LightSample l = no_light_sample();
        for (uint k = 0u; k < rays; k++) {
            LightHit at;
            float t;
            bool met = meet(has_surface, origin, direction, otherwise, at, t);
            float pdf = met ? light_pdf_emit(lights[light], scene_bounds(), direction, at) : -1.0;
            if (k == 0u) {
                r.t_hit = t;
                origin = e.origin + e.direction * min(0.01 + random(i, 3u).x, 0.5 * t);
                direction = -e.direction;
                l = light_sample_towards(lights[light], origin, random(i, 4u));
            } else if (k == 1u) {
                r.met_pdf = pdf;
                if (met) r.met_radiance = luminance(light_radiance(lights[light], direction, at));
                direction = l.direction;
                otherwise = origin + l.direction * min(l.distance, 1e6);
            } else if (l.pdf > 0.0 && met) {
                r.sampled_emission_pdf = l.emission_pdf;
                r.sampled_met_pdf = pdf;
            }
        }
        probed_rays[i] = r;
    }
    #elif MODE == 1
    // Even over étendue: positions by area, directions by cosine; density 1 / (pi area).
    void probe(uint i, bool has_surface) {
        SceneBounds bounds = scene_bounds();
        vec3 n = warp_sphere(random(i, 1u));
        vec3 exit = bounds.center + bounds.radius * n;
        vec3 direction = normalize(frame_around(n) * warp_cosine_hemisphere(random(i, 2u)));
        LightHit at;
        float t;
        bool met = meet(has_surface, exit, -direction, exit, at, t);
        crossing_rays[i] = CrossingRay(exit, met ? light_pdf_emit(lights[light], bounds, -direction, at) : 0.0, direction, 0.0);
    }
    #elif MODE == 2
    void probe(uint i, bool has_surface) {
        vec3 n = vec3(nx, ny, nz);
        vec3 point = vec3(x, y, z) + radius * (frame_around(n) * vec3(warp_disk(random(i, 1u)), 0.0));
        LightSample l = light_sample_towards(lights[light], point, random(i, 2u));
        float cosine = dot(n, l.direction);
        bool visible = l.pdf > 0.0 && cosine > 0.0;
        if (visible) visible = !find_occlusion(point, l.direction, 0.9999 * l.distance);
        numbers[i] = visible ? luminance(l.radiance) * cosine / l.pdf : 0.0;
    }
    #else
    void probe(uint i, bool has_surface) {
        LightHit at = LightHit(vec3(0), vec3(0, 0, 1), vec2(0), vec2(0));
        numbers[i] = light_pdf_emit(lights[light], scene_bounds(), -directions[i], at);
    }
    #endif

    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        light = i % uint(LIGHT_COUNT);
        vec3 lo, hi;
        light_bounds(lights[light], lo, hi);
        probe(i, lo.x <= hi.x && lo != hi);  // neither infinitely far nor a point
    }
)";

}  // namespace

EmissionProbe::EmissionProbe(const SceneDescription& description) {
    SceneOptions options;
    options.shaders = source_path("shaders");
    options.cache_folder = cache_.path;
    options.color = ColorMode::rgb;
    scene_ = compile_scene(test_device(), description, options);
    scene_.sources.generated["probe_emission.comp"] = text;
}

template <class T>
std::vector<T> EmissionProbe::run(uint32_t mode, uint32_t count, uint32_t seed, const char* results,
                                  const std::vector<glm::vec3>& directions, const MeasuringDisk& disk) {
    const Buffer out(test_device(), uint64_t(count) * sizeof(T), results), none(test_device(), 4, "none"),
        along = create_buffer(test_device(), directions, "directions");
    BufferTable buffers = {
        {"ProbedRays", &none}, {"CrossingRays", &none}, {"Numbers", &none}, {"Directions", &along}};
    buffers[results] = &out;
    const Kernel kernel = make_kernel(test_device(), scene_, "probe_emission.comp", buffers,
                                      fmt::format("#define MODE {}\n", mode));
    CommandList list(test_device());
    list.dispatch(kernel, (count + 63) / 64,
                  {{"count", count},
                   {"rays", 3u},
                   {"seed", seed},
                   {"x", disk.center.x},
                   {"y", disk.center.y},
                   {"z", disk.center.z},
                   {"nx", disk.normal.x},
                   {"ny", disk.normal.y},
                   {"nz", disk.normal.z},
                   {"radius", disk.radius}});
    list.run();
    return out.template read_array<T>(count);
}

std::vector<ProbedRay> EmissionProbe::emit(uint32_t count, uint32_t seed) {
    return run<ProbedRay>(0, count, seed, "ProbedRays", {}, {});
}
std::vector<CrossingRay> EmissionProbe::cross(uint32_t count, uint32_t seed) {
    return run<CrossingRay>(1, count, seed, "CrossingRays", {}, {});
}
std::vector<float> EmissionProbe::illuminances(const MeasuringDisk& disk, uint32_t count, uint32_t seed) {
    return run<float>(2, count, seed, "Numbers", {}, disk);
}
std::vector<float> EmissionProbe::densities(const std::vector<glm::vec3>& directions) {
    return run<float>(3, uint32_t(directions.size()), 0, "Numbers", directions, {});
}

}  // namespace etendue
