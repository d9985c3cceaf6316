// What surfaces do to polarization: reference values in double precision, and for every registered class that
// no light comes out with more polarization than there is light, and that the way back is that of
// reciprocity.
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/contracts/mueller_frames.h"
#include "tests/contracts/surface_configurations.h"
#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"

using namespace etendue;

namespace {

using glm::dvec3, glm::dvec4, glm::dmat4;
constexpr double pi = std::numbers::pi, degree = pi / 180;

// Across the plane of incidence of a surface with normal z.
dvec3 across(const dvec3& w) { return glm::normalize(glm::cross(dvec3(0, 0, 1), w)); }

// In frames of s and p.
dmat4 in_plane(const MuellerQuery& q, const MuellerAnswer& a) {
    const dvec3 from = q.from, to = q.to;
    return rotator(a.to, across(to), to) * matrix(a) * rotator(across(from), a.from, -from);
}

ClassRegistry registry() {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    return ClassRegistry(sources);
}

MuellerQuery reflection(double theta, double phi = 0.7) {
    return {direction(theta, phi), direction(theta, phi + pi), event_reflect | event_delta};
}

// b, c, d of lib/stokes.glsl: (Rs - Rp, 2 sqrt(Rs Rp) cos D, … sin D) / (Rs + Rp).
void check_block(const dmat4& m, double b, double c, double d, double tolerance = 2e-6) {
    dmat4 expected(0);
    expected[0][0] = expected[1][1] = 1;
    expected[1][0] = expected[0][1] = b;
    expected[2][2] = expected[3][3] = c;
    expected[3][2] = -d, expected[2][3] = d;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            CAPTURE(i);
            CAPTURE(k);
            CHECK(m[k][i] == doctest::Approx(expected[k][i]).epsilon(tolerance).scale(1));
        }
}

void check_reflectances(const dmat4& m, double s, double p, double phase) {
    const double sum = s + p, both = 2 * std::sqrt(s * p) / sum;
    check_block(m, (s - p) / sum, both * std::cos(phase), both * std::sin(phase));
}

// Part of unpolarized light along `to` that passes two ideal polarizers and what lies between them.
double passing_part(const MuellerAnswer& first, const MuellerAnswer& sheet, const MuellerAnswer& second,
                    const dvec3& to, int lane) {
    const dmat4 whole = matrix(second, lane) * rotator(sheet.to, second.from, to) * matrix(sheet, lane) *
                        rotator(first.to, sheet.from, to) * matrix(first, lane);
    return 0.25 * whole[0][0];  // both in units of the 1/2 that they let through
}

}  // namespace

TEST_CASE("glass polarizes what it reflects and refracts by Fresnel") {
    ClassRegistry classes = registry();
    SurfaceProbe probe(classes, "dielectric", {nlohmann::json::object()});
    const auto reflected = [&](double angle, SurfaceSurroundings at) {
        const MuellerQuery q = reflection(angle * degree);
        return in_plane(q, probe.polarize(0, at, {{q}})[0]);
    };
    // Of the index 1.5; r_s < 0 and r_p > 0 below Brewster's angle, both < 0 above.
    const SurfaceSurroundings air{1, 1.5f}, glass{1.5f, 1};
    check_reflectances(reflected(30, air), 0.057796105, 0.025249147, pi);
    check_reflectances(reflected(45, air), 0.092013363, 0.008466459, pi);
    check_reflectances(reflected(60, air), 0.176571488, 0.001801938, 0);
    check_reflectances(reflected(75, air), 0.399356027, 0.106765099, 0);
    check_reflectances(reflected(56.309932, air), 0.147928994, 0, 0);
    // Total reflection.
    for (const auto& [angle, phase] :
         {std::pair{45.0, 36.869898}, {60.0, 40.459083}, {51.671190, 45.239730}, {50.229432, 45.0}})
        check_block(reflected(angle, glass), 0, std::cos(phase * degree), std::sin(phase * degree));
    // Refraction: T_s : T_p, no phase.
    for (double angle : {0.01, 30.0, 60.0, 85.0}) {
        const double c = std::cos(angle * degree),
                     t = std::sqrt(1 - std::pow(std::sin(angle * degree) / 1.5, 2));
        const double s = 2 * c / (c + 1.5 * t), p = 2 * c / (1.5 * c + t), sum = s * s + p * p;
        const MuellerQuery in{direction(angle * degree, 0.7), direction(std::acos(-t), 0.7 + pi),
                              event_transmit | event_delta};
        const MuellerQuery out{in.to, in.from, in.event};
        check_block(in_plane(in, probe.polarize(0, air, {{in}})[0]), (s * s - p * p) / sum, 2 * s * p / sum,
                    0);
        check_block(in_plane(out, probe.polarize(0, air, {{out}})[0]), (s * s - p * p) / sum, 2 * s * p / sum,
                    0);
    }
}

TEST_CASE("metals turn what they reflect elliptic") {
    ClassRegistry classes = registry();
    SurfaceProbe probe(
        classes, "conductor",
        {{{"eta", 0.183}, {"k", 3.43}}, {{"eta", 1.37}, {"k", 7.62}}, {{"eta", 1.5}, {"k", 1e-4}}});
    const auto reflected = [&](size_t metal, double angle) {
        const MuellerQuery q = reflection(angle * degree);
        return in_plane(q, probe.polarize(metal, {}, {{q}})[0]);
    };
    check_reflectances(reflected(0, 45), 0.961149192, 0.923807768, 157.224604 * degree);
    check_reflectances(reflected(1, 45), 0.938591665, 0.880954314, 169.761451 * degree);
    const dmat4 gold70 = reflected(0, 70);
    CHECK(std::atan2(gold70[2][3], gold70[2][2]) == doctest::Approx(108.126825 * degree).epsilon(1e-6));
    CHECK(reflected(0, 74.8585)[2][2] == doctest::Approx(0).scale(1).epsilon(1e-5));  // the principal angle
    // What hardly absorbs is glass.
    const dmat4 glass = reflected(2, 30);
    CHECK(glass[2][2] ==
          doctest::Approx(-2 * std::sqrt(0.057796105 * 0.025249147) / 0.083045252).epsilon(1e-3));
}

TEST_CASE("a pane adds its echoes, s and p apart") {
    ClassRegistry classes = registry();
    SurfaceProbe probe(classes, "thin_dielectric", {nlohmann::json::object()});
    const MuellerQuery reflects = reflection(60 * degree);
    const MuellerQuery passes{reflects.from, -reflects.from, event_transmit | event_delta | event_straight};
    CHECK(in_plane(reflects, probe.polarize(0, {}, {{reflects}})[0])[1][0] ==
          doctest::Approx(0.148274198 / 0.151871590).epsilon(1e-5));
    CHECK(in_plane(passes, probe.polarize(0, {}, {{passes}})[0])[1][0] ==
          doctest::Approx(-0.148274198 / 0.848128410).epsilon(1e-5));
}

// Light goes in along the normal, is depolarized, and comes out by Fresnel: (Tp - Ts) / (Tp + Ts).
TEST_CASE("what leaves the body of a plastic is polarized by its face") {
    ClassRegistry classes = registry();
    SurfaceProbe probe(
        classes, "principled",
        {{{"metallic", 0}, {"specular", 0}, {"ior", 1.5}, {"base_color", {0.5, 0.5, 0.5, 1}}}});
    for (const auto& [angle, degree_of] : {std::pair{60.0, 0.0959}, {1e-3, 0.0}}) {
        const MuellerQuery out{{0, 0, 1}, direction(angle * degree, 0.4), 0}, in{out.to, out.from, 0};
        const MuellerAnswer leaves = probe.polarize(0, {}, {{out}})[0],
                            enters = probe.polarize(0, {}, {{in}})[0];
        const dmat4 leaving = rotator(leaves.to, across(out.to), out.to) * matrix(leaves);
        CHECK(leaving[0][1] == doctest::Approx(-degree_of).epsilon(1e-3).scale(1e-2));
        CHECK(std::fabs(leaving[0][2]) < 1e-5);
        CHECK(std::fabs(leaving[1][1]) + std::fabs(leaving[2][2]) + std::fabs(leaving[3][3]) < 1e-5);
        const dmat4 entering = matrix(enters) * rotator(across(in.from), enters.from, -dvec3(in.from));
        CHECK(entering[1][0] == doctest::Approx(-degree_of).epsilon(1e-3).scale(1e-2));
    }
}

TEST_CASE("a twisted nematic cell between polarizers along its directors") {
    ClassRegistry classes = registry();
    SurfaceProbe cell(classes, "lc_cell", {nlohmann::json::object()}),
        sheets(classes, "linear_polarizer", {{{"axis", 0}}, {{"axis", pi / 2}}});
    // Part of the light that the first polarizer lets through and the cell turns, so that crossed ones do: of
    // the three wavelengths.
    const auto crossed = [&](const SurfaceSurroundings& at, const glm::vec3& to, int lane) {
        const MuellerQuery q{-to, to, event_transmit | event_delta | event_straight};
        return 2 * passing_part(sheets.polarize(0, at, {{q}})[0], cell.polarize(0, at, {{q}})[0],
                                sheets.polarize(1, at, {{q}})[0], to, lane);
    };
    // Gooch & Tarry 1975: sin²(pi/2 sqrt(1 + u²)) / (1 + u²), u = 2 d dn / lambda; the director on the side
    // of the normal lies along x, and light comes from there.
    const double nm[] = {611, 549, 464};
    for (int lane = 0; lane < 3; ++lane) {
        const double u = 2 * 4330 * 0.1 / nm[lane], v = std::sqrt(1 + u * u);
        CHECK(crossed({1.55f, 1.55f}, {0, 0, -1}, lane) ==
              doctest::Approx(1 - std::pow(std::sin(pi / 2 * v) / v, 2)).epsilon(1e-4));
    }
    // Oblique: Berreman's 4 x 4 matrices in glass of index 1.55, 30 degrees in air; between 450, 550 and 650
    // nm.
    const double sine = 0.5 / 1.55, expected[] = {0.982989, 0.922720, 0.982989, 0.997054};
    for (int i = 0; i < 4; ++i) {
        const double azimuth = 45 * degree * i;
        const glm::vec3 to(sine * std::cos(azimuth), sine * std::sin(azimuth), -std::sqrt(1 - sine * sine));
        CAPTURE(i);
        CHECK(crossed({1.55f, 1.55f}, to, 1) == doctest::Approx(expected[i]).epsilon(5e-3));
    }
}

// Axes are projected onto every direction anew: where a component of it changes its sign, nothing may jump.
TEST_CASE("a sensitive tint has no seam over a field of 60 degrees") {
    ClassRegistry classes = registry();
    SurfaceProbe plate(classes, "retarder", {{{"axis", 0.6}, {"thickness", 551 / 0.009}}}),
        sheets(classes, "linear_polarizer", {{{"axis", 0.1}}, {{"axis", 0.1 + pi / 2}}});
    // Greatest difference of neighbours among count x count directions, with and without some at 0.
    const auto greatest_jump = [&](int count) {
        std::vector<MuellerQuery> queries;
        for (int i = 0; i < count * count; ++i) {
            const auto place = [&](int k) { return std::tan(30 * degree) * (2.0 * k / (count - 1) - 1); };
            const glm::vec3 to = glm::normalize(dvec3(place(i % count), place(i / count), -1));
            queries.push_back({-to, to, event_transmit | event_delta | event_straight});
        }
        const auto p = plate.polarize(0, {}, queries), a = sheets.polarize(0, {}, queries),
                   b = sheets.polarize(1, {}, queries);
        double jump = 0;
        for (int i = 0; i < count * count; ++i)
            for (int lane = 0; lane < 3; ++lane) {
                const auto part = [&](int k) { return passing_part(a[k], p[k], b[k], queries[k].to, lane); };
                if (i % count > 0) jump = std::max(jump, std::fabs(part(i) - part(i - 1)));
                if (i >= count) jump = std::max(jump, std::fabs(part(i) - part(i - count)));
            }
        return jump;
    };
    for (const int count : {15, 16}) {
        const double coarse = greatest_jump(count), fine = greatest_jump(4 * (count - 1) + 1);
        CAPTURE(coarse);
        CHECK(coarse > 0.01);
        CHECK(coarse < 0.2);
        CHECK(fine < 0.3 * coarse);
    }
}

TEST_CASE("no surface makes more polarization than there is light, and light goes back as it came") {
    ClassRegistry classes = registry();
    uint32_t state = 1;
    const auto random = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / 16777216.0; };
    for (const ClassInfo& info : classes.classes(Interface::surface)) {
        const auto configurations = surface_configurations(info.name);
        std::vector<nlohmann::json> parameters;
        for (const auto& c : configurations) parameters.push_back(c.parameters);
        SurfaceProbe probe(classes, info.name, parameters);
        for (size_t record = 0; record < parameters.size(); ++record)
            for (const bool importance : {false, true}) {
                const SurfaceSurroundings at{configurations[record].ior_above,
                                             configurations[record].ior_below, importance};
                std::vector<MuellerQuery> there, back;
                for (int i = 0; i < 12; ++i) {
                    const glm::vec3 wo = direction(std::acos(2 * random() - 1), 2 * pi * random());
                    for (const SurfaceSample& s : probe.sample(record, at, wo, 16, uint32_t(i)).samples) {
                        if (s.event == 0) continue;
                        const uint32_t event = s.event & event_delta ? s.event : 0;
                        const glm::vec3 from = importance ? wo : s.wi, to = importance ? s.wi : wo;
                        there.push_back({from, to, event}), back.push_back({to, from, event});
                    }
                }
                if (there.empty()) continue;
                const auto forth = probe.polarize(record, at, there),
                           reversed = probe.polarize(record, at, back);
                double most = 0;
                size_t irreversible = 0;
                for (size_t i = 0; i < there.size(); ++i)
                    for (int lane = 0; lane < 3; ++lane) {
                        const dvec3 from = there[i].from, to = there[i].to;
                        const dmat4 m = matrix(forth[i], lane);
                        for (int k = 0; k < 4; ++k) {
                            const dvec4 s(1, direction(std::acos(2 * random() - 1), 2 * pi * random()));
                            const dvec4 out = m * s;
                            most = std::max(most, glm::length(dvec3(out.y, out.z, out.w)) - out.x);
                        }
                        // Frames (x, y, z) of light become (x, -y, -z) of light that goes back.
                        dmat4 flip(1);
                        flip[2][2] = -1;
                        const dmat4 expected = flip * glm::transpose(m) * flip;
                        const dmat4 found = rotator(reversed[i].to, forth[i].from, from) *
                                            matrix(reversed[i], lane) *
                                            rotator(forth[i].to, reversed[i].from, -to);
                        double apart = 0;
                        for (int k = 0; k < 4; ++k)
                            apart = std::max(apart, glm::length(expected[k] - found[k]));
                        irreversible += apart > 2e-3;
                    }
                INFO(info.name, " ", configurations[record].label, importance ? ", power" : ", radiance");
                CHECK(most < 1e-4);
                // Near the critical angle of a facet single precision does not tell on which side of it light
                // is.
                if (configurations[record].is_reciprocal) CHECK(50 * irreversible <= 3 * there.size());
            }
    }
}
