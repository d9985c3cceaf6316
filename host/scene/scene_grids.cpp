// Files that light comes from and that media of the class grid have their densities from.
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "host/error.h"
#include "host/scene/image_file.h"
#include "host/scene/scene_compiler.h"
#include "host/scene/scene_files.h"

namespace etendue {
namespace {

using nlohmann::json;

std::vector<double> numbers(const json& object, const char* key, std::vector<double> otherwise,
                            const std::string& place) {
    if (!object.contains(key)) return otherwise;
    const json& value = object[key];
    std::vector<double> result;
    for (size_t i = 0; value.is_array() && i < value.size(); ++i)
        if (value[i].is_number() && std::isfinite(value[i].get<double>()) &&
            std::abs(value[i].get<double>()) < 1e15)
            result.push_back(value[i]);
    if (!value.is_array() || result.size() != value.size() || result.size() != otherwise.size())
        fail_input("{}/{}: allowed: an array of {} numbers", place, key, otherwise.size());
    return result;
}

// {"name", "grid"} and, as for a node of glTF, "translation", "rotation", "scale".
glm::dmat4 placement(const json& object, const std::string& place) {
    const auto t = numbers(object, "translation", {0, 0, 0}, place),
               s = numbers(object, "scale", {1, 1, 1}, place),
               r = numbers(object, "rotation", {0, 0, 0, 1}, place);
    const glm::dquat q(r[3], r[0], r[1], r[2]);
    if (!(glm::length(q) > 1e-6))
        fail_input("{}/rotation: a quaternion of zero length; allowed: length 1", place);
    glm::dmat4 m = glm::mat4_cast(glm::normalize(q));
    for (int c = 0; c < 3; ++c) m[c] *= s[c];
    m[3] = glm::dvec4(t[0], t[1], t[2], 1);
    return m;
}

// What a transform into the lattice can be made of, in 32-bit floats.
void check_placement(const glm::dmat4& world_from_lattice, const std::string& place) {
    double volume = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double spacing = glm::length(glm::dvec3(world_from_lattice[axis]));
        if (!(spacing >= 1e-12 && spacing <= 1e12))
            fail_input("{}: the points of the density are {:.3g} m apart; allowed: 1e-12 to 1e12 m", place,
                       spacing);
        volume *= spacing;
    }
    if (!(glm::length(glm::dvec3(world_from_lattice[3])) <= 1e15))
        fail_input("{}: the density lies more than 1e15 m away", place);
    if (!(std::abs(glm::determinant(glm::dmat3(world_from_lattice))) > 1e-6 * volume))
        fail_input("{}: the transform of the density squashes space flat", place);
}

}  // namespace

EnvironmentMapRef SceneCompiler::add_environment_map(const std::filesystem::path& file) {
    const auto known = memory_.environment_maps.find(file);
    if (known != memory_.environment_maps.end()) return known->second;
    EnvironmentMap map = build_environment_map(read_image_file(file));
    std::vector<glm::uvec4>& all = memory_.environment_texels;
    map.ref.first = uint32_t(all.size());
    memory_.buffers.erase("EnvironmentTexels");
    all.insert(all.end(), map.texels.begin(), map.texels.end());
    return memory_.environment_maps[file] = map.ref;
}

uint32_t SceneCompiler::add_grid(const json& value, const std::string& where) {
    const std::string place = message_place(in_, where);
    const json object = value.is_string() ? json{{"name", value}} : value;
    if (!object.is_object() || !object.contains("name") || !object["name"].is_string())
        fail_input(
            "{}: allowed: the name of a file, or {{\"name\", \"grid\", \"translation\", \"rotation\", "
            "\"scale\"}}",
            place);
    for (const auto& [key, unused] : object.items())
        if (key != "name" && key != "grid" && key != "translation" && key != "rotation" && key != "scale")
            fail_input("{}/{}: unknown; allowed: name, grid, translation, rotation, scale", place, key);
    if (object.contains("grid") && !object["grid"].is_string()) fail_input("{}/grid: allowed: a name", place);
    const std::filesystem::path file = named_file(in_, object["name"].get<std::string>());
    const auto key = std::pair(file, object.value("grid", ""));
    auto known = memory_.density_files.find(key);
    if (known == memory_.density_files.end()) {
        const DensityLattice lattice = read_density_file(key.first, key.second);
        memory_.buffers.erase("DensityBricks"), memory_.buffers.erase("DensityValues");
        const DensityGridRecord record = add_bricks(memory_.density_bricks, lattice, file.string());
        known =
            memory_.density_files.emplace(key, SceneMemory::DensityFile{record, lattice.world_from_lattice})
                .first;
    }
    const glm::dmat4 world_from_lattice = placement(object, place) * known->second.world_from_lattice;
    check_placement(world_from_lattice, place);
    grids_.push_back(known->second.record);
    grid_placements_.push_back(recentred(world_from_lattice, is_within_element_ ? 1 : 0));
    return uint32_t(grids_.size() - 1);
}

void SceneCompiler::upload_grids() {
    if (grids_.empty()) return;
    for (size_t i = 0; i < grids_.size(); ++i) {
        const glm::dmat4 m = glm::inverse(grid_placements_[i]);
        for (int c = 0; c < 4; ++c) grids_[i].lattice_from_world[c] = glm::vec3(m[c]);
    }
    upload("DensityGrids", grids_);
    share("DensityBricks", memory_.density_bricks.bricks);
    share("DensityValues", memory_.density_bricks.values);
}

}  // namespace etendue
