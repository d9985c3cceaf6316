#include "host/scene/scene.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <thread>

#include "host/error.h"
#include "host/gpu/program_store.h"
#include "host/scene/scene_compiler.h"
#include "host/scene/scene_files.h"

namespace etendue {

SceneCompiler::SceneCompiler(Device& device, const SceneDescription& description, const SceneOptions& options,
                             SceneMemory& memory)
    : device_(device),
      in_(description),
      options_(options),
      memory_(memory),
      threads_(options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency())),
      resolver_{description, {}, {}, {}} {
    resolver_.spectrum = [this](const SpectralValue& value, SpectralKind kind) {
        return add_spectrum(value, kind);
    };
    resolver_.texture = [this](const nlohmann::json& info, bool color, const std::string& where) {
        const auto content = color ? TextureContent::color : TextureContent::data;
        return texture_index(textures_,
                             parse_texture_info(info, content, in_.textures, message_place(in_, where)));
    };
    resolver_.environment_map = [this](const std::filesystem::path& file, const std::string&) {
        return add_environment_map(named_file(in_, file));
    };
    resolver_.grid = [this](const nlohmann::json& value, const std::string& where) {
        return add_grid(value, where);
    };
    resolver_.world_point = [this](const glm::dvec3& point) {
        return glm::vec3(is_within_element_ ? point : point - out_.center);
    };
    resolver_.measured = [this](const std::filesystem::path& file) { return add_measured(file); };
    resolver_.mueller_table = [this](const std::filesystem::path& file) { return add_mueller_table(file); };
    resolver_.grating = [this](const nlohmann::json& value, const std::string& where) {
        return append(grating_orders_, read_grating_orders(value, in_, where, resolver_.spectrum));
    };
    resolver_.places = [this](const std::filesystem::path& file, const ClassInfo& info,
                              const std::vector<std::byte>& record) {
        return add_places(file, info, record);
    };
    resolver_.cell = [this](uint32_t cell) { return add_cell(cell); };
    resolver_.grating_table = [this](const nlohmann::json& value, const std::string& where) {
        return append(grating_orders_, grating_numbers_, read_grating_table(value, in_, where));
    };
    resolver_.own_shape = [this](const std::string& where) { return own_shape(where); };
    resolver_.photometry = [this](const std::filesystem::path& file) { return add_photometry(file); };
    resolver_.watched = [this](const std::string& mesh, const std::string& where) {
        return add_watched(mesh, where);
    };
    resolver_.sky = [this](const ClassInfo& info, const std::vector<std::byte>& record,
                           const std::string& where) { return add_sky(info, record, where); };
    resolver_.rays = [this](const std::filesystem::path& file, const ClassInfo& info,
                            const std::vector<std::byte>& record,
                            const std::string& where) { return add_rays(file, info, record, where); };
    resolver_.mie = [this](const ClassInfo& info, const std::vector<std::byte>& record,
                           const std::string& where) { return add_mie(info, record, where); };
}

Scene SceneCompiler::run() {
    out_.warnings = in_.warnings;
    out_.layers = in_.layers;
    add_spectrum({glm::vec3(1), {}}, SpectralKind::radiance);  // white light: features/spectrum.glsl
    out_.cache_folder = options_.cache_folder;
    out_.features.independent_samples = options_.samples == SampleSequence::independent;
    out_.sources.folder = options_.shaders;
    out_.sources.keep_folder();
    find_registry();
    add_geometry();
    add_media();
    add_materials();
    upload_grids();
    if (memory_.world.bounds.empty() && !in_.environment && options_.environment.empty()) {
        if (in_.lights.empty() || in_.receivers.empty())
            fail_input(
                "{}: the scene is empty: it has neither geometry nor an environment, nor a light with a "
                "receiver",
                in_.file.string());
        out_.radius = 1;  // any will do
    }
    add_receivers();
    add_lights();
    add_textures();
    write_headers();
    measure_lights();
    upload_elements();
    choose_polarization();
    choose_color();
    return std::move(out_);
}

// As choose_color(): what measures lights and materials does so without.
void SceneCompiler::choose_polarization() {
    bool polarizes = false;
    for (const auto& [interface, classes] : out_.classes)
        for (const ClassInfo* info : classes) polarizes |= info->polarizes;
    polarizes |= out_.features.polarized_lights;
    for (const Receiver& receiver : out_.receivers) polarizes |= receiver.wants_stokes;
    out_.features.polarization = options_.polarization == PolarizationMode::on ||
                                 (options_.polarization == PolarizationMode::automatic && polarizes);
    if (out_.features.polarization && !mueller_tables_.empty())
        share("MuellerRatios", memory_.mueller_tables.ratios);
}

// Classes are reflected at first use, which takes a compilation.
void SceneCompiler::find_registry() {
    if (!in_.class_files.empty() && !options_.allow_class_files)
        throw ClassFilesRefused(
            ExitCode::bad_input,
            fmt::format(
                "{}: the class file {} is code that this scene brings along, which may do whatever you "
                "may; give --allow-class-files where you trust it",
                message_place(in_, in_.class_files[0].where), in_.class_files[0].file.string()));
    uint64_t key = out_.sources.hash();
    for (const ClassFileDescription& file : in_.class_files) {
        std::ifstream stream(file.file, std::ios::binary);
        const std::string text = (std::ostringstream() << stream.rdbuf()).str();
        key = hash_text(text, hash_text(file.file.string(), hash_text(file.interface, key)));
    }
    if (memory_.registry && memory_.registry_key == key) {
        out_.registry = memory_.registry;
        return;
    }
    out_.registry = std::make_shared<ClassRegistry>(out_.sources, options_.cache_folder);
    add_class_files();
    memory_.registry = out_.registry;
    memory_.registry_key = key;
}

void SceneCompiler::add_class_files() {
    for (const ClassFileDescription& file : in_.class_files) {
        const auto& interfaces = all_interfaces();
        const auto found = std::find_if(interfaces.begin(), interfaces.end(),
                                        [&](auto& i) { return file.interface == i.name; });
        if (found == interfaces.end())
            fail_input(
                "{}/interface: there is no interface {}; allowed: geometry, light, receiver, surface, "
                "medium, phase",
                message_place(in_, file.where), file.interface);
        out_.registry->add_class_file(found->interface, file.file);
    }
}

void SceneCompiler::add_media() {
    add_phases();
    std::vector<Added> added;
    for (const MediumDescription& medium : in_.media) {
        is_within_element_ = fills_elements(medium);
        added.push_back(add_record(Interface::medium, medium.medium));
    }
    is_within_element_ = false;
    const auto refs = references(Interface::medium, added);
    for (size_t i = 0; i < refs.size(); ++i) {
        resolver_.media[in_.media[i].name] = refs[i];
        out_.medium_names[refs[i]] = in_.media[i].name;
    }
    if (refs.empty()) return;
    out_.features.interfaces = true;
    write_headers();
    upload("MediumRecords", records_[Interface::medium].bytes());
    const Buffer in = create_buffer(device_, refs, "MediumRefs");
    const Buffer out(device_, refs.size() * 4, "MediumEffects");
    run_once("kernels/measure_media.comp", uint32_t(refs.size()),
             {{"MediumRefs", &in}, {"MediumEffects", &out}}, {{"count", uint32_t(refs.size())}});
    for (uint32_t effect : out.read_array<uint32_t>(refs.size())) {
        out_.features.media |= (effect & 3) != 0;
        out_.features.scattering |= (effect & 2) != 0;
        out_.features.even_scattering |= (effect & 8) != 0;
        out_.features.bending |= (effect & 4) != 0;
    }
    if (!out_.features.scattering) out_.classes.erase(Interface::phase);
}

const ClassInfo& SceneCompiler::find_class(Interface interface, const ObjectDescription& object) {
    const ClassInfo* info = out_.registry->find(interface, object.class_name);
    if (!info) {
        std::string names;
        for (const ClassInfo& known : out_.registry->classes(interface))
            names += (names.empty() ? "" : ", ") + known.name;
        fail_input("{}/class: there is no {} class {}; allowed: {}", message_place(in_, object.where),
                   interface_info(interface).name, object.class_name, names.empty() ? "none" : names);
    }
    return *info;
}

const ClassInfo& SceneCompiler::use_class(Interface interface, const ObjectDescription& object) {
    const ClassInfo* info = &find_class(interface, object);
    auto& used = out_.classes[interface];
    const auto place =
        std::lower_bound(used.begin(), used.end(), info, [](auto* a, auto* b) { return a->tag < b->tag; });
    if (place == used.end() || *place != info) used.insert(place, info);
    out_.features.general_mueller |= info->has_general_mueller || info->is_crystal;
    out_.features.crystals |= info->is_crystal;
    out_.features.body_mueller |= info->has_body_mueller;
    out_.features.apertures |= info->has_aperture;
    out_.features.far_receivers |= info->is_far;
    out_.features.surface_meters |= info->on_surface;
    return *info;
}

SceneCompiler::Added SceneCompiler::add_record(Interface interface, const ObjectDescription& object,
                                               const std::optional<glm::dmat4>& placement) {
    const ClassInfo& info = use_class(interface, object);
    RecordBuffer& records = records_[interface];
    records.add(info, fill_record(info, object, placement, resolver_));
    return {&info, records.count(info) - 1};
}

std::vector<uint32_t> SceneCompiler::references(Interface interface, const std::vector<Added>& added) {
    records_[interface].layout();
    std::vector<uint32_t> refs;
    for (const Added& a : added) refs.push_back(records_[interface].ref(*a.info, a.nth));
    return refs;
}

void SceneCompiler::write_headers() {
    for (const InterfaceInfo& interface : all_interfaces()) {
        const auto& classes = out_.classes[interface.interface];
        std::map<std::string, ClassConstants> constants;
        // Receivers move and zoom while the kernels stay.
        if (interface.interface != Interface::receiver)
            for (const ClassInfo* info : classes)
                constants[info->name] =
                    records_[interface.interface].constant_members(*info, options_.varying);
        out_.sources.generated[fmt::format("generated/{}_classes.glsl", interface.name)] =
            class_header(interface, classes, constants);
    }
    for (const auto& [name, text] : out_.registry->sources().generated) out_.sources.generated[name] = text;
}

void SceneCompiler::run_once(const std::string& file, uint32_t items, const BufferTable& buffers,
                             std::vector<PushValue> values) {
    const Kernel kernel = make_kernel(device_, out_, file, buffers);
    const uint32_t size = kernel.group_size();
    CommandList list(device_);
    values.push_back({"first", 0u});
    for (uint32_t first = 0; first < items; first += std::min(items - first, max_groups * size)) {
        values.back().bits = first;
        list.dispatch(kernel, std::min((items - first + size - 1) / size, max_groups), values);
    }
    list.run();
}

Scene compile_scene(Device& device, const SceneDescription& description, const SceneOptions& options) {
    SceneMemory memory;
    return compile_scene(device, description, options, memory);
}

Scene compile_scene(Device& device, const SceneDescription& description, const SceneOptions& options,
                    SceneMemory& memory) {
    return SceneCompiler(device, description, options, memory).run();
}

namespace {

// What a kernel reads by name: `buffers`, and behind them the scene's own.
BufferTable with_buffers_of(const Scene& scene, const BufferTable& buffers) {
    BufferTable table = buffers;
    for (const auto& [name, buffer] : scene.buffers) table.emplace(name, &buffer);
    for (const auto& [name, buffer] : scene.shared_buffers) table.emplace(name, buffer.get());
    return table;
}

std::shared_ptr<const Program> make_program(Device& device, Scene& scene, const std::string& file,
                                            const BufferTable& table, const std::string& defines) {
    CompileOptions options;
    options.defines = scene.features.defines() + defines;
    options.cache_folder = scene.cache_folder;
    uint64_t key = hash_text(file, hash_text(options.defines, scene.sources.hash()));
    std::set<std::string> not_texels;
    if (device.description.max_texels > 0) not_texels = beyond_texels(device, table);
    for (const std::string& name : not_texels) key = hash_text(name, key);
    std::shared_ptr<const Program> program = device.programs->find(key);
    KernelReport report{"", key, true, true, 0, 0};
    if (!program) {
        report.from_store = false;
        const CompiledShader shader = compile_shader(scene.sources, file, options);
        report.from_cache = shader.from_cache, report.seconds = shader.seconds;
        program = std::make_shared<const Program>(device, shader, not_texels);
        device.programs->add(key, program);
    }
    report.name = program->name(), report.spirv_bytes = program->spirv_bytes();
    // Whoever makes a program from its file alone knows of no buffers.
    if (not_texels.empty()) report.spirv = program->file();
    if (std::none_of(scene.kernels.begin(), scene.kernels.end(), [&](auto& k) { return k.key == key; }))
        scene.kernels.push_back(report);
    return program;
}

}  // namespace

Kernel make_kernel(Device& device, Scene& scene, const std::string& file, const BufferTable& buffers,
                   const std::string& defines) {
    const BufferTable table = with_buffers_of(scene, buffers);
    Kernel kernel(device, make_program(device, scene, file, table, defines), table);
    for (const auto& block : kernel.layout().blocks)
        scene.reads_color_spectra |= block.name == "ColorSpectra";
    return kernel;
}

uint64_t element_bytes(Device& device, Scene& scene, const std::string& file, const std::string& defines,
                       const std::string& buffer) {
    return make_program(device, scene, file, with_buffers_of(scene, {}), defines)
        ->layout()
        .element_bytes(buffer);
}

uint64_t spirv_bytes(Device& device, Scene& scene, const std::string& file, const std::string& defines) {
    return make_program(device, scene, file, with_buffers_of(scene, {}), defines)->spirv_bytes();
}

Kernel make_color_kernel(Device& device, Scene& scene, const std::string& file, const BufferTable& buffers,
                         const std::string& defines) {
    const InColors colors(scene);
    return make_kernel(device, scene, file, buffers, defines);
}

}  // namespace etendue
