// Lenses: paraxial figures and real rays against values that are known in closed form, or from patents. Their
// files: lens_file_test.cpp.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "host/lens/pupil_rays.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

constexpr double nm = 587.5618;

// A lens from a table; see read_prescription.
Prescription lens(const std::string& table) {
    TemporaryFolder folder;
    write_text(folder / "lens.txt", table);
    return read_prescription(folder / "lens.txt");
}

ParaxialFigures figures(const Prescription& p) { return paraxial_figures(p, p.primary_nm()); }

TracedRay parallel(const Prescription& p, double height) {
    return LensTracer(p, p.primary_nm()).trace({{0, height, -1}, {0, 0, 1}});
}

// How far behind the last surface the ray crosses the axis.
double crossing(const Prescription& p, double height) {
    const TracedRay traced = parallel(p, height);
    REQUIRE(traced.fate == TracedRay::Fate::arrives);
    const LensRay& last = traced.points[p.surfaces.size() - 2];
    return last.position.z - last.position.y * last.direction.z / last.direction.y;
}

doctest::Approx about(double value, double relative = 1e-7) {
    return doctest::Approx(value).epsilon(relative);
}

const char* double_gauss = "tests/host/lenses/own_dgauss_tronnier.txt";

}  // namespace

TEST_CASE("a plano-convex lens has its focal length, its focus and its spherical aberration") {
    for (const auto& [table, focus, crossings] :
         {std::tuple{"50 10 1.5 40\n0 93.3333 1 40\n", 93.333333333,
                     glm::dvec3(93.045487, 92.172002, 90.681145)},
          std::tuple{"0 10 1.5 40\n-50 100 1 40\n", 100.0, glm::dvec3(98.870029, 95.417983, 89.436241)}}) {
        const Prescription p = lens(table);
        CHECK(figures(p).focal_length == about(100));
        CHECK(figures(p).rear_focus == about(focus));
        for (int i = 0; i < 3; ++i) CHECK(crossing(p, 5 * (i + 1)) == about(crossings[i], 1e-8));
    }
}

TEST_CASE("a ball lens") {
    const auto ball = [](const std::string& index) { return lens("5 10 " + index + " 10\n-5 2 1 10\n"); };
    CHECK(figures(ball("1.5")).focal_length == about(7.5));
    CHECK(figures(ball("1.5")).rear_focus == about(2.5));
    CHECK(figures(ball("1.5")).front_principal == about(5));
    CHECK(figures(ball("1.5")).rear_principal == about(-5));
    CHECK(figures(ball("1.5168")).focal_length == about(7.337461));
    CHECK(figures(ball("1.5168")).rear_focus == about(2.337461, 2e-7));
    CHECK(std::abs(figures(ball("2")).rear_focus) < 1e-12);
    const glm::dvec3 crossings(2.416160, 2.158222, 1.703902);
    for (int i = 0; i < 3; ++i) CHECK(crossing(ball("1.5"), i + 1) == about(crossings[i], 4e-7));
}

TEST_CASE("conics that are perfect bring all rays to one point") {
    const Prescription hyperbola = lens("0 20 1.5 60\n-50 100 1 60 -2.25\n");
    CHECK(figures(hyperbola).focal_length == about(100));
    // An ellipsoid whose focus lies in the glass.
    const Prescription ellipsoid = lens("33.33333333333333 100 1.5 60 -0.4444444444444444\n0 1 1.5 60\n");
    for (const double height : {1.0, 5.0, 15.0, 25.0}) {
        CHECK(crossing(hyperbola, height) == about(100, 1e-12));
        CHECK(std::abs(parallel(ellipsoid, height).points[1].position.y) < 1e-12);
    }
    CHECK(figures(ellipsoid).matrix.a == doctest::Approx(0).epsilon(1e-12));  // that plane is the focal plane
}

TEST_CASE("the aplanatic points of a sphere: all rays from one seem to come from the other") {
    // Light from within a ball of index 1.5, 20/3 mm before its centre, leaves it as from 15 mm before the
    // centre.
    Prescription ball;
    ball.object_glass = Glass::constant("1.5", 1.5), ball.object_distance = 50.0 / 3;
    ball.surfaces.resize(2);
    ball.surfaces[0].shape.curvature = -0.1;
    ball.wavelengths = {{nm, 1}};
    CHECK(paraxial_figures(ball, nm).magnification == about(2.25, 1e-12));
    CHECK(paraxial_figures(ball, nm).image == about(-25, 1e-12));
    for (const double angle : {0.1, 0.5, 0.95}) {
        CAPTURE(angle);
        const glm::dvec3 direction(0, std::sin(angle), std::cos(angle));
        const TracedRay traced = LensTracer(ball, nm).trace({{0, 0, -50.0 / 3}, direction});
        REQUIRE(traced.points.size() >= 1);
        const LensRay& out = traced.points[0];
        CHECK(out.position.z - out.position.y * out.direction.z / out.direction.y == about(-25, 1e-12));
        CHECK(std::sin(angle) / out.direction.y ==
              about(1.5, 1e-12));  // Abbe's condition: m = 2.25 = 1.5 × 1.5
    }
}

TEST_CASE("Tronnier's double Gauss") {
    Prescription p = read_prescription(source_path(double_gauss));
    const ParaxialFigures f = figures(p);
    CHECK(f.focal_length == about(100.71633));
    CHECK(f.rear_focus == about(72.21181));
    CHECK(-f.front_focus == about(54.24489));
    CHECK(f.entrance_diameter == about(49.61021));
    CHECK(f.f_number == about(2.03015, 2e-6));
    CHECK(f.entrance_pupil == about(39.89297, 2e-7));
    CHECK(f.exit_pupil == about(-35.54271));
    const double heights[] = {5, 10, 15, 20, 25},
                 expected[] = {-.001325, -.008851, -.019242, -.006489, .094472};
    p.surfaces[p.surfaces.size() - 2].thickness = f.rear_focus;
    for (int i = 0; i < 5; ++i)
        CHECK(std::abs(parallel(p, heights[i]).at_image().position.y - expected[i]) < 6e-7);
    Prescription near = p;
    near.object_distance = 2000;
    CHECK(figures(near).image == about(77.42510));
    CHECK(figures(near).magnification == about(-.0517621, 1e-6));
    // Spots over the whole pupil, as a program of few lines in Python finds them, too; on coarse grids they
    // are told as .02888 .0406 .0636 .0749, the clear part as 1 .903 .740 .596.
    const double angles[] = {0, 5, 10, 14}, rms[] = {.02747, .04015, .06359, .07488},
                 clear[] = {1, .9103, .7484, .6025}, chief[] = {0, 8.80689, 17.71974, 24.99567};
    for (int i = 0; i < 4; ++i) {
        CAPTURE(angles[i]);
        const LensSpot spot = lens_spot(p, f, {{0, angles[i]}}, 200);
        CHECK(std::abs(spot.chief.y - chief[i]) < 6e-6);
        CHECK(spot.rms == about(rms[i], 1e-3));
        CHECK(spot.clear == about(clear[i], 2e-3));
    }
}

TEST_CASE("lines meet surfaces on the sheet of the vertex") {
    const auto meet = [](const SurfaceShape& shape, glm::dvec3 from, glm::dvec3 towards) {
        const glm::dvec3 d = glm::normalize(towards);
        const auto t = shape.intersect(from, d);
        return t ? from + *t * d : glm::dvec3(NAN);
    };
    SUBCASE("a paraboloid, along its axis, where the equation is no longer quadratic") {
        const SurfaceShape paraboloid{-0.01, -1};
        CHECK(meet(paraboloid, {10, 0, -50}, {0, 0, 1}).z == about(-0.5, 1e-15));
        CHECK(meet(paraboloid, {10, 0, -50}, {1e-13, 0, 1}).z == about(-0.5, 1e-12));
    }
    SUBCASE("a plane") { CHECK(meet({}, {3, 4, -5}, {0, 0.6, 0.8}) == glm::dvec3(3, 7.75, 0)); }
    SUBCASE("a steep hyperboloid has another sheet, which is not met") {
        const SurfaceShape hyperboloid{-0.1, -10};  // the other vertex at z = 2 / (c (1 + K)) = 20/9
        const glm::dvec3 at = meet(hyperboloid, {1, 0, 30}, {0, 0, -1});
        CHECK(at.z == about(hyperboloid.sag(1, 0), 1e-15));
        CHECK(at.z < 0);
        // A flat line that would come to the other sheet first.
        CHECK(meet(hyperboloid, {0, 0, 10}, {0.02, 0, -1}).z < 0);
    }
    SUBCASE("a start on the surface stays there") {
        for (const double conic : {0.0, -1.0, -4.0}) {
            const SurfaceShape shape{0.02, conic};
            const glm::dvec3 on(3, 5, shape.sag(3, 5));
            CHECK(glm::distance(meet(shape, on, {0.1, -0.2, 1}), on) < 1e-14);
        }
    }
    SUBCASE("of two crossings that nearer to the axis") {
        for (const double conic : {-4.0, -1.0, 0.0, 1.0}) {
            const SurfaceShape shape{0.1, conic};
            const glm::dvec3 inner(-2, 0, shape.sag(2, 0)), outer(6, 0, shape.sag(6, 0));
            CHECK(glm::distance(meet(shape, inner - 30.0 * (outer - inner), outer - inner), inner) < 1e-12);
            CHECK(glm::distance(meet(shape, outer + 30.0 * (outer - inner), inner - outer), inner) < 1e-12);
        }
    }
    SUBCASE("an asphere equals the conic it expands, to the order of the expansion") {
        // A sphere of radius 100 as its series: c/2 r² + c³/8 r⁴ + c⁵/16 r⁶ + 5 c⁷/128 r⁸ + 7 c⁹/256 r¹⁰.
        const double c = 0.01;
        const SurfaceShape sphere{c, 0}, series{0,
                                                0,
                                                {c / 2, std::pow(c, 3) / 8, std::pow(c, 5) / 16,
                                                 5 * std::pow(c, 7) / 128, 7 * std::pow(c, 9) / 256}};
        const glm::dvec3 a = meet(sphere, {2, -3, -40}, {0.1, 0.2, 1}),
                         b = meet(series, {2, -3, -40}, {0.1, 0.2, 1});
        CHECK(glm::distance(a, b) < 1e-10);
        CHECK(glm::distance(sphere.normal(a), series.normal(b)) < 1e-11);
        CHECK(series.vertex_curvature() == c);
    }
    SUBCASE("an asphere that turns back") {
        const SurfaceShape gull{0.05, -1, {0, -2e-4}};
        for (const double x : {0.0, 3.0, 8.0, 12.0, 16.0}) {
            const glm::dvec3 at = meet(gull, {x, 1, -200}, {0.05, 0, 1});
            CHECK(std::abs(at.z - gull.sag(at.x, at.y)) < 1e-12);
        }
    }
    SUBCASE("far starts lose nothing") {
        const SurfaceShape shape{0.02, -0.5, {0, 1e-6}};
        const glm::dvec3 d = glm::normalize(glm::dvec3(0.1, 0.05, 1)), here = meet(shape, {1, 2, -10}, d);
        CHECK(glm::distance(meet(shape, glm::dvec3(1, 2, -10) - 1e5 * d, d), here) < 1e-10);
    }
    SUBCASE("what misses, misses") {
        CHECK(std::isnan(meet({0.1, 0}, {0, 11, -5}, {0, 0, 1}).z));
        CHECK(std::isnan(meet({0.1, 0}, {-20, 0, 15}, {1, 0, 0}).z));    // beyond the equator
        CHECK(std::isnan(meet({-0.1, -10}, {-20, 0, 5}, {1, 0, 0}).z));  // the other sheet alone
        CHECK(std::isnan(meet({0.1, 0, {0, 1e-5}}, {0, 11, -5}, {0, 0, 1}).z));
    }
    SUBCASE("a cylinder is the same for all x") {
        const SurfaceShape cylinder{0.1, 0, {}, true};
        CHECK(meet(cylinder, {500, 3, -5}, {0, 0, 1}).z == about(10 - std::sqrt(91.0), 1e-14));
        CHECK(cylinder.normal({500, 0, 0}) == glm::dvec3(0, 0, 1));
    }
}

TEST_CASE("gratings send their orders where the tangential wave vector says") {
    Prescription p = lens("0 10 1 20\n");
    p.wavelengths = {{550, 1}};
    p.surfaces[0].grating = LensGrating{1000, -1};
    const double tilt = std::numbers::pi / 4;
    const auto angle = [&](double order, bool mirror = false) {
        p.surfaces[0].grating->order = order, p.surfaces[0].is_mirror = mirror;
        const TracedRay traced = LensTracer(p, 550).trace({{0, 0, 0}, {0, std::sin(tilt), std::cos(tilt)}});
        if (traced.fate == TracedRay::Fate::evanescent) return infinite;
        const glm::dvec3 d = traced.points[0].direction;
        CHECK((d.z < 0) == mirror);
        return std::asin(d.y) * 180 / std::numbers::pi;
    };
    CHECK(angle(-1) == about(9.03900, 1e-6));
    CHECK(angle(-2) == about(-23.13464, 1e-6));
    CHECK(angle(0) == about(45, 1e-12));
    CHECK(std::isinf(angle(1)));
    CHECK(angle(-1, true) == about(9.03900, 1e-6));
}

TEST_CASE("a mirror's focal length, and light that runs back") {
    const Prescription p = lens("-100 -50 mirror 20 -1\n");
    CHECK(figures(p).focal_length == about(50));
    CHECK(figures(p).rear_focus == about(-50));
    for (const double height : {1.0, 5.0, 9.0})
        CHECK(std::abs(parallel(p, height).at_image().position.y) < 1e-13);
}

TEST_CASE("apertures stop rays, and say where; what is traced goes on") {
    const Prescription p = lens("50 10 1.5 40\n0 90 1 20\n");
    CHECK(parallel(p, 5).passes());
    CHECK(parallel(p, 15).stopped == 1);
    CHECK(parallel(p, 15).fate == TracedRay::Fate::arrives);
    CHECK(parallel(p, 21).stopped == 0);
}

TEST_CASE("fields reach the heights that they name") {
    Prescription p = read_prescription(source_path(double_gauss));
    p.field_kind = Prescription::FieldKind::real_image_height;
    CHECK(lens_spot(p, figures(p), {{0, 20}}, 8).chief.y == about(20, 1e-10));
    p.object_distance = 2000;
    p.surfaces[p.surfaces.size() - 2].thickness = figures(p).image;
    CHECK(lens_spot(p, figures(p), {{3, -15}}, 8).chief.y == about(-15, 1e-10));
    CHECK(lens_spot(p, figures(p), {{3, -15}}, 8).chief.x == about(3, 1e-10));
    p.field_kind = Prescription::FieldKind::object_height;
    CHECK(lens_spot(p, figures(p), {{0, 1}}, 8).chief.y == about(figures(p).magnification, 1e-4));
}
