// How mouse and keys move a camera: pure functions of where it stands. Lengths in metres, angles in radians,
// the scene file's coordinates; +y is up.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

namespace etendue {

struct CameraPose {
    glm::dmat4 placement{1.0};  // world_from_local of the receiver; it looks along -z of it, +y is up
    glm::dvec3 pivot{0};        // what it turns around
};

// How large the view is at the pivot.
struct CameraLens {
    bool parallel = false;  // rays
    double height = 1;  // of the view: tan(yfov / 2) * 2 at distance 1, or in metres where rays are parallel
};

// Where a camera stands to begin with: the pivot lies on its axis, as far away as the scene's centre if that
// is in front of it, else a tenth of the radius.
CameraPose start_pose(const glm::dmat4& placement, const glm::dvec3& scene_center, double scene_radius);

// Turns around the pivot: the scene follows a pointer that moves by those angles. The view never tips over.
CameraPose orbit(const CameraPose& pose, double right, double down);
// Turns around where the camera stands, by those angles. The pivot turns along.
CameraPose look(const CameraPose& pose, double right, double down);
// What is at the depth of the pivot follows a pointer that moves by those fractions of the view's height.
CameraPose pan(const CameraPose& pose, const CameraLens& lens, double right, double down);
// Moves towards the pivot until it is `factor` times as far away (> 0); scales the view where rays are
// parallel.
CameraPose dolly(const CameraPose& pose, const CameraLens& lens, double factor);
// Moves by metres along the camera's own axes; the pivot moves along.
CameraPose fly(const CameraPose& pose, double right, double up, double forward);
// Turns around another point from now on; nothing moves.
CameraPose focus(const CameraPose& pose, const glm::dvec3& point);

// A line between two points, cut where it comes too near to the camera.
struct SeenLine {
    std::array<glm::dvec2, 2> at;     // heights of the view from its top left corner, x to the right, y down
    std::array<glm::dvec3, 2> local;  // the same in the camera's coordinates, which looks along -z
};
// None where all of it lies behind the camera.
std::optional<SeenLine> seen_line(const CameraPose& pose, const CameraLens& lens, double aspect_ratio,
                                  const glm::dvec3& from, const glm::dvec3& to);

double pivot_distance(const CameraPose& pose);  // along the axis; > 0

}  // namespace etendue
