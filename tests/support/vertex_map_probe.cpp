#include "tests/support/vertex_map_probe.h"

#include <algorithm>
#include <ctime>

#include "host/error.h"
#include "tests/support/source_path.h"

namespace etendue {
namespace {

ShaderSources sources() {
    ShaderSources result;
    result.folder = source_path("shaders");
    return result;
}

const char* const points_text = R"(
    layout(local_size_x = 64) in;
    layout(push_constant) uniform Push { uint count, room; };
    #include "lib/vertex_grid.glsl"
    struct Point { vec3 position; float radius; uint key, flags; };
    layout(scalar, set = 0) readonly buffer Points { Point points[]; };
)";

// Lanes take turns of different lengths, so that they append in divergent flow. instance holds the key.
const char* const store_text = R"(
    void main() {
        uint lanes = gl_NumWorkGroups.x * 64u, lane = gl_GlobalInvocationID.x;
        for (uint first = lane * 4u; first < count; first += lanes * 4u) {
            uint turns = min(4u, count - first);
            for (uint k = 0u; k < turns; ++k) {
                Point p = points[first + k];
                LightVertex v = LightVertex(p.position, p.radius, vec3(1, 2, 3), 4.0, vec2(0.5, 0.25), 5u,
                                            p.key, vec2(6, 7), 8u, light_vertex_link(first + k, p.flags));
                uint vertex = append_light_vertex(v);
                if (vertex != NO_LIGHT_VERTEX && (p.flags & LIGHT_VERTEX_MERGES) != 0u)
                    enter_grid(vertex, p.position, p.radius, p.key);
            }
        }
    }
)";

const char* const query_text = R"(
    // Rows of 1 + room: the count, the keys.
    layout(scalar, set = 0) writeonly buffer Found { uint found[]; };
    void main() {
        uint lanes = gl_NumWorkGroups.x * 64u;
        for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
            GridQuery q;
            uint vertex, number = 0u, row = i * (1u + room);
            vec3 position;
            begin_query(q, points[i].position, points[i].radius);
            while (next_candidate(q, vertex, position)) {
                if (number < room) {
                    bool same = position == light_vertices[vertex].position;
                    found[row + 1u + number] = same ? light_vertices[vertex].instance : 0xFFFFFFFFu;
                }
                number++;
                found[row] = number;
            }
        }
    }
)";

const char* const rays_text = R"(
    // Points in pairs: the ends of rays. Found as above; the caller has defined merge_radius.
    layout(scalar, set = 0) writeonly buffer Found { uint found[]; };
    #include "lib/constants.glsl"
    #include "lib/beam_query.glsl"
    void main() {
        uint lanes = gl_NumWorkGroups.x * 64u;
        for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
            vec3 origin = points[2u * i].position, way = points[2u * i + 1u].position - origin;
            float far = length(way);
            vec3 direction = way / far;
            BeamQuery q;
            uint vertex, number = 0u, row = i * (1u + room);
            begin_beam(q, origin, direction, far, points[2u * i].radius);
            while (next_on_beam(q, vertex)) {
                if (number < room) found[row + 1u + number] = light_vertices[vertex].instance;
                number++;
                found[row] = number;
            }
        }
    }
)";

// What merging does with a neighbour on a diffuse surface (Georgiev et al. 2012), in outline.
const char* const merge_text = R"(
    #include "lib/constants.glsl"
    layout(scalar, set = 0) writeonly buffer Found { uint found[]; };  // the count
    layout(scalar, set = 0) writeonly buffer Merged { vec3 merged[]; };
    void main() {
        uint lanes = gl_NumWorkGroups.x * 64u;
        for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
            GridQuery q;
            uint vertex, number = 0u;
            vec3 position, sum = vec3(0), normal = vec3(0, 0, 1);
            begin_query(q, points[i].position, points[i].radius);
            while (next_candidate(q, vertex, position)) {
                LightVertex v = light_vertices[vertex];
                float cosine = dot(decode_octahedral(v.direction), normal);
                float pdf = max(cosine, 0.0) * INV_PI;
                bool same = dot(decode_octahedral_16(v.normal), normal) > -2.0;
                float weight = 1.0 / (1.0 + square(v.vcm) + square(pdf * v.vc));
                number++;
                sum += same ? v.throughput * (weight * INV_PI) : vec3(0);
                found[i] = number;
                merged[i] = sum;
            }
        }
    }
)";

}  // namespace

VertexMapProbe::VertexMapProbe(Device& device, uint32_t capacity)
    : map(device, capacity,
          {[&](const std::string& file, const BufferTable& buffers) {
               return Kernel(device, compile_shader(sources(), file), buffers);
           },
           [](const std::string& file, const std::string& buffer) {
               return reflect_shader(compile_shader(sources(), file).spirv).element_bytes(buffer);
           }}),
      device_(device) {}

Kernel VertexMapProbe::kernel(const std::string& name, const std::string& text, BufferTable buffers) {
    ShaderSources all = sources();
    all.generated[name] = points_text + text;
    buffers.merge(map.buffers());
    return Kernel(device_, compile_shader(all, name), buffers);
}

void VertexMapProbe::store(const std::vector<GridPoint>& points, uint32_t groups, uint32_t expected,
                           KernelTimings* timings) {
    const Buffer in = create_buffer(device_, points, "points");
    const Kernel store = kernel("store_points", store_text, {{"Points", &in}});
    CommandList commands(device_);
    for (int run = timings ? 0 : 1; run < 2; ++run) {  // the first compiles
        map.clear(commands);
        commands.dispatch(store, groups, {{"count", uint32_t(points.size())}, {"room", 0u}});
        map.build(commands, expected);
        const std::clock_t start = std::clock();
        commands.run(run == 1 ? timings : nullptr);
        processor_seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    }
}

std::vector<std::vector<uint32_t>> VertexMapProbe::neighbours(const std::vector<GridPoint>& points,
                                                              uint32_t room) {
    return found_by("query_points", query_text, points, uint32_t(points.size()), room);
}

std::vector<std::vector<uint32_t>> VertexMapProbe::along(const std::vector<GridPoint>& ends,
                                                         const std::string& radius, uint32_t room) {
    return found_by("query_rays", "float merge_radius(vec3 p) { return " + radius + "; }\n" + rays_text, ends,
                    uint32_t(ends.size() / 2), room);
}

std::vector<std::vector<uint32_t>> VertexMapProbe::found_by(const std::string& name, const std::string& text,
                                                            const std::vector<GridPoint>& points,
                                                            uint32_t count, uint32_t room) {
    const Buffer in = create_buffer(device_, points, "points");
    Buffer found(device_, uint64_t(count) * (1 + room) * 4, "found");
    found.fill(0);
    const Kernel query = kernel(name, text, {{"Points", &in}, {"Found", &found}});
    CommandList commands(device_);
    commands.dispatch(query, std::min((count + 63) / 64, max_groups), {{"count", count}, {"room", room}});
    commands.run();
    const auto words = found.read_array<uint32_t>(uint64_t(count) * (1 + room));
    std::vector<std::vector<uint32_t>> result;
    for (size_t row = 0; row < words.size(); row += 1 + room) {
        if (words[row] > room) fail_input("{} neighbours, room for {}", words[row], room);
        result.emplace_back(words.begin() + row + 1, words.begin() + row + 1 + words[row]);
    }
    return result;
}

double VertexMapProbe::merge(const std::vector<GridPoint>& points, KernelTimings* timings) {
    const auto count = uint32_t(points.size());
    const Buffer in = create_buffer(device_, points, "points");
    const Buffer found(device_, uint64_t(count) * 4, "found"),
        merged(device_, uint64_t(count) * 12, "merged");
    const Kernel query =
        kernel("merge_points", merge_text, {{"Points", &in}, {"Found", &found}, {"Merged", &merged}});
    CommandList commands(device_);
    processor_seconds = 1e30;
    for (int run = 0; run < 6; ++run) {  // the first compiles
        commands.fill(found, 0);
        commands.dispatch(query, std::max(2u, std::min((count + 511) / 512, max_groups)),
                          {{"count", count}, {"room", 0u}});
        const std::clock_t start = std::clock();
        commands.run(run == 1 ? timings : nullptr);
        if (run > 0)
            processor_seconds = std::min(processor_seconds, double(std::clock() - start) / CLOCKS_PER_SEC);
    }
    double sum = 0;
    for (uint32_t n : found.read_array<uint32_t>(count)) sum += n;
    return sum / count;
}

std::vector<LightVertex> VertexMapProbe::vertices() const {
    return map.buffers().at("LightVertices")->read_array<LightVertex>(map.capacity());
}

std::vector<glm::vec4> VertexMapProbe::entries() const {
    return map.buffers().at("GridEntries")->read_array<glm::vec4>(map.counts().stored);
}

}  // namespace etendue
