#include <doctest/doctest.h>

#include "tests/host/gltf_scene_builder.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

TEST_CASE("transforms of nested nodes multiply in double precision") {
    GltfBuilder b;
    b.triangle();
    b.document["nodes"] = {{{"children", {1}}, {"translation", {1e9, 0, 0}}},
                           {{"children", {2}}, {"rotation", {0, 0, 0.7071067811865476, 0.7071067811865476}}},
                           {{"mesh", 0}, {"translation", {0.125, 0, 0}}}};
    SceneDescription s = b.import();
    REQUIRE(s.instances.size() == 1);
    CHECK(s.instances[0].world_from_local[3].x == doctest::Approx(1e9).epsilon(1e-15));
    CHECK(s.instances[0].world_from_local[3].y == doctest::Approx(0.125));
    CHECK(s.instances[0].world_from_local[0].y == doctest::Approx(1));
}

TEST_CASE("a matrix is read column by column") {
    GltfBuilder b;
    b.triangle();
    b.document["nodes"][0]["matrix"] = {1, 2, 3, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};
    glm::dmat4 m = b.import().instances.at(0).world_from_local;
    CHECK(m[0] == glm::dvec4(1, 2, 3, 0));
    CHECK(m[3] == glm::dvec4(7, 8, 9, 1));
}

TEST_CASE("only the chosen scene is read; without scenes, every root node") {
    GltfBuilder b;
    b.triangle();
    b.node({{"mesh", 0}});
    b.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    CHECK(b.import().instances.at(0).where == "/nodes/0");
    b.document["scene"] = 1;
    CHECK(b.import().instances.at(0).where == "/nodes/1");
    b.document.erase("scene");
    b.document.erase("scenes");
    CHECK(b.import().instances.size() == 2);
}

TEST_CASE("an empty scene, and a document without scenes or nodes, are read") {
    CHECK(import_error(bytes_of(R"({"asset":{"version":"2.0"}})")) == "");
    CHECK(import_error(bytes_of(R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})")) == "");
}

TEST_CASE("a chain of a hundred thousand nodes is no danger to the stack") {
    GltfBuilder b;
    b.triangle();
    nlohmann::json nodes = nlohmann::json::array();
    for (int i = 0; i < 100000; ++i) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back({{"mesh", 0}});
    b.document["nodes"] = nodes;
    CHECK(b.import().instances.size() == 1);
}

TEST_CASE("a node that is its own ancestor is refused") {
    GltfBuilder b;
    b.document["nodes"] = {
        {{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}, {{"children", {3}}}};
    b.document["nodes"][2]["children"] = {0};
    CHECK(import_error(b.glb()) == "nowhere/scene.glb: /nodes/0: is its own ancestor; nodes must form trees");
}

TEST_CASE("a node with two parents is refused") {
    GltfBuilder b;
    b.document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, nlohmann::json::object()};
    CHECK(import_error(b.glb()) ==
          "nowhere/scene.glb: /nodes/1/children/0: node 2 is already a child of node 0; a "
          "node has one parent at most");
}

TEST_CASE("a mesh under a transform that squashes space flat is left out with a warning") {
    GltfBuilder b;
    b.triangle();
    b.document["nodes"][0]["scale"] = {1, 0, 1};
    SceneDescription s = b.import();
    CHECK(s.instances.empty());
    CHECK(has_warning(s, "/nodes/0: has a transform that squashes space flat"));
}

TEST_CASE("a perspective camera becomes a receiver, its node's scale ignored") {
    GltfBuilder b;
    b.document["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"aspectRatio", 1.5}, {"znear", 1}}}}};
    b.node({{"camera", 0}, {"name", "main"}, {"scale", {2, 3, 4}}, {"translation", {1, 2, 3}}});
    PlacedObject r = b.import().receivers.at(0);
    CHECK(r.name == "main");
    CHECK(r.object.class_name == "perspective");
    CHECK(r.object.parameters == nlohmann::json{{"yfov", 0.5}, {"aspect_ratio", 1.5}});
    CHECK(r.world_from_local == glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1));
}

TEST_CASE("cameras ask for Stokes vectors, lights and emission have them") {
    const nlohmann::json perspective = {{"type", "perspective"},
                                        {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}};
    const auto optics = [](nlohmann::json value) { return nlohmann::json{{"ETD_optics", std::move(value)}}; };
    GltfBuilder b;
    b.document["extensionsUsed"] = {"ETD_optics"};
    b.document["cameras"] = {perspective};
    b.node({{"camera", 0}, {"extensions", optics({{"receiver", {{"stokes", true}}}})}});
    b.node({{"extensions", optics({{"receiver", {{"class", "perspective"}, {"stokes", true}}}})}});
    b.node({{"extensions", optics({{"receiver", {{"class", "perspective"}}}})}});
    b.node({{"extensions", optics({{"light", {{"class", "point"}, {"stokes", {1, 0.6, 0, -0.8}}}}})}});
    b.document["materials"] = {
        {{"extensions", optics({{"emission", {{"radiance", 1}, {"stokes", {1, 0, 0.5, 0}}}}})}}};
    const SceneDescription s = b.import();
    REQUIRE(s.receivers.size() == 3);
    CHECK(s.receivers[0].wants_stokes);
    CHECK(s.receivers[1].wants_stokes);
    CHECK(!s.receivers[2].wants_stokes);
    CHECK(!s.receivers[1].object.parameters.contains("stokes"));
    CHECK(s.lights.at(0).stokes == glm::dvec3(0.6, 0, -0.8));
    CHECK(s.materials.at(0).emission->stokes == glm::dvec3(0, 0.5, 0));
}

TEST_CASE("an orthographic camera becomes a receiver with ymag") {
    GltfBuilder b;
    b.document["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"zfar", 9}, {"znear", 0}}}}};
    b.node({{"camera", 0}});
    PlacedObject r = b.import().receivers.at(0);
    CHECK(r.object.class_name == "orthographic");
    CHECK(r.object.parameters == nlohmann::json{{"ymag", 3.0}});
}

TEST_CASE("punctual lights become lights with the parameters of their classes") {
    GltfBuilder b;
    b.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"},
                                                                  {"color", {1, 0.5, 0}},
                                                                  {"intensity", 7},
                                                                  {"range", 10},
                                                                  {"spot", {{"outerConeAngle", 0.4}}}},
                                                                 {{"type", "directional"}},
                                                                 {{"type", "point"}, {"name", "lamp"}}};
    for (int i = 0; i < 3; ++i) b.node({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    SceneDescription s = b.import();
    REQUIRE(s.lights.size() == 3);
    CHECK(s.lights[0].object.class_name == "spot");
    CHECK(s.lights[0].object.parameters == nlohmann::json{{"color", {1.0, 0.5, 0.0}},
                                                          {"intensity", 7.0},
                                                          {"range", 10.0},
                                                          {"inner_cone_angle", 0.0},
                                                          {"outer_cone_angle", 0.4}});
    CHECK(s.lights[1].object.parameters == nlohmann::json{{"color", {1.0, 1.0, 1.0}}, {"intensity", 1.0}});
    CHECK(s.lights[2].name == "lamp");
}

TEST_CASE("light profiles of EXT_lights_ies become lights of class ies, from files, buffers and data URIs") {
    const TemporaryFolder folder;
    write_text(folder / "a lamp.ies", "x");
    GltfBuilder b;
    json& profiles = b.document["extensions"]["EXT_lights_ies"]["lights"];
    profiles = {{{"uri", "a%20lamp.ies"}, {"name", "lamp"}},
                {{"uri", "data:application/x-ies-lm-63;base64,VElMVA=="}}};
    b.node({{"extensions", {{"EXT_lights_ies", {{"light", 0}, {"multiplier", 2}, {"color", {1, 0.5, 0}}}}}},
            {"scale", {3, 3, 3}}});
    b.node({{"name", "inline"}, {"extensions", {{"EXT_lights_ies", {{"light", 1}}}}}});
    b.document["extensionsUsed"] = json::array({"EXT_lights_ies"});
    b.document["extensionsRequired"] = json::array({"EXT_lights_ies"});
    write_text(folder / "scene.gltf", b.document.dump());
    const SceneDescription s = import_gltf(folder / "scene.gltf", {});
    CHECK(s.warnings.empty());
    REQUIRE(s.lights.size() == 2);
    CHECK(s.lights[0].name == "lamp");
    CHECK(s.lights[0].object.class_name == "ies");
    CHECK(s.lights[0].object.parameters ==
          json{{"file", (folder / "a lamp.ies").string()}, {"scale", 2.0}, {"color", {1.0, 0.5, 0.0}}});
    CHECK(glm::length(s.lights[0].world_from_local[2]) == doctest::Approx(1));
    CHECK(s.embedded_files.at(s.lights[1].object.parameters["file"]) == "TILT");

    profiles[1] = json::object();
    write_text(folder / "scene.gltf", b.document.dump());
    CHECK_THROWS_AS(import_gltf(folder / "scene.gltf", {}), Error);
}
