// The scene importer: a glTF 2.0 file (.gltf or .glb), with the extension ETD_optics, becomes a
// SceneDescription.
//
// Everything that the file says is checked here, so that later stages meet indices in range, finite numbers
// and references that exist. A fault ends the import with one line, "FILE: /json/pointer: what is wrong; what
// is allowed". What is read but not modelled stands in SceneDescription::warnings.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host/scene/description.h"

namespace etendue {

// What is wanted of a file that offers several things.
struct ImportOptions {
    std::string variant;            // of its materials; empty = those of its meshes
    std::optional<double> seconds;  // the moment of its animations, all at once; none = as the nodes stand

    bool operator==(const ImportOptions&) const = default;
};

SceneDescription import_gltf(const std::filesystem::path& file, const ImportOptions& options = {});

// The same for bytes already in memory (either form). `file` names the scene in messages, and the folder of
// `file` is where relative URIs are looked up.
SceneDescription import_gltf(std::span<const uint8_t> bytes, const std::filesystem::path& file,
                             const ImportOptions& options = {});

// What is wrong with a material that has a priority; null = nothing.
const char* priority_error(const MaterialDescription& material);

}  // namespace etendue
