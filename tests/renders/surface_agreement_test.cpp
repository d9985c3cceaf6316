// Forward, backward and bidirectional rays give the same image of every class of surface that scatters in a
// way of its own.
#include <doctest/doctest.h>

#include "tests/renders/agreement_scenes.h"
#include "tests/renders/algorithm_comparison.h"

using namespace etendue;
using nlohmann::json;

namespace {

// A rough one, whose parameters `extensions` change.
int gltf_material(SceneBuilder& s, json extensions, double metallic = 0) {
    return s.material(
        json::object(),
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.7, 0.5, 0.4, 1}}, {"metallicFactor", metallic}, {"roughnessFactor", 0.5}}},
         {"doubleSided", true},
         {"extensions", std::move(extensions)}});
}

}  // namespace

TEST_SUITE("long") {
    TEST_CASE("algorithms agree: coats, sheen, brushed metal, coloured reflections, paper") {
        SceneBuilder s;
        add_room(s);
        add_lamp(s, 1.5);
        const auto ball = [&](int material, double x, double y, double z) {
            s.sphere(0.55, material, at(x, y, z));
        };
        ball(gltf_material(s, {{"KHR_materials_clearcoat",
                                {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.4}}}}),
             -1.3, -1.4, -0.6);
        ball(gltf_material(s, {{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.8}}}}), 0, -1.4, -0.6);
        ball(gltf_material(s, {{"KHR_materials_sheen",
                                {{"sheenColorFactor", {0.9, 0.6, 0.8}}, {"sheenRoughnessFactor", 0.5}}}}),
             1.3, -1.4, -0.6);
        ball(
            gltf_material(
                s, {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.7}, {"anisotropyRotation", 0.5}}}},
                1),
            -1.3, 0.1, -1);
        ball(gltf_material(s, {{"KHR_materials_specular", {{"specularColorFactor", {9, 4, 1}}}}}), 1.3, 0.1,
             -1);
        s.rectangle(1.6, 1.6,
                    gltf_material(s, {{"KHR_materials_diffuse_transmission",
                                       {{"diffuseTransmissionFactor", 0.7},
                                        {"diffuseTransmissionColorFactor", {0.9, 0.8, 0.5}}}}}),
                    hanging(0.2, 0.6, -0.4));
        s.medium("wax", {{"ior", 1.4}, {"absorption", {0.5, 1, 2}}});
        s.sphere(0.4,
                 s.material({{"surface",
                              {{"class", "diffuse_transmitter"},
                               {"reflectance", 0.3},
                               {"transmittance", {0.6, 0.5, 0.4}}}},
                             {"inside", "wax"}}),
                 at(0.2, -1.5, 0.7));
        check_against_backward(s);
    }

    TEST_CASE("algorithms agree: thin films on metal, on glass and on nothing, and iridescence") {
        // Tabulated metals make a scene spectral: colours integrate films over bands, wavelengths do not.
        nlohmann::json eta = {3, 3, 2.5}, k = 3.2;
        SUBCASE("in colours") {}
        SUBCASE("in wavelengths") { eta = {{"name", "Cr eta"}}, k = {{"name", "Cr k"}}; }
        SceneBuilder s;
        add_room(s);
        add_lamp(s, 1.5);
        s.sphere(0.3, s.black_emitter({6, 4, 3}), at(1.2, 1.2, 0.6));
        s.sphere(0.5,
                 s.surface({{"class", "thin_film"},
                            {"ior", 2.2},
                            {"thickness", 70},
                            {"eta", eta},
                            {"k", k},
                            {"alpha", 0.2}}),
                 at(-1.2, -1.4, -0.6));
        s.medium("glass", {{"ior", 1.5}});
        const auto on_glass = [&](double alpha) {
            return s.material(
                {{"surface", {{"class", "thin_film"}, {"ior", 1.8}, {"thickness", 400}, {"alpha", alpha}}},
                 {"inside", "glass"}});
        };
        s.sphere(0.5, on_glass(0), at(0, -1.4, 0.3));
        s.sphere(0.5, on_glass(0.3), at(1.2, -1.4, -0.6));
        s.rectangle(1.4, 1.4, s.surface({{"class", "thin_film"}}), hanging(-0.8, 0.3, 0));
        s.sphere(0.5,
                 gltf_material(s, {{"KHR_materials_iridescence",
                                    {{"iridescenceFactor", 1}, {"iridescenceThicknessMaximum", 300}}}}),
                 at(0.1, -1.4, -1.2));
        check_against_backward(s);
    }
}
