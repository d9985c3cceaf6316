// What sheets of microstructure read beside their records: places from files, triangles of cells.
#include <algorithm>
#include <cmath>
#include <optional>

#include "host/error.h"
#include "host/scene/scene_compiler.h"
#include "host/scene/scene_files.h"

namespace etendue {

// Half the width of an element's foot along x, which leaves its tangent plane on a sheet that is bent, m;
// none: it never comes to the sheet. `bend` as the record has it.
static std::optional<double> foot(uint32_t shape, double radius, double depth, double bend, bool adds) {
    const double toward = adds == (bend > 0) ? 0.5 / std::abs(bend) : -0.5 / std::abs(bend);
    if (bend == 0) return radius;
    if (shape == 0 || shape == 4) {
        const double narrows = depth / (radius * radius + depth * depth) - toward;
        if (narrows > 0) return std::max(std::sqrt(depth / narrows), radius);
        return {};
    }
    const double slope = depth / radius, rest = slope * slope - 4 * toward * depth;
    if (rest > 0) return 2 * depth / (slope + std::sqrt(rest));
    return {};
}

// Of elements on a cylinder that are too large for it.
static void check_bend(const std::string& shape, uint32_t number, double radius, double depth, double bend,
                       bool adds, double width, const std::string& place) {
    if (bend == 0) return;
    const double around = 2 * M_PI * std::abs(bend);
    if (width > around * (1 + 1e-6))
        fail_input("{}/size: {:g} m goes more than once around the cylinder; allowed: at most {:g}", place,
                   width, around);
    if (std::max(radius, depth) > 0.25 * std::abs(bend))
        fail_input("{}/bend: {:g} m; allowed: at least four times the radius and depth of elements", place,
                   bend);
    if (!foot(number, radius, depth, bend, adds))
        fail_input(
            "{}/bend: {:g} m: each {} is flatter than the cylinder; allowed: steeper ones, or a larger bend",
            place, bend, shape);
}

// Elements of a microstructure that reach out of their cells would be cut off there.
void check_microstructure(const ClassInfo& info, const ObjectDescription& object, const std::string& place) {
    const auto value = [&](const char* name) {
        const auto parameter = std::ranges::find(info.parameters, std::string(name),
                                                 [](const Parameter& p) { return p.member.name; });
        return object.parameters.value(name, parameter->default_value);
    };
    if (object.parameters.contains("cell")) return;  // the importer has seen to it
    const auto size = value("size").get<std::vector<double>>(),
               pitch = value("pitch").get<std::vector<double>>();
    const std::string shape = value("shape");
    const bool is_ridge = shape == "groove" || shape == "lens", is_round = shape == "dome" || shape == "lens";
    const double radius = value("radius"), depth = value("depth"), turn = value("turn"), bend = value("bend"),
                 least = 1 - 1e-6;
    const auto& names = std::ranges::find(info.parameters, "shape", [](const Parameter& p) {
                            return p.member.name;
                        })->choices;
    const auto number = uint32_t(std::ranges::find(names, shape) - names.begin());
    const bool adds = value("operation") == "add";
    check_bend(shape, number, radius, depth, bend, adds, size[0], place);
    const double widening = *foot(number, radius, depth, bend, adds) / radius;
    const double reach = radius * std::max(widening, 1.0) *
                         (shape == "prism" ? std::abs(std::cos(turn)) + std::abs(std::sin(turn)) : 1.0);
    for (size_t axis = 0; axis < (is_ridge ? 1 : 2); ++axis) {
        if (2 * reach * least > pitch[axis])
            fail_input(
                "{}/radius: elements are {:g} m wide and reach beyond their cells of {:g} m; allowed: at "
                "most {:g}",
                place, 2 * reach, pitch[axis], radius * pitch[axis] / (2 * reach));
        if (pitch[axis] * least > size[axis])
            fail_input("{}/pitch: {:g} m is more than the size of {:g} m", place, pitch[axis], size[axis]);
    }
    if (is_round && depth * least > radius)
        fail_input("{}/depth: {:g} m; allowed for a {}: at most the radius of {:g} m", place, depth, shape,
                   radius);
}

MicroSheet micro_sheet(const ClassInfo& info, const std::vector<std::byte>& record) {
    const auto number = [&](const char* name) { return record_member<float>(info, record, name); };
    const auto shape = record_member<uint32_t>(info, record, "shape");
    MicroSheet sheet{record_member<glm::vec2>(info, record, "size"), number("radius"), number("turn")};
    const bool adds = record_member<uint32_t>(info, record, "operation") == 0;
    sheet.radius =
        std::max(sheet.radius,
                 foot(shape, sheet.radius, number("depth"), number("bend"), adds).value_or(sheet.radius));
    if (shape == 2) sheet.foot = MicroSheet::square;  // as in shaders/lib/micro_shapes.glsl
    if (shape > 2) sheet.foot = MicroSheet::strip;
    return sheet;
}

MicroPlaces SceneCompiler::add_places(const std::filesystem::path& file, const ClassInfo& info,
                                      const std::vector<std::byte>& record) {
    const std::filesystem::path path = named_file(in_, file);
    const MicroSheet sheet = micro_sheet(info, record);
    const std::string key = fmt::format("{} {} {} {} {} {}", path.string(), sheet.size.x, sheet.size.y,
                                        sheet.radius, sheet.turn, int(sheet.foot));
    const auto known = memory_.micro_files.find(key);
    if (known != memory_.micro_files.end()) return known->second;
    memory_.buffers.erase("MicroCells"), memory_.buffers.erase("MicroPlaceRows");
    return memory_.micro_files[key] = read_micro_places(path, sheet, threads_, memory_.micro_tables);
}

CellMesh SceneCompiler::add_cell(uint32_t cell) {
    const auto known = memory_.cells.find(cell);
    if (known != memory_.cells.end()) return known->second;
    memory_.buffers.erase("CellNodes"), memory_.buffers.erase("CellTriangles");
    return memory_.cells[cell] = append_cell_mesh(in_.cells[cell].corners, threads_, memory_.cell_tables);
}

void SceneCompiler::upload_microstructures() {
    if (!memory_.micro_files.empty()) {
        share("MicroCells", memory_.micro_tables.cells);
        share("MicroPlaceRows", memory_.micro_tables.places);
    }
    if (!memory_.cells.empty()) {
        share("CellNodes", memory_.cell_tables.nodes);
        share("CellTriangles", memory_.cell_tables.triangles);
    }
}

}  // namespace etendue
