// What the compilation of a scene leaves for the next one of the same scene with other parameters: the layout
// of its classes, its world, its textures and files. Each part has a key and is made anew where that has
// changed.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/measured/measured_bsdf.h"
#include "host/measured/mueller_table.h"
#include "host/mie/mie_table.h"
#include "host/scene/cell_mesh.h"
#include "host/scene/classes.h"
#include "host/photometry/photometric_table.h"
#include "host/photometry/ray_set.h"
#include "host/scene/density_bricks.h"
#include "host/lights/emission_map.h"
#include "host/lights/environment_map.h"
#include "host/scene/features.h"
#include "host/scene/micro_places.h"
#include "host/scene/texture_pack.h"
#include "host/geometry/world.h"

namespace etendue {

// Of one device, and of descriptions that share their meshes, images and textures.
struct SceneMemory {
    uint64_t registry_key = 0;  // of the shaders and the scene's own class files
    std::shared_ptr<ClassRegistry> registry;

    // Files that parameters name: the contents of all of them, one behind the other.
    std::vector<glm::uvec4> environment_texels;  // floats, as bits
    std::map<std::filesystem::path, EnvironmentMapRef> environment_maps;
    std::optional<uint32_t> sky_texels;  // where in `environment_texels` those of a sky begin
    std::vector<float> photometric_values;
    struct PhotometricFile {
        PhotometryRef ref;
        std::string summary;
        std::vector<std::string> warnings;
    };
    std::map<std::filesystem::path, PhotometricFile> photometric_files;
    std::vector<uint32_t> ray_words;
    std::map<std::filesystem::path, RaySet> ray_files;
    DensityBricks density_bricks;
    struct DensityFile {
        DensityGridRecord record;
        glm::dmat4 world_from_lattice;
    };
    std::map<std::pair<std::filesystem::path, std::string>, DensityFile> density_files;
    MeasuredBsdf measured;
    struct MeasuredFile {
        MeasuredRef ref;
        SpectralValue place;
    };
    std::map<std::filesystem::path, MeasuredFile> measured_files;
    MuellerTables mueller_tables;
    std::map<std::filesystem::path, MuellerFile> mueller_files;
    MicroTables micro_tables;
    std::map<std::string, MicroPlaces> micro_files;  // by file and sheet
    CellTables cell_tables;
    std::map<uint32_t, CellMesh> cells;                       // of SceneDescription::cells
    std::vector<std::shared_ptr<const MieTable>> mie_tables;  // of the last compilation

    uint64_t world_key = 0;
    World world;  // its lights are those of the last compilation
    Features world_features;
    std::string unrolled_traversal;
    std::map<uint32_t, uint32_t> light_positions;  // of primitives, in the list of lights

    std::vector<TextureUse> texture_uses;  // that the packed textures are of
    uint32_t texture_formats = 0;
    struct LitTriangles {  // what drop_dark_triangles came to
        uint64_t key = 0;
        std::vector<TextureUse> textures;
        std::vector<uint32_t> primitives;
    } lit;
    struct EmittingParts {  // what map_emission came to
        uint64_t key = 0;
        std::vector<TextureUse> textures;
        EmissionMaps maps;
    } emission;

    // Of all that: scenes share them, so what has changed gets a new buffer.
    std::map<std::string, std::shared_ptr<Buffer>> buffers;
};

}  // namespace etendue
