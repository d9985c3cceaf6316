// Sheets of microstructure: what their parameters name, and the sheet that is an optical element.
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/gltf/import.h"

namespace etendue {
namespace {

using nlohmann::json;

// Members of `at` that something makes useless.
void refuse(const JsonAt& at, std::initializer_list<const char*> names, const char* what) {
    for (const char* name : names)
        if (const auto found = find(at, name)) fail_at(*found, "is not for {}; allowed: without", what);
}

// The meshes of a scene that stands in cells, in metres.
CellDescription read_cell(GltfImport& import, const JsonAt& at, uint32_t number, double scale) {
    if (import.reads_cell) fail_at(at, "stands in a cell itself; allowed in cells: meshes");
    SceneDescription& scene = import.scene;
    const auto objects = [&] {
        return scene.shapes.size() + scene.lights.size() + scene.receivers.size() + scene.elements.size();
    };
    const size_t others = objects(), first = scene.instances.size();
    const glm::dmat4 root = std::exchange(import.content_root, glm::dmat4(glm::dmat3(scale)));
    import.reads_cell = true;
    place_nodes(import, number);
    import.reads_cell = false;
    import.content_root = root;
    if (objects() != others)
        fail_at(at, "scene {} has shapes, lamps, receivers or elements; allowed in cells: meshes", number);
    CellDescription cell{{}, number};
    for (size_t i = first; i < scene.instances.size(); ++i) {
        const MeshDescription& mesh = scene.meshes[scene.instances[i].mesh];
        const glm::dmat4& m = scene.instances[i].world_from_local;
        const bool mirrors = glm::determinant(glm::dmat3(m)) < 0;
        for (const glm::uvec3& t : mesh.triangles)
            for (const uint32_t corner : {t.x, mirrors ? t.z : t.y, mirrors ? t.y : t.z})
                cell.corners.push_back(glm::vec3(m * glm::dvec4(mesh.positions[corner], 1)));
    }
    scene.instances.resize(first);
    if (cell.corners.empty()) fail_at(at, "scene {} has no triangles; allowed in cells: meshes", number);
    if (cell.corners.size() / 3 > most_cell_triangles)
        fail_at(at, "scene {} has {} triangles; allowed in a cell: at most {}", number,
                cell.corners.size() / 3, most_cell_triangles);
    return cell;
}

// What an element's parameters are made of where a scene stands in its cells.
void name_cell(GltfImport& import, const JsonAt& at, json& parameters) {
    const JsonAt cell_at = member(at, "cell");
    refuse(at, {"shape", "radius", "depth", "operation", "spread", "turn", "scale", "bend"},
           "cells that hold a scene");
    if (parameters.contains("placement") && parameters["placement"] != "grid" &&
        parameters["placement"] != "staggered")
        fail_at(member(at, "placement"),
                "cells that hold a scene fill their places; allowed: grid, staggered");
    const uint32_t number = index_value(cell_at, array_size(import.root, "scenes"), "/scenes");
    const double scale =
        at->contains("cell_size") ? number_value(member(at, "cell_size"), 1e-12, max_coordinate) : 1;
    CellDescription cell = read_cell(import, cell_at, number, scale);
    const std::vector<double> pitch = number_array(member(at, "pitch"), 2, 0, max_coordinate);
    for (glm::vec3& p : cell.corners)
        for (int axis = 0; axis < 2; ++axis) {
            const float end = float(0.5 * pitch[axis]);
            if (!(std::abs(p[axis]) <= end * 1.00001f))
                fail_at(
                    cell_at,
                    "scene {} reaches to {} = {:g} m, out of its cell; allowed: -{:g} to {:g}, half a pitch",
                    number, axis ? "y" : "x", p[axis], end, end);
            p[axis] = std::clamp(p[axis], -end, end);
        }
    parameters.erase("cell_size");
    // Cells that are alike are one.
    auto& cells = import.scene.cells;
    const auto known =
        std::ranges::find_if(cells, [&](const CellDescription& c) { return c.corners == cell.corners; });
    parameters["cell"] = size_t(known - cells.begin());
    if (known == cells.end()) cells.push_back(std::move(cell));
    // Nothing reads these.
    parameters["radius"] = 0.5 * std::min(pitch[0], pitch[1]), parameters["depth"] = parameters["radius"];
}

}  // namespace

void name_parts(GltfImport& import, const JsonAt& at, json& parameters) {
    if (const auto placement = find(at, "placement"); placement && (*placement)->is_object()) {
        only_members(*placement, {"file"});
        refuse(at, {"pitch", "density", "spread", "seed"}, "places from a file");
        parameters["placement"] = "file", parameters["file"] = text_value(member(*placement, "file"));
        parameters["pitch"] = *member(at, "size");
    } else if (placement && **placement == "file") {
        fail_at(*placement, "is \"file\"; allowed: {{\"file\": NAME}}");
    }
    if (at->contains("cell"))
        name_cell(import, at, parameters);
    else
        refuse(at, {"cell_size"}, "shapes");
}

void place_microstructure(GltfImport& import, const JsonAt& at) {
    PlacedObject sheet{"microstructure", {"microstructure", json::object(), at.pointer}, import.content_root};
    json& parameters = sheet.object.parameters;
    for (const auto& [key, value] : at->items())
        if (key != "class" && key != "material" && key != "density" && key != "scale" && key != "thickness")
            parameters[key] = value;
    if (const auto density = find(at, "density"); density && (*density)->is_object())
        parameters["density_texture"] = read_texture_info(import, *density);
    else if (density)
        parameters["density"] = **density;
    if (const auto bend = find(at, "bend"))
        fail_at(*bend,
                "is not for a sheet in a box; allowed: in a geometry of a scene that an element holds");
    const double scale = number(at, "scale", 1, 1e-9, 1e9);
    const std::vector<double> size = number_array(member(at, "size"), 2, 0, max_coordinate);
    name_parts(import, at, parameters);
    double low = 0, high = 0;  // of what stands on the plane
    if (parameters.contains("cell")) {
        for (const glm::vec3& p : import.scene.cells[parameters["cell"].get<size_t>()].corners)
            low = std::min(low, double(p.z)), high = std::max(high, double(p.z));
        if (low == high) high = 1e-3 * std::min(size[0], size[1]);
    } else {
        const double depth = scale * number_value(member(at, "depth"), 0, max_coordinate);
        parameters["radius"] = scale * number_value(member(at, "radius"), 0, max_coordinate);
        parameters["depth"] = depth;
        (text(at, "operation", "add") == "remove" ? low : high) = depth;
        low = -low;
    }
    const auto material = index(at, "material", array_size(import.root, "materials"), "/materials");
    sheet.material = material ? *material : default_material(import);
    import.scene.shapes.push_back(sheet);

    const double depth = high - low;
    const double thickness = number(at, "thickness", 1.01 * depth, depth, max_coordinate),
                 beyond = 0.01 * depth;
    const bool is_dent = high == 0;
    bound_by_box(import, at, size, is_dent ? -thickness : low - beyond,
                 is_dent ? beyond : std::max(low + thickness, high));
}

}  // namespace etendue
