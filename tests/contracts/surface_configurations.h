// What the tests ask of every class of surface: parameters, surroundings, and what is known of the result.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct SurfaceConfiguration {
    std::string label;
    nlohmann::json parameters = nlohmann::json::object();
    float ior_above = 1, ior_below = 1;
    // The part of the light that leaves, whatever the direction, and how near to it every direction must
    // come.
    std::optional<double> albedo;
    double albedo_tolerance = 2e-5;
    // Width of the narrowest lobe: what single precision directions resolve of it limits how well values
    // agree.
    double width = 1;
    bool is_reciprocal = true;  // tables need not be
};

// Of a grating: whatever comes, polarized and not the same both ways.
inline nlohmann::json grating_table() {
    nlohmann::json rows = nlohmann::json::array();
    for (int order = -1; order <= 1; ++order)
        for (const char* side : {"above", "below"})
            for (const char* polarization : {"s", "p"})
                for (int i = 0; i < 4; ++i) {
                    const double turn = order + 3 * (side[0] == 'a') + 7 * (polarization[0] == 's') + 1.7 * i;
                    const double part = 0.08 + 0.07 * std::sin(turn);
                    rows.push_back({{"order", order},
                                    {"side", side},
                                    {"polarization", polarization},
                                    {"angle", -0.9 + 0.5 * i},
                                    {"wavelength", {464, 549, 611}},
                                    {"reflected", {part, 0.5 * part, 0.9 * part}},
                                    {"transmitted", {0.2 - part, 0.1, 1.1 * part}}});
                }
    return rows;
}

std::vector<SurfaceConfiguration> extended_principled();  // principled_extensions_test.cpp
std::vector<SurfaceConfiguration> measured_files();       // measured_test.cpp
std::vector<SurfaceConfiguration> mueller_files();        // mueller_table_test.cpp

inline std::vector<SurfaceConfiguration> surface_configurations(const std::string& name) {
    using C = SurfaceConfiguration;
    const auto value = [](double r, double g, double b, double a) {
        return nlohmann::json{{"value", {r, g, b, a}}};
    };
    if (name == "lambertian")
        return {C{"white", {{"reflectance", 1}}, 1, 1, 1.0},
                C{"coloured", {{"reflectance", {0.7, 0.2, 0.05}}}},
                C{"textured",
                  {{"reflectance", 1}, {"reflectance_texture", value(0.25, 0.25, 0.25, 1)}},
                  1,
                  1,
                  0.25}};
    if (name == "conductor") {
        const nlohmann::json gold_eta = {0.143, 0.375, 1.442}, gold_k = {3.983, 2.386, 1.603};
        return {
            C{"mirror", {{"reflectance", 1}}, 1, 1, 1.0},
            C{"mirror by default", nlohmann::json::object(), 1, 1.5, 1.0},
            C{"grey mirror, alpha below the threshold", {{"reflectance", 0.4}, {"alpha", 5e-5}}, 1, 1, 0.4},
            C{"smooth gold under water", {{"eta", gold_eta}, {"k", gold_k}}, 1.33f, 1},
            C{"alpha 1e-4", {{"reflectance", 1}, {"alpha", 1e-4}}, 1, 1, {}, 0, 1e-4},
            C{"alpha .001", {{"reflectance", 1}, {"alpha", 0.001}}, 1, 1, {}, 0, 1e-3},
            C{"gold, alpha .01", {{"eta", gold_eta}, {"k", gold_k}, {"alpha", 0.01}}, 1, 1, {}, 0, 0.01},
            C{"gold, alpha .3", {{"eta", gold_eta}, {"k", gold_k}, {"alpha", 0.3}}},
            C{"white, alpha .3", {{"reflectance", 1}, {"alpha", 0.3}}},
            C{"white, alpha 1", {{"reflectance", 1}, {"alpha", 1}}},
            C{"lossless, alpha .01",
              {{"reflectance", 1}, {"alpha", 0.01}, {"multiscatter", true}},
              1,
              1,
              1.0,
              0.005,
              0.01},
            C{"lossless, alpha .1",
              {{"reflectance", 1}, {"alpha", 0.1}, {"multiscatter", true}},
              1,
              1,
              1.0,
              0.005},
            C{"lossless, alpha .4",
              {{"reflectance", 1}, {"alpha", 0.4}, {"multiscatter", true}},
              1,
              1,
              1.0,
              0.005},
            C{"lossless, alpha .7",
              {{"reflectance", 1}, {"alpha", 0.7}, {"multiscatter", true}},
              1,
              1,
              1.0,
              0.005},
            C{"lossless, alpha 1",
              {{"reflectance", 1}, {"alpha", 1}, {"multiscatter", true}},
              1,
              1,
              1.0,
              0.005},
            C{"grey, multiscatter, alpha 1", {{"reflectance", 0.5}, {"alpha", 1}, {"multiscatter", true}}},
            C{"gold, multiscatter, alpha .5",
              {{"eta", gold_eta}, {"k", gold_k}, {"alpha", 0.5}, {"multiscatter", true}}}};
    }
    if (name == "dielectric")
        return {C{"smooth glass", nlohmann::json::object(), 1, 1.5f, 1.0},
                C{"smooth, nearly matched", nlohmann::json::object(), 1.5f, 1.5001f, 1.0},
                C{"matched, rough", {{"alpha", 0.3}}, 1.5f, 1.5f, 1.0},
                C{"nearly matched, rough", {{"alpha", 0.3}}, 1.5f, 1.5001f, 1.0},
                C{"oil in water, alpha .2", {{"alpha", 0.2}}, 1.33f, 1.36f, {}, 0, 0.2 * 0.02},
                C{"glass, alpha .001", {{"alpha", 0.001}}, 1, 1.5f, {}, 0, 0.001},
                C{"glass, alpha .01", {{"alpha", 0.01}}, 1, 1.5f, {}, 0, 0.01},
                C{"glass, alpha .3", {{"alpha", 0.3}}, 1, 1.5f},
                C{"diamond below air, alpha .5", {{"alpha", 0.5}}, 2.4f, 1},
                C{"glass, alpha 1", {{"alpha", 1}}, 1, 1.5f},
                C{"lossless, alpha .05", {{"alpha", 0.05}, {"multiscatter", true}}, 1, 1.5f, 1.0, 0.01},
                C{"lossless, alpha .3", {{"alpha", 0.3}, {"multiscatter", true}}, 1, 1.5f, 1.0, 0.005},
                C{"lossless, alpha .7", {{"alpha", 0.7}, {"multiscatter", true}}, 1, 1.5f, 1.0, 0.005},
                C{"lossless, alpha 1", {{"alpha", 1}, {"multiscatter", true}}, 1, 1.5f, 1.0, 0.005},
                C{"water over air, multiscatter, alpha .5",
                  {{"alpha", 0.5}, {"multiscatter", true}},
                  1.33f,
                  1,
                  1.0,
                  0.01}};
    if (name == "antireflective")
        return {C{"coated glass", nlohmann::json::object(), 1, 1.5f, 1.0},
                C{"out of diamond", nlohmann::json::object(), 2.4f, 1, 1.0},
                C{"matched", nlohmann::json::object(), 1.5f, 1.5f, 1.0}};
    if (name == "thin_dielectric")
        return {C{"pane", nlohmann::json::object(), 1, 1, 1.0}, C{"bubble", {{"ior", 1}}, 1.33f, 1.33f, 1.0}};
    if (name == "diffuse_transmitter")
        return {
            C{"by default", nlohmann::json::object(), 1, 1, 1.0},
            C{"lossless under water", {{"reflectance", 0.3}, {"transmittance", 0.7}}, 1.33f, 1, 1.0},
            C{"coloured", {{"reflectance", {0.2, 0.6, 0.1}}, {"transmittance", {0.3, 0.4, 0.0}}}, 1, 1.5f},
            C{"too bright", {{"reflectance", 0.8}, {"transmittance", 0.7}}, 1, 1, 1.0},
            C{"textured",
              {{"reflectance", 1},
               {"reflectance_texture", value(0.25, 0.25, 0.25, 1)},
               {"transmittance_texture", value(0.5, 0.5, 0.5, 1)}},
              1,
              1,
              0.5}};
    if (name == "thin_film") {
        const nlohmann::json steel_eta = {2.9, 2.9, 2.6}, steel_k = {3.1, 3.3, 3.3};
        return {
            C{"soap", nlohmann::json::object(), 1, 1, 1.0},
            C{"soap, rough", {{"alpha", 0.3}}, 1, 1, 1.0},
            C{"oil on water, smooth", {{"ior", 1.47}, {"thickness", 350}}, 1, 1.33f, 1.0},
            C{"coat against reflection, alpha .3",
              {{"ior", 1.22}, {"thickness", 112}, {"alpha", 0.3}},
              1,
              1.5f},
            C{"gap between glasses, alpha .4", {{"ior", 1}, {"thickness", 90}, {"alpha", 0.4}}, 1.5f, 1.6f},
            C{"oxide on smooth steel under water",
              {{"ior", 2.4}, {"thickness", 60}, {"eta", steel_eta}, {"k", steel_k}},
              1.33f,
              1},
            C{"oxide on rough steel, textured",
              {{"ior", 2.4},
               {"thickness", 200},
               {"thickness_texture", value(0, 0.3, 0, 1)},
               {"eta", steel_eta},
               {"k", steel_k},
               {"alpha", 0.2}}}};
    }
    if (name == "linear_polarizer")
        return {C{"ideal", nlohmann::json::object(), 1, 1, 0.5},
                C{"real, turned", {{"axis", 0.7}, {"parallel", {0.8, 0.85, 0.7}}, {"crossed", 0.01}}},
                C{"along its axis", {{"axis", -2}, {"kind", "transmitting"}, {"crossed", 0.1}}, 1, 1, 0.55}};
    if (name == "reflective_polarizer")
        return {C{"ideal", nlohmann::json::object(), 1, 1, 1.0},
                C{"real, turned", {{"axis", 0.7}, {"pass", {0.8, 0.85, 0.7}}, {"block", 0.9}}}};
    if (name == "retarder")
        return {C{"quarter wave", {{"axis", 0.3}, {"retardance", 1.5707963}}, 1, 1, 1.0},
                C{"quartz", {{"axis", 0.3}}, 1, 1, 1.0},
                C{"calcite",
                  {{"ior_ordinary", 1.6584}, {"ior_extraordinary", 1.4864}, {"thickness", 1300}},
                  1,
                  1,
                  1.0}};
    if (name == "depolarizer") return {C{"depolarizer", nlohmann::json::object(), 1, 1, 1.0}};
    if (name == "lc_cell")
        return {C{"twisted", nlohmann::json::object(), 1, 1, 1.0},
                C{"driven, in glass",
                  {{"rubbing", 0.4}, {"twist", -1.2}, {"pretilt", 0.05}, {"drive", 0.6}},
                  1.5f,
                  1.5f,
                  1.0}};
    if (name == "mueller") {
        const nlohmann::json circular = {0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5};
        const nlohmann::json diagonal = {0.4, 0.1, 0.2, 0, 0.05, 0.2,  0, 0.1,
                                         0.1, 0,   0.2, 0, 0,    0.05, 0, 0.2};
        return {C{"some matrix", {{"matrix", diagonal}}, 1, 1, 0.4},
                C{"right circular polarizer", {{"matrix", circular}}, 1, 1, 0.5},
                C{"mirror of it", {{"matrix", circular}, {"axis", 0.4}, {"reflects", true}}, 1, 1, 0.5}};
    }
    if (name == "grating") {
        const nlohmann::json lossless = {{{"order", 0}, {"reflected", 0.2}, {"transmitted", 0.1}},
                                         {{"order", 1}, {"reflected", 0.15}, {"transmitted", 0.1}},
                                         {{"order", -1}, {"reflected", 0.15}, {"transmitted", 0.1}},
                                         {{"order", 2}, {"transmitted", 0.1}},
                                         {{"order", -2}, {"transmitted", 0.1}}};
        const nlohmann::json blazed = {
            {{"order", 1}, {"reflected", 0.7}, {"reflected_below", 0.1}},
            {{"order", -3}, {"reflected", {0.1, 0.2, 0.05}}, {"transmitted", 0.1}}};
        return {
            C{"lossless", {{"period", 1.3e-6}, {"axis", 0.4}, {"orders", lossless}}, 1, 1, 1.0},
            C{"lossless, of all but 0 evanescent", {{"period", 1e-7}, {"orders", lossless}}, 1, 1, 1.0},
            C{"lossless, on glass", {{"period", 1.3e-6}, {"axis", 2}, {"orders", lossless}}, 1, 1.5f, 1.0},
            C{"absorbing what is evanescent",
              {{"period", 1.3e-6}, {"orders", lossless}, {"evanescent", "absorbed"}},
              1.33f,
              1},
            C{"blazed", {{"period", 2e-6}, {"axis", -1}, {"orders", blazed}}, 1, 1.5f},
            C{.label = "tabulated",
              .parameters = {{"period", 1.3e-6}, {"axis", 0.4}, {"efficiencies", grating_table()}},
              .ior_below = 1.5f,
              .is_reciprocal = false}};
    }
    if (name == "mueller_table") return mueller_files();
    if (name == "color_filter") return {C{"red", {{"transmittance", {0.9, 0.2, 0.05}}}}};
    if (name == "measured") return measured_files();
    if (name == "absorber") return {C{"absorber", nlohmann::json::object(), 1, 1, 0.0}};
    if (name == "boundary") return {C{"boundary", nlohmann::json::object(), 1.33f, 1, 1.0}};
    if (name == "principled") {
        std::vector<C> result = {
            C{"white plastic, smooth", {{"metallic", 0}, {"roughness", 0}}, 1, 1, 1.0},
            C{"white plastic, roughness .2", {{"metallic", 0}, {"roughness", 0.2}}},
            C{"plastic, roughness .5",
              {{"metallic", 0}, {"roughness", 0.5}, {"base_color", {0.8, 0.3, 0.1, 1}}}},
            C{"white plastic, roughness 1", {{"metallic", 0}, {"roughness", 1}}},
            C{"ior 2.4, half metal", {{"metallic", 0.5}, {"roughness", 0.6}, {"ior", 2.4}}},
            C{"copper, roughness .3", {{"roughness", 0.3}, {"base_color", {0.95, 0.6, 0.4, 1}}}},
            C{"black", {{"metallic", 0}, {"roughness", 0.7}, {"base_color", {0, 0, 0, 1}}}},
            C{"blended",
              {{"metallic", 0}, {"roughness", 0.4}, {"alpha_mode", 2}, {"base_color", {0.9, 0.5, 0.2, 0.3}}}},
            C{"masked out", {{"alpha_mode", 1}, {"base_color", {1, 1, 1, 0.4}}}, 1, 1, 1.0},
            C{"masked in", {{"alpha_mode", 1}, {"roughness", 0.5}, {"base_color", {0.5, 0.5, 0.5, 0.6}}}},
            C{"thin, smooth",
              {{"metallic", 0}, {"roughness", 0}, {"transmission", 1}, {"thin", true}},
              1,
              1,
              1.0},
            C{"thin, rough, tinted",
              {{"metallic", 0},
               {"roughness", 0.5},
               {"transmission", 0.7},
               {"thin", true},
               {"base_color", {1, 0.6, 0.3, 1}}}},
            C{"solid, smooth", {{"metallic", 0}, {"roughness", 0}, {"transmission", 1}}, 1, 1.5f, 1.0},
            C{"solid, rough", {{"metallic", 0}, {"roughness", 0.5}, {"transmission", 1}}, 1, 1.5f},
            C{"solid, half",
              {{"metallic", 0.1},
               {"roughness", 0.6},
               {"transmission", 0.5},
               {"base_color", {0.4, 0.8, 0.9, 1}}},
              1,
              1.5f},
            C{"solid, matched",
              {{"metallic", 0}, {"roughness", 0.5}, {"transmission", 1}, {"ior", 1}},
              1.2f,
              1.2f},
            C{"textured",
              {{"base_color_texture", value(0.5, 0.25, 1, 0.5)},
               {"alpha_mode", 2},
               {"roughness", 0.8},
               {"metallic_roughness_texture", value(0, 0.5, 0.25, 1)},
               {"transmission", 1},
               {"thin", true},
               {"transmission_texture", value(0.5, 0, 0, 1)}}}};
        const std::vector<C> extended = extended_principled();
        result.insert(result.end(), extended.begin(), extended.end());
        return result;
    }
    return {};
}

}  // namespace etendue
