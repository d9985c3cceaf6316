// What a film holds as a checkpoint and back: for render, which makes and goes on from them, and merge.
#pragma once
#include <filesystem>

#include "host/image/checkpoint.h"
#include "host/open_scene.h"
#include "host/render/renderer.h"

namespace etendue {

// Of what was rendered, whoever did it: the bytes of all files of the scene, and all shaders.
nlohmann::json source_hashes(const OpenedScene& opened, const SceneChoice& choice);

// Everything that passes must agree on to be parts of one render: `sources` and what was asked for and
// chosen. Devices are no part of it: what theirs make agrees within rounding.
nlohmann::json render_identity(const nlohmann::json& sources, const RenderOptions& options,
                               const Scene& scene, const std::vector<const Receiver*>& receivers,
                               const Renderer& renderer);

// The passes that a renderer has. `earlier`: Checkpoint::about of those that it went on from; empty = none.
Checkpoint to_checkpoint(const nlohmann::json& identity, const Renderer& renderer, const Device& device,
                         const nlohmann::json& earlier);
void restore(Checkpoint& checkpoint, const std::filesystem::path& path, Renderer& renderer);
std::string device_text(const Device& device);  // as a checkpoint names it
// Adds the layers of a view's image that tell what pixels see (Renderer::add_aovs), if it has them, for merge
// to write them, too.
void keep_seen(Checkpoint& checkpoint, const Image& image, size_t view);

// Adds the passes of another part of the same render, `path`. Both have been checked to be that, and to have
// no pass in common.
void merge(Checkpoint& all, Checkpoint& part, const std::filesystem::path& path);

// What a checkpoint's passes show, without a device: colours and spectra, and with `aovs` their errors and
// the layers that it has of what pixels see.
struct Developed {
    std::string receiver;
    Image image;  // with its attributes, the command aside
    RelativeError error;
};
std::vector<Developed> develop(Checkpoint& checkpoint, const std::filesystem::path& path, bool aovs);

}  // namespace etendue
