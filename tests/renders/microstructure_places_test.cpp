// Where rays meet small dots on a large sheet, in double precision: in rows, and at places from a file, which
// is also packed; near the sheet and far from it, and where that is moved.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/geometry_probe.h"
#include "tests/support/random.h"

using namespace etendue;
using nlohmann::json;

namespace {

struct Dot {
    glm::dvec2 center;
    double radius, depth;
};

// A ray with the plane z = 0 and domes on it, or in it: where it is met, and in the middle of which dot.
struct Meeting {
    double t = 1e30;
    const Dot* dot = nullptr;
    double cosine = 1;
};
Meeting meet(const std::vector<Dot>& dots, bool dents, const glm::dvec3& o, const glm::dvec3& d) {
    Meeting best;
    const double t = -o.z / d.z;
    bool is_plain = t > 0;
    for (const Dot& dot : dots) {
        const glm::dvec2 away = glm::dvec2(o + t * d) - dot.center;
        is_plain = is_plain && !(glm::length(away) < dot.radius);
        const double curvature = (dot.radius * dot.radius + dot.depth * dot.depth) / (2 * dot.depth),
                     up = dents ? -1 : 1;
        const glm::dvec3 from = o - glm::dvec3(dot.center, up * (dot.depth - curvature));
        const double a = glm::dot(d, d), b = glm::dot(from, d), nearest = glm::length(from - b / a * d);
        if (nearest > curvature) continue;
        const double half = std::sqrt((curvature - nearest) * (curvature + nearest) / a);
        for (const double s : {-b / a - half, -b / a + half})
            if (s > 0 && up * (o.z + s * d.z) >= 0 && s < best.t)
                best = {s, &dot, std::abs(glm::dot(from + s * d, d)) / (curvature * glm::length(d))};
    }
    if (is_plain && t < best.t) best = {t, nullptr, std::abs(d.z) / glm::length(d)};
    return best;
}

// Rays towards a sheet of half a metre, from between `nearest` and `farthest` metres away.
std::vector<ProbeRay> rays_from(size_t count, float nearest, float farthest, const glm::vec3& shift,
                                float side) {
    Random random(7);
    std::vector<ProbeRay> rays(count);
    for (ProbeRay& r : rays) {
        const glm::vec3 target(random(-0.24f, 0.24f), random(-0.24f, 0.24f), 0);
        const float away = random(nearest, farthest), slope = random(0, 1.2f), azimuth = random(0, 6.283f);
        const glm::vec3 back(std::sin(slope) * std::cos(azimuth), std::sin(slope) * std::sin(azimuth),
                             side * std::cos(slope));
        r = {shift + target + away * back, 1e30f, -back};
    }
    return rays;
}

struct Compared {
    size_t on_dots = 0, wrong = 0;
    double farthest = 0;  // m
};
// `dots_near`: those that a ray may meet that comes to a place of the plane.
template <class Near>
Compared compare(GeometryProbe& probe, const std::vector<ProbeRay>& rays, const glm::dvec3& shift, bool dents,
                 double pitch, Near dots_near) {
    Compared result;
    const auto traces = probe.trace(rays, false);
    for (size_t i = 0; i < rays.size(); ++i) {
        // As it is in the sheet's frame.
        const glm::dvec3 o = rays[i].origin - glm::vec3(shift), d(rays[i].direction);
        const std::vector<Dot> dots = dots_near(glm::dvec2(o - o.z / d.z * d));
        const Meeting exact = meet(dots, dents, o, d);
        // Where rays beside it go elsewhere, either answer is right.
        bool clear = exact.cosine > 0.05;
        for (const glm::dvec3& beside : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}})
            clear = clear && meet(dots, dents, o + 1e-4 * pitch * beside, d).dot == exact.dot;
        if (!clear) continue;
        const ProbeHit& hit = traces[i].hit;
        const bool on_dot = hit.uv.x < 1e29f;
        result.on_dots += on_dot;
        if (hit.primitive == no_record || on_dot != (exact.dot != nullptr))
            ++result.wrong;
        else if (on_dot)
            result.farthest = std::max(result.farthest, glm::length(glm::dvec2(o + exact.t * d) -
                                                                    exact.dot->center - glm::dvec2(hit.uv)));
    }
    return result;
}

const Box sheet_box{{-0.25f, -0.25f, -1e-5f}, {0.25f, 0.25f, 1e-5f}};
const float distances[][2] = {{1e-5f, 1e-4f}, {0.01f, 0.1f}, {0.5f, 2}};

}  // namespace

TEST_CASE(
    "dots of 20 µm are met where they are to a millionth of their pitch, on half a metre, and moved by 1 and "
    "100 m") {
    const double pitch = double(20e-6f), radius = double(9e-6f), depth = double(4e-6f);
    const int cells = int(double(0.5f) / pitch + 1e-3);
    for (const bool dents : {false, true})
        for (const double metres : {0.0, 1.0, 100.0}) {
            GeometryProbe probe;
            const glm::dvec3 shift(metres, -metres, metres);
            probe.add_shape("microstructure",
                            {{"size", {0.5, 0.5}},
                             {"pitch", {20e-6, 20e-6}},
                             {"radius", 9e-6},
                             {"depth", 4e-6},
                             {"operation", dents ? "remove" : "add"}},
                            sheet_box, glm::translate(glm::dmat4(1), shift));
            probe.build();
            const auto near = [&](const glm::dvec2& p) {
                std::vector<Dot> dots;
                const glm::ivec2 cell(glm::floor(p / pitch + 0.5 * cells));
                for (int y = -1; y <= 1; ++y)
                    for (int x = -1; x <= 1; ++x)
                        dots.push_back({(glm::dvec2(cell + glm::ivec2(x, y)) + 0.5 - 0.5 * cells) * pitch,
                                        radius, depth});
                return dots;
            };
            for (const auto& [nearest, farthest] : distances) {
                if (metres == 100 && nearest < 1e-3f) continue;  // a float there has steps of 8 µm
                const Compared c =
                    compare(probe, rays_from(15000, nearest, farthest, shift, dents ? -1.0f : 1.0f), shift,
                            dents, pitch, near);
                MESSAGE((dents ? "dents" : "bumps"), " moved by ", metres, " m, from ", nearest, " to ",
                        farthest, " m: ", c.on_dots, " met, ", c.wrong, " wrong, others within ",
                        c.farthest / pitch, " pitches");
                CHECK(c.on_dots > 3700);
                CHECK(c.wrong == 0);
                CHECK(c.farthest < 1e-6 * pitch);
            }
        }
}

TEST_CASE("dots of a file are met where it says, and those of the packed file at the same places") {
    const std::filesystem::path text = std::filesystem::temp_directory_path() / "etendue_dots.txt",
                                packed = text.parent_path() / "etendue_dots.bin";
    // In rows that are not the file's cells, so that dots reach over borders; of all sizes, none overlaps.
    Random random(5);
    std::vector<Dot> said;
    {
        std::ofstream file(text);
        file << "# dots\n\n";
        for (int row = 0; row < 60; ++row)
            for (int column = 0; column < 60; ++column) {
                const double size = random(0.2f, 1);
                const glm::dvec2 p((column - 29.5) * 0.0081 + random(-0.001f, 0.001f),
                                   (row - 29.5) * 0.0081 + random(-0.001f, 0.001f));
                said.push_back({p, size * 0.003, size * 0.001});
                file << fmt::format("{:.12f}\t{:.12f} {:.6f}  # dot\r\n", p.x, p.y, size);
            }
    }
    const json sheet = {{"size", {0.5, 0.5}}, {"pitch", {0.5, 0.5}}, {"radius", 0.003},
                        {"depth", 0.001},     {"placement", "file"}, {"file", text.string()}};
    const Box box{{-0.25f, -0.25f, -1e-3f}, {0.25f, 0.25f, 1e-3f}};
    for (const bool is_packed : {false, true}) {
        json parameters = sheet;
        if (is_packed) parameters["file"] = packed.string();
        GeometryProbe probe;
        probe.add_shape("microstructure", parameters, box, glm::dmat4(1));
        probe.build();
        // As they are packed: off by half a step of a 65536th of a cell.
        const MicroTables& tables = probe.places();
        const uint32_t cells = uint32_t(std::sqrt(double(tables.cells.size())));
        REQUIRE(tables.places.size() == said.size());
        std::vector<Dot> dots;
        for (uint32_t cell = 0; cell < cells * cells; ++cell)
            for (uint32_t i = tables.cells[cell]; i < tables.cells[cell + 1]; ++i) {
                const glm::uvec2 v = tables.places[i];
                const glm::dvec2 in_cell = (glm::dvec2(v.x & 0xFFFFu, v.x >> 16) + 0.5) / 65536.0;
                const double size = ((v.y & 0xFFFFu) + 1) / 65536.0;
                dots.push_back(
                    {((glm::dvec2(cell % cells, cell / cells) + in_cell) / double(cells) - 0.5) * 0.5,
                     size * double(0.003f), size * double(0.001f)});
            }
        double off = 0;
        for (const Dot& d : said) {
            double nearest = 1;
            for (const Dot& other : dots)
                nearest = std::min(nearest,
                                   glm::length(other.center - d.center) + std::abs(other.radius - d.radius));
            off = std::max(off, nearest);
        }
        CHECK(off < 1.2 * 0.5 / cells / 65536);
        const auto near = [&](const glm::dvec2& p) {
            std::vector<Dot> some;
            for (const Dot& d : dots)
                if (glm::length(d.center - p) < 0.012) some.push_back(d);
            return some;
        };
        for (const auto& [nearest, farthest] : {std::pair(0.004f, 0.02f), {0.5f, 2.0f}}) {
            const Compared c = compare(probe, rays_from(20000, nearest, farthest, glm::vec3(0), 1),
                                       glm::dvec3(0), false, 0.0081, near);
            MESSAGE(cells, " x ", cells, " cells, from ", nearest, " to ", farthest, " m: ", c.on_dots,
                    " met, ", c.wrong, " wrong, others within ", c.farthest / 0.0081, " pitches");
            CHECK(c.on_dots > 2000);
            CHECK(c.wrong == 0);
            CHECK(c.farthest < 1e-6 * 0.0081);
        }
        if (!is_packed) {
            MicroPlaces places{cells, cells, 0, 0};
            std::ofstream(packed, std::ios::binary) << packed_micro_places(places, tables);
        }
    }
    std::filesystem::remove(text), std::filesystem::remove(packed);
}
