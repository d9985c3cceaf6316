// Every phase function, on the device: its sampler against its value, and what it does to polarization.
// Classes come from the registry; one without parameters in tests/support/phase_probe.cpp fails.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/contracts/mueller_frames.h"
#include "tests/support/phase_probe.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;
using glm::dvec3, glm::dmat4;
using nlohmann::json;

namespace {

constexpr uint32_t sample_count = 1 << 18;

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

ClassRegistry phase_registry() {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    return ClassRegistry(sources);
}

void check_phases(ClassRegistry& registry, const std::string& name, const std::vector<json>& parameters,
                  std::optional<glm::vec4> nm = {}) {
    const std::vector<double> bounds = cosine_bounds();
    constexpr int points = 64;  // of the midpoint rule in a cell
    std::vector<float> cosines;
    for (size_t i = 0; i + 1 < bounds.size(); ++i)
        for (int k = 0; k < points; ++k)
            cosines.push_back(float(bounds[i] + (k + 0.5) / points * (bounds[i + 1] - bounds[i])));
    PhaseProbe probe(registry, name, parameters, nm);
    for (size_t record = 0; record < parameters.size(); ++record) {
        CAPTURE(name);
        CAPTURE(parameters[record].dump());
        const auto drawn = probe.draw(record, sample_count, 3);
        const auto values = probe.values(record, cosines);
        std::vector<double> expected(bounds.size() - 1), observed(bounds.size() - 1);
        std::vector<double> integrals(size_t(probe.lanes()));
        double integral = 0, mean = 0;
        for (size_t k = 0; k < cosines.size(); ++k) {
            const size_t cell = k / points;
            const double width = 2 * std::numbers::pi * (bounds[cell + 1] - bounds[cell]) / points;
            double part = 0;
            for (size_t lane = 0; lane < integrals.size(); ++lane) {
                CHECK(values[k][lane] >= 0);
                integrals[lane] += width * values[k][lane];
                part += width * values[k][lane] / probe.lanes();
            }
            expected[cell] += part, integral += part, mean += part * cosines[k];
        }
        for (const double lane : integrals) CHECK(lane == doctest::Approx(1).epsilon(1e-3));
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
        if (parameters[record].contains("g"))
            CHECK(mean == doctest::Approx(parameters[record]["g"].get<double>()).epsilon(1e-3).scale(1));
    }
}

}  // namespace

TEST_CASE("phase functions: values integrate to one, samples follow them, and keep the mean cosine") {
    ClassRegistry registry = phase_registry();
    for (const ClassInfo& listed : registry.classes(Interface::phase)) {
        const std::vector<json> parameters = phase_configurations(listed.name);
        CHECK_MESSAGE(!parameters.empty(), listed.name, " has no configuration");
        check_phases(registry, listed.name, parameters);
    }
    // In wavelengths: at the table's ends, at one of its points, and between two.
    check_phases(registry, "mie", {{{"radius", 1e-6}, {"variance", 0.1}}}, glm::vec4(360, 829.5, 560, 611));
}

TEST_CASE("spheres: values and matrices are those computed for that wavelength") {
    ClassRegistry registry = phase_registry();
    const std::vector<json> parameters = phase_configurations("mie");
    const glm::vec4 nm(460, 500, 560, 640);  // of the table
    PhaseProbe probe(registry, "mie", parameters, nm);
    std::vector<float> cosines{1, -1, 0};
    for (int i = 1; i < 60; ++i) cosines.push_back(float(std::cos(i * std::numbers::pi / 60)));
    for (size_t record = 0; record < parameters.size(); ++record) {
        CAPTURE(parameters[record].dump());
        const MieParameters p = mie_parameters(parameters[record]);
        const auto values = probe.values(record, cosines);
        double worst = 0;
        for (size_t i = 0; i < cosines.size(); ++i)
            for (int lane = 0; lane < 4; ++lane) {
                const double expected = direct_mie_elements(p, nm[lane], cosines[i]).s11;
                worst = std::max(worst, std::abs(values[i][size_t(lane)] / expected - 1));
            }
        CHECK(worst < 0.05);
    }
    // In colours, of the wavelengths that the channels have then: 611, 549 and 464 nm, between those of the
    // table.
    PhaseProbe colors(registry, "mie", parameters);
    for (const size_t record : {size_t(0), size_t(2)}) {
        CAPTURE(parameters[record].dump());
        const MieParameters p = mie_parameters(parameters[record]);
        std::vector<MuellerQuery> queries;
        for (int i = 1; i < 60; ++i)
            queries.push_back({{0, 0, -1}, direction(i * std::numbers::pi / 60, 0.3), 0});
        const auto answers = colors.polarize(record, queries);
        const double channels[] = {611, 549, 464};
        for (size_t i = 0; i < queries.size(); ++i)
            for (int lane = 0; lane < 3; ++lane) {
                CAPTURE(i);
                const dvec3 to = queries[i].to, across = glm::normalize(glm::cross(dvec3(0, 0, 1), to));
                const dmat4 m = rotator(answers[i].to, across, to) * matrix(answers[i], lane) *
                                rotator(across, answers[i].from, {0, 0, 1});
                const MieElements e = direct_mie_elements(p, channels[lane], to.z);
                const auto near = [](double x) { return doctest::Approx(x).scale(1).epsilon(0.02); };
                CHECK(m[1][0] == near(e.b / e.s11));
                CHECK(m[0][1] == near(e.b / e.s11));
                CHECK(m[1][1] == near(1));
                CHECK(m[2][2] == near(e.c / e.s11));
                CHECK(m[3][3] == near(e.c / e.s11));
                CHECK(m[2][3] == near(e.d / e.s11));
                CHECK(m[3][2] == near(-e.d / e.s11));
            }
    }
}

TEST_CASE("no phase function makes more polarization than there is light; back and mirrored light fits") {
    ClassRegistry registry = phase_registry();
    uint32_t state = 1;
    const auto random = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / 16777216.0; };
    const auto any = [&] { return direction(std::acos(2 * random() - 1), 2 * std::numbers::pi * random()); };
    for (const ClassInfo& listed : registry.classes(Interface::phase)) {
        const std::vector<json> parameters = phase_configurations(listed.name);
        PhaseProbe probe(registry, listed.name, parameters);
        std::vector<MuellerQuery> there, back, mirrored;
        for (int i = 0; i < 500; ++i) {
            const dvec3 from = any(), to = any(), flipped(1, 1, -1);
            there.push_back({from, to, 0}), back.push_back({to, from, 0});
            mirrored.push_back({from * flipped, to * flipped, 0});
        }
        for (size_t record = 0; record < parameters.size(); ++record) {
            const auto forth = probe.polarize(record, there), reversed = probe.polarize(record, back),
                       mirror = probe.polarize(record, mirrored);
            INFO(listed.name, " ", parameters[record].dump());
            double most = 0, irreversible = 0, crooked = 0;
            const dmat4 turned_back = glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
            const dmat4 seen_mirrored = glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1);
            for (size_t i = 0; i < there.size(); ++i)
                for (int lane = 0; lane < 3; ++lane) {
                    const dvec3 from = there[i].from, to = there[i].to;
                    const dmat4 m = matrix(forth[i], lane);
                    const glm::dvec4 out = m * glm::dvec4(1, any());
                    most = std::max(most, glm::length(dvec3(out.y, out.z, out.w)) - out.x);
                    const auto apart = [&](const dmat4& a, const dmat4& b) {
                        double d = 0;
                        for (int k = 0; k < 4; ++k) d = std::max(d, glm::length(a[k] - b[k]));
                        return d;
                    };
                    const dmat4 found = rotator(reversed[i].to, forth[i].from, from) *
                                        matrix(reversed[i], lane) *
                                        rotator(forth[i].to, reversed[i].from, -to);
                    irreversible =
                        std::max(irreversible, apart(turned_back * glm::transpose(m) * turned_back, found));
                    // With the axes of the mirror image.
                    const dvec3 flipped(1, 1, -1);
                    const dmat4 image =
                        rotator(mirror[i].to, dvec3(forth[i].to) * flipped, to * flipped) *
                        matrix(mirror[i], lane) *
                        rotator(dvec3(forth[i].from) * flipped, mirror[i].from, -from * flipped);
                    crooked = std::max(crooked, apart(seen_mirrored * m * seen_mirrored, image));
                }
            CHECK(most < 1e-5);
            CHECK(irreversible < 1e-3);
            CHECK(crooked < 1e-3);
        }
    }
}
