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

const glm::dvec3 center{1, 2, 3};  // of all profiles, and of the scene

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
        return ior * ior * (1 + c.x * r2 + c.y * r2 * r2 + c.z * r2 * r2 * r2 + a.x * z + a.y * z * z + a.z * z * z * z);
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
    return {"fish-eye", "fish_eye", 4, {{"ior", ior}, {"radius", radius}}, n, [=](glm::dvec3 p) {
                return -2 * std::pow(n(p), 3) / (ior * radius * radius) * p;
            }};
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

// Twin of Step in bend_rays.comp.
struct Step {
    glm::vec3 position, chord, start, end, bow;
    glm::dvec3 at(double part) const { return glm::dvec3(position) + part * glm::dvec3(chord); }
    glm::dvec3 direction_at(double part) const {
        return glm::normalize(glm::mix(glm::dvec3(start), glm::dvec3(end), part) +
                              part * (1 - part) * glm::dvec3(bow));
    }
};

// The steps of rays through a medium of the profile, within a sphere around its centre.
struct BendProbe {
    Scene scene;
    uint32_t tag;
    Kernel kernel;

    BendProbe(const Profile& profile, double tolerance) : tag(profile.tag) {
        SceneBuilder s;
        json parameters = profile.parameters;
        parameters["class"] = profile.class_name;
        parameters["center"] = {center.x, center.y, center.z};
        parameters["tolerance"] = tolerance;
        s.medium("bends", parameters);
        s.sphere(2, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "bends"}}),
                 at(center.x, center.y, center.z));
        scene = compile_test_scene(s.import());
        REQUIRE(scene.features.bending);
        scene.sources.generated["bend_rays.comp"] = test_kernel_text("bend_rays.comp");
    }

    std::vector<std::vector<Step>> run(const std::vector<Ray>& rays, uint32_t steps) {
        std::vector<glm::vec3> starts;
        for (const Ray& ray : rays) starts.insert(starts.end(), {ray.position, ray.direction});
        const Buffer in = create_buffer(test_device(), starts, "Starts");
        const Buffer out(test_device(), rays.size() * steps * sizeof(Step), "Steps");
        kernel = make_kernel(test_device(), scene, "bend_rays.comp", {{"Starts", &in}, {"Steps", &out}});
        CommandList commands(test_device());
        commands.dispatch(kernel, uint32_t(rays.size() + 63) / 64,
                          {{"count", uint32_t(rays.size())},
                           {"steps_a_ray", steps},
                           {"medium", record_ref(tag, 0)}});
        commands.run();
        const auto all = out.read_array<Step>(rays.size() * steps);
        std::vector<std::vector<Step>> result;
        for (size_t i = 0; i < rays.size(); ++i)
            result.emplace_back(all.begin() + long(i * steps), all.begin() + long((i + 1) * steps));
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

    // To the plane across the ray that holds p, which is near it; returns how far p lies from the ray there, m.
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

double angle(glm::dvec3 a, glm::dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

// From all over the ball of radius 0.7 m, in all directions.
std::vector<Ray> some_rays(uint32_t count) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto direction = [&] { return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))); };
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < count; ++i) rays.push_back({0.7 * std::cbrt(uniform(random)) * direction(), direction()});
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
        ExactRay exact(profile, {glm::dvec3(steps[i][0].position), glm::normalize(glm::dvec3(steps[i][0].start))});
        double gone = 0;
        for (const Step& s : steps[i]) {
            if (gone > length || glm::length(s.at(1)) > 1.1) break;
            gone += glm::length(glm::dvec3(s.chord)), count += 1;
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
    for (const Profile* profile : {&rod, &ramp, &luneburg, &mixed, &maxwell}) {
        CAPTURE(profile->name);
        Errors before;
        for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
            CAPTURE(tolerance);
            const Errors e = errors_of(*profile, tolerance, 4);
            MESSAGE(profile->name, ", tolerance ", tolerance, ": chord ", e.chord / tolerance, ", end ", e.end / tolerance,
                    " tolerances, direction ", e.direction, " rad, ", e.steps, " steps a metre");
            CHECK(e.chord < tolerance);
            CHECK(e.chord > 0.4 * tolerance);
        }
    }
}
