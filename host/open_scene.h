// The opening that render, inspect and bench share: a device, the scene compiled for it, the receiver to
// render and its size.
#pragma once
#include <memory>

#include "host/gltf/gltf.h"
#include "host/options.h"
#include "host/scene/scene.h"

namespace etendue {

struct OpenedScene {
    std::unique_ptr<Device> device;
    Scene scene;
    std::vector<std::filesystem::path> files;  // that it was read from, the scene file first
    std::vector<std::string> variants;         // of its materials
    double animation_seconds = 0;              // 0 = it has none
};

// Fails with one line for what is wrong in the scene or its files, and where there is no such device.
OpenedScene open_scene(const SceneChoice& choice);

// The device aside: what the choice says of reading the file, and of compiling.
ImportOptions import_options(const SceneChoice& choice);
SceneOptions scene_options(const SceneChoice& choice);

// The receiver of that name, else the first.
const Receiver& choose_receiver(const Scene& scene, const SceneChoice& choice);
// The receivers whose names stand there, separated by commas; all of them for "all"; else the first.
std::vector<const Receiver*> choose_receivers(const Scene& scene, const SceneChoice& choice);

// Of its pixels: "lx", "cd"; of cameras "cd/m²".
std::string receiver_unit(const Receiver& receiver);

// The layers that are asked for, else those of the scene. Fails with one line where they are none.
std::vector<LightLayer> choose_layers(const Scene& scene, const SceneChoice& choice);

// As chosen, else 512 rows, and columns by the receiver's aspect ratio.
ImageSize image_size(const Receiver& receiver, const SceneChoice& choice);

}  // namespace etendue
