// Scenes are shown anew when a file that they name changes.
#include <doctest/doctest.h>

#include <set>

#include "host/image/exr.h"
#include "host/image/png.h"
#include "host/preview/worker.h"
#include "host/gltf/gltf.h"
#include "host/scene/scene_files.h"
#include "tests/preview/two_balls.h"

using namespace etendue;

namespace {

Image even(float value) {
    Image image;
    image.width = 4, image.height = 2;
    add_channels(image, {"R", "G", "B"}, std::vector<float>(3 * 8, value), 3);
    return image;
}

// A triangle of that size in metres, without indices.
std::string triangle(float size) {
    const float positions[] = {-size, -size, 0, size, -size, 0, 0, size, 0};
    return {reinterpret_cast<const char*>(positions), sizeof positions};
}

// Beside two balls a triangle from a buffer with an image on it; the green ball's colour is a spectrum from a
// file, the surroundings are an image.
std::string scene_of_files() {
    auto scene = nlohmann::json::parse(two_balls);
    scene["images"] = {{{"uri", "cloth.png"}}};
    scene["textures"] = {{{"source", 0}}};
    scene["buffers"] = {{{"uri", "mesh.bin"}, {"byteLength", 36}}};
    scene["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
    scene["accessors"] = {{{"bufferView", 0},
                           {"componentType", 5126},
                           {"count", 3},
                           {"type", "VEC3"},
                           {"min", {-10, -10, 0}},
                           {"max", {10, 10, 0}}}};
    scene["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 3}}}}}};
    scene["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}});
    scene["nodes"].push_back({{"mesh", 0}, {"translation", {0, 1, 0}}});
    scene["scenes"][0]["nodes"].push_back(5);
    scene["materials"][1]["extensions"]["ETD_optics"]["surface"]["reflectance"] = {{"file", "leaf.csv"}};
    scene["extensions"]["ETD_optics"]["environment"] = {{"class", "image"}, {"file", "sky.exr"}};
    return scene.dump();
}

void write_files(const TemporaryFolder& folder) {
    write_text(folder / "scene.gltf", scene_of_files());
    write_png(folder / "cloth.png", even(0.7f));
    write_exr(folder / "sky.exr", even(1));
    write_text(folder / "leaf.csv", "400, 0.1\n700, 0.6\n");
    write_text(folder / "mesh.bin", triangle(0.5f));
}

}  // namespace

TEST_CASE("a scene knows the files that it was read from") {
    TemporaryFolder folder;
    write_files(folder);
    std::set<std::string> names;
    for (const auto& file : files_of(import_gltf(folder / "scene.gltf"))) {
        CHECK(std::filesystem::is_regular_file(file));
        names.insert(file.filename().string());
    }
    CHECK(names == std::set<std::string>{"cloth.png", "leaf.csv", "mesh.bin", "sky.exr"});
}

TEST_CASE("a file that a scene names is read again when it changes; of a broken one the message") {
    TemporaryFolder folder;
    write_files(folder);
    ViewOptions options;
    options.scene = folder / "scene.gltf";
    options.passes = 4;
    PreviewWorker worker(options, {}, [] {});
    worker.open();
    PreviewRequest request;
    request.width = 48, request.height = 36;
    request.algorithm = Algorithm::backward;
    const auto shown = [&] {
        while (worker.work(request)) {
        }
        REQUIRE(worker.picture());
        return worker.picture()->radiance;
    };
    const auto reloads = [&] {  // a change is waited for until it has settled
        bool any = false;
        for (int i = 0; i < 3; ++i) any |= worker.reload_changed();
        return any;
    };
    const auto first = shown();
    CHECK(!reloads());
    auto last = first;
    const auto check_change = [&](const char* what) {
        CAPTURE(what);
        CHECK(reloads());
        CHECK(worker.status().message == "");
        const auto now = shown();
        CHECK(now != last);
        last = now;
    };
    write_png(folder / "cloth.png", even(0.2f)), check_change("image");
    write_text(folder / "mesh.bin", triangle(0.8f)), check_change("buffer");
    write_text(folder / "leaf.csv", "400, 0.6\n700, 0.1\n"), check_change("spectrum");
    write_exr(folder / "sky.exr", even(0.5f)), check_change("surroundings");

    const auto check_error = [&](const char* name) {
        CAPTURE(name);
        CHECK(reloads());
        CHECK(worker.status().is_error);
        CHECK(worker.status().message.find(name) != std::string::npos);
        CHECK(shown() == last);
        CHECK(!reloads());
    };
    write_text(folder / "cloth.png", "no image"), check_error("cloth.png");
    std::filesystem::remove(folder / "cloth.png"), check_error("cloth.png");
    write_png(folder / "cloth.png", even(0.7f)), check_change("image again");
    write_text(folder / "leaf.csv", "none"), check_error("leaf.csv");
    std::filesystem::remove(folder / "leaf.csv"), check_error("leaf.csv");
    write_files(folder);
    CHECK(reloads());
    CHECK(shown() == first);
}
