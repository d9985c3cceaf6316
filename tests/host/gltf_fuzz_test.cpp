#include <doctest/doctest.h>

#include "tests/fuzz/import_mutations.h"

using namespace etendue;

TEST_CASE("the scene that mutations start from is read without a warning") {
    SceneDescription s = import_gltf(rich_scene().glb(), "nowhere/fuzz.glb");
    CHECK(s.warnings.empty());
    CHECK(s.instances.size() == 5);
    CHECK(s.meshes.size() == 3);
    CHECK(import_gltf(rich_scene().glb(), "nowhere/fuzz.glb", {"v", 0.5}).warnings.empty());
}

TEST_CASE("three thousand damaged scenes give a sound description or a one-line error each") {
    GltfBuilder scene = rich_scene();
    Random random(20240229);
    size_t scenes = 0;
    for (int i = 0; i < 3000; ++i) scenes += try_import(mutated_scene(scene, random));
    CHECK(scenes > 300);
    CHECK(scenes < 2700);
}
