// How mouse and keys move a camera, without a window.
#include "host/preview/camera_control.h"

#include <doctest/doctest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>

using namespace etendue;

namespace {

glm::dvec3 eye(const CameraPose& p) { return glm::dvec3(p.placement[3]); }
glm::dvec3 forward(const CameraPose& p) { return -glm::normalize(glm::dvec3(p.placement[2])); }

// Where a point stands in the picture: right and up, in heights of the view.
glm::dvec2 seen_at(const CameraPose& p, const CameraLens& lens, const glm::dvec3& point) {
    const glm::dvec3 local = glm::dvec3(glm::inverse(p.placement) * glm::dvec4(point, 1));
    return glm::dvec2(local) / (lens.parallel ? lens.height : lens.height * -local.z);
}

bool near(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }
bool near(const glm::dvec2& a, const glm::dvec2& b) { return glm::length(a - b) < 1e-9; }

const CameraLens lens{false, 0.7}, parallel{true, 3.0};

CameraPose some_pose() {
    const glm::dmat4 placement =
        glm::inverse(glm::lookAt(glm::dvec3(1, 2, 6), glm::dvec3(0.2, 0.5, -1), glm::dvec3(0, 1, 0)));
    return start_pose(placement, glm::dvec3(0), 4);
}

}  // namespace

TEST_CASE("a camera turns around what it sees at the depth of the scene's centre") {
    const CameraPose pose = some_pose();
    CHECK(near(glm::normalize(pose.pivot - eye(pose)), forward(pose)));
    CHECK(std::abs(glm::dot(pose.pivot - glm::dvec3(0), forward(pose))) < 1e-9);
    const CameraPose away =
        start_pose(glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -5)), glm::dvec3(0), 4);
    CHECK(near(away.pivot, glm::dvec3(0, 0, -5.4)));
}

TEST_CASE(
    "orbits keep the pivot in its place, the distance and the horizon, and are undone by their opposite") {
    const CameraPose pose = some_pose();
    const double distance = glm::length(pose.pivot - eye(pose));
    const CameraPose turned = orbit(pose, 0.7, 0.2);
    CHECK(near(turned.pivot, pose.pivot));
    CHECK(near(seen_at(turned, lens, pose.pivot), seen_at(pose, lens, pose.pivot)));
    CHECK(glm::length(turned.pivot - eye(turned)) == doctest::Approx(distance));
    CHECK(std::abs(turned.placement[0].y) < 1e-12);  // the camera's x axis stays level
    CHECK(near(eye(orbit(orbit(pose, 0.7, 0), -0.7, 0)), eye(pose)));
    // The scene follows the pointer: what is before the pivot moves to the right with it, and down.
    const glm::dvec3 before = pose.pivot - 0.5 * forward(pose);
    CHECK(seen_at(orbit(pose, 0.1, 0), lens, before).x > 0.01);
    CHECK(seen_at(orbit(pose, 0, 0.1), lens, before).y < -0.01);
}

TEST_CASE("an orbit never tips over") {
    CameraPose pose = some_pose();
    for (int i = 0; i < 100; ++i) pose = orbit(pose, 0, 0.2);
    CHECK(forward(pose).y > -1);
    CHECK(forward(pose).y < -0.99);
    CHECK(pose.placement[1].y > 0);
    for (int i = 0; i < 100; ++i) pose = orbit(pose, 0, -0.2);
    CHECK(forward(pose).y > 0.99);
    CHECK(pose.placement[1].y > 0);
}

TEST_CASE("looking around leaves the camera where it is") {
    const CameraPose pose = some_pose(), turned = look(pose, -0.3, 0.1);
    CHECK(near(eye(turned), eye(pose)));
    CHECK(glm::dot(forward(turned), forward(pose)) < 0.99);
    CHECK(near(glm::normalize(turned.pivot - eye(turned)), forward(turned)));
}

TEST_CASE("what lies at the depth of the pivot follows a pan") {
    for (const CameraLens& l : {lens, parallel}) {
        const CameraPose pose = some_pose(), panned = pan(pose, l, 0.25, 0.1);
        CHECK(near(seen_at(panned, l, pose.pivot) - seen_at(pose, l, pose.pivot), glm::dvec2(0.25, -0.1)));
        CHECK(near(forward(panned), forward(pose)));
    }
}

TEST_CASE("a dolly changes the distance, or the scale of parallel rays, and keeps the pivot in its place") {
    CameraPose pose = focus(some_pose(), glm::dvec3(0.3, -0.2, 0.4));
    const CameraPose nearer = dolly(pose, lens, 0.5);
    CHECK(glm::length(nearer.pivot - eye(nearer)) ==
          doctest::Approx(0.5 * glm::length(pose.pivot - eye(pose))));
    CHECK(near(seen_at(nearer, lens, pose.pivot), seen_at(pose, lens, pose.pivot)));
    const CameraPose larger = dolly(pose, parallel, 0.5);
    CHECK(near(seen_at(larger, parallel, pose.pivot), seen_at(pose, parallel, pose.pivot)));
    const glm::dvec3 beside = pose.pivot + glm::dvec3(glm::normalize(pose.placement[0]));
    CHECK(seen_at(larger, parallel, beside).x - seen_at(larger, parallel, pose.pivot).x ==
          doctest::Approx(2 * (seen_at(pose, parallel, beside).x - seen_at(pose, parallel, pose.pivot).x)));
}

TEST_CASE("a line is seen where its ends are, and cut where it passes the camera") {
    const CameraPose pose = some_pose();
    const double aspect = 1.5;
    const glm::dvec3 a = pose.pivot + glm::dvec3(0.3, 0.1, -0.2), b = pose.pivot - glm::dvec3(0.1, 0.4, 0.3);
    for (const CameraLens& l : {lens, parallel}) {
        const auto line = seen_line(pose, l, aspect, a, b);
        REQUIRE(line);
        const auto corner = [&](const glm::dvec2& p) { return glm::dvec2(0.5 * aspect + p.x, 0.5 - p.y); };
        CHECK(near(line->at[0], corner(seen_at(pose, l, a))));
        CHECK(near(line->at[1], corner(seen_at(pose, l, b))));
        CHECK(!seen_line(pose, l, aspect, eye(pose) - forward(pose), eye(pose) - 2.0 * forward(pose)));
    }
    // From behind the camera, above it, to the pivot: what is seen of it comes in from above.
    const auto cut =
        seen_line(pose, lens, aspect, eye(pose) - forward(pose) + glm::dvec3(0, 1, 0), pose.pivot);
    REQUIRE(cut);
    CHECK(cut->at[0].y < -10);
    CHECK(near(cut->at[1], glm::dvec2(0.5 * aspect, 0.5)));
}

TEST_CASE("flying goes by metres along the camera's axes") {
    const CameraPose pose = some_pose(), flown = fly(pose, 1, 2, 3);
    const glm::dvec3 local = glm::dvec3(glm::inverse(pose.placement) * glm::dvec4(eye(flown), 1));
    CHECK(near(local, glm::dvec3(1, 2, -3)));
    CHECK(near(flown.pivot - pose.pivot, eye(flown) - eye(pose)));
}
