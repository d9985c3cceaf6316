// A scene whose objects are edited while one looks at it, and that is read anew when its file has changed.
//
// A change makes another Scene beside the one there is, which shares all that has not changed. Once its
// renderers stand, accept() puts it in the place of the first. Until then, and where anything is wrong, all
// stays as it was: errors are the lines that the same values in a scene file would give.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/gltf/gltf.h"
#include "host/scene/scene.h"
#include "host/scene/scene_memory.h"

namespace etendue {

struct LiveParameter {
    Parameter info;  // name, unit, default, range, meaning
    nlohmann::json value;
};

struct LiveObject {
    // boundary: media and priority of a material; place: live_places.h.
    enum class Part {
        surface,
        emission,
        boundary,
        medium,
        phase,
        geometry,
        light,
        place,
        environment,
        receiver
    };
    Part part = Part::surface;
    uint32_t index = 0;      // of the material, medium, … in the description; of the receiver in the scene
    std::string name;        // that the file gives; may be empty
    std::string class_name;  // emission, boundaries and places have none
    std::vector<LiveParameter> parameters;
};
// Of the interface whose classes the object can have; emission's is light.
Interface interface_of(LiveObject::Part part);

class LiveScene {
  public:
    // `device` must outlive it. Errors are those of import_gltf and compile_scene.
    LiveScene(Device& device, std::filesystem::path file, SceneOptions options, ImportOptions import = {});

    const std::shared_ptr<Scene>& scene() const { return scene_; }
    const SceneDescription& description() const { return description_; }
    std::vector<LiveObject> objects() const;

    // null = the default. A material that emits nothing has an emission of 0, and may be given another one.
    // Of the emission of a material, a value under the name of another quantity ("flux"
    // in the place of "radiance") takes the place of the one there is.
    std::shared_ptr<Scene> set_parameter(const LiveObject& object, const std::string& name,
                                         const nlohmann::json& value);
    std::shared_ptr<Scene> set_class(const LiveObject& object, const std::string& class_name,
                                     const nlohmann::json& parameters = nlohmann::json::object());
    // Puts a geometry, a light or a receiver elsewhere, in the coordinates of the scene file.
    std::shared_ptr<Scene> place(const LiveObject& object, const glm::dmat4& world_from_local);
    // Reads the scene file and the folder of shaders again. Edits are forgotten, but receivers that were
    // moved stay where they are unless the file has changed them.
    std::shared_ptr<Scene> reload();

    // Reads the scene file again, with another variant or at another moment. As reload() else.
    std::shared_ptr<Scene> reload(const ImportOptions& import);
    const ImportOptions& import() const { return import_; }
    void allow_class_files() { options_.allow_class_files = true; }

    // After the device was lost: frees all that lies on it, asks for another, and compiles the same scene
    // there, with its edits and its receivers where they are. Nobody else may hold the scene.
    void move_to(const std::function<Device&()>& next_device);

    // What the last change has made becomes the scene. Changes of receivers need none: they are made at once
    // and give the same scene.
    void accept();

  private:
    struct Candidate {
        std::shared_ptr<Scene> scene;
        SceneObjects objects;                         // of an edit, or
        std::optional<SceneDescription> description;  // of a file, read so:
        ImportOptions import;
        std::shared_ptr<SceneMemory> memory;
    };
    std::shared_ptr<Scene> compile(SceneObjects objects);
    std::shared_ptr<Scene> compile_file(const ImportOptions& import, std::shared_ptr<SceneMemory> memory);
    static void keep_receivers(Scene& next, const std::vector<Receiver>& receivers);
    Device* device_;
    std::filesystem::path file_;
    SceneOptions options_;
    ImportOptions import_;
    SceneDescription description_;
    std::shared_ptr<SceneMemory> memory_;
    std::shared_ptr<Scene> scene_;
    std::optional<Candidate> candidate_;
};

}  // namespace etendue
