// Extensions that a file may require: variants of materials, other material models, packed meshes and
// textures.
#include <doctest/doctest.h>
#include <meshoptimizer.h>
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#pragma GCC diagnostic pop
#include <webp/encode.h>

#include "tests/host/gltf_scene_builder.h"
#include "tests/support/source_path.h"

using namespace etendue;
using nlohmann::json;

namespace {

void require(GltfBuilder& b, const char* extension) {
    b.document["extensionsRequired"].push_back(extension);
    b.document["extensionsUsed"].push_back(extension);
}

// An image of two texels, losslessly packed as WebP.
int webp_image(GltfBuilder& b, const std::vector<uint8_t>& rgba) {
    uint8_t* packed = nullptr;
    const size_t size = WebPEncodeLosslessRGBA(rgba.data(), 2, 1, 8, &packed);
    const int view = b.view(packed, size);
    WebPFree(packed);
    b.document["images"].push_back({{"bufferView", view}, {"mimeType", "image/webp"}});
    return int(b.document["images"].size()) - 1;
}

void add_webp_texture(GltfBuilder& b, const std::vector<uint8_t>& rgba) {
    b.document["textures"].push_back(
        {{"extensions", {{"EXT_texture_webp", {{"source", webp_image(b, rgba)}}}}}});
}

}  // namespace

TEST_CASE("variants of materials: those of the mesh, or those of the variant that is named") {
    GltfBuilder b;
    require(b, "KHR_materials_variants");
    b.document["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "midnight"}}, {{"name", "noon"}}, {{"name", "dusk"}}};
    b.document["materials"] = {{{"name", "a"}}, {{"name", "b"}}, {{"name", "c"}}};
    json& primitive = b.triangle();
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                     {{"material", 2}, {"variants", {1}}}};
    const auto material = [&](const std::string& variant) {
        return import_gltf(b.glb(), b.file, {variant, {}}).meshes.at(0).material;
    };
    CHECK(material("") == 0);
    CHECK(material("midnight") == 1);
    CHECK(material("noon") == 2);
    CHECK(material("dusk") == 0);
    const SceneDescription s = b.import();
    CHECK(s.variants == std::vector<std::string>{"midnight", "noon", "dusk"});
    CHECK(s.warnings.empty());
    CHECK_THROWS_WITH(material("dawn"),
                      "nowhere/scene.glb: has no variant 'dawn' of its materials; it has: "
                      "midnight, noon, dusk");
    primitive["extensions"]["KHR_materials_variants"]["mappings"][0]["variants"] = {5};
    CHECK(import_error(b.glb()).find("/mappings/0/variants/0: is 5") != std::string::npos);
}

TEST_CASE("an unlit material is a black surface that emits its base colour") {
    GltfBuilder b;
    require(b, "KHR_materials_unlit");
    require(b, "EXT_texture_webp");
    add_webp_texture(b, {255, 0, 0, 255, 0, 255, 0, 0});
    b.document["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0.25, 1, 0.75}}, {"baseColorTexture", {{"index", 0}}}}},
         {"emissiveFactor", {1, 1, 1}},
         {"alphaMode", "BLEND"},
         {"extensions", {{"KHR_materials_unlit", json::object()}}}}};
    b.triangle()["material"] = 0;
    const SceneDescription s = b.import();
    const MaterialDescription& m = s.materials.at(0);
    REQUIRE(m.emission);
    CHECK(m.emission->value == json{0.5, 0.25, 1.0});
    CHECK(m.emission->texture["index"] == 0);
    CHECK(m.surface.parameters["base_color"] == json{0, 0, 0, 0.75});
    CHECK(m.surface.parameters["specular"] == 0);
    CHECK(m.surface.parameters["alpha_mode"] == 2);
    CHECK(s.warnings.empty());
    b.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        b.accessor<float>("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0});
    CHECK(has_warning(b.import(), "colours of vertices do not count on unlit materials"));
}

TEST_CASE("specular-glossiness by factors: c_diff, F0 and alpha as its specification says") {
    GltfBuilder b;
    require(b, "KHR_materials_pbrSpecularGlossiness");
    b.document["materials"] = {{{"extensions",
                                 {{"KHR_materials_pbrSpecularGlossiness",
                                   {{"diffuseFactor", {0.8, 0.4, 0.2, 0.5}},
                                    {"specularFactor", {0.25, 0.5, 0.125}},
                                    {"glossinessFactor", 0.75}}}}}}};
    b.triangle()["material"] = 0;
    const SceneDescription s = b.import();
    const json& p = s.materials.at(0).surface.parameters;
    CHECK(p["base_color"] == json{0.4, 0.2, 0.1, 0.5});
    CHECK(p["specular_color"] == json{0.25, 0.5, 0.125});
    CHECK(p["roughness"] == 0.25);
    CHECK(p["metallic"] == 0);
    CHECK(p["ior"] == 0);
    CHECK(s.warnings.empty());
}

TEST_CASE("specular-glossiness by textures: made into those of colour and roughness") {
    GltfBuilder b;
    add_webp_texture(b, {255, 255, 255, 255, 188, 188, 188, 51});  // diffuse: white; half, alpha 0.2
    add_webp_texture(b, {188, 0, 0, 255, 255, 255, 255, 102});     // specular: half red, glossy 1; white, 0.4
    b.document["materials"] = {{{"extensions",
                                 {{"KHR_materials_pbrSpecularGlossiness",
                                   {{"diffuseTexture", {{"index", 0}}},
                                    {"specularGlossinessTexture", {{"index", 1}}},
                                    {"specularFactor", {0.5, 0.5, 0.5}},
                                    {"glossinessFactor", 0.5}}}}}}};
    b.triangle()["material"] = 0;
    const SceneDescription s = b.import();
    const json& p = s.materials.at(0).surface.parameters;
    const auto image = [&](const char* name) {
        return s.images.at(s.textures.at(p[name]["index"].get<size_t>()).image);
    };
    // Linear, 188 is 0.503: of white 0.75 is left, which is 225 in sRGB; of 0.503 half, which is 137.
    const std::vector<uint8_t> color = image("base_color_texture").rgba8;
    CHECK(std::abs(color.at(0) - 225) <= 1);
    CHECK(std::abs(color.at(2) - 225) <= 1);
    CHECK(color.at(3) == 255);
    CHECK(std::abs(color.at(4) - 137) <= 1);
    CHECK(color.at(7) == 51);
    CHECK(image("specular_color_texture").rgba8.at(0) == 188);
    CHECK(p["specular_color"] == json{0.5, 0.5, 0.5});
    CHECK(p["roughness"] == 1);
    const std::vector<uint8_t> roughness = image("metallic_roughness_texture").rgba8;
    CHECK(roughness.at(1) == 128);
    CHECK(roughness.at(5) == 204);  // 1 - 0.5 * 0.4
    CHECK(p["base_color"] == json{1.0, 1.0, 1.0, 1.0});
}

TEST_CASE("meshopt: packed vertices, triangles and filters; damage is one line") {
    const std::vector<uint16_t> positions = {0, 0, 0, 0, 10, 0, 0, 0, 0, 20, 0, 0, 10, 20, 0, 0};
    const std::vector<uint32_t> corners = {0, 1, 2, 2, 1, 3};
    GltfBuilder b;
    require(b, "EXT_meshopt_compression"), require(b, "KHR_mesh_quantization");
    std::vector<uint8_t> vertices(meshopt_encodeVertexBufferBound(4, 8)),
        triangles(meshopt_encodeIndexBufferBound(6, 4));
    meshopt_encodeVertexVersion(0), meshopt_encodeIndexVersion(1);
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), 4, 8));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), corners.data(), 6));
    const auto pack = [&](const std::vector<uint8_t>& bytes, json extension, size_t length) {
        const int view = b.view(bytes.data(), bytes.size());
        json& v = b.document["bufferViews"][size_t(view)];
        extension["buffer"] = 0, extension["byteOffset"] = v["byteOffset"],
        extension["byteLength"] = bytes.size();
        v = {{"buffer", 1}, {"byteLength", length}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
        if (extension["mode"] == "ATTRIBUTES") v["byteStride"] = 8;
        return view;
    };
    const int of_vertices = pack(vertices, {{"byteStride", 8}, {"count", 4}, {"mode", "ATTRIBUTES"}}, 32);
    const int of_corners = pack(triangles, {{"byteStride", 4}, {"count", 6}, {"mode", "TRIANGLES"}}, 24);
    b.document["accessors"] = {
        {{"bufferView", of_vertices}, {"componentType", 5123}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", of_corners}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
    b.mesh({{"POSITION", 0}}, 1);
    b.document["buffers"] = {
        {{"byteLength", b.binary.size()}},
        {{"byteLength", 56}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    const SceneDescription s = b.import();
    CHECK(s.warnings.empty());
    REQUIRE(s.meshes.at(0).positions.size() == 4);
    CHECK(s.meshes[0].positions[3] == glm::vec3(10, 20, 0));
    CHECK(s.meshes[0].triangles.size() == 2);

    const auto error = [&](const std::function<void(json&)>& change) {
        GltfBuilder c = b;
        change(c.document["bufferViews"][size_t(of_vertices)]["extensions"]["EXT_meshopt_compression"]);
        return import_error(c.glb());
    };
    CHECK(error([](json& e) { e["byteLength"] = 10; }).find("the compressed data are damaged") !=
          std::string::npos);
    CHECK(error([](json& e) { e["count"] = 400000000; }).find("do not pack so well") != std::string::npos);
    CHECK(error([](json& e) { e["mode"] = "POINTS"; }).find("must be ATTRIBUTES") != std::string::npos);
    CHECK(error([](json& e) { e["filter"] = "QUATERNION"; }) == "");  // of 8 bytes
    CHECK(error([](json& e) { e["filter"] = "HEXAGONAL"; }).find("HEXAGONAL") != std::string::npos);
    GltfBuilder c = b;
    c.document["bufferViews"][size_t(of_vertices)].erase("extensions");
    CHECK(import_error(c.glb()).find("of a buffer that has 0") != std::string::npos);
}

TEST_CASE("Draco: packed attributes and triangles; damage is one line") {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int places = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}},
                uv[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    const int faces[2][3] = {{0, 1, 2}, {2, 1, 3}};
    for (int f = 0; f < 2; ++f) {
        builder.SetAttributeValuesForFace(positions, draco::FaceIndex(uint32_t(f)), corners[faces[f][0]],
                                          corners[faces[f][1]], corners[faces[f][2]]);
        builder.SetAttributeValuesForFace(places, draco::FaceIndex(uint32_t(f)), uv[faces[f][0]],
                                          uv[faces[f][1]], uv[faces[f][2]]);
    }
    const auto mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer packed;
    REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());

    GltfBuilder b;
    require(b, "KHR_draco_mesh_compression");
    const int view = b.view(packed.data(), packed.size());
    b.document["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                               {{"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
                               {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
    json& primitive = b.mesh({{"POSITION", 0}, {"TEXCOORD_0", 1}}, 2);
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view},
        {"attributes",
         {{"POSITION", mesh->attribute(positions)->unique_id()},
          {"TEXCOORD_0", mesh->attribute(places)->unique_id()}}}};
    const SceneDescription s = b.import();
    CHECK(s.warnings.empty());
    const MeshDescription& m = s.meshes.at(0);
    REQUIRE(m.triangles.size() == 2);
    double area = 0;
    for (const glm::uvec3& t : m.triangles)
        area += 0.5 * double(glm::length(glm::cross(m.positions[t.y] - m.positions[t.x],
                                                    m.positions[t.z] - m.positions[t.x])));
    CHECK(area == doctest::Approx(2));
    for (size_t i = 0; i < 4; ++i) {
        CHECK(m.positions[i].x == doctest::Approx(m.uv0.at(i).x));
        CHECK(m.positions[i].y == doctest::Approx(2 * m.uv0.at(i).y));
    }

    GltfBuilder c = b;
    c.document["accessors"][0]["count"] = c.document["accessors"][1]["count"] = 5;
    CHECK(import_error(c.glb()).find("has 5 elements; the compressed data have 4") != std::string::npos);
    c = b;
    c.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
              ["POSITION"] = 77;
    CHECK(import_error(c.glb()).find("no such attribute") != std::string::npos);
    for (size_t at = 0; at < packed.size(); ++at) {  // whatever comes of them, it comes without a crash
        c = b;
        c.binary[at] ^= 0xFF;
        import_error(c.glb());
    }
}

TEST_CASE("WebP textures come before those for others, and damage is one line") {
    GltfBuilder b;
    add_webp_texture(b, {255, 0, 0, 255, 0, 255, 0, 128});
    b.document["textures"][0]["source"] = 7;  // is not looked at
    b.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    b.triangle()["material"] = 0;
    CHECK(b.import().images.at(0).rgba8 == std::vector<uint8_t>{255, 0, 0, 255, 0, 255, 0, 128});
    b.binary.resize(30);
    b.document["bufferViews"][0]["byteLength"] = 30;
    b.document["bufferViews"].erase(1), b.document["accessors"] = json::array();
    b.document["meshes"] = json::array(), b.document["nodes"] = json::array(), b.document.erase("scenes");
    CHECK(import_error(b.glb()).find("/images/0: bufferView 0: the WebP image is damaged") !=
          std::string::npos);
}

TEST_CASE("textures of KTX 2 alone are refused in one line; where there is another one it is taken") {
    GltfBuilder b;
    b.document["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    b.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    CHECK(import_error(b.glb()).find("/textures/0: is of KTX 2 alone (KHR_texture_basisu)") !=
          std::string::npos);
    b.document["textures"][0]["source"] = webp_image(b, {255, 0, 0, 255, 0, 255, 0, 128});
    b.triangle()["material"] = 0;
    CHECK(b.import().images.size() == 1);
    require(b, "KHR_texture_basisu");
    CHECK(import_error(b.glb()).find("requires the extension KHR_texture_basisu: its textures, of KTX 2") !=
          std::string::npos);
}
