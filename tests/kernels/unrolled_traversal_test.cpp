// Straight code for few primitives finds what the hierarchy finds.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"

using namespace etendue;

namespace {

void add_quad(GeometryProbe& probe, const glm::dmat4& m, const glm::dvec3& a, const glm::dvec3& u,
              const glm::dvec3& v) {
    const auto p = [&](double s, double t) { return glm::vec3(m * glm::dvec4(a + s * u + t * v, 1)); };
    probe.add_triangle(p(0, 0), p(1, 0), p(1, 1));
    probe.add_triangle(p(1, 1), p(0, 1), p(0, 0));
}

void add_box(GeometryProbe& probe, const glm::dmat4& m) {  // [0,1]³
    const glm::dvec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) {
        add_quad(probe, m, glm::dvec3(0), axis[(k + 1) % 3], axis[k]);
        add_quad(probe, m, axis[(k + 2) % 3], axis[k], axis[(k + 1) % 3]);
    }
}

glm::dmat4 room(double scale) {
    return glm::translate(glm::scale(glm::dmat4(1), glm::dvec3(scale)), glm::dvec3(-1));
}

// A closed room of 2 m with two turned boxes, a lamp, and things of other kinds.
void add_room(GeometryProbe& probe, double scale) {
    add_box(probe, glm::scale(room(scale), glm::dvec3(2)));
    add_box(probe, glm::scale(glm::rotate(glm::translate(room(scale), glm::dvec3(0.3, 0.01, 0.6)), 0.3,
                                          glm::dvec3(0, 1, 0)),
                              glm::dvec3(0.6, 1.2, 0.6)));
    add_box(probe, glm::scale(glm::rotate(glm::translate(room(scale), glm::dvec3(1.1, 0.01, 1.2)), -0.2,
                                          glm::dvec3(0, 1, 0)),
                              glm::dvec3(0.6)));
    add_quad(probe, room(scale), {0.8, 1.99, 0.8}, {0.4, 0, 0}, {0, 0, 0.4});
}

void add_things(GeometryProbe& probe, double scale) {
    const glm::dmat4 m = room(scale);
    const auto p = [&](double x, double y, double z) { return glm::vec3(m * glm::dvec4(x, y, z, 1)); };
    probe.add_triangle(p(0.2, 1.1, 0.3), p(0.5, 1.7, 0.4), p(0.1, 1.5, 0.9));
    add_quad(probe, m, {1.2, 0.9, 0.3}, {0.3, 0.1, 0.2}, {0.1, 0.4, 0.0});  // not a rectangle
    const Box unit{glm::vec3(-1), glm::vec3(1)}, flat{{-1, -1, 0}, {1, 1, 0}};
    probe.add_shape("sphere", {{"radius", 1}}, unit,
                    glm::scale(glm::translate(m, glm::dvec3(1.5, 1.5, 1.5)), glm::dvec3(0.2)));
    probe.add_shape("sphere", {{"radius", 0.5}}, unit,
                    glm::scale(glm::translate(m, glm::dvec3(0.5, 1.6, 1.5)), glm::dvec3(-0.3)));
    probe.add_shape(
        "disk", {{"radius", 1}}, flat,
        glm::scale(glm::rotate(glm::translate(m, glm::dvec3(1.5, 0.9, 0.5)), 1.0, glm::dvec3(1, 1, 0)),
                   glm::dvec3(0.2)));
    probe.add_shape(
        "rectangle", {{"size", {1, 2}}}, flat,
        glm::scale(glm::rotate(glm::translate(m, glm::dvec3(0.9, 1.2, 0.2)), 2.0, glm::dvec3(0, 1, 1)),
                   glm::dvec3(0.2, 0.1, 0.2)));
}

std::vector<ProbeRay> rays_within(double scale, size_t count) {
    Random random(21);
    std::vector<ProbeRay> rays(count);
    for (size_t i = 0; i < count; i++) {
        ProbeRay& r = rays[i];
        r = {float(scale) * glm::vec3(random(-0.99f, 0.99f), random(-0.99f, 0.99f), random(-0.99f, 0.99f)),
             1e30f, random.direction()};
        if (i % 5 == 1) r.t_max = random(0, 2) * float(scale);
        if (i % 5 == 2) r.direction[int(i % 3)] = 0;
        if (i % 5 == 3) r.direction *= 0.01f;
        if (i % 5 == 4) r.origin *= 4.0f, r.direction = -r.origin + float(scale) * random.direction();
    }
    return rays;
}

}  // namespace

TEST_CASE("straight code finds what the hierarchy finds, edges aside") {
    for (const double scale : {1e-3, 1.0, 1e4}) {
        CAPTURE(scale);
        GeometryProbe probe;
        add_room(probe, scale);
        add_things(probe, scale);
        probe.build();
        const std::vector<ProbeRay> rays = rays_within(scale, 100000);
        const std::vector<ProbeTrace> expected = probe.trace(rays, false);
        const UnrolledTraversal unrolled = probe.unroll();
        REQUIRE(!unrolled.glsl.empty());
        CHECK(unrolled.primitives == 45);
        CHECK(unrolled.tests == 25);
        const std::vector<ProbeTrace> found = probe.trace(rays, false);
        size_t other_hit = 0, other_place = 0, inconsistent = 0;
        for (size_t i = 0; i < rays.size(); i++) {
            const ProbeTrace &a = expected[i], &b = found[i];
            other_hit += a.hit.primitive != b.hit.primitive;
            inconsistent += (b.occluded != 0) != (b.hit.primitive != no_record);
            if (a.hit.primitive != b.hit.primitive || a.hit.primitive == no_record) continue;
            const float tolerance =
                1e-5f * (std::abs(a.hit.t) + float(scale) / glm::length(rays[i].direction));
            // Grazing planes lose digits along the ray, never across the plane.
            const float across = std::abs(glm::dot(a.position - b.position, a.geometric_normal));
            const float cosine = std::abs(glm::dot(glm::normalize(rays[i].direction), a.geometric_normal));
            other_place += !(across < 2e-6f * float(scale)) ||
                           !(std::abs(a.hit.t - b.hit.t) * cosine < tolerance) ||
                           !(glm::length(a.hit.uv - b.hit.uv) * cosine < 1e-4f);
        }
        CHECK(other_hit <= 3);  // of 100,000: through an edge within the margin
        CHECK(other_place == 0);
        CHECK(inconsistent == 0);
    }
}

TEST_CASE("straight code lets no ray out of a closed room, not even through its edges and corners") {
    for (const bool turned : {false, true}) {
        CAPTURE(turned);
        GeometryProbe probe;
        glm::dmat4 m =
            glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(0.3, -0.2, 0.1)), glm::dvec3(2, 1.4, 3));
        if (turned) m = glm::rotate(m, 0.8, glm::normalize(glm::dvec3(1, 2, -1)));
        add_box(probe, glm::translate(m, glm::dvec3(-0.5)));
        probe.build();
        REQUIRE(!probe.unroll().glsl.empty());
        Random random(5);
        std::vector<ProbeRay> rays(500000);
        for (size_t i = 0; i < rays.size(); i++) {
            const auto inside = [&](glm::dvec3 p) { return glm::vec3(m * glm::dvec4(p, 1)); };
            const glm::vec3 origin = inside({random(-0.4f, 0.4f), random(-0.4f, 0.4f), random(-0.4f, 0.4f)});
            glm::dvec3 target(random(-0.5f, 0.5f), random(-0.5f, 0.5f), random(-0.5f, 0.5f));
            for (size_t axis = 0; axis < 3; axis++)
                if (i % 4 > axis)
                    target[int(axis)] = random.engine() % 2 ? 0.5 : -0.5;  // faces, edges, corners
            rays[i] = {origin, 1e30f, inside(target) - origin};
        }
        size_t leaks = 0;
        for (const ProbeTrace& t : probe.trace(rays, false))
            leaks += t.hit.primitive == no_record || !t.occluded;
        CHECK(leaks == 0);
    }
}

TEST_CASE("with straight code a ray that leaves a surface does not hit it again") {
    GeometryProbe probe;
    add_room(probe, 1);
    add_things(probe, 1);
    probe.build();
    REQUIRE(!probe.unroll().glsl.empty());
    Random random(17);
    std::vector<ProbeRay> away;
    for (const ProbeTrace& t : probe.trace(rays_within(1, 100000), false)) {
        if (t.hit.primitive == no_record) continue;
        glm::vec3 n = t.geometric_normal;
        const bool may_be_round = primitive_kind(probe.primitives()[t.hit.primitive]) == PrimitiveKind::shape;
        if (!may_be_round && random.engine() % 2) n = -n;
        const glm::vec3 direction = random.direction(),
                        along = glm::normalize(direction - n * glm::dot(direction, n));
        ProbeRay r{{}, 1e-3f, glm::normalize(along + std::pow(10.0f, random(-6, 0)) * n)};
        const glm::vec3 offset = glm::dot(glm::abs(n), t.error) * n;
        for (int axis = 0; axis < 3; axis++) {
            const float moved = t.position[axis] + offset[axis];
            r.origin[axis] =
                offset[axis] == 0 ? moved : std::nextafter(moved, offset[axis] > 0 ? 1e30f : -1e30f);
        }
        // Other surfaces within a millimetre are met rightly.
        away.push_back(r);
        away.back().unused = std::bit_cast<float>(t.hit.primitive);
    }
    size_t again = 0;
    for (size_t i = 0; const ProbeTrace& t : probe.trace(away, false)) {
        again += t.hit.primitive == std::bit_cast<uint32_t>(away[i].unused);
        i++;
    }
    CHECK(away.size() > 50000);
    CHECK(again == 0);
}

TEST_CASE("worlds that straight code does not suit keep their hierarchy") {
    GeometryProbe cylinder;
    cylinder.add_shape("cylinder", {{"radius", 1}, {"height", 1}}, {glm::vec3(-1), glm::vec3(1)},
                       glm::dmat4(1));
    cylinder.build();
    CHECK(cylinder.unroll().glsl.empty());

    GeometryProbe ellipsoid;
    ellipsoid.add_shape("sphere", {{"radius", 1}}, {glm::vec3(-1), glm::vec3(1)},
                        glm::scale(glm::dmat4(1), glm::dvec3(1, 2, 1)));
    ellipsoid.build();
    CHECK(ellipsoid.unroll().glsl.empty());

    GeometryProbe many;
    for (int i = 0; i < 70; i++)
        many.add_triangle(glm::vec3(i, 0, 0), glm::vec3(i + 1, 0, 0), glm::vec3(i, 1, 0.1f * float(i)));
    many.build();
    CHECK(many.unroll().glsl.empty());

    GeometryProbe instance;
    instance.add_instance(instance.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), glm::dmat4(1));
    instance.build();
    CHECK(instance.unroll().glsl.empty());
}
