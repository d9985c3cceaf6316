#include "host/gltf/gltf.h"

#include <nlohmann/json.hpp>

#include "host/image/atomic_file.h"
#include "host/gltf/import.h"

namespace etendue {

SceneDescription import_gltf(std::span<const uint8_t> bytes, const std::filesystem::path& file,
                             const ImportOptions& options) {
    GltfImport import;
    import.options = options;
    import.scene.file = file;
    import.scene.folder = file.parent_path();
    import.file_name = file.string();

    parse_document(import, bytes);
    check_extensions(import);
    load_variants(import);
    load_buffers(import);
    load_accessors(import);
    load_root_optics(import);
    load_materials(import);
    check_media_names(import);
    load_nodes(import);
    decode_images(import);
    return std::move(import.scene);
}

SceneDescription import_gltf(const std::filesystem::path& file, const ImportOptions& options) {
    std::vector<std::byte> bytes = read_whole_file(file);
    return import_gltf(octets(bytes), file, options);
}

}  // namespace etendue
