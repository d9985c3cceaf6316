// Optical elements of class grating: a plate of no thickness in the middle of its box.
#include "host/gltf/import.h"

namespace etendue {
namespace {

// [-1, 0, 1] with as many efficiencies, of light that passes or is reflected.
nlohmann::json listed_orders(const JsonAt& at) {
    const JsonAt orders = member(at, "orders"), parts = member(at, "efficiencies");
    const std::vector<double> carried = number_array(parts, orders->size(), 0, 1);
    const char* const side = boolean(at, "reflects", false) ? "reflected" : "transmitted";
    nlohmann::json rows = nlohmann::json::array();
    for (size_t i = 0; i < carried.size(); ++i) rows.push_back({{"order", (*orders)[i]}, {side, carried[i]}});
    return rows;
}

}  // namespace

void place_grating(GltfImport& import, const JsonAt& at) {
    const std::vector<double> size = number_array(member(at, "size"), 2, 0, max_coordinate);
    const double thickness = number(at, "thickness", 0.01 * std::min(size[0], size[1]), 1e-9, max_coordinate);
    MaterialDescription material;
    material.name = "grating";
    material.surface = {"grating", nlohmann::json::object(), at.pointer};
    for (const auto& [key, value] : at->items())
        if (key != "class" && key != "size" && key != "thickness" && key != "reflects")
            material.surface.parameters[key] = value;
    const auto parts = find(at, "efficiencies");
    const bool are_listed = parts && (*parts)->is_array() && !(*parts)->empty() && (**parts)[0].is_number();
    if (are_listed) {
        material.surface.parameters["orders"] = listed_orders(at);
        material.surface.parameters.erase("efficiencies");
    } else if (find(at, "reflects")) {
        fail_at(member(at, "reflects"), "is for efficiencies that are numbers, one an order; allowed: those");
    }
    check_grating_form(at, material.surface);
    import.scene.shapes.push_back({"grating",
                                   {"rectangle",
                                    {{ "size",
                                       size }},
                                    at.pointer},
                                   import.content_root,
                                   uint32_t(import.scene.materials.size())});
    import.scene.materials.push_back(std::move(material));
    bound_by_box(import, at, size, -0.5 * thickness, 0.5 * thickness);
}

}  // namespace etendue
