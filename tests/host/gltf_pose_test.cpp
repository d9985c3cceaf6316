// Poses: animations at a moment, morph targets and skins.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/host/gltf_scene_builder.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();

SceneDescription at(const GltfBuilder& b, std::optional<double> seconds) {
    return import_gltf(b.glb(), b.file, {"", seconds});
}

std::string error_at(const GltfBuilder& b, double seconds) {
    try {
        at(b, seconds);
        return "";
    } catch (const Error& e) {
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
        return e.what();
    }
}

// A channel of an animation of its own.
void animate(GltfBuilder& b, int node, const char* path, int input, int output,
             const char* interpolation = "LINEAR") {
    b.document["animations"].push_back(
        {{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
}

// A triangle whose node is moved along x between 1 s and 3 s.
GltfBuilder moved(const char* interpolation, const std::vector<float>& keys) {
    GltfBuilder b;
    b.triangle();
    const int input = b.accessor<float>("SCALAR", {1, 3});
    animate(b, 0, "translation", input, b.accessor<float>("VEC3", keys), interpolation);
    return b;
}

double x_at(const GltfBuilder& b, std::optional<double> seconds) {
    return at(b, seconds).instances.at(0).world_from_local[3].x;
}

}  // namespace

TEST_CASE("translations between keys, and before and behind them") {
    const GltfBuilder linear = moved("LINEAR", {4, 0, 0, 8, 0, 0});
    CHECK(x_at(linear, 0) == 4);
    CHECK(x_at(linear, 1.5) == 5);
    CHECK(x_at(linear, 3) == 8);
    CHECK(x_at(linear, 99) == 8);
    const GltfBuilder step = moved("STEP", {4, 0, 0, 8, 0, 0});
    CHECK(x_at(step, 2.9) == 4);
    CHECK(x_at(step, 3) == 8);
    // (t - 1)³ is a cubic spline through its own values and slopes.
    const GltfBuilder cubic = moved("CUBICSPLINE", {9, 9, 9, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 9, 9, 9});
    CHECK(x_at(cubic, 2) == doctest::Approx(1));
    CHECK(x_at(cubic, 2.5) == doctest::Approx(3.375));
    CHECK(x_at(cubic, 0) == 0);
    CHECK(x_at(cubic, 5) == 8);
}

TEST_CASE("without a moment nodes stand as they are, and the file says how long its animations last") {
    const SceneDescription s = at(moved("LINEAR", {4, 0, 0, 8, 0, 0}), {});
    CHECK(s.instances.at(0).world_from_local[3].x == 0);
    CHECK(s.animation_seconds == 3);
    CHECK(s.warnings.empty());
}

TEST_CASE("rotations go the shorter way at even speed, from floats or integers; scales are scaled") {
    GltfBuilder b;
    b.triangle();
    const int input = b.accessor<float>("SCALAR", {0, 1});
    const float half = float(std::sqrt(0.5));
    SUBCASE("floats") {
        animate(b, 0, "rotation", input, b.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0, half, half}));
    }
    SUBCASE("the other sign") {
        animate(b, 0, "rotation", input, b.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0, -half, -half}));
    }
    SUBCASE("integers") {
        const int16_t h = int16_t(std::lround(32767 * half));
        animate(b, 0, "rotation", input, b.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, h, h}, true));
    }
    animate(b, 0, "scale", input, b.accessor<float>("VEC3", {1, 1, 1, 3, 1, 1}));
    const glm::dmat4 m = at(b, 1.0 / 3).instances.at(0).world_from_local;
    const double angle = std::acos(-1.0) / 6, scale = 5.0 / 3;
    CHECK(m[0].x == doctest::Approx(scale * std::cos(angle)).epsilon(1e-4));
    CHECK(m[0].y == doctest::Approx(scale * std::sin(angle)).epsilon(1e-4));
    CHECK(m[1].x == doctest::Approx(-std::sin(angle)).epsilon(1e-4));
}

TEST_CASE("of two animations that move the same thing the first counts, with a warning") {
    GltfBuilder b = moved("LINEAR", {4, 0, 0, 8, 0, 0});
    animate(b, 0, "translation", b.accessor<float>("SCALAR", {0, 7}),
            b.accessor<float>("VEC3", {0, 0, 0, 70, 0, 0}));
    CHECK(x_at(b, 3) == 8);
    CHECK(has_warning(at(b, 3), "/animations/1/channels/0: moves what an animation before it moves"));
    CHECK(at(b, 3).animation_seconds == 7);
}

TEST_CASE("morph targets count by the weights of the mesh, of the node, or of an animation") {
    GltfBuilder b;
    json& primitive = b.triangle();
    const int up = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int right = b.accessor<int8_t>("VEC4", {100, 0, 0, 0, 100, 0, 0, 0, 100, 0, 0, 0});
    b.document["accessors"][size_t(right)]["type"] = "VEC3";  // of bytes, four apart
    b.document["bufferViews"][b.document["accessors"][size_t(right)]["bufferView"].get<size_t>()]
              ["byteStride"] = 4;
    primitive["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
    const auto first = [&](std::optional<double> seconds = {}) {
        return at(b, seconds).meshes.at(0).positions.at(0);
    };
    CHECK(first() == glm::vec3(0));
    b.document["meshes"][0]["weights"] = {0.5, 0};
    CHECK(first() == glm::vec3(0, 0, 0.5));
    b.document["nodes"][0]["weights"] = {0.25, 0.5};
    CHECK(first() == glm::vec3(50, 0, 0.25));
    animate(b, 0, "weights", b.accessor<float>("SCALAR", {0, 2}),
            b.accessor<float>("SCALAR", {0, 0, 1, -0.5}));
    CHECK(first(1) == glm::vec3(-25, 0, 0.5));
    CHECK(first() == glm::vec3(50, 0, 0.25));
    // Nodes of one mesh, each with weights of its own.
    b.node({{"mesh", 0}});
    const SceneDescription s = b.import();
    REQUIRE(s.instances.size() == 2);
    CHECK(s.meshes.at(s.instances[1].mesh).positions.at(0) == glm::vec3(0, 0, 0.5));
}

TEST_CASE("morph targets turn normals and change colours") {
    GltfBuilder b;
    json& primitive = b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
                              {"NORMAL", b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})},
                              {"COLOR_0", b.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})}});
    primitive["targets"] = {{{"NORMAL", b.accessor<float>("VEC3", {1, 0, 0, 0, 0, 0, 0, 0, 0})},
                             {"COLOR_0", b.accessor<float>("VEC3", {0.5, 2, 0, 0, 0, 0, 0, 0, 0})}}};
    b.document["meshes"][0]["weights"] = {1};
    const MeshDescription m = b.import().meshes.at(0);
    CHECK(m.normals.at(0).x == doctest::Approx(std::sqrt(0.5)));
    CHECK(m.colors.at(0) == glm::vec4(0.5, 1, 0, 1));
    CHECK(m.colors.at(1) == glm::vec4(0, 0, 0, 1));
}

namespace {

// A triangle on two joints: the first vertex on joint 0, the second on joint 1, the third on both.
GltfBuilder skinned() {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
            {"NORMAL", b.accessor<float>("VEC3", {0, 0, 1, 1, 1, 0, 0, 0, 1})},
            {"JOINTS_0", b.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0})},
            {"WEIGHTS_0", b.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0})}});
    b.document["nodes"][0]["translation"] = {100, 0, 0};  // counts for nothing
    b.document["nodes"][0]["skin"] = 0;
    b.node({{"translation", {0, 0, 5}}});
    b.node({{"translation", {10, 0, 0}}, {"scale", {2, 1, 1}}});
    b.document["skins"] = {{{"joints", {1, 2}}}};
    return b;
}

}  // namespace

TEST_CASE("a skinned mesh stands where its joints carry it, and its normals with it") {
    GltfBuilder b = skinned();
    SceneDescription s = b.import();
    CHECK(s.warnings.empty());
    CHECK(s.instances.at(0).world_from_local == glm::dmat4(1));
    const MeshDescription& m = s.meshes.at(0);
    CHECK(m.positions.at(0) == glm::vec3(0, 0, 5));
    CHECK(m.positions.at(1) == glm::vec3(12, 0, 0));
    CHECK(m.positions.at(2) == glm::vec3(5, 1, 2.5));
    CHECK(m.normals.at(1).x == doctest::Approx(1 / std::sqrt(5)));  // (1/2, 1, 0)

    // Bind matrices that take the joints' own places back leave it where it was drawn.
    std::vector<float> inverse(32, 0.0f);
    for (size_t i : {0, 5, 10, 15, 16 + 5, 16 + 10, 16 + 15}) inverse[i] = 1;
    inverse[14] = -5, inverse[16] = 0.5, inverse[16 + 12] = -5;
    const int matrices = b.accessor<float>("VEC4", inverse);
    b.document["accessors"][size_t(matrices)]["type"] = "MAT4";
    b.document["accessors"][size_t(matrices)]["count"] = 2;
    b.document["skins"][0]["inverseBindMatrices"] = matrices;
    s = b.import();
    CHECK(s.meshes.at(0).positions.at(1) == glm::vec3(1, 0, 0));
    CHECK(s.meshes.at(0).positions.at(2) == glm::vec3(0, 1, 0));

    animate(b, 1, "translation", b.accessor<float>("SCALAR", {0, 1}),
            b.accessor<float>("VEC3", {0, 0, 5, 0, 0, 9}));
    s = at(b, 1);
    CHECK(s.meshes.at(0).positions.at(0) == glm::vec3(0, 0, 4));
    CHECK(s.meshes.at(0).positions.at(2) == glm::vec3(0, 1, 2));
}

TEST_CASE("joints stand where all nodes above them put them, in whichever order the file has them") {
    GltfBuilder b = skinned();
    b.document["nodes"][2]["children"] = {1};  // joint 0 below joint 1
    b.document["scenes"][0]["nodes"] = {0, 2};
    CHECK(b.import().meshes.at(0).positions.at(0) == glm::vec3(10, 0, 5));
    b.node({{"scale", {1, 1, 2}}, {"children", {2}}});
    b.document["scenes"][0]["nodes"] = {0, 3};
    CHECK(b.import().meshes.at(0).positions.at(0) == glm::vec3(10, 0, 10));
}

TEST_CASE("weights that sum up to something else are scaled; none at all go with the first joint") {
    GltfBuilder b = skinned();
    json& attributes = b.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = b.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 51, 0, 0, 0, 102, 102, 0, 0}, true);
    const MeshDescription m = b.import().meshes.at(0);
    CHECK(m.positions.at(0) == glm::vec3(0, 0, 5));
    CHECK(m.positions.at(1).x == doctest::Approx(12));
    CHECK(m.positions.at(2).x == doctest::Approx(5));
}

TEST_CASE("bad animations, targets and skins are one line each") {
    const auto message = [](GltfBuilder b, const std::function<void(GltfBuilder&)>& change) {
        change(b);
        return error_at(b, 2);
    };
    const GltfBuilder b = moved("LINEAR", {4, 0, 0, 8, 0, 0});
    CHECK(
        message(b,
                [](GltfBuilder& c) {
                    c.document["animations"][0]["samplers"][0]["input"] = c.accessor<float>("SCALAR", {1, 1});
                })
            .find("/samplers/0/input: has the time 1 at position 1; must be finite and rise") !=
        std::string::npos);
    CHECK(message(b, [](GltfBuilder& c) {
              c.document["animations"][0]["samplers"][0]["output"] = c.accessor<float>("VEC3", {1, 1, 1});
          }).find("has 1 elements; its 2 keys take 2") != std::string::npos);
    CHECK(message(b, [](GltfBuilder& c) {
              c.document["animations"][0]["samplers"][0]["output"] =
                  c.accessor<float>("VEC3", {inf, 1, 1, 1, 1, 1});
          }).find("not finite") != std::string::npos);
    CHECK(message(b, [](GltfBuilder& c) {
              c.document["animations"][0]["samplers"][0]["interpolation"] = "BEZIER";
          }).find("is 'BEZIER'; must be LINEAR, STEP or CUBICSPLINE") != std::string::npos);
    CHECK(message(b, [](GltfBuilder& c) {
              c.document["animations"][0]["channels"][0]["sampler"] = 4;
          }).find("/channels/0/sampler: is 4") != std::string::npos);
    CHECK(message(b, [](GltfBuilder& c) {
              c.document["animations"][0]["channels"][0]["target"] = {{"node", 0}, {"path", "rotation"}};
          }).find("must be an accessor of type VEC4") != std::string::npos);
    // What cannot be read past is; what is none of the renderer's is not.
    CHECK(message(b, [](GltfBuilder& c) {
              c.document["animations"][0]["channels"][0]["target"] = {{"path", "pointer"}};
          }) == "");

    GltfBuilder morphed;
    morphed.triangle()["targets"] = {{{"POSITION", morphed.accessor<float>("VEC3", {0, 0, 1})}}};
    morphed.document["meshes"][0]["weights"] = {1};
    CHECK(message(morphed, [](GltfBuilder&) {}).find("/targets/0/POSITION: has 1 elements; POSITION has 3") !=
          std::string::npos);
    CHECK(message(morphed,
                  [](GltfBuilder& c) {
                      c.document["meshes"][0]["weights"] = {1, 1};
                  })
              .find("/meshes/0/weights: has 2 weights; /meshes/0/primitives/0 has 1 morph targets") !=
          std::string::npos);

    const GltfBuilder s = skinned();
    const auto with = [](const char* name, int accessor) {
        return
            [=](GltfBuilder& c) { c.document["meshes"][0]["primitives"][0]["attributes"][name] = accessor; };
    };
    GltfBuilder c = s;
    const int joints = c.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 7, 0, 0, 0, 0, 1, 0, 0});
    CHECK(message(c, with("JOINTS_0", joints)).find("JOINTS_0: has joint 7 at vertex 1; the skin has 2") !=
          std::string::npos);
    const int negative = c.accessor<float>("VEC4", {1, 0, 0, 0, 2, -1, 0, 0, 1, 0, 0, 0});
    CHECK(message(c, with("WEIGHTS_0", negative)).find("has the weight -1 at vertex 1") != std::string::npos);
    CHECK(message(s, [](GltfBuilder& d) {
              d.document["skins"][0]["joints"] = {1, 9};
          }).find("/skins/0/joints/1: is 9") != std::string::npos);
    CHECK(message(s, [](GltfBuilder& d) {
              d.document["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
          }).find("has no \"WEIGHTS_0\"") != std::string::npos);
}
