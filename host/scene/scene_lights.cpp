// Lights: which there are, and what they say of their power and extent.
#include <cmath>
#include <algorithm>
#include <cstring>

#include "host/error.h"
#include "host/lights/emission_choice.h"
#include "host/lights/emission_texture.h"
#include "host/photometry/ies_file.h"
#include "host/photometry/ray_set.h"
#include "host/scene/scene_compiler.h"
#include "host/scene/scene_files.h"
#include "host/scene/sky_record.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

std::vector<std::byte> area_record(const ClassInfo& info, uint32_t primitive, uint32_t material) {
    std::vector<std::byte> record(info.stride);
    for (const Parameter& p : info.parameters) {
        if (p.member.name == "primitive") std::memcpy(record.data() + p.member.offset, &primitive, 4);
        if (p.member.name == "material") std::memcpy(record.data() + p.member.offset, &material, 4);
    }
    return record;
}

// `stokes`: S1 to S3 over S0 of light whose x is that of a node.
LightStokes light_stokes(const glm::dvec3& stokes, const glm::dmat4& world_from_local) {
    return {glm::vec3(stokes), glm::vec3(glm::normalize(glm::dvec3(world_from_local[0])))};
}

}  // namespace

// That primitive becomes part of the light that is being added.
uint32_t SceneCompiler::own_shape(const std::string& where) {
    const std::string place = message_place(in_, where);
    const auto shape = in_.lights.at(opening_lights_.size()).shape;
    const std::string name = shape ? in_.shapes[*shape].object.class_name : "";
    if (name != "rectangle" && name != "disk")
        fail_input("{}/opening: {}; allowed: true where the node has a rectangle or disk", place,
                   shape ? "the node's geometry is a " + name : "the node has no geometry");
    const std::vector<uint32_t>& placed = *out_.placed;
    const auto found = std::find(placed.begin(), placed.end(), uint32_t(in_.instances.size() + *shape));
    const uint32_t primitive = uint32_t(found - placed.begin());
    if (materials_[memory_.world.primitives[primitive].material].emission.rgb != glm::vec3(0))
        fail_input(
            "{}/opening: the material of the node's geometry emits light already; allowed: one that emits "
            "none",
            place);
    opening_ = primitive;
    return primitive;
}

PhotometryRef SceneCompiler::add_photometry(const std::filesystem::path& file) {
    const auto embedded = in_.embedded_files.find(file.string());
    const bool is_embedded = embedded != in_.embedded_files.end();
    const std::filesystem::path path = is_embedded ? file : named_file(in_, file);
    auto known = memory_.photometric_files.find(path);
    if (known == memory_.photometric_files.end()) {
        const IntensityDistribution d = is_embedded
                                            ? parse_ies(message_place(in_, file.string()), embedded->second)
                                            : read_photometric_file(path);
        std::vector<float>& all = memory_.photometric_values;
        PhotometryRef ref = append_photometric_table(all, d);
        memory_.buffers.erase("PhotometricValues");
        known = memory_.photometric_files
                    .emplace(path, SceneMemory::PhotometricFile{ref, photometric_summary(d), d.warnings})
                    .first;
    }
    describe_lamp_file(path, known->second.summary, known->second.warnings);
    return known->second.ref;
}

// All skies have maps of one size: that of the scene before makes room.
SkyRef SceneCompiler::add_sky(const ClassInfo& info, const std::vector<std::byte>& record,
                              const std::string& where) {
    const std::string place = message_place(in_, where);
    if (has_sky_) fail_input("{}: is a second sky; allowed: one", place);
    has_sky_ = true;
    Sky sky = build_sky(sky_parameters(info, record, place));
    std::vector<glm::uvec4>& all = memory_.environment_texels;
    if (!memory_.sky_texels) memory_.sky_texels = uint32_t(all.size());
    sky.ref.map.first = *memory_.sky_texels;
    all.resize(std::max(all.size(), *memory_.sky_texels + sky.map.texels.size()));
    std::copy(sky.map.texels.begin(), sky.map.texels.end(), all.begin() + *memory_.sky_texels);
    memory_.buffers.erase("EnvironmentTexels");
    return sky.ref;
}

void SceneCompiler::describe_lamp_file(const std::filesystem::path& file, const std::string& summary,
                                       const std::vector<std::string>& warnings) {
    if (!out_.lamp_files.emplace(file, summary).second) return;
    for (const std::string& warning : warnings)
        out_.warnings.push_back(fmt::format("{}: {}", file.string(), warning));
}

// Watts without spectra are those of light of the record's colour.
RayFileRef SceneCompiler::add_rays(const std::filesystem::path& file, const ClassInfo& info,
                                   const std::vector<std::byte>& record, const std::string& where) {
    const std::filesystem::path path = named_file(in_, file);
    auto known = memory_.ray_files.find(path);
    if (known == memory_.ray_files.end()) {
        known = memory_.ray_files.emplace(path, append_ray_set(memory_.ray_words, read_ray_file(path))).first;
        memory_.buffers.erase("RayWords");
    }
    const RaySet& set = known->second;
    RayFileRef ref = set.ref;
    out_.features.polarized_rays |= ref.polarized != 0;
    const auto member = [&]<class T>(const char* name, T value) {
        for (const Parameter& p : info.parameters)
            if (p.member.name == name) std::memcpy(&value, record.data() + p.member.offset, sizeof value);
        return value;
    };
    const auto color = member("color", SpectrumRef{});
    const auto flux = member("flux", 0.0f);  // instead of the file's
    const SpectralValue& value = spectra_.at(color.table).first;
    if (!set.colors.empty() && value != SpectralValue{glm::vec3(1), {}})
        fail_input("{}: {} has spectra of its own; allowed: no color", message_place(in_, where),
                   path.string());
    std::vector<std::string> warnings = set.warnings;
    if (set.colors.empty()) {
        const double y = value.table ? xyz_of_radiance(*value.table).y : luminance(glm::dvec3(value.rgb));
        if (!(y > 0)) fail_input("{}: the color of its rays must not be black", message_place(in_, where));
        ref.scale = float(1 / y);
        if (!set.lumens) {
            const double efficacy = luminous_efficacy(value);
            ref.flux = float(set.watts * efficacy);
            if (flux == 0)
                warnings.push_back(fmt::format(
                    "tells watts and no wavelengths: taken for light of its color, {:.4g} lm/W", efficacy));
        }
    }
    ref.first_color = uint32_t(ray_colors_.size());
    for (const SpectralValue& of_rays : set.colors)
        ray_colors_.push_back({of_rays.rgb, add_spectrum(of_rays, SpectralKind::radiance)});
    describe_lamp_file(path, set.summary, warnings);
    return ref;
}

// Lights at infinity come first in the list (features/light_selection.glsl).
void SceneCompiler::add_lights() {
    std::vector<Added> finite, infinite;
    if (!options_.environment.empty()) {
        ObjectDescription image{
            "image", {{"file", std::filesystem::absolute(options_.environment).string()}}, "--environment"};
        infinite.push_back(add_record(Interface::light, image));
    } else if (in_.environment) {
        infinite.push_back(add_record(Interface::light, *in_.environment));
    }
    light_names_.assign(infinite.size(), "environment");
    light_stokes_.assign(infinite.size(), {});
    for (const PlacedObject& light : in_.lights) {
        opening_ = no_record;
        const Added added =
            add_record(Interface::light, light.object, recentred(light.world_from_local, light.content));
        opening_lights_.push_back(opening_);
        finite.push_back(added);  // sorted by what measure_lights finds
        light_names_.push_back(light.name);
        light_stokes_.push_back(light_stokes(light.stokes, light.world_from_local));
    }
    for (uint32_t i = 0; i < memory_.world.world_primitives; ++i) {
        const PrimitiveRecord& p = memory_.world.primitives[i];
        const glm::vec3 e = materials_[p.material].emission.rgb;
        if (primitive_kind(p) != PrimitiveKind::instance && (e.x > 0 || e.y > 0 || e.z > 0))
            area_primitives_.push_back(i);
    }
    drop_dark_triangles(area_primitives_);
    std::vector<Added> area;
    if (!area_primitives_.empty()) {
        const ClassInfo& info = use_class(Interface::light, {"area", nlohmann::json::object(), ""});
        for (uint32_t i : area_primitives_) {
            records_[Interface::light].add(info, area_record(info, i, memory_.world.primitives[i].material));
            area.push_back({&info, uint32_t(area.size())});
            const MaterialDescription& material = in_.materials[memory_.world.primitives[i].material];
            light_names_.push_back(material.name);
            light_stokes_.push_back(
                light_stokes(material.emission ? material.emission->stokes : glm::dvec3(0),
                             placed_transform(out_.placed->at(i))));
        }
    }
    std::vector<Added> all = infinite;
    all.insert(all.end(), finite.begin(), finite.end());
    all.insert(all.end(), area.begin(), area.end());
    lights_ = references(Interface::light, all);
    first_area_light_ = uint32_t(infinite.size() + finite.size());
    out_.lights = lights_.size();
    out_.features.emission_maps = emission_varies();
    out_.features.light_count = uint32_t(lights_.size());
    // A number in kernels: where places vary it grows in steps, so that most edits leave it as it is.
    out_.features.scene_radius = options_.varying.count("places") && out_.radius > 0
                                     ? std::exp2(std::ceil(4 * std::log2(out_.radius)) / 4)
                                     : out_.radius;
}

// Of what `placed` counts: instances of meshes, then shapes.
const glm::dmat4& SceneCompiler::placed_transform(uint32_t index) const {
    return index < in_.instances.size() ? in_.instances[index].world_from_local
                                        : in_.shapes.at(index - in_.instances.size()).world_from_local;
}

// Triangles that an emissive texture leaves dark are no lights.
void SceneCompiler::drop_dark_triangles(std::vector<uint32_t>& primitives) {
    uint64_t key = memory_.world_key;
    for (uint32_t i : primitives) {
        const uint32_t words[] = {i, materials_[memory_.world.primitives[i].material].emission_texture};
        key = hash_text({reinterpret_cast<const char*>(words), sizeof words}, key);
    }
    if (key == memory_.lit.key && textures_ == memory_.lit.textures) {
        primitives = memory_.lit.primitives;
        return;
    }
    std::map<uint32_t, EmissionTexture> textures;  // by index of the Texture
    std::erase_if(primitives, [&](uint32_t i) {
        const PrimitiveRecord& p = memory_.world.primitives[i];
        const uint32_t index = materials_[p.material].emission_texture;
        if (index == no_record || primitive_kind(p) != PrimitiveKind::triangle ||
            memory_.world.triangle_indices.empty())
            return false;
        const TextureUse& use = textures_[index];
        const EmissionTexture& texture =
            textures.try_emplace(index, in_.images[use.image], use).first->second;
        const glm::uvec3 t = memory_.world.triangle_indices[p.attributes & 0x3FFFFFFFu];
        const VertexRecord &a = memory_.world.vertices[t.x], &b = memory_.world.vertices[t.y],
                           &c = memory_.world.vertices[t.z];
        const glm::vec2 uv0[3] = {a.uv0, b.uv0, c.uv0}, uv1[3] = {a.uv1, b.uv1, c.uv1};
        return texture.is_dark(uv0, uv1);
    });
    memory_.lit = {key, textures_, primitives};
}

// By index in lights_: what rays hit to meet the light; no_record = nothing.
uint32_t SceneCompiler::primitive_of_light(uint32_t i) const {
    if (i >= first_area_light_) return area_primitives_[i - first_area_light_];
    const size_t infinite = first_area_light_ - opening_lights_.size();
    return i < infinite ? no_record : opening_lights_[i - infinite];
}

// Power and extent of every light, found out by the classes on the device; then the order of the list, the
// tree, and the scale of materials whose emission is given as the power of the whole object.
void SceneCompiler::measure_lights() {
    for (const InterfaceInfo& interface : all_interfaces())
        upload(interface.buffer, records_[interface.interface].bytes());
    share("EnvironmentTexels", memory_.environment_texels);
    if (!memory_.photometric_values.empty()) share("PhotometricValues", memory_.photometric_values);
    if (!memory_.ray_words.empty()) {
        share("RayWords", memory_.ray_words);
        upload("RayColors", ray_colors_);
    }
    upload("Materials", materials_);
    upload_world();
    upload("Lights", lights_);
    if (lights_.empty()) {
        upload("LightNodes", std::vector<uint32_t>());
        upload("LightTrails", std::vector<uint32_t>());
        upload("LightEmission", std::vector<EmissionChoice>());
        name_lights({});
        return;
    }
    map_emission();
    std::vector<LightBounds> bounds = run_measurement();
    shrink_to_lit(bounds);
    scale_powers(bounds);

    std::vector<uint32_t> order(lights_.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_partition(order.begin(), order.end(), [&](uint32_t i) { return is_at_infinity(bounds[i]); });
    std::vector<uint32_t> elements(lights_.size());
    if (!in_.elements.empty()) {
        for (uint32_t i = 0; i < elements.size(); ++i) elements[i] = element_of_light(i);
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return elements[a] < elements[b]; });
    }
    std::vector<uint32_t> sorted_lights;
    std::vector<LightStokes> sorted_stokes;
    std::vector<LightBounds> sorted_bounds;
    std::vector<double> powers;
    std::map<uint32_t, uint32_t> positions;
    for (uint32_t position = 0; position < order.size(); ++position) {
        const uint32_t i = order[position], primitive = primitive_of_light(i);
        sorted_lights.push_back(lights_[i]);
        sorted_stokes.push_back(light_stokes_[i]);
        out_.features.polarized_lights |= light_stokes_[i].stokes != glm::vec3(0);
        out_.light_names.push_back(light_names_[i]);
        out_.light_shapes.push_back(primitive == no_record ? ""
                                                           : out_.placed_names[out_.placed->at(primitive)]);
        light_elements_.push_back(elements[i]);
        if (elements[i] == 0)
            sorted_bounds.push_back(bounds[i]);
        else if (is_at_infinity(bounds[i]))
            fail_input("{}: light {} shines from infinity within an optical element; allowed: in the scene",
                       in_.file.string(), light_names_[i]);
        powers.push_back(bounds[i].power);
        const bool is_enclosed_point = elements[i] != 0 && bounds[i].lo == bounds[i].hi;
        if (is_unmet(bounds[i]) || is_enclosed_point) out_.unmet_lights.push_back(light_names_[i]);
        out_.power += bounds[i].power;
        if (primitive != no_record) positions[primitive] = position;
    }
    const LightTree tree = build_light_tree(sorted_bounds);
    out_.features.light_tree = tree.is_tree;
    out_.features.scene_light_count = uint32_t(sorted_bounds.size());
    out_.features.infinite_light_count = tree.infinite_count;
    upload("Lights", sorted_lights);
    out_.features.polarized_lights |= out_.features.polarized_rays;
    if (out_.features.polarized_lights) upload("LightStokesTable", sorted_stokes);
    upload("LightNodes", tree.nodes);
    upload("LightTrails", tree.trails);
    upload("LightEmission", build_emission_choices(powers));
    name_lights(positions);
}

// In the primitives, whose buffer stays if all are as in the scene before.
void SceneCompiler::name_lights(const std::map<uint32_t, uint32_t>& positions) {
    if (positions == memory_.light_positions) return;
    World& world = memory_.world;
    for (const auto& [primitive, position] : memory_.light_positions)
        world.primitives[primitive].light = no_record;
    for (const auto& [primitive, position] : positions) world.primitives[primitive].light = position;
    memory_.light_positions = positions;
    out_.shared_buffers.erase("Primitives");
    std::shared_ptr<Buffer>& buffer = memory_.buffers["Primitives"];
    if (buffer.use_count() == 1)
        buffer->write(world.primitives.data(), world.primitives.size() * sizeof(PrimitiveRecord));
    else
        buffer = nullptr;
    share("Primitives", world.primitives);
}

std::vector<LightBounds> SceneCompiler::run_measurement() {
    const Buffer out(device_, lights_.size() * sizeof(LightBounds), "LightBoundsTable");
    const uint32_t count = uint32_t(lights_.size());
    run_once("kernels/measure_lights.comp", count, {{"LightBoundsTable", &out}}, {{"light_count", count}});
    return out.read_array<LightBounds>(count);
}

void SceneCompiler::scale_powers(std::vector<LightBounds>& bounds) {
    using Quantity = EmissionDescription::Quantity;
    std::vector<double> totals(materials_.size());
    for (size_t i = 0; i < area_primitives_.size(); ++i)
        totals[memory_.world.primitives[area_primitives_[i]].material] += bounds[first_area_light_ + i].power;
    std::vector<float> scales(materials_.size(), 1.0f);
    bool changed = false;
    for (size_t m = 0; m < in_.materials.size(); ++m) {
        const auto& e = in_.materials[m].emission;
        if (!e || totals[m] <= 0 || (e->quantity != Quantity::power && e->quantity != Quantity::flux))
            continue;
        const double wanted =
            luminance(glm::dvec3(spectral_value(e->value, in_, e->where, SpectralKind::radiance).rgb));
        scales[m] = float(wanted / totals[m]);
        scale_emission(materials_[m], scales[m]);
        changed = true;
    }
    if (!changed) return;
    for (size_t i = 0; i < area_primitives_.size(); ++i)
        bounds[first_area_light_ + i].power *= scales[memory_.world.primitives[area_primitives_[i]].material];
    upload("Materials", materials_);
}

}  // namespace etendue
