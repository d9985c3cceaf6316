// Damaged scenes for the importer: mutations of bytes and of JSON values, and what must hold for whatever
// comes out.
#pragma once
#include <cmath>
#include <random>
#include <stdexcept>

#include "host/scene/image_file.h"
#include "tests/host/gltf_scene_builder.h"

namespace etendue {

using Random = std::mt19937_64;

inline size_t below(Random& random, size_t count) { return size_t(random() % count); }

// A small scene that has one of nearly everything.
inline GltfBuilder rich_scene() {
    using nlohmann::json;
    GltfBuilder b;
    int p = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1});
    int n = b.accessor<int8_t>("VEC4", {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, true);
    int uv = b.accessor<uint16_t>("VEC2", {0, 0, 65535, 0, 0, 65535, 1, 1}, true);
    int color = b.accessor<uint8_t>("VEC4", {255, 0, 0, 1, 255, 0, 0, 1, 255, 0, 0, 1, 255, 0, 0, 1}, true);
    int triangles = b.accessor<uint16_t>("SCALAR", {0, 1, 2, 1, 3, 2});
    int strip = b.accessor<uint8_t>("SCALAR", {0, 1, 2, 3});
    int places = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 2});
    json attributes = {{"POSITION", p}, {"TANGENT", n}, {"TEXCOORD_0", uv}, {"COLOR_0", color}};
    b.mesh(attributes, triangles)["material"] = 0;
    json& second = b.mesh(attributes, strip);
    second["mode"] = 5;
    second["material"] = 1;
    b.document["accessors"][size_t(p)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", strip}, {"componentType", 5121}}},
        {"values", {{"bufferView", places}}}};
    // Posed: a target, two joints and an animation of all that can be animated.
    json& third = b.mesh(attributes, triangles);
    third["targets"] = {{{"POSITION", p}}};
    third["attributes"]["JOINTS_0"] = b.accessor<uint8_t>("VEC4", std::vector<uint8_t>(16, 0));
    third["attributes"]["WEIGHTS_0"] = color;
    third["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}}};
    b.document["meshes"][2]["weights"] = {0.5};
    b.document["nodes"].back()["skin"] = 0;
    b.document["skins"] = {{{"joints", {2, 0}}}};
    const int times = b.accessor<float>("SCALAR", {0, 1});
    const int turns = b.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 32767, 0, 0}, true);
    const int spline = b.accessor<float>("VEC3", std::vector<float>(18, 1.0f));
    b.document["animations"] = {{{"channels",
                                  {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}},
                                   {{"sampler", 1}, {"target", {{"node", 2}, {"path", "translation"}}}},
                                   {{"sampler", 2}, {"target", {{"node", 2}, {"path", "weights"}}}}}},
                                 {"samplers",
                                  {{{"input", times}, {"output", turns}},
                                   {{"input", times}, {"output", spline}, {"interpolation", "CUBICSPLINE"}},
                                   {{"input", times}, {"output", times}, {"interpolation", "STEP"}}}}}};
    const std::string png =
        "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwgZAA/5Av6UPD2zAAAAAElFTkSuQmCC";
    b.document["images"] = json::array({{{"uri", "data:image/png;base64," + png}}});
    b.document["samplers"] = json::array({{{"wrapS", 33071}, {"magFilter", 9728}}});
    b.document["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
    json texture = {{"index", 0},
                    {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}, {"texCoord", 0}}}}}};
    b.document["materials"] = json::array(
        {{{"pbrMetallicRoughness", {{"baseColorTexture", texture}, {"baseColorFactor", {1, 1, 1, 0.5}}}},
          {"alphaMode", "BLEND"},
          {"normalTexture", texture},
          {"emissiveFactor", {1, 1, 1}},
          {"extensions",
           {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
            {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 0.5, 0}}}}}}},
         {{"extensions",
           {{"ETD_optics",
             {{"surface", {{"class", "dielectric"}, {"ior", 1.7}, {"map", {{"index", 0}}}}},
              {"outside", "fog"},
              {"emission", {{"flux", 8}, {"spectrum", {{"illuminant", "A"}}}}}}}}}},
         {{"extensions", {{"KHR_materials_unlit", json::object()}}}},
         {{"extensions",
           {{"KHR_materials_pbrSpecularGlossiness",
             {{"diffuseTexture", texture},
              {"specularGlossinessTexture", texture},
              {"glossinessFactor", 0.5}}}}}}});
    b.document["cameras"] =
        json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 1}}}}});
    b.document["extensions"] = {
        {"KHR_materials_variants", {{"variants", {{{"name", "v"}}}}}},
        {"KHR_lights_punctual",
         {{"lights", json::array({{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}})}}},
        {"ETD_optics",
         {{"media", json::array({{{"name", "fog"}, {"class", "homogeneous"}}})},
          {"spectra", json::array({{{"name", "s"}, {"value", 0.5}}})},
          {"environment", {{"class", "constant"}, {"radiance", 1}}}}}};
    b.node({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}});
    b.node({{"extensions",
             {{"KHR_lights_punctual", {{"light", 0}}},
              {"ETD_optics", {{"geometry", {{"class", "sphere"}, {"radius", 1}, {"material", 0}}}}}}}});
    b.node({{"mesh", 0},
            {"rotation", {0, 0, 1, 0}},
            {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
    return b;
}

inline std::vector<uint8_t> mutate_bytes(std::vector<uint8_t> bytes, Random& random) {
    for (size_t i = 1 + below(random, 8); i-- > 0 && !bytes.empty();) {
        size_t at = below(random, bytes.size());
        size_t length = std::min(bytes.size() - at, 1 + below(random, 64));
        switch (below(random, 6)) {
            case 0:
                bytes[at] ^= uint8_t(1u << below(random, 8));
                break;
            case 1:
                bytes[at] = uint8_t(random());
                break;
            case 2:
                bytes.resize(at);
                break;
            case 3:
                bytes.erase(bytes.begin() + ptrdiff_t(at), bytes.begin() + ptrdiff_t(at + length));
                break;
            case 4: {
                std::vector<uint8_t> copy(bytes.begin() + ptrdiff_t(at),
                                          bytes.begin() + ptrdiff_t(at + length));
                bytes.insert(bytes.begin() + ptrdiff_t(below(random, bytes.size())), copy.begin(),
                             copy.end());
                break;
            }
            default: {
                const uint32_t words[] = {0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x7F800000, 0x7FC00000};
                uint32_t word = words[below(random, std::size(words))];
                for (size_t k = 0; k < 4 && at + k < bytes.size(); ++k)
                    bytes[at + k] = uint8_t(word >> (8 * k));
            }
        }
    }
    return bytes;
}

inline void collect_values(nlohmann::json& value, std::vector<nlohmann::json*>& values) {
    values.push_back(&value);
    if (value.is_structured())
        for (nlohmann::json& child : value) collect_values(child, values);
}

inline void mutate_json(nlohmann::json& document, Random& random) {
    using nlohmann::json;
    for (size_t i = 1 + below(random, 3); i-- > 0;) {
        std::vector<json*> values;
        collect_values(document, values);
        json& value = *values[below(random, values.size())];
        json copy = *values[below(random, values.size())];
        const json odd[] = {nullptr,
                            true,
                            -1,
                            0,
                            1,
                            2,
                            3,
                            5,
                            65536,
                            4294967295u,
                            9007199254740993,
                            -9223372036854775807,
                            0.5,
                            1e-300,
                            1e18,
                            1e300,
                            "",
                            "x",
                            "\n",
                            "%",
                            "data:,",
                            "../x",
                            json::array(),
                            json::object(),
                            json::array({0}),
                            json::array({0, 0, 0})};
        switch (below(random, 5)) {
            case 0:
                value = copy;
                break;
            case 1:
                if (value.is_number()) value = value.get<double>() + double(below(random, 5)) - 2;
                break;
            case 2:
                if (value.is_structured() && !value.empty()) {
                    auto at = value.begin();
                    std::advance(at, ptrdiff_t(below(random, value.size())));
                    value.erase(at);
                }
                break;
            case 3:
                if (value.is_array()) value.push_back(copy);
                break;
            default:
                value = odd[below(random, std::size(odd))];
        }
    }
}

// What every imported scene promises to those who read it. Throws where it does not hold.
inline void check_invariants(const SceneDescription& s) {
    auto require = [](bool holds, const char* what) {
        if (!holds) throw std::logic_error(what);
    };
    for (const MeshDescription& m : s.meshes) {
        size_t n = m.positions.size();
        require(!m.triangles.empty(), "a mesh has triangles");
        for (const glm::uvec3& t : m.triangles)
            require(t.x < n && t.y < n && t.z < n, "corners are in range");
        for (const glm::vec3& p : m.positions)
            require(std::fabs(p.x) <= 1e18f && std::fabs(p.y) <= 1e18f && std::fabs(p.z) <= 1e18f,
                    "positions are finite");
        for (const glm::vec3& v : m.normals)
            require(std::fabs(v.x * v.x + v.y * v.y + v.z * v.z - 1) < 1e-5f, "normals are unit vectors");
        for (const glm::vec4& v : m.tangents)
            require(std::fabs(v.x * v.x + v.y * v.y + v.z * v.z - 1) < 1e-5f && std::fabs(v.w) == 1,
                    "tangents are unit");
        for (size_t size : {m.normals.size(), m.tangents.size(), m.uv0.size(), m.uv1.size(), m.colors.size()})
            require(size == 0 || size == n, "attributes are as many as positions");
        require(m.material < s.materials.size(), "a mesh has a material");
    }
    for (const MeshInstance& i : s.instances) {
        require(i.mesh < s.meshes.size(), "an instance has a mesh");
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                require(std::isfinite(i.world_from_local[c][r]), "transforms are finite");
    }
    for (const TextureDescription& t : s.textures)
        require(t.image < s.images.size(), "a texture has an image");
    for (const ImageDescription& i : s.images)
        require(std::max(i.rgba8.size(), i.rgba32f.size()) == 4 * size_t(i.width) * i.height &&
                    i.rgba8.empty() != i.rgba32f.empty(),
                "an image has its texels once");
    for (const PlacedObject& o : s.shapes) require(o.material < s.materials.size(), "a shape has a material");
    for (const std::string& w : s.warnings)
        require(w.find('\n') == std::string::npos, "a warning is one line");
    for (const MaterialDescription& m : s.materials)
        require(!m.surface.class_name.empty(), "a material has a surface");
}

inline bool is_image(std::span<const uint8_t> bytes) {
    const uint8_t first = bytes.empty() ? 0 : bytes[0];
    return first == 0x89 || first == 0xFF || first == '#' || first == 0x76;  // PNG, JPEG, .hdr, OpenEXR
}

// Imports (or decodes, where it looks like an image) and checks; returns whether it was sound. Anything but a
// one-line input error passes through.
inline bool try_import(std::span<const uint8_t> bytes) {
    try {
        if (is_image(bytes))
            decode_image(bytes, "nowhere/fuzz.glb");
        else
            check_invariants(import_gltf(
                bytes, "nowhere/fuzz.glb",
                {bytes.size() % 3 ? "" : "v", bytes.size() % 2 ? std::optional(0.5) : std::nullopt}));
        return true;
    } catch (const Error& e) {
        if (e.code != ExitCode::bad_input) throw;
        std::string line = e.what();
        if (line.find('\n') != std::string::npos) throw std::logic_error("an error is not one line: " + line);
        if (!line.starts_with("nowhere/fuzz.glb: "))
            throw std::logic_error("an error does not name the file: " + line);
        return false;
    }
}

// A damaged form of the rich scene.
inline std::vector<uint8_t> mutated_scene(const GltfBuilder& scene, Random& random) {
    GltfBuilder damaged = scene;
    if (below(random, 8) != 0) mutate_json(damaged.document, random);
    if (below(random, 4) == 0) damaged.binary = mutate_bytes(damaged.binary, random);
    std::vector<uint8_t> bytes = damaged.glb();
    return below(random, 6) == 0 ? mutate_bytes(bytes, random) : bytes;
}

}  // namespace etendue
