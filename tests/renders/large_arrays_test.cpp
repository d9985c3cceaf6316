// Arrays read through their address, as those beyond the size of a binding are, give the same image bit for
// bit.
#include <doctest/doctest.h>

#include <cstdlib>

#include "host/render/renderer.h"
#include "host/scene/gltf.h"
#include "tests/support/device_fixture.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

std::vector<std::byte> film_of(const SceneDescription& description, uint64_t binding_bytes,
                               bool expect_by_address) {
    SceneOptions options;
    options.cache_folder = default_cache_folder();
    options.binding_bytes = binding_bytes;
    Scene scene = compile_scene(test_device(), description, options);
    CHECK(scene.features.nodes_by_address == expect_by_address);
    CHECK(scene.features.primitives_by_address == expect_by_address);
    CHECK(scene.features.texels_by_address == expect_by_address);
    CHECK(scene.features.environment_texels_by_address == expect_by_address);
    RenderSettings settings;
    settings.width = settings.height = 32;
    settings.receiver = scene.receivers.front().ref;
    settings.binding_bytes = binding_bytes;
    Renderer renderer(test_device(), scene, settings);
    CHECK(scene.features.film_by_address == expect_by_address);
    renderer.render_passes(2);
    return renderer.state().pixels;
}

}  // namespace

TEST_CASE("arrays beyond the size of a binding are read by address, with the same image") {
    SceneDescription scene;
    scene.file = "large_arrays.gltf";
    ImageDescription checks;
    checks.width = checks.height = 16;
    for (int i = 0; i < 256; ++i)
        for (int c = 0; c < 4; ++c) checks.rgba8.push_back(c == 3 ? 255 : uint8_t(37 * i * (c + 1)));
    scene.images.push_back(checks);
    scene.textures.push_back({0});
    MeshDescription mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};
    mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 0.5f}};
    mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0});
    MaterialDescription material;
    material.surface = {
        "lambertian", {{"reflectance", 0.8}, {"reflectance_texture", {{"index", 0}}}}, "/materials/0"};
    scene.materials.push_back(material);
    glm::dmat4 placement(1.0);
    placement[3] = glm::dvec4(0, 0, 4, 1);
    scene.receivers.push_back({"camera", {"perspective", {{"yfov", 0.6}}, ""}, placement});
    // The environment image comes from a file.
    const TemporaryFolder folder;
    const char hdr[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    std::string file(hdr, sizeof hdr - 1);
    for (int i = 0; i < 8; ++i) file += {char(100 + 10 * i), char(90), char(200 - 10 * i), char(129)};
    FILE* out = std::fopen((folder / "sky.hdr").c_str(), "wb");
    REQUIRE(out);
    std::fwrite(file.data(), 1, file.size(), out);
    std::fclose(out);
    scene.folder = folder.path;
    scene.environment =
        ObjectDescription{"image", {{"file", "sky.hdr"}}, "/extensions/ETD_optics/environment"};

    CHECK(film_of(scene, 0, false) == film_of(scene, 16, true));
}
