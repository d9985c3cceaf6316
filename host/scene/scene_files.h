// Which files a scene was read from, beside the scene file itself.
#pragma once
#include <filesystem>
#include <vector>

#include "host/scene/description.h"

namespace etendue {

// Buffers and images of the glTF file, classes of the scene's own, and every file that a value names:
// spectra, maps, grids, measured surfaces.
std::vector<std::filesystem::path> files_of(const SceneDescription& scene);

}  // namespace etendue
