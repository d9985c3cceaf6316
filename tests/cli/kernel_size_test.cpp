// No kernel is larger than a driver compiles while one waits. LLVM's time grows faster than a kernel: on a processor without AVX-512,
// under lavapipe, 0.5 s for 70 kB of SPIR-V, 1 s for 110, 2 to 3 s for 190, 4 to 5 s for 250 (Mesa 25.0.7, LLVM 15, EPYC). What
// backward rays alone need, which is what a first pass waits for, stays below 190. Polarization takes 80 kB where paths meet.
//
// Whoever exceeds it: find what stands in a kernel many times (a function called at many sites, an `evaluate`), and let it stand once,
// in a loop; or split the kernel.
#include <nlohmann/json.hpp>

#include "host/scene/classes.h"
#include "tests/cli/program.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/render_probe.h"
#include "tests/support/light_probe.h"
#include "tests/support/source_path.h"

using namespace etendue;

namespace {

constexpr uint64_t most_bytes = 256 << 10, most_bytes_backward = 192 << 10;
constexpr uint64_t most_bytes_polarized = 320 << 10;  // both ways, with polarization

struct Largest {
    std::string kernel;
    uint64_t bytes = 0;
    bool polarized = false;
};

Largest largest_kernel(const Executable& program, const std::string& scene, const std::string& algorithm) {
    const Run run = program.run({"render", scene, "-o", "out.exr", "--size", "8x8", "--passes", "1", "--algorithm",
                                 algorithm, "--stats", "stats.json"});
    REQUIRE_MESSAGE(run.code == 0, scene << ": " << run.err);
    Largest largest;
    const auto stats = nlohmann::json::parse(read_text(program.folder / "stats.json"));  // outlives the loop
    for (const auto& kernel : stats.at("compiled_kernels"))
        if (const uint64_t bytes = kernel.at("spirv_bytes"); bytes > largest.bytes)
            largest = {kernel.at("name"), bytes};
    CHECK(largest.bytes > 10000);
    largest.polarized = stats.at("polarization");
    return largest;
}

void check_sizes(const Executable& program, const std::string& scene) {
    const Largest largest = largest_kernel(program, scene, "bidirectional");
    CHECK_MESSAGE(largest.bytes <= (largest.polarized ? most_bytes_polarized : most_bytes), scene << ", " << largest.kernel);
    if (largest.bytes <= most_bytes_backward) return;  // alone they need less
    const Largest backward = largest_kernel(program, scene, "backward");
    CHECK_MESSAGE(backward.bytes <= most_bytes_backward, scene << ", backward: " << backward.kernel);
}

}  // namespace

TEST_CASE("kernels of the example scenes are within the budget") {
    const Executable program;
    size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(source_path("scenes"))) {
        if (entry.path().extension() != ".gltf") continue;
        check_sizes(program, entry.path().string());
        ++scenes;
    }
    CHECK(scenes >= 19);
}

// What it lacks costs nothing: 70 and 72 kB when features became modules, the same as before.
TEST_CASE("kernels of scenes without features hold nothing of them") {
    const Executable program;
    for (const char* scene : {"cornell_box", "furnace_closed"}) {
        const auto file = source_path("scenes/" + std::string(scene) + ".gltf");
        CHECK_MESSAGE(largest_kernel(program, file, "backward").bytes <= 76 << 10, scene);
    }
}

TEST_CASE("kernels of exports with every material extension are within the budget") {
    const Executable program;
    for (const char* folder : {"24_animation_pointer", "01_principled_material", "22_factors"}) {
        const auto scenes = shared_file(std::string("faults/blender/") + folder);
        REQUIRE(scenes);
        for (const auto& entry : std::filesystem::directory_iterator(*scenes))
            if (entry.path().extension() == ".gltf") check_sizes(program, entry.path().string());
    }
}

TEST_CASE("kernels of a scene of each class of surfaces and media are within the budget") {
    const Executable program;
    const ClassRegistry registry(test_sources());
    GgxMetal metal;
    metal.reflectance = [](double, size_t) { return 0.8; };
    std::ofstream(program.folder / "metal.bsdf", std::ios::binary) << tensor_file_bytes(rgl_fields(metal, {}));
    const auto scene_of = [&](const nlohmann::json& surface, const nlohmann::json& medium) {
        auto scene = nlohmann::json::parse(read_text(source_path("scenes/caustic_box.gltf")));
        auto medium_named = medium;
        medium_named["name"] = "probed";
        scene["extensions"]["ETD_optics"]["media"].push_back(medium_named);
        for (auto& material : scene["materials"])
            if (material["extensions"]["ETD_optics"].contains("inside"))
                material["extensions"]["ETD_optics"] = {{"surface", surface}, {"inside", "probed"}};
        std::ofstream(program.folder / "scene.gltf") << scene;
        check_sizes(program, (program.folder / "scene.gltf").string());
    };
    for (const ClassInfo& info : registry.classes(Interface::surface)) {
        nlohmann::json surface = {{"class", info.name}};
        if (info.name == "measured") surface["file"] = "metal.bsdf";
        if (info.name == "color_filter") surface["transmittance"] = 0.5;
        if (info.name == "mueller") surface["matrix"] = {0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5};
        scene_of(surface, {{"class", "homogeneous"}, {"scattering", 1}});
    }
    for (const ClassInfo& info : registry.classes(Interface::medium))
        if (info.name != "grid")  // needs a file; cloud.gltf has one
            scene_of({{"class", "dielectric"}}, {{"class", info.name}});
}
