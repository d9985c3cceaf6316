// Sheets of two triangles, one for each side.
#include <doctest/doctest.h>

#include "host/geometry/twins.h"
#include "host/scene/records.h"
#include "tests/support/render_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

const std::vector<glm::vec3> corners = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};

json glowing(const json& color, bool double_sided) {
    return {{"doubleSided", double_sided},
            {"emissiveFactor", color},
            {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

}  // namespace

TEST_CASE("twins: triangles with the same corners that face apart, one-sided and without media") {
    const PrimitiveRecord front{{0, 0, 0}, 0, {1, 0, 0}, no_record, {0, 1, 0}, 0};
    PrimitiveRecord back{{1, 0, 0}, 0, {0, 0, 0}, no_record, {0, 1, 0}, 0};
    std::vector<MaterialDescription> materials(1);
    CHECK(find_twins(std::vector{front, back}, materials) == std::vector<uint32_t>{1, 0});
    CHECK(find_twins(std::vector{front, front}, materials) == std::vector<uint32_t>{no_record, no_record});
    CHECK(find_twins(std::vector{front, back, back}, materials) == std::vector<uint32_t>{1, 0, no_record});
    glm::uvec3 indices(7, 8, 9);
    turn_to(front, back, &indices);
    CHECK((back.v0 == front.v0 && back.v1 == front.v2 && back.v2 == front.v1));
    CHECK(indices == glm::uvec3(8, 9, 7));
    materials[0].double_sided = true;
    CHECK(find_twins(std::vector{front, back}, materials)[0] == no_record);
    materials[0].double_sided = false, materials[0].inside = "glass";
    CHECK(find_twins(std::vector{front, back}, materials)[0] == no_record);
}

TEST_CASE("twins: a ray sees the sheet whose front is turned towards it, and alpha counts once") {
    // Red on the side of +z, green on the other; beside it the same of alpha 0.5 before a white sky.
    SceneBuilder s;
    for (double x : {-1.0, 1.0}) {
        json red = glowing({1, 0, 0}, false), green = glowing({0, 1, 0}, false);
        if (x > 0)
            for (json* m : {&red, &green}) {
                (*m)["alphaMode"] = "BLEND";
                (*m)["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 0.5};
            }
        s.mesh(corners, {0, 1, 2, 0, 2, 3}, s.material(json::object(), red), at(x, 0, 0));
        s.mesh(corners, {1, 0, 2, 3, 2, 0}, s.material(json::object(), green), at(x, 0, 0));
    }
    s.environment({0, 0, 1});
    s.orthographic(0.5, at(0, 0, 5), "front");
    s.orthographic(0.5, Place{{0, 0, -5}, {0, 1, 0, 0}}, "back");
    Scene scene = compile_test_scene(s.import());
    for (Algorithm algorithm : {Algorithm::backward, Algorithm::bidirectional})
        for (int back : {0, 1}) {
            const Estimates e = render_estimates(scene, {.width = 16,
                                                         .height = 4,
                                                         .passes = 64,
                                                         .seeds = 4,
                                                         .receiver = back ? "back" : "front",
                                                         .algorithm = algorithm});
            const uint32_t whole = back ? 10 : 2,
                           half = back ? 2 : 10;  // the camera behind sees +x on the left
            for (const auto& [x, part] : {std::pair(whole, 1.0), std::pair(half, 0.5)}) {
                const Window window{x, 0, 4, 4};
                CAPTURE(back);
                CAPTURE(x);
                CHECK(window_mean(e, window, back).mean == doctest::Approx(part).epsilon(0.05));
                CHECK(window_mean(e, window, 1 - back).mean == 0);
                CHECK(window_mean(e, window, 2).mean == doctest::Approx(1 - part).epsilon(0.05));
            }
        }
}
