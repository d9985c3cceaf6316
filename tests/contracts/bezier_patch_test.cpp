// The geometry class `bezier_patch` beside its contract: surfaces of many pieces, splines that are spheres
// and tori, borders, silhouettes, rays that start on the surface.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/gltf/splines.h"
#include "tests/contracts/geometry_classes.h"
#include "tests/support/nurbs_shapes.h"

using namespace etendue;
using glm::dvec3;
using nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

json patches(const json& spline) {
    const std::string file = "spline";
    return {{"control_points", patches_of_spline({&spline, "", &file})}};
}
json sphere() { return patches(nurbs_sphere(1)); }
json torus() { return patches(nurbs_torus(2.5, 1)); }

double torus_distance(const dvec3& p) { return std::hypot(std::hypot(p.x, p.y) - 2.5, p.z) - 1; }

std::vector<BezierPiece> pieces_of(const json& parameters) {
    return cut_bezier_patches(read_bezier_patches(parameters["control_points"], ""), "");
}

// A point of a piece, in doubles.
dvec3 place(const BezierPiece& p, double u, double v) {
    glm::dvec4 h(0);
    const auto basis = [](double x) {
        const double y = 1 - x;
        return glm::dvec4(y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x);
    };
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) h += basis(u)[i] * basis(v)[j] * glm::dvec4(p.rows[j][i]);
    return dvec3(p.origin) + dvec3(h) / h.w;
}

}  // namespace

TEST_CASE("splines of degree 2 with weights are spheres and tori, also at poles") {
    for (const bool is_torus : {false, true}) {
        CAPTURE(is_torus);
        const json parameters = is_torus ? torus() : sphere();
        const std::vector<BezierPiece> pieces = pieces_of(parameters);
        double area = 0, off = 0;
        for (const BezierPiece& p : pieces) {
            for (int k = 0; k < 4; ++k)
                for (int l = 0; l < 4; ++l) area += double(p.area_density[k][l]) / 16;
            for (const double u : {0.0, 0.3, 1.0})
                for (const double v : {0.0, 0.6, 1.0}) {
                    const dvec3 at = place(p, u, v);
                    off = std::max(off, std::abs(is_torus ? torus_distance(at) : glm::length(at) - 1));
                }
        }
        CHECK(pieces.size() < 1200);
        CHECK(off < 1e-7);
        CHECK(area == doctest::Approx(is_torus ? 10 * pi * pi : 4 * pi).epsilon(1e-5));
        MESSAGE(pieces.size() << " pieces, off by " << off);
    }
}

TEST_CASE("rays meet a sphere of patches where they meet the sphere, from without and within") {
    GeometryProbe probe;
    probe.add_shape("bezier_patch", sphere(), {}, glm::dmat4(1));
    probe.build();
    Random random(4);
    std::vector<ProbeRay> rays(60000);
    for (size_t i = 0; i < rays.size(); ++i) {
        const glm::vec3 from = random.direction() * (i % 3 == 0   ? 0.9f * random(0, 1)
                                                     : i % 3 == 1 ? 2.0f
                                                                  : 50.0f);
        glm::vec3 to = random.direction() * random(0, 1.1f);
        if (i % 5 == 0) to = glm::vec3(0, 0, i % 2 ? 1 : -1) + 0.02f * random.direction();  // at the poles
        rays[i] = {from, 1e30f, glm::normalize(to - from)};
    }
    const auto traces = probe.trace(rays, false);
    size_t wrong = 0, far = 0, tilted = 0, hits = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const dvec3 o(rays[i].origin), d(rays[i].direction);
        const double away = glm::length(o), b = glm::dot(o, d) / glm::dot(d, d),
                     near = glm::length(o - b * d);
        const double tolerance = 1e-6 * (1 + away);
        if (std::abs(near - 1) < tolerance) continue;
        const double root = std::sqrt(std::max(1 - near * near, 0.0) / glm::dot(d, d));
        const bool meets = near < 1 && -b + root > 0;
        const double t = away < 1 ? -b + root : -b - root;
        const bool met = traces[i].hit.primitive != no_record;
        wrong += met != meets;
        if (!met || !meets) continue;
        hits++;
        // Along the ray by what a tolerance across makes of it.
        far += !(std::abs(traces[i].hit.t - t) < tolerance * (1 + 1 / std::max(root, 1e-3)));
        const dvec3 p(traces[i].position), n(traces[i].geometric_normal);
        far += !(std::abs(glm::length(p) - 1) < 1e-6);
        tilted += !(glm::length(n - glm::normalize(p)) < (std::hypot(p.x, p.y) < 0.01 ? 4e-3 : 2e-5));
    }
    CHECK(hits > 30000);
    CHECK(wrong == 0);
    CHECK(far == 0);
    CHECK(tilted == 0);
}

TEST_CASE("no ray slips between the pieces of a torus, nor away from where it leaves") {
    const json parameters = torus();
    const std::vector<BezierPiece> pieces = pieces_of(parameters);
    GeometryProbe probe;
    probe.add_shape("bezier_patch", parameters, {}, glm::dmat4(1));
    probe.build();
    Random random(6);
    std::vector<ProbeRay> rays;
    // From within at points of borders, and at corners.
    for (int i = 0; i < 60000; ++i) {
        const BezierPiece& p = pieces[size_t(random(0, 0.9999f) * float(pieces.size()))];
        const float along = i % 7 == 0 ? 0.0f : random(0, 1);
        const dvec3 at = i % 2 ? place(p, i % 4 < 2, along) : place(p, along, i % 4 < 2);
        const float turn = random(0, 6.2831853f), wide = 0.95f * std::sqrt(random(0, 1)),
                    phi = random(0, 6.2831853f);
        const float reach = 2.5f + wide * std::cos(phi);
        const glm::vec3 from(reach * std::cos(turn), reach * std::sin(turn), wide * std::sin(phi));
        rays.push_back({from, 1e30f, glm::normalize(glm::vec3(at) - from)});
    }
    auto traces = probe.trace(rays, false);
    size_t slipped = 0, again = 0;
    std::vector<ProbeRay> onward;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (traces[i].hit.primitive == no_record) {
            slipped++;
            continue;
        }
        // Mirrored, and along the wall, from steep to grazing: within the tube.
        const glm::vec3 n = traces[i].geometric_normal;
        const glm::vec3 any = random.direction(), along = glm::normalize(any - n * glm::dot(any, n));
        const glm::vec3 d = glm::normalize(along - std::pow(10.0f, random(-3, 1)) * n);
        glm::vec3 from = traces[i].position - glm::dot(glm::abs(n), traces[i].error) * n;
        onward.push_back({from, 1e30f, d});
    }
    CHECK(slipped == 0);
    traces = probe.trace(onward, false);
    slipped = 0;
    for (size_t i = 0; i < onward.size(); ++i) {
        slipped += traces[i].hit.primitive == no_record;
        // A wall that is concave along the ray is not met where it began.
        if (traces[i].hit.primitive != no_record) again += traces[i].hit.t < 1e-7f;
    }
    CHECK(slipped == 0);
    CHECK(again == 0);
}

TEST_CASE("of several points on a ray the first is met, on waves of one patch") {
    const GraphOracle waves{
        {{0, 0.9, 0, -1.0}, {0.4, 0, 0, 0.5}, {0, -0.6, 0.3, 0.4}, {-0.5, 0, 0.4, -0.3}}, 1, 0.8};
    const json parameters = {{"control_points", waves.control_points()}};
    GeometryProbe probe;
    probe.add_shape("bezier_patch", parameters, {}, glm::dmat4(1));
    probe.build();
    Random random(8);
    std::vector<ProbeRay> rays(60000);
    for (size_t i = 0; i < rays.size(); ++i) {
        glm::vec3 a(random(-1, 1), random(-0.8f, 0.8f), 0), b(random(-1, 1), random(-0.8f, 0.8f), 0);
        a.z = float(waves.height(a.x, a.y)) + random(-0.05f, 0.05f), b.z = float(waves.height(b.x, b.y));
        rays[i] = {a, 1e30f, glm::normalize(b - a)};
        if (i % 2) rays[i].origin -= 3.0f * rays[i].direction;
    }
    const auto traces = probe.trace(rays, false);
    size_t wrong = 0, several = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const dvec3 o(rays[i].origin), d(rays[i].direction);
        const auto nearest = [&](const dvec3& from, size_t& count) {
            double t = 1e30;
            count = 0;
            for (const double at : waves.crossings(from, d))
                if (at > 0) t = std::min(t, at), ++count;
            return t;
        };
        size_t count, unused;
        const double t = nearest(o, count);
        bool clear = true;
        for (int k = 0; k < 6; ++k) {
            dvec3 beside = o;
            beside[k / 2] += (k % 2 ? 1 : -1) * 4e-6;
            clear = clear && std::abs(nearest(beside, unused) - t) < 1e-3;
        }
        if (!clear) continue;
        several += count > 1;
        const double found = traces[i].hit.primitive == no_record ? 1e30 : double(traces[i].hit.t);
        const bool is_wrong = !(std::abs(found - t) < 1e-3);
        wrong += is_wrong;
    }
    CHECK(several > 10000);
    CHECK(wrong == 0);
}

TEST_CASE("the host's record of a piece is laid out as the shader's") {
    ClassRegistry classes(test_sources());
    const ClassInfo* info = classes.find(Interface::geometry, "bezier_patch");
    REQUIRE(info);
    CHECK(info->parameters.front().member.size == sizeof(BezierPiece));
    std::map<std::string, uint32_t> offsets;
    for (const MemberLayout& m : info->parameters.front().member.members) offsets[m.name] = m.offset;
    CHECK(offsets.at("row1") == offsetof(BezierPiece, rows) + sizeof(glm::mat4));
    CHECK(offsets.at("area_density") == offsetof(BezierPiece, area_density));
    CHECK(offsets.at("origin") == offsetof(BezierPiece, origin));
    CHECK(offsets.at("radius") == offsetof(BezierPiece, radius));
    CHECK(offsets.at("hi") == offsetof(BezierPiece, hi));
    CHECK(offsets.at("axis") == offsetof(BezierPiece, axis));
    CHECK(offsets.at("second_out") == offsetof(BezierPiece, second_out));
    CHECK(offsets.at("slack") == offsetof(BezierPiece, slack));
    CHECK(offsets.at("domain") == offsetof(BezierPiece, domain));
}

TEST_CASE("what a patch may be is said") {
    const auto fault = [](const json& value) -> std::string {
        try {
            cut_bezier_patches(read_bezier_patches(value, "f: /g"), "f: /g");
        } catch (const std::exception& e) {
            return e.what();
        }
        return "";
    };
    json net = json::array();
    for (int i = 0; i < 16; ++i) net.push_back({i % 4, i / 4, 0});
    CHECK(fault(net) == "");
    CHECK(fault({net, {{"points", net}, {"uv", {0, 0, 0.5, 1}}}}) == "");
    CHECK(fault(json::array()).find("allowed: 16 points") != std::string::npos);
    json bad = net;
    bad[7] = {1, 2};
    CHECK(fault(bad).find("f: /g/7: allowed: [x, y, z]") != std::string::npos);
    bad[7] = {1, 2, 3, 0};
    CHECK(fault(bad).find("f: /g/7/3: 0 is out of range") != std::string::npos);
    for (int i = 0; i < 16; ++i) bad[size_t(i)] = {i, i, i};
    CHECK(fault(bad).find("no area") != std::string::npos);
}
