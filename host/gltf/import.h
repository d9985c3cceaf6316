// What the parts of the importer (gltf_*.cpp) share. Nothing else includes it.
#pragma once
#include <deque>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "host/scene/description.h"
#include "host/gltf/gltf.h"
#include "host/gltf/json.h"

namespace etendue {

using Bytes = std::vector<uint8_t>;

inline std::span<const uint8_t> octets(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

// Coordinates beyond this are refused: their squares must stay finite in 32-bit floats.
inline constexpr double max_coordinate = 1e18;
// Records are addressed by 24 bits.
inline constexpr size_t max_objects = size_t(1) << 24;

struct BufferView {
    std::span<const uint8_t> bytes;
    size_t stride = 0;  // bytes from one element to the next; 0 = no gap
};

enum class Component : uint32_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

// A checked accessor: every element lies inside the data.
struct Accessor {
    Component component = Component::f32;
    std::string type;  // SCALAR, VEC2, …
    uint32_t components = 1;
    bool normalized = false;
    size_t count = 0;
    const uint8_t* data = nullptr;  // null: zeros
    size_t stride = 0;              // bytes
    struct Sparse {
        size_t count = 0;
        Component index_component = Component::u32;
        const uint8_t* indices = nullptr;
        const uint8_t* values = nullptr;  // no gaps
    } sparse;
};

struct Bounds {
    glm::dvec3 low{DBL_MAX}, high{-DBL_MAX};
};

struct MeshRange {
    uint32_t first = 0, count = 0;  // in SceneDescription::meshes, one for each primitive that has triangles
    bool read = false;
};

struct GltfImport {
    ImportOptions options;
    SceneDescription scene;
    std::string file_name;
    nlohmann::json document;
    JsonAt root;

    std::span<const uint8_t> binary_chunk;  // of a .glb
    std::deque<std::vector<std::byte>>
        files;                  // what the buffers look at, where they are not in the scene file:
    std::deque<Bytes> decoded;  // other files and data URIs
    std::vector<std::span<const uint8_t>> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;

    std::vector<MeshRange> mesh_ranges;  // per glTF mesh, read when a node first uses it
    std::vector<Bounds> mesh_bounds;     // per SceneDescription::meshes
    std::vector<uint32_t> image_of;      // glTF image -> SceneDescription::images; UINT32_MAX = unused
    std::vector<uint32_t> texture_of;    // glTF texture -> SceneDescription::textures; UINT32_MAX = unused
    std::vector<uint32_t> images_to_decode;  // glTF image of each of SceneDescription::images
    uint32_t default_material = UINT32_MAX;
    std::set<std::string> warned;  // subjects of warnings that are given once
    struct {
        size_t triangles = 0, meshes = 0;
        std::string first_pointer, first_name;
    } zero_area;  // what was left out, for one warning
};

// A child of `object` as an array of the document: member(root, "meshes")[i].
JsonAt document_element(const GltfImport& import, const char* array, size_t index);

void warn(GltfImport& import, const JsonAt& at, const std::string& message);
// Only the first of several warnings on one subject is kept.
void warn_once(GltfImport& import, const std::string& subject, const JsonAt& at, const std::string& message);

// gltf_document.cpp: file, JSON, extensions, buffers, views.
void parse_document(GltfImport& import, std::span<const uint8_t> bytes);
void check_extensions(GltfImport& import);
void load_buffers(GltfImport& import);

// gltf_uri.cpp: what a URI refers to.
bool is_data_uri(const std::string& uri);
Bytes decode_data_uri(const JsonAt& uri);
std::filesystem::path resolve_uri(const GltfImport& import, const JsonAt& uri);  // an existing regular file

// gltf_accessors.cpp
void load_accessors(GltfImport& import);
const Accessor& accessor_at(const GltfImport& import, const JsonAt& index_at);
size_t component_size(Component component);
std::vector<uint32_t> read_indices(const Accessor& accessor);
// Elements first … first+count as floats (normalised integers mapped to [0,1] or [-1,1]), `out_stride` floats
// apart.
void read_floats(const Accessor& accessor, size_t first, size_t count, float* out, size_t out_stride);

// gltf_images.cpp
// Checks a textureInfo and returns it with `index` into SceneDescription::textures.
nlohmann::json read_texture_info(GltfImport& import, const JsonAt& info);
void decode_images(GltfImport& import);

// gltf_materials.cpp
void load_materials(GltfImport& import);
uint32_t default_material(GltfImport& import);
// A dielectric takes its refractive indices from the media on its sides. One without media named gets one
// inside, from the "ior" of its parameters, which lose it.
void take_medium_from_ior(GltfImport& import, MaterialDescription& material, const JsonAt& at,
                          nlohmann::json& parameters);

// gltf_optics.cpp: ETD_optics, cameras and lights.
void load_root_optics(GltfImport& import);
void read_material_optics(GltfImport& import, const JsonAt& optics, MaterialDescription& material);
void read_node_optics(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);
void check_media_names(const GltfImport& import);

// gltf_punctual.cpp: glTF's own cameras and lights.
void read_node_camera(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);
void read_node_light(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);

// gltf_meshes.cpp
MeshRange read_mesh(GltfImport& import, uint32_t gltf_mesh);

// gltf_nodes.cpp
void load_nodes(GltfImport& import);
// No axis of the local frame vanishes or lies in the plane of the other two.
bool is_invertible(const glm::dmat4& matrix);

}  // namespace etendue
