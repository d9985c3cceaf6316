// Every phase function, on the device: its sampler against its value. Classes come from the registry; one
// without parameters here fails. And free paths: where light scatters, and what is left of every lane.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/scene/records.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"
#include "tests/support/surface_probe.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr uint32_t sample_count = 1 << 18;

std::vector<json> configurations(const std::string& name) {
    if (name == "isotropic" || name == "rayleigh") return {json::object()};
    if (name == "henyey_greenstein") {
        std::vector<json> result;
        for (const double g : {0.0, 1e-4, 0.5, -0.5, 0.9, 0.99, -0.99, 0.999}) result.push_back({{"g", g}});
        return result;
    }
    return {};
}

// Bounds of cells in which 1 - |cosine| grows tenfold in twelve steps: narrow lobes on either side are
// resolved.
std::vector<double> cosine_bounds() {
    std::vector<double> bounds = {-1};
    for (int i = 0; i <= 96; ++i) bounds.push_back(-1 + std::pow(10.0, -8 + i / 12.0));
    for (int i = 96; i >= 0; --i) bounds.push_back(1 - std::pow(10.0, -8 + i / 12.0));
    bounds.push_back(1);
    std::sort(bounds.begin(), bounds.end());
    bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
    return bounds;
}

}  // namespace

TEST_CASE("phase functions: values integrate to one, samples follow them, and keep the mean cosine") {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    const std::vector<double> bounds = cosine_bounds();
    constexpr int points = 64;  // of the midpoint rule in a cell
    std::vector<float> cosines;
    for (size_t i = 0; i + 1 < bounds.size(); ++i)
        for (int k = 0; k < points; ++k)
            cosines.push_back(float(bounds[i] + (k + 0.5) / points * (bounds[i + 1] - bounds[i])));
    REQUIRE(cosines.size() < sample_count);
    const size_t used = cosines.size();
    cosines.resize(sample_count, 0);
    const Buffer in = create_buffer(test_device(), cosines, "Cosines");
    const Buffer samples(test_device(), sample_count * 4, "Samples"),
        values(test_device(), sample_count * 4, "Values");
    for (const ClassInfo& listed : registry.classes(Interface::phase)) {
        const ClassInfo* info = registry.find(Interface::phase, listed.name);
        const std::vector<json> parameters = configurations(listed.name);
        CHECK_MESSAGE(!parameters.empty(), listed.name, " has no configuration");
        const SceneDescription scene;
        RecordBuffer records;
        for (const json& p : parameters)
            records.add(*info, fill_record(*info, {listed.name, p, "/phase"}, {}, {scene, {}, {}, {}}));
        records.layout();
        const Buffer record_buffer = create_buffer(test_device(), records.bytes(), "PhaseRecords");
        const Kernel kernel = make_test_kernel(
            "sample_phase.comp", test_kernel_text("sample_phase.comp"),
            {{"Cosines", &in}, {"Samples", &samples}, {"Values", &values}, {"PhaseRecords", &record_buffer}},
            {{"generated/phase_classes.glsl", class_header(interface_info(Interface::phase), {info})}});
        for (uint32_t i = 0; i < parameters.size(); ++i) {
            CAPTURE(listed.name);
            CAPTURE(parameters[i].dump());
            CommandList commands(test_device());
            commands.dispatch(kernel, sample_count / 64,
                              {{"count", sample_count}, {"seed", 3u}, {"phase", records.ref(*info, i)}});
            commands.run();
            const auto drawn = samples.read_array<float>(sample_count),
                       value = values.read_array<float>(used);
            std::vector<double> expected(bounds.size() - 1), observed(bounds.size() - 1);
            double integral = 0, mean = 0;
            for (size_t k = 0; k < used; ++k) {
                CHECK(value[k] >= 0);
                const size_t cell = k / points;
                const double part =
                    2 * std::numbers::pi * value[k] * (bounds[cell + 1] - bounds[cell]) / points;
                expected[cell] += part, integral += part, mean += part * cosines[k];
            }
            CHECK(integral == doctest::Approx(1).epsilon(1e-3));
            mean /= integral;
            Moments sampled;
            for (const float c : drawn) {
                REQUIRE(std::fabs(c) <= 1);
                const auto above = std::upper_bound(bounds.begin(), bounds.end(), double(c));
                observed[std::min<size_t>(size_t(above - bounds.begin()) - 1, observed.size() - 1)]++;
                sampled.add(c);
            }
            // Cells that a cosine in single precision does not resolve count together, on either side.
            for (size_t k = 0; k < observed.size(); ++k) {
                const bool first = 1 + bounds[k + 1] < 1e-5, last = 1 - bounds[k] < 1e-5;
                if (!first && !last) continue;
                const size_t into = first ? 0 : observed.size() - 1;
                if (k == into) continue;
                observed[into] += observed[k], expected[into] += expected[k];
                observed[k] = expected[k] = 0;
            }
            for (double& e : expected) e *= sample_count / integral;
            const ChiSquared fit = chi_squared_test(observed, expected);
            CAPTURE(fit.statistic);
            CAPTURE(fit.degrees);
            CHECK(fit.p_value > sidak_level(1e-4, 10));
            CHECK(std::fabs(sampled.mean - mean) < 5 * sampled.standard_error() + 1e-4);
            if (parameters[i].contains("g"))
                CHECK(mean == doctest::Approx(parameters[i]["g"].get<double>()).epsilon(1e-3).scale(1));
        }
    }
}

namespace {

struct FreePaths {
    struct Path {
        float distance;
        uint32_t scatters;
        glm::vec3 weight;
        float passage;
    };
    Buffer paths{test_device(), uint64_t(1 << 20) * sizeof(Path), "Paths"};
    Kernel kernel = make_test_kernel("sample_free_path.comp", test_kernel_text("sample_free_path.comp"),
                                     {{"Paths", &paths}});
    std::vector<Path> sample(uint32_t count, uint32_t steps, glm::vec3 extinction, glm::vec3 scattering,
                             glm::vec3 carried, float distance) {
        CommandList commands(test_device());
        commands.dispatch(kernel, (count + 63) / 64,
                          {{"count", count},
                           {"seed", 11u},
                           {"steps", steps},
                           {"extinction_r", extinction.x},
                           {"extinction_g", extinction.y},
                           {"extinction_b", extinction.z},
                           {"scattering_r", scattering.x},
                           {"scattering_g", scattering.y},
                           {"scattering_b", scattering.z},
                           {"carried_r", carried.x},
                           {"carried_g", carried.y},
                           {"carried_b", carried.z},
                           {"distance", distance}});
        commands.run();
        return paths.read_array<Path>(count);
    }
};

}  // namespace

TEST_CASE("free paths: of every lane what Beer and Lambert say is left, and scatters in every layer") {
    FreePaths probe;
    constexpr uint32_t count = 1 << 20, layers = 16;
    const glm::vec3 extinction(0.3f, 2, 8), scattering(0.3f, 1.5f, 2), carried(0.7f, 0.2f, 1.1f);
    constexpr float distance = 1.5f;
    const auto paths = probe.sample(count, 0, extinction, scattering, carried, distance);
    double share[3], worst = 0;
    for (int c = 0; c < 3; ++c) share[c] = carried[c] / double(carried.x + carried.y + carried.z);
    std::vector<double> observed(layers + 1), expected(layers + 1);
    Moments scattered[3][layers], passed[3];
    for (const auto& p : paths) {
        const uint32_t layer =
            p.scatters ? std::min(layers - 1, uint32_t(p.distance / distance * layers)) : layers;
        REQUIRE(p.distance <= distance);
        observed[layer]++;
        double sum = 0, left = 0;
        const double luminance[3] = {0.2126, 0.7152, 0.0722};
        for (int c = 0; c < 3; ++c) {
            for (uint32_t k = 0; k < layers; ++k) scattered[c][k].add(k == layer ? p.weight[c] : 0);
            passed[c].add(layer == layers ? p.weight[c] : 0);
            sum += share[c] * p.weight[c];
            left += luminance[c] * std::exp(-double(extinction[c]) * p.distance);
        }
        worst = std::max(worst, sum);
        CHECK(p.passage == doctest::Approx(left).epsilon(1e-5));
    }
    CHECK(worst < 1 + 1e-5);  // what the lanes carry together never grows
    const auto left = [&](int c, uint32_t k) {
        return std::exp(-double(extinction[c]) * distance * k / layers);
    };
    for (int c = 0; c < 3; ++c) {
        CHECK(std::fabs(passed[c].mean - left(c, layers)) < 5 * passed[c].standard_error());
        for (uint32_t k = 0; k < layers; ++k) {
            const double part = left(c, k) - left(c, k + 1);
            expected[k] += count * share[c] * part;
            CHECK(std::fabs(scattered[c][k].mean - part * scattering[c] / extinction[c]) <
                  5 * scattered[c][k].standard_error());
        }
        expected[layers] += count * share[c] * left(c, layers);
    }
    CHECK(chi_squared_test(observed, expected).p_value > 1e-4);
}

TEST_CASE("free paths: thin media scatter as seldom as they should, thick ones at once") {
    FreePaths probe;
    // Of 2^24 values of the second number, 1e-6 * 2^24 = 16.777 lead to an event: 16 of the first 17 and a
    // part of the last.
    constexpr uint32_t steps = 17, count = steps << 15;
    size_t events = 0;
    for (const auto& p : probe.sample(count, steps, glm::vec3(1e-6f), glm::vec3(1e-6f), glm::vec3(1), 1))
        events += p.scatters;
    CHECK(std::fabs(double(events) / count * steps - 16.777216) <
          5 * std::sqrt(0.777 * 0.223 / (count / steps)));
    // A lane that nothing happens to, one that passes nothing.
    for (const auto& p : probe.sample(4096, 0, {0, 1e4f, 1e4f}, {0, 9999, 1e4f}, {0, 1, 1}, 1)) {
        CHECK(p.scatters == 1);
        CHECK(p.distance < 2e-3f);
        CHECK(p.weight.y == doctest::Approx(0.9999).epsilon(1e-5));
    }
    for (const auto& p : probe.sample(4096, 0, {0, 1e4f, 1e4f}, {0, 9999, 1e4f}, {1, 0, 0}, 1)) {
        CHECK(p.scatters == 0);
        CHECK(p.weight.x == doctest::Approx(1));
    }
}
