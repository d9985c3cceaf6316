// glTF's own cameras and lights (KHR_lights_punctual, EXT_lights_ies) as receivers and lights.
#include <cmath>
#include <glm/geometric.hpp>

#include "host/gltf/import.h"

namespace etendue {
namespace {

const double pi = 3.14159265358979323846;

// Cameras and lights take position and rotation of their node, not its scale. A mirrored frame stays
// mirrored.
glm::dmat4 without_scale(const glm::dmat4& m) {
    glm::dvec3 z = glm::normalize(glm::dvec3(m[2])), y = glm::dvec3(m[1]);
    y = glm::normalize(y - z * glm::dot(y, z));
    glm::dvec3 x = glm::cross(y, z);
    if (glm::dot(x, glm::dvec3(m[0])) < 0) x = -x;
    return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), m[3]);
}

double positive(const JsonAt& at) {
    double value = number_value(at, -max_coordinate, max_coordinate);
    if (!(value > 0)) fail_at(at, "is {}; must be more than 0", value);
    return value;
}

ObjectDescription camera_description(const JsonAt& camera) {
    JsonAt type = member(camera, "type");
    const std::string& name = text_value(type);
    if (name != "perspective" && name != "orthographic")
        fail_at(type, "is '{}'; must be perspective or orthographic", name);
    JsonAt shape = member(camera, name);
    require_object(shape);
    ObjectDescription result{name, nlohmann::json::object(), camera.pointer};
    if (name == "orthographic") {
        result.parameters["ymag"] = positive(member(shape, "ymag"));
        return result;
    }
    double yfov = positive(member(shape, "yfov"));
    if (yfov >= pi)
        fail_at(member(shape, "yfov"), "is {}; must be more than 0 and less than pi (radians)", yfov);
    result.parameters["yfov"] = yfov;
    if (std::optional<JsonAt> aspect = find(shape, "aspectRatio"))
        result.parameters["aspect_ratio"] = positive(*aspect);
    return result;
}

ObjectDescription light_description(const JsonAt& light) {
    JsonAt type = member(light, "type");
    const std::string& name = text_value(type);
    if (name != "point" && name != "spot" && name != "directional")
        fail_at(type, "is '{}'; must be point, spot or directional", name);
    ObjectDescription result{name, nlohmann::json::object(), light.pointer};
    result.parameters["color"] = numbers(light, "color", {1, 1, 1}, 0, max_coordinate);
    result.parameters["intensity"] = number(light, "intensity", 1, 0, 1e30);
    if (std::optional<JsonAt> range = find(light, "range"))
        if (name != "directional") result.parameters["range"] = positive(*range);
    if (name == "spot") {
        JsonAt spot = member(light, "spot");
        double inner = number(spot, "innerConeAngle", 0, 0, pi / 2);
        double outer =
            number(spot, "outerConeAngle", pi / 4, 0, pi / 2 * (1 + 1e-6));  // pi/2 as a float may be more
        if (!(inner < outer))
            fail_at(spot, "innerConeAngle is {}, outerConeAngle {}; the inner must be the smaller one", inner,
                    outer);
        result.parameters["inner_cone_angle"] = inner;
        result.parameters["outer_cone_angle"] = std::fmin(outer, pi / 2);
    }
    return result;
}

// The name by which the class `ies` finds a light profile: that of a file, or the place where its text stands
// in the scene.
std::string profile_file(GltfImport& import, const JsonAt& profile) {
    const std::optional<JsonAt> uri = find(profile, "uri");
    const std::optional<uint32_t> view =
        index(profile, "bufferView", array_size(import.root, "bufferViews"), "/bufferViews");
    if (uri.has_value() == view.has_value())
        fail_at(profile, "has {} uri {} bufferView; must have one of them", uri ? "both" : "neither",
                uri ? "and" : "nor");
    if (uri && !is_data_uri(text_value(*uri)))
        return std::filesystem::absolute(resolve_uri(import, *uri)).string();
    const Bytes decoded = uri ? decode_data_uri(*uri) : Bytes();
    const std::span<const uint8_t> bytes = uri ? std::span(decoded) : import.views[*view].bytes;
    import.scene.embedded_files[profile.pointer] = std::string(bytes.begin(), bytes.end());
    return profile.pointer;
}

void require_directions(const JsonAt& node, const glm::dmat4& world_from_local, const char* what) {
    if (!is_invertible(world_from_local))
        fail_at(node, "has a {}, and a transform that squashes space flat", what);
}

}  // namespace

void read_node_camera(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local) {
    std::optional<uint32_t> i = index(node, "camera", array_size(import.root, "cameras"), "/cameras");
    if (!i) return;
    JsonAt camera = document_element(import, "cameras", *i);
    require_directions(node, world_from_local, "camera");
    std::string name = text(node, "name", text(camera, "name", fmt::format("camera {}", *i)));
    import.scene.receivers.push_back({name, camera_description(camera), without_scale(world_from_local)});
}

void read_node_light(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local) {
    std::optional<JsonAt> extension = find_extension(node, "KHR_lights_punctual");
    if (!extension) return;
    std::optional<JsonAt> root = find_extension(import.root, "KHR_lights_punctual");
    const char* array = "/extensions/KHR_lights_punctual/lights";
    uint32_t i = index_value(member(*extension, "light"), root ? array_size(*root, "lights") : 0, array);
    JsonAt light = element(member(*root, "lights"), i);
    require_directions(node, world_from_local, "light");
    std::string name = text(node, "name", text(light, "name", fmt::format("light {}", i)));
    import.scene.lights.push_back({name, light_description(light), without_scale(world_from_local)});
}

void read_node_profile(GltfImport& import, const JsonAt& node, const glm::dmat4& world_from_local) {
    std::optional<JsonAt> extension = find_extension(node, "EXT_lights_ies");
    if (!extension) return;
    std::optional<JsonAt> root = find_extension(import.root, "EXT_lights_ies");
    const char* array = "/extensions/EXT_lights_ies/lights";
    const uint32_t i =
        index_value(member(*extension, "light"), root ? array_size(*root, "lights") : 0, array);
    const JsonAt profile = element(member(*root, "lights"), i);
    require_directions(node, world_from_local, "light");
    ObjectDescription light{"ies", nlohmann::json::object(), extension->pointer};
    light.parameters["file"] = profile_file(import, profile);
    light.parameters["scale"] = number(*extension, "multiplier", 1, 0, 1e30);
    light.parameters["color"] = numbers(*extension, "color", {1, 1, 1}, 0, max_coordinate);
    std::string name = text(node, "name", text(profile, "name", fmt::format("light profile {}", i)));
    import.scene.lights.push_back({name, light, without_scale(world_from_local)});
}

}  // namespace etendue
