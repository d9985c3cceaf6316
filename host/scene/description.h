// A scene as its file describes it: plain data, validated, in world units, before any class or device is
// known.
//
// The importer (gltf.h) makes one; compile_scene (scene.h) turns it into records, hierarchies and buffers.
// Units: metres, radians, nanometres; radiance so that (1,1,1) has luminance 1 cd/m².
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace etendue {

// One object of a class behind one of the six interfaces. `parameters` is a JSON object whose keys are
// members of the class's record (unknown keys are reported when the record is filled). Values follow the
// scene format; a glTF textureInfo is {"index": i, "texCoord": n, …} with `index` into
// SceneDescription::textures. Paths of files inside `parameters` are relative to SceneDescription::folder.
struct ObjectDescription {
    std::string class_name;
    nlohmann::json parameters = nlohmann::json::object();
    std::string where;  // JSON pointer of the object in the scene file, for messages
};

// The emission of a material. `value` is in the unit that `quantity` names: radiance and luminance in the
// unit of the image (1 = 1 cd/m² for white), power and flux of the whole emitting object in W (or lm for
// flux).
struct EmissionDescription {
    enum class Quantity { radiance, luminance, power, flux };
    Quantity quantity = Quantity::radiance;
    nlohmann::json value = 0.0;  // a spectral value
    nlohmann::json spectrum;     // a spectral value that multiplies `value`; null = 1
    nlohmann::json texture;      // glTF textureInfo (emissiveTexture), or null
    glm::dvec3 stokes{0};        // S1 to S3 over S0, x being the node's
    std::string where;
};

struct MaterialDescription {
    std::string name;
    ObjectDescription surface;
    std::string inside, outside;  // names of media; empty = none named
    uint32_t priority = 0;        // of the body among those that overlap; 0 = none
    std::optional<EmissionDescription> emission;
    bool double_sided = false;      // emits on both sides (surfaces scatter on both sides in any case)
    nlohmann::json normal_texture;  // glTF normalTextureInfo with `scale`, or null
};

struct MediumDescription {
    std::string name;
    ObjectDescription medium;
};

// One glTF primitive: indexed triangles. Every attribute array is empty or as long as `positions`.
struct MeshDescription {
    std::string name, where;
    std::vector<glm::vec3> positions;  // m, finite
    std::vector<glm::vec3> normals;    // unit
    std::vector<glm::vec4> tangents;   // unit, w = ±1
    std::vector<glm::vec2> uv0, uv1;
    std::vector<glm::vec4> colors;      // linear
    std::vector<glm::uvec3> triangles;  // all indices in range; triangles of zero area already left out
    uint32_t material = 0;  // index into SceneDescription::materials (a default one is appended if needed)
};

// `content`: what holds an object, and in whose frame its place is; 0 = the scene, i = ElementContent i - 1.
struct MeshInstance {
    uint32_t mesh = 0;
    glm::dmat4 world_from_local{1.0};
    std::string where;
    std::string name = {};  // of the node, else of the mesh
    uint32_t content = 0;
};

// The triangles that stand in each cell of a microstructure, in the frame of the cell: three corners each.
struct CellDescription {
    std::vector<glm::vec3> corners;  // m
    uint32_t scene = 0;              // of the file, that they are from
};
constexpr size_t most_cell_triangles = (1 << 22) - 1;  // the device has four numbers for each, in a float

// An object placed by a node: a geometry with its material, a light or a receiver.
struct PlacedObject {
    std::string name;
    ObjectDescription object;
    glm::dmat4 world_from_local{1.0};
    uint32_t material = 0;               // geometry only
    bool wants_stokes = false;           // receivers: S1 to S3 are wanted, too
    glm::dvec3 stokes{0};                // lights: S1 to S3 over S0, x being the node's
    std::optional<uint32_t> shape = {};  // lights: index of the geometry at the same node
    uint32_t content = 0;
};

// What an optical element holds, in its frame: the objects that name it as their content, within a closed
// boundary. Several elements may hold the same, unless it has lights, receivers or elements.
struct ElementContent {
    std::vector<MeshInstance>
        boundary;  // in its frame, facing outward; none = a box around all that it holds
    std::string where;
};

// An optical element: a black box of which the scene, or the element that holds it, knows only the boundary.
struct PlacedElement {
    std::string name, where;
    uint32_t content = 0;               // index into SceneObjects::contents
    uint32_t parent = 0;                // 0 = the scene, i = element i - 1, which stands before this one
    glm::dmat4 parent_from_local{1.0};  // turned and moved, not scaled
};

// 8-bit images keep their bytes; float images (.hdr, .exr) are linear.
struct ImageDescription {
    std::string name;
    std::filesystem::path file = {};  // empty = it stands in the scene file or in a buffer
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba8;  // 4 bytes a texel, or
    std::vector<float> rgba32f;  // 4 floats a texel; exactly one of the two is filled
};

enum class Wrap : uint32_t { repeat = 0, clamp = 1, mirror = 2 };
struct TextureDescription {
    uint32_t image = 0;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;
};

// Of events that befall light on its way from a lamp to a receiver: `least` to `most` of these kinds are at
// these objects. Kinds as `etendue rays` has them: emitted, reflected, refracted, straight, scattered;
// objects are lamps, nodes, shapes, materials and media, by name. Empty = any.
struct LayerCondition {
    std::set<std::string> events, objects;
    uint32_t least = 1;
    std::optional<uint32_t> most;  // none = any number
};
constexpr uint32_t most_counted_events = 16;

// A layer of images that holds the light which meets all conditions, and those of no layer before.
struct LightLayer {
    std::string name;
    std::vector<LayerCondition> conditions;
};

// A class file that the scene brings along: {"interface": "surface", "file": "velvet.glsl"}.
struct ClassFileDescription {
    std::string interface;       // surface, geometry, light, receiver, medium, phase
    std::filesystem::path file;  // as it can be opened
    std::string where;
};

// The part of a scene that is edited while one looks at it (live_scene.h): all but meshes and images.
struct SceneObjects {
    std::vector<MediumDescription> media;
    std::vector<MaterialDescription> materials;
    std::vector<MeshInstance> instances;
    std::vector<PlacedObject> shapes, lights, receivers;
    std::vector<ElementContent> contents;
    std::vector<PlacedElement> elements;
    uint32_t boundary_material = 0;  // of elements' boundaries, where there are elements
    std::optional<ObjectDescription> environment;
};

struct SceneDescription : SceneObjects {
    std::filesystem::path file, folder;
    std::vector<std::filesystem::path> buffer_files;  // of glTF buffers
    std::vector<ClassFileDescription> class_files;
    std::map<std::string, nlohmann::json> spectra;  // named spectral values
    std::vector<ImageDescription> images;
    std::vector<TextureDescription> textures;
    std::vector<MeshDescription> meshes;
    std::vector<CellDescription> cells;
    std::vector<std::string> variants;  // of its materials, by KHR_materials_variants
    double animation_seconds = 0;       // the end of its last animation; 0 = it has none
    // Contents of files that stand in the scene file itself, by the names that parameters have for them.
    std::map<std::string, std::string> embedded_files;
    std::vector<LightLayer> layers;     // of its images, where nobody asks for others
    std::vector<std::string> warnings;  // one line each: what was read but is not modelled
};

}  // namespace etendue
