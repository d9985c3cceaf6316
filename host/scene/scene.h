// A scene ready to render: records, hierarchies and textures in device buffers, and the headers that make
// kernels hold only the classes and features the scene uses.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/error.h"
#include "host/gpu/kernel.h"
#include "host/scene/classes.h"
#include "host/scene/description.h"
#include "host/scene/path_modes.h"
#include "host/scene/features.h"
#include "host/spectra/spectrum.h"
#include "host/scene/records.h"
#include "host/scene/watched_surface.h"
#include "host/geometry/world.h"

namespace etendue {

struct Receiver {
    std::string name;
    uint32_t ref = no_record;
    float aspect_ratio = 0;          // of its image; 0 = the scene does not say
    uint32_t columns = 0, rows = 0;  // of its image, where the scene fixes them; else 0
    bool wants_stokes = false;       // S1 to S3, too
    const ClassInfo* info = nullptr;
    nlohmann::json parameters;         // as in the scene file
    glm::dmat4 world_from_local{1.0};  // in the coordinates of the scene file
    WatchedSurface watched;            // of a meter on a surface
    uint32_t element = 0;              // that it is in; 0 = the scene, i = element i - 1 of the description
};

// What was compiled of a kernel, for --stats and inspect; each once a scene.
struct KernelReport {
    std::string name;
    uint64_t key = 0;         // of ProgramStore
    bool from_store = false;  // the device had its program already, or
    bool from_cache = false;  // a folder its SPIR-V
    double seconds = 0;
    size_t spirv_bytes = 0;
    std::filesystem::path spirv;  // of the cache; empty = none
};

struct SceneMemory;

struct Scene {
    Features features;
    ShaderSources sources;                                       // with the generated headers
    std::map<Interface, std::vector<const ClassInfo*>> classes;  // in use
    std::shared_ptr<ClassRegistry> registry;
    std::map<std::string, Buffer> buffers;
    std::map<std::string, std::shared_ptr<Buffer>> shared_buffers;  // with SceneMemory
    std::vector<Receiver> receivers;
    uint64_t receiver_moves = 0;  // calls of move_receiver
    std::vector<std::string> warnings;
    // As the scene file has them: of materials, of lights in their order on the device (of area lights the
    // material's), of media by RecordRef.
    std::vector<std::string> material_names, light_names;
    std::map<uint32_t, std::string> medium_names;
    std::vector<PlacedElement> elements;  // of the description
    // Of instances of meshes, shapes and elements, and their materials'; which of them each primitive of the
    // world is of; those of lights, empty where they have none.
    std::vector<std::string> placed_names, placed_materials, light_shapes;
    std::shared_ptr<const std::vector<uint32_t>> placed;
    uint64_t triangles = 0, instances = 0, shapes = 0, lights = 0, materials = 0, textures = 0;
    glm::dvec3 center{0};  // of the device's world coordinates
    float radius = 0;      // m, of a sphere around everything
    double power = 0;      // of all lights, lm
    // Of each photometric and each ray file in use, what it holds: a line.
    std::map<std::filesystem::path, std::string> lamp_files;
    // Of lights whose light forward rays alone bring: their names.
    std::vector<std::string> unmet_lights;
    std::vector<LightLayer> layers;  // that the scene file asks for
    // That records refer to, radiances in units of even_luminance; the first is white light. Empty in
    // colours.
    std::vector<SpectralTable> spectra;
    bool reads_color_spectra = false;  // some kernel does, so that they must be there (host/spectra/color.h)
    std::optional<bool> has_narrow_materials;  // once asked (find_narrow_materials)
    double bvh_seconds = 0, bvh_cost = 0;
    uint32_t bvh_depth = 0;
    std::filesystem::path cache_folder;
    std::vector<KernelReport> kernels;
};

struct SceneOptions {
    std::filesystem::path shaders;       // folder of shaders instead of the embedded ones
    std::filesystem::path environment;   // image that takes the place of the scene's environment
    std::filesystem::path cache_folder;  // of compiled kernels; empty = none
    ColorMode color = ColorMode::automatic;
    PolarizationMode polarization = PolarizationMode::automatic;
    bool spectral_image = false;  // that is asked for: automatic color is spectral
    // "surface/conductor/roughness": members that kernels read from the records even where all have the same.
    // "places": where things stand, which kernels of small scenes otherwise hold as numbers.
    std::set<std::string> varying;
    SampleSequence samples = SampleSequence::sobol;
    // A class file of a scene is code: it reaches all memory of the process where the device is a CPU.
    bool allow_class_files = false;
    unsigned threads = 0;  // for building; 0 = all
};

// A scene that brings class files, which the options do not allow.
class ClassFilesRefused : public Error {
  public:
    using Error::Error;
};

// Errors: fail_input for what is wrong in the scene, fail_device for what the device cannot hold. `memory`:
// of earlier compilations (scene_memory.h).
Scene compile_scene(Device& device, const SceneDescription& description, const SceneOptions& options);
Scene compile_scene(Device& device, const SceneDescription& description, const SceneOptions& options,
                    SceneMemory& memory);

// Puts a receiver elsewhere, with other parameters: rewrites its record, compiles nothing. Images through it
// begin anew with Renderer::restart. Fails, and changes nothing, where a parameter is wrong or the placement
// is singular.
void move_receiver(Scene& scene, size_t receiver, const glm::dmat4& world_from_local,
                   const nlohmann::json& parameters);

// Compiles a kernel for the scene; `buffers` adds to the scene's own, `defines` to the features'.
Kernel make_kernel(Device& device, Scene& scene, const std::string& file, const BufferTable& buffers,
                   const std::string& defines = "");

// Bytes of an element of a buffer, as a kernel declares it: what stands in memory is declared by the shaders
// alone. Fails where the kernel has no such buffer.
uint64_t element_bytes(Device& device, Scene& scene, const std::string& file, const std::string& defines,
                       const std::string& buffer);

// Of a kernel, which is compiled for that, but by no driver.
uint64_t spirv_bytes(Device& device, Scene& scene, const std::string& file, const std::string& defines);

// While it lives, kernels of the scene are compiled for colours even where paths carry wavelengths: for what
// does not depend on them.
class InColors {
  public:
    explicit InColors(Scene& scene)
        : scene_(scene), spectral_(std::exchange(scene.features.spectral, false)) {}
    InColors(const InColors&) = delete;
    ~InColors() { scene_.features.spectral = spectral_; }

  private:
    Scene& scene_;
    bool spectral_;
};

// make_kernel() in colours.
Kernel make_color_kernel(Device& device, Scene& scene, const std::string& file, const BufferTable& buffers,
                         const std::string& defines = "");

}  // namespace etendue
