// The choice of a light, on the device: chosen as often as stated, complete, and good with ten thousand
// lights.
#include <cmath>
#include <cstring>
#include <random>

#include "host/scene/features.h"
#include "host/lights/light_tree.h"
#include "tests/support/device_fixture.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double false_alarm = 1e-4;

struct Triangle {
    glm::dvec3 center, normal;
    double area;
};

// Small emissive triangles, radiance 1, on lamps spread through a hall of 40 x 40 x 4 m.
std::vector<Triangle> hall_triangles(uint32_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Triangle> triangles;
    while (triangles.size() < count) {
        const glm::dvec3 lamp(20 * uniform(random), 20 * uniform(random), 2 * uniform(random));
        const double size = 0.02 * std::exp(uniform(random));
        for (int i = 0; i < 20 && triangles.size() < count; ++i) {  // the faces of a bulb
            const glm::dvec3 n =
                glm::normalize(glm::dvec3(uniform(random), uniform(random), uniform(random)));
            triangles.push_back({lamp + 2 * size * n, n, size * size});
        }
    }
    return triangles;
}

LightBounds bounds_of(const Triangle& t) {
    LightBounds b;
    const glm::vec3 size(float(std::sqrt(t.area)));
    b.lo = glm::vec3(t.center) - size, b.hi = glm::vec3(t.center) + size;
    b.power = float(3.14159265 * t.area);
    b.axis = glm::normalize(glm::vec3(t.normal));
    b.cos_normals = 1;
    return b;
}

// Lights at infinity, then triangles; of three lights one shines all around, as a point light.
std::vector<LightBounds> test_lights(uint32_t infinite, uint32_t finite) {
    std::vector<LightBounds> lights(infinite, LightBounds{{1, 1, 1}, 1, {-1, -1, -1}, -1, {0, 0, 1}, 0});
    uint32_t i = 0;
    for (const Triangle& t : hall_triangles(finite)) {
        lights.push_back(bounds_of(t));
        if (i++ % 3 == 2)
            lights.back().lo = lights.back().hi = glm::vec3(t.center), lights.back().cos_normals = -1;
    }
    return lights;
}

struct Choice {
    uint32_t light;
    float probability, stated, u;
};

const char* const text = R"(
    #include "features/light_selection.glsl"
    #include "lib/sampler.glsl"
    layout(local_size_x = 64) in;
    struct Choice { uint light; float probability; float stated; float u; };
    layout(scalar, set = 0) readonly buffer Points { vec3 points[]; };
    layout(scalar, set = 0) writeonly buffer Choices { Choice choices[]; };
    layout(scalar, set = 0) writeonly buffer Probabilities { float probabilities[]; };
    layout(push_constant) uniform Push { uint count, list; };
    void main() {
        uint i = gl_GlobalInvocationID.x;
        if (i >= count) return;
        if (list != 0u) {
            probabilities[i] = light_selection_probability(i % LIGHT_COUNT, points[i / LIGHT_COUNT]);
            return;
        }
        float u = float(hash_3d(hash_3d(uvec3(i, 7u, 1u))).x >> 8) / 16777216.0;
        Choice c;
        c.light = select_light(points[0], u, c.probability, c.u);
        c.stated = light_selection_probability(c.light, points[0]);
        choices[i] = c;
    }
)";

class Selection {
  public:
    Selection(const std::vector<LightBounds>& lights, uint32_t max_listed = max_listed_lights)
        : count_(uint32_t(lights.size())), tree(build_light_tree(lights, max_listed)) {
        nodes_ = create_buffer(test_device(), tree.nodes, "light nodes");
        trails_ = create_buffer(test_device(), tree.trails, "light trails");
    }

    std::vector<Choice> choose(glm::vec3 point, uint32_t samples) {
        Buffer out(test_device(), uint64_t(samples) * sizeof(Choice), "choices"),
            none(test_device(), 4, "none");
        run(samples, 0, {point}, out, none);
        return out.read_array<Choice>(samples);
    }
    std::vector<float> probabilities(const std::vector<glm::vec3>& points) {
        const uint32_t count = count_ * uint32_t(points.size());
        Buffer out(test_device(), uint64_t(count) * 4, "probabilities"), none(test_device(), 4, "none");
        run(count, 1, points, none, out);
        return out.read_array<float>(count);
    }

  private:
    void run(uint32_t count, uint32_t list, const std::vector<glm::vec3>& points, Buffer& choices,
             Buffer& probabilities) {
        ShaderSources sources;
        sources.folder = source_path("shaders");
        sources.generated["select_lights.comp"] = text;
        Features features;
        features.light_count = count_;
        features.infinite_light_count = tree.infinite_count;
        features.light_tree = tree.is_tree;
        CompileOptions options;
        options.defines = features.defines();
        Buffer at = create_buffer(test_device(), points, "points"), none(test_device(), 4, "lights");
        const Kernel kernel(test_device(), compile_shader(sources, "select_lights.comp", options),
                            {{"Points", &at},
                             {"Choices", &choices},
                             {"Probabilities", &probabilities},
                             {"Lights", &none},
                             {"LightNodes", &nodes_},
                             {"LightTrails", &trails_}});
        CommandList list_(test_device());
        list_.dispatch(kernel, (count + 63) / 64, {{"count", count}, {"list", list}});
        KernelTimings timings;
        list_.run(&timings);
        seconds = timings.at("select_lights").seconds;
    }
    uint32_t count_;
    Buffer nodes_, trails_;

  public:
    LightTree tree;
    double seconds = 0;
};

struct Setup {
    uint32_t infinite, finite, max_listed;
};
constexpr Setup setups[] = {{0, 1, 8}, {1, 0, 8},   {3, 0, 8},  {0, 2, 8},  {1, 1, 8},     {0, 8, 8},
                            {2, 7, 8}, {0, 13, 16}, {0, 10, 0}, {2, 30, 8}, {0, 10000, 8}, {1, 10000, 8}};

}  // namespace

TEST_CASE("light selection: lights are chosen as often as their stated probabilities say") {
    for (const Setup& setup : setups) {
        CAPTURE(setup.infinite);
        CAPTURE(setup.finite);
        const auto lights = test_lights(setup.infinite, setup.finite);
        for (glm::vec3 point :
             {glm::vec3(0.1f, -0.3f, -1.9f), glm::vec3(300, 500, 20), glm::vec3(lights.back().lo)}) {
            Selection selection(lights, setup.max_listed);
            const uint32_t count = 1 << 18;
            const auto probabilities = selection.probabilities({point});
            std::vector<double> observed(lights.size() + 1), expected(lights.size() + 1);
            double sum = 0, u_sum = 0, mismatch = 0, outside = 0;
            for (size_t i = 0; i < lights.size(); ++i)
                expected[i] = double(probabilities[i]) * count, sum += probabilities[i];
            // What is left leads to a part of the tree that turns out to send nothing.
            CHECK(sum <= 1 + 1e-5);
            expected.back() = sum > 1 - 1e-5 ? 0 : (1 - sum) * count;
            for (const Choice& c : selection.choose(point, count)) {
                u_sum += c.u;
                if (!(c.probability > 0)) {
                    observed.back() += 1;
                    continue;
                }
                if (c.light >= lights.size() || !(c.u >= 0.0f && c.u < 1.0f)) {
                    ++outside;
                    continue;
                }
                observed[c.light] += 1;
                mismatch = std::max(mismatch, std::abs(c.stated / double(c.probability) - 1));
            }
            CHECK(outside == 0);
            CHECK(mismatch < 1e-5);
            CHECK(chi_squared_test(observed, expected, 10).p_value >
                  sidak_level(false_alarm, 2 * 3 * std::size(setups)));
            // What is left of u stays uniform.
            CHECK(z_test(u_sum / count, 0.5, std::sqrt(1.0 / 12 / count), 1e-4) >
                  sidak_level(false_alarm, 2 * 3 * std::size(setups)));
        }
    }
}

TEST_CASE(
    "light selection: whatever light reaches a point can be chosen, and nothing is chosen where none does") {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (uint32_t finite : {6u, 200u, 3000u}) {
        const auto triangles = hall_triangles(finite);
        std::vector<LightBounds> lights;
        for (const Triangle& t : triangles) lights.push_back(bounds_of(t));
        std::vector<glm::vec3> points;
        for (int i = 0; i < 100; ++i)
            points.push_back(20.0f * glm::vec3(uniform(random), uniform(random), 0.1f * uniform(random)));
        // Right beside a light, in its plane and behind it.
        for (int i = 0; i < 100; ++i) {
            const Triangle& t = triangles[size_t(i) % triangles.size()];
            const glm::dvec3 side = glm::normalize(glm::cross(t.normal, glm::dvec3(0.3, 0.5, 0.8)));
            points.push_back(glm::vec3(t.center + 1e-3 * side + 1e-5 * (i % 3 - 1.0) * t.normal));
        }
        const auto probabilities = Selection(lights).probabilities(points);
        size_t missed = 0;
        for (size_t k = 0; k < points.size(); ++k) {
            for (uint32_t i = 0; i < finite; ++i) {
                const glm::dvec3 d = glm::dvec3(points[k]) - triangles[i].center;
                const double cosine = glm::dot(d, triangles[i].normal) / glm::length(d);
                if (cosine > 1e-4 && !(probabilities[k * finite + i] > 0.0f)) ++missed;
            }
        }
        CHECK(missed == 0);
    }
    // Behind the only two lights.
    const Triangle down{{0, 0, 1}, {0, 0, -1}, 1e-4};
    Selection two({bounds_of(down), bounds_of(down)});
    CHECK(two.choose({0, 0, 3}, 1)[0].probability == 0.0f);
}

TEST_CASE(
    "light selection: ten thousand triangles through a tree bring far less variance than by power alone") {
    const auto triangles = hall_triangles(10000);
    std::vector<LightBounds> lights;
    double power = 0;
    for (const Triangle& t : triangles) lights.push_back(bounds_of(t)), power += lights.back().power;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<glm::vec3> points;
    for (int i = 0; i < 64; ++i) points.push_back({20 * uniform(random), 20 * uniform(random), -2.2f});
    Selection selection(lights);
    const auto probabilities = selection.probabilities(points);
    const double probability_ns = selection.seconds * 1e9 / (64 * 10000.0);
    double log_ratio = 0, tree_relative = 0;
    for (size_t k = 0; k < points.size(); ++k) {
        // One sample's estimate is c / p: its variance is the sum of c²/p less the square of the sum of c.
        double sum = 0, by_tree = 0, by_power = 0;
        for (size_t i = 0; i < triangles.size(); ++i) {
            const glm::dvec3 d = glm::dvec3(points[k]) - triangles[i].center;
            const double d2 = glm::dot(d, d);
            const double c = triangles[i].area * std::max(0.0, glm::dot(triangles[i].normal, d)) *
                             std::max(0.0, -d.z) / (d2 * d2);
            if (c == 0) continue;
            sum += c;
            by_tree += c * c / probabilities[k * triangles.size() + i];
            by_power += c * c * power / lights[i].power;
        }
        log_ratio += std::log((by_power - sum * sum) / (by_tree - sum * sum)) / points.size();
        tree_relative += (by_tree / (sum * sum) - 1) / points.size();
    }
    selection.choose(points[0], 1 << 18);
    MESSAGE("variance by power / by tree: ", std::exp(log_ratio),
            " (geometric mean); the tree's relative variance ", tree_relative, "; depth ",
            selection.tree.depth, "; ", probability_ns, " ns a probability, ",
            selection.seconds * 1e9 / (1 << 18), " ns a choice with its probability");
    CHECK(std::exp(log_ratio) > 10);
    CHECK(tree_relative < 5);
}
