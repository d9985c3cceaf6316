// Materials: metallic-roughness with the KHR extensions that `principled` models, emission and media.
// occlusionTexture is not read: it stands in for light that is computed here.
#include <algorithm>
#include <cmath>

#include "host/gltf/gltf.h"
#include "host/gltf/import.h"
#include "host/spectra/spectrum.h"

namespace etendue {
namespace {

using nlohmann::json;

void read_texture(GltfImport& import, const JsonAt& object, const char* key, json& parameters,
                  const char* name) {
    if (std::optional<JsonAt> info = find_object(object, key))
        parameters[name] = read_texture_info(import, *info);
}

double material_ior(const JsonAt& material) {
    std::optional<JsonAt> extension = find_extension(material, "KHR_materials_ior");
    if (!extension) return 1.5;
    double ior = number(*extension, "ior", 1.5, 0, 100);
    if (ior != 0 && ior < 1) fail_at(member(*extension, "ior"), "is {}; must be 0, or at least 1", ior);
    return ior;
}

double material_dispersion(const JsonAt& material) {
    std::optional<JsonAt> extension = find_extension(material, "KHR_materials_dispersion");
    return extension ? number(*extension, "dispersion", 0, 0, 1e3) : 0.0;
}

// Names of an extension's members and of the parameters of class `principled` that they become; all have that
// class's ranges and defaults.
struct ExtensionMember {
    enum Kind { factor, color, angle, index, length, texture } kind;
    const char *member, *parameter;
};
struct MaterialExtension {
    const char* name;
    std::vector<ExtensionMember> members;
};

const std::vector<MaterialExtension>& surface_extensions() {
    using M = ExtensionMember;
    static const std::vector<MaterialExtension> result = {
        {"KHR_materials_specular",
         {{M::factor, "specularFactor", "specular"},
          {M::texture, "specularTexture", "specular_texture"},
          {M::color, "specularColorFactor", "specular_color"},
          {M::texture, "specularColorTexture", "specular_color_texture"}}},
        {"KHR_materials_anisotropy",
         {{M::factor, "anisotropyStrength", "anisotropy"},
          {M::angle, "anisotropyRotation", "anisotropy_rotation"},
          {M::texture, "anisotropyTexture", "anisotropy_texture"}}},
        {"KHR_materials_iridescence",
         {{M::factor, "iridescenceFactor", "iridescence"},
          {M::texture, "iridescenceTexture", "iridescence_texture"},
          {M::index, "iridescenceIor", "iridescence_ior"},
          {M::length, "iridescenceThicknessMinimum", "iridescence_thickness_minimum"},
          {M::length, "iridescenceThicknessMaximum", "iridescence_thickness_maximum"},
          {M::texture, "iridescenceThicknessTexture", "iridescence_thickness_texture"}}},
        {"KHR_materials_diffuse_transmission",
         {{M::factor, "diffuseTransmissionFactor", "diffuse_transmission"},
          {M::texture, "diffuseTransmissionTexture", "diffuse_transmission_texture"},
          {M::color, "diffuseTransmissionColorFactor", "diffuse_transmission_color"},
          {M::texture, "diffuseTransmissionColorTexture", "diffuse_transmission_color_texture"}}},
        {"KHR_materials_clearcoat",
         {{M::factor, "clearcoatFactor", "clearcoat"},
          {M::texture, "clearcoatTexture", "clearcoat_texture"},
          {M::factor, "clearcoatRoughnessFactor", "clearcoat_roughness"},
          {M::texture, "clearcoatRoughnessTexture", "clearcoat_roughness_texture"}}},
        {"KHR_materials_sheen",
         {{M::color, "sheenColorFactor", "sheen_color"},
          {M::texture, "sheenColorTexture", "sheen_color_texture"},
          {M::factor, "sheenRoughnessFactor", "sheen_roughness"},
          {M::texture, "sheenRoughnessTexture", "sheen_roughness_texture"}}}};
    return result;
}

void read_surface_extensions(GltfImport& import, const JsonAt& material, json& parameters) {
    for (const MaterialExtension& e : surface_extensions()) {
        std::optional<JsonAt> extension = find_extension(material, e.name);
        if (!extension) continue;
        for (const ExtensionMember& m : e.members) {
            std::optional<JsonAt> at = find(*extension, m.member);
            if (!at) continue;
            // Only the color of a reflection may exceed 1: it multiplies a small one.
            const double most = std::string(m.member) == "specularColorFactor" ? max_coordinate : 1;
            if (m.kind == ExtensionMember::texture)
                read_texture(import, *extension, m.member, parameters, m.parameter);
            else if (m.kind == ExtensionMember::color)
                parameters[m.parameter] = number_array(*at, 3, 0, most);
            else if (m.kind == ExtensionMember::angle)
                parameters[m.parameter] = number_value(*at);
            else if (m.kind == ExtensionMember::index)
                parameters[m.parameter] = number_value(*at, 1, 100);
            else if (m.kind == ExtensionMember::length)
                parameters[m.parameter] = number_value(*at, 0, 1e5);  // nm
            else
                parameters[m.parameter] = number_value(*at, 0, 1);
        }
    }
}

// A coat has normals of its own: those of the mesh, bent by its map alone.
void read_coat_normals(GltfImport& import, const JsonAt& material, json& parameters) {
    std::optional<JsonAt> coat = find_extension(material, "KHR_materials_clearcoat");
    if (!coat) return;
    std::optional<JsonAt> map = find_object(*coat, "clearcoatNormalTexture");
    const double scale = map ? number(*map, "scale", 1, -max_coordinate, max_coordinate) : 0;
    if (scale != 0)
        read_texture(import, *coat, "clearcoatNormalTexture", parameters, "clearcoat_normal_texture");
    if (map || find(material, "normalTexture")) parameters["clearcoat_normal_scale"] = scale != 0 ? scale : 1;
}

json metallic_roughness(GltfImport& import, const JsonAt& material) {
    json p = json::object();
    json none = json::object();
    JsonAt metal = find_object(material, "pbrMetallicRoughness")
                       .value_or(JsonAt{&none, material.pointer, material.file});
    p["base_color"] = numbers(metal, "baseColorFactor", {1, 1, 1, 1}, 0, 1);
    p["metallic"] = number(metal, "metallicFactor", 1, 0, 1);
    p["roughness"] = number(metal, "roughnessFactor", 1, 0, 1);
    read_texture(import, metal, "baseColorTexture", p, "base_color_texture");
    read_texture(import, metal, "metallicRoughnessTexture", p, "metallic_roughness_texture");
    p["ior"] = material_ior(material);
    read_surface_extensions(import, material, p);
    return p;
}

// The parameters of class `principled`, as glTF 2.0, section 3.9 and its appendix B name the quantities.
json principled_parameters(GltfImport& import, const JsonAt& material) {
    std::optional<JsonAt> glossy = find_extension(material, "KHR_materials_pbrSpecularGlossiness");
    json p = glossy ? specular_glossiness(import, *glossy) : metallic_roughness(import, material);
    p["alpha_mode"] = alpha_mode(material);
    p["alpha_cutoff"] = number(material, "alphaCutoff", 0.5, 0, max_coordinate);
    if (glossy) return p;
    if (std::optional<JsonAt> transmission = find_extension(material, "KHR_materials_transmission")) {
        p["transmission"] = number(*transmission, "transmissionFactor", 0, 0, 1);
        read_texture(import, *transmission, "transmissionTexture", p, "transmission_texture");
    }
    read_coat_normals(import, material, p);
    return p;
}

// Of KHR_materials_dispersion: 20 / V_d, V_d the Abbe number. Its section "Overview" gives the formula, λ in
// nm; `ior` is that at 587.6 nm.
json dispersive_ior(double ior, double dispersion) {
    json wavelengths = json::array(), values = json::array();
    for (int nm = first_nm; nm <= last_nm; ++nm) {
        const double slope = (ior - 1) * dispersion / 20;
        wavelengths.push_back(nm);
        values.push_back(std::max(ior + slope * (523655.0 / (double(nm) * nm) - 1.5168), 1.0));
    }
    return {{"wavelengths", wavelengths}, {"values", values}};
}

// The medium of a volume: Beer-Lambert with attenuationColor left after attenuationDistance
// (KHR_materials_volume).
json volume_parameters(const JsonAt& volume, double ior, double dispersion) {
    std::vector<double> color = numbers(volume, "attenuationColor", {1, 1, 1}, 0, 1);
    json absorption = 0.0;
    if (std::optional<JsonAt> distance = find(volume, "attenuationDistance")) {
        double d = number_value(*distance, DBL_MIN);
        absorption = json::array();
        // A channel of 0 would absorb without bound: what is left of it is less than any image shows.
        for (double c : color) absorption.push_back(std::fabs(std::log(std::max(c, 1e-9)) / d));
    }
    // An ior of 0 stands for a dielectric that reflects everything: no light comes in, any medium will do.
    json medium = {{"ior", ior == 0 ? 1.0 : ior}, {"absorption", absorption}};
    if (dispersion > 0 && ior > 1) medium["ior"] = dispersive_ior(ior, dispersion);
    return medium;
}

void add_medium(GltfImport& import, MaterialDescription& material, const JsonAt& at, json parameters) {
    std::string name = "medium of " + at.pointer;
    import.scene.media.push_back({name, { "homogeneous", std::move(parameters), at.pointer }});
    material.inside = name;
}

bool names_media(const MaterialDescription& material) {
    return !material.inside.empty() || !material.outside.empty();
}

void read_emission(GltfImport& import, const JsonAt& at, MaterialDescription& material) {
    std::vector<double> factor = numbers(at, "emissiveFactor", {0, 0, 0}, 0, max_coordinate);
    double strength = 1;
    if (std::optional<JsonAt> extension = find_extension(at, "KHR_materials_emissive_strength"))
        strength = number(*extension, "emissiveStrength", 1, 0, 1e30);
    std::optional<JsonAt> texture = find_object(at, "emissiveTexture");
    for (double& f : factor) f *= strength;
    if (std::all_of(factor.begin(), factor.end(), [](double f) { return f == 0; })) return;
    EmissionDescription emission;
    emission.value = factor;
    if (texture) emission.texture = read_texture_info(import, *texture);
    emission.where = at.pointer;
    material.emission = emission;
}

void check_priority(const JsonAt& at, const MaterialDescription& material) {
    if (const char* wrong = priority_error(material))
        fail_at(member(*find_extension(at, "ETD_optics"), "priority"), "{}", wrong);
}

MaterialDescription read_material(GltfImport& import, size_t i) {
    JsonAt at = document_element(import, "materials", i);
    MaterialDescription material;
    material.name = text(at, "name", fmt::format("material {}", i));
    material.double_sided = boolean(at, "doubleSided", false);
    read_emission(import, at, material);
    if (std::optional<JsonAt> normal = find_object(at, "normalTexture"))
        material.normal_texture = read_texture_info(import, *normal);
    if (std::optional<JsonAt> optics = find_extension(at, "ETD_optics"))
        read_material_optics(import, *optics, material);

    json& parameters = material.surface.parameters;
    if (material.surface.class_name == "dielectric" || material.surface.class_name == "antireflective") {
        take_medium_from_ior(import, material, at, parameters);
    } else if (material.surface.class_name.empty() && find_extension(at, "KHR_materials_unlit")) {
        material.surface = {"principled", unlit(import, at, material), at.pointer};
    } else if (material.surface.class_name.empty()) {
        material.surface = {"principled", principled_parameters(import, at), at.pointer};
        std::optional<JsonAt> volume = find_extension(at, "KHR_materials_volume");
        bool thick = volume && number(*volume, "thicknessFactor", 0, 0, max_coordinate) > 0;
        if (thick && !names_media(material))
            add_medium(import, material, at,
                       volume_parameters(*volume, parameters["ior"].get<double>(), material_dispersion(at)));
        else if (!thick && parameters.contains("transmission"))
            parameters["thin"] = true;
    }
    if (material.priority > 0) check_priority(at, material);
    return material;
}

}  // namespace

// What is around a body with a priority follows from the others, and its faces may vanish, with what they
// emit.
const char* priority_error(const MaterialDescription& material) {
    if (material.priority == 0) return nullptr;
    if (material.inside.empty()) return "a material with a priority must name a medium inside";
    if (!material.outside.empty()) return "a material with a priority must name none outside";
    if (material.emission) return "a material with a priority must not emit";
    return nullptr;
}

void take_medium_from_ior(GltfImport& import, MaterialDescription& material, const JsonAt& at,
                          json& parameters) {
    if (names_media(material)) return;
    add_medium(import, material, at, {{"ior", parameters.value("ior", json(1.5))}});
    parameters.erase("ior");
}

int alpha_mode(const JsonAt& material) {
    std::string mode = text(material, "alphaMode", "OPAQUE");
    if (mode == "OPAQUE") return 0;
    if (mode == "MASK") return 1;
    if (mode == "BLEND") return 2;
    fail_at(member(material, "alphaMode"), "is '{}'; must be OPAQUE, MASK or BLEND", mode);
}

void load_materials(GltfImport& import) {
    for (size_t i = 0; i < array_size(import.root, "materials"); ++i)
        import.scene.materials.push_back(read_material(import, i));
}

uint32_t default_material(GltfImport& import) {
    if (import.default_material == UINT32_MAX) {
        nlohmann::json empty = nlohmann::json::object();
        MaterialDescription material;
        material.name = "default";
        material.surface = {"principled",
                            principled_parameters(import, {&empty, "/materials", &import.file_name}),
                            "/materials"};
        import.default_material = uint32_t(import.scene.materials.size());
        import.scene.materials.push_back(material);
    }
    return import.default_material;
}

}  // namespace etendue
