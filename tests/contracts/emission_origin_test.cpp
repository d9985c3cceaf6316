// Where rays leave emissive surfaces: the error that is stated of their origins holds, so that nothing is met
// that they leave.
#include <cmath>

#include "host/lens/surface_shape.h"
#include "tests/contracts/geometry_classes.h"
#include "tests/support/emission_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

// Of one piece.
const GraphOracle bulge{{{0, 0, -0.05, -0.01}, {0, -0.02, 0, 0}, {-0.04, 0, 0, 0}, {0, 0, 0, 0}}, 0.7, 0.5};

// Signed distance from the surface in the shape's own frame, and its gradient there.
double local_distance(const std::string& name, const glm::dvec3& p, double radius, glm::dvec3& gradient) {
    if (name == "sphere") {
        gradient = glm::normalize(p);
        return glm::length(p) - radius;
    }
    if (name == "asphere") {
        const SurfaceShape shape{-1, 0.5, {0, -0.2}};
        gradient = shape.normal({p.x, p.y, shape.sag(p.x, p.y)});
        return (p.z - shape.sag(p.x, p.y)) * gradient.z;
    }
    if (name == "bezier_patch") {
        gradient = bulge.normal(p);
        return bulge.distance(p);
    }
    if (name == "cylinder") {
        gradient = glm::normalize(glm::dvec3(p.x, p.y, 0));
        return std::hypot(p.x, p.y) - radius;
    }
    gradient = {0, 0, 1};
    return p.z;  // disk, rectangle
}

const std::pair<std::string, json> shapes[] = {
    {"sphere", {{"radius", 0.7}}},
    {"disk", {{"radius", 0.7}}},
    {"rectangle", {{"size", {0.9, 0.3}}}},
    {"cylinder", {{"radius", 0.7}, {"height", 0.4}}},
    {"asphere", {{"curvature", -1}, {"conic", 0.5}, {"coefficients", {-0.2}}, {"aperture", 0.7}}},
    {"bezier_patch", {{"control_points", bulge.control_points()}}}};

constexpr uint32_t shape_count = std::size(shapes), light_count = 4 * shape_count;

// Each shape upright and squeezed, 30 m apart.
SceneDescription shapes_scene(double far) {
    SceneDescription scene;
    scene.materials.resize(1);
    scene.materials[0].surface.class_name = "absorber";
    scene.materials[0].emission = EmissionDescription{};
    scene.materials[0].emission->value = {1, 1, 1};
    for (double side : {-1.0, 1.0})  // the device's coordinates are relative to the middle
        for (const auto& [name, parameters] : shapes)
            for (bool squeezed : {false, true}) {
                PlacedObject shape;
                shape.object = {name, parameters, "/shape"};
                if (squeezed)
                    shape.world_from_local = {{0.9, 0.2, 0, 0}, {0, -0.7, 0.3, 0}, {0.1, 0, -1.2, 0}, {}};
                const double along = 30.0 * double(scene.shapes.size() % (light_count / 2));
                shape.world_from_local[3] = {side * far, 0.6 * side * far + along, -0.3 * side * far, 1};
                scene.shapes.push_back(shape);
            }
    return scene;
}

}  // namespace

TEST_CASE("emission: origins lie within their error of the surface, and rays do not meet what they leave") {
    for (double far : {20.0, 5000.0}) {
        EmissionProbe probe(shapes_scene(far));
        REQUIRE(probe.scene().lights == light_count);
        const auto transforms =
            probe.scene().shared_buffers.at("Transforms")->read_array<TransformRecord>(light_count);
        double worst[light_count] = {};
        uint32_t met = 0;
        for (const ProbedRay& r : probe.emit(1 << 18, 4)) {
            uint32_t light = 0;  // the shape that is nearest
            for (uint32_t k = 1; k < light_count; ++k)
                if (glm::distance(transforms[k].world_from_local[3], r.origin) <
                    glm::distance(transforms[light].world_from_local[3], r.origin))
                    light = k;
            glm::dmat4 world(1);
            for (int k = 0; k < 4; ++k)
                world[k] = glm::dvec4(glm::dvec3(transforms[light].world_from_local[k]), k == 3);
            const glm::dmat4 local = glm::inverse(world);
            glm::dvec3 gradient;
            const glm::dvec3 p(local * glm::dvec4(glm::dvec3(r.origin), 1));
            const double d = local_distance(shapes[light / 2 % shape_count].first, p, 0.7f, gradient);
            const double distance = std::abs(d) / glm::length(gradient * glm::dmat3(local));
            const double bound = glm::dot(glm::abs(glm::dvec3(r.normal)), glm::dvec3(r.error));
            worst[light] = std::max(worst[light], bound > 0 ? distance / bound : 2.0);
            met += r.t_hit < 5;
        }
        CHECK(met == 0);
        for (uint32_t light = 0; light < light_count; ++light) {
            INFO(shapes[light / 2 % shape_count].first, ", ", far, " m away",
                 std::string(light % 2 ? ", squeezed" : ""));
            CHECK(worst[light] <= 1);
            // Not wide beyond use, either; upright planes are met exactly.
            if (light % 2) CHECK(worst[light] > 0.01);
        }
    }
}
