#include "host/preview/camera_control.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace etendue {
namespace {

constexpr double steepest = 1.55;  // of the axis against the horizontal, rad; a little less than upright

glm::dvec3 eye(const CameraPose& pose) { return glm::dvec3(pose.placement[3]); }
glm::dvec3 axis(const CameraPose& pose) { return -glm::normalize(glm::dvec3(pose.placement[2])); }

// Moves and turns both by a world transform.
CameraPose moved(const CameraPose& pose, const glm::dmat4& by) {
    return {by * pose.placement, glm::dvec3(by * glm::dvec4(pose.pivot, 1))};
}

glm::dmat4 turn_around(const glm::dvec3& point, const glm::dmat4& turn) {
    return glm::translate(glm::dmat4(1.0), point) * turn * glm::translate(glm::dmat4(1.0), -point);
}

// By `azimuth` around the vertical and `elevation` (upwards) as far as the axis may rise or fall.
glm::dmat4 turn(const CameraPose& pose, double azimuth, double elevation) {
    const glm::dvec3 forward = axis(pose);
    const double now = std::asin(std::clamp(forward.y, -1.0, 1.0));
    // A camera that stands steeper to begin with may stay so.
    const double limit = std::max(steepest, std::abs(now));
    const double rise = std::clamp(now + elevation, -limit, limit) - now;
    glm::dvec3 right = glm::cross(forward, glm::dvec3(0, 1, 0));
    if (glm::length(right) < 1e-6) right = glm::dvec3(pose.placement[0]);
    const glm::dmat4 one(1.0);
    return glm::rotate(one, azimuth, glm::dvec3(0, 1, 0)) * glm::rotate(one, rise, glm::normalize(right));
}

}  // namespace

double pivot_distance(const CameraPose& pose) {
    return std::max(glm::dot(pose.pivot - eye(pose), axis(pose)), 1e-9);
}

CameraPose start_pose(const glm::dmat4& placement, const glm::dvec3& scene_center, double scene_radius) {
    CameraPose pose{placement, {}};
    const double depth = glm::dot(scene_center - eye(pose), axis(pose));
    pose.pivot = eye(pose) + axis(pose) * (depth > 0 ? depth : 0.1 * scene_radius);
    return pose;
}

CameraPose orbit(const CameraPose& pose, double right, double down) {
    CameraPose result = moved(pose, turn_around(pose.pivot, turn(pose, -right, -down)));
    result.pivot = pose.pivot;
    return result;
}

CameraPose look(const CameraPose& pose, double right, double down) {
    return moved(pose, turn_around(eye(pose), turn(pose, -right, -down)));
}

CameraPose pan(const CameraPose& pose, const CameraLens& lens, double right, double down) {
    const double height = lens.parallel ? lens.height : lens.height * pivot_distance(pose);
    return fly(pose, -right * height, down * height, 0);
}

CameraPose dolly(const CameraPose& pose, const CameraLens& lens, double factor) {
    CameraPose result = pose;
    if (lens.parallel) {
        result.placement[0] *= factor;
        result.placement[1] *= factor;
        // What stands at the pivot stays where it is in the picture.
        const glm::dvec3 across = pose.pivot - eye(pose) - axis(pose) * pivot_distance(pose);
        result.placement[3] += glm::dvec4(across * (1 - factor), 0);
    } else {
        result.placement[3] = glm::dvec4(pose.pivot + (eye(pose) - pose.pivot) * factor, 1);
    }
    return result;
}

CameraPose fly(const CameraPose& pose, double right, double up, double forward) {
    const glm::dvec3 x = glm::normalize(glm::dvec3(pose.placement[0])),
                     y = glm::normalize(glm::dvec3(pose.placement[1]));
    return moved(pose, glm::translate(glm::dmat4(1.0), x * right + y * up + axis(pose) * forward));
}

CameraPose focus(const CameraPose& pose, const glm::dvec3& point) { return {pose.placement, point}; }

std::optional<SeenLine> seen_line(const CameraPose& pose, const CameraLens& lens, double aspect_ratio,
                                  const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dmat4 local_from_world = glm::inverse(pose.placement);
    std::array<glm::dvec3, 2> ends = {glm::dvec3(local_from_world * glm::dvec4(from, 1)),
                                      glm::dvec3(local_from_world * glm::dvec4(to, 1))};
    // Cut where it comes near to the camera, which looks along -z.
    const double nearest = lens.parallel ? 0 : 1e-3 * std::max(-ends[0].z, -ends[1].z);
    if (!(std::max(-ends[0].z, -ends[1].z) > 0)) return {};
    for (int i = 0; i < 2; ++i)
        if (-ends[i].z < nearest) {
            const glm::dvec3& other = ends[1 - i];
            const double t = (nearest + ends[i].z) / (ends[i].z - other.z);
            ends[i] += t * (other - ends[i]);
        }
    SeenLine seen;
    seen.local = ends;
    for (int i = 0; i < 2; ++i) {
        const glm::dvec2 at = glm::dvec2(ends[i]) / (lens.parallel ? lens.height : lens.height * -ends[i].z);
        seen.at[i] = {0.5 * aspect_ratio + at.x, 0.5 - at.y};
    }
    return seen;
}

}  // namespace etendue
