// Every registered geometry class, on the device: its area and its sampler against random lines through it,
// sampling towards a point against its pdf, intersections against double precision, bounds, error bounds.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/contracts/geometry_classes.h"
#include "tests/support/statistics.h"

using namespace etendue;

TEST_CASE("every geometry class in the registry is known to these tests") {
    for (const std::string& name : registered()) {
        INFO("geometry class " << name << " needs an oracle here");
        CHECK(oracles().count(name) == 1);
    }
}

TEST_CASE("area and uniform sampling agree with random lines through the surface") {
    const std::vector<std::string> names = registered();
    for (const std::string& name : names) {
        if (!oracles().at(name).is_samplable) continue;
        CAPTURE(name);
        ClassProbe probe(name);
        const size_t n = 400000;
        float radius;
        // A line is counted where it enters by the front: half of all crossings.
        std::vector<double> by_lines(side * side * side), by_samples(side * side * side);
        double entered = 0;
        std::vector<ProbeRay> rays = random_lines(probe.bounds, n, radius, 1);
        std::vector<Meeting> meetings = probe.meet(rays);
        for (int crossing = 0; crossing < 2; crossing++) {
            for (size_t i = 0; i < n; i++) {
                if (!meetings[i].met) {
                    rays[i].origin = glm::vec3(1e6f);
                    continue;
                }
                if (glm::dot(meetings[i].normal, rays[i].direction) < 0)
                    entered++, by_lines[cell_of(probe.bounds, meetings[i].position)]++;
                rays[i].origin = meetings[i].position + 1e-4f * radius * rays[i].direction;
            }
            if (crossing == 0) meetings = probe.meet(rays);
        }
        const double p = entered / n, area = p * 4 * M_PI * radius * radius;
        CHECK(z_test(area, probe.area, std::sqrt(p * (1 - p) / n) * 4 * M_PI * radius * radius, 1e-4 * area) >
              sidak_level(0.001, 3 * names.size()));

        const std::vector<Sample> samples = probe.sample(uniform_points(n, 2));
        size_t wrong_pdf = 0, outside = 0, not_unit = 0;
        Box reached;
        for (const Sample& s : samples) {
            by_samples[cell_of(probe.bounds, s.position)]++;
            wrong_pdf += !(std::abs(s.pdf * probe.area - 1) < 1e-4f);
            not_unit += !(std::abs(glm::length(s.normal) - 1) < 1e-5f);
            const glm::vec3 slack = 1e-6f * glm::abs(s.position);
            outside += glm::any(glm::lessThan(s.position, probe.bounds.lo - slack)) ||
                       glm::any(glm::greaterThan(s.position, probe.bounds.hi + slack));
            reached.grow(s.position);
        }
        CHECK(wrong_pdf == 0);
        CHECK(not_unit == 0);
        CHECK(outside == 0);
        CHECK(glm::length(probe.bounds.hi - probe.bounds.lo - (reached.hi - reached.lo)) < 0.02f * radius);
        // Two counts of the same distribution.
        double statistic = 0;
        size_t cells = 0;
        const double k = std::sqrt(double(n) / entered);
        for (size_t i = 0; i < by_lines.size(); i++) {
            if (by_lines[i] + by_samples[i] < 20) continue;
            statistic += std::pow(by_samples[i] / k - by_lines[i] * k, 2) / (by_samples[i] + by_lines[i]);
            cells++;
        }
        CHECK(cells > 10);
        CHECK(chi2_survival(statistic, double(cells - 1)) > sidak_level(0.001, 3 * names.size()));
    }
}

TEST_CASE("sampling towards a point has the pdf that it says") {
    const glm::vec3 references[] = {{2, 1, 3}, {0.9f, 0.4f, 0.6f}, {0.1f, -0.2f, 0.15f}, {-30, 10, 5},
                                    {0, 0, 4}, {0.2f, 2, 0.01f},   {3000, -5000, 2000}};
    const std::vector<std::string> names = registered();
    for (const std::string& name : names) {
        if (!oracles().at(name).is_samplable) continue;
        CAPTURE(name);
        ClassProbe probe(name);
        for (const glm::vec3& reference : references) {
            CAPTURE(reference.x);
            const size_t n = 200000;
            const int grid = 1000;
            std::vector<double> observed(side * side * side), expected(side * side * side);
            double integral = 0;
            for (const Sample& s : probe.sample(grid_points(grid), {}, reference)) {
                const double share = double(s.pdf_towards) * probe.area / (grid * grid);
                expected[cell_of(probe.bounds, s.position)] += share * n;
                integral += share;
            }
            CHECK(integral == doctest::Approx(1).epsilon(0.003));
            size_t wrong_pdf = 0, off = 0;
            for (const Sample& s : probe.sample(uniform_points(n, 3), reference)) {
                observed[cell_of(probe.bounds, s.position)]++;
                wrong_pdf += !(std::abs(s.pdf - s.pdf_towards) <= 1e-4f * s.pdf);
                off += !(std::abs(oracles().at(name).distance(s.position)) < 1e-6);
            }
            CHECK(wrong_pdf == 0);
            CHECK(off == 0);
            // Quadrature puts the cells' borders a grid step wide: relative 1/grid of what neighbours hold.
            const ChiSquared test = chi_squared_test(observed, expected, 200);
            CHECK(test.p_value > 1e-5);
        }
    }
}

TEST_CASE("a small or far sphere is sampled over the half that is seen") {
    for (const float distance : {1.0000005f, 1.01f, 500.0f, 1e6f}) {
        CAPTURE(distance);
        ClassProbe probe("sphere");
        const glm::vec3 reference = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f)) * (0.8f * distance);
        const std::vector<Sample> samples = probe.sample(uniform_points(20000, 4), reference);
        size_t unseen = 0, wrong = 0;
        const double sine = 1.0 / distance,
                     solid_angle = 2 * M_PI * sine * sine / (1 + std::sqrt(1 - sine * sine));
        for (const Sample& s : samples) {
            const glm::dvec3 d = glm::dvec3(reference) - glm::dvec3(s.position);
            const double l = glm::length(d), cosine = glm::dot(d, glm::dvec3(s.normal)) / l;
            unseen += !(cosine >= -1e-6);
            // Per solid angle the pdf is constant; near the limb the cosine has lost its digits.
            if (cosine > 0.02) wrong += !(std::abs(s.pdf * l * l / cosine * solid_angle - 1) < 2e-3);
        }
        CHECK(unseen == 0);
        CHECK(wrong == 0);
    }
}

TEST_CASE("intersections agree with double precision") {
    for (const std::string& name : registered()) {
        CAPTURE(name);
        ClassProbe probe(name);
        const Oracle& oracle = oracles().at(name);
        Random random(9);
        std::vector<ProbeRay> rays(100000);
        for (size_t i = 0; i < rays.size(); i++) {
            const float away = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 3.0f : 1000.0f;
            const glm::vec3 origin = random.direction() * (away * random(0.2f, 1)),
                            target = random.direction() * random(0, 0.9f);
            rays[i] = {origin, 1e30f, i % 2 ? target - origin : glm::normalize(target - origin)};
        }
        const std::vector<Meeting> meetings = probe.meet(rays);
        size_t wrong = 0, hits = 0, off = 0;
        for (size_t i = 0; i < rays.size(); i++) {
            const glm::dvec3 o(rays[i].origin), d(rays[i].direction);
            double nearest = 1e30;
            for (const double t : oracle.crossings(o, d))
                if (t > 0) nearest = std::min(nearest, t);
            const bool exact = nearest < 1e30, met = meetings[i].met != 0;
            // Near a rim or the limb either answer is right: ask whether rays beside it disagree, too.
            const double tolerance = 2e-6 * (glm::length(o) + 1);
            bool clear = true;
            for (int k = 0; k < 6 && clear; k++) {
                glm::dvec3 beside = o;
                beside[k / 2] += (k % 2 ? 1 : -1) * tolerance;
                double t_beside = 1e30;
                for (const double t : oracle.crossings(beside, d))
                    if (t > 0) t_beside = std::min(t_beside, t);
                clear = (t_beside < 1e30) == exact &&
                        (!exact || std::abs(t_beside - nearest) * glm::length(d) < 50 * tolerance);
            }
            if (!clear) continue;
            hits += met;
            if (met != exact ||
                (met && !(std::abs(meetings[i].t - nearest) * glm::length(d) < 20 * tolerance)))
                wrong++;
            if (met) {
                const double bound = glm::dot(glm::abs(meetings[i].normal), meetings[i].error);
                off += !(std::abs(oracle.distance(meetings[i].position)) <= bound + 1e-30);
            }
        }
        CHECK(hits > 10000);
        CHECK(wrong == 0);
        CHECK(off == 0);
    }
}

TEST_CASE("placed surfaces: error bounds hold and rays that leave do not hit again, under any affine map") {
    for (const std::string& name : registered()) {
        if (name == "triangle") continue;  // is placed by its vertices; see the traversal tests
        const Oracle& oracle = oracles().at(name);
        for (int placement = 0; placement < 5; placement++) {
            CAPTURE(name);
            CAPTURE(placement);
            glm::dmat4 m(1);
            if (placement == 1) m = glm::translate(m, glm::dvec3(20, -30, 10));
            if (placement == 2)
                m = glm::scale(glm::translate(m, glm::dvec3(3, 2, 1)), glm::dvec3(2, 0.5, -1));
            if (placement == 3) m = glm::scale(glm::dmat4(1), glm::dvec3(1e-3));
            if (placement == 4)
                m = glm::scale(glm::translate(m, glm::dvec3(3e4, 2e4, -1e4)), glm::dvec3(1e4));
            m = glm::rotate(m, 1.1, glm::normalize(glm::dvec3(1, -2, 3)));
            GeometryProbe probe;
            probe.add_shape(name, oracle.parameters, oracle.bounds, m);
            probe.build();
            Random random(12);
            std::vector<ProbeRay> rays(20000);
            for (ProbeRay& r : rays) {
                const glm::dvec3 a = glm::dvec3(random.direction()) * 3.0,
                                 b = glm::dvec3(random.direction()) * double(random(0, 0.7f));
                const glm::vec3 origin(m * glm::dvec4(a, 1)), target(m * glm::dvec4(b, 1));
                r = {origin, 1e30f, glm::normalize(target - origin)};
            }
            const glm::dmat4 inverse = glm::inverse(m);
            std::vector<ProbeRay> away;
            size_t off = 0, hits = 0, again = 0;
            for (const ProbeTrace& t : probe.trace(rays, false)) {
                if (t.hit.primitive == no_record) continue;
                hits++;
                const glm::dvec3 n(t.geometric_normal);
                const glm::dvec3 local(inverse * glm::dvec4(glm::dvec3(t.position), 1));
                // The step along the world normal that leads back to the surface.
                const double step = 1e-6 * glm::length(glm::dvec3(m[0]));
                const glm::dvec3 local_step(inverse * glm::dvec4(n * step, 0));
                const double slope =
                    (oracle.distance(local + local_step) - oracle.distance(local - local_step)) / (2 * step);
                const double distance = oracle.distance(local) / slope,
                             bound = glm::dot(glm::abs(t.geometric_normal), t.error);
                off += !(std::abs(distance) <= bound);
                // Leaving from the outside, from steep to grazing.
                const glm::vec3 direction = random.direction();
                const glm::vec3 normal = t.geometric_normal;
                const glm::vec3 along = glm::normalize(direction - normal * glm::dot(direction, normal));
                ProbeRay r{{}, 1e30f, glm::normalize(along + std::pow(10.0f, random(-6, 1)) * normal)};
                const glm::vec3 offset = glm::dot(glm::abs(normal), t.error) * normal;
                for (int axis = 0; axis < 3; axis++)
                    r.origin[axis] =
                        std::nextafter(t.position[axis] + offset[axis], offset[axis] > 0 ? 1e30f : -1e30f);
                away.push_back(r);
            }
            CHECK(hits > 1000);
            CHECK(off == 0);
            if (!oracle.is_convex) continue;  // others may be in the way
            for (const ProbeTrace& t : probe.trace(away, false)) again += t.hit.primitive != no_record;
            CHECK(again == 0);
        }
    }
}
