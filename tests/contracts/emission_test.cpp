// Rays that leave lights, for every registered class: distributed as stated, carrying the light's power, and
// the same light that points of the scene sample. A class without a configuration here fails.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/contracts/emission_cases.h"
#include "tests/support/source_path.h"
#include "tests/support/statistics.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double false_alarm = 1e-4;

double square(double x) { return x * x; }
double luminance(glm::vec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

struct Probed {
    EmissionCase c;
    std::unique_ptr<EmissionProbe> probe;
    std::vector<ProbedRay> rays;
    bool has_surface() const { return c.class_name == "area"; }
    bool has_position() const {
        return c.class_name == "point" || c.class_name == "spot" || c.class_name == "ies" ||
               c.class_name == "rays" || c.class_name == "collimated";
    }
    // Forward rays alone bring its light.
    bool is_unmet() const { return c.class_name == "rays" || c.label == "parallel"; }
    json parameters() const { return c.scene.lights[0].object.parameters; }
};

std::vector<Probed>& probed() {
    static std::vector<Probed> all = [] {
        std::vector<Probed> result;
        for (EmissionCase& c : emission_cases()) {
            auto probe = std::make_unique<EmissionProbe>(c.scene);
            std::vector<ProbedRay> rays = probe->emit(1 << 19, 1);
            result.push_back({std::move(c), std::move(probe), std::move(rays)});
        }
        return result;
    }();
    return all;
}

// Cells of equal area on the unit sphere.
constexpr uint32_t rows = 6, columns = 8;
uint32_t cell_of(glm::vec3 d) {
    const double turn = std::atan2(double(d.y), double(d.x)) / (2 * pi) + 0.5;
    const uint32_t row = uint32_t(std::clamp((1 - double(d.z)) / 2 * rows, 0.0, rows - 1.0));
    return row * columns + std::min(uint32_t(turn * columns), columns - 1);
}

// Where a ray leaves the sphere around the scene, and its direction, each by cell.
uint32_t ray_cell(glm::vec3 exit, glm::vec3 direction) {
    return cell_of(glm::normalize(exit)) * rows * columns + cell_of(direction);
}

// Emitted rays against the density by which they leave the scene, integrated by rays that are even over
// étendue.
double crossing_p_value(Probed& p) {
    const double radius = p.probe->scene().radius;
    const uint32_t cells = rows * columns * rows * columns, drawn = 1 << 21;
    std::vector<double> observed(cells), expected(cells), squares(cells);
    std::vector<uint32_t> hits(cells);
    for (const ProbedRay& r : p.rays) {
        if (p.has_surface() && r.t_hit < 1e29f) continue;  // it does not leave the scene
        const glm::dvec3 o(r.origin), d(r.direction);
        const double b = glm::dot(o, d), root = b * b + radius * radius - glm::dot(o, o);
        observed[ray_cell(glm::vec3(o + d * (-b + std::sqrt(std::max(0.0, root)))), r.direction)] += 1;
    }
    // Étendue of the sphere: pi times its area.
    const double each = pi * 4 * pi * radius * radius / drawn * double(p.rays.size());
    for (const CrossingRay& r : p.probe->cross(drawn, 2)) {
        const uint32_t cell = ray_cell(r.exit, r.direction);
        const double value = r.pdf_emit * each;
        expected[cell] += value, squares[cell] += value * value, hits[cell] += value > 0;
    }
    double statistic = 0, degrees = 0, rest_observed = 0, rest_expected = 0, rest_squares = 0;
    const auto add = [&](double o, double e, double variance) {
        if (variance > 0) statistic += (o - e) * (o - e) / (e + variance), degrees += 1;
    };
    for (uint32_t i = 0; i < cells; ++i)
        if (expected[i] < 25 || hits[i] < 100)
            rest_observed += observed[i], rest_expected += expected[i], rest_squares += squares[i];
        else
            add(observed[i], expected[i], squares[i]);
    add(rest_observed, rest_expected, rest_squares);
    CAPTURE(statistic);
    CAPTURE(degrees);
    CHECK(degrees > 50);
    return chi2_survival(statistic, degrees);
}

// Lights at a point, or of whose points each sends alike: cells in 1 - cos of the angle to -z and in azimuth,
// up to where the cone of light ends.
double direction_p_value(Probed& p) {
    constexpr uint32_t rings = 32, sectors = 16, fine = 8;  // quadrature points along each side of a cell
    const json parameters = p.parameters();
    const bool is_disk = p.c.class_name == "collimated";
    const double outer =
                     is_disk ? parameters.value("divergence", 0.0) : parameters.value("outer_cone_angle", pi),
                 end = 2 * std::pow(std::sin(outer / 2), 2);
    std::vector<double> observed(rings * sectors), expected(rings * sectors);
    for (const ProbedRay& r : p.rays) {
        const glm::dvec3 d(r.direction);
        const double v = d.z < 0 ? (d.x * d.x + d.y * d.y) / (1 - d.z) : 1 + d.z;
        REQUIRE(v < end * (1 + 1e-5));
        const double turn = std::atan2(d.y, d.x) / (2 * pi) + 0.5;
        observed[std::min(uint32_t(v / end * rings), rings - 1) * sectors +
                 std::min(uint32_t(turn * sectors), sectors - 1)] += 1;
    }
    std::vector<glm::vec3> directions;
    for (uint32_t i = 0; i < rings * sectors; ++i)
        for (uint32_t j = 0; j < fine * fine; ++j) {
            const double v = end * (i / sectors + (j / fine + 0.5) / fine) / rings;
            const double phi = 2 * pi * ((i % sectors + (j % fine + 0.5) / fine) / sectors - 0.5);
            const double s = std::sqrt(v * (2 - v));
            directions.push_back(glm::vec3(s * std::cos(phi), s * std::sin(phi), v - 1));
        }
    const std::vector<float> densities = p.probe->densities(directions);
    double total = 0;
    for (size_t i = 0; i < densities.size(); ++i) {
        double part = densities[i] * 2 * pi * end / double(densities.size());
        if (is_disk)
            part *= pi * square(parameters["radius"]) * -double(directions[i].z);  // from that per étendue
        expected[i / (fine * fine)] += part * double(p.rays.size());
        total += part;
    }
    CHECK(total == doctest::Approx(1).epsilon(1e-3));
    return chi_squared_test(observed, expected).p_value;
}

// Evenly over a disk: of parallel rays one across them whose area is 1 / pdf, else the light's.
double disk_p_value(Probed& p) {
    const double area =
        p.c.class_name == "collimated" ? pi * square(p.parameters()["radius"]) : 1 / double(p.rays[0].pdf);
    std::vector<double> observed(16 * 32), expected(16 * 32, double(p.rays.size()) / (16 * 32));
    for (const ProbedRay& r : p.rays) {
        const glm::dvec3 o(r.origin),
            axis = p.c.class_name == "collimated" ? glm::dvec3(0, 0, -1) : glm::dvec3(r.direction);
        const glm::dvec3 across = o - axis * glm::dot(o, axis);
        const double ring = glm::dot(across, across) * pi / area;
        REQUIRE(ring < 1.0001);
        const double turn = std::atan2(across.y, across.x) / (2 * pi) + 0.5;
        observed[std::min(uint32_t(ring * 16), 15u) * 32 + std::min(uint32_t(turn * 32), 31u)] += 1;
    }
    return chi_squared_test(observed, expected).p_value;
}

// Rays of a file: each as often as its part of the flux, from where it starts, the way that it goes.
double ray_p_value(Probed& p) {
    const RayFile file = read_ray_file(p.parameters()["file"].get<std::string>());
    std::vector<double> observed(file.rays.size()), expected(file.rays.size());
    for (size_t i = 0; i < file.rays.size(); ++i)
        expected[i] = file.rays[i].flux / file.flux() * double(p.rays.size());
    for (const ProbedRay& r : p.rays) {
        const glm::vec3 start = 1000.0f * (r.origin - glm::vec3(0, 0, 0.5f));
        size_t nearest = 0;
        for (size_t i = 1; i < file.rays.size(); ++i)
            if (glm::distance(file.rays[i].position, start) <
                glm::distance(file.rays[nearest].position, start))
                nearest = i;
        REQUIRE(glm::distance(file.rays[nearest].position, start) < 1e-3f);
        REQUIRE(glm::distance(file.rays[nearest].direction, r.direction) < 1e-6f);
        observed[nearest] += 1;
    }
    for (size_t i = 0; i < file.rays.size(); ++i) CHECK((observed[i] > 0) == (expected[i] > 0));
    return chi_squared_test(observed, expected).p_value;
}

}  // namespace

TEST_CASE("emission: every registered class of light has a configuration to be tested with") {
    ClassRegistry registry(ShaderSources{.folder = source_path("shaders")});
    for (const ClassInfo& info : registry.classes(Interface::light)) {
        CAPTURE(info.name);
        bool found = false;
        for (const Probed& p : probed()) found = found || p.c.class_name == info.name;
        CHECK(found);
    }
}

TEST_CASE("emission: rays start on the light and leave it, or outside the scene") {
    for (Probed& p : probed()) {
        INFO(p.c.class_name, " ", p.c.label);
        double worst_length = 0;
        uint32_t wrong_start = 0, back = 0;
        for (const ProbedRay& r : p.rays) {
            REQUIRE(r.pdf > 0);
            worst_length = std::max({worst_length, std::abs(glm::length(glm::dvec3(r.direction)) - 1),
                                     std::abs(glm::length(glm::dvec3(r.normal)) - 1)});
            back += !(glm::dot(r.normal, r.direction) >= 0) || (p.has_surface() && r.t_hit < 1e-3f);
            if (p.has_position())
                wrong_start += !(glm::length(r.origin - glm::vec3(0, 0, 0.5f)) <= p.c.extent);
            if (!p.has_position() && !p.has_surface())
                wrong_start += !(glm::length(r.origin) > p.probe->scene().radius);
            if (!p.has_surface()) wrong_start += r.normal != r.direction || r.error != glm::vec3(0);
        }
        CHECK(worst_length < 1e-6);
        CHECK(wrong_start == 0);
        // From inside a cylinder the other wall may be as near as that.
        CHECK(back <= (p.c.label == "cylinder, both sides" ? p.rays.size() / 100 : 0));
    }
}

TEST_CASE("emission: a ray has the same density and radiance where it starts, is met, and is sampled") {
    for (Probed& p : probed()) {
        INFO(p.c.class_name, " ", p.c.label);
        const bool steps = p.probe->scene().features.emission_maps;
        double across = 0, missed = 0, worst_pdf = 0, worst_radiance = 0, worst_sampled = 0, worst_delta = 0,
               sampled = 0;
        double largest = 0, brightest = 0;
        for (const ProbedRay& r : p.rays)
            largest = std::max(largest, double(r.pdf)),
            brightest = std::max(brightest, luminance(r.radiance));
        for (const ProbedRay& r : p.rays) {
            if (r.met_pdf < 0) {
                ++missed;
                continue;
            }
            // Rounding takes few points of a light with a map across a step of its density.
            const double off = std::abs(r.met_pdf - double(r.pdf)) / largest;
            if (steps && off > 1e-4 && off < 0.5)
                ++across;
            else
                worst_pdf = std::max(worst_pdf, off);
            if (!r.is_delta)
                worst_radiance =
                    std::max(worst_radiance, std::abs(r.met_radiance - luminance(r.radiance)) / brightest);
            if (r.sampled_met_pdf < 0) continue;
            ++sampled;
            const double apart = std::abs(r.sampled_emission_pdf - double(r.sampled_met_pdf)) / largest;
            if (steps && apart > 0.02 && apart < 0.5)
                ++across;
            else
                worst_sampled = std::max(worst_sampled, apart);
            if (r.is_delta && p.c.extent == 0)
                worst_delta =
                    std::max(worst_delta, std::abs(r.sampled_emission_pdf - double(r.pdf)) / largest);
        }
        // A narrow beam's angles are known to the rounding of directions.
        const double tolerance = p.c.label == "narrow" ? 1e-3 : steps ? 1e-3 : 1e-4;
        CHECK(across <= 2e-3 * double(p.rays.size()));
        CHECK(missed <= 1e-3 * double(p.rays.size()));
        if (p.is_unmet())
            CHECK(sampled == 0);
        else
            CHECK(sampled > 0.2 * double(p.rays.size()));
        CHECK(worst_pdf < tolerance);
        CHECK(worst_radiance < tolerance);
        CHECK(worst_sampled < (p.has_surface() ? 0.02 : tolerance));
        CHECK(worst_delta < tolerance);
    }
}

TEST_CASE("emission: positions and directions are distributed as stated") {
    const double level = sidak_level(false_alarm, probed().size());
    for (Probed& p : probed()) {
        INFO(p.c.class_name, " ", p.c.label);
        if (p.c.class_name == "rays")
            CHECK(ray_p_value(p) > level);
        else if (p.has_position() && !p.is_unmet())
            CHECK(direction_p_value(p) > level);
        if (p.has_position() && p.c.class_name != "collimated") continue;
        if (p.rays[0].is_delta)
            CHECK(disk_p_value(p) > level);
        else
            CHECK(crossing_p_value(p) > level);
    }
}

TEST_CASE("emission: rays carry the light's power") {
    const double level = sidak_level(false_alarm, probed().size());
    for (Probed& p : probed()) {
        INFO(p.c.class_name, " ", p.c.label);
        Moments flux;
        for (const ProbedRay& r : p.rays) flux.add(luminance(r.radiance) / double(r.pdf));
        const double power = p.probe->scene().power;
        CAPTURE(flux.mean);
        CAPTURE(power);
        CHECK(z_test(flux.mean, power, flux.standard_error(), p.c.power_tolerance * power) > level);
    }
}

TEST_CASE("emission: the flux through a disk is the illuminance that its points sample") {
    const double level = sidak_level(false_alarm, probed().size());
    for (Probed& p : probed()) {
        INFO(p.c.class_name, " ", p.c.label);
        const MeasuringDisk& disk = p.c.disk;
        const glm::dvec3 center(disk.center), normal(disk.normal);
        Moments arriving, sampled;
        for (const ProbedRay& r : p.rays) {
            const glm::dvec3 o(r.origin), d(r.direction);
            const double down = glm::dot(d, normal), t = glm::dot(center - o, normal) / down;
            const bool arrives =
                down < 0 && t > 0 && t < r.t_hit && glm::length(o + t * d - center) < disk.radius;
            arriving.add(arrives ? luminance(r.radiance) / double(r.pdf) : 0);
        }
        for (float e : p.probe->illuminances(disk, 1 << 19, 3)) sampled.add(e);
        const double area = pi * double(disk.radius) * double(disk.radius);
        const double error = std::hypot(arriving.standard_error(), area * sampled.standard_error());
        CAPTURE(arriving.mean / area);
        CAPTURE(sampled.mean);
        CHECK(arriving.mean > 0);
        if (p.is_unmet()) {
            CHECK(sampled.mean == 0);
            continue;
        }
        CHECK(error < 0.02 * arriving.mean);
        CHECK(z_test(arriving.mean, area * sampled.mean, error, 1e-4 * arriving.mean) > level);
    }
}
