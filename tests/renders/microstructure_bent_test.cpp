// Sheets of microstructure on cylinders: rays in double precision, a furnace, and a rod that dents let light
// out of.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/renders/algorithm_comparison.h"
#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"

using namespace etendue;
using nlohmann::json;

namespace {

constexpr double pi = 3.14159265358979323846;

// Domes on a cylinder, or in it, in cells around (0, 0) of the sheet.
struct BentSheet {
    double bend, width, height, pitch, radius, depth;
    bool dents;

    double up() const { return dents ? -1 : 1; }
    glm::ivec2 cells() const { return {int(width / pitch + 1e-3), int(height / pitch + 1e-3)}; }
    double around(const glm::dvec3& p) const { return bend * std::atan2(p.x / bend, (p.z + bend) / bend); }
    // Beyond the cylinder, m.
    double height_of(const glm::dvec3& p) const {
        return (std::hypot(p.x, p.z + bend) - std::abs(bend)) * (bend > 0 ? 1 : -1);
    }
    double curvature() const { return (radius * radius + depth * depth) / (2 * depth); }
    // Middle of the sphere over a place of the sheet; of the cell there, moved by some.
    std::optional<glm::dvec3> sphere(double x, double y, int dx, int dy) const {
        const glm::ivec2 n = cells();
        const int column = int(std::floor(x / pitch + 0.5 * n.x)) + dx,
                  row = int(std::floor(y / pitch + 0.5 * n.y)) + dy;
        if (column < 0 || row < 0 || column >= n.x || row >= n.y) return {};
        const double angle = (column + 0.5 - 0.5 * n.x) * pitch / bend,
                     from_axis = bend + up() * (depth - curvature());
        return glm::dvec3(from_axis * std::sin(angle), (row + 0.5 - 0.5 * n.y) * pitch,
                          from_axis * std::cos(angle) - bend);
    }
};

struct Met {
    double t = 1e30, cosine = 0;
    bool on_dome = false;
};
Met meet(const BentSheet& s, const glm::dvec3& o, const glm::dvec3& d) {
    Met best;
    const glm::dvec2 from(o.x, o.z + s.bend), along(d.x, d.z);
    const double a = glm::dot(along, along), b = glm::dot(from, along);
    const auto crossings = [](double a, double b, double c) {
        const double rest = b * b - a * c, root = std::sqrt(std::max(rest, 0.0));
        return rest < 0 ? std::vector<double>{} : std::vector<double>{(-b - root) / a, (-b + root) / a};
    };
    const auto domes_near = [&](const glm::dvec3& p) {
        std::vector<glm::dvec3> spheres;
        for (int dx = -1; dx <= 1; ++dx)
            for (int dy = -1; dy <= 1; ++dy)
                if (const auto c = s.sphere(s.around(p), p.y, dx, dy)) spheres.push_back(*c);
        return spheres;
    };
    for (const double t : crossings(a, b, glm::dot(from, from) - s.bend * s.bend)) {
        const glm::dvec3 p = o + t * d;
        bool is_plain =
            t > 0 && t < best.t && std::abs(s.around(p)) <= s.width / 2 && std::abs(p.y) <= s.height / 2;
        for (const glm::dvec3& c : domes_near(p)) is_plain = is_plain && glm::length(p - c) >= s.curvature();
        if (is_plain)
            best = {t, std::abs(glm::dot(along, from + t * along)) / std::abs(s.bend) / glm::length(d),
                    false};
    }
    for (int column = 0; column < s.cells().x; ++column) {
        // Of a column, those near where the ray passes it.
        const double x = (column + 0.5 - 0.5 * s.cells().x) * s.pitch;
        const auto middle = s.sphere(x, 0, 0, 0);
        const double near = -glm::dot(glm::dvec2(o.x - middle->x, o.z - middle->z), along) / a;
        const double reach = 2 * s.curvature() * std::abs(d.y) / std::sqrt(a);
        for (double y = o.y + near * d.y - reach - s.pitch; y <= o.y + near * d.y + reach + s.pitch;
             y += s.pitch)
            if (const auto c = s.sphere(x, y, 0, 0)) {
                const glm::dvec3 e = o - *c;
                for (const double t : crossings(glm::dot(d, d), glm::dot(e, d),
                                                glm::dot(e, e) - s.curvature() * s.curvature()))
                    if (t > 0 && t < best.t && s.up() * s.height_of(o + t * d) >= 0)
                        best = {t, std::abs(glm::dot(e + t * d, d)) / s.curvature() / glm::length(d), true};
            }
    }
    return best;
}

json parameters(const BentSheet& s) {
    return {{"size", {s.width, s.height}},
            {"pitch", {s.pitch, s.pitch}},
            {"radius", s.radius},
            {"depth", s.depth},
            {"bend", s.bend},
            {"operation", s.dents ? "remove" : "add"}};
}

// A rod of glass along y, with dents or bumps all around, and flat ends.
void add_rod(SceneBuilder& s, double radius, double length, int glass, bool dents) {
    const double pitch = 2 * pi * radius / 24;
    json sheet = parameters({radius, 24 * pitch, length, pitch, 0.35 * pitch, 0.2 * pitch, dents});
    sheet["class"] = "microstructure";
    s.shape(sheet, glass, at(0, 0, radius));
    const double h = std::sqrt(0.5);
    s.shape({{"class", "disk"}, {"radius", radius}}, glass, {{0, length / 2, 0}, {-h, 0, 0, h}});
    s.shape({{"class", "disk"}, {"radius", radius}}, glass, {{0, -length / 2, 0}, {h, 0, 0, h}});
}

}  // namespace

TEST_CASE("domes on and in cylinders are met where double precision says") {
    for (const double bend : {0.05, -0.05})
        for (const bool dents : {false, true})
            for (const bool is_closed : {false, true}) {
                const double pitch = double(float(2 * pi * 0.05 / 32));
                const BentSheet s{double(float(bend)),
                                  is_closed ? 2 * pi * double(0.05f) : 0.7 * pi * 0.05,
                                  double(0.2f),
                                  pitch,
                                  double(0.004f),
                                  double(0.003f),
                                  dents};
                GeometryProbe probe;
                probe.add_shape("microstructure", parameters(s),
                                {{-0.06f, -0.1f, -0.11f}, {0.06f, 0.1f, 0.11f}}, glm::dmat4(1));
                probe.build();
                Random random(3);
                std::vector<ProbeRay> rays(8000);
                for (size_t i = 0; i < rays.size(); ++i) {
                    const float away = i % 3 == 0 ? 0.03f : i % 3 == 1 ? 0.2f : 2.0f;
                    const glm::vec3 target(random(-0.05f, 0.05f), random(-0.09f, 0.09f),
                                           random(-0.05f, 0.05f) - float(bend));
                    const glm::vec3 d = glm::normalize(glm::vec3(random.direction()) * glm::vec3(1, 0.7f, 1));
                    rays[i] = {target - away * d, 1e30f, d};
                }
                const auto traces = probe.trace(rays, false);
                size_t on_domes = 0, wrong = 0, unsure = 0;
                double farthest = 0, off = 0;
                for (size_t i = 0; i < rays.size(); ++i) {
                    const glm::dvec3 o(rays[i].origin), d(rays[i].direction);
                    const Met exact = meet(s, o, d);
                    bool clear = exact.t > 1e29 || exact.cosine > 0.05;
                    for (const glm::dvec3& beside :
                         {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
                        const Met other = meet(s, o + 1e-3 * pitch * beside, d);
                        clear = clear && other.on_dome == exact.on_dome &&
                                (other.t > 1e29) == (exact.t > 1e29) &&
                                (exact.t > 1e29 || std::abs(other.t - exact.t) < 0.1 * pitch);
                    }
                    if (!clear) {
                        ++unsure;
                        continue;
                    }
                    const ProbeHit& hit = traces[i].hit;
                    const bool met = hit.primitive != no_record, on_dome = met && hit.uv.x < 1e29f;
                    on_domes += on_dome;
                    if (met != (exact.t < 1e29) ||
                        (met &&
                         (on_dome != exact.on_dome || std::abs(double(hit.t) - exact.t) > 1e-2 * pitch))) {
                        ++wrong;
                        continue;
                    }
                    if (!met) continue;
                    farthest = std::max(farthest, std::abs(double(hit.t) - exact.t) * exact.cosine);
                    // The point itself, and that it is within its bound.
                    const glm::dvec3 away = glm::dvec3(traces[i].position) - (o + exact.t * d),
                                     n(traces[i].geometric_normal);
                    off = std::max(off, std::abs(glm::dot(away, n)) /
                                            glm::dot(glm::abs(n), glm::dvec3(traces[i].error)));
                }
                MESSAGE("bend ", bend, std::string(dents ? " dents" : " bumps"),
                        std::string(is_closed ? " all around: " : ": "), on_domes, " on domes, ", unsure,
                        " unsure, ", wrong, " wrong, others within ", farthest / pitch, " pitches, and ", off,
                        " of their bounds");
                CHECK(on_domes > 1000);
                CHECK(wrong == 0);
                CHECK(farthest < 1e-4 * pitch);
                CHECK(off < 1);
                CHECK(unsure < rays.size() / 10);
            }
}

TEST_CASE("a rod of glass with dents or bumps loses no light") {
    for (const bool dents : {false, true}) {
        CAPTURE(dents);
        SceneBuilder s;
        s.environment({1, 1, 1});
        s.medium("glass", {{"ior", 1.5}});
        add_rod(s, 0.2, 1, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}), dents);
        s.perspective(0.9, at(0.05, -0.1, 1.2));
        RenderPlan plan;
        plan.width = plan.height = 32, plan.passes = 16, plan.seeds = 1;
        size_t off = 0;
        for (const double v : render_estimates(s.import(), plan).mean) off += std::fabs(v - 1) > 1e-4;
        CHECK(off == 0);
    }
}

// What enters a smooth rod by its end leaves by the other; dents let some out on the way.
TEST_CASE("dents let light out of a rod") {
    double through[2];
    for (const bool dents : {false, true}) {
        SceneBuilder s;
        s.medium("glass", {{"ior", 1.5}});
        const int glass = s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}});
        if (dents) {
            add_rod(s, 0.2, 2, glass, true);
        } else {
            const double h = std::sqrt(0.5);
            s.shape({{"class", "cylinder"}, {"radius", 0.2}, {"height", 2}}, glass,
                    {{0, 0, 0}, {-h, 0, 0, h}});
            for (const double end : {-1.0, 1.0})
                s.shape({{"class", "disk"}, {"radius", 0.2}}, glass,
                        {{0, end, 0}, {end > 0 ? -h : h, 0, 0, h}});
        }
        const double h = std::sqrt(0.5);
        s.placed("light", {{"class", "collimated"}, {"radius", 0.15}, {"divergence", 0.5}, {"power", 1}},
                 {{0, -1.01, 0}, {h, 0, 0, h}});
        s.placed("receiver", {{"class", "illuminance"}, {"size", {0.6, 0.6}}, {"resolution", {1, 1}}},
                 {{0, 1.01, 0}, {h, 0, 0, h}});
        RenderPlan plan;
        plan.width = plan.height = 1, plan.algorithm = Algorithm::forward, plan.forward_paths = 20000,
        plan.passes = 1, plan.seeds = 4;
        through[dents] = window_mean(render_estimates(s.import(), plan)).mean;
    }
    MESSAGE("of what a smooth rod lets through one with dents does ", through[1] / through[0]);
    CHECK(through[1] < 0.95 * through[0]);
    CHECK(through[1] > 0.2 * through[0]);
}
