// etendue inspect: what a scene holds, what it makes the shaders compile, and why.
#include <fmt/core.h>

#include "host/error.h"
#include "host/open_scene.h"
#include "host/render/automatic.h"
#include "host/render/renderer.h"

namespace etendue {
namespace {

RenderSettings render_settings(const Receiver& receiver, const InspectOptions& options) {
    const ImageSize size = image_size(receiver, options);
    RenderSettings settings;
    settings.receiver = receiver.ref;
    settings.width = size.width, settings.height = size.height;
    settings.algorithm = options.algorithm;
    return settings;
}

// What `auto` chooses, and the words by which every machine renders so.
void print_choice(OpenedScene& opened, const Receiver& receiver, const InspectOptions& options) {
    const AlgorithmChoice choice =
        choose_algorithm(*opened.device, opened.scene, render_settings(receiver, options));
    nlohmann::json json = to_json(choice);
    json.erase("is_open");
    std::vector<std::string> words = {"--algorithm", algorithm_name(choice.algorithm)};
    if (choice.algorithm != Algorithm::backward)
        words.insert(words.end(), {"--forward-paths", fmt::format("{}", choice.forward_paths)});
    json["arguments"] = words;
    fmt::print("{}\n", json.dump(2));
}

// Of each what it is and what it stands in.
void print_elements(const Scene& scene) {
    const auto name_of = [&](uint32_t element) {
        const std::string& name = scene.elements[element].name;
        return name.empty() ? std::string("(unnamed)") : printable(name);
    };
    uint32_t contents = 0;
    for (const PlacedElement& element : scene.elements) contents = std::max(contents, element.content + 1);
    fmt::print("elements   {}, which hold {} different things\n", scene.elements.size(), contents);
    constexpr size_t most = 16;
    for (size_t i = 0; i < std::min(scene.elements.size(), most); ++i) {
        const uint32_t parent = scene.elements[i].parent;
        fmt::print("    {:<18} in {}\n", name_of(uint32_t(i)),
                   parent == 0 ? "the scene" : name_of(parent - 1));
    }
    if (scene.elements.size() > most) fmt::print("    and {} more\n", scene.elements.size() - most);
}

}  // namespace

int inspect_command(const InspectOptions& options) {
    OpenedScene opened = open_scene(options);
    const Device& device = *opened.device;
    Scene& scene = opened.scene;
    const bool any = !scene.receivers.empty() || !options.receiver.empty();
    const Receiver* chosen = any ? &choose_receiver(scene, options) : nullptr;
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "warning: {}\n", printable(warning));
    if (options.json) {
        if (!chosen) choose_receiver(scene, options);  // which fails with a line
        print_choice(opened, *chosen, options);
        return 0;
    }

    fmt::print("scene      {}\n", options.scene.string());
    fmt::print(
        "geometry   {} triangles, {} instances, {} shapes; sphere of radius {:.6g} m around ({:.6g}, {:.6g}, "
        "{:.6g})\n",
        scene.triangles, scene.instances, scene.shapes, scene.radius, scene.center.x, scene.center.y,
        scene.center.z);
    fmt::print("hierarchy  built in {:.3f} s, cost {:.1f}, depth {}\n", scene.bvh_seconds, scene.bvh_cost,
               scene.bvh_depth);
    if (!scene.elements.empty()) print_elements(scene);
    fmt::print("materials  {}, textures {}\n", scene.materials, scene.textures);
    if (!opened.variants.empty())
        fmt::print("variants   {}\n", printable(fmt::format("{}", fmt::join(opened.variants, ", "))));
    if (opened.animation_seconds > 0) fmt::print("animations {:.6g} s\n", opened.animation_seconds);
    fmt::print("lights     {} ({} at infinity), {:.6g} lm, selected by {}\n", scene.lights,
               scene.features.infinite_light_count, scene.power,
               scene.features.light_tree ? "a tree" : "a list");
    for (const auto& [file, summary] : scene.lamp_files)
        fmt::print("lamp       {}: {}\n", printable(file.string()), printable(summary));
    fmt::print("receivers ");
    for (const Receiver& receiver : scene.receivers)
        fmt::print(" {}", receiver.name.empty() ? "(unnamed)" : printable(receiver.name));
    fmt::print("\nclasses   ");
    for (const auto& [interface, classes] : scene.classes)
        for (const ClassInfo* info : classes)
            fmt::print(" {}/{}", interface_info(interface).name, info->name);

    const Features& f = scene.features;
    fmt::print("\nfeatures\n");
    const auto feature = [](bool on, const char* name, const char* why_on, const char* why_off) {
        fmt::print("    {:<18} {:<4} {}\n", name, on ? "on" : "off", on ? why_on : why_off);
    };
    feature(f.triangles, "triangles", "meshes", "no mesh");
    feature(f.shapes, "shapes", "analytic geometry", "no analytic geometry");
    feature(f.instances, "instances", "meshes placed several times", "every mesh is merged in world space");
    feature(f.elements, "elements", "rays go into optical elements and out of them", "no optical elements");
    feature(f.vertex_attributes, "vertex attributes", "normals, tangents, texture coordinates or colors",
            "positions only");
    feature(f.textures, "textures", "materials use images", "no material uses an image");
    feature(f.normal_maps, "normal maps", "a material has one", "no material has one");
    feature(f.shading_normals, "shading normals", "some normals are not those of their triangles",
            "all normals are those of the surface");
    feature(f.twins, "twins", "two sheets at one place face apart", "no two sheets at one place face apart");
    feature(f.emission_maps, "emission maps", "textures or alpha make parts of lights brighter than others",
            "no texture or alpha makes parts of lights brighter than others");
    feature(f.spectral, "spectral",
            "a value is a spectrum, or there is a grating: paths carry four wavelengths",
            "no value is a spectrum: paths carry three channels");
    feature(f.dispersion, "dispersion", "a refractive index or a grating parts wavelengths",
            "all wavelengths go the same ways");
    feature(f.polarization, "polarization", "rays carry Stokes vectors",
            "no class polarizes on purpose: what reflection and refraction do to polarization is neglected "
            "(--polarization on)");
    feature(f.interfaces, "interfaces", "surfaces separate media", "no medium named");
    feature(f.media, "media", "a medium absorbs or scatters", "no medium absorbs");
    feature(f.scattering, "scattering", "a medium scatters: paths have vertices between surfaces",
            "no medium scatters");
    feature(f.bending, "bent rays", "the refractive index of a medium varies in space",
            "every medium has one refractive index");
    feature(f.straight, "straight passage",
            "a surface class lets light pass unscattered: shadow rays go through",
            "shadow rays end at the first surface");

    if (chosen) {
        const Renderer renderer(*opened.device, scene, render_settings(*chosen, options));
        const AlgorithmChoice& choice = renderer.choice();
        fmt::print("algorithm  {}, {} schedule: {}\n", algorithm_name(choice.algorithm),
                   schedule_name(renderer.schedule()), choice.reason);
        if (choice.algorithm == Algorithm::bidirectional)
            fmt::print("           {} forward paths a pixel and pass\n", choice.forward_paths);
    }
    fmt::print("kernels\n");
    for (const KernelReport& k : scene.kernels)
        fmt::print(
            "    {:<18} {} bytes of SPIR-V, {}\n", k.name, k.spirv_bytes,
            k.from_cache ? std::string("from the cache") : fmt::format("compiled in {:.2f} s", k.seconds));
    fmt::print("memory     {:.1f} MiB on {} ({})\n", double(device.peak_bytes_allocated) / (1 << 20),
               device.description.name, device.description.driver);
    return 0;
}

}  // namespace etendue
