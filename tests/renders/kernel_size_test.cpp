// No kernel is larger than a driver compiles while one waits. LLVM's time grows faster than a kernel: on a
// processor without AVX-512, under lavapipe, 0.5 s for 70 kB of SPIR-V, 1 s for 110, 2 to 3 s for 190, 4 to 5
// s for 250 (Mesa 25.0.7, LLVM 15, EPYC). What backward rays alone need, which is what a first pass waits
// for, stays below 224. Polarization takes 60 to 80 kB where paths meet.
//
// Whoever exceeds it: find what stands in a kernel many times (a function called at many sites, an
// `evaluate`), and let it stand once, in a loop; or split the kernel.
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/gltf/gltf.h"
#include "host/render/techniques.h"
#include "host/scene/classes.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/light_probe.h"
#include "tests/support/render_probe.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

struct Largest {
    std::string kernel;
    uint64_t bytes = 0;
};

// Of the kernels that trace or scatter paths, by the schedule that is chosen for the scene: SPIR-V alone,
// which no driver sees.
Largest largest_kernel(Scene& scene, Algorithm algorithm, bool stokes = false) {
    Device& device = test_device();
    Techniques techniques = choose_techniques(device, scene, algorithm);
    techniques.stokes = stokes;
    const std::string backward = techniques.backward_defines(), forward = techniques.forward_defines();
    const Schedule schedule = choose_schedule(device, scene, techniques);
    scene.kernels.clear();
    if (schedule == Schedule::fused) {
        spirv_bytes(device, scene, "kernels/trace_paths.comp", backward);
        if (techniques.forward) spirv_bytes(device, scene, "kernels/trace_forward_paths.comp", forward);
    } else {
        for (const char* file : {"kernels/scatter_paths.comp", "kernels/find_occlusions.comp"}) {
            spirv_bytes(device, scene, file, backward);
            if (techniques.forward) spirv_bytes(device, scene, file, forward);
        }
    }
    Largest largest;
    for (const KernelReport& kernel : scene.kernels)
        if (kernel.spirv_bytes > largest.bytes) largest = {kernel.name, kernel.spirv_bytes};
    CHECK(largest.bytes > 10000);
    return largest;
}

void check_sizes(const SceneDescription& description, const std::string& name) {
    Scene scene = compile_test_scene(description);
    const bool polarized = scene.features.polarization;
    const Largest largest = largest_kernel(scene, Algorithm::bidirectional);
    INFO(name, ", ", largest.kernel);
    CHECK(largest.bytes <= (polarized ? most_polarized_kernel_bytes : most_kernel_bytes));
    if (polarized)
        CHECK(largest_kernel(scene, Algorithm::bidirectional, true).bytes <= most_polarized_kernel_bytes);
    if (largest.bytes > most_backward_kernel_bytes)  // alone they need less
        CHECK(largest_kernel(scene, Algorithm::backward).bytes <= most_backward_kernel_bytes);
}

}  // namespace

TEST_CASE("kernels of the example scenes are within the budget") {
    size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(source_path("scenes"))) {
        if (entry.path().extension() != ".gltf") continue;
        check_sizes(import_gltf(entry.path()), entry.path().string());
        ++scenes;
    }
    CHECK(scenes >= 19);
}

// What it lacks costs nothing: 70 and 72 kB when features became modules, the same as before.
TEST_CASE("kernels of scenes without features hold nothing of them") {
    for (const char* name : {"cornell_box", "furnace_closed"}) {
        Scene scene = compile_test_scene(import_gltf(source_path("scenes/" + std::string(name) + ".gltf")));
        CHECK_MESSAGE(largest_kernel(scene, Algorithm::backward).bytes <= 76 << 10, name);
    }
}

TEST_CASE("kernels of exports with every material extension are within the budget") {
    for (const char* folder : {"24_animation_pointer", "01_principled_material", "22_factors"}) {
        const auto scenes = shared_file(std::string("faults/blender/") + folder);
        REQUIRE(scenes);
        for (const auto& entry : std::filesystem::directory_iterator(*scenes))
            if (entry.path().extension() == ".gltf")
                check_sizes(import_gltf(entry.path()), entry.path().string());
    }
}

TEST_CASE("kernels of a scene of each class of surfaces and media are within the budget") {
    const TemporaryFolder folder;
    const ClassRegistry registry(test_sources());
    GgxMetal metal;
    metal.reflectance = [](double, size_t) { return 0.8; };
    std::ofstream(folder / "metal.bsdf", std::ios::binary) << tensor_file_bytes(rgl_fields(metal, {}));
    const auto scene_of = [&](const nlohmann::json& surface, const nlohmann::json& medium) {
        auto scene = nlohmann::json::parse(read_text(source_path("scenes/caustic_box.gltf")));
        auto medium_named = medium;
        medium_named["name"] = "probed";
        scene["extensions"]["ETD_optics"]["media"].push_back(medium_named);
        for (auto& material : scene["materials"])
            if (material["extensions"]["ETD_optics"].contains("inside"))
                material["extensions"]["ETD_optics"] = {{"surface", surface}, {"inside", "probed"}};
        std::ofstream(folder / "scene.gltf") << scene;
        check_sizes(import_gltf(folder / "scene.gltf"), surface.dump() + " in " + medium.dump());
    };
    for (const ClassInfo& info : registry.classes(Interface::surface)) {
        nlohmann::json surface = {{"class", info.name}};
        if (info.name == "measured") surface["file"] = "metal.bsdf";
        if (info.name == "color_filter") surface["transmittance"] = 0.5;
        if (info.name == "mueller")
            surface["matrix"] = {0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5};
        scene_of(surface, {{"class", "homogeneous"}, {"scattering", 1}});
    }
    for (const ClassInfo& info : registry.classes(Interface::medium))
        if (info.name != "grid")  // needs a file; cloud.gltf has one
            scene_of({{"class", "dielectric"}}, {{"class", info.name}});
}
