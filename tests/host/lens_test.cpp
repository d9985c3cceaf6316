// Lenses: paraxial figures and real rays against values that are known in closed form, or from patents.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "host/error.h"
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

doctest::Approx about(double value, double relative = 1e-7) { return doctest::Approx(value).epsilon(relative); }

const char* double_gauss = "tests/host/lenses/own_dgauss_tronnier.txt";

}  // namespace

TEST_CASE("a plano-convex lens has its focal length, its focus and its spherical aberration") {
    for (const auto& [table, focus, crossings] :
         {std::tuple{"50 10 1.5 40\n0 93.3333 1 40\n", 93.333333333, glm::dvec3(93.045487, 92.172002, 90.681145)},
          std::tuple{"0 10 1.5 40\n-50 100 1 40\n", 100.0, glm::dvec3(98.870029, 95.417983, 89.436241)}}) {
        const Prescription p = lens(table);
        CHECK(figures(p).focal_length == about(100));
        CHECK(figures(p).rear_focus == about(focus));
        for (int i = 0; i < 3; ++i) CHECK(crossing(p, 5 * (i + 1)) == about(crossings[i], 1e-8));
    }
}

TEST_CASE("a ball lens") {
    const auto ball = [](const std::string& index) {
        return lens("5 10 " + index + " 10\n-5 2 1 10\n");
    };
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
    // Light from within a ball of index 1.5, 20/3 mm before its centre, leaves it as from 15 mm before the centre.
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
        CHECK(std::sin(angle) / out.direction.y == about(1.5, 1e-12));  // Abbe's condition: m = 2.25 = 1.5 × 1.5
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
    const double heights[] = {5, 10, 15, 20, 25}, expected[] = {-.001325, -.008851, -.019242, -.006489, .094472};
    p.surfaces[p.surfaces.size() - 2].thickness = f.rear_focus;
    for (int i = 0; i < 5; ++i) CHECK(std::abs(parallel(p, heights[i]).at_image().position.y - expected[i]) < 6e-7);
    Prescription near = p;
    near.object_distance = 2000;
    CHECK(figures(near).image == about(77.42510));
    CHECK(figures(near).magnification == about(-.0517621, 1e-6));
    // Spots over the whole pupil, as a program of few lines in Python finds them, too; on coarse grids they are told
    // as .02888 .0406 .0636 .0749, the clear part as 1 .903 .740 .596.
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

// ---- Files of others

namespace {

// Empty where they are absent, of which it tells.
std::filesystem::path shared_lenses() {
    const char* shared = std::getenv("ETENDUE_SHARED");
    const std::filesystem::path folder = std::filesystem::path(shared ? shared : "") / "photometry/lenses";
    if (shared && std::filesystem::exists(folder)) return folder;
    MESSAGE("SKIPPED: shared lens files are not there");
    return {};
}

double focal_length(const Prescription& p, double at_nm) { return paraxial_figures(p, at_nm).focal_length; }

}  // namespace

TEST_CASE("lens files: focal lengths of the shared files") {
    const std::filesystem::path folder = shared_lenses();
    if (folder.empty()) return;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        try {
            const Prescription p = read_prescription(entry.path());
            const ParaxialFigures f = figures(p);
            std::string line = fmt::format("{}: {} surfaces, EFL {} BFL {} EPD {} F/{}", entry.path().filename().string(), p.surfaces.size(), f.focal_length, f.rear_focus, f.entrance_diameter, f.f_number);
            for (const LensField& field : p.fields) {
                const LensSpot spot = lens_spot(p, f, field, 32);
                line += fmt::format("\n   {} {}: chief {} {} rms {} clear {}", field.value.x, field.value.y, spot.chief.x, spot.chief.y, spot.rms, spot.clear);
            }
            for (auto& w : p.warnings) line += "\n   " + w;
            MESSAGE(line);
        } catch (const Error& e) {
            MESSAGE(std::string(e.what()));
        }
    }
}
