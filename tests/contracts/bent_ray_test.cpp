// Rays through media whose refractive index varies: steps against the ray equation in double precision, and
// against what is known of some profiles.
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "host/error.h"
#include "host/scene/scene.h"
#include "tests/support/render_probe.h"
#include "tests/support/surface_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

const glm::dvec3 center{1, 2, 3};  // of all profiles, not of the scene

// n, and half the gradient of n², at a place as seen from the centre.
struct Profile {
    std::string name, class_name;
    uint32_t tag;
    json parameters;
    std::function<double(glm::dvec3)> index;
    std::function<glm::dvec3(glm::dvec3)> bending;
};

Profile polynomial(const std::string& name, double ior, glm::dvec3 c, glm::dvec3 a, glm::dvec3 axis) {
    const glm::dvec3 u = glm::normalize(axis);
    const auto squared = [=](glm::dvec3 p) {
        const double z = glm::dot(p, u), r2 = glm::dot(p, p) - z * z;
        return ior * ior *
               (1 + c.x * r2 + c.y * r2 * r2 + c.z * r2 * r2 * r2 + a.x * z + a.y * z * z + a.z * z * z * z);
    };
    const auto list = [](glm::dvec3 v) { return json{v.x, v.y, v.z}; };
    return {name,
            "gradient_index",
            3,
            {{"ior", ior}, {"radial", list(c)}, {"axial", list(a)}, {"axis", list(axis)}},
            [=](glm::dvec3 p) { return std::sqrt(squared(p)); },
            [=](glm::dvec3 p) {
                const double h = 1e-5;  // central differences: exact for squares, else to 1e-10
                glm::dvec3 g;
                for (int i = 0; i < 3; ++i) {
                    glm::dvec3 d(0);
                    d[i] = h;
                    g[i] = (squared(p + d) - squared(p - d)) / (4 * h);
                }
                return g;
            }};
}

Profile fish_eye(double ior, double radius) {
    const auto n = [=](glm::dvec3 p) { return ior / (1 + glm::dot(p, p) / (radius * radius)); };
    return {"fish-eye", "fish_eye",
            4,          {{"ior", ior}, {"radius", radius}},
            n,          [=](glm::dvec3 p) {
                return -2 * std::pow(n(p), 3) / (ior * radius * radius) * p; }};
}

constexpr double g = 0.8;  // 1/m
const Profile rod = polynomial("rod", 1.6, {-g * g, 0, 0}, {0, 0, 0}, {0, 0, 1});
const Profile ramp = polynomial("ramp", 1.4, {0, 0, 0}, {0.2, 0, 0}, {0, 2, 0});
const Profile luneburg = polynomial("Luneburg", std::sqrt(2), {-0.5, 0, 0}, {0, -0.5, 0}, {0, 0, 1});
const Profile mixed =
    polynomial("all coefficients, aslant", 1.5, {-0.8, 0.5, -0.3}, {0.05, -0.1, 0.06}, {1, -2, 3});
const Profile maxwell = fish_eye(2, 1);

struct Ray {
    glm::dvec3 position, direction;  // as seen from the centre; unit
};

struct Step {
    glm::dvec3 position, chord, start, end, bow;
    glm::dvec3 at(double part) const { return position + part * chord; }
    glm::dvec3 direction_at(double part) const {
        return glm::normalize(glm::mix(start, end, part) + part * (1 - part) * bow);
    }
};
struct DeviceStep {  // twin of Step in bend_rays.comp
    glm::vec3 position, chord, start, end, bow;
};

// The steps of rays through a medium of the profile, within a sphere around its centre.
struct BendProbe {
    Scene scene;
    uint32_t tag;
    Kernel kernel;
    glm::dvec3 offset{0};  // of the profile's centre in the device's world

    BendProbe(const Profile& profile, double tolerance) : tag(profile.tag) {
        SceneBuilder s;
        json parameters = profile.parameters;
        parameters["class"] = profile.class_name;
        parameters["center"] = {center.x, center.y, center.z};
        parameters["tolerance"] = tolerance;
        s.medium("bends", parameters);
        s.sphere(2, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "bends"}}),
                 at(center.x, center.y, center.z));
        s.sphere(0.1, s.surface({{"class", "absorber"}}), at(center.x + 1, center.y - 0.5, center.z - 3));
        scene = compile_test_scene(s.import());
        REQUIRE(scene.features.bending);
        offset = center - scene.center;
        scene.sources.generated["bend_rays.comp"] = test_kernel_text("bend_rays.comp");
    }

    std::vector<std::vector<Step>> run(const std::vector<Ray>& rays, uint32_t steps) {
        std::vector<glm::vec3> starts;
        for (const Ray& ray : rays) starts.insert(starts.end(), {ray.position + offset, ray.direction});
        const Buffer in = create_buffer(test_device(), starts, "Starts");
        const Buffer out(test_device(), rays.size() * steps * sizeof(DeviceStep), "Steps");
        kernel = make_kernel(test_device(), scene, "bend_rays.comp", {{"Starts", &in}, {"Steps", &out}});
        CommandList commands(test_device());
        commands.dispatch(
            kernel, uint32_t(rays.size() + 63) / 64,
            {{"count", uint32_t(rays.size())}, {"steps_a_ray", steps}, {"medium", record_ref(tag, 0)}});
        commands.run();
        const auto all = out.read_array<DeviceStep>(rays.size() * steps);
        std::vector<std::vector<Step>> result(rays.size());
        for (size_t i = 0; i < rays.size(); ++i)
            for (uint32_t k = 0; k < steps; ++k) {
                const DeviceStep& s = all[i * steps + k];
                result[i].push_back({glm::dvec3(s.position) - offset, s.chord, s.start, s.end, s.bow});
            }
        return result;
    }
};

// The exact ray: Runge-Kutta steps of fourth order, so short that they are exact.
struct ExactRay {
    const Profile& profile;
    glm::dvec3 position, optical;  // direction, as long as the index

    ExactRay(const Profile& profile, const Ray& ray)
        : profile(profile), position(ray.position), optical(ray.direction * profile.index(ray.position)) {}

    void advance(double dt) {
        const auto f = [&](glm::dvec3 p) { return profile.bending(p); };
        const glm::dvec3 k1 = f(position), k2 = f(position + 0.5 * dt * optical),
                         k3 = f(position + 0.5 * dt * optical + 0.25 * dt * dt * k1),
                         k4 = f(position + dt * optical + 0.5 * dt * dt * k2);
        position += dt * optical + dt * dt / 6 * (k1 + k2 + k3);
        optical += dt / 6 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }

    // To the plane across the ray that holds p, which is near it; returns how far p lies from the ray there,
    // m.
    double meet(glm::dvec3 p) {
        constexpr double longest = 2e-3;
        for (int i = 0; i < 1000000; ++i) {
            const double left = glm::dot(p - position, optical) / glm::dot(optical, optical);
            if (std::fabs(left) < 1e-13) break;
            advance(std::clamp(left, -longest, longest));
        }
        return glm::length(p - position);
    }
    glm::dvec3 direction() const { return glm::normalize(optical); }
};

// Of the chord's point nearest to p: how far it is, m, and where.
double distance_to(const Step& s, glm::dvec3 p, double& part) {
    part = std::clamp(glm::dot(p - s.position, s.chord) / glm::dot(s.chord, s.chord), 0.0, 1.0);
    return glm::length(s.at(part) - p);
}

double angle(glm::dvec3 a, glm::dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

// From all over the ball of radius 0.7 m, in all directions.
std::vector<Ray> some_rays(uint32_t count) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto direction = [&] {
        return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    };
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < count; ++i)
        rays.push_back({0.7 * std::cbrt(uniform(random)) * direction(), direction()});
    return rays;
}

struct Errors {
    double chord = 0, end = 0, direction = 0;  // greatest, m and radians
    double steps = 0;                          // a metre, on average
};

// Of rays while they are within the ball of radius 1.1 m and no longer than `length`.
Errors errors_of(const Profile& profile, double tolerance, double length) {
    BendProbe probe(profile, tolerance);
    const auto rays = some_rays(24);
    Errors e;
    double way = 0, count = 0;
    const auto steps = probe.run(rays, uint32_t(length * 0.6 / std::sqrt(tolerance)) + 20);
    for (size_t i = 0; i < rays.size(); ++i) {
        // From what the device starts with: rays are rounded.
        ExactRay exact(profile, {steps[i][0].position, glm::normalize(steps[i][0].start)});
        double gone = 0;
        for (const Step& s : steps[i]) {
            if (gone > length || glm::length(s.at(1)) > 1.1) break;
            gone += glm::length(s.chord), count += 1;
            for (const double part : {0.25, 0.5, 0.75}) {
                e.chord = std::max(e.chord, exact.meet(s.at(part)));
                e.direction = std::max(e.direction, angle(s.direction_at(part), exact.direction()));
            }
            e.end = std::max(e.end, exact.meet(s.at(1)));
            e.direction = std::max(e.direction, angle(s.direction_at(1), exact.direction()));
        }
        way += gone;
    }
    e.steps = count / way;
    return e;
}

}  // namespace

TEST_CASE("bent rays stay within the tolerance of their chords, and their ends are more accurate than that") {
    constexpr double rounding = 3e-6;  // of some hundred steps in a scene of some metres, m and radians
    for (const Profile* profile : {&rod, &ramp, &luneburg, &mixed, &maxwell}) {
        CAPTURE(profile->name);
        double steps_before = 0;
        for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
            CAPTURE(tolerance);
            const Errors e = errors_of(*profile, tolerance, 4);
            MESSAGE(profile->name, ", tolerance ", tolerance, ": chord ", e.chord / tolerance, ", end ",
                    e.end / tolerance, " tolerances, direction ", e.direction, " rad, ", e.steps,
                    " steps a metre");
            CHECK(e.chord < tolerance);
            CHECK(e.chord > 0.5 * tolerance);  // steps are no shorter than they must be
            CHECK(e.end < 0.02 * tolerance + rounding);
            CHECK(e.direction < 6 * std::pow(tolerance, 1.5) + rounding);
            if (steps_before > 0)
                CHECK(e.steps / steps_before == doctest::Approx(std::sqrt(10)).epsilon(0.1));
            steps_before = e.steps;
        }
    }
}

TEST_CASE("bent rays in a rod of quadratic index are sinusoids of its pitch, also after ten pitches") {
    // x'' = -(n0 g)² x in the parameter t, for each of both coordinates across the axis; dz/dt is constant.
    constexpr double tolerance = 1e-4;
    BendProbe probe(rod, tolerance);
    std::vector<Ray> rays;
    for (const Ray& ray : some_rays(16))
        rays.push_back({0.6 * ray.position, glm::normalize(glm::dvec3(0, 0, 3) + ray.direction)});
    const double pitch = 2 * std::numbers::pi / g, omega = 1.6 * g;
    double worst = 0, furthest = 0;
    for (const auto& steps : probe.run(rays, 3000)) {
        const glm::dvec3 p = steps[0].position, d = steps[0].start;
        for (const Step& s : steps) {
            const double t = (s.at(1).z - p.z) / d.z;
            if (t * d.z > 10 * pitch) break;
            const glm::dvec3 exact = p * std::cos(omega * t) + d * (std::sin(omega * t) / omega);
            worst = std::max(worst, glm::length(glm::dvec2(s.at(1)) - glm::dvec2(exact)));
            furthest = std::max(furthest, t * d.z);
        }
    }
    MESSAGE("after ten pitches off by ", worst / tolerance, " tolerances");
    CHECK(furthest > 9.9 * pitch);
    CHECK(worst < tolerance);
}

TEST_CASE("bent rays over a ramp of the squared index are parabolas") {
    BendProbe probe(ramp, 1e-3);
    for (const auto& steps : probe.run(some_rays(16), 8)) {
        const glm::dvec3 p = steps[0].position, d = steps[0].start, f = ramp.bending({0, 0, 0});
        for (const Step& s : steps) {
            const double t = (s.at(1).x - p.x) / d.x;  // the ramp is along y
            const glm::dvec3 exact = p + t * d + 0.5 * t * t * f;
            CHECK(glm::length(s.at(1) - exact) < 3e-6 * (1 + glm::length(exact - p) / std::fabs(d.x)));
        }
    }
}

TEST_CASE("bent rays from a point of Maxwell's fish-eye meet at its image, and Bouguer's invariant is kept") {
    constexpr double tolerance = 1e-4;
    BendProbe probe(maxwell, tolerance);
    const glm::dvec3 from{0.5, 0.2, -0.4}, image = -from / glm::dot(from, from);
    std::vector<Ray> rays;
    for (const Ray& ray : some_rays(16)) rays.push_back({from, ray.direction});
    for (const auto& steps : probe.run(rays, 2000)) {
        const glm::dvec3 invariant = glm::cross(steps[0].position, steps[0].start);
        double nearest = 1e9, part;
        for (const Step& s : steps) {
            nearest = std::min(nearest, distance_to(s, image, part));
            CHECK(glm::length(glm::cross(s.position, s.start) - invariant) < 0.2 * tolerance);
        }
        CHECK(nearest < tolerance);
    }
}

TEST_CASE("bent rays that enter a Luneburg lens along each other meet at its far side") {
    constexpr double tolerance = 1e-4;
    BendProbe probe(luneburg, tolerance);
    std::vector<Ray> rays;
    for (int i = 0; i < 16; ++i) {
        const double y = -0.9 + 1.8 * i / 15;  // on the sphere of radius 1 m, where the index is 1
        rays.push_back({{-std::sqrt(1 - y * y - 0.04), y, 0.2}, {1, 0, 0}});
    }
    for (const auto& steps : probe.run(rays, 300)) {
        double nearest = 1e9, part;
        for (const Step& s : steps) {
            nearest = std::min(nearest, distance_to(s, {1, 0, 0}, part));
        }
        CHECK(nearest < tolerance);
    }
}

TEST_CASE("bent rays turned round go back to where they came from") {
    constexpr double tolerance = 1e-4;
    for (const Profile* profile : {&rod, &mixed, &maxwell}) {
        CAPTURE(profile->name);
        BendProbe probe(*profile, tolerance);
        std::vector<Ray> rays = some_rays(16), back;
        const auto there = probe.run(rays, 40);
        for (const auto& steps : there)
            back.push_back({steps.back().at(1), -glm::normalize(steps.back().end)});
        const auto again = probe.run(back, 60);
        for (size_t i = 0; i < rays.size(); ++i) {
            double nearest = 1e9, turned = 0;
            for (const Step& s : again[i]) {
                double part;
                const double distance = distance_to(s, rays[i].position, part);
                if (distance < nearest) turned = angle(s.direction_at(part), -rays[i].direction);
                nearest = std::min(nearest, distance);
            }
            if (glm::length(back[i].position) > 1.1) continue;  // where the polynomial is no index any more
            CHECK(nearest < 1.2 * tolerance);
            CHECK(turned < 1e-3);
        }
    }
}

TEST_CASE("parameters of media that bend rays: what is wrong is said in one line") {
    const auto message = [](json more) -> std::string {
        SceneBuilder s;
        json parameters = {{"class", "gradient_index"}};
        parameters.update(more);
        s.medium("bends", parameters);
        s.sphere(1, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "bends"}}), at(0, 0, 0));
        try {
            compile_test_scene(s.import());
        } catch (const std::exception& e) {
            return e.what();
        }
        return "";
    };
    CHECK(message({{"radial", {-1, 0, 0}}}) == "");
    CHECK(message({{"axis", {0, 0, 0}}}).find("/axis: has no length") != std::string::npos);
    CHECK(message({{"center", {0, 0}}}).find("/center: allowed: an array of 3 numbers") != std::string::npos);
    CHECK(message({{"tolerance", 0}}).find("/tolerance: 0 is out of range") != std::string::npos);
    CHECK(message({{"scattering", 1}}).find("unknown parameter of medium gradient_index") !=
          std::string::npos);
}
