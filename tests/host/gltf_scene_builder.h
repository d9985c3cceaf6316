// Small scenes made in memory, for the tests of the importer.
#pragma once
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "host/error.h"
#include "host/gltf/gltf.h"

namespace etendue {

struct GltfBuilder {
    nlohmann::json document = {{"asset", {{"version", "2.0"}}}};
    std::vector<uint8_t> binary;
    std::filesystem::path file = "nowhere/scene.glb";

    template <class T>
    static int component_type() {
        if (std::is_same_v<T, int8_t>) return 5120;
        if (std::is_same_v<T, uint8_t>) return 5121;
        if (std::is_same_v<T, int16_t>) return 5122;
        if (std::is_same_v<T, uint16_t>) return 5123;
        return std::is_same_v<T, uint32_t> ? 5125 : 5126;
    }

    int view(const void* data, size_t size, size_t stride = 0) {
        while (binary.size() % 4) binary.push_back(0);
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}};
        if (stride) view["byteStride"] = stride;
        const uint8_t* bytes = static_cast<const uint8_t*>(data);
        binary.insert(binary.end(), bytes, bytes + size);
        document["bufferViews"].push_back(view);
        return int(document["bufferViews"].size()) - 1;
    }

    template <class T>
    int accessor(const std::string& type, const std::vector<T>& values, bool normalized = false) {
        size_t components = type == "SCALAR" ? 1 : size_t(type[3] - '0');
        nlohmann::json a = {{"bufferView", view(values.data(), values.size() * sizeof(T))},
                            {"componentType", component_type<T>()},
                            {"count", values.size() / components},
                            {"type", type}};
        if (normalized) a["normalized"] = true;
        document["accessors"].push_back(a);
        return int(document["accessors"].size()) - 1;
    }

    // A mesh with one primitive, on a node of its own in the scene. Returns the primitive.
    nlohmann::json& mesh(nlohmann::json attributes, int indices = -1) {
        nlohmann::json primitive = {{"attributes", std::move(attributes)}};
        if (indices >= 0) primitive["indices"] = indices;
        document["meshes"].push_back({{"name", "m"}, {"primitives", {primitive}}});
        node({{"mesh", int(document["meshes"].size()) - 1}});
        return document["meshes"].back()["primitives"][0];
    }

    // One triangle in the xy plane.
    nlohmann::json& triangle() {
        return mesh({{"POSITION", accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})}});
    }

    nlohmann::json& node(nlohmann::json node) {
        if (!document.contains("scenes")) document["scenes"] = {{{"nodes", nlohmann::json::array()}}};
        document["nodes"].push_back(std::move(node));
        document["scenes"][0]["nodes"].push_back(document["nodes"].size() - 1);
        return document["nodes"].back();
    }

    static void append_word(std::vector<uint8_t>& bytes, uint32_t word) {
        for (int i = 0; i < 4; ++i) bytes.push_back(uint8_t(word >> (8 * i)));
    }

    std::vector<uint8_t> glb() const {
        nlohmann::json d = document;
        if (!binary.empty() && d.is_object() && !d.contains("buffers"))
            d["buffers"] = {{{"byteLength", binary.size()}}};
        std::string text = d.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<uint8_t> chunk = binary;
        chunk.resize((chunk.size() + 3) / 4 * 4);
        std::vector<uint8_t> bytes = {'g', 'l', 'T', 'F'};
        append_word(bytes, 2);
        append_word(bytes, uint32_t(20 + text.size() + (chunk.empty() ? 0 : 8 + chunk.size())));
        append_word(bytes, uint32_t(text.size()));
        append_word(bytes, 0x4E4F534A);
        bytes.insert(bytes.end(), text.begin(), text.end());
        if (chunk.empty()) return bytes;
        append_word(bytes, uint32_t(chunk.size()));
        append_word(bytes, 0x004E4942);
        bytes.insert(bytes.end(), chunk.begin(), chunk.end());
        return bytes;
    }

    SceneDescription import() const { return import_gltf(glb(), file); }
};

inline std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

// The one line that an import fails with; empty where it succeeds.
inline std::string import_error(const std::vector<uint8_t>& bytes) {
    try {
        import_gltf(bytes, "nowhere/scene.glb");
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

inline bool has_warning(const SceneDescription& scene, const std::string& part) {
    for (const std::string& warning : scene.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}

}  // namespace etendue
