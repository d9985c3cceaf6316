#include "tests/support/geometry_probe.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "tests/support/light_probe.h"

namespace etendue {
namespace {

// The brute force knows an instance's triangles from words that traversal does not read: v1.x first, v1.y
// count.
const char* const trace_kernel = R"(
    #include "lib/primitives.glsl"
    layout(local_size_x = 64) in;
    struct Ray { vec3 origin; float t_max; vec3 direction; float unused; };
    struct Trace { Hit hit; Hit expected; uint occluded; vec3 position, error, geometric_normal, shading_normal, onward; };
    layout(scalar, set = 0) readonly buffer Rays { Ray rays[]; };
    layout(scalar, set = 0) writeonly buffer Traces { Trace traces[]; };
    layout(push_constant) uniform Push { uint count, world_primitives, brute_force; };

    void meet(uint i, uint instance, vec3 origin, vec3 direction, inout Hit best) {
        Triangle r = primitives[i];
        GeometryHit hit;
        bool met = false;
        if (attributes_kind(r.attributes) == KIND_TRIANGLE) met = triangle_intersect(r, origin, direction, best.t, hit);
    #if HAS_SHAPES
        if (attributes_kind(r.attributes) == KIND_SHAPE) {
            mat4x3 m = transform_at(floatBitsToUint(r.v0.y)).local_from_world;
            met = geometry_intersect(floatBitsToUint(r.v0.x), m * vec4(origin, 1.0), m * vec4(direction, 0.0), best.t, hit);
        }
    #endif
        if (met) best = Hit(hit.t, hit.uv, i, instance);
    }

    Hit try_all(vec3 origin, vec3 direction, float t_max) {
        Hit best = Hit(t_max, vec2(0), NO_RECORD, NO_RECORD);
        for (uint i = 0u; i < world_primitives; i++) {
            Triangle r = primitives[i];
            if (attributes_kind(r.attributes) != KIND_INSTANCE) {
                meet(i, NO_RECORD, origin, direction, best);
                continue;
            }
    #if HAS_INSTANCES
            mat4x3 m = transform_at(floatBitsToUint(r.v0.y)).local_from_world;
            vec3 o = m * vec4(origin, 1.0), d = m * vec4(direction, 0.0);
            uint first = floatBitsToUint(r.v1.x), end = first + floatBitsToUint(r.v1.y);
            for (uint j = first; j < end; j++) meet(j, i, o, d, best);
    #endif
        }
        return best;
    }

    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        Ray r = rays[i];
        Trace t;
        t.hit = find_hit(r.origin, r.direction, r.t_max);
        t.expected = t.hit;
        if (brute_force != 0u) t.expected = try_all(r.origin, r.direction, r.t_max);
        t.occluded = find_occlusion(r.origin, r.direction, r.t_max) ? 1u : 0u;
        t.position = t.error = t.geometric_normal = t.shading_normal = t.onward = vec3(0);
        if (t.hit.primitive != NO_RECORD) {
            SurfacePoint p = locate(t.hit, r.origin, r.direction);
            t.position = p.position;
            t.error = p.error;
            t.geometric_normal = p.geometric_normal;
            t.shading_normal = p.shading_normal;
            t.onward = offset_origin(p.position, p.error, p.geometric_normal, r.direction);
        }
        traces[i] = t;
    }
)";

Box box_of(const PrimitiveRecord& p) {
    Box box;
    box.grow(p.v0), box.grow(p.v1), box.grow(p.v2);
    return box;
}

PrimitiveRecord triangle_record(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return {a, 0, b, no_record, c, 0};
}

}  // namespace

GeometryProbe::GeometryProbe() : registry_(test_sources()), sources_(test_sources()) {}

void GeometryProbe::add_triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    placed_.push_back(triangle_record(a, b, c));
    boxes_.push_back(box_of(placed_.back()));
}

void GeometryProbe::place(const glm::dmat4& world_from_local, PrimitiveKind kind, const Box& local) {
    PrimitiveRecord p{};
    p.v0.y = std::bit_cast<float>(uint32_t(world_.transforms.size()));
    p.light = no_record;
    p.attributes = uint32_t(kind) << 30;
    placed_.push_back(p);
    Box box;
    for (int corner = 0; corner < 8; corner++)
        box.grow(glm::vec3(world_from_local * glm::dvec4(corner & 1 ? local.hi.x : local.lo.x,
                                                         corner & 2 ? local.hi.y : local.lo.y,
                                                         corner & 4 ? local.hi.z : local.lo.z, 1)));
    boxes_.push_back(box);
    world_.transforms.push_back(transform_record(world_from_local));
    shapes_.emplace_back(nullptr, 0);
    instance_meshes_.push_back(0);
}

void GeometryProbe::add_shape(const std::string& class_name, const nlohmann::json& parameters,
                              const Box& local, const glm::dmat4& world_from_local) {
    const ClassInfo* info = registry_.find(Interface::geometry, class_name);
    REQUIRE(info);
    RecordResolver resolver = micro_.resolver(scene_);
    std::vector<BezierPiece> pieces;
    if (class_name == "bezier_patch")
        pieces =
            cut_bezier_patches(read_bezier_patches(parameters["control_points"], "/geometry"), "/geometry");
    for (size_t i = 0; i < std::max<size_t>(pieces.size(), 1); ++i) {
        if (!pieces.empty()) resolver.piece = &pieces[i];
        scene_.shapes.push_back({class_name, {class_name, parameters, "/geometry"}, world_from_local, 0});
        place(world_from_local, PrimitiveKind::shape,
              pieces.empty() ? local : Box{pieces[i].lo, pieces[i].hi});
        shapes_.back() = {info, records_.count(*info)};
        records_.add(*info, fill_record(*info, {class_name, parameters, "/geometry"}, {}, resolver));
    }
}

uint32_t GeometryProbe::add_cell(const std::vector<glm::vec3>& corners) {
    scene_.cells.push_back({corners});
    return uint32_t(scene_.cells.size() - 1);
}

uint32_t GeometryProbe::add_mesh(const std::vector<glm::vec3>& vertices) {
    Mesh mesh;
    for (size_t i = 0; i + 2 < vertices.size(); i += 3) {
        mesh.triangles.push_back(triangle_record(vertices[i], vertices[i + 1], vertices[i + 2]));
        mesh.bounds.grow(box_of(mesh.triangles.back()));
    }
    meshes_.push_back(mesh);
    return uint32_t(meshes_.size() - 1);
}

void GeometryProbe::add_instance(uint32_t mesh, const glm::dmat4& world_from_local) {
    place(world_from_local, PrimitiveKind::instance, meshes_[mesh].bounds);
    instance_meshes_.back() = mesh;
}

void GeometryProbe::build() {
    const auto add_tree = [&](const std::vector<PrimitiveRecord>& primitives, const std::vector<Box>& boxes) {
        const Bvh bvh = build_bvh(boxes, 2);
        const auto first = uint32_t(world_.primitives.size());
        for (uint32_t i : bvh.order) world_.primitives.push_back(primitives[i]);
        return std::pair(encode_bvh(bvh, first, world_.nodes), first);
    };
    add_tree(placed_, boxes_);
    world_.world_primitives = uint32_t(placed_.size());
    std::vector<std::pair<uint32_t, uint32_t>> trees;
    for (const Mesh& mesh : meshes_) {
        std::vector<Box> boxes;
        for (const PrimitiveRecord& p : mesh.triangles) boxes.push_back(box_of(p));
        trees.push_back(add_tree(mesh.triangles, boxes));
    }
    records_.layout();
    Features& features = features_;
    std::vector<const ClassInfo*> classes;
    for (const ClassInfo& info : registry_.classes(Interface::geometry))
        if (info.name != "triangle") classes.push_back(&info);
    features.triangles = !meshes_.empty();
    for (uint32_t i = 0; i < world_.world_primitives; i++) {
        PrimitiveRecord& p = world_.primitives[i];
        const PrimitiveKind kind = primitive_kind(p);
        features.triangles |= kind == PrimitiveKind::triangle;
        features.shapes |= kind == PrimitiveKind::shape;
        features.instances |= kind == PrimitiveKind::instance;
        if (kind == PrimitiveKind::triangle) continue;
        const auto transform = std::bit_cast<uint32_t>(p.v0.y);
        if (kind == PrimitiveKind::shape) {
            const auto& [info, nth] = shapes_[transform];
            p.v0.x = std::bit_cast<float>(records_.ref(*info, nth));
        } else {
            const uint32_t mesh = instance_meshes_[transform];
            p.v0.x = std::bit_cast<float>(trees[mesh].first);
            p.v1.x = std::bit_cast<float>(trees[mesh].second);
            p.v1.y = std::bit_cast<float>(uint32_t(meshes_[mesh].triangles.size()));
        }
    }
    for (const Box& box : boxes_) world_.bounds.grow(box);
    nodes_ = create_buffer(test_device(), world_.nodes, "nodes");
    primitives_ = create_buffer(test_device(), world_.primitives, "primitives");
    transforms_ = create_buffer(test_device(), world_.transforms, "transforms");
    geometry_ = create_buffer(test_device(), records_.bytes(), "geometry records");
    sources_.generated["generated/geometry_classes.glsl"] =
        class_header(interface_info(Interface::geometry), classes);
}

UnrolledTraversal GeometryProbe::unroll() {
    UnrolledTraversal unrolled = unroll_traversal(world_, scene_);
    if (unrolled.glsl.empty()) return unrolled;
    nodes_ = create_buffer(test_device(), world_.nodes, "nodes");
    sources_.generated["generated/unrolled_traversal.glsl"] = unrolled.glsl;
    features_.unrolled_traversal = true;
    return unrolled;
}

Kernel GeometryProbe::kernel(const std::string& name, const std::string& text, BufferTable buffers,
                             const std::string& defines) {
    ShaderSources sources = sources_;
    if (!text.empty()) sources.generated[name] = text;
    CompileOptions options;
    options.defines = features_.defines() + defines;
    buffers["Nodes"] = &nodes_;
    buffers["Primitives"] = &primitives_;
    buffers["Transforms"] = &transforms_;
    buffers[interface_info(Interface::geometry).buffer] = &geometry_;
    micro_.bind(buffers);
    return Kernel(test_device(), compile_shader(sources, name, options), buffers);
}

std::vector<ProbeTrace> GeometryProbe::trace(const std::vector<ProbeRay>& rays, bool brute_force) {
    const auto count = uint32_t(rays.size());
    const Buffer in = create_buffer(test_device(), rays, "rays");
    const Buffer out(test_device(), count * sizeof(ProbeTrace), "traces");
    const Kernel trace = kernel("trace_rays", trace_kernel, {{"Rays", &in}, {"Traces", &out}});
    CommandList list(test_device());
    list.dispatch(trace, (count + 63) / 64,
                  {{"count", count},
                   {"world_primitives", world_.world_primitives},
                   {"brute_force", uint32_t(brute_force)}});
    list.run();
    return out.read_array<ProbeTrace>(count);
}

std::vector<ProbeHit> GeometryProbe::find_hits(const std::vector<ProbeRay>& rays) {
    const auto count = uint32_t(rays.size());
    std::vector<glm::vec4> origins, directions;
    for (const ProbeRay& r : rays)
        origins.emplace_back(r.origin, 0), directions.emplace_back(r.direction, r.t_max);
    const Buffer o = create_buffer(test_device(), origins, "ray origins");
    const Buffer d = create_buffer(test_device(), directions, "ray directions");
    const Buffer hits(test_device(), count * sizeof(ProbeHit), "hits");
    const Kernel find =
        kernel("kernels/find_hits.comp", "", {{"RayOrigins", &o}, {"RayDirections", &d}, {"Hits", &hits}});
    CommandList list(test_device());
    list.dispatch(find, std::max(1u, count / 64 / 16), {{"ray_count", count}});
    list.run();
    return hits.read_array<ProbeHit>(count);
}

std::vector<glm::vec3> icosphere(int subdivisions, float radius) {
    const double g = (1 + std::sqrt(5.0)) / 2;
    const glm::dvec3 p[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<glm::dvec3> corners;
    for (const auto& face : faces)
        for (int k : face) corners.push_back(glm::normalize(p[k]));
    for (int level = 0; level < subdivisions; level++) {
        std::vector<glm::dvec3> finer;
        for (size_t i = 0; i < corners.size(); i += 3) {
            const glm::dvec3 a = corners[i], b = corners[i + 1], c = corners[i + 2];
            const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                             ca = glm::normalize(c + a);
            finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
        corners = std::move(finer);
    }
    std::vector<glm::vec3> result;
    for (const glm::dvec3& c : corners) result.push_back(glm::vec3(c * double(radius)));
    return result;
}

}  // namespace etendue
