// The examples of the classes, each put into a small scene that shows it, and pictures of them.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <vector>

#include "host/gpu/device.h"
#include "host/options.h"
#include "host/progress.h"
#include "host/scene/classes.h"

namespace etendue {

// The showcases, scenes/manual/INTERFACE.gltf, and the files that examples name, in a folder that is there as
// long as this is.
class Showcases {
  public:
    Showcases();  // fails where the folder cannot be made
    Showcases(const Showcases&) = delete;
    ~Showcases();

    // Puts the class's example into its interface's showcase: objects member by member, lists end to end.
    // Returns the scene's file, NAME.gltf in the folder. Fails where the example is no JSON object.
    std::filesystem::path write_scene(const ClassInfo& info) const;

  private:
    std::filesystem::path folder_;
};

using Png = std::vector<std::byte>;

// Of those classes that have an example, 240 x 240 pixels; fewer where it was interrupted. Of the options
// those of the pictures.
std::map<const ClassInfo*, Png> render_examples(Device& device, const std::vector<const ClassInfo*>& classes,
                                                const ClassesOptions& options, Progress& progress);

}  // namespace etendue
