// From bytes to a checked document: container, JSON, version, extensions, buffers and buffer views.
#include <algorithm>
#include <cstring>

#include "host/image/atomic_file.h"
#include "host/gltf/import.h"

namespace etendue {
namespace {

using nlohmann::json;

const uint32_t glb_magic = 0x46546C67, json_chunk_type = 0x4E4F534A, binary_chunk_type = 0x004E4942;
// Deeper documents are refused: the stack of the program is finite.
const int max_depth = 256;

const char* const modelled_extensions[] = {"ETD_optics",
                                           "KHR_materials_emissive_strength",
                                           "KHR_materials_ior",
                                           "KHR_materials_transmission",
                                           "KHR_materials_volume",
                                           "KHR_materials_dispersion",
                                           "KHR_materials_specular",
                                           "KHR_materials_clearcoat",
                                           "KHR_materials_sheen",
                                           "KHR_materials_anisotropy",
                                           "KHR_materials_iridescence",
                                           "KHR_materials_diffuse_transmission",
                                           "KHR_materials_unlit",
                                           "KHR_materials_pbrSpecularGlossiness",
                                           "KHR_materials_variants",
                                           "KHR_lights_punctual",
                                           "KHR_texture_transform",
                                           "KHR_mesh_quantization",
                                           "KHR_draco_mesh_compression",
                                           "EXT_meshopt_compression",
                                           "EXT_texture_webp",
                                           "EXT_lights_ies",
                                           "EXT_mesh_gpu_instancing"};

// What a scene may require although it is read past, with a warning.
const char* const passed_extensions[] = {"KHR_animation_pointer"};

bool is_among(std::span<const char* const> names, const std::string& name) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
}

uint32_t word_at(std::span<const uint8_t> bytes, size_t offset) {
    uint32_t word;
    std::memcpy(&word, bytes.data() + offset, 4);
    return word;
}

// Splits a .glb into its JSON and its binary chunk (glTF 2.0, section 4.4).
std::span<const uint8_t> split_glb(GltfImport& import, std::span<const uint8_t> bytes) {
    const std::string& file = import.file_name;
    if (bytes.size() < 20) fail_input("{}: the file is truncated; a .glb has at least 20 bytes", file);
    if (word_at(bytes, 4) != 2) fail_input("{}: is a .glb of version {}; must be 2", file, word_at(bytes, 4));
    size_t length = word_at(bytes, 8);
    if (length > bytes.size())
        fail_input("{}: the file is truncated: its header says {} bytes, it has {}", file, length,
                   bytes.size());
    std::span<const uint8_t> text;
    for (size_t at = 12; at + 8 <= length;) {
        size_t size = word_at(bytes, at);
        uint32_t type = word_at(bytes, at + 4);
        if (size > length - at - 8) fail_input("{}: the chunk at byte {} is longer than the file", file, at);
        std::span<const uint8_t> chunk = bytes.subspan(at + 8, size);
        if (at == 12) {
            if (type != json_chunk_type) fail_input("{}: the first chunk of the .glb is not JSON", file);
            text = chunk;
        } else if (type == binary_chunk_type && !import.binary_chunk.data()) {
            import.binary_chunk = chunk;
        }
        at += 8 + (size + 3) / 4 * 4;
    }
    return text;
}

void check_depth(const std::string& file, std::span<const uint8_t> text) {
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        if (quoted) {
            if (text[i] == '\\')
                ++i;
            else if (text[i] == '"')
                quoted = false;
        } else if (text[i] == '"') {
            quoted = true;
        } else if (text[i] == '{' || text[i] == '[') {
            if (++depth > max_depth)
                fail_input("{}: not a scene: JSON nested deeper than {}", file, max_depth);
        } else if (text[i] == '}' || text[i] == ']') {
            --depth;
        }
    }
}

// The first place where each extension stands that is not modelled.
void collect_ignored(const JsonAt& at, std::map<std::string, JsonAt>& ignored) {
    if (!at->is_structured()) return;
    for (auto i = at->begin(); i != at->end(); ++i) {
        if (!i->is_structured()) continue;
        if (at->is_array()) {
            collect_ignored(element(at, size_t(i - at->begin())), ignored);
            continue;
        }
        if (i.key() == "extras") continue;
        JsonAt child = member(at, i.key());
        if (i.key() == "extensions" && i->is_object())
            for (auto e = i->begin(); e != i->end(); ++e)
                if (!is_among(modelled_extensions, e.key())) ignored.emplace(e.key(), at);
        collect_ignored(child, ignored);
    }
}

}  // namespace

JsonAt document_element(const GltfImport& import, const char* array, size_t index) {
    return element(member(import.root, array), index);
}

void warn(GltfImport& import, const JsonAt& at, const std::string& message) {
    import.scene.warnings.push_back(message_at(at, message));
}

void warn_once(GltfImport& import, const std::string& subject, const JsonAt& at, const std::string& message) {
    if (import.warned.insert(subject).second) warn(import, at, message);
}

void parse_document(GltfImport& import, std::span<const uint8_t> bytes) {
    std::span<const uint8_t> content = bytes;
    if (bytes.empty()) fail_input("{}: the file is empty", import.file_name);
    if (bytes.size() >= 4 && word_at(bytes, 0) == glb_magic) content = split_glb(import, bytes);
    check_depth(import.file_name, content);
    try {
        import.document = json::parse(content.begin(), content.end());
    } catch (const json::exception& e) {
        std::string reason = e.what();  // "[json.exception.parse_error.101] parse error at line 1, …"
        size_t bracket = reason.find("] ");
        if (bracket != std::string::npos) reason.erase(0, bracket + 2);
        import.root = {&import.document, "", &import.file_name};
        fail_at(import.root, "not a scene: {}", reason);
    }
    import.root = {&import.document, "", &import.file_name};
    require_object(import.root);
    JsonAt asset = member(import.root, "asset");
    JsonAt version = member(asset, "version");
    if (!text_value(version).starts_with("2."))
        fail_at(version, "is '{}'; must be 2.0, glTF's version", text_value(version));
    std::string least = text(asset, "minVersion");
    if (!least.empty() && least != "2.0")
        fail_at(member(asset, "minVersion"), "is '{}'; glTF 2.0 is what can be read", least);
}

void check_extensions(GltfImport& import) {
    for (size_t i = 0; i < array_size(import.root, "extensionsRequired"); ++i) {
        JsonAt at = document_element(import, "extensionsRequired", i);
        const std::string& name = text_value(at);
        if (name == "KHR_texture_basisu")
            fail_at(at,
                    "requires the extension {}: its textures, of KTX 2, cannot be read; PNG, JPEG, WebP, "
                    "Radiance .hdr and OpenEXR can",
                    name);
        if (!is_among(modelled_extensions, name) && !is_among(passed_extensions, name))
            fail_at(at, "requires the extension {}, which is not known", name);
    }
    std::map<std::string, JsonAt> ignored;
    collect_ignored(import.root, ignored);
    for (size_t i = 0; i < array_size(import.root, "extensionsUsed"); ++i) {
        JsonAt at = document_element(import, "extensionsUsed", i);
        if (!is_among(modelled_extensions, text_value(at))) ignored.emplace(text_value(at), at);
    }
    for (const auto& [name, at] : ignored)
        warn(import, at, fmt::format("{} is not modelled yet: ignored", name));
}

void load_variants(GltfImport& import) {
    const std::string& wanted = import.options.variant;
    if (std::optional<JsonAt> extension = find_extension(import.root, "KHR_materials_variants"))
        for (size_t i = 0; i < array_size(*extension, "variants"); ++i)
            import.scene.variants.push_back(
                text_value(member(element(member(*extension, "variants"), i), "name")));
    if (wanted.empty()) return;
    const auto& names = import.scene.variants;
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found == names.end())
        fail_input("{}: has no variant '{}' of its materials; it has: {}", import.file_name, wanted,
                   names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")));
    import.variant = uint32_t(found - names.begin());
}

}  // namespace etendue
