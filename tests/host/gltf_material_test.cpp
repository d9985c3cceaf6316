#include <doctest/doctest.h>

#include <cmath>

#include "host/scene/spectral_value.h"
#include "tests/host/gltf_scene_builder.h"

using namespace etendue;
using nlohmann::json;

namespace {

// A PNG of 2 x 1 texels: red, and green of alpha 0.
const std::string png =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgZAA/5Av6UPD2zAAAAAElFTkSuQmCC";

GltfBuilder with_material(json material) {
    GltfBuilder b;
    b.document["materials"] = {std::move(material)};
    b.triangle()["material"] = 0;
    return b;
}

void add_texture(GltfBuilder& b) {
    b.document["images"] = {{{"uri", "data:image/png;base64," + png}}};
    b.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    b.document["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
}

json optics(json value) { return {{"extensions", {{"ETD_optics", std::move(value)}}}}; }

}  // namespace

TEST_CASE("a plain material has glTF's default values") {
    MaterialDescription m = with_material(json::object()).import().materials.at(0);
    CHECK(m.surface.class_name == "principled");
    CHECK(m.surface.parameters == json{{"base_color", {1.0, 1.0, 1.0, 1.0}},
                                       {"metallic", 1.0},
                                       {"roughness", 1.0},
                                       {"alpha_mode", 0},
                                       {"alpha_cutoff", 0.5},
                                       {"ior", 1.5}});
    CHECK(m.surface.where == "/materials/0");
    CHECK(!m.emission);
    CHECK(m.normal_texture.is_null());
    CHECK(m.inside.empty());
    CHECK(!m.double_sided);
}

TEST_CASE("a primitive without a material gets the default one") {
    GltfBuilder b = with_material(json::object());
    b.triangle();
    SceneDescription s = b.import();
    REQUIRE(s.materials.size() == 2);
    CHECK(s.meshes.at(1).material == 1);
    CHECK(s.materials[1].surface.parameters == s.materials[0].surface.parameters);
}

TEST_CASE("metallic-roughness values and alpha modes become parameters") {
    MaterialDescription m =
        with_material(
            {{"pbrMetallicRoughness",
              {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0}, {"roughnessFactor", 0.25}}},
             {"alphaMode", "MASK"},
             {"alphaCutoff", 0.7},
             {"doubleSided", true},
             {"extensions", {{"KHR_materials_ior", {{"ior", 1.33}}}}}})
            .import()
            .materials.at(0);
    CHECK(m.surface.parameters == json{{"base_color", {0.1, 0.2, 0.3, 0.4}},
                                       {"metallic", 0.0},
                                       {"roughness", 0.25},
                                       {"alpha_mode", 1},
                                       {"alpha_cutoff", 0.7},
                                       {"ior", 1.33}});
    CHECK(m.double_sided);
}

TEST_CASE("only textures that materials use are kept, with their sampler and image") {
    GltfBuilder b =
        with_material({{"pbrMetallicRoughness",
                        {{"baseColorTexture",
                          {{"index", 1},
                           {"texCoord", 1},
                           {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}}}}},
                       {"normalTexture", {{"index", 1}, {"scale", 0.5}}},
                       {"occlusionTexture", {{"index", 0}}}});
    add_texture(b);
    SceneDescription s = b.import();
    REQUIRE(s.textures.size() == 1);
    CHECK(s.textures[0].wrap_u == Wrap::clamp);
    CHECK(s.textures[0].wrap_v == Wrap::mirror);
    CHECK(s.textures[0].nearest);
    REQUIRE(s.images.size() == 1);
    CHECK(s.images[0].width == 2);
    CHECK(s.images[0].height == 1);
    CHECK(s.images[0].rgba8 == std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 0});
    CHECK(s.materials[0].surface.parameters["base_color_texture"] ==
          json{{"index", 0},
               {"texCoord", 1},
               {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}});
    CHECK(s.materials[0].normal_texture == json{{"index", 0}, {"scale", 0.5}});
    CHECK(s.warnings.empty());
}

TEST_CASE("emission is the factor times the strength, with its texture") {
    GltfBuilder b =
        with_material({{"emissiveFactor", {1, 0.5, 0.25}},
                       {"emissiveTexture", {{"index", 0}}},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}});
    add_texture(b);
    MaterialDescription m = b.import().materials.at(0);
    REQUIRE(m.emission);
    CHECK(m.emission->quantity == EmissionDescription::Quantity::radiance);
    CHECK(m.emission->value == json{8.0, 4.0, 2.0});
    CHECK(m.emission->texture == json{{"index", 0}});
}

TEST_CASE("a volume with thickness becomes a medium inside") {
    SceneDescription s = with_material({{"extensions",
                                         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                          {"KHR_materials_ior", {{"ior", 1.4}}},
                                          {"KHR_materials_volume",
                                           {{"thicknessFactor", 1},
                                            {"attenuationDistance", 2},
                                            {"attenuationColor", {1, 0.5, 0.25}}}}}}})
                             .import();
    REQUIRE(s.media.size() == 1);
    CHECK(s.materials.at(0).inside == s.media[0].name);
    CHECK(s.media[0].medium.class_name == "homogeneous");
    CHECK(s.media[0].medium.parameters["ior"] == 1.4);
    json absorption = s.media[0].medium.parameters["absorption"];
    CHECK(absorption[0] == 0.0);
    CHECK(absorption[1].get<double>() == doctest::Approx(std::log(2.0) / 2));
    CHECK(absorption[2].get<double>() == doctest::Approx(std::log(4.0) / 2));
    CHECK(s.materials[0].surface.parameters["transmission"] == 1.0);
    CHECK(!s.materials[0].surface.parameters.contains("thin"));
}

TEST_CASE("members of the surface extensions become parameters, each with its texture") {
    GltfBuilder b = with_material({{"extensions",
                                    {{"KHR_materials_specular",
                                      {{"specularFactor", 0.5},
                                       {"specularTexture", {{"index", 0}}},
                                       {"specularColorFactor", {4, 1, 0}},
                                       {"specularColorTexture", {{"index", 0}}}}},
                                     {"KHR_materials_anisotropy",
                                      {{"anisotropyStrength", 0.6},
                                       {"anisotropyRotation", -7.5},
                                       {"anisotropyTexture", {{"index", 0}}}}},
                                     {"KHR_materials_iridescence",
                                      {{"iridescenceFactor", 0.875},
                                       {"iridescenceTexture", {{"index", 0}}},
                                       {"iridescenceIor", 1.8},
                                       {"iridescenceThicknessMinimum", 50},
                                       {"iridescenceThicknessMaximum", 700},
                                       {"iridescenceThicknessTexture", {{"index", 0}}}}},
                                     {"KHR_materials_diffuse_transmission",
                                      {{"diffuseTransmissionFactor", 0.25},
                                       {"diffuseTransmissionTexture", {{"index", 0}}},
                                       {"diffuseTransmissionColorFactor", {0.1, 0.2, 0.3}},
                                       {"diffuseTransmissionColorTexture", {{"index", 0}}}}},
                                     {"KHR_materials_clearcoat",
                                      {{"clearcoatFactor", 0.75},
                                       {"clearcoatTexture", {{"index", 0}}},
                                       {"clearcoatRoughnessFactor", 0.3},
                                       {"clearcoatRoughnessTexture", {{"index", 0}}},
                                       {"clearcoatNormalTexture", {{"index", 0}}}}},
                                     {"KHR_materials_sheen",
                                      {{"sheenColorFactor", {0.5, 0.25, 0}},
                                       {"sheenColorTexture", {{"index", 0}}},
                                       {"sheenRoughnessFactor", 0.4},
                                       {"sheenRoughnessTexture", {{"index", 0}}}}}}}});
    add_texture(b);
    const SceneDescription s = b.import();
    json p = s.materials.at(0).surface.parameters;
    for (const char* name :
         {"specular", "specular_color", "anisotropy", "iridescence", "iridescence_thickness",
          "diffuse_transmission", "diffuse_transmission_color", "clearcoat", "clearcoat_roughness",
          "clearcoat_normal", "sheen_color", "sheen_roughness"}) {
        CAPTURE(name);
        CHECK(p[std::string(name) + "_texture"] == json{{"index", 0}});
        p.erase(std::string(name) + "_texture");
    }
    for (const char* name : {"base_color", "metallic", "roughness", "alpha_mode", "alpha_cutoff", "ior"})
        p.erase(name);
    CHECK(p == json{{"specular", 0.5},
                    {"specular_color", {4, 1, 0}},
                    {"anisotropy", 0.6},
                    {"anisotropy_rotation", -7.5},
                    {"iridescence", 0.875},
                    {"iridescence_ior", 1.8},
                    {"iridescence_thickness_minimum", 50},
                    {"iridescence_thickness_maximum", 700},
                    {"diffuse_transmission", 0.25},
                    {"diffuse_transmission_color", {0.1, 0.2, 0.3}},
                    {"clearcoat", 0.75},
                    {"clearcoat_roughness", 0.3},
                    {"clearcoat_normal_scale", 1},
                    {"sheen_color", {0.5, 0.25, 0}},
                    {"sheen_roughness", 0.4}});
    CHECK(s.warnings.empty());
}

TEST_CASE("dispersion gives the medium of a volume an index of that Abbe number") {
    const auto medium = [](json material_extensions) {
        material_extensions["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
        SceneDescription s = with_material({{"extensions", material_extensions}}).import();
        const json ior = s.media.empty() ? json() : s.media.at(0).medium.parameters["ior"];
        return ior.is_object() ? spectral_value(ior, s, "", SpectralKind::index) : SpectralValue{};
    };
    const json volume = {{"thicknessFactor", 1}};
    const SpectralValue flint = medium({{"KHR_materials_ior", {{"ior", 1.6}}},
                                        {"KHR_materials_dispersion", {{"dispersion", 20 / 35.0}}},
                                        {"KHR_materials_volume", volume}});
    REQUIRE(flint.table);
    CHECK(flint.table->at(587.6) == doctest::Approx(1.6).epsilon(2e-5));
    CHECK(0.6 / (flint.table->at(486.1) - flint.table->at(656.3)) == doctest::Approx(35).epsilon(1e-3));
    const SpectralValue extreme =
        medium({{"KHR_materials_dispersion", {{"dispersion", 1000}}}, {"KHR_materials_volume", volume}});
    REQUIRE(extreme.table);
    CHECK(extreme.table->least() == 1);
    CHECK(
        !medium({{"KHR_materials_dispersion", {{"dispersion", 0}}}, {"KHR_materials_volume", volume}}).table);
    CHECK(!medium({{"KHR_materials_dispersion", {{"dispersion", 1}}}}).table);  // thin: nothing refracts
}

TEST_CASE("transmission without a volume is thin-walled") {
    SceneDescription s =
        with_material({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}})
            .import();
    CHECK(s.media.empty());
    CHECK(s.materials.at(0).surface.parameters["thin"] == true);
}

TEST_CASE("a surface class with its parameters passes through as it stands") {
    GltfBuilder b = with_material(optics({{"surface",
                                           {{"class", "velvet"},
                                            {"sigma", {{"wavelengths", {400, 700}}, {"values", {0, 1}}}},
                                            {"color_texture", {{"index", 1}}}}}}));
    add_texture(b);
    ObjectDescription o = b.import().materials.at(0).surface;
    CHECK(o.class_name == "velvet");
    CHECK(o.where == "/materials/0/extensions/ETD_optics/surface");
    CHECK(o.parameters == json{{"sigma", {{"wavelengths", {400, 700}}, {"values", {0, 1}}}},
                               {"color_texture", {{"index", 0}}}});
}

TEST_CASE("a dielectric without media named gets one from its ior, and one with media keeps them") {
    GltfBuilder b;
    b.document["materials"] = {
        optics({{"surface", {{"class", "dielectric"}, {"ior", 1.7}, {"alpha", 0.1}}}}),
        optics({{"surface", {{"class", "dielectric"}}}}),
        optics({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}, {"outside", "water"}})};
    b.document["extensions"]["ETD_optics"]["media"] = {
        {{"name", "glass"}, {"class", "homogeneous"}, {"ior", 1.6}},
        {{"name", "water"}, {"class", "homogeneous"}}};
    SceneDescription s = b.import();
    REQUIRE(s.media.size() == 4);
    CHECK(s.media[0].medium.parameters == json{{"ior", 1.6}});
    CHECK(s.materials[0].inside == s.media[2].name);
    CHECK(s.media[2].medium.parameters == json{{"ior", 1.7}});
    CHECK(s.media[3].medium.parameters == json{{"ior", 1.5}});
    CHECK(s.materials[0].surface.parameters == json{{"alpha", 0.1}});
    CHECK(s.materials[2].inside == "glass");
    CHECK(s.materials[2].outside == "water");
}

TEST_CASE("a thin film takes what is below from its base") {
    const auto film = [](const json& base) {
        return optics({{"surface", {{"class", "thin_film"}, {"thickness", 200}, {"base", base}}}});
    };
    GltfBuilder b;
    b.document["materials"] = {film({{"class", "conductor"}, {"k", 3}, {"alpha", 0.1}}),
                               film({{"class", "dielectric"}, {"ior", 1.7}, {"alpha", 0.2}}),
                               film({{"class", "principled"}, {"metallic", 0}, {"ior", 1.6}})};
    const SceneDescription s = b.import();
    const ObjectDescription metal = s.materials.at(0).surface, glass = s.materials.at(1).surface;
    CHECK(metal.class_name == "thin_film");
    CHECK(metal.parameters == json{{"thickness", 200}, {"eta", 0}, {"k", 3}, {"alpha", 0.1}});
    CHECK(glass.class_name == "thin_film");
    CHECK(glass.parameters == json{{"thickness", 200}, {"alpha", 0.2}});
    REQUIRE(s.media.size() == 1);
    CHECK(s.materials[1].inside == s.media[0].name);
    CHECK(s.media[0].medium.parameters == json{{"ior", 1.7}});
    CHECK(s.materials[2].surface.class_name == "principled");
    CHECK(s.materials[2].surface.parameters == json{{"metallic", 0},
                                                    {"ior", 1.6},
                                                    {"iridescence", 1},
                                                    {"iridescence_ior", 1.33},
                                                    {"iridescence_thickness_minimum", 0},
                                                    {"iridescence_thickness_maximum", 200}});

    const std::string at = "/materials/0/extensions/ETD_optics/surface/base";
    CHECK(import_error(with_material(film({{"class", "lambertian"}})).glb()) ==
          "nowhere/scene.glb: " + at +
              "/class: is 'lambertian'; must be conductor, dielectric or principled");
    CHECK(import_error(with_material(film({{"class", "conductor"}, {"thickness", 1}})).glb()) ==
          "nowhere/scene.glb: " + at + ": has a \"thickness\", and so has the film; must be named once");
}

TEST_CASE("named emission has its quantity and spectrum") {
    SceneDescription s =
        with_material(optics({{"emission", {{"flux", 800}, {"spectrum", {{"illuminant", "A"}}}}}})).import();
    REQUIRE(s.materials.at(0).emission);
    CHECK(s.materials[0].emission->quantity == EmissionDescription::Quantity::flux);
    CHECK(s.materials[0].emission->value == 800);
    CHECK(s.materials[0].emission->spectrum == json{{"illuminant", "A"}});
    CHECK(s.materials[0].surface.class_name == "principled");
}

TEST_CASE("objects on nodes are placed, with the material of a geometry") {
    GltfBuilder b = with_material(json::object());
    b.node({{"name", "ball"},
            {"translation", {1, 2, 3}},
            {"extensions",
             {{"ETD_optics", {{"geometry", {{"class", "sphere"}, {"radius", 2}, {"material", 0}}}}}}}});
    b.node({{"extensions", {{"ETD_optics", {{"receiver", {{"class", "thin_lens"}, {"focus", 1}}}}}}}});
    b.node({{"extensions", {{"ETD_optics", {{"light", {{"class", "collimated"}}}}}}}});
    b.node({{"extensions", {{"ETD_optics", {{"element", {{"class", "subscene"}, {"scene", 1}}}}}}}});
    b.document["scenes"].push_back({{"nodes", json::array()}});
    SceneDescription s = b.import();
    REQUIRE(s.shapes.size() == 1);
    CHECK(s.shapes[0].name == "ball");
    CHECK(s.shapes[0].object.class_name == "sphere");
    CHECK(s.shapes[0].object.parameters == json{{"radius", 2}});
    CHECK(s.shapes[0].world_from_local[3] == glm::dvec4(1, 2, 3, 1));
    CHECK(s.receivers.at(0).object.parameters == json{{"focus", 1}});
    CHECK(s.lights.at(0).object.class_name == "collimated");
    CHECK(s.elements.at(0).where == "/nodes/4/extensions/ETD_optics/element");
}

TEST_CASE("spectra, environment and media of the root are read") {
    GltfBuilder b;
    b.document["extensions"]["ETD_optics"] = {
        {"spectra", {{{"name", "a"}, {"value", 0.5}}, {{"name", "b"}, {"blackbody", 3000}}}},
        {"environment", {{"class", "image"}, {"file", "sky.hdr"}, {"scale", 2}}}};
    SceneDescription s = b.import();
    CHECK(s.spectra == std::map<std::string, json>{{"a", 0.5}, {"b", {{"blackbody", 3000}}}});
    REQUIRE(s.environment);
    CHECK(s.environment->class_name == "image");
    CHECK(s.environment->parameters == json{{"file", "sky.hdr"}, {"scale", 2}});
}
