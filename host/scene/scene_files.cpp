#include "host/scene/scene_files.h"

#include "host/error.h"

namespace etendue {
namespace {

using Paths = std::vector<std::filesystem::path>;

void add_named(Paths& files, const nlohmann::json& value, const std::filesystem::path& folder) {
    std::error_code error;
    if (value.is_string()) {
        const std::filesystem::path file = folder / value.get<std::string>();
        if (std::filesystem::is_regular_file(file, error)) files.push_back(file);
    }
    if (value.is_structured())
        for (const nlohmann::json& part : value) add_named(files, part, folder);
}

}  // namespace

std::filesystem::path named_file(const SceneDescription& scene, const std::filesystem::path& name) {
    const std::filesystem::path file = scene.folder / name;
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (std::filesystem::is_other(status))
        fail_input("{}: the scene names {}, a device or a pipe; must be a regular file", scene.file.string(),
                   file.string());
    return file;
}

Paths files_of(const SceneDescription& scene) {
    Paths files = scene.buffer_files;
    for (const ImageDescription& image : scene.images)
        if (!image.file.empty()) files.push_back(image.file);
    for (const ClassFileDescription& file : scene.class_files) files.push_back(file.file);
    const auto add = [&](const nlohmann::json& value) { add_named(files, value, scene.folder); };
    for (const auto& [name, spectrum] : scene.spectra) add(spectrum);
    for (const MediumDescription& medium : scene.media) add(medium.medium.parameters);
    for (const MaterialDescription& material : scene.materials) {
        add(material.surface.parameters);
        if (material.emission) add(material.emission->value), add(material.emission->spectrum);
    }
    for (const auto* objects : {&scene.shapes, &scene.lights, &scene.receivers})
        for (const PlacedObject& object : *objects) add(object.object.parameters);
    if (scene.environment) add(scene.environment->parameters);
    return files;
}

}  // namespace etendue
