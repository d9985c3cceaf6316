// Builds a Scene from its description, step by step; each step needs what the ones before it made. Internal
// to compile_scene: the steps stand in scene.cpp, scene_phases.cpp, scene_spectra.cpp, scene_materials.cpp,
// scene_geometry.cpp, scene_lights.cpp and scene_emission.cpp.
#pragma once
#include "host/lights/emission_map.h"
#include "host/lights/light_tree.h"
#include "host/scene/grating_table.h"
#include "host/scene/scene.h"
#include "host/scene/scene_memory.h"

namespace etendue {

// Twin of struct Material in shaders/lib/materials.glsl; a test compares the layouts.
struct MaterialRecord {
    SpectrumRef emission;
    uint32_t surface, inside, outside, flags, emission_texture, normal_texture;
    float normal_scale;
    uint32_t body;
};
enum MaterialFlag : uint32_t {
    emits_both_sides = 1,
    separates_media = 2,
    opaque = 4,
    narrow = 8,
    blocks = 16
};

// Fails where elements of a sheet of microstructure would be cut off, or have no shape.
void check_microstructure(const ClassInfo& info, const ObjectDescription& object, const std::string& place);
MicroSheet micro_sheet(const ClassInfo& info, const std::vector<std::byte>& record);

class SceneCompiler {
  public:
    SceneCompiler(Device& device, const SceneDescription& description, const SceneOptions& options,
                  SceneMemory& memory);
    Scene run();

  private:
    // scene.cpp and scene_phases.cpp
    void find_registry();
    void add_class_files();
    void add_media();
    void add_phases();  // of the media
    SpectralValue index_of(const MediumDescription& medium);
    MieRef add_mie(const ClassInfo& info, const std::vector<std::byte>& record, const std::string& where);
    void upload_mie();
    void write_headers();  // for the classes used and the records added so far
    const ClassInfo& find_class(Interface interface, const ObjectDescription& object);
    const ClassInfo& use_class(Interface interface, const ObjectDescription& object);
    // A record; its reference can be looked up once all records of the interface are there.
    struct Added {
        const ClassInfo* info;
        uint32_t nth;
    };
    Added add_record(Interface interface, const ObjectDescription& object,
                     const std::optional<glm::dmat4>& placement = {});
    std::vector<uint32_t> references(Interface interface, const std::vector<Added>& added);
    // Runs a kernel that asks the classes something, a lane an item; the push constant `first` is the first
    // lane's item.
    void run_once(const std::string& file, uint32_t items, const BufferTable& buffers,
                  std::vector<PushValue> values);

    // scene_grids.cpp
    EnvironmentMapRef add_environment_map(const std::filesystem::path& file);
    uint32_t add_grid(const nlohmann::json& value, const std::string& where);
    void upload_grids();

    // scene_spectra.cpp
    uint32_t add_spectrum(const SpectralValue& value, SpectralKind kind);
    SpectralValue emitted_spectrum(const EmissionDescription& emission);
    void scale_emission(MaterialRecord& record, float scale);
    void choose_color();
    void choose_polarization();

    // scene_materials.cpp
    void add_materials();
    std::vector<bool> used_materials() const;
    void fill_emission(const EmissionDescription& emission, MaterialRecord& record);
    bool has_bodies() const;  // materials with a priority
    void rank_bodies();
    void ask_opacity();
    uint32_t medium_ref(const std::string& name, const std::string& where);
    bool has_receptors();
    void check_crystal_face(const MaterialDescription& m);
    void add_textures();

    MeasuredRef add_measured(const std::filesystem::path& file);
    uint32_t add_mueller_table(const std::filesystem::path& file);
    void upload_measured();

    // scene_elements.cpp
    uint32_t element_of(uint32_t content) const;
    bool fills_elements(const MediumDescription& medium) const;
    uint32_t element_of_light(uint32_t i) const;
    void upload_elements();

    // scene_geometry.cpp
    void add_geometry();  // and where its centre is, from which positions are measured
    uint64_t world_key(const std::vector<ShapePart>& parts) const;
    void find_bounds(std::vector<ShapePart>& parts);
    void upload_world();
    void add_receivers();
    WatchedSurface add_watched(const std::string& mesh, const std::string& where);
    glm::dmat4 recentred(const glm::dmat4& world_from_local, uint32_t content) const;

    // scene_microstructures.cpp
    MicroPlaces add_places(const std::filesystem::path& file, const ClassInfo& info,
                           const std::vector<std::byte>& record);
    CellMesh add_cell(uint32_t cell);
    void upload_microstructures();

    // scene_lights.cpp
    uint32_t own_shape(const std::string& where);
    PhotometryRef add_photometry(const std::filesystem::path& file);
    SkyRef add_sky(const ClassInfo& info, const std::vector<std::byte>& record, const std::string& where);
    RayFileRef add_rays(const std::filesystem::path& file, const ClassInfo& info,
                        const std::vector<std::byte>& record, const std::string& where);
    void describe_lamp_file(const std::filesystem::path& file, const std::string& summary,
                            const std::vector<std::string>& warnings);
    void add_lights();
    const glm::dmat4& placed_transform(uint32_t index) const;
    void drop_dark_triangles(std::vector<uint32_t>& primitives);
    uint32_t primitive_of_light(uint32_t i) const;
    void measure_lights();
    void name_lights(const std::map<uint32_t, uint32_t>& positions);
    std::vector<LightBounds> run_measurement();
    void scale_powers(std::vector<LightBounds>& bounds);

    // scene_emission.cpp
    std::vector<uint32_t> emission_textures(uint32_t material);
    double texel_edge(const PrimitiveRecord& p, const std::vector<uint32_t>& textures) const;
    bool emission_varies();
    void map_emission();
    void shrink_to_lit(std::vector<LightBounds>& bounds) const;

    template <class T>
    void upload(const std::string& name, const std::vector<T>& data) {
        out_.buffers[name] = create_buffer(device_, data, name);
    }
    // Of the memory's: the buffer that earlier scenes have, unless it was forgotten because the data changed.
    template <class T>
    void share(const std::string& name, const std::vector<T>& data) {
        std::shared_ptr<Buffer>& buffer = memory_.buffers[name];
        if (!buffer) buffer = std::make_shared<Buffer>(create_buffer(device_, data, name));
        out_.shared_buffers[name] = buffer;
    }

    Device& device_;
    const SceneDescription& in_;
    const SceneOptions& options_;
    SceneMemory& memory_;
    unsigned threads_;
    Scene out_;
    RecordResolver resolver_;
    std::map<Interface, RecordBuffer> records_;
    std::vector<TextureUse> textures_;
    std::vector<DensityGridRecord> grids_;
    std::vector<glm::dmat4> grid_placements_;  // device_from_lattice
    bool uses_measured_ = false, has_sky_ = false;
    std::vector<MuellerTable> mueller_tables_;
    std::vector<GratingOrder> grating_orders_;
    std::vector<float> grating_numbers_;
    SpectralValue surrounding_;  // index of the medium whose phase function is being added
    std::vector<std::shared_ptr<const MieTable>> mie_tables_;
    std::vector<uint32_t> watched_words_;  // of meters on surfaces
    std::vector<WatchedSurface> watched_;  // … in the order of the receivers
    std::vector<MaterialRecord> materials_;
    std::vector<std::pair<SpectralValue, SpectralKind>> spectra_;  // that records refer to
    std::vector<SpectrumRef> ray_colors_;                          // of ray files
    std::map<std::string, uint32_t> phases_;                       // RecordRefs, by their places in the scene
    std::vector<uint32_t> lights_;                                 // RecordRefs
    std::vector<std::string> light_names_;                         // in the same order
    std::vector<LightStokes> light_stokes_;                        // … as well
    uint32_t first_area_light_ = 0;                                // in lights_, before they are sorted
    std::vector<uint32_t> area_primitives_;                        // of each area light
    bool is_within_element_ = false;                               // what is being added
    std::vector<uint32_t> light_elements_;                         // of the sorted lights: that they are in
    uint32_t opening_ = no_record;                                 // primitive of the light being added
    std::vector<uint32_t> opening_lights_;                         // … of each placed light
};

}  // namespace etendue
