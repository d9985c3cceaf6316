// Forward, backward and bidirectional rays give the same image of every scene in scenes/.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "host/scene/gltf.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;

namespace {

// Scenes whose light is rarely found by backward rays, and what forward rays leave to them: one path in some
// thousand meets the lamp. Passes of backward and forward rays.
const std::map<std::string, uint32_t> rare_light = {{"caustic_box", 2048}, {"pool", 4096}};

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(ETENDUE_SOURCE_DIR) / "scenes"))
        if (entry.path().extension() == ".gltf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST_CASE("algorithms agree: every scene in scenes/" * doctest::test_suite("long")) {
    for (const std::filesystem::path& file : scene_files()) {
        const std::string name = file.stem().string();
        SUBCASE(name.c_str()) {
            CAPTURE(name);
            MESSAGE(name);
            Comparison c;
            c.width = 32, c.height = 24, c.seeds = 16;
            c.largest_error = 0.02;  // glass hides lamps from forward rays, too
            if (const auto rare = rare_light.find(name); rare != rare_light.end())
                c.backward = c.forward = rare->second;
            Scene scene = compile_test_scene(import_gltf(file));
            check_against_backward(scene, c);
        }
    }
}
