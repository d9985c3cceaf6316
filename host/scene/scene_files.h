// The files that a scene names, beside the scene file itself.
#pragma once
#include <filesystem>
#include <vector>

#include "host/scene/description.h"

namespace etendue {

// Buffers and images of the glTF file, classes of the scene's own, and every file that a value names:
// spectra, maps, grids, measured surfaces.
std::vector<std::filesystem::path> files_of(const SceneDescription& scene);

// The file of a name that stands in the scene, relative to its folder. Devices and pipes, which have no end
// or act when they are read, are refused: a scene that others made may name anything.
std::filesystem::path named_file(const SceneDescription& scene, const std::filesystem::path& name);

}  // namespace etendue
