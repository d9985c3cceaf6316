#include "host/scene/live_places.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <type_traits>

#include "host/error.h"
#include "host/geometry/turn.h"

namespace etendue {
namespace {

using nlohmann::json;

constexpr double farthest = 1e9, largest = 1e9;  // m; times

template <class Matrix>
struct Place {
    const std::string& name;
    Matrix& world_from_local;
    bool is_light;
};

// Of SceneObjects, constant or not.
template <class Objects>
auto place_at(Objects& scene, uint32_t index) {
    using Found = Place<std::remove_reference_t<decltype((scene.instances[0].world_from_local))>>;
    if (index < scene.instances.size())
        return Found{scene.instances[index].name, scene.instances[index].world_from_local, false};
    index -= uint32_t(scene.instances.size());
    const bool is_light = index >= scene.shapes.size();
    auto& object = is_light ? scene.lights.at(index - scene.shapes.size()) : scene.shapes[index];
    return Found{object.name, object.world_from_local, is_light};
}

glm::dvec3 scale_of(const glm::dmat3& m) {
    const double sign = glm::determinant(m) < 0 ? -1 : 1;
    return {sign * glm::length(m[0]), glm::length(m[1]), glm::length(m[2])};
}

// Degrees; turn = about z * about y * about x.
glm::dvec3 angles_of(const glm::dmat3& turn) {
    const double y = std::asin(glm::clamp(-turn[0][2], -1.0, 1.0));
    if (std::abs(turn[0][2]) > 1 - 1e-12)  // x and z turn about the same axis
        return glm::degrees(glm::dvec3(0, y, std::atan2(-turn[1][0], turn[1][1])));
    return glm::degrees(
        glm::dvec3(std::atan2(turn[1][2], turn[2][2]), y, std::atan2(turn[0][1], turn[0][0])));
}

glm::dmat3 turned(const glm::dvec3& degrees) {
    glm::dmat4 m(1.0);
    for (int axis = 2; axis >= 0; --axis) {
        glm::dvec3 about(0);
        about[axis] = 1;
        m = glm::rotate(m, glm::radians(degrees[axis]), about);
    }
    return glm::dmat3(m);
}

json as_json(glm::dvec3 v) {
    for (int i = 0; i < 3; ++i) v[i] = std::abs(v[i]) < 1e-12 ? 0 : v[i];
    return {v.x, v.y, v.z};
}

Parameter place_parameter(const char* name, const char* unit, double most, const char* text) {
    Parameter p;
    p.member.name = name, p.member.type = "vec3";
    p.from_scene = true;
    p.lo = -most, p.hi = most, p.lo_open = p.hi_open = false;
    p.unit = unit, p.text = text;
    return p;
}

glm::dvec3 three_numbers(const std::string& name, const json& value, double most, double none) {
    if (value.is_null()) return glm::dvec3(none);
    glm::dvec3 v(0);
    bool good = value.is_array() && value.size() == 3;
    for (int i = 0; good && i < 3; ++i) {
        good = value[size_t(i)].is_number();
        if (good) v[i] = value[size_t(i)].get<double>();
        good = good && std::abs(v[i]) <= most;
    }
    if (!good)
        fail_input("{} {}: must be three numbers within [-{:g}, {:g}]", name, value.dump(), most, most);
    return v;
}

}  // namespace

size_t place_count(const SceneObjects& scene) {
    return scene.instances.size() + scene.shapes.size() + scene.lights.size();
}

LiveObject described_place(const SceneObjects& scene, uint32_t index) {
    const auto place = place_at(scene, index);
    const glm::dmat3 m(place.world_from_local);
    LiveObject object{LiveObject::Part::place, index, place.name, "", {}};
    object.parameters = {{place_parameter("translation", "m", farthest, "Where it stands."),
                          as_json(glm::dvec3(place.world_from_local[3]))},
                         {place_parameter("rotation", "degrees", 360, "About x, y and z, in this order."),
                          as_json(angles_of(parted(m).turn))}};
    if (!place.is_light)
        object.parameters.push_back(
            {place_parameter("scale", "", largest, "Along its own axes; not 0."), as_json(scale_of(m))});
    return object;
}

void edit_place(SceneObjects& scene, uint32_t index, const std::string& name, const json& value) {
    const auto place = place_at(scene, index);
    glm::dmat4& world = place.world_from_local;
    if (name == "translation") {
        world[3] = glm::dvec4(three_numbers(name, value, farthest, 0), 1);
    } else if (name == "rotation") {
        const glm::dmat3 m = turned(three_numbers(name, value, 360, 0)) * parted(glm::dmat3(world)).rest;
        for (int c = 0; c < 3; ++c) world[c] = glm::dvec4(m[c], 0);
    } else if (name == "scale" && !place.is_light) {
        const glm::dvec3 to = three_numbers(name, value, largest, 1), from = scale_of(glm::dmat3(world));
        if (to.x * to.y * to.z == 0) fail_input("scale {}: must not be 0", value.dump());
        for (int c = 0; c < 3; ++c) world[c] *= to[c] / from[c];
    } else {
        fail_input("there is no {}; allowed: translation, rotation{}", name, place.is_light ? "" : ", scale");
    }
}

}  // namespace etendue
