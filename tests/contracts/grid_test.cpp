// Media whose density varies: free paths and transmittance along rays against the integrals, whatever the
// lanes carry.
#include <algorithm>
#include <cmath>

#include "host/scene/scene.h"
#include "tests/support/density_field.h"
#include "tests/support/render_probe.h"
#include "tests/support/statistics.h"
#include "tests/support/surface_probe.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr uint32_t count = 1 << 18, layers = 24;

struct Track {
    float distance;
    uint32_t scatters;
    glm::vec3 weight;
    float passage;
    glm::vec3 transmittance;
    float mean;
};

struct Coefficients {
    glm::dvec3 absorption, scattering, carried;
};
const Coefficients grey = {glm::dvec3(0.5), glm::dvec3(1.5), glm::dvec3(1)};
const Coefficients coloured = {{0.1, 0.6, 2}, {0.3, 1.5, 4}, {0.7, 0.2, 1.1}};

json rgb(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// One medium of the class, filled with the field; the scene is a sphere around it, whose centre is not the
// origin.
struct TrackingProbe {
    TemporaryFolder folder;
    Scene scene;
    Kernel kernel;
    Buffer tracks{test_device(), uint64_t(count) * sizeof(Track), "Tracks"};

    TrackingProbe(const DensityField& field, const Coefficients& c, json file = "field.nrrd") {
        field.write(folder / "field.nrrd");
        SceneBuilder s;
        s.medium("cloud", {{"class", "grid"},
                           {"file", file},
                           {"density", 0.5},
                           {"absorption", rgb(2.0 * c.absorption)},
                           {"scattering", rgb(2.0 * c.scattering)}});
        s.sphere(4, s.material({{"surface", {{"class", "boundary"}}}, {"inside", "cloud"}}), at(1, 2, 3));
        scene = compile_test_scene(s.import(folder / "scene.gltf"));
        scene.sources.generated["track_medium.comp"] = test_kernel_text("track_medium.comp");
        kernel = make_kernel(test_device(), scene, "track_medium.comp", {{"Tracks", &tracks}});
    }

    std::vector<Track> run(glm::dvec3 from, glm::dvec3 direction, double distance, glm::dvec3 carried,
                           uint32_t count = ::count) {
        const glm::vec3 o = from - scene.center, d = direction, w = carried;
        CommandList commands(test_device());
        commands.dispatch(kernel, count / 64,
                          {{"count", count},
                           {"seed", 5u},
                           {"medium", record_ref(2, 0)},
                           {"x", o.x},
                           {"y", o.y},
                           {"z", o.z},
                           {"dx", d.x},
                           {"dy", d.y},
                           {"dz", d.z},
                           {"distance", float(distance)},
                           {"carried_r", w.x},
                           {"carried_g", w.y},
                           {"carried_b", w.z}});
        commands.run();
        return tracks.read_array<Track>(count);
    }
};

struct Ray {
    glm::dvec3 from, to;
    glm::dvec3 direction() const { return glm::normalize(to - from); }
    double length() const { return glm::length(to - from); }
};

// Column of density to the ends of so many equal layers of the ray, m, by the midpoint rule.
std::vector<double> columns(const DensityField& field, const Ray& ray) {
    constexpr int steps = 2000;
    std::vector<double> result(layers + 1, 0.0);
    const double step = ray.length() / (layers * steps);
    for (uint32_t k = 0; k < layers; ++k) {
        result[k + 1] = result[k];
        for (int i = 0; i < steps; ++i)
            result[k + 1] += step * field.at(ray.from + ray.direction() * (step * (k * steps + i + 0.5)));
    }
    return result;
}

void check_tracks(const DensityField& field, const Coefficients& c, const Ray& ray,
                  json file = "field.nrrd") {
    TrackingProbe probe(field, c, file);
    const auto tracks = probe.run(ray.from, ray.direction(), ray.length(), c.carried);
    const std::vector<double> column = columns(field, ray);
    const glm::dvec3 extinction = c.absorption + c.scattering;
    const auto left = [&](int lane, uint32_t k) { return std::exp(-extinction[lane] * column[k]); };
    const double carried_sum = c.carried.x + c.carried.y + c.carried.z;
    std::vector<double> observed(layers + 1);
    std::vector<Moments> scattered(3 * layers);
    Moments passed[3], transmitted[3];
    double most = 0;
    std::pair<float, float> mean{1e30f, 0};
    for (const Track& t : tracks) {
        REQUIRE(t.distance <= float(ray.length()));
        const uint32_t layer =
            t.scatters ? std::min(layers - 1, uint32_t(t.distance / ray.length() * layers)) : layers;
        observed[layer]++;
        double sum = 0;
        for (int lane = 0; lane < 3; ++lane) {
            for (uint32_t k = 0; k < layers; ++k)
                scattered[3 * k + lane].add(k == layer ? t.weight[lane] : 0);
            passed[lane].add(layer == layers ? t.weight[lane] : 0);
            transmitted[lane].add(t.transmittance[lane]);
            sum += c.carried[lane] * t.weight[lane] / carried_sum;
        }
        most = std::max(most, sum);
        if (t.transmittance != glm::vec3(0))  // else nobody asks
            mean.first = std::min(mean.first, t.mean), mean.second = std::max(mean.second, t.mean);
    }
    CHECK(mean.second < mean.first * (1 + 1e-5f));  // whatever the seed
    CHECK(most < 1 + 1e-4);                         // what the lanes carry together never grows
    const double limit = sidak_level(1e-4, 3 * layers + 6);
    for (int lane = 0; lane < 3; ++lane) {
        CAPTURE(lane);
        CAPTURE(left(lane, layers));
        CHECK(z_test(passed[lane].mean, left(lane, layers), passed[lane].standard_error(), 2e-5) > limit);
        CHECK(z_test(transmitted[lane].mean, left(lane, layers), transmitted[lane].standard_error(), 2e-5) >
              limit);
        CHECK(transmitted[lane].standard_error() < 0.002);
        for (uint32_t k = 0; k < layers; ++k) {
            const double part = (left(lane, k) - left(lane, k + 1)) * c.scattering[lane] / extinction[lane];
            const Moments& m = scattered[3 * k + lane];
            CAPTURE(k);
            CAPTURE(m.mean);
            CAPTURE(part);
            if (part == 0)
                CHECK(m.mean == 0);
            else
                CHECK(z_test(m.mean, part, m.standard_error(), 2e-5) > limit);
        }
    }
    if (extinction.x != extinction.y) return;
    std::vector<double> expected;  // where lanes are alike they collide as light does
    for (uint32_t k = 0; k < layers; ++k) expected.push_back(count * (left(0, k) - left(0, k + 1)));
    expected.push_back(count * left(0, layers));
    const ChiSquared fit = chi_squared_test(observed, expected);
    CAPTURE(fit.statistic);
    CHECK(fit.p_value > 1e-4);
}

// A ramp along x, exact between the points.
DensityField ramp() {
    return {{3, 2, 12}, {-1, -1, 2}, {1, 1, 4}, [](glm::dvec3 p) { return 1.0 + p.x; }};
}

// Hills, with empty bricks between them, an even one, and sizes that end within a brick.
DensityField hills() {
    return {{20, 33, 18}, {-1, -1, 2}, {1, 2, 4}, [](glm::dvec3 p) {
                if (p.y > 1.1) return 1.5;
                const double h = std::sin(5 * p.x + 1) + std::sin(7 * p.y) + std::cos(6 * p.z) - 0.6;
                return h > 0 ? 2 * h : 0.0;
            }};
}

}  // namespace

TEST_CASE("grid media: free paths and transmittance along a ramp of density") {
    const Ray along{{-0.9, 0.2, 3}, {0.95, 0.2, 3}}, slanted{{1.5, -1.2, 1.7}, {-1.5, 1.3, 4.3}};
    check_tracks(ramp(), grey, along);
    check_tracks(ramp(), coloured, slanted);
}

TEST_CASE("grid media: free paths and transmittance through hills and empty bricks") {
    const Ray across{{-2, -1.5, 1.6}, {1.4, 2.5, 4.2}}, back{{0.7, 1.9, 2.1}, {-0.6, -0.9, 3.8}},
        on_a_face{{-1.5, 0.5, 2.9411764}, {1.5, 0.5, 2.9411764}};
    check_tracks(hills(), grey, across);
    check_tracks(hills(), coloured, across);
    check_tracks(hills(), coloured, back);
    check_tracks(hills(), coloured, on_a_face);
}

TEST_CASE("grid media stand where their placement says") {
    // A quarter turn about z, then twice as large, then moved: the ray of the file's frame goes along.
    const Ray in_file{{-0.9, -0.7, 2.2}, {0.8, 0.9, 3.7}};
    const json file = {{"name", "field.nrrd"},
                       {"translation", {0.5, 1, 2}},
                       {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
                       {"scale", {0.5, 0.5, 0.5}}};
    const auto placed = [](glm::dvec3 p) { return 0.5 * glm::dvec3(-p.y, p.x, p.z) + glm::dvec3(0.5, 1, 2); };
    const DensityField field = hills();
    TrackingProbe probe(field, coloured, file);
    const Ray ray{placed(in_file.from), placed(in_file.to)};
    const auto tracks = probe.run(ray.from, ray.direction(), ray.length(), coloured.carried);
    const double column = 0.5 * columns(field, in_file).back();
    for (int lane = 0; lane < 3; ++lane) {
        Moments m;
        for (const Track& t : tracks) m.add(t.transmittance[lane]);
        CHECK(z_test(m.mean, std::exp(-column * (coloured.absorption + coloured.scattering)[lane]),
                     m.standard_error(), 2e-5) > 1e-4);
    }
}

TEST_CASE("grid media: weights' passage is the same both ways, and near the transmittance") {
    const DensityField field = hills();
    TrackingProbe probe(field, grey);
    const Ray ray{{-2, -1.5, 1.6}, {1.4, 2.5, 4.2}};
    const auto mean = [&](const glm::dvec3& from, const glm::dvec3& direction) {
        for (const Track& t : probe.run(from, direction, ray.length(), grey.carried))
            if (t.transmittance != glm::vec3(0)) return double(t.mean);
        return 0.0;
    };
    const double there = mean(ray.from, ray.direction()), back = mean(ray.to, -ray.direction());
    CHECK(there == doctest::Approx(back).epsilon(1e-4));
    CHECK(there == doctest::Approx(std::exp(-2 * columns(field, ray).back())).epsilon(0.5));
}

TEST_CASE("grid media: where density is even, free paths are those of a homogeneous medium") {
    const DensityField even({9, 9, 9}, {-1, -1, 2}, {1, 1, 4}, [](glm::dvec3) { return 1.0; });
    TrackingProbe probe(even, grey);
    for (const Track& t : probe.run({0, 0, 2.5}, {0, 0, 1}, 1, grey.carried)) {
        CHECK(t.transmittance.x == doctest::Approx(std::exp(-2.0)).epsilon(1e-5));
        CHECK(t.mean == doctest::Approx(std::exp(-2.0)).epsilon(1e-5));
        CHECK(t.weight.x == doctest::Approx(t.scatters ? 0.75 : 1.0).epsilon(1e-5));
        CHECK(t.passage == doctest::Approx(std::exp(-2.0 * t.distance)).epsilon(1e-5));
    }
}

TEST_CASE("grid media: thin ones scatter as seldom as they should, thick ones pass nothing and end soon") {
    const DensityField field = hills();
    const Ray ray{{-2, -1.5, 1.6}, {1.4, 2.5, 4.2}};
    const double column = columns(field, ray).back();
    {
        TrackingProbe probe(field, {glm::dvec3(0), glm::dvec3(1e-4), glm::dvec3(1)});
        double events = 0;
        Moments transmitted;
        for (const Track& t : probe.run(ray.from, ray.direction(), ray.length(), glm::dvec3(1))) {
            events += t.scatters;
            transmitted.add(t.transmittance.x);
        }
        const double expected = count * 1e-4 * column;
        CHECK(std::fabs(events - expected) < 4 * std::sqrt(expected));
        CHECK(z_test(transmitted.mean, 1 - 1e-4 * column, transmitted.standard_error(), 1e-7) > 1e-4);
    }
    // A free path and a shadow ray take 7 turns of a loop per 1/m: all that there are on a device that ends loops after 65535.
    TrackingProbe probe(field, {glm::dvec3(0), glm::dvec3(3e3), glm::dvec3(1)});
    for (const Track& t : probe.run(ray.from, ray.direction(), ray.length(), glm::dvec3(1), 4096)) {
        CHECK(t.scatters == 1);
        CHECK(t.weight.x == doctest::Approx(1).epsilon(1e-4));
        CHECK(t.transmittance.x < 1e-6f);
        CHECK(t.passage > 0);
    }
}
