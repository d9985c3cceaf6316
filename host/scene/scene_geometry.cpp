// Geometry and receivers: everything that has a place.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/error.h"
#include "host/scene/scene_compiler.h"
#include "host/geometry/unrolled_traversal.h"

namespace etendue {

// Contents of elements have frames of their own.
glm::dmat4 SceneCompiler::recentred(const glm::dmat4& world_from_local, uint32_t content) const {
    glm::dmat4 result = world_from_local;
    if (content == 0) result[3] -= glm::dvec4(out_.center, 0);
    return result;
}

// Of a disk or an asphere.
static void check_hole(const ObjectDescription& object, const std::string& place) {
    if (!object.parameters.contains("hole")) return;
    const double hole = object.parameters["hole"],
                 rim = object.parameters[object.class_name == "disk" ? "radius" : "aperture"];
    if (!(hole < rim))
        fail_input("{}/hole: {:g} m; allowed: less than the radius of the rim, {:g} m", place, hole, rim);
}

// Of an object that the host cuts, a record each; else none.
static std::vector<BezierPiece> pieces_of(const ClassInfo& info, const ObjectDescription& object,
                                          const std::string& place) {
    for (const Parameter& p : info.parameters) {
        if (p.member.type != "BezierPiece" || !object.parameters.contains(p.member.name)) continue;
        const std::string at = place + "/" + p.member.name;
        return cut_bezier_patches(read_bezier_patches(object.parameters[p.member.name], at), at);
    }
    return {};
}

void SceneCompiler::add_geometry() {
    std::vector<Added> shapes;
    std::vector<ShapePart> parts;
    for (const PlacedObject& shape : in_.shapes) {
        const auto index = uint32_t(&shape - in_.shapes.data());
        const std::vector<BezierPiece> pieces =
            pieces_of(use_class(Interface::geometry, shape.object), shape.object,
                      message_place(in_, shape.object.where));
        for (size_t i = 0; i < std::max<size_t>(pieces.size(), 1); ++i) {
            resolver_.piece = pieces.empty() ? nullptr : &pieces[i];
            shapes.push_back(add_record(Interface::geometry, shape.object));
            parts.push_back({index});
        }
        resolver_.piece = nullptr;
        if (shape.object.class_name == "disk" || shape.object.class_name == "asphere")
            check_hole(shape.object, message_place(in_, shape.object.where));
        if (shapes.back().info->never_emits && in_.materials[shape.material].emission)
            fail_input("{}/material: emits light, which a {} cannot; allowed: a material that does not",
                       message_place(in_, shape.object.where), shape.object.class_name);
        if (shape.object.class_name == "microstructure")
            check_microstructure(*shapes.back().info, shape.object, message_place(in_, shape.object.where));
    }
    upload_microstructures();
    const auto refs = references(Interface::geometry, shapes);
    for (size_t i = 0; i < parts.size(); ++i) parts[i].ref = refs[i];
    find_bounds(parts);
    const uint64_t key = world_key(parts);
    World& world = memory_.world;
    if (key != memory_.world_key) {
        memory_.world_key = 0;
        for (const char* name : {"Nodes", "Primitives", "Vertices", "TriangleIndices", "Transforms", "Twins"})
            memory_.buffers.erase(name);
        memory_.world_features = {};
        memory_.light_positions.clear();
        world = build_world(in_, parts, threads_, memory_.world_features);
        memory_.unrolled_traversal.clear();
        if (in_.elements.empty() && !has_bodies() && !memory_.world_features.twins &&
            !options_.varying.count("places") && device_.description.compiles_choices)
            memory_.unrolled_traversal = unroll_traversal(world, in_).glsl;
        memory_.world_key = key;
    }
    out_.features.triangles = memory_.world_features.triangles;
    out_.features.shapes = memory_.world_features.shapes;
    out_.features.instances = memory_.world_features.instances;
    out_.features.twins = memory_.world_features.twins;
    out_.features.vertex_attributes = memory_.world_features.vertex_attributes;
    out_.features.shading_normals |= memory_.world_features.shading_normals;
    out_.features.unrolled_traversal = !memory_.unrolled_traversal.empty();
    out_.sources.generated["generated/unrolled_traversal.glsl"] = memory_.unrolled_traversal;
    out_.placed = world.placed;
    const auto add_placed = [&](const std::string& name, uint32_t material) {
        out_.placed_names.push_back(name);
        out_.placed_materials.push_back(in_.materials[material].name);
    };
    for (const MeshInstance& instance : in_.instances)
        add_placed(instance.name, in_.meshes[instance.mesh].material);
    for (const PlacedObject& shape : in_.shapes) add_placed(shape.name, shape.material);
    for (const PlacedElement& element : in_.elements) add_placed(element.name, in_.boundary_material);
    out_.features.elements = !in_.elements.empty();
    out_.center = world.center;
    out_.radius = world.bounds.empty() ? 0.0f : 0.5f * glm::length(world.bounds.hi - world.bounds.lo);
    out_.triangles = world.triangles, out_.instances = world.instances, out_.shapes = in_.shapes.size();
    out_.bvh_seconds = world.statistics.seconds, out_.bvh_cost = world.statistics.sah_cost;
    out_.bvh_depth = world.statistics.depth;
}

// Of all that the world depends on but the meshes themselves.
uint64_t SceneCompiler::world_key(const std::vector<ShapePart>& parts) const {
    uint64_t key = hash_text(has_bodies() ? "bodies" : options_.varying.count("places") ? "places" : "");
    const auto add = [&](const auto& value) {
        key = hash_text({reinterpret_cast<const char*>(&value), sizeof value}, key);
    };
    for (const std::byte b : records_.at(Interface::geometry).bytes()) add(b);
    for (const ShapePart& part : parts) add(part);
    for (const PlacedObject& shape : in_.shapes) {
        key = hash_text(shape.object.class_name, key);
        add(shape.world_from_local);
        add(shape.material);
        add(shape.content);
    }
    for (const MeshInstance& instance : in_.instances) {
        add(instance.mesh);
        add(instance.world_from_local);
        add(instance.content);
    }
    for (const PlacedElement& element : in_.elements) {
        add(element.content);
        add(element.parent);
        add(element.parent_from_local);
    }
    for (const ElementContent& content : in_.contents)
        for (const MeshInstance& instance : content.boundary) add(instance.mesh);
    for (const MaterialDescription& m : in_.materials) add(m.emission.has_value());
    for (const bool watched : all_watched(in_)) add(watched);
    return key;
}

// The classes themselves say how large their objects are: on the device, so that a class needs no host code.
void SceneCompiler::find_bounds(std::vector<ShapePart>& parts) {
    if (parts.empty()) return;
    std::vector<uint32_t> refs;
    for (const ShapePart& part : parts) refs.push_back(part.ref);
    write_headers();
    upload("GeometryRecords", records_[Interface::geometry].bytes());
    const Buffer in = create_buffer(device_, refs, "ShapeRefs");
    const Buffer out(device_, refs.size() * 24, "ShapeBounds");
    run_once("kernels/bound_shapes.comp", uint32_t(refs.size()), {{"ShapeRefs", &in}, {"ShapeBounds", &out}},
             {{"count", uint32_t(refs.size())}});
    const auto corners = out.read_array<glm::vec3>(2 * refs.size());
    for (size_t i = 0; i < refs.size(); ++i) {
        parts[i].bounds = {corners[2 * i], corners[2 * i + 1]};
        const glm::vec3 size = parts[i].bounds.hi - parts[i].bounds.lo;
        if (!glm::all(glm::lessThan(size, glm::vec3(1e29f)))) {
            const ObjectDescription& object = in_.shapes[parts[i].shape].object;
            fail_input("{}: no {} has these parameters together; see: etendue classes {}",
                       message_place(in_, object.where), object.class_name, object.class_name);
        }
    }
}

void SceneCompiler::upload_world() {
    share("Nodes", memory_.world.nodes);
    share("Primitives", memory_.world.primitives);
    share("Vertices", memory_.world.vertices);
    share("TriangleIndices", memory_.world.triangle_indices);
    share("Transforms", memory_.world.transforms);
    if (out_.features.twins) share("Twins", memory_.world.twins);
}

// Of classes with the parameter "resolution".
static void fix_resolution(Receiver& receiver, const std::string& where) {
    for (const Parameter& p : receiver.info->parameters) {
        if (p.member.name != "resolution") continue;
        const auto pixels =
            receiver.parameters.value(p.member.name, p.default_value).get<std::vector<double>>();
        for (const double n : pixels)
            if (n != std::round(n))
                fail_input("{}/resolution: {} is not a number of pixels; allowed: whole numbers", where, n);
        receiver.columns = uint32_t(pixels.at(0)), receiver.rows = uint32_t(pixels.at(1));
    }
}

WatchedSurface SceneCompiler::add_watched(const std::string& mesh, const std::string& where) {
    const std::string place = message_place(in_, where);
    const std::vector<uint32_t> instances = watched_instances(in_, mesh, where);
    if (instances.empty() && mesh.empty())
        fail_input("{}: its node has no mesh; allowed there, or with a mesh: the name of one, or of its node",
                   place);
    if (instances.empty()) fail_input("{}: there is no mesh, and no node with one, called {}", place, mesh);
    for (const uint32_t i : instances) {
        if (in_.instances[i].content != 0)
            fail_input("{}: {} is within an optical element; allowed: a mesh of the scene", place,
                       in_.instances[i].name);
        const MaterialDescription& material = in_.materials[in_.meshes[in_.instances[i].mesh].material];
        if (material.priority > 0)
            fail_input("{}: {} bounds a body with a priority; allowed: a mesh without", place, material.name);
    }
    const WatchedSurface surface = append_watched(watched_words_, memory_.world, instances);
    if (surface.count == 0 || surface.count > most_watched_triangles)
        fail_input("{}: its mesh has {} triangles; allowed: 1 to {}", place, surface.count,
                   most_watched_triangles);
    watched_.push_back(surface);
    return surface;
}

void SceneCompiler::add_receivers() {
    std::vector<PlacedObject> all = in_.receivers;
    if (all.empty() && out_.radius > 0) {
        // glTF leaves the view to the program where a file has no camera: the whole scene from the front, a
        // little above.
        const double yfov = 0.6;
        const glm::dvec3 from =
            glm::normalize(glm::dvec3(0.35, 0.25, 1.0)) * (double(out_.radius) / std::sin(yfov / 2));
        const glm::dmat4 placement =
            glm::inverse(glm::lookAt(from + out_.center, out_.center, glm::dvec3(0, 1, 0)));
        all.push_back({"(default)", {"perspective", {{"yfov", yfov}}, ""}, placement, 0});
        out_.warnings.push_back(
            fmt::format("{}: the scene has no camera: all of it is shown from the front", in_.file.string()));
    }
    std::vector<Added> added;
    for (const PlacedObject& receiver : all) {
        ObjectDescription object = receiver.object;
        const float aspect = object.parameters.value("aspect_ratio", 0.0f);
        object.parameters.erase("aspect_ratio");  // of the image, not of the receiver's record
        added.push_back(
            add_record(Interface::receiver, object, recentred(receiver.world_from_local, receiver.content)));
        out_.receivers.push_back({receiver.name, no_record, aspect, 0, 0, receiver.wants_stokes,
                                  added.back().info, object.parameters, receiver.world_from_local});
        out_.receivers.back().element = element_of(receiver.content);
        if (receiver.content != 0 && (added.back().info->is_far || added.back().info->on_surface))
            fail_input(
                "{}: a receiver of class {} cannot be within an optical element; allowed: in the scene",
                message_place(in_, object.where), object.class_name);
        fix_resolution(out_.receivers.back(), message_place(in_, object.where));
        if (!added.back().info->on_surface) continue;
        Receiver& meter = out_.receivers.back();
        meter.watched = watched_.back();
        meter.columns = meter.watched.columns,
        meter.rows = uint32_t(std::size(surface_parts)) * meter.watched.rows;
    }
    if (out_.features.surface_meters) upload("WatchedWords", watched_words_);
    const auto refs = references(Interface::receiver, added);
    for (size_t i = 0; i < refs.size(); ++i) out_.receivers[i].ref = refs[i];
}

void move_receiver(Scene& scene, size_t index, const glm::dmat4& world_from_local,
                   const nlohmann::json& parameters) {
    Receiver& receiver = scene.receivers.at(index);
    SceneDescription place;  // for messages
    place.file = "receiver " + receiver.name;
    glm::dmat4 placement = world_from_local;
    if (receiver.element == 0) placement[3] -= glm::dvec4(scene.center, 0);
    const double volume = glm::determinant(glm::dmat3(placement));
    if (!std::isfinite(volume) || volume == 0)
        fail_input("{}: its placement squashes space flat", place.file.string());
    RecordResolver resolver{place};
    resolver.watched = [&](const std::string&, const std::string&) { return receiver.watched; };
    const std::vector<std::byte> record =
        fill_record(*receiver.info, {receiver.info->name, parameters, ""}, placement, resolver);
    scene.buffers.at("ReceiverRecords")
        .write(record.data(), record.size(), uint64_t(record_index(receiver.ref)) * receiver.info->stride);
    receiver.parameters = parameters;
    receiver.world_from_local = world_from_local;
    ++scene.receiver_moves;
}

}  // namespace etendue
