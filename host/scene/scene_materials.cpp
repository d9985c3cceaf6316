// Materials: surfaces, media on their sides, emission, textures.
#include <algorithm>

#include "host/error.h"
#include "host/scene/scene_compiler.h"
#include "host/scene/scene_files.h"

namespace etendue {

namespace {

// Of an illuminance meter.
void check_pupil(const nlohmann::json& parameters, const std::string& place) {
    const auto pupil = parameters.find("pupil");
    if (pupil == parameters.end() || !(pupil->at(1).get<double>() > 0)) return;
    if (parameters.value("shape", "plane") != "plane")
        fail_input("{}/pupil: the shape is a {}; allowed: a plane", place,
                   parameters["shape"].get<std::string>());
    if (!(pupil->at(0).get<double>() > 0))
        fail_input("{}/pupil: its distance is 0; allowed: more than 0 m", place);
}
constexpr double smooth_alpha = 1e-4;  // below which a surface is smooth (shaders/lib/microfacet.glsl)
}  // namespace

uint32_t SceneCompiler::medium_ref(const std::string& name, const std::string& where) {
    if (name.empty()) return no_record;
    const auto found = resolver_.media.find(name);
    if (found == resolver_.media.end())
        fail_input("{}: {} is not the name of a medium", message_place(in_, where), name);
    return found->second;
}

// Faces of crystals are made by shaders/features/crystals.glsl, which knows smooth ones.
void SceneCompiler::check_crystal_face(const MaterialDescription& m) {
    const auto is_crystal = [&](const MediumDescription& medium) {
        return (medium.name == m.inside || medium.name == m.outside) &&
               find_class(Interface::medium, medium.medium).is_crystal;
    };
    const auto crystal = std::find_if(in_.media.begin(), in_.media.end(), is_crystal);
    if (crystal == in_.media.end()) return;
    const nlohmann::json alpha = m.surface.parameters.value("alpha", nlohmann::json(0));
    if (m.surface.class_name != "dielectric" || !alpha.is_number() || alpha > smooth_alpha)
        fail_input("{}: is a face of the crystal {}; allowed there: the class dielectric with alpha 0",
                   message_place(in_, m.surface.where), crystal->name);
}

// Materials that no object has are checked like all others, but leave nothing to compile.
std::vector<bool> SceneCompiler::used_materials() const {
    std::vector<bool> used(in_.materials.size());
    for (const MeshInstance& instance : in_.instances) used[in_.meshes[instance.mesh].material] = true;
    for (const PlacedObject& shape : in_.shapes) used[shape.material] = true;
    return used;
}

void SceneCompiler::add_materials() {
    const std::vector<bool> used = used_materials();
    std::vector<Added> surfaces;
    std::vector<uint32_t> places;  // of the surfaces' materials
    for (const MaterialDescription& m : in_.materials) {
        MaterialRecord record{};
        record.inside = medium_ref(m.inside, m.surface.where);
        record.outside = medium_ref(m.outside, m.surface.where);
        check_crystal_face(m);
        if (m.double_sided) record.flags |= emits_both_sides;
        if (!m.inside.empty() || !m.outside.empty()) record.flags |= separates_media;
        record.emission_texture = record.normal_texture = no_record;
        if (m.normal_texture.is_object()) {
            record.normal_texture =
                resolver_.texture(m.normal_texture, false, m.surface.where + "/normalTexture");
            record.normal_scale = m.normal_texture.value("scale", 1.0f);
            out_.features.normal_maps = out_.features.shading_normals = true;
        }
        if (m.emission) fill_emission(*m.emission, record);
        record.surface = record.body = no_record;
        if (used[materials_.size()]) {
            surfaces.push_back(add_record(Interface::surface, m.surface));
            places.push_back(uint32_t(materials_.size()));
        } else {
            fill_record(find_class(Interface::surface, m.surface), m.surface, {}, resolver_);
        }
        materials_.push_back(record);
        out_.material_names.push_back(m.name);
    }
    if (has_receptors()) {
        out_.features.receptors = true;
        out_.features.receptor_material = uint32_t(materials_.size());
        MaterialRecord white{};
        white.inside = white.outside = white.emission_texture = white.normal_texture = white.body = no_record;
        const Added surface =
            add_record(Interface::surface, {"lambertian", {{"reflectance", {1, 1, 1}}}, ""});
        for (int shape = 0; shape < 5; ++shape) {  // shaders/features/receptor_shapes.glsl
            surfaces.push_back(surface);
            places.push_back(uint32_t(materials_.size()));
            materials_.push_back(white);
            out_.material_names.push_back("receptor");
        }
        for (const PlacedObject& receiver : in_.receivers) {
            const nlohmann::json& parameters = receiver.object.parameters;
            check_pupil(parameters, message_place(in_, receiver.object.where));
            out_.features.receptor_shapes |=
                (parameters.contains("shape") && parameters["shape"] != "plane") ||
                parameters.contains("pupil");
        }
    }
    const auto refs = references(Interface::surface, surfaces);
    for (size_t i = 0; i < refs.size(); ++i) materials_[places[i]].surface = refs[i];
    out_.materials = materials_.size();
    rank_bodies();
    ask_opacity();
}

MeasuredRef SceneCompiler::add_measured(const std::filesystem::path& file) {
    const std::filesystem::path path = named_file(in_, file);
    auto known = memory_.measured_files.find(path);
    if (known == memory_.measured_files.end()) {
        const MeasuredBsdf bsdf = read_measured_bsdf(path);
        for (const char* name : {"MeasuredPoints", "MeasuredColors", "MeasuredSpectra"})
            memory_.buffers.erase(name);
        const MeasuredRef ref = append(memory_.measured, bsdf);
        known = memory_.measured_files.emplace(path, SceneMemory::MeasuredFile{ref, bsdf.place}).first;
    }
    uses_measured_ = true;
    MeasuredRef ref = known->second.ref;
    ref.place_table = add_spectrum(known->second.place, SpectralKind::factor);
    return ref;
}

uint32_t SceneCompiler::add_mueller_table(const std::filesystem::path& file) {
    const std::filesystem::path path = file.is_absolute() ? file : in_.folder / file;
    auto known = memory_.mueller_files.find(path);
    if (known == memory_.mueller_files.end()) {
        for (const char* name : {"MuellerNumbers", "MuellerIntensities", "MuellerRatios"})
            memory_.buffers.erase(name);
        known = memory_.mueller_files.emplace(path, read_mueller_file(path, threads_, memory_.mueller_tables))
                    .first;
    }
    MuellerTable table = known->second.table;
    for (size_t i = 0; i < mueller_tables_.size(); ++i)
        if (mueller_tables_[i].matrices == table.matrices) return uint32_t(i);
    table.place_rgb = known->second.place.rgb;
    table.place_table = add_spectrum(known->second.place, SpectralKind::factor);
    mueller_tables_.push_back(table);
    return uint32_t(mueller_tables_.size() - 1);
}

void SceneCompiler::upload_measured() {
    if (uses_measured_) {
        share("MeasuredPoints", memory_.measured.points);
        share("MeasuredColors", memory_.measured.colors);
    }
    if (!grating_orders_.empty()) {
        upload("GratingOrderRows", grating_orders_);
        upload("GratingNumbers", grating_numbers_);
    }
    if (!mueller_tables_.empty()) {
        upload("MuellerTables", mueller_tables_);
        share("MuellerNumbers", memory_.mueller_tables.numbers);
        share("MuellerIntensities", memory_.mueller_tables.intensities);
    }
}

bool SceneCompiler::has_bodies() const {
    const std::vector<bool> used = used_materials();
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i] && in_.materials[i].priority > 0) return true;
    return false;
}

// Receivers that need a material which no object has (shaders/features/receptors.glsl).
bool SceneCompiler::has_receptors() {
    return std::any_of(in_.receivers.begin(), in_.receivers.end(), [&](const PlacedObject& r) {
        return find_class(Interface::receiver, r.object).has_receptor;
    });
}

// Materials with a priority by their place in the order of priorities; the first of several of the same.
void SceneCompiler::rank_bodies() {
    const std::vector<bool> used = used_materials();
    std::vector<uint32_t> bodies, media;
    for (uint32_t i = 0; i < in_.materials.size(); ++i)
        if (used[i] && in_.materials[i].priority > 0) bodies.push_back(i);
    if (bodies.empty()) return;
    if (bodies.size() > most_bodies)
        fail_input("{}: {} materials have a priority; allowed: {}",
                   message_place(in_, in_.materials[bodies[most_bodies]].surface.where), bodies.size(),
                   most_bodies);
    std::stable_sort(bodies.begin(), bodies.end(), [&](uint32_t a, uint32_t b) {
        return in_.materials[a].priority > in_.materials[b].priority;
    });
    for (uint32_t place = 0; place < bodies.size(); ++place) {
        materials_[bodies[place]].body = place;
        media.push_back(materials_[bodies[place]].inside);
    }
    upload("BodyMedia", media);
    out_.features.body_count = uint32_t(bodies.size());
    out_.features.straight = true;  // shadow rays, too, pass faces that are not there
}

void SceneCompiler::ask_opacity() {
    if (materials_.empty()) return;
    const uint32_t count = uint32_t(materials_.size());
    write_headers();
    upload_measured();
    upload("SurfaceRecords", records_[Interface::surface].bytes());
    upload("MediumRecords", records_[Interface::medium].bytes());
    upload("Materials", materials_);
    const Buffer out(device_, count * 4, "MaterialOpacity");
    run_once("kernels/measure_materials.comp", count, {{"MaterialOpacity", &out}}, {{"count", count}});
    const auto is_opaque = out.read_array<uint32_t>(count);
    for (uint32_t i = 0; i < count; ++i) {
        if (is_opaque[i] & 1)
            materials_[i].flags |= opaque;
        else
            out_.features.straight = true;
        if (is_opaque[i] & 2) materials_[i].flags |= blocks;
        out_.features.coverage |= i < in_.materials.size() && in_.materials[i].emission &&
                                  !(is_opaque[i] & 1) &&
                                  find_class(Interface::surface, in_.materials[i].surface).says_coverage;
    }
}

void SceneCompiler::fill_emission(const EmissionDescription& e, MaterialRecord& record) {
    const SpectralValue value = emitted_spectrum(e);
    if (value.least() < 0) fail_input("{}: emission must not be negative", message_place(in_, e.where));
    record.emission = {value.rgb, add_spectrum(value, SpectralKind::radiance)};
    if (e.texture.is_object()) record.emission_texture = resolver_.texture(e.texture, true, e.where);
}

void SceneCompiler::add_textures() {
    out_.features.textures = !textures_.empty();
    out_.textures = textures_.size();
    if (textures_.empty()) return;
    PackedTextures packed;
    if (textures_ != memory_.texture_uses || !memory_.buffers["Texels"]) {
        memory_.buffers.erase("Texels"), memory_.buffers.erase("Textures");
        packed = pack_textures(in_.images, textures_);
        memory_.texture_uses = textures_;
        memory_.texture_formats = packed.formats;
    }
    out_.features.texture_formats = memory_.texture_formats;
    share("Texels", packed.texels);
    share("Textures", packed.textures);
}

}  // namespace etendue
