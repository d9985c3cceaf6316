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
#include "host/render/wavefront.h"
#include "host/scene/classes.h"
#include "tests/renders/registered_classes.h"
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

// The schedule's kernels of one direction.
void compile_paths(Scene& scene, Schedule schedule, const char* fused, const std::string& defines) {
    Device& device = test_device();
    if (schedule == Schedule::fused) {
        spirv_bytes(device, scene, fused, defines);
        return;
    }
    spirv_bytes(device, scene, "kernels/find_occlusions.comp", defines);
    const char* file = "kernels/scatter_paths.comp";
    if (schedule == Schedule::wavefront) spirv_bytes(device, scene, file, defines);
    if (schedule == Schedule::by_class)
        for (const std::string& of_class : Wavefront::defines_by_class(scene, defines))
            spirv_bytes(device, scene, file, of_class);
}

// Of the kernels that trace or scatter paths, by the schedule that is chosen for the scene: SPIR-V alone,
// which no driver sees.
Largest largest_kernel(Scene& scene, Algorithm algorithm, bool stokes = false) {
    Device& device = test_device();
    Techniques techniques = choose_techniques(device, scene, algorithm);
    techniques.stokes = stokes;
    const Schedule schedule = choose_schedule(device, scene, techniques);
    scene.kernels.clear();
    compile_paths(scene, schedule, "kernels/trace_paths.comp", techniques.backward_defines());
    if (techniques.forward)
        compile_paths(scene, schedule, "kernels/trace_forward_paths.comp", techniques.forward_defines());
    Largest largest;
    for (const KernelReport& kernel : scene.kernels)
        if (kernel.spirv_bytes > largest.bytes) largest = {kernel.name, kernel.spirv_bytes};
    CHECK(largest.bytes > 10000);
    return largest;
}

void check_sizes(Scene scene, const std::string& name) {
    const bool polarized = scene.features.polarization;
    const Largest largest = largest_kernel(scene, Algorithm::bidirectional);
    INFO(name, ", ", largest.kernel);
    CHECK(largest.bytes <= (polarized ? most_polarized_kernel_bytes : most_kernel_bytes));
    if (polarized)
        CHECK(largest_kernel(scene, Algorithm::bidirectional, true).bytes <= most_polarized_kernel_bytes);
    if (largest.bytes > most_backward_kernel_bytes)  // alone they need less
        CHECK(largest_kernel(scene, Algorithm::backward).bytes <=
              (polarized ? most_polarized_kernel_bytes : most_backward_kernel_bytes));
}

void check_sizes(const std::filesystem::path& file, const std::string& name) {
    check_sizes(compile_test_scene(import_gltf(file)), name);
}

// The caustic box, with other things in the place of its glass sphere.
struct ProbedScene {
    TemporaryFolder folder;
    nlohmann::json scene;

    ProbedScene() : scene(nlohmann::json::parse(read_text(source_path("scenes/caustic_box.gltf")))) {
        write_metals(folder.path);
        std::filesystem::copy_file(source_path("scenes/cloud.nrrd"), folder / "cloud.nrrd");
        scene["scenes"][0]["nodes"].erase(7);
    }
    void add(const nlohmann::json& surface, nlohmann::json medium) {
        auto& optics = scene["extensions"]["ETD_optics"];
        const size_t count = optics["media"].size(), material = scene["materials"].size();
        const std::string name = "probed " + std::to_string(count);
        if (medium["class"] == "grid") medium["file"] = "cloud.nrrd";
        medium["name"] = name;
        optics["media"].push_back(medium);
        scene["materials"].push_back(
            {{"extensions", {{"ETD_optics", {{"surface", surface}, {"inside", name}}}}}});
        scene["scenes"][0]["nodes"].push_back(scene["nodes"].size());
        const nlohmann::json sphere = {{"class", "sphere"}, {"radius", 0.04}, {"material", material}};
        scene["nodes"].push_back({{"translation", {0.1 * double(count) - 1, 0.4, 0}},
                                  {"extensions", {{"ETD_optics", {{"geometry", sphere}}}}}});
    }
    std::filesystem::path write() const {
        std::ofstream(folder / "scene.gltf") << scene;
        return folder / "scene.gltf";
    }
};

// Calls see(surface, medium inside it).
template <class See>
void for_each_class(See see) {
    const ClassRegistry registry(test_sources());
    for (const ClassInfo& info : registry.classes(Interface::surface))
        see(surface_of(info.name), {{"class", "homogeneous"}, {"scattering", 1}});
    for (const ClassInfo& info : registry.classes(Interface::medium))
        see({{"class", "dielectric"}}, medium_of(info.name));
}

}  // namespace

TEST_CASE("kernels of the largest example scenes are within the budget") {
    for (const char* name : {"materials", "iced_water", "glass_in_fog", "light_guide", "spectrometer",
                             "polarizers", "calcite", "office", "cloud", "grin"})
        check_sizes(source_path("scenes/" + std::string(name) + ".gltf"), name);
}

TEST_CASE("kernels of the example scenes are within the budget" * doctest::test_suite("long")) {
    size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(source_path("scenes"))) {
        if (entry.path().extension() != ".gltf") continue;
        check_sizes(entry.path(), entry.path().string());
        ++scenes;
    }
    CHECK(scenes >= 19);
}

TEST_CASE("kernels of films and of many materials under a sky with a sun are within the budget") {
    for (const char* name : {"films", "materials", "iced_water"}) {
        nlohmann::json scene =
            nlohmann::json::parse(read_text(source_path("scenes/" + std::string(name) + ".gltf")));
        scene["extensions"]["ETD_optics"]["environment"] = {
            {"class", "sky"}, {"diffuse", 1}, {"direct", 3}, {"sun", {1, 1, 1}}};
        const TemporaryFolder folder;
        write_text(folder / "scene.gltf", scene.dump());
        check_sizes(folder / "scene.gltf", name);
    }
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
            if (entry.path().extension() == ".gltf") check_sizes(entry.path(), entry.path().string());
    }
}

// More classes mean more kernels, not larger ones: films both ways with polarization are traced by class;
// where all classes are met vertices are not connected, too.
TEST_CASE("kernels of films that polarize are within the budget") {
    SceneOptions options = test_options();
    options.polarization = PolarizationMode::on;
    check_sizes(compile_test_scene(import_gltf(source_path("scenes/films.gltf")), options), "films");
}

// No scene has more of them; each class alone (below) needs kernels no larger. Tables of Mueller matrices
// make it spectral: then rays do not merge along their way either.
TEST_CASE("kernels of a scene of all classes of surfaces and media at once are within the budget" *
          doctest::test_suite("long")) {
    ProbedScene all;
    for_each_class(
        [&](const nlohmann::json& surface, const nlohmann::json& medium) { all.add(surface, medium); });
    Scene scene = compile_test_scene(import_gltf(all.write()));
    REQUIRE(scene.features.polarization);
    CHECK(largest_kernel(scene, Algorithm::bidirectional, true).bytes <= most_polarized_kernel_bytes);
}

TEST_CASE("kernels of a scene of each class of surfaces and media are within the budget" *
          doctest::test_suite("long")) {
    for_each_class([&](const nlohmann::json& surface, const nlohmann::json& medium) {
        ProbedScene one;
        one.add(surface, medium);
        check_sizes(one.write(), surface.dump() + " in " + medium.dump());
    });
}
