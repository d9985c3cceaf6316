// Records of scene objects, filled from the scene file's parameters by name, as the class's reflection
// describes them.
#pragma once
#include <cstddef>
#include <cstring>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/measured/measured_bsdf.h"
#include "host/mie/mie_table.h"
#include "host/photometry/photometric_table.h"
#include "host/photometry/ray_set.h"
#include "host/geometry/bezier_pieces.h"
#include "host/scene/cell_mesh.h"
#include "host/scene/classes.h"
#include "host/scene/description.h"
#include "host/scene/micro_places.h"
#include "host/scene/watched_surface.h"
#include "host/lights/environment_map.h"
#include "host/lights/sky.h"
#include "host/scene/spectral_value.h"

namespace etendue {

// Twin in shaders/features/polarized_lights.glsl.
struct LightStokes {
    glm::vec3 stokes{0}, axis{1, 0, 0};
};

// Twin of struct SpectrumRef in shaders/features/spectrum.glsl.
struct SpectrumRef {
    glm::vec3 rgb{0};    // linear Rec.709
    uint32_t table = 0;  // index into Scene::spectra
};

// Twin of struct GratingOrders in shaders/surfaces/grating.glsl.
struct GratingOrders {
    uint32_t first = 0, count = 0;  // rows (host/scene/grating_orders.h)
};

// Twin of struct GratingTable there.
struct GratingTable {
    uint32_t first = 0xFFFFFFFFu;  // number (host/scene/grating_table.h); none
    uint32_t wavelengths = 0, sines = 0;
    uint32_t polarizes = 0, transmits = 0;
    GratingOrders orders = {};
};

// What typed members of a record refer to.
struct RecordResolver {
    const SceneDescription& scene;
    std::map<std::string, uint32_t> media;  // name -> RecordRef
    // Index of the Texture for a glTF textureInfo; `color`: its image is sRGB.
    std::function<uint32_t(const nlohmann::json& info, bool color, const std::string& where)> texture;
    std::function<EnvironmentMapRef(const std::filesystem::path& file, const std::string& where)>
        environment_map;
    // Index of a density in space that is given by a file.
    std::function<uint32_t(const nlohmann::json& value, const std::string& where)> grid =
        [](const nlohmann::json&, const std::string&) { return 0u; };
    // A point in the device's world.
    std::function<glm::vec3(const glm::dvec3& point)> world_point = [](const glm::dvec3& p) {
        return glm::vec3(p);
    };
    std::function<MeasuredRef(const std::filesystem::path& file)> measured =
        [](const std::filesystem::path&) { return MeasuredRef{}; };
    // Index of the table of Mueller matrices in a file.
    std::function<uint32_t(const std::filesystem::path& file)> mueller_table =
        [](const std::filesystem::path&) { return 0u; };
    // The orders of a grating and what each of them carries.
    std::function<GratingOrders(const nlohmann::json& value, const std::string& where)> grating =
        [](const nlohmann::json&, const std::string&) { return GratingOrders{}; };
    // Of the elements of a microstructure, whose parameters before that are filled already.
    std::function<MicroPlaces(const std::filesystem::path& file, const ClassInfo& info,
                              const std::vector<std::byte>& record)>
        places = [](const std::filesystem::path&, const ClassInfo&, const std::vector<std::byte>&) {
            return MicroPlaces{};
        };
    // Of SceneDescription::cells.
    std::function<CellMesh(uint32_t cell)> cell = [](uint32_t) { return CellMesh{}; };
    std::function<GratingTable(const nlohmann::json& value, const std::string& where)> grating_table =
        [](const nlohmann::json&, const std::string&) { return GratingTable{}; };
    // Of a patch: the piece that the record is of; null = the only one.
    const BezierPiece* piece = nullptr;
    std::function<PhotometryRef(const std::filesystem::path& file)> photometry =
        [](const std::filesystem::path&) { return PhotometryRef{}; };
    // Primitive of the shape at the node of the light that is being added.
    std::function<uint32_t(const std::string& where)> own_shape = [](const std::string&) {
        return 0xFFFFFFFFu;
    };
    // The rays of a file, for a record whose parameters before that are filled already.
    std::function<RayFileRef(const std::filesystem::path& file, const ClassInfo& info,
                             const std::vector<std::byte>& record, const std::string& where)>
        rays = [](const std::filesystem::path&, const ClassInfo&, const std::vector<std::byte>&,
                  const std::string&) { return RayFileRef{}; };
    // The mesh of that name, or of the node that the receiver stands at.
    std::function<WatchedSurface(const std::string& mesh, const std::string& where)> watched =
        [](const std::string&, const std::string&) { return WatchedSurface{}; };
    // The table of a record of the class mie, whose parameters are filled already.
    std::function<MieRef(const ClassInfo& info, const std::vector<std::byte>& record,
                         const std::string& where)>
        mie = [](const ClassInfo&, const std::vector<std::byte>&, const std::string&) { return MieRef{}; };
    // Of a record of the class sky, whose parameters are filled already.
    std::function<SkyRef(const ClassInfo& info, const std::vector<std::byte>& record,
                         const std::string& where)>
        sky = [](const ClassInfo&, const std::vector<std::byte>&, const std::string&) { return SkyRef{}; };
    // RecordRef of the phase function that stands at that place of the scene.
    std::function<uint32_t(const std::string& where)> phase = [](const std::string&) { return 0xFFFFFFFFu; };
    // Index of the table that a spectrum has where paths carry wavelengths.
    std::function<uint32_t(const SpectralValue& value, SpectralKind kind)> spectrum =
        [](const SpectralValue&, SpectralKind) { return 0u; };
};

constexpr uint32_t no_record = 0xFFFFFFFFu;
constexpr uint32_t record_ref(uint32_t tag, uint32_t index) { return tag << 24 | index; }
constexpr uint32_t record_index(uint32_t ref) { return ref & 0xFFFFFFu; }

// One record's bytes. `placement` (world_from_local) goes into members of type Placement. Unknown parameters,
// wrong types and values out of range fail with file, JSON pointer, and what is allowed.
std::vector<std::byte> fill_record(const ClassInfo& info, const ObjectDescription& object,
                                   const std::optional<glm::dmat4>& placement,
                                   const RecordResolver& resolver);

// A member of a record; it must be there.
template <class T>
T record_member(const ClassInfo& info, const std::vector<std::byte>& record, const std::string& name) {
    T value{};
    for (const Parameter& p : info.parameters)
        if (p.member.name == name) std::memcpy(&value, record.data() + p.member.offset, sizeof(T));
    return value;
}

// "surface/conductor/roughness".
std::string member_path(const ClassInfo& info, const std::string& member);

// The records of one interface in one buffer: each class's region starts at a multiple of its stride, so that
// all classes can be typed views of the buffer's start.
class RecordBuffer {
  public:
    void add(const ClassInfo& info, std::vector<std::byte> record);  // in any order
    // RecordRef of the `nth` record added of a class; valid after layout().
    uint32_t ref(const ClassInfo& info, uint32_t nth) const;
    uint32_t count(const ClassInfo& info) const;
    void layout();
    // For class_header: switches (whole numbers, truth values, absent textures, numbers that are 0 or 1,
    // vectors of such numbers) that have the same value in all records of the class.
    // Members whose path "surface/conductor/roughness" stands in `varying` are not among them.
    ClassConstants constant_members(const ClassInfo& info, const std::set<std::string>& varying) const;
    const std::vector<std::byte>& bytes() const { return bytes_; }

  private:
    struct Region {
        uint32_t tag, stride, first = 0;
        std::vector<std::byte> records;
    };
    std::map<std::string, Region> regions_;
    std::vector<std::byte> bytes_;
};

}  // namespace etendue
