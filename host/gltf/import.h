// What the parts of the importer (of this folder) share. Nothing else includes it.
#pragma once
#include <deque>
#include <functional>
#include <glm/gtc/quaternion.hpp>
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
// Meshes that targets and skins shape anew for each node cost the file nothing.
inline constexpr size_t max_deformed_vertices = size_t(1) << 27;
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

// The vertices of a primitive that its triangles use: others are not read.
struct VertexRange {
    size_t first = 0, count = 0;
};

// What animations say of a node at the moment that is wanted; what they do not say is the node's own.
struct NodePose {
    std::optional<glm::dvec3> translation, scale;
    std::optional<glm::dquat> rotation;
    std::optional<std::vector<double>> weights;  // of morph targets
};

// Of the mesh of a node.
struct Deformation {
    std::vector<double> weights;     // of morph targets; empty = all 0
    JsonAt weights_at;               // where they stand, for messages
    std::vector<glm::dmat4> joints;  // world_from_mesh of each joint of its skin; empty = no skin
    bool none() const { return weights.empty() && joints.empty(); }
};

using ImageMaker = std::function<ImageDescription(const std::vector<ImageDescription>& images)>;

// An optical element of a node, before what it holds is read.
struct ElementImport {
    std::optional<uint32_t> scene;  // of the file, that it holds
    glm::dmat3 scale;               // what of its node's transform is no turn
    JsonAt at;
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

    std::vector<NodePose> poses;      // per glTF node
    std::vector<uint32_t> parents;    // per glTF node, UINT32_MAX for roots
    std::vector<glm::dmat4> worlds;   // per glTF node, world_from_local; filled for the first skin
    size_t deformed_vertices = 0;     // of meshes that are made for a node alone
    std::optional<uint32_t> variant;  // of materials, that is wanted
    glm::dmat4 content_root{
        1.0};                 // of the nodes that are being placed: of elements what scales their contents
    uint32_t holder = 0;      // of them: 0 = the scene, i = element i - 1
    bool reads_cell = false;  // the nodes that are being placed stand in the cells of a microstructure
    std::vector<ElementImport> elements;  // that stand in the file, in the order of scene.elements
    std::vector<MeshRange> mesh_ranges;   // per glTF mesh, read when a node first uses it undeformed
    std::vector<Bounds> mesh_bounds;      // per SceneDescription::meshes
    std::vector<uint32_t> image_of;       // glTF image -> SceneDescription::images; UINT32_MAX = unused
    std::vector<uint32_t> texture_of;     // glTF texture -> SceneDescription::textures; UINT32_MAX = unused
    std::vector<uint32_t>
        images_to_decode;  // glTF image of each of SceneDescription::images; UINT32_MAX = made
    std::map<uint32_t, ImageMaker> images_to_make;  // index into SceneDescription::images
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

// document.cpp: file, JSON, extensions.
void parse_document(GltfImport& import, std::span<const uint8_t> bytes);
void check_extensions(GltfImport& import);
void load_variants(GltfImport& import);  // the names, and which is wanted

// buffers.cpp
void load_buffers(GltfImport& import);  // and views

// uri.cpp: what a URI refers to.
bool is_data_uri(const std::string& uri);
Bytes decode_data_uri(const JsonAt& uri);
std::filesystem::path resolve_uri(const GltfImport& import, const JsonAt& uri);  // an existing regular file

// accessors.cpp
void load_accessors(GltfImport& import);
const Accessor& accessor_at(const GltfImport& import, const JsonAt& index_at);
size_t component_size(Component component);
std::vector<uint32_t> read_indices(const Accessor& accessor);
// Elements first … first+count as floats (normalised integers mapped to [0,1] or [-1,1]), `out_stride` floats
// apart.
void read_floats(const Accessor& accessor, size_t first, size_t count, float* out, size_t out_stride);

// draco.cpp: data of the accessors of a primitive that KHR_draco_mesh_compression has packed.
void decode_draco(GltfImport& import, const JsonAt& primitive);

// images.cpp
// Checks a textureInfo and returns it with `index` into SceneDescription::textures.
nlohmann::json read_texture_info(GltfImport& import, const JsonAt& info);
// The texture of a textureInfo that was read, but with an image that is made of others once they are decoded.
nlohmann::json derived_texture(GltfImport& import, const nlohmann::json& info, ImageMaker make);
void decode_images(GltfImport& import);

// materials.cpp
void load_materials(GltfImport& import);
// As glTF names the alpha modes, for class `principled`.
int alpha_mode(const JsonAt& material);
uint32_t default_material(GltfImport& import);
// Fails unless a grating has orders, or a table of efficiencies.
void check_grating_form(const JsonAt& at, const ObjectDescription& surface);
// A dielectric takes its refractive indices from the media on its sides. One without media named gets one
// inside, from the "ior" of its parameters, which lose it.
void take_medium_from_ior(GltfImport& import, MaterialDescription& material, const JsonAt& at,
                          nlohmann::json& parameters);

// material_models.cpp: what extensions put in the place of metallic-roughness, as parameters of `principled`.
nlohmann::json specular_glossiness(GltfImport& import, const JsonAt& extension);
// The parameters, and the emission that shows the colour.
nlohmann::json unlit(GltfImport& import, const JsonAt& material, MaterialDescription& description);

// optics.cpp: ETD_optics, cameras and lights.
void load_root_optics(GltfImport& import);
void read_material_optics(GltfImport& import, const JsonAt& optics, MaterialDescription& material);
void read_node_optics(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);
void check_media_names(const GltfImport& import);

// punctual.cpp: glTF's own cameras and lights.
void read_node_camera(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);
void read_node_light(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);
void read_node_profile(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local);

// meshes.cpp
MeshRange read_mesh(GltfImport& import, uint32_t gltf_mesh, const Deformation& deformation);

// attributes.cpp
void read_attributes(GltfImport& import, const JsonAt& attributes, size_t vertex_count, VertexRange range,
                     MeshDescription& mesh);
bool are_within_limits(const std::vector<glm::vec3>& positions);  // finite, none beyond max_coordinate
// Changes of the attributes of a morph target's vertices; those that it does not change are empty.
MeshDescription read_morph_target(GltfImport& import, const JsonAt& target, size_t vertex_count,
                                  VertexRange range);
// Of JOINTS_n, whole numbers, and WEIGHTS_n.
std::vector<glm::vec4> read_joints(GltfImport& import, const JsonAt& attributes, const std::string& name,
                                   VertexRange range, size_t vertex_count);
std::vector<glm::vec4> read_joint_weights(GltfImport& import, const JsonAt& attributes,
                                          const std::string& name, VertexRange range, size_t vertex_count);

// animations.cpp: how long the animations last, and poses at the moment that is wanted.
void pose_nodes(GltfImport& import);

// deformation.cpp
size_t morph_targets(const GltfImport& import, const JsonAt& node);  // of the node's mesh
Deformation deformation_of(GltfImport& import, uint32_t node);       // of a node with a mesh
// Both change a mesh whose attributes are those of the vertices in `range`.
void morph(GltfImport& import, const JsonAt& primitive, size_t vertex_count, VertexRange range,
           const Deformation& deformation, MeshDescription& mesh);
void skin(GltfImport& import, const JsonAt& attributes, size_t vertex_count, VertexRange range,
          const Deformation& deformation, MeshDescription& mesh);

// elements.cpp
void read_element(GltfImport& import, const JsonAt& at, const std::string& name,
                  const glm::dmat4& parent_from_local);
void load_elements(GltfImport& import, uint32_t root_scene);  // what they hold

// element_boundaries.cpp
// The closed meshes that an element of class subscene names; none = a box around all that it holds.
std::vector<MeshInstance> read_boundary(GltfImport& import, const JsonAt& element);
// The boundary of the content that is being placed: a box around the node's z axis.
void bound_by_box(GltfImport& import, const JsonAt& at, const std::vector<double>& size, double low,
                  double high);

// grating_elements.cpp: an element of that class, a plate in the middle of a box.
void place_grating(GltfImport& import, const JsonAt& at);

// lens_elements.cpp: the surfaces, housing and media of an element of class lens_system, placed in its frame.
void place_lens_system(GltfImport& import, const JsonAt& at);
// microstructures.cpp
// Of a sheet of class microstructure: "placement" and "cell" as its record has them; reads what they name.
void name_parts(GltfImport& import, const JsonAt& at, nlohmann::json& parameters);
// The only object of an element of that class, within a box that it fills from side to side.
void place_microstructure(GltfImport& import, const JsonAt& at);

// nodes.cpp
void load_nodes(GltfImport& import);
void place_nodes(GltfImport& import, uint32_t scene);                 // of the file, below content_root
glm::dmat4 local_transform(const GltfImport& import, uint32_t node);  // as posed
// No axis of the local frame vanishes or lies in the plane of the other two.
bool is_invertible(const glm::dmat4& matrix);

}  // namespace etendue
