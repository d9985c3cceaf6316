#include "host/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <thread>

#include "host/error.h"
#include "host/scene/image_file.h"
#include "host/scene/light_tree.h"
#include "host/scene/texture_pack.h"
#include "host/scene/unrolled_traversal.h"

namespace etendue {
namespace {

using nlohmann::json;

// Twin of struct Material in shaders/lib/materials.glsl; a test compares the layouts.
struct MaterialRecord {
    glm::vec4 emission, mean_emission;
    uint32_t surface, inside, outside, flags, emission_texture, normal_texture;
    float normal_scale;
    uint32_t reserved;
};
constexpr uint32_t emits_both_sides = 1, separates_media = 2, opaque = 4;

glm::dmat4 recentred(const Scene& scene, const glm::dmat4& m) {
    glm::dmat4 result = m;
    result[3] -= glm::dvec4(scene.center, 0);
    return result;
}

// Builds a Scene step by step; each step needs what the ones before it made.
class SceneCompiler {
  public:
    SceneCompiler(Device& device, const SceneDescription& description, const SceneOptions& options)
        : device_(device), in_(description), options_(options),
          threads_(options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency())),
          resolver_{description, {}, {}, {}} {
        resolver_.texture = [this](const json& info, bool color, const std::string& where) {
            const auto content = color ? TextureContent::color : TextureContent::data;
            return texture_index(textures_, parse_texture_info(info, content, in_.textures, message_place(in_, where)));
        };
        resolver_.environment_map = [this](const std::filesystem::path& file, const std::string&) {
            EnvironmentMap map = build_environment_map(read_image_file(file.is_absolute() ? file : in_.folder / file));
            map.ref.first = uint32_t(environment_texels_.size());
            environment_texels_.insert(environment_texels_.end(), map.texels.begin(), map.texels.end());
            return map.ref;
        };
    }

    Scene run() {
        out_.warnings = in_.warnings;
        out_.cache_folder = options_.cache_folder;
        out_.sources.folder = options_.shaders;
        out_.registry = std::make_unique<ClassRegistry>(out_.sources);
        add_class_files();
        for (const PlacedObject& element : in_.elements)
            fail_input("{}: optical elements are not available in this version", message_place(in_, element.object.where));
        add_media();
        add_materials();
        add_geometry();
        if (world_.bounds.empty() && !in_.environment && options_.environment.empty())
            fail_input("{}: the scene is empty: it has neither geometry nor an environment", in_.file.string());
        add_receivers();
        add_lights();
        add_textures();
        write_headers();
        measure_lights();
        return std::move(out_);
    }

  private:
    const ClassInfo& use_class(Interface interface, const ObjectDescription& object) {
        const ClassInfo* info = out_.registry->find(interface, object.class_name);
        if (!info) {
            std::string names;
            for (const ClassInfo& known : out_.registry->classes(interface)) names += (names.empty() ? "" : ", ") + known.name;
            fail_input("{}/class: there is no {} class {}; allowed: {}", message_place(in_, object.where),
                       interface_info(interface).name, object.class_name, names.empty() ? "none" : names);
        }
        auto& used = out_.classes[interface];
        const auto place = std::lower_bound(used.begin(), used.end(), info, [](auto* a, auto* b) { return a->tag < b->tag; });
        if (place == used.end() || *place != info) used.insert(place, info);
        return *info;
    }

    // Adds a record and returns where its reference can be looked up once all records of the interface are there.
    struct Added { const ClassInfo* info; uint32_t nth; };
    Added add_record(Interface interface, const ObjectDescription& object, const std::optional<glm::dmat4>& placement = {}) {
        const ClassInfo& info = use_class(interface, object);
        RecordBuffer& records = records_[interface];
        records.add(info, fill_record(info, object, placement, resolver_));
        return {&info, records.count(info) - 1};
    }
    std::vector<uint32_t> references(Interface interface, const std::vector<Added>& added) {
        records_[interface].layout();
        std::vector<uint32_t> refs;
        for (const Added& a : added) refs.push_back(records_[interface].ref(*a.info, a.nth));
        return refs;
    }

    template <class T>
    void upload(const std::string& name, const std::vector<T>& data) {
        out_.buffers[name] = create_buffer(device_, data, name);
    }

    // An array that may exceed a binding: its address goes into the buffer LargeArrays (lib/large_arrays.glsl).
    template <class T>
    void upload_large(const std::string& name, const std::vector<T>& data, uint32_t slot, bool& by_address) {
        upload(name, data);
        const uint64_t limit = options_.binding_bytes ? options_.binding_bytes : device_.description.max_buffer_range;
        by_address = out_.buffers[name].bytes() > limit;
        large_arrays_[slot] = out_.buffers[name].address();
        upload("LargeArrays", std::vector<uint64_t>(large_arrays_, large_arrays_ + 6));
    }

    void add_class_files() {
        for (const ClassFileDescription& file : in_.class_files) {
            const auto& interfaces = all_interfaces();
            const auto found = std::find_if(interfaces.begin(), interfaces.end(), [&](auto& i) { return file.interface == i.name; });
            if (found == interfaces.end())
                fail_input("{}/interface: there is no interface {}; allowed: geometry, light, receiver, surface, medium, element",
                           message_place(in_, file.where), file.interface);
            out_.registry->add_class_file(found->interface, file.file.is_absolute() ? file.file : in_.folder / file.file);
        }
    }

    void add_media() {
        std::vector<Added> added;
        for (const MediumDescription& medium : in_.media) added.push_back(add_record(Interface::medium, medium.medium));
        const auto refs = references(Interface::medium, added);
        for (size_t i = 0; i < refs.size(); ++i) resolver_.media[in_.media[i].name] = refs[i];
        out_.features.media = out_.features.interfaces = !refs.empty();
    }

    uint32_t medium_ref(const std::string& name, const std::string& where) {
        if (name.empty()) return no_record;
        const auto found = resolver_.media.find(name);
        if (found == resolver_.media.end()) fail_input("{}: {} is not the name of a medium", message_place(in_, where), name);
        return found->second;
    }

    void add_materials() {
        std::vector<Added> surfaces;
        for (const MaterialDescription& m : in_.materials) {
            MaterialRecord record{};
            record.inside = medium_ref(m.inside, m.surface.where);
            record.outside = medium_ref(m.outside, m.surface.where);
            if (m.double_sided) record.flags |= emits_both_sides;
            if (!m.inside.empty() || !m.outside.empty()) record.flags |= separates_media;
            record.emission_texture = record.normal_texture = no_record;
            if (m.normal_texture.is_object()) {
                record.normal_texture = resolver_.texture(m.normal_texture, false, m.surface.where + "/normalTexture");
                record.normal_scale = m.normal_texture.value("scale", 1.0f);
                out_.features.normal_maps = true;
            }
            if (m.emission) fill_emission(*m.emission, record);
            surfaces.push_back(add_record(Interface::surface, m.surface));
            materials_.push_back(record);
        }
        const auto refs = references(Interface::surface, surfaces);
        for (size_t i = 0; i < refs.size(); ++i) materials_[i].surface = refs[i];
        out_.materials = materials_.size();
        ask_opacity();
    }

    void ask_opacity() {
        if (materials_.empty()) return;
        const uint32_t count = uint32_t(materials_.size());
        write_headers();
        upload("SurfaceRecords", records_[Interface::surface].bytes());
        upload("MediumRecords", records_[Interface::medium].bytes());
        upload("Materials", materials_);
        const Buffer out(device_, count * 4, "MaterialOpacity");
        run_once("kernels/measure_materials.comp", count, {{"MaterialOpacity", &out}}, {{"count", count}});
        const auto is_opaque = out.read_array<uint32_t>(count);
        for (uint32_t i = 0; i < count; ++i) {
            if (is_opaque[i]) materials_[i].flags |= opaque;
            else out_.features.straight = true;
        }
    }

    // One dispatch of a kernel that asks the classes something, a lane an item.
    void run_once(const std::string& file, uint32_t items, const BufferTable& buffers, std::initializer_list<PushValue> values) {
        const Kernel kernel = make_kernel(device_, out_, file, buffers);
        CommandList list(device_);
        list.dispatch(kernel, (items + kernel.group_size() - 1) / kernel.group_size(), values);
        list.run();
    }

    void fill_emission(const EmissionDescription& e, MaterialRecord& record) {
        glm::vec3 value = spectral_value(e.value, in_, e.where);
        if (!e.spectrum.is_null()) {
            glm::vec3 spectrum = spectral_value(e.spectrum, in_, e.where + "/spectrum");
            if (e.quantity != EmissionDescription::Quantity::radiance) {
                // Photometric quantities and powers fix the scale: the spectrum only gives the colour.
                const float y = glm::dot(spectrum, glm::vec3(0.2126f, 0.7152f, 0.0722f));
                if (!(y > 0)) fail_input("{}/spectrum: must not be black", message_place(in_, e.where));
                spectrum /= y;
            }
            value *= spectrum;
        }
        if (glm::any(glm::lessThan(value, glm::vec3(0)))) fail_input("{}: emission must not be negative", message_place(in_, e.where));
        record.emission = record.mean_emission = glm::vec4(value, 0);
        if (e.texture.is_object()) {
            record.emission_texture = resolver_.texture(e.texture, true, e.where);
            record.mean_emission *= mean_color(in_.images[textures_[record.emission_texture].image]);
        }
    }

    static glm::vec4 mean_color(const ImageDescription& image) {
        glm::dvec3 sum(0);
        const size_t count = size_t(image.width) * image.height;
        const auto linear = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
        double table[256];
        for (int i = 0; i < 256; ++i) table[i] = linear(i / 255.0);
        for (size_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c)
                sum[c] += image.rgba32f.empty() ? table[image.rgba8[4 * i + c]] : double(image.rgba32f[4 * i + c]);
        return glm::vec4(glm::vec3(sum / double(std::max<size_t>(count, 1))), 0);
    }

    void add_geometry() {
        std::vector<Added> shapes;
        for (const PlacedObject& shape : in_.shapes) shapes.push_back(add_record(Interface::geometry, shape.object));
        const auto refs = references(Interface::geometry, shapes);
        world_ = build_world(in_, shape_bounds(refs), refs, threads_, out_.features);
        const UnrolledTraversal unrolled = unroll_traversal(world_, in_);
        out_.features.unrolled_traversal = !unrolled.glsl.empty();
        out_.sources.generated["generated/unrolled_traversal.glsl"] = unrolled.glsl;
        out_.center = world_.center;
        out_.radius = world_.bounds.empty() ? 0.0f : 0.5f * glm::length(world_.bounds.hi - world_.bounds.lo);
        out_.triangles = world_.triangles, out_.instances = world_.instances, out_.shapes = in_.shapes.size();
        out_.bvh_seconds = world_.statistics.seconds, out_.bvh_cost = world_.statistics.sah_cost;
        out_.bvh_depth = world_.statistics.depth;
    }

    // The classes themselves say how large their objects are: on the device, so that a class needs no host code.
    std::vector<Box> shape_bounds(const std::vector<uint32_t>& refs) {
        if (refs.empty()) return {};
        write_headers();
        upload("GeometryRecords", records_[Interface::geometry].bytes());
        const Buffer in = create_buffer(device_, refs, "ShapeRefs");
        const Buffer out(device_, refs.size() * 24, "ShapeBounds");
        run_once("kernels/bound_shapes.comp", uint32_t(refs.size()), {{"ShapeRefs", &in}, {"ShapeBounds", &out}},
                 {{"count", uint32_t(refs.size())}});
        const auto corners = out.read_array<glm::vec3>(2 * refs.size());
        std::vector<Box> boxes;
        for (size_t i = 0; i < refs.size(); ++i) boxes.push_back({corners[2 * i], corners[2 * i + 1]});
        return boxes;
    }

    void add_receivers() {
        std::vector<Added> added;
        for (const PlacedObject& receiver : in_.receivers) {
            ObjectDescription object = receiver.object;
            const float aspect = object.parameters.value("aspect_ratio", 0.0f);
            object.parameters.erase("aspect_ratio");  // of the image, not of the receiver's record
            added.push_back(add_record(Interface::receiver, object, recentred(out_, receiver.world_from_local)));
            out_.receivers.push_back({receiver.name, no_record, aspect});
        }
        if (in_.receivers.empty() && out_.radius > 0) {
            // glTF leaves the view to the program where a file has no camera: the whole scene from the front, a little above.
            const double yfov = 0.6;
            const glm::dvec3 from = glm::normalize(glm::dvec3(0.35, 0.25, 1.0)) * (double(out_.radius) / std::sin(yfov / 2));
            const glm::dmat4 placement = glm::inverse(glm::lookAt(from, glm::dvec3(0), glm::dvec3(0, 1, 0)));
            added.push_back(add_record(Interface::receiver, {"perspective", {{"yfov", yfov}}, ""}, placement));
            out_.receivers.push_back({"(default)", no_record, 0});
            out_.warnings.push_back(fmt::format("{}: the scene has no camera: all of it is shown from the front", in_.file.string()));
        }
        const auto refs = references(Interface::receiver, added);
        for (size_t i = 0; i < refs.size(); ++i) out_.receivers[i].ref = refs[i];
    }

    // Lights at infinity come first in the list (lib/light_selection.glsl).
    void add_lights() {
        std::vector<Added> finite, infinite;
        if (!options_.environment.empty()) {
            ObjectDescription image{"image", {{"file", std::filesystem::absolute(options_.environment).string()}}, "--environment"};
            infinite.push_back(add_record(Interface::light, image));
        } else if (in_.environment) {
            infinite.push_back(add_record(Interface::light, *in_.environment));
        }
        for (const PlacedObject& light : in_.lights) {
            const Added added = add_record(Interface::light, light.object, recentred(out_, light.world_from_local));
            finite.push_back(added);  // sorted by what measure_lights finds
        }
        std::vector<Added> area;
        std::vector<uint32_t> area_primitives;
        const ClassInfo* info = nullptr;
        for (uint32_t i = 0; i < world_.world_primitives; ++i) {
            const PrimitiveRecord& p = world_.primitives[i];
            if (primitive_kind(p) == PrimitiveKind::instance) continue;
            const glm::vec4 e = materials_[p.material].emission;
            if (!(e.x > 0 || e.y > 0 || e.z > 0)) continue;
            if (!info) info = &use_class(Interface::light, {"area", json::object(), ""});
            records_[Interface::light].add(*info, area_record(*info, i, p.material));
            area.push_back({info, records_[Interface::light].count(*info) - 1});
            area_primitives.push_back(i);
        }
        std::vector<Added> all = infinite;
        all.insert(all.end(), finite.begin(), finite.end());
        all.insert(all.end(), area.begin(), area.end());
        lights_ = references(Interface::light, all);
        first_area_light_ = uint32_t(infinite.size() + finite.size());
        area_primitives_ = std::move(area_primitives);
        out_.lights = lights_.size();
        out_.features.light_count = uint32_t(lights_.size());
    }

    static std::vector<std::byte> area_record(const ClassInfo& info, uint32_t primitive, uint32_t material) {
        std::vector<std::byte> record(info.stride);
        for (const Parameter& p : info.parameters) {
            if (p.member.name == "primitive") std::memcpy(record.data() + p.member.offset, &primitive, 4);
            if (p.member.name == "material") std::memcpy(record.data() + p.member.offset, &material, 4);
        }
        return record;
    }

    void add_textures() {
        out_.features.textures = !textures_.empty();
        out_.textures = textures_.size();
        if (textures_.empty()) return;
        const PackedTextures packed = pack_textures(in_.images, textures_);
        out_.features.texture_formats = packed.formats;
        upload_large("Texels", packed.texels, 4, out_.features.texels_by_address);
        upload("Textures", packed.textures);
    }

    void write_headers() {
        for (const InterfaceInfo& interface : all_interfaces()) {
            const auto& classes = out_.classes[interface.interface];
            std::map<std::string, std::string> constants;
            for (const ClassInfo* info : classes) constants[info->name] = records_[interface.interface].constant_members(*info);
            out_.sources.generated[fmt::format("generated/{}_classes.glsl", interface.name)] =
                class_header(interface, classes, constants);
        }
        for (const auto& [name, text] : out_.registry->sources().generated) out_.sources.generated[name] = text;
    }

    void upload_world() {
        Features& f = out_.features;
        upload_large("Nodes", world_.nodes, 0, f.nodes_by_address);
        upload_large("Primitives", world_.primitives, 1, f.primitives_by_address);
        upload_large("Vertices", world_.vertices, 2, f.vertices_by_address);
        upload_large("TriangleIndices", world_.triangle_indices, 3, f.triangle_indices_by_address);
        upload("Transforms", world_.transforms);
    }

    // Power and extent of every light, found out by the classes on the device; then the order of the list, the tree, and
    // the scale of materials whose emission is given as the power of the whole object.
    void measure_lights() {
        for (const InterfaceInfo& interface : all_interfaces())
            upload(interface.buffer, records_[interface.interface].bytes());
        upload_large("EnvironmentTexels", environment_texels_, 5, out_.features.environment_texels_by_address);
        upload("Materials", materials_);
        upload_world();
        upload("Lights", lights_);
        if (lights_.empty()) {
            upload("LightNodes", std::vector<uint32_t>());
            upload("LightTrails", std::vector<uint32_t>());
            return;
        }
        std::vector<LightBounds> bounds = run_measurement();
        scale_powers(bounds);

        std::vector<uint32_t> order(lights_.size());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::stable_partition(order.begin(), order.end(), [&](uint32_t i) { return is_at_infinity(bounds[i]); });
        std::vector<uint32_t> sorted_lights;
        std::vector<LightBounds> sorted_bounds;
        for (uint32_t position = 0; position < order.size(); ++position) {
            const uint32_t i = order[position];
            sorted_lights.push_back(lights_[i]);
            sorted_bounds.push_back(bounds[i]);
            out_.power += bounds[i].power;
            if (i >= first_area_light_) world_.primitives[area_primitives_[i - first_area_light_]].light = position;
        }
        const LightTree tree = build_light_tree(sorted_bounds);
        out_.features.light_tree = tree.is_tree;
        out_.features.infinite_light_count = tree.infinite_count;
        upload("Lights", sorted_lights);
        upload("LightNodes", tree.nodes);
        upload("LightTrails", tree.trails);
        out_.buffers["Primitives"].write(world_.primitives.data(), world_.primitives.size() * sizeof(PrimitiveRecord));
    }

    std::vector<LightBounds> run_measurement() {
        const Buffer out(device_, lights_.size() * sizeof(LightBounds), "LightBoundsTable");
        const uint32_t count = uint32_t(lights_.size());
        run_once("kernels/measure_lights.comp", count, {{"LightBoundsTable", &out}},
                 {{"light_count", count}, {"scene_radius", out_.radius}});
        return out.read_array<LightBounds>(count);
    }

    void scale_powers(std::vector<LightBounds>& bounds) {
        using Quantity = EmissionDescription::Quantity;
        std::vector<double> totals(materials_.size());
        for (size_t i = 0; i < area_primitives_.size(); ++i)
            totals[world_.primitives[area_primitives_[i]].material] += bounds[first_area_light_ + i].power;
        std::vector<float> scales(materials_.size(), 1.0f);
        bool changed = false;
        for (size_t m = 0; m < materials_.size(); ++m) {
            const auto& e = in_.materials[m].emission;
            if (!e || totals[m] <= 0 || (e->quantity != Quantity::power && e->quantity != Quantity::flux)) continue;
            const double wanted = glm::dot(spectral_value(e->value, in_, e->where), glm::vec3(0.2126f, 0.7152f, 0.0722f));
            scales[m] = float(wanted / totals[m]);
            materials_[m].emission *= scales[m];
            materials_[m].mean_emission *= scales[m];
            changed = true;
        }
        if (!changed) return;
        for (size_t i = 0; i < area_primitives_.size(); ++i)
            bounds[first_area_light_ + i].power *= scales[world_.primitives[area_primitives_[i]].material];
        upload("Materials", materials_);
    }

    Device& device_;
    const SceneDescription& in_;
    const SceneOptions& options_;
    unsigned threads_;
    Scene out_;
    RecordResolver resolver_;
    std::map<Interface, RecordBuffer> records_;
    std::vector<TextureUse> textures_;
    std::vector<glm::uvec4> environment_texels_;  // floats, as bits
    std::vector<MaterialRecord> materials_;
    World world_;
    std::vector<uint32_t> lights_;           // RecordRefs
    uint64_t large_arrays_[6] = {};
    uint32_t first_area_light_ = 0;          // in lights_, before they are sorted
    std::vector<uint32_t> area_primitives_;  // of each area light
};

}  // namespace

Scene compile_scene(Device& device, const SceneDescription& description, const SceneOptions& options) {
    return SceneCompiler(device, description, options).run();
}

Kernel make_kernel(Device& device, Scene& scene, const std::string& file, const BufferTable& buffers,
                   const std::string& defines) {
    CompileOptions options;
    options.defines = scene.features.defines() + defines;
    options.cache_folder = scene.cache_folder;
    const CompiledShader shader = compile_shader(scene.sources, file, options);
    scene.kernels.push_back({shader.name, shader.from_cache, shader.seconds, shader.spirv.size() * 4});
    BufferTable table = buffers;
    for (const auto& [name, buffer] : scene.buffers) table.emplace(name, &buffer);
    return Kernel(device, shader, table);
}

}  // namespace etendue
