#include <doctest/doctest.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "tests/host/gltf_scene_builder.h"

using namespace etendue;

namespace {

const std::vector<float> quad = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

bool close(const glm::vec4& a, const glm::vec4& b) { return glm::length(a - b) < 1e-6f; }

}  // namespace

TEST_CASE("a triangle mesh keeps positions, indices and its node's place") {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor("VEC3", quad)}}, b.accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3}));
    b.document["nodes"][0]["translation"] = {1, 2, 3};
    SceneDescription s = b.import();
    REQUIRE(s.meshes.size() == 1);
    CHECK(s.meshes[0].positions[2] == glm::vec3(1, 1, 0));
    CHECK(s.meshes[0].triangles == std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
    CHECK(s.meshes[0].normals.empty());
    CHECK(s.meshes[0].where == "/meshes/0/primitives/0");
    REQUIRE(s.instances.size() == 1);
    CHECK(s.instances[0].world_from_local[3] == glm::dvec4(1, 2, 3, 1));
    CHECK(s.warnings.empty());
}

TEST_CASE("indices of 8, 16 and 32 bits are read alike") {
    GltfBuilder b;
    int p = b.accessor("VEC3", quad);
    b.mesh({{"POSITION", p}}, b.accessor<uint8_t>("SCALAR", {0, 1, 2}));
    b.mesh({{"POSITION", p}}, b.accessor<uint16_t>("SCALAR", {0, 1, 2}));
    b.mesh({{"POSITION", p}}, b.accessor<uint32_t>("SCALAR", {0, 1, 2}));
    b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0})}});
    SceneDescription s = b.import();
    REQUIRE(s.meshes.size() == 4);
    for (const MeshDescription& mesh : s.meshes) CHECK(mesh.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
}

TEST_CASE("strips and fans become triangles in glTF's order") {
    GltfBuilder b;
    int p = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0.5f, 2, 0});
    b.mesh({{"POSITION", p}})["mode"] = 5;
    b.mesh({{"POSITION", p}})["mode"] = 6;
    SceneDescription s = b.import();
    CHECK(s.meshes[0].triangles == std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}});
    CHECK(s.meshes[1].triangles == std::vector<glm::uvec3>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}});
}

TEST_CASE("points and lines are left out with a warning") {
    GltfBuilder b;
    b.triangle()["mode"] = 1;
    SceneDescription s = b.import();
    CHECK(s.meshes.empty());
    CHECK(s.instances.empty());
    CHECK(has_warning(s, "/meshes/0/primitives/0: lines are not modelled"));
}

TEST_CASE("integer attributes are scaled where they are normalised, and not where they are not") {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor<int16_t>("VEC3", {0, 0, 0, 300, 0, 0, 0, -300, 0})},
            {"NORMAL", b.accessor<int8_t>("VEC3", {0, 0, 127, 0, 0, -128, 0, 127, 0}, true)},
            {"TEXCOORD_0", b.accessor<uint16_t>("VEC2", {0, 0, 65535, 0, 0, 65535}, true)},
            {"TEXCOORD_1", b.accessor<uint8_t>("VEC2", {0, 0, 2, 0, 0, 3})},
            {"COLOR_0", b.accessor<uint8_t>("VEC3", {255, 0, 51, 0, 0, 0, 0, 0, 0}, true)}});
    MeshDescription m = b.import().meshes.at(0);
    CHECK(m.positions[2] == glm::vec3(0, -300, 0));
    CHECK(m.normals[1] == glm::vec3(0, 0, -1));
    CHECK(m.uv0[1] == glm::vec2(1, 0));
    CHECK(m.uv1[2] == glm::vec2(0, 3));
    CHECK(close(m.colors[0], glm::vec4(1, 0, 0.2f, 1)));
}

TEST_CASE("interleaved attributes are read with their stride") {
    GltfBuilder b;
    const float data[] = {0, 0, 0, 0.1f, 0.2f, 1, 0, 0, 0.3f, 0.4f, 0, 1, 0, 0.5f, 0.6f};
    int view = b.view(data, sizeof data, 20);
    auto accessor = [&](int offset, const char* type) {
        b.document["accessors"].push_back({{"bufferView", view},
                                           {"byteOffset", offset},
                                           {"componentType", 5126},
                                           {"count", 3},
                                           {"type", type}});
        return int(b.document["accessors"].size()) - 1;
    };
    int p = accessor(0, "VEC3"), uv = accessor(12, "VEC2");
    b.mesh({{"POSITION", p}, {"TEXCOORD_0", uv}});
    MeshDescription m = b.import().meshes.at(0);
    CHECK(m.positions[2] == glm::vec3(0, 1, 0));
    CHECK(m.uv0[1] == glm::vec2(0.3f, 0.4f));
}

TEST_CASE("sparse accessors replace elements, of data and of zeros") {
    GltfBuilder b;
    const uint16_t at[] = {1, 2};
    const float values[] = {5, 0, 0, 0, 5, 0};
    nlohmann::json sparse = {{"count", 2},
                             {"indices", {{"bufferView", b.view(at, sizeof at)}, {"componentType", 5123}}},
                             {"values", {{"bufferView", b.view(values, sizeof values)}}}};
    b.triangle();
    b.document["accessors"][0]["sparse"] = sparse;
    b.document["accessors"].push_back(
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
    b.mesh({{"POSITION", 1}});
    SceneDescription s = b.import();
    CHECK(s.meshes.at(0).positions == std::vector<glm::vec3>{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}});
    CHECK(s.meshes.at(1).positions == s.meshes[0].positions);
}

TEST_CASE("normals and tangents come out as unit vectors, those of zero length replaced") {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
            {"NORMAL", b.accessor<float>("VEC3", {0, 0, 0, 0, 3, 4, 0, 0, 1})},
            {"TANGENT", b.accessor<float>("VEC4", {2, 0, 0, -1, 0, 0, 0, 1, 1, 0, 0, 0})}});
    MeshDescription m = b.import().meshes.at(0);
    CHECK(m.normals[0] == glm::vec3(0, 0, 1));
    CHECK(glm::length(m.normals[1] - glm::vec3(0, 0.6f, 0.8f)) < 1e-6f);
    CHECK(m.tangents[0] == glm::vec4(1, 0, 0, -1));
    CHECK(glm::dot(glm::vec3(m.tangents[1]), m.normals[1]) == doctest::Approx(0));
    CHECK(glm::length(glm::vec3(m.tangents[1])) == doctest::Approx(1));
    CHECK(m.tangents[2].w == 1);
}

TEST_CASE("triangles of zero area are left out, thin ones are kept, and the mesh is named") {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1e-30f, 0})}},
           b.accessor<uint8_t>("SCALAR", {0, 1, 2, 0, 0, 3, 0, 1, 3}));
    SceneDescription s = b.import();
    CHECK(s.meshes.at(0).triangles.size() == 1);
    CHECK(has_warning(s, "mesh 'm' has triangles of zero area: 2 in 1 mesh are left out"));
}

TEST_CASE("a primitive keeps only the vertices that it uses of those that it shares") {
    GltfBuilder b;
    std::vector<float> positions;
    for (int i = 0; i < 1000; ++i) positions.insert(positions.end(), {float(i), float(i * i % 97), 1});
    int p = b.accessor("VEC3", positions);
    b.mesh({{"POSITION", p}}, b.accessor<uint16_t>("SCALAR", {500, 501, 502}));
    b.mesh({{"POSITION", p}}, b.accessor<uint16_t>("SCALAR", {3, 999, 500}));
    SceneDescription s = b.import();
    CHECK(s.meshes.at(0).positions.size() == 3);
    CHECK(s.meshes.at(1).positions.size() == 3);
    glm::uvec3 t = s.meshes[1].triangles.at(0);
    CHECK(s.meshes[1].positions[t.x].x == 3);
    CHECK(s.meshes[1].positions[t.y].x == 999);
    CHECK(s.meshes[1].positions[t.z].x == 500);
}

TEST_CASE("a mesh that two nodes use is read once") {
    GltfBuilder b;
    b.triangle();
    b.node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
    SceneDescription s = b.import();
    CHECK(s.meshes.size() == 1);
    REQUIRE(s.instances.size() == 2);
    CHECK(s.instances[1].mesh == 0);
    CHECK(s.instances[1].where == "/nodes/1");
    CHECK(glm::determinant(s.instances[1].world_from_local) == doctest::Approx(-1));
}

TEST_CASE("EXT_mesh_gpu_instancing multiplies the node's transform") {
    GltfBuilder b;
    b.triangle();
    int t = b.accessor<float>("VEC3", {1, 0, 0, 0, 1, 0});
    int r = b.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 32767, 0}, true);
    b.document["nodes"][0]["scale"] = {2, 2, 2};
    b.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", {{"TRANSLATION", t}, {"ROTATION", r}}}};
    SceneDescription s = b.import();
    REQUIRE(s.instances.size() == 2);
    CHECK(s.instances[0].world_from_local[3] == glm::dvec4(2, 0, 0, 1));
    CHECK(s.instances[1].world_from_local[3] == glm::dvec4(0, 2, 0, 1));
    CHECK(s.instances[1].world_from_local[0].x == doctest::Approx(-2));
}

TEST_CASE("positions that are not finite, or huge, are refused") {
    for (float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2e18f}) {
        GltfBuilder b;
        b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1, bad, 0, 0, 1, 0})}});
        CHECK(import_error(b.glb()) ==
              "nowhere/scene.glb: /meshes/0/primitives/0/attributes/POSITION: has a value "
              "that is not finite, or beyond 1e+18");
    }
}

TEST_CASE("coordinates that become huge by their node's transform are refused") {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 1e10f, 0, 0, 0, 1, 0})}});
    b.document["nodes"][0]["scale"] = {1e10, 1, 1};
    CHECK(import_error(b.glb()).find("/nodes/0: its mesh reaches coordinates beyond 1e+18") !=
          std::string::npos);
}
