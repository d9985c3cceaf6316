// The geometry class `asphere` beside its contract: kinds of conics against double precision and closed
// forms.
#include "tests/contracts/geometry_classes.h"

using namespace etendue;

namespace {

struct Case {
    const char* name;
    SurfaceShape shape;
    double aperture;
};

// Coefficients of the class begin with r⁴.
nlohmann::json parameters(const Case& c) {
    nlohmann::json list = nlohmann::json::array();
    for (size_t i = 1; i < c.shape.coefficients.size(); ++i) list.push_back(c.shape.coefficients[i]);
    return {{"curvature", c.shape.curvature},
            {"conic", c.shape.conic},
            {"coefficients", list},
            {"aperture", c.aperture}};
}

const Case cases[] = {{"flat", {0, 0}, 0.5},
                      {"sphere", {1.25, 0}, 0.5},
                      {"hemisphere", {-2, 0}, 0.5},
                      {"paraboloid", {1.5, -1}, 0.5},
                      {"ellipsoid", {1.5, -0.6}, 0.5},
                      {"oblate ellipsoid", {-0.8, 3}, 0.5},
                      {"steep hyperboloid", {4, -6}, 0.5},
                      {"nearly flat", {1e-4, -1}, 0.5},
                      {"gull wing", {1, 0, {0, -4}}, 0.5},
                      {"asphere that ends steep", {1, -1, {0, 0.5, 0, 30}}, 0.5}};

}  // namespace

TEST_CASE("aspheres: every kind of conic meets rays where double precision says") {
    for (const Case& c : cases) {
        CAPTURE(c.name);
        ClassProbe probe("asphere", parameters(c));
        const AsphereOracle oracle{c.shape, double(float(c.aperture))};
        Random random(3);
        std::vector<ProbeRay> rays(8000);
        for (size_t i = 0; i < rays.size(); ++i) {
            const glm::vec3 origin = random.direction() * (i % 4 == 3 ? 100.0f : random(0.1f, 1));
            glm::vec3 target = random.direction() * random(0, 0.6f);
            if (i % 4 == 2) target = {origin.x, origin.y, -origin.z};  // along the axis
            rays[i] = {origin, 1e30f, glm::normalize(target - origin)};
        }
        const std::vector<Meeting> meetings = probe.meet(rays);
        size_t wrong = 0, hits = 0, off = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const glm::dvec3 o(rays[i].origin), d(rays[i].direction);
            const auto nearest = [&](glm::dvec3 from) {
                double t = 1e30;
                for (const double at : oracle.crossings(from, d))
                    if (at > 0) t = std::min(t, at);
                return t;
            };
            const double exact = nearest(o), tolerance = 4e-6 * (glm::length(o) + 1);
            bool clear = true;  // of the rim, the limb and the start
            for (int k = 0; k < 6 && clear; ++k) {
                glm::dvec3 beside = o;
                beside[k / 2] += (k % 2 ? 1 : -1) * tolerance;
                clear = std::abs(nearest(beside) - exact) < 50 * tolerance;
            }
            if (!clear) continue;
            const bool met = meetings[i].met != 0;
            wrong += met != (exact < 1e30) || (met && std::abs(meetings[i].t - exact) > 50 * tolerance);
            hits += met;
            if (met) {
                const double bound = glm::dot(glm::abs(meetings[i].normal), meetings[i].error);
                off += !(std::abs(oracle.distance(meetings[i].position)) <= bound + 1e-30);
            }
        }
        CHECK(hits > 800);
        CHECK(wrong == 0);
        CHECK(off == 0);
    }
}

TEST_CASE("aspheres: a paraboloid of radius -100, met along its axis, and from far away") {
    ClassProbe paraboloid("asphere", {{"curvature", -0.01}, {"conic", -1}, {"aperture", 20}});
    const glm::vec3 aside = glm::normalize(glm::vec3(0.3f, 0.1f, 1));
    const auto met = paraboloid.meet({{{10, 0, -5}, 1e30f, {0, 0, 1}},
                                      {{10, 0, 100}, 1e30f, {0, 0, -1}},
                                      {glm::vec3(10, 0, -0.5f) - 100.0f * aside, 1e30f, aside},
                                      {{10, 0, -5}, 4, {0, 0, 1}},
                                      {{10, 0, 5}, 1e30f, {0, 0, 1}}});
    for (int i = 0; i < 3; ++i) {
        REQUIRE(met[i].met);
        CHECK(std::abs(met[i].position.z + 0.5f) < (i < 2 ? 1e-6f : 2e-5f));
    }
    CHECK_FALSE(met[3].met);  // beyond t_max
    CHECK_FALSE(met[4].met);  // behind the start
}

TEST_CASE("aspheres: a start on the surface does not meet it again") {
    for (const Case& c : cases) {
        CAPTURE(c.name);
        if (!c.shape.coefficients.empty() || c.shape.curvature > 0)
            continue;  // hollow: may be met further on
        ClassProbe probe("asphere", parameters(c));
        std::vector<ProbeRay> rays;
        for (int i = 0; i < 400; ++i)
            rays.push_back({{0.02f * float(i % 20) - 0.2f, 0.02f * float(i / 20) - 0.2f, 3},
                            1e30f,
                            {0.05f, -0.02f, -1}});
        std::vector<ProbeRay> away;
        for (const Meeting& m : probe.meet(rays)) {
            REQUIRE(m.met);
            const glm::vec3 offset = glm::dot(glm::abs(m.normal), m.error) * m.normal;
            away.push_back({m.position + 1.0001f * offset + 1e-7f * m.normal, 1e30f,
                            glm::normalize(m.normal + glm::vec3(0.5f, -0.3f, 0))});
        }
        for (const Meeting& m : probe.meet(away)) CHECK_FALSE(m.met);
    }
}

TEST_CASE("aspheres: areas in closed form") {
    const auto area = [](const Case& c) { return ClassProbe("asphere", parameters(c)).area; };
    CHECK(area({"", {0, 0}, 0.5}) == doctest::Approx(M_PI / 4).epsilon(1e-6));
    CHECK(area({"", {2, 0}, 0.5}) == doctest::Approx(M_PI / 2).epsilon(1e-5));  // a hemisphere
    CHECK(area({"", {1, 0}, 0.6}) == doctest::Approx(2 * M_PI * 0.2).epsilon(1e-5));
    // A paraboloid: 2 π / (3 c²) ((1 + c² R²)^(3/2) - 1).
    CHECK(area({"", {3, -1}, 0.5}) ==
          doctest::Approx(2 * M_PI / 27 * (std::pow(1 + 9 * 0.25, 1.5) - 1)).epsilon(1e-5));
}
