// Scenes of several files, image files, and the content that is shared beside the project.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

#include "host/image/exr.h"
#include "host/scene/image_file.h"
#include "tests/host/gltf_scene_builder.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

template <class Bytes>
void write_file(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

std::string image_error(const std::filesystem::path& path) {
    try {
        read_image_file(path);
        return "";
    } catch (const Error& e) {
        return e.what();
    }
}

// 2 x 1 texels, (1, 0.5, 0.25) and (4, 0, 0) in Radiance's shared exponents.
std::string radiance_image() {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    const unsigned char texels[] = {128, 64, 32, 129, 128, 0, 0, 131};
    return text + std::string(reinterpret_cast<const char*>(texels), sizeof texels);
}

std::filesystem::path shared_folder() {
    const char* path = std::getenv("ETENDUE_SHARED");
    if (!path) MESSAGE("SKIPPED: ETENDUE_SHARED is not set; shared scenes are not read");
    return path ? path : "";
}

size_t triangle_count(const SceneDescription& scene) {
    size_t count = 0;
    for (const MeshInstance& instance : scene.instances)
        count += scene.meshes.at(instance.mesh).triangles.size();
    return count;
}

}  // namespace

TEST_CASE(
    "a scene with a buffer and images in other files is read, names with %-escapes and longer buffers too") {
    const TemporaryFolder folder;
    GltfBuilder b;
    b.triangle()["material"] = 0;
    b.document["buffers"] = json::array({{{"byteLength", b.binary.size()}, {"uri", "my%20data.bin"}}});
    b.document["materials"] =
        json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    b.document["textures"] = json::array({{{"source", 0}}});
    b.document["images"] = json::array({{{"uri", "sub/image.hdr"}}});
    b.binary.resize(b.binary.size() + 100);
    write_file(folder.path / "my data.bin", b.binary);
    std::filesystem::create_directories(folder.path / "sub");
    write_file(folder.path / "sub/image.hdr", radiance_image());
    write_file(folder.path / "scene.gltf", b.document.dump());
    SceneDescription s = import_gltf(folder.path / "scene.gltf");
    CHECK(s.folder == folder.path);
    CHECK(s.meshes.at(0).positions.at(1) == glm::vec3(1, 0, 0));
    REQUIRE(s.images.size() == 1);
    CHECK(s.images[0].name == "sub/image.hdr");
    CHECK(s.images[0].rgba32f == std::vector<float>{1, 0.5f, 0.25f, 1, 4, 0, 0, 1});
}

TEST_CASE("Radiance rows stored by component, with runs, are read") {
    std::string text = "#?RADIANCE\nEXPOSURE=1\n\n-Y 1 +X 8\n";
    for (int byte : {2, 2, 0, 8, 128 + 8, 128, 3, 64, 128, 0, 128 + 5, 32, 128 + 8, 0, 128 + 8, 130})
        text += char(byte);
    const TemporaryFolder folder;
    write_file(folder.path / "image.hdr", text);
    ImageDescription image = read_image_file(folder.path / "image.hdr");
    REQUIRE(image.rgba32f.size() == 32);
    CHECK(std::vector<float>(image.rgba32f.begin(), image.rgba32f.begin() + 8) ==
          std::vector<float>{2, 1, 0, 1, 2, 2, 0, 1});
    CHECK(image.rgba32f[4 * 7 + 1] == 0.5f);
    text[text.size() - 2] = 0;  // a run of no bytes
    write_file(folder.path / "image.hdr", text);
    CHECK(image_error(folder.path / "image.hdr").find("a run leaves its row") != std::string::npos);
}

TEST_CASE("an OpenEXR image is read as linear floats") {
    const TemporaryFolder folder;
    Image image;
    image.width = 2, image.height = 1;
    image.channels = {"R", "G", "B"};
    image.values = {1, 2, 3, 4, 5, 1e6f};
    write_exr(folder.path / "image.exr", image);
    ImageDescription read = read_image_file(folder.path / "image.exr");
    CHECK(read.name == "image.exr");
    CHECK(read.width == 2);
    CHECK(read.rgba8.empty());
    CHECK(read.rgba32f == std::vector<float>{1, 3, 5, 1, 2, 4, 1e6f, 1});
}

TEST_CASE("image files that are missing, damaged, or not finite are refused") {
    const TemporaryFolder folder;
    std::filesystem::path path = folder.path / "image";
    CHECK(image_error(path).find(path.string()) == 0);
    write_file(path, std::string("no image"));
    CHECK(image_error(path) ==
          path.string() + ": not an image that can be read; PNG, JPEG, WebP, Radiance .hdr and OpenEXR are");
    std::string jpeg = "\xFF\xD8\xFF\xC4";  // a Huffman table of 16 x 255 codes
    jpeg += std::string("\x10\x20\x00", 3) + std::string(16, '\xFF');
    write_file(path, jpeg);
    CHECK(image_error(path) == path.string() + ": the image is damaged: a Huffman table of 4080 codes");
    write_file(path, radiance_image().substr(0, radiance_image().size() - 6));
    CHECK(image_error(path) == path.string() + ": the image is truncated");
    write_file(path, std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n"));
    CHECK(image_error(path).find("the image has 1000000 x 1000000 texels") != std::string::npos);
    Image image;
    image.width = image.height = 1;
    image.channels = {"R", "G", "B"};
    image.values = {1, INFINITY, 3};
    write_exr(path, image);
    CHECK(image_error(path) == path.string() + ": the texel in column 0, row 0 of the image is not finite");
}

TEST_CASE("shared real content is read whole") {
    std::filesystem::path shared = shared_folder();
    if (shared.empty()) return;
    SceneDescription helmet = import_gltf(shared / "real/DamagedHelmet.glb");
    CHECK(triangle_count(helmet) == 15452);
    CHECK(helmet.images.size() == 4);  // the occlusion image is not used
    CHECK(helmet.images.at(0).width == 2048);
    CHECK(helmet.materials.at(0).emission.has_value());
    CHECK(!helmet.materials[0].normal_texture.is_null());
    CHECK(helmet.warnings.empty());

    SceneDescription duck = import_gltf(shared / "real/Duck.glb");
    CHECK(triangle_count(duck) == 4212);
    CHECK(duck.receivers.at(0).object.parameters["yfov"].get<double>() ==
          doctest::Approx(0.6605925559997559));
    CHECK(glm::length(glm::dvec3(duck.receivers[0].world_from_local[2])) == doctest::Approx(1));

    CHECK(import_gltf(shared / "real/2CylinderEngine.glb").instances.size() == 115);
    CHECK(import_gltf(shared / "real/BoxTextured.glb").images.size() == 1);
    SceneDescription alpha = import_gltf(shared / "real/AlphaBlendModeTest.glb");
    CHECK(alpha.materials.at(0).surface.parameters["alpha_mode"] == 1);
    CHECK(alpha.materials.at(3).surface.parameters["alpha_mode"] == 2);
}

TEST_CASE("shared reference scenes are read whole") {
    std::filesystem::path shared = shared_folder();
    if (shared.empty()) return;
    SceneDescription cornell = import_gltf(shared / "reference/cornell_rgb/scene.gltf");
    CHECK(triangle_count(cornell) == 32);
    REQUIRE(cornell.materials.at(0).emission);
    CHECK(cornell.materials[0].emission->value[0] == 17.0);
    CHECK(cornell.materials[0].surface.parameters == json{{"reflectance", 0.0}});

    SceneDescription furnace = import_gltf(shared / "reference/furnace/scene.gltf");
    CHECK(furnace.shapes.size() == 4);
    CHECK(furnace.environment->class_name == "constant");
    CHECK(furnace.materials.at(furnace.shapes[3].material).inside == "ior1.5");

    SceneDescription fog = import_gltf(shared / "reference/media_iso/scene.gltf");
    CHECK(fog.media.at(0).medium.parameters["phase"]["class"] == "isotropic");
    CHECK(import_gltf(shared / "reference/veach_mis/scene.gltf").shapes.size() == 5);
    SceneDescription spectral = import_gltf(shared / "reference/cornell_spectral/scene.gltf");
    CHECK(spectral.materials.at(0).emission->value["wavelengths"].size() == 4);
}
