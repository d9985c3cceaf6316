// The hierarchy against brute force, and what watertightness and error bounds promise.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"

using namespace etendue;

namespace {

// Rays of all kinds around a scene of the given size: anywhere, along axes and planes, of any length,
// starting on vertices, from far away.
std::vector<ProbeRay> many_rays(size_t count, float size, const std::vector<glm::vec3>& vertices = {}) {
    Random random(11);
    std::vector<ProbeRay> rays;
    for (size_t i = 0; i < count; i++) {
        ProbeRay r{random.point(1.5f * size), 1e30f, random.direction()};
        if (i % 7 == 1) r.direction[int(i / 7 % 3)] = 0;
        if (i % 7 == 2) r.direction = glm::vec3(0), r.direction[int(i / 7 % 3)] = i % 2 ? 1.0f : -1.0f;
        if (i % 7 == 3) r.direction *= std::pow(10.0f, random(-3, 3));
        if (i % 7 == 4 && !vertices.empty()) r.origin = vertices[random.engine() % vertices.size()];
        if (i % 7 == 5) r.t_max = random(0, 2) * size;
        if (i % 7 == 6) {
            const glm::vec3 target = random.point(size);
            r.origin *= 100.0f;
            r.direction = target - r.origin;
        }
        rays.push_back(r);
    }
    return rays;
}

// Rays that hit something else than brute force says, ties in distance aside.
size_t disagreements(const std::vector<ProbeTrace>& traces, const std::vector<ProbeRay>& rays) {
    size_t wrong = 0, hits = 0;
    for (size_t i = 0; i < traces.size(); i++) {
        const ProbeTrace& t = traces[i];
        const bool same = t.hit.primitive == t.expected.primitive && t.hit.instance == t.expected.instance;
        bool agree = t.hit.t == t.expected.t && (same || t.hit.primitive != no_record);
        agree = agree && (t.occluded != 0) == (t.expected.primitive != no_record);
        hits += t.expected.primitive != no_record;
        if (!agree && wrong++ < 3)
            MESSAGE("ray ", i, ": t ", t.hit.t, " of ", t.hit.primitive, ", brute force ", t.expected.t,
                    " of ", t.expected.primitive, ", occluded ", t.occluded, ", t_max ", rays[i].t_max);
    }
    CHECK(hits > traces.size() / 50);
    return wrong;
}

std::vector<glm::vec3> random_triangles(size_t count, float size, float triangle_size) {
    Random random(5);
    std::vector<glm::vec3> vertices;
    for (size_t i = 0; i < count; i++) {
        const glm::vec3 center = random.point(size);
        for (int k = 0; k < 3; k++) vertices.push_back(center + random.point(triangle_size));
    }
    return vertices;
}

void add_triangles(GeometryProbe& probe, const std::vector<glm::vec3>& vertices) {
    for (size_t i = 0; i < vertices.size(); i += 3)
        probe.add_triangle(vertices[i], vertices[i + 1], vertices[i + 2]);
}

}  // namespace

TEST_CASE("the hierarchy finds the triangle that brute force finds, at any scale and from any side") {
    for (const float scale : {1e-3f, 1.0f, 1e4f}) {
        CAPTURE(scale);
        const std::vector<glm::vec3> vertices = random_triangles(1500, scale, 0.1f * scale);
        GeometryProbe probe;
        add_triangles(probe, vertices);
        probe.build();
        const std::vector<ProbeRay> rays = many_rays(7000, scale, vertices);
        CHECK(disagreements(probe.trace(rays), rays) == 0);
    }
}

TEST_CASE("triangles in few planes, with shared edges along the axes, are found as by brute force") {
    GeometryProbe probe;
    std::vector<glm::vec3> vertices;
    for (int plane = 0; plane < 4; plane++)
        for (int i = 0; i < 12; i++)
            for (int j = 0; j < 12; j++) {
                const auto p = [&](int u, int v) {
                    return glm::vec3(u / 6.0f - 1, plane / 2.0f - 0.75f, v / 6.0f - 1);
                };
                for (const glm::vec3& v :
                     {p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j), p(i + 1, j + 1), p(i, j + 1)})
                    vertices.push_back(v);
            }
    add_triangles(probe, vertices);
    probe.build();
    std::vector<ProbeRay> rays = many_rays(7000, 1, vertices);
    Random random(2);
    for (int i = 0; i < 2000; i++) {  // straight at vertices and edges
        const glm::vec3 a = vertices[random.engine() % vertices.size()];
        rays.push_back({a + glm::vec3(0, 1.1f, 0), 1e30f, {0, -1, 0}});
        const glm::vec3 origin = random.point(2);
        rays.push_back({origin, 1e30f, a - origin});
    }
    CHECK(disagreements(probe.trace(rays), rays) == 0);
}

TEST_CASE("shapes, triangles and instances in one hierarchy are found as by brute force") {
    Random random(3);
    GeometryProbe probe;
    const std::vector<glm::vec3> vertices = random_triangles(200, 1, 0.2f);
    add_triangles(probe, vertices);
    const Box unit{glm::vec3(-1), glm::vec3(1)}, flat{{-1, -1, 0}, {1, 1, 0}};
    for (int i = 0; i < 8; i++) {
        const glm::dmat4 scale = glm::scale(glm::dmat4(1), glm::dvec3(0.15));
        probe.add_shape("sphere", {{"radius", 1}}, unit, random.placement(1) * scale);
        probe.add_shape("disk", {{"radius", 1}}, flat, random.placement(1) * scale);
        probe.add_shape("rectangle", {{"size", {2, 2}}}, flat, random.placement(1) * scale);
        probe.add_shape("cylinder", {{"radius", 1}, {"height", 2}}, unit, random.placement(1) * scale);
    }
    const uint32_t mesh = probe.add_mesh(icosphere(2, 0.2f));
    const uint32_t single = probe.add_mesh({{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0}});
    for (int i = 0; i < 12; i++) probe.add_instance(i % 4 ? mesh : single, random.placement(1));
    probe.build();
    const std::vector<ProbeRay> rays = many_rays(7000, 1, vertices);
    CHECK(disagreements(probe.trace(rays), rays) == 0);

    const std::vector<ProbeTrace> traces = probe.trace(rays, false);
    const std::vector<ProbeHit> hits = probe.find_hits(rays);
    size_t different = 0;
    for (size_t i = 0; i < rays.size(); i++)
        different += hits[i].t != traces[i].hit.t || hits[i].primitive != traces[i].hit.primitive ||
                     hits[i].instance != traces[i].hit.instance;
    CHECK(different == 0);
}

TEST_CASE("an empty world is missed by every ray") {
    GeometryProbe probe;
    probe.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});  // never placed
    probe.build();
    for (const ProbeTrace& t : probe.trace(many_rays(100, 1))) CHECK(t.hit.primitive == no_record);
}

TEST_CASE("rays that are not numbers end without a hit") {
    GeometryProbe probe;
    add_triangles(probe, icosphere(2, 1));
    probe.build();
    const float nan = std::nanf("");
    for (const ProbeTrace& t : probe.trace({{{nan, 0, 0}, 1e30f, {0, 0, 1}},
                                            {{0, 0, 0}, 1e30f, {nan, nan, nan}},
                                            {{0, 0, 0}, 1e30f, {0, 0, 0}}}))
        CHECK(t.hit.primitive == no_record);
}

// Of rays from within a closed, bumpy mesh, two thirds of them aimed at edges and vertices: how many meet
// nothing.
size_t count_leaks(size_t batches, size_t batch) {
    Random random(8);
    const std::vector<glm::vec3> sphere = icosphere(4, 1);
    // Bumps make it concave; every copy of a corner is displaced alike.
    std::vector<glm::vec3> vertices;
    for (const glm::vec3& v : sphere)
        vertices.push_back(v * (1 + 0.2f * std::sin(9 * v.x) * std::sin(8 * v.y + 1) * std::sin(7 * v.z)) +
                           glm::vec3(3, -2, 5));
    GeometryProbe probe;
    add_triangles(probe, vertices);
    probe.build();
    size_t leaks = 0;
    for (size_t b = 0; b < batches; b++) {
        std::vector<ProbeRay> rays(batch);
        for (ProbeRay& r : rays) {
            r = {glm::vec3(3, -2, 5) + random.point(0.1f), 1e30f, random.direction()};
            const size_t triangle = random.engine() % (vertices.size() / 3);
            const glm::vec3 a = vertices[3 * triangle], c = vertices[3 * triangle + 1];
            switch (random.engine() % 3) {
                case 1:
                    r.direction = a - r.origin;
                    break;
                case 2:
                    r.direction = glm::mix(a, c, random(0, 1)) - r.origin;
                    break;
                default:
                    break;
            }
        }
        for (const ProbeHit& hit : probe.find_hits(rays)) leaks += hit.primitive == no_record;
    }
    return leaks;
}

TEST_CASE("no ray leaves a closed mesh, not even through its edges and vertices") {
    CHECK(count_leaks(1, 300000) == 0);
}

TEST_CASE("of a hundred million rays none leaves a closed mesh" * doctest::test_suite("long")) {
    CHECK(count_leaks(100, 1000000) == 0);
}

TEST_CASE("rays pass both walls of a shell 4e-5 thick one after the other, at any scale and place") {
    for (const float scale : {1e-3f, 1.0f, 1e4f}) {
        for (const float away : {0.0f, 3.0f}) {
            CAPTURE(scale);
            CAPTURE(away);
            GeometryProbe probe;
            const std::vector<glm::vec3> sphere = icosphere(5, 1);
            for (const float radius : {1.0f, 1.00004f})
                for (size_t i = 0; i < sphere.size(); i += 3) {
                    const auto p = [&](size_t k) { return scale * (radius * sphere[i + k] + away); };
                    probe.add_triangle(p(0), p(1), p(2));
                }
            probe.build();
            Random random(4);
            std::vector<ProbeRay> rays(20000);
            for (ProbeRay& r : rays) r = {scale * (random.point(0.3f) + away), 1e30f, random.direction()};
            std::vector<ProbeTrace> first = probe.trace(rays, false);
            std::vector<ProbeRay> onward = rays;
            for (size_t i = 0; i < rays.size(); i++) onward[i].origin = first[i].onward;
            std::vector<ProbeTrace> second = probe.trace(onward, false);
            for (size_t i = 0; i < rays.size(); i++) onward[i].origin = second[i].onward;
            std::vector<ProbeTrace> third = probe.trace(onward, false);
            size_t missed = 0, again = 0, beyond = 0;
            for (size_t i = 0; i < rays.size(); i++) {
                const glm::vec3 d = rays[i].direction;
                const float gap = glm::dot(second[i].position - first[i].position, d) / scale;
                missed += first[i].hit.primitive == no_record || second[i].hit.primitive == no_record;
                again += gap < 3e-5f;
                beyond += third[i].hit.primitive != no_record;
            }
            CHECK(missed == 0);
            CHECK(again == 0);
            CHECK(beyond == 0);
        }
    }
}

TEST_CASE("a ray that grazes away from a plane of many triangles does not hit it") {
    for (const float scale : {1e-3f, 1.0f, 1e4f}) {
        for (int tilt = 0; tilt < 3; tilt++) {
            CAPTURE(scale);
            CAPTURE(tilt);
            glm::dmat4 m =
                glm::translate(glm::dmat4(1), glm::dvec3(scale) * glm::dvec3(0.3, -0.7, 0.2) * double(tilt));
            m = glm::rotate(m, 0.7 * tilt, glm::normalize(glm::dvec3(1, 2, 3)));
            const auto p = [&](int i, int j) {
                return glm::vec3(m * glm::dvec4(scale * i / 8.0 - scale, 0, scale * j / 8.0 - scale, 1));
            };
            GeometryProbe probe;
            for (int i = 0; i < 16; i++)
                for (int j = 0; j < 16; j++) {
                    probe.add_triangle(p(i, j), p(i + 1, j + 1), p(i + 1, j));
                    probe.add_triangle(p(i, j), p(i, j + 1), p(i + 1, j + 1));
                }
            probe.build();
            const glm::vec3 up = glm::vec3(m * glm::dvec4(0, 1, 0, 0));
            Random random(6);
            std::vector<ProbeRay> rays(20000);
            for (ProbeRay& r : rays) {
                const glm::vec3 target =
                    glm::vec3(m * glm::dvec4(scale * random(-0.9f, 0.9f), 0, scale * random(-0.9f, 0.9f), 1));
                r.direction = -random.direction();
                if (glm::dot(r.direction, up) > 0) r.direction = -r.direction;
                r.origin = target - scale * r.direction;
                r.t_max = 1e30f;
            }
            const std::vector<ProbeTrace> hits = probe.trace(rays, false);
            std::vector<ProbeRay> away;
            for (size_t i = 0; i < rays.size(); i++) {
                if (hits[i].hit.primitive == no_record) continue;
                const glm::vec3 n = hits[i].geometric_normal;
                const float height = std::pow(10.0f, random(-5, 0));
                glm::vec3 along = random.direction();
                along = glm::normalize(along - n * glm::dot(along, n));
                away.push_back({{}, 1e30f, glm::normalize(along + height * n)});
                // offset_origin on the side that the ray came from
                const float offset = glm::dot(glm::abs(n), hits[i].error);
                for (int axis = 0; axis < 3; axis++) {
                    const float moved = hits[i].position[axis] + offset * n[axis];
                    away.back().origin[axis] =
                        offset * n[axis] == 0 ? moved : std::nextafter(moved, n[axis] > 0 ? 1e30f : -1e30f);
                }
            }
            CHECK(away.size() > 15000);
            size_t hit_again = 0;
            for (const ProbeTrace& t : probe.trace(away, false)) hit_again += t.hit.primitive != no_record;
            CHECK(hit_again == 0);
        }
    }
}
