// Optical elements of a scene file: what is read, and what is refused.
#include <doctest/doctest.h>

#include "tests/host/gltf_scene_builder.h"

using namespace etendue;
using nlohmann::json;

namespace {

// Scene 0 holds an element of scene 1, which holds a ball.
GltfBuilder with_element(json element) {
    GltfBuilder b;
    b.node({{"name", "lens"},
            {"translation", {1, 2, 3}},
            {"scale", {2, 2, 2}},
            {"extensions", {{"ETD_optics", {{"element", std::move(element)}}}}}});
    b.node({{"name", "ball"},
            {"extensions", {{"ETD_optics", {{"geometry", {{"class", "sphere"}, {"radius", 0.5}}}}}}}});
    b.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    return b;
}
json subscene(int scene) { return {{"class", "subscene"}, {"scene", scene}}; }

}  // namespace

TEST_CASE("an element has a frame without scale, and what it holds is scaled") {
    const SceneDescription s = with_element(subscene(1)).import();
    REQUIRE(s.elements.size() == 1);
    REQUIRE(s.contents.size() == 1);
    CHECK(s.elements[0].name == "lens");
    CHECK(s.elements[0].parent == 0);
    CHECK(s.elements[0].parent_from_local[3] == glm::dvec4(1, 2, 3, 1));
    CHECK(s.elements[0].parent_from_local[0] == glm::dvec4(1, 0, 0, 0));
    REQUIRE(s.shapes.size() == 1);
    CHECK(s.shapes[0].content == 1);
    CHECK(s.shapes[0].world_from_local[0] == glm::dvec4(2, 0, 0, 0));
    CHECK(s.materials[s.boundary_material].surface.class_name == "absorber");
}

TEST_CASE("elements of the same scene and scale share what they hold, unless it shines") {
    GltfBuilder b = with_element(subscene(1));
    for (int i = 2; i < 5; ++i) {
        b.node({{"scale", {i == 4 ? 1 : 2, 2, 2}},
                {"extensions", {{"ETD_optics", {{"element", subscene(1)}}}}}});
    }
    b.document["scenes"] = {{{"nodes", {0, 2, 3, 4}}}, {{"nodes", {1}}}};
    const SceneDescription s = b.import();
    CHECK(s.elements.size() == 4);
    CHECK(s.contents.size() == 2);
    b.document["nodes"][1]["extensions"]["ETD_optics"]["light"] = {{"class", "collimated"}};
    CHECK(b.import().contents.size() == 4);
}

TEST_CASE("faults of elements are named") {
    const std::string at = "nowhere/scene.glb: /nodes/0/extensions/ETD_optics/element";
    const auto error = [](json element) { return import_error(with_element(std::move(element)).glb()); };
    CHECK(error({{"class", "lens"}, {"scene", 1}}) ==
          at + "/class: there is no element class 'lens'; allowed: subscene, microstructure, lens_system, "
               "grating");
    CHECK(error(subscene(7)) == at + "/scene: is 7; /scenes has elements 0 to 1");
    CHECK(error(subscene(0)) == at + "/scene: scene 0 holds itself; allowed: another scene");
    json sphere = subscene(1);
    sphere["boundary"] = "sphere";
    CHECK(error(sphere) ==
          at + "/boundary: is 'sphere'; allowed: \"box\", the index of a mesh, or a sphere or cylinder");
    sphere["boundary"] = {{"class", "torus"}, {"radius", 1}};
    CHECK(error(sphere) == at + "/boundary/class: is 'torus'; allowed: sphere, cylinder");
    json open = subscene(1);
    open["boundary"] = 0;
    GltfBuilder b = with_element(open);
    b.triangle();
    CHECK(import_error(b.glb()).find("is not closed: there is a hole") != std::string::npos);
}

TEST_CASE("spheres and cylinders bound elements as closed meshes around them") {
    for (const json& shape : {json{{"class", "sphere"}, {"radius", 2}},
                              json{{"class", "cylinder"}, {"radius", 2}, {"height", 3}}}) {
        json element = subscene(1);
        element["boundary"] = shape;
        const SceneDescription s = with_element(element).import();
        const MeshDescription& mesh = s.meshes.at(s.contents.at(0).boundary.at(0).mesh);
        double volume = 0, nearest = INFINITY;
        std::map<std::pair<uint32_t, uint32_t>, int> edges;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
            volume += glm::dot(a, glm::cross(b, c)) / 6;
            nearest = std::min(nearest, glm::dot(n, a));
            for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}], --edges[{t[(i + 1) % 3], t[i]}];
        }
        for (const auto& [edge, balance] : edges) CHECK(balance == 0);
        const bool is_sphere = shape["class"] == "sphere";
        CHECK(nearest >= (is_sphere ? 2 : 1.5) * (1 - 1e-6));
        CHECK(volume == doctest::Approx(is_sphere ? 33.51 : 37.70).epsilon(0.03));
    }
}

TEST_CASE("a scene that holds one that holds it is refused") {
    GltfBuilder b = with_element(subscene(1));
    b.document["nodes"][1]["extensions"]["ETD_optics"] = {{"element", subscene(1)}};
    CHECK(import_error(b.glb()).find("scene 1 holds itself") != std::string::npos);
    b.document["nodes"][1]["extensions"]["ETD_optics"] = {{"element", subscene(0)}};
    CHECK(import_error(b.glb()).find("scene 0 holds itself") != std::string::npos);
}

TEST_CASE("an element of grating is a rectangle in a box, with orders or with a table") {
    const json listed = {{"class", "grating"},
                         {"size", {0.02, 0.01}},
                         {"period", 1e-6},
                         {"orders", {-1, 0, 1}},
                         {"efficiencies", {0.1, 0.3, 0.5}},
                         {"reflects", true},
                         {"evanescent", "absorbed"}};
    const SceneDescription s = with_element(listed).import();
    REQUIRE(s.shapes.size() == 1);
    CHECK(s.shapes[0].content == 1);
    CHECK(s.shapes[0].object.parameters["size"] == json({0.02, 0.01}));
    const ObjectDescription& surface = s.materials.at(s.shapes[0].material).surface;
    CHECK(surface.class_name == "grating");
    CHECK(surface.parameters == json({{"period", 1e-6},
                                      {"evanescent", "absorbed"},
                                      {"orders",
                                       {{{"order", -1}, {"reflected", 0.1}},
                                        {{"order", 0}, {"reflected", 0.3}},
                                        {{"order", 1}, {"reflected", 0.5}}}}}));
    REQUIRE(s.contents.at(0).boundary.size() == 1);
    float high = 0, wide = 0;
    for (const glm::vec3& p : s.meshes.at(s.contents[0].boundary[0].mesh).positions)
        high = std::max(high, p.z), wide = std::max(wide, p.x);
    CHECK(wide == 0.01f);
    CHECK(high == doctest::Approx(5e-5));

    json table = listed;
    table.erase("orders"), table.erase("reflects");
    table["efficiencies"] = {{{"order", 1}, {"transmitted", 0.5}}};
    CHECK(with_element(table).import().materials.size() == 2);
    const auto error = [](json element) { return import_error(with_element(std::move(element)).glb()); };
    json both = listed;
    both["efficiencies"] = table["efficiencies"], both.erase("reflects");
    CHECK(error(both).find("element: has both orders and efficiencies; allowed: one of them") !=
          std::string::npos);
    json fewer = listed;
    fewer["efficiencies"] = {0.1, 0.3};
    CHECK(error(fewer).find("/element/efficiencies") != std::string::npos);
    json none = listed;
    none.erase("size");
    CHECK(error(none).find("/element") != std::string::npos);
}

TEST_CASE("an element of microstructure is a sheet in a box that it fills") {
    const json sheet = {{"class", "microstructure"},
                        {"size", {0.4, 0.2}},
                        {"pitch", {0.01, 0.01}},
                        {"radius", 0.002},
                        {"depth", 0.001},
                        {"scale", 2},
                        {"density", 0.5},
                        {"operation", "remove"}};
    const SceneDescription s = with_element(sheet).import();
    REQUIRE(s.shapes.size() == 1);  // the ball is in no scene that is shown
    CHECK(s.shapes[0].content == 1);
    CHECK(s.shapes[0].object.class_name == "microstructure");
    CHECK(s.shapes[0].object.parameters["radius"] == 0.004);
    CHECK(s.shapes[0].object.parameters["density"] == 0.5);
    REQUIRE(s.contents.at(0).boundary.size() == 1);
    float low = 0, high = 0, wide = 0;
    for (const glm::vec3& p : s.meshes.at(s.contents[0].boundary[0].mesh).positions)
        low = std::min(low, p.z), high = std::max(high, p.z), wide = std::max(wide, p.x);
    CHECK(wide == 0.2f);
    CHECK(low < -0.002f);
    CHECK(high > 0);

    const std::string at = "nowhere/scene.glb: /nodes/0/extensions/ETD_optics/element";
    const auto error = [&](json more, const char* without) {
        json element = sheet;
        element.update(more);
        for (const char* name : {without, "density", "scale"}) element.erase(name);
        return import_error(with_element(std::move(element)).glb());
    };
    CHECK(error({{"placement", {{"file", "dots.txt"}}}}, "") ==
          at + "/pitch: is not for places from a file; allowed: without");
    CHECK(error({{"placement", "file"}}, "") == at + "/placement: is \"file\"; allowed: {\"file\": NAME}");
    CHECK(error({{"bend", 1}}, "") ==
          at + "/bend: is not for a sheet in a box; allowed: in a geometry of a scene that an element holds");
    CHECK(error({{"cell_size", 2}}, "") == at + "/cell_size: is not for shapes; allowed: without");
    CHECK(error({{"cell", 1}}, "") == at + "/radius: is not for cells that hold a scene; allowed: without");
}

TEST_CASE("the meshes of a scene stand in the cells of a sheet") {
    const auto with_cell = [](json more) {
        json sheet = {{"class", "microstructure"}, {"size", {4, 4}}, {"pitch", {2, 2}}, {"cell", 1}};
        sheet.update(more);
        GltfBuilder b = with_element(sheet);
        b.triangle();
        b.document["nodes"][1] = {{"mesh", 0}};
        b.document["scenes"][0]["nodes"] = {0};
        return b;
    };
    const SceneDescription s = with_cell({{"cell_size", 0.5}}).import();
    REQUIRE(s.cells.size() == 1);
    CHECK(s.cells[0].corners.size() == 3);
    CHECK(s.instances.empty());
    CHECK(s.shapes.at(0).object.parameters["cell"] == 0);
    float reach = 0;
    for (const glm::vec3& p : s.cells[0].corners) reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
    CHECK(reach == 0.5f);

    const std::string at = "nowhere/scene.glb: /nodes/0/extensions/ETD_optics/element/cell";
    CHECK(import_error(with_cell({{"cell_size", 3}}).glb()).starts_with(at + ": scene 1 reaches to "));
    GltfBuilder other = with_cell(json::object());
    other.document["nodes"][1] = {
        {"extensions", {{"ETD_optics", {{"geometry", {{"class", "sphere"}, {"radius", 1}}}}}}}};
    CHECK(import_error(other.glb()) ==
          at + ": scene 1 has shapes, lamps, receivers or elements; allowed in cells: meshes");
    CHECK(import_error(with_cell({{"placement", "jittered"}}).glb())
              .ends_with("/placement: cells that hold a scene fill their places; allowed: grid, staggered"));
}

TEST_CASE("an element of a lens is its surfaces, rims and housing, and its glasses as media") {
    const json doublet = {
        {{"radius", 0.0615}, {"thickness", 0.01}, {"material", "N-BK7"}, {"semi_diameter", 0.015}},
        {{"radius", -0.0446}, {"thickness", 0.0025}, {"ior", 1.6727}, {"semi_diameter", 0.015}},
        {{"radius", -0.1299}, {"conic", -0.5}, {"coefficients", {20, 3e4}}, {"semi_diameter", 0.0125}}};
    const SceneDescription s = with_element({{"class", "lens_system"}, {"surfaces", doublet}}).import();
    std::map<std::string, int> count;
    for (const PlacedObject& shape : s.shapes) ++count[shape.object.class_name];
    CHECK(count == std::map<std::string, int>{{"asphere", 3}, {"disk", 3}, {"cylinder", 2}});
    const auto glass = std::ranges::find(s.media, "glass N-BK7", &MediumDescription::name);
    REQUIRE(glass != s.media.end());
    CHECK(glass->medium.parameters["ior"].contains("sellmeier"));
    const json& last = std::ranges::find(s.shapes, "surface 3", &PlacedObject::name)->object.parameters;
    CHECK(last["curvature"] == doctest::Approx(-1 / 0.1299));
    CHECK(last["coefficients"][0] == doctest::Approx(20));
    CHECK(std::abs(last["coefficients"][1].get<double>() - 3e4) < 1e-6);
}

TEST_CASE("faults of lens systems are named") {
    const auto error = [](json lens) {
        lens["class"] = "lens_system";
        return import_error(with_element(lens).glb());
    };
    const std::string at = "nowhere/scene.glb: /nodes/0/extensions/ETD_optics/element";
    CHECK(error({}) == at + ": names neither file nor surfaces; allowed: one of file and surfaces");
    CHECK(error({{"surfaces", json::array()}}) == at + "/surfaces: is empty; allowed: at least one surface");
    CHECK(error({{"surfaces", {{{"radius", 1}}}}}) ==
          at + "/surfaces/0: has no \"semi_diameter\", which is required");
    const json plane = {{"semi_diameter", 0.01}};
    CHECK(error({{"surfaces", {{{"semi_diameter", 0.01}, {"material", "jelly"}}}}})
              .starts_with(
                  at + "/surfaces/0/material: no data of the glass 'jelly'; allowed: mirror, glasses of"));
    const std::string surface = at + "/surfaces: surface 1: ";
    CHECK(error({{"surfaces", {{{"radius", 0.01}, {"semi_diameter", 0.02}, {"ior", 1.5}}, plane}}})
              .starts_with(surface + "its aperture reaches 20 mm from the axis"));
    CHECK(error({{"surfaces",
                  {{{"radius", 0.02}, {"thickness", 0.001}, {"semi_diameter", 0.01}, {"ior", 1.5}}, plane}}})
              .find("cross") != std::string::npos);
    json high = {
        {"semi_diameter", 0.01}, {"ior", 1.5}, {"coefficients", json::array({0, 0, 0, 0, 0, 0, 0, 0, 1})}};
    CHECK(error({{"surfaces", {high}}}).find("allowed in a scene: r⁴ to r¹⁸") != std::string::npos);
    CHECK(error({{"file", "no.zmx"}}).find("no.zmx") != std::string::npos);
}
