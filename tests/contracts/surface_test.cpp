// Every class of surface, on the device: its sampler against its density, its weights against its values,
// energy, reciprocity and the relation of the two transport directions. Classes come from the registry; one
// without a configuration in surface_configurations.h fails.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include "tests/contracts/surface_configurations.h"
#include "tests/support/source_path.h"
#include "tests/support/sphere_cells.h"
#include "tests/support/statistics.h"
#include "tests/support/surface_probe.h"

using namespace etendue;

namespace {

constexpr double false_alarm = 1e-4;  // of each test case as a whole
constexpr uint32_t pilot_count = 16384, sample_count = 65536;
constexpr double quadrature_tolerance = 1e-6;  // of the integral over a cell

glm::vec3 direction(double cosine, double azimuth) {
    const double s = std::sqrt((1 - cosine) * (1 + cosine));
    return glm::vec3(s * std::cos(azimuth), s * std::sin(azimuth), cosine);
}

const std::vector<glm::vec3>& outgoing_directions() {
    static const std::vector<glm::vec3> result = {direction(1, 0),       direction(0.7, 1.2),
                                                  direction(0.25, 2.0),  direction(0.02, 1.0),
                                                  direction(-0.85, 4.2), direction(-0.3, 1.9)};
    return result;
}

// Everything measured for one surface, one wo, one transport direction.
struct Measurement {
    std::string label;
    const SurfaceConfiguration* configuration;
    glm::vec3 wo;
    SurfaceSurroundings at;
    bool is_delta, is_opaque;
    size_t bad_values = 0;                           // not finite, or negative
    double density = 0;                              // integral of pdf
    double discrete = 0;                             // probabilities of the delta directions
    double absorbed = 0;                             // part of the samples with no direction
    ChiSquared fit;                                  // of the samples over the cells
    glm::dvec3 albedo{0};                            // power, by quadrature of evaluate and the delta weights
    glm::dvec3 sampled_albedo{0}, sampled_error{0};  // mean weight as power, its standard error
    glm::dvec3 straight{0}, transparency{0};
    bool quadrature_of_zero = true;  // no value was above zero
};

// What radiance is to be multiplied with to become power.
double power_scale(const SurfaceSurroundings& at, glm::vec3 wo, glm::vec3 wi) {
    if (at.importance || wo.z * wi.z > 0) return 1;
    const double eta = wo.z > 0 ? double(at.ior_below) / at.ior_above : double(at.ior_above) / at.ior_below;
    return eta * eta;
}

bool acceptable(float x) { return std::isfinite(x) && x >= 0; }
bool acceptable(glm::vec3 x) { return acceptable(x.x) && acceptable(x.y) && acceptable(x.z); }

double relative_difference(double a, double b) {
    return std::abs(a - b) / std::max({std::abs(a), std::abs(b), 1e-12});
}

double high_quantile(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto at = values.begin() + ptrdiff_t(double(values.size() - 1) * 0.999);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// A direction that samples take with a probability of its own.
struct DeltaDirection {
    glm::vec3 wi;
    uint32_t event;
    double probability;
    glm::dvec3 weight;
    double samples = 0;
};

DeltaDirection& delta_of(std::vector<DeltaDirection>& found, const SurfaceSample& s) {
    for (DeltaDirection& d : found)
        if (d.event == s.event && glm::distance(d.wi, s.wi) < 1e-3f) return d;
    return found.emplace_back(s.wi, s.event, s.pdf, s.weight);
}

void count_samples(Measurement& m, const SurfaceSamples& drawn, const SphereCells& cells,
                   const std::vector<glm::dvec4>& integrals) {
    std::vector<double> observed(cells.size(), 0), expected(cells.size(), 0);
    std::vector<DeltaDirection> deltas;
    for (uint32_t i = 0; i < pilot_count; ++i)
        if (drawn.samples[i].event & event_delta) delta_of(deltas, drawn.samples[i]);
    Moments power[3];
    size_t absorbed = 0;
    // What goes straight on is not refracted: radiance and power are the same.
    const auto scale_of = [&](uint32_t event, glm::vec3 wi) {
        return event & event_straight ? 1 : power_scale(m.at, m.wo, wi);
    };
    for (uint32_t i = pilot_count; i < drawn.samples.size(); ++i) {
        const SurfaceSample& s = drawn.samples[i];
        if (!acceptable(s.weight) || !acceptable(s.pdf)) m.bad_values++;
        for (int k = 0; k < 3; ++k) power[k].add(s.event ? scale_of(s.event, s.wi) * s.weight[k] : 0);
        if (!s.event)
            absorbed++;
        else if (s.event & event_delta)
            delta_of(deltas, s).samples++;
        else
            observed[cells.find(s.wi)]++;
    }
    const double n = double(drawn.samples.size() - pilot_count);
    m.absorbed = double(absorbed) / n;
    for (int k = 0; k < 3; ++k)
        m.sampled_albedo[k] = power[k].mean, m.sampled_error[k] = power[k].standard_error();
    for (size_t i = 0; i < cells.size(); ++i) expected[i] = integrals[i].w, m.density += integrals[i].w;
    for (const DeltaDirection& d : deltas) {
        observed.push_back(d.samples), expected.push_back(d.probability);
        m.discrete += d.probability;
        m.albedo += d.weight * d.probability * scale_of(d.event, d.wi);
        if (d.event & event_straight) m.straight += d.weight * d.probability;
    }
    for (double& e : expected) e *= (n - double(absorbed)) / std::max(m.density + m.discrete, 1e-12);
    // A cell without density may hold as much as the quadrature can overlook.
    for (size_t i = 0; i < cells.size(); ++i) expected[i] += n * quadrature_tolerance;
    m.fit = chi_squared_test(observed, expected);
}

Measurement measure(SurfaceProbe& probe, size_t record, const SurfaceConfiguration& configuration,
                    const std::string& name, glm::vec3 wo, bool importance) {
    Measurement m;
    m.label = fmt::format("{}, {}, wo.z {:.2g}, {}", name, configuration.label, wo.z,
                          importance ? "power" : "radiance");
    m.configuration = &configuration;
    m.wo = wo;
    m.at = {configuration.ior_above, configuration.ior_below, importance};
    const SurfaceSamples drawn = probe.sample(record, m.at, wo, pilot_count + sample_count, 7);
    m.is_delta = drawn.is_delta;
    m.is_opaque = drawn.is_opaque;
    m.transparency = drawn.transparency;
    std::vector<glm::vec3> pilot;
    for (uint32_t i = 0; i < pilot_count; ++i)
        if (drawn.samples[i].event && !(drawn.samples[i].event & event_delta))
            pilot.push_back(drawn.samples[i].wi);
    const SphereCells cells(pilot, pilot_count, configuration.width < 0.05 ? 24 : 128);
    const auto integrals = cells.integrate(
        [&](std::span<const glm::vec3> wis) {
            std::vector<DirectionPair> pairs;
            for (glm::vec3 wi : wis) pairs.push_back({wo, wi});
            std::vector<glm::vec4> result;
            for (const SurfaceValue& v : probe.evaluate(record, m.at, pairs)) {
                if (!acceptable(v.f_cos) || !acceptable(v.pdf) || !acceptable(v.pdf_reverse)) m.bad_values++;
                if (v.f_cos != glm::vec3(0)) m.quadrature_of_zero = false;
                result.push_back(glm::vec4(v.f_cos, v.pdf));
            }
            return result;
        },
        quadrature_tolerance);
    for (size_t i = 0; i < cells.size(); ++i)
        m.albedo +=
            glm::dvec3(integrals[i]) * power_scale(m.at, wo, glm::vec3(0, 0, cells[i].above() ? 1 : -1));
    count_samples(m, drawn, cells, integrals);
    return m;
}

ClassRegistry& registry() {
    static ClassRegistry result = [] {
        ShaderSources sources;
        sources.folder = source_path("shaders");
        return ClassRegistry(sources);
    }();
    return result;
}

struct TestedClass {
    std::string name;
    std::vector<SurfaceConfiguration> configurations;
    std::unique_ptr<SurfaceProbe> probe;
};

std::vector<TestedClass>& tested_classes() {
    static std::vector<TestedClass> result = [] {
        std::vector<TestedClass> classes;
        for (const ClassInfo& info : registry().classes(Interface::surface)) {
            TestedClass c{info.name, surface_configurations(info.name), nullptr};
            if (c.configurations.empty()) continue;
            std::vector<nlohmann::json> parameters;
            for (const auto& configuration : c.configurations) parameters.push_back(configuration.parameters);
            c.probe = std::make_unique<SurfaceProbe>(registry(), c.name, parameters);
            classes.push_back(std::move(c));
        }
        return classes;
    }();
    return result;
}

// Measured once, looked at by every test case.
const std::vector<Measurement>& measurements() {
    static const std::vector<Measurement> result = [] {
        std::vector<Measurement> all;
        for (TestedClass& c : tested_classes())
            for (size_t i = 0; i < c.configurations.size(); ++i)
                for (glm::vec3 wo : outgoing_directions())
                    for (const bool importance : {false, true})
                        all.push_back(measure(*c.probe, i, c.configurations[i], c.name, wo, importance));
        return all;
    }();
    return result;
}

// How well values computed in single precision from directions agree: directions are off by some 1e-7, lobes
// turn that into a relative error by their width.
double rounding_tolerance(const SurfaceConfiguration& c) { return 2e-4 + 1e-5 / c.width; }

}  // namespace

TEST_CASE("every registered surface class has a test configuration") {
    for (const ClassInfo& info : registry().classes(Interface::surface)) {
        INFO(info.name);
        CHECK(!surface_configurations(info.name).empty());
    }
}

TEST_CASE("surface values, weights and pdfs are finite and not negative") {
    for (const Measurement& m : measurements()) {
        INFO(m.label);
        CHECK(m.bad_values == 0);
    }
}

TEST_CASE("surface samples are distributed as their pdf says") {
    const double level = sidak_level(false_alarm, measurements().size());
    for (const Measurement& m : measurements()) {
        INFO(m.label, ": chi-squared ", m.fit.statistic, " of ", m.fit.degrees);
        CHECK(m.fit.p_value > level);
    }
}

TEST_CASE("surface pdfs integrate to one, less what is absorbed and what goes into delta directions") {
    const double level = sidak_level(false_alarm, measurements().size());
    for (const Measurement& m : measurements()) {
        const double a = m.absorbed, error = std::sqrt(std::max(a * (1 - a), 1e-6) / sample_count);
        INFO(m.label, ": density ", m.density, ", discrete ", m.discrete, ", absorbed ", a);
        CHECK(m.density + m.discrete < 1.001);
        CHECK(z_test(a, 1 - m.density - m.discrete, error, 1e-3) > level);
    }
}

TEST_CASE("no surface sends out more power than reaches it") {
    for (const Measurement& m : measurements()) {
        // Tables say what arrives from all directions where a receiver is, and little of what one direction
        // sends.
        if (m.at.importance && !m.configuration->is_reciprocal) continue;
        INFO(m.label, ": ", m.albedo.x, " ", m.albedo.y, " ", m.albedo.z);
        const double limit =
            1 +
            std::max(5e-4, m.configuration->albedo.value_or(0) == 1 ? m.configuration->albedo_tolerance : 0);
        CHECK(std::max({m.albedo.x, m.albedo.y, m.albedo.z}) < limit);
    }
}

TEST_CASE("the mean weight of surface samples is the directional albedo found by quadrature") {
    const double level = sidak_level(false_alarm, 3 * measurements().size());
    for (const Measurement& m : measurements())
        for (int k = 0; k < 3; ++k) {
            INFO(m.label, ": ", m.sampled_albedo[k], " +- ", m.sampled_error[k], ", quadrature ",
                 m.albedo[k]);
            CHECK(z_test(m.sampled_albedo[k], m.albedo[k], m.sampled_error[k], 1e-3 * m.albedo[k] + 1e-6) >
                  level);
        }
}

TEST_CASE("surfaces of known albedo have it in every direction") {
    for (const Measurement& m : measurements()) {
        if (!m.configuration->albedo || (m.at.importance && !m.configuration->is_reciprocal)) continue;
        INFO(m.label, ": ", m.albedo.x, " ", m.albedo.y, " ", m.albedo.z);
        const double tolerance = m.configuration->albedo_tolerance;
        for (int k = 0; k < 3; ++k)
            CHECK(std::abs(m.albedo[k] - *m.configuration->albedo) < tolerance + 1e-4);
    }
}

TEST_CASE(
    "rough surfaces have the albedo of Walter et al. 2007, equations 20 and 21, integrated in double "
    "precision") {
    struct Expected {
        const char* label;
        double cosine, albedo;
    };
    const Expected table[] = {
        {"conductor, white, alpha .3", 1, 0.87736},     {"conductor, white, alpha .3", 0.7, 0.84352},
        {"conductor, white, alpha .3", 0.25, 0.80918},  {"conductor, white, alpha 1", 0.7, 0.36100},
        {"conductor, white, alpha 1", 0.25, 0.49096},   {"dielectric, glass, alpha .3", 0.7, 0.97077},
        {"dielectric, glass, alpha .3", 0.25, 0.89584}, {"dielectric, glass, alpha .3", -0.85, 0.86532},
        {"dielectric, glass, alpha .3", -0.3, 0.75120}, {"dielectric, glass, alpha 1", 0.7, 0.77587},
        {"dielectric, glass, alpha 1", -0.3, 0.38311},
    };
    for (const Expected& e : table) {
        size_t found = 0;
        for (const Measurement& m : measurements()) {
            if (m.label.rfind(std::string(e.label) + ",", 0) != 0 || std::abs(m.wo.z - e.cosine) > 1e-6)
                continue;
            INFO(m.label);
            CHECK(std::abs(m.albedo.x - e.albedo) < 2e-4);
            found++;
        }
        CHECK(found == 2);
    }
}

TEST_CASE("light reflected more than once between facets is coloured more than once") {
    // Reflectance r: r E(mu) of single reflections, then r² (1 - L) / (1 - r L) of the rest (Kulla & Conty
    // 2017), with E as above and the mean loss L = 0.62337 by quadrature in double precision.
    for (const Measurement& m : measurements()) {
        if (m.label.rfind("conductor, grey, multiscatter, alpha 1,", 0) != 0) continue;
        const double expected = m.wo.z == 0.7f ? 0.26791 : m.wo.z == 0.25f ? 0.31511 : m.albedo.x;
        INFO(m.label);
        CHECK(std::abs(m.albedo.x - expected) < 2e-3);
    }
}

TEST_CASE("what a surface's samples let pass straight on is its transparency") {
    for (const Measurement& m : measurements()) {
        INFO(m.label);
        for (int k = 0; k < 3; ++k) CHECK(m.straight[k] == doctest::Approx(m.transparency[k]).epsilon(1e-5));
    }
}

TEST_CASE("surfaces that let light pass straight on say that they are not opaque") {
    for (const Measurement& m : measurements()) {
        INFO(m.label);
        if (m.is_opaque) CHECK(m.transparency == glm::dvec3(0));
    }
}

TEST_CASE("a surface is delta exactly where it has no values") {
    for (const Measurement& m : measurements()) {
        INFO(m.label);
        CHECK(m.is_delta == m.quadrature_of_zero);
    }
}

TEST_CASE(
    "surfaces are reciprocal, with radiance over squared index, forward paths are adjoint to backward ones, "
    "and pdfs of the way back are those of directions exchanged") {
    for (TestedClass& c : tested_classes())
        for (size_t i = 0; i < c.configurations.size(); ++i) {
            const SurfaceConfiguration& configuration = c.configurations[i];
            const SurfaceSurroundings radiance{configuration.ior_above, configuration.ior_below, false};
            const SurfaceSurroundings power{configuration.ior_above, configuration.ior_below, true};
            std::vector<DirectionPair> pairs, swapped;
            for (glm::vec3 wo : outgoing_directions())
                for (const SurfaceSample& s : c.probe->sample(i, radiance, wo, 1024, 3).samples)
                    if (s.event && !(s.event & event_delta)) pairs.push_back({wo, s.wi});
            for (int k = 0; k < 2048; ++k)  // pairs that the sampler may never give
                pairs.push_back(
                    {direction(std::sin(k * 1.1), k * 2.3), direction(std::sin(k * 1.7), k * 0.7)});
            for (const DirectionPair& p : pairs) swapped.push_back({p.wi, p.wo});
            const auto there = c.probe->evaluate(i, radiance, pairs),
                       back = c.probe->evaluate(i, radiance, swapped);
            const auto carried = c.probe->evaluate(i, power, pairs),
                       carried_back = c.probe->evaluate(i, power, swapped);
            std::vector<double> reciprocity, adjoint, reverse;
            for (size_t k = 0; k < pairs.size(); ++k) {
                const double wo = pairs[k].wo.z, wi = pairs[k].wi.z;
                const double n_o = wo > 0 ? radiance.ior_above : radiance.ior_below;
                const double n_i = wi > 0 ? radiance.ior_above : radiance.ior_below;
                // What comes back is of the other transport direction.
                for (const auto& [a, b] : {std::pair(there[k].pdf_reverse, carried_back[k].pdf),
                                           std::pair(carried[k].pdf_reverse, back[k].pdf)})
                    reverse.push_back(std::max(a, b) < 1e-6f ? 0 : relative_difference(a, b));
                for (int channel = 0; channel < 3; ++channel) {
                    const double a = there[k].f_cos[channel] / std::abs(wi),
                                 b = back[k].f_cos[channel] / std::abs(wo);
                    reciprocity.push_back(
                        std::max(a, b) < 1e-9 ? 0 : relative_difference(a / (n_o * n_o), b / (n_i * n_i)));
                    const double forward = carried[k].f_cos[channel] / std::abs(wi);
                    adjoint.push_back(std::max(b, forward) < 1e-9 ? 0 : relative_difference(forward, b));
                }
            }
            INFO(c.name, ", ", configuration.label);
            // Near the critical angle the Fresnel term grows like a square root and magnifies rounding.
            if (configuration.is_reciprocal)
                CHECK(high_quantile(reciprocity) < 1e-3 + rounding_tolerance(configuration));
            CHECK(high_quantile(adjoint) < 1e-3 + rounding_tolerance(configuration));
            CHECK(high_quantile(reverse) < 1e-3 + rounding_tolerance(configuration));
        }
}
