#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/host/gltf_scene_builder.h"

using namespace etendue;
using nlohmann::json;

namespace {

struct Fault {
    const char* expected;  // part of the message
    std::function<void(json&)> make;
};

// A valid document with one of everything that is checked; a fault changes one thing of it.
GltfBuilder whole_scene() {
    GltfBuilder b;
    int p = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    int n = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    int i = b.accessor<uint16_t>("SCALAR", {0, 1, 2});
    b.mesh({{"POSITION", p}, {"NORMAL", n}}, i)["material"] = 0;
    b.document["buffers"] = json::array({{{"byteLength", b.binary.size()}}});
    b.document["materials"] = json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                            {"normalTexture", {{"index", 0}}}},
                                           {{"extensions",
                                             {{"ETD_optics",
                                               {{"surface", {{"class", "lambertian"}}},
                                                {"inside", "fog"},
                                                {"emission", {{"radiance", 1}}}}}}}}});
    b.document["images"] = json::array({{{"bufferView", 0}}});
    b.document["textures"] = json::array({{{"source", 0}}});
    b.document["cameras"] =
        json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}});
    b.node({{"camera", 0}});
    b.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    b.node({{"extensions", {{"ETD_optics", {{"geometry", {{"class", "sphere"}, {"material", 1}}}}}}}});
    b.document["extensions"] = {
        {"KHR_lights_punctual", {{"lights", json::array({{{"type", "point"}}})}}},
        {"ETD_optics", {{"media", json::array({{{"name", "fog"}, {"class", "homogeneous"}}})}}}};
    return b;
}

const Fault faults[] = {
    {"/asset: is a string; must be an object", [](json& d) { d["asset"] = "2.0"; }},
    {": has no \"asset\", which is required", [](json& d) { d.erase("asset"); }},
    {"/asset/version: is '1.0'; must be 2.0", [](json& d) { d["asset"]["version"] = "1.0"; }},
    {"/asset/minVersion: is '2.1'", [](json& d) { d["asset"]["minVersion"] = "2.1"; }},
    {"/extensionsRequired/0: requires the extension FOO_bar, which is not known",
     [](json& d) { d["extensionsRequired"] = json::array({"FOO_bar"}); }},
    {"/nodes: is an object; must be an array", [](json& d) { d["nodes"] = json::object(); }},
    {"/nodes/0: is a null; must be an object", [](json& d) { d["nodes"][0] = nullptr; }},
    {"/nodes/0/mesh: is 7; /meshes has elements 0 to 0", [](json& d) { d["nodes"][0]["mesh"] = 7; }},
    {"/nodes/0/mesh: is -1; must be an index", [](json& d) { d["nodes"][0]["mesh"] = -1; }},
    {"/nodes/0/mesh: is 0.5; must be an index", [](json& d) { d["nodes"][0]["mesh"] = 0.5; }},
    {"/nodes/0/mesh: is a string; must be an index", [](json& d) { d["nodes"][0]["mesh"] = "0"; }},
    {"/nodes/0/matrix: has 3 elements; must be 16 numbers",
     [](json& d) {
         d["nodes"][0]["matrix"] = json::array({1, 2, 3});
     }},
    {"/nodes/0/matrix: is not affine",
     [](json& d) {
         d["nodes"][0]["matrix"] = json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1});
     }},
    {"/nodes/0/translation/1: is a string; must be a number",
     [](json& d) {
         d["nodes"][0]["translation"] = json::array({0, "x", 0});
     }},
    {"/nodes/0/translation/0: is 1e+19; must be from -1e+18 to 1e+18",
     [](json& d) {
         d["nodes"][0]["translation"] = json::array({1e19, 0, 0});
     }},
    {"/nodes/0/rotation: is a quaternion of zero length",
     [](json& d) {
         d["nodes"][0]["rotation"] = json::array({0, 0, 0, 0});
     }},
    {"/nodes/0/children/0: is 9; /nodes has elements 0 to 3",
     [](json& d) { d["nodes"][0]["children"] = json::array({9}); }},
    {"/nodes/0/name: is a number; must be a string",
     [](json& d) { d["nodes"][0]["name"] = 1, d["nodes"][0]["camera"] = 0; }},
    {"/scene: is 1; /scenes has elements 0 to 0", [](json& d) { d["scene"] = 1; }},
    {"/scenes/0/nodes/4: node 0 is listed twice", [](json& d) { d["scenes"][0]["nodes"].push_back(0); }},
    {"/scenes/0/nodes/1: node 1 is a child of node 0",
     [](json& d) { d["nodes"][0]["children"] = json::array({1}); }},
    {"/meshes/0: has no \"primitives\"", [](json& d) { d["meshes"][0].erase("primitives"); }},
    {"/meshes/0/primitives/0/mode: is 9; must be an integer from 0 to 6",
     [](json& d) { d["meshes"][0]["primitives"][0]["mode"] = 9; }},
    {"/meshes/0/primitives/0/material: is 5; /materials has elements 0 to 1",
     [](json& d) { d["meshes"][0]["primitives"][0]["material"] = 5; }},
    {"/meshes/0/primitives/0/attributes/POSITION: is 8; /accessors has elements 0 to 2",
     [](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 8; }},
    {"/meshes/0/primitives/0/attributes/POSITION: is an accessor of type SCALAR; must be VEC3",
     [](json& d) {
         d["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 2}}}};
     }},
    {"/meshes/0/primitives/0/attributes/NORMAL: has 2 elements; POSITION has 3",
     [](json& d) { d["accessors"][1]["count"] = 2; }},
    {"/meshes/0/primitives/0/indices: must be an accessor of type SCALAR",
     [](json& d) { d["meshes"][0]["primitives"][0]["indices"] = 0; }},
    {"/meshes/0/primitives/0/indices: has index 2 at position 2; the primitive has 2 vertices",
     [](json& d) { d["accessors"][0]["count"] = d["accessors"][1]["count"] = 2; }},
    {"/meshes/0/primitives/0: has 2 corners of triangles; must be a multiple of 3",
     [](json& d) { d["accessors"][2]["count"] = 2; }},
    {"/accessors/0/componentType: is 5124; must be 5120",
     [](json& d) { d["accessors"][0]["componentType"] = 5124; }},
    {"/accessors/0/type: is 'VEC9'; must be SCALAR", [](json& d) { d["accessors"][0]["type"] = "VEC9"; }},
    {"/accessors/0/count: is -3; must be an integer from 1",
     [](json& d) { d["accessors"][0]["count"] = -3; }},
    {"/accessors/0/count: is 1e+30; must be an integer from 1",
     [](json& d) { d["accessors"][0]["count"] = 1e30; }},
    {"/accessors/0: reads bytes 0 to 1200 of a bufferView that has 36",
     [](json& d) { d["accessors"][0]["count"] = 100; }},
    {"/accessors/0: reads bytes 8 to 44 of a bufferView that has 36",
     [](json& d) { d["accessors"][0]["byteOffset"] = 8; }},
    {"/accessors/0/bufferView: is 3; /bufferViews has elements 0 to 2",
     [](json& d) { d["accessors"][0]["bufferView"] = 3; }},
    {"/accessors/0/normalized: is true", [](json& d) { d["accessors"][0]["normalized"] = true; }},
    {"/accessors/0: has 100000000 elements without a bufferView",
     [](json& d) {
         d["accessors"][0] = {{"componentType", 5126}, {"count", 100000000}, {"type", "VEC3"}};
     }},
    {"/accessors/0/sparse/indices: has index 256 at position 0; the accessor has 3 elements",
     [](json& d) {
         d["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 73}, {"byteLength", 2}});
         d["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 0}}}};
     }},
    {"/accessors/0/sparse/count: is 4; must be an integer from 1 to 3",
     [](json& d) {
         d["accessors"][0]["sparse"] = {{"count", 4}};
     }},
    {"/bufferViews/0: bytes 0 to 5000 of a buffer that has 78",
     [](json& d) { d["bufferViews"][0]["byteLength"] = 5000; }},
    {"/bufferViews/0: bytes 9007199254740992 to",
     [](json& d) { d["bufferViews"][0]["byteOffset"] = 9007199254740992; }},
    {"/bufferViews/0/buffer: is 1; /buffers has elements 0 to 0",
     [](json& d) { d["bufferViews"][0]["buffer"] = 1; }},
    {"/bufferViews/0/byteStride: is 1; must be an integer from 4 to 252",
     [](json& d) { d["bufferViews"][0]["byteStride"] = 1; }},
    {"/accessors/0: has elements of 12 bytes in a bufferView with a byteStride of 8",
     [](json& d) { d["bufferViews"][0]["byteStride"] = 8; }},
    {"/buffers/0: is truncated: byteLength says 90000, there are 80 bytes",
     [](json& d) { d["buffers"][0]["byteLength"] = 90000; }},
    {"/buffers/1: has no \"uri\"",
     [](json& d) {
         d["buffers"].push_back({{"byteLength", 4}});
     }},
    {"/buffers/0/uri: there is no file nowhere/gone file.bin",
     [](json& d) { d["buffers"][0]["uri"] = "gone%20file.bin"; }},
    {"/buffers/0/uri: has a '%' that two hexadecimal digits do not follow",
     [](json& d) { d["buffers"][0]["uri"] = "100%"; }},
    {"/buffers/0/uri: is 'http://example.org/a.bin'; must be a path relative",
     [](json& d) { d["buffers"][0]["uri"] = "http://example.org/a.bin"; }},
    {"/buffers/0/uri: is a data URI of an unknown form",
     [](json& d) { d["buffers"][0]["uri"] = "data:,abc"; }},
    {"/buffers/0/uri: has a character that base64 does not know, at position 17",
     [](json& d) { d["buffers"][0]["uri"] = "data:a/b;base64,A*AA"; }},
    {"/buffers/0: is truncated: byteLength says 78, there are 3 bytes",
     [](json& d) { d["buffers"][0]["uri"] = "data:a/b;base64,AAAA"; }},
    {"/materials/0: is an array; must be an object", [](json& d) { d["materials"][0] = json::array(); }},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture/index: is 4; /textures has elements 0 to 0",
     [](json& d) { d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 4; }},
    {"/materials/0/pbrMetallicRoughness/roughnessFactor: is 2; must be from 0 to 1",
     [](json& d) { d["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 2; }},
    {"/materials/0/alphaMode: is 'opaque'; must be OPAQUE, MASK or BLEND",
     [](json& d) { d["materials"][0]["alphaMode"] = "opaque"; }},
    {"/materials/0/emissiveFactor: has 2 elements; must be 3 numbers",
     [](json& d) {
         d["materials"][0]["emissiveFactor"] = json::array({1, 1});
     }},
    {"/materials/0/extensions/ETD_optics/priority: is 0; must be an integer from 1",
     [](json& d) {
         d["materials"][0]["extensions"]["ETD_optics"] = {{"priority", 0}};
     }},
    {"/materials/0/extensions/ETD_optics/priority: is 1.5",
     [](json& d) {
         d["materials"][0]["extensions"]["ETD_optics"] = {{"priority", 1.5}};
     }},
    {"/materials/0/extensions/ETD_optics/priority: a material with a priority must name a medium inside",
     [](json& d) {
         d["materials"][0]["extensions"]["ETD_optics"] = {{"priority", 1}};
     }},
    {"/materials/0/extensions/ETD_optics/priority: a material with a priority must name none outside",
     [](json& d) {
         d["extensions"]["ETD_optics"]["media"] = json::array({{{"name", "ice"}, {"class", "homogeneous"}}});
         d["materials"][0]["extensions"]["ETD_optics"] = {
             {"priority", 1}, {"inside", "ice"}, {"outside", "ice"}};
     }},
    {"/materials/0/extensions/ETD_optics/priority: a material with a priority must not emit",
     [](json& d) {
         d["extensions"]["ETD_optics"]["media"] = json::array({{{"name", "ice"}, {"class", "homogeneous"}}});
         d["materials"][0]["extensions"]["ETD_optics"] = {
             {"priority", 1}, {"inside", "ice"}, {"emission", {{"radiance", 1}}}};
     }},
    {"/materials/0/extensions/KHR_materials_ior/ior: is 0.5; must be 0, or at least 1",
     [](json& d) { d["materials"][0]["extensions"]["KHR_materials_ior"]["ior"] = 0.5; }},
    {"/materials/0/extensions/KHR_materials_dispersion/dispersion: is -1; must be from 0",
     [](json& d) {
         json& extensions = d["materials"][0]["extensions"];
         extensions["KHR_materials_transmission"]["transmissionFactor"] = 1;
         extensions["KHR_materials_volume"]["thicknessFactor"] = 1;
         extensions["KHR_materials_dispersion"]["dispersion"] = -1;
     }},
    {"/materials/0/extensions/KHR_materials_sheen/sheenColorFactor/1: is 2; must be from 0 to 1",
     [](json& d) {
         d["materials"][0]["extensions"]["KHR_materials_sheen"]["sheenColorFactor"] = {0, 2, 0};
     }},
    {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/index: is 4; /textures has",
     [](json& d) {
         d["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"]["index"] = 4;
     }},
    {"/materials/1/extensions/ETD_optics/inside: there is no medium 'mist'",
     [](json& d) { d["materials"][1]["extensions"]["ETD_optics"]["inside"] = "mist"; }},
    {"/materials/1/extensions/ETD_optics/surface: has no \"class\"",
     [](json& d) { d["materials"][1]["extensions"]["ETD_optics"]["surface"].erase("class"); }},
    {"/materials/1/extensions/ETD_optics/surface/class: is a number; must be a string",
     [](json& d) { d["materials"][1]["extensions"]["ETD_optics"]["surface"]["class"] = 3; }},
    {"/materials/1/extensions/ETD_optics/surfaces: is not known; allowed are surface, inside, outside, "
     "priority, emission",
     [](json& d) { d["materials"][1]["extensions"]["ETD_optics"]["surfaces"] = 3; }},
    {"/materials/1/extensions/ETD_optics/emission: names 2 quantities",
     [](json& d) { d["materials"][1]["extensions"]["ETD_optics"]["emission"]["power"] = 3; }},
    {"/textures/0/source: is 1; /images has elements 0 to 0",
     [](json& d) { d["textures"][0]["source"] = 1; }},
    {"/textures/0: has no \"source\"", [](json& d) { d["textures"][0].erase("source"); }},
    {"/images/0: bufferView 0: not an image that can be read", [](json&) {}},
    {"/images/0/bufferView: is 9; /bufferViews has elements",
     [](json& d) { d["images"][0]["bufferView"] = 9; }},
    {"/images/0/uri: there is no file nowhere/gone.png",
     [](json& d) {
         d["images"][0] = {{"uri", "gone.png"}};
     }},
    {"/images/0: has neither", [](json& d) { d["images"][0] = json::object(); }},
    {"/cameras/0/type: is 'fisheye'; must be perspective or orthographic",
     [](json& d) { d["cameras"][0]["type"] = "fisheye"; }},
    {"/cameras/0: has no \"perspective\"", [](json& d) { d["cameras"][0].erase("perspective"); }},
    {"/cameras/0/perspective/yfov: is 0; must be more than 0",
     [](json& d) { d["cameras"][0]["perspective"]["yfov"] = 0; }},
    {"/cameras/0/perspective/yfov: is 4; must be more than 0 and less than pi",
     [](json& d) { d["cameras"][0]["perspective"]["yfov"] = 4; }},
    {"/nodes/2/extensions/KHR_lights_punctual/light: is 3; /extensions/KHR_lights_punctual/lights has "
     "elements 0 to 0",
     [](json& d) { d["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 3; }},
    {"/extensions/KHR_lights_punctual/lights/0/type: is 'area'; must be point, spot or directional",
     [](json& d) { d["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "area"; }},
    {"/extensions/KHR_lights_punctual/lights/0/intensity: is -1; must be from 0",
     [](json& d) { d["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = -1; }},
    {"/nodes/3/extensions/ETD_optics/geometry/material: is 6; /materials has elements 0 to 1",
     [](json& d) { d["nodes"][3]["extensions"]["ETD_optics"]["geometry"]["material"] = 6; }},
    {"/nodes/3/extensions/ETD_optics/light/stokes: must be [1, S1, S2, S3] with S1² + S2² + S3² at most 1",
     [](json& d) {
         d["nodes"][3]["extensions"]["ETD_optics"]["light"] = {{"class", "point"},
                                                               {"stokes", {1, 0.8, 0.8, 0}}};
     }},
    {"/nodes/3/extensions/ETD_optics/light/stokes: has 3 elements; must be 4 numbers",
     [](json& d) {
         d["nodes"][3]["extensions"]["ETD_optics"]["light"] = {{"class", "point"}, {"stokes", {1, 0, 0}}};
     }},
    {"/nodes/3/extensions/ETD_optics/receiver/stokes: is",
     [](json& d) {
         d["nodes"][3]["extensions"]["ETD_optics"]["receiver"] = {{"class", "perspective"}, {"stokes", 1}};
     }},
    {"/nodes/3/extensions/ETD_optics/receiver: has no \"class\"",
     [](json& d) {
         d["nodes"][3]["extensions"]["ETD_optics"]["receiver"] = {{"stokes", true}};
     }},
    {"/nodes/3/extensions/ETD_optics/shape: is not known; allowed are geometry, light, receiver, element",
     [](json& d) { d["nodes"][3]["extensions"]["ETD_optics"]["shape"] = 6; }},
    {"/extensions/ETD_optics/media/1: has the name 'fog', which another medium has",
     [](json& d) {
         json& media = d["extensions"]["ETD_optics"]["media"];
         media.push_back(json(media[0]));
     }},
    {"/extensions/ETD_optics/class_files/0/interface: is 'film'; must be surface, geometry",
     [](json& d) {
         d["extensions"]["ETD_optics"]["class_files"] =
             json::array({{{"interface", "film"}, {"file", "a.glsl"}}});
     }},
    {"/extensions/ETD_optics/class_files/0/file: there is no file nowhere/a.glsl",
     [](json& d) {
         d["extensions"]["ETD_optics"]["class_files"] =
             json::array({{{"interface", "surface"}, {"file", "a.glsl"}}});
     }},
};

}  // namespace

TEST_CASE("every fault of a document is one line with the place and what is allowed") {
    for (const Fault& fault : faults) {
        GltfBuilder b = whole_scene();
        fault.make(b.document);
        std::string error = import_error(b.glb());
        std::string expected = fault.expected;
        CAPTURE(expected);
        CAPTURE(error);
        CHECK(error.starts_with("nowhere/scene.glb: "));
        CHECK(error.find(expected) != std::string::npos);
        CHECK(error.find('\n') == std::string::npos);
    }
}

TEST_CASE("a document without faults is read") {
    GltfBuilder b = whole_scene();
    b.document["materials"][0] = json::object();
    CHECK(import_error(b.glb()) == "");
}

TEST_CASE("bytes that are no scene are refused") {
    CHECK(import_error({}) == "nowhere/scene.glb: the file is empty");
    CHECK(import_error(bytes_of("hello")).find("not a scene: parse error at line 1") != std::string::npos);
    CHECK(import_error(bytes_of("[1]")).find("is an array; must be an object") != std::string::npos);
    CHECK(import_error(bytes_of("{\"asset\":")).find("not a scene: parse error") != std::string::npos);
    CHECK(import_error(bytes_of("{\"a\":1e999}")).find("not a scene: number overflow") != std::string::npos);
    CHECK(import_error(bytes_of("{\"a\":\"\xff\"}")).find("not a scene") != std::string::npos);
    CHECK(import_error(bytes_of(std::string(100000, '['))).find("nested deeper than 256") !=
          std::string::npos);
}

TEST_CASE("a .glb that is cut off anywhere is refused") {
    std::vector<uint8_t> whole = whole_scene().glb();
    for (size_t size = 1; size < whole.size(); size += 7) {
        std::string error = import_error({whole.begin(), whole.begin() + ptrdiff_t(size)});
        CAPTURE(size);
        CHECK(!error.empty());
        if (size >= 20) CHECK(error.find("the file is truncated: its header says") != std::string::npos);
    }
}

TEST_CASE("a .glb of another version, or with chunks beyond its end, is refused") {
    std::vector<uint8_t> bytes = whole_scene().glb();
    bytes[4] = 1;
    CHECK(import_error(bytes).find("is a .glb of version 1; must be 2") != std::string::npos);
    bytes = whole_scene().glb();
    bytes[14] = 0x7f;
    CHECK(import_error(bytes).find("is longer than the file") != std::string::npos);
}

TEST_CASE("a missing file and a folder are refused with their name") {
    auto error_of = [](const std::filesystem::path& path) -> std::string {
        try {
            import_gltf(path);
            return "";
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            return e.what();
        }
    };
    CHECK(error_of("nowhere/at_all.gltf").starts_with("nowhere/at_all.gltf: "));
    CHECK(error_of(std::filesystem::temp_directory_path()) != "");
}

TEST_CASE("what is read past is one warning for each extension, naming it and its first place") {
    GltfBuilder b = whole_scene();
    json other = {{"extensions", {{"KHR_materials_fur", json::object()}}}};
    b.document["materials"] = json::array({other, other});
    b.document["nodes"][3].erase("extensions");
    b.document["extensionsUsed"] = json::array({"KHR_animation_pointer", "FOO_bar", "ETD_optics"});
    b.document["extensionsRequired"] = json::array({"KHR_animation_pointer"});
    SceneDescription s = b.import();
    CHECK(s.warnings.size() == 3);
    CHECK(has_warning(s, "nowhere/scene.glb: /materials/0: KHR_materials_fur is not modelled yet: ignored"));
    CHECK(has_warning(s, "/extensionsUsed/0: KHR_animation_pointer is not modelled yet: ignored"));
    CHECK(has_warning(s, "/extensionsUsed/1: FOO_bar is not modelled yet: ignored"));
}
