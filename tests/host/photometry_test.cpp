// Photometric files: flux and peak against an independent integral, what is said of bad files, and files that
// are written and read again.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "host/error.h"
#include "host/photometry/ldt_file.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

using Kind = LuminousOpening::Kind;
using std::numbers::pi;

IntensityDistribution own(const std::string& name) {
    return read_photometric_file(source_path("tests/host/photometry/" + name));
}

struct Folder {
    TemporaryFolder folder;
    IntensityDistribution read(const std::string& text, const std::string& name = "lamp.ies") const {
        write_text(folder / name, text);
        return read_photometric_file(folder / name);
    }
    // The one line that reading fails with.
    std::string complaint(const std::string& text, const std::string& name = "lamp.ies") const {
        try {
            read(text, name);
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            const std::string line = e.what();
            CHECK_MESSAGE(line.find(name) != std::string::npos, line);
            return line;
        }
        return "no error";
    }
};

// A file of 1000 cd down to 500 cd at 90 degrees, for one thing that differs.
std::string ies(const std::string& numbers, const std::string& version = "IESNA:LM-63-2002",
                const std::string& tilt = "TILT=NONE") {
    return version + "\n[TEST] x\n" + tilt + "\n" + numbers;
}
std::string with_opening(const std::string& sizes, const std::string& version) {
    return ies("1 -1 1 2 1 1 2 " + sizes + "\n1 1 10\n0 90\n0\n1000 500\n", version);
}
// One value a plane of type C, at 0 and 90 degrees alike.
std::string with_planes(const std::string& angles, const std::string& values, size_t count) {
    return ies(fmt::format("1 -1 1 2 {} 1 2 0 0 0\n1 1 10\n0 90\n{}\n{}\n", count, angles, values));
}

void check_says(const std::string& line, const std::vector<std::string>& words) {
    for (const std::string& word : words) CHECK_MESSAGE(line.find(word) != std::string::npos, line);
}

double largest_difference(const IntensityDistribution& a, const IntensityDistribution& b) {
    double worst = 0;
    for (double c = 0.5; c < 360; c += 7.3)
        for (double gamma = 0.2; gamma < 180; gamma += 1.7)
            worst = std::max(worst, std::abs(a.intensity(c, gamma) - b.intensity(c, gamma)));
    return worst;
}

}  // namespace

TEST_CASE("photometry: flux, peak and size of files of every kind") {
    struct Gold {
        const char* file;
        double flux, peak;
        glm::dvec3 size;
    };
    for (const Gold& g :
         std::vector<Gold>{{"own_asym_0_360.ies", 3139.597, 1500, {0.1, 0.1, 0}},
                           {"own_lambert_1986_commas_feet.ies", 3139.597, 1000, glm::dvec3(1, 1, 0)},
                           {"own_lambert_iesna91_one_per_line.ies", 3139.597, 1000, glm::dvec3(0)},
                           {"own_lambert_type_a.ies", 3125.667, 1000, {0.1, 0.1, 0}},
                           {"own_lambert_type_b.ies", 3125.667, 1000, {0.1, 0.1, 0}},
                           {"own_lambert_type_b_quarter.ies", 3125.667, 1000, {0.1, 0.1, 0}},
                           {"own_isym0_asym.ldt", 999.3649, 477.465, {0.1, 0.1, 0}},
                           {"own_isym1_lambert.ldt", 999.3649, 318.310, {0.1, 0.1, 0}},
                           {"own_isym2_asym.ldt", 999.3649, 477.465, {0.1, 0.1, 0}},
                           {"own_isym4_asym.ldt", 999.3649, 477.465, {0.1, 0.1, 0}}}) {
        CAPTURE(g.file);
        const IntensityDistribution d = own(g.file);
        CHECK(d.flux() == doctest::Approx(g.flux).epsilon(1e-6));
        CHECK(d.peak() == doctest::Approx(g.peak).epsilon(1e-6));
        CHECK(d.warnings.empty());
        if (std::string(g.file).ends_with(".ies")) CHECK(glm::length(d.opening.size - g.size) < 1e-5);
    }
}

TEST_CASE("photometry: flux and peak of the shared files") {
    const char* shared = std::getenv("ETENDUE_SHARED");
    if (!shared) {
        MESSAGE("SKIPPED: ETENDUE_SHARED is not set; shared photometric files are not read");
        return;
    }
    const std::filesystem::path folder = std::filesystem::path(shared) / "photometry";
    if (!std::filesystem::exists(folder)) return;
    const auto check = [&](const std::string& file, double flux, double peak, Kind kind) {
        CAPTURE(file);
        const IntensityDistribution d = read_photometric_file(folder / file);
        CHECK(d.flux() == doctest::Approx(flux).epsilon(5e-4));
        CHECK(d.peak() == doctest::Approx(peak).epsilon(5e-4));
        CHECK(int(d.opening.kind) == int(kind));
    };
    check("ies/pv95_absolute_photometry.ies", 904.525, 2200, Kind::disk);
    check("ies/pv95_absolute_photometry_with_multiplier.ies", 1356.787, 3300, Kind::disk);
    check("ies/pv95_ellipse_opening_along_width.ies", 904.525, 2200, Kind::cylinder);
    check("ies/pv95_horizontal_cylinder_opening_along_length.ies", 904.525, 2200, Kind::cylinder);
    check("ies/pv95_imperial_units.ies", 904.525, 2200, Kind::box);
    check("ies/pv95_label_lines.ies", 904.525, 2200, Kind::box);
    check("ies/pv95_point_opening.ies", 904.525, 2200, Kind::point);
    check("ies/pv95_relative_photometry.ies", 904.525, 2200, Kind::disk);
    check("ies/pv95_relative_photometry_with_multiplier.ies", 1356.787, 3300, Kind::disk);
    check("ies/pv95_round_opening_with_height.ies", 904.525, 2200, Kind::cylinder);
    check("ies/pv95_sphere_opening.ies", 904.525, 2200, Kind::sphere);
    check("ies/pv_dummy.ies", 904.525, 2200, Kind::disk);
    check("ldt/pv_absolute.ldt", 904.5245 / 2, 1100, Kind::point);
    check("ldt/pv_dummy.ldt", 904.5245, 2200, Kind::disk);
    check("ldt/pv_multiple_lamp_sets.ldt", 904.5245 / 2, 1100, Kind::point);
    check("ldt/pv_no_symmetry.ldt", 3722.0199, 3051, Kind::point);
    check("ldt/pv_symmetry_to_c0c180.ldt", 3140.8252, 2866, Kind::point);
    check("ldt/pv_symmetry_to_c90c270.ldt", 3140.8252, 2866, Kind::point);
    check("ldt/pv_symmetry_to_c0c90c180c270.ldt", 2094.6749, 2533, Kind::point);
}

TEST_CASE("photometry: one lamp in every symmetry and type has the same intensities") {
    const IntensityDistribution all = own("own_asym_0_360.ies");
    for (const double c : {15.0, 90.0, 210.0, 300.0})
        CHECK(all.intensity(c, 60) ==
              doctest::Approx(500 * (1 + 0.5 * std::sin(c * pi / 180))).epsilon(1e-6));
    CHECK(all.intensity(0, 91) == 0);
    const IntensityDistribution lambert = own("own_lambert_iesna91_one_per_line.ies");
    for (const char* file :
         {"own_lambert_type_a.ies", "own_lambert_type_b.ies", "own_lambert_type_b_quarter.ies"})
        CHECK(largest_difference(own(file), lambert) < 12);  // tables in steps of 10 degrees
    CHECK(largest_difference(own("own_lambert_type_b.ies"), own("own_lambert_type_b_quarter.ies")) < 1e-9);
    CHECK(largest_difference(own("own_lambert_1986_commas_feet.ies"), lambert) < 1e-9);
}

TEST_CASE("photometry: types A and B have their poles across the beam") {
    // Brightest at V = 40, H = 20.
    const std::string numbers = "\n1 1 10\n-60 40 80\n-70 20 60\n0 0 0 0 900 0 0 0 0\n";
    const Folder folder;
    const IntensityDistribution b = folder.read(ies("1 -1 1 3 3 2 2 0 0 0" + numbers)),
                                a = folder.read(ies("1 -1 1 3 3 3 2 0 0 0" + numbers));
    const double v = 40 * pi / 180, h = 20 * pi / 180;
    CHECK(b.intensity({std::cos(h) * std::sin(v), std::sin(h), -std::cos(h) * std::cos(v)}) ==
          doctest::Approx(900).epsilon(1e-9));
    CHECK(a.intensity({std::sin(v), std::cos(v) * std::sin(h), -std::cos(v) * std::cos(h)}) ==
          doctest::Approx(900).epsilon(1e-9));
    CHECK(b.intensity(0, 180) == 0);
    // tan B = cos C tan gamma, sin beta = sin C sin gamma.
    const double c = 30, gamma = 25,
                 along = std::atan(std::cos(c * pi / 180) * std::tan(gamma * pi / 180)) * 180 / pi,
                 across = std::asin(std::sin(c * pi / 180) * std::sin(gamma * pi / 180)) * 180 / pi;
    CHECK(b.intensity(c, gamma) ==
          doctest::Approx(900 * (along + 60) / 100 * (across + 70) / 90).epsilon(1e-9));
    const IntensityDistribution resampled = in_c_planes(b);
    CHECK(resampled.flux() == doctest::Approx(b.flux()).epsilon(5e-4));
}

TEST_CASE("photometry: horizontal angles say what symmetry there is") {
    const Folder folder;
    const auto at = [](const IntensityDistribution& d, double c) { return d.intensity(c, 45); };
    IntensityDistribution d = folder.read(with_planes("0 90", "1 1 3 3", 2));
    for (const double c : {45.0, 135.0, 225.0, 315.0}) CHECK(at(d, c) == doctest::Approx(2));
    CHECK(at(d, 270) == doctest::Approx(3));
    d = folder.read(with_planes("0 90 180", "1 1 3 3 5 5", 3));
    CHECK(at(d, 225) == doctest::Approx(4));
    CHECK(at(d, 315) == doctest::Approx(2));
    d = folder.read(with_planes("90 180 270", "1 1 3 3 5 5", 3));  // about the plane C90-C270
    CHECK(at(d, 0) == doctest::Approx(3));
    CHECK(at(d, 45) == doctest::Approx(2));
    CHECK(at(d, 315) == doctest::Approx(4));
    d = folder.read(with_planes("0 90 180 270", "1 1 2 2 3 3 4 4", 4));
    CHECK(at(d, 315) == doctest::Approx(2.5));
    REQUIRE(d.warnings.size() == 1);
    check_says(d.warnings[0], {"270", "360"});
    d = folder.read(with_planes("-180 -90 0 90 180", "3 3 4 4 1 1 2 2 3 3", 5));
    CHECK(at(d, 0) == doctest::Approx(1));
    CHECK(at(d, 315) == doctest::Approx(2.5));
    check_says(folder.complaint(with_planes("0 20 135", "1 1 1 1 1 1", 3)), {"line 8", "135"});
}

TEST_CASE("photometry: factors of every edition") {
    const Folder folder;
    const auto peak = [&](const std::string& version, const std::string& factors) {
        return folder.read(ies("1 500 2 2 1 1 2 0 0 0\n" + factors + " 10\n0 90\n0\n1000 500\n", version))
            .peak();
    };
    CHECK(peak("IESNA91", "1.5 0.5") == doctest::Approx(1500));
    CHECK(peak("IESNA:LM-63-1995", "1.5 0.5") == doctest::Approx(1500));
    CHECK(peak("IESNA:LM-63- 2002", "1.5 1") == doctest::Approx(3000));
    CHECK(peak("IES:LM-63-2019", "1.5 1.00010") == doctest::Approx(3000));
    CHECK(peak("IES:LM-63-2031", "1.5 1.1") == doctest::Approx(3000));
    const auto d = folder.read(ies("1 500 2 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n1000 500\n"));
    REQUIRE(d.warnings.size() == 1);  // a table of other light than the lamps have
    check_says(d.warnings[0], {"500 lm"});
    CHECK(d.watts == 10);
}

TEST_CASE("photometry: wild forms are read") {
    const Folder folder;
    const std::string numbers = "1 -1 1 2 1 1 2 0 0 0\r\n1 1 10\r\n0,90\r\n0\r\n1000\r\n500\r\ntrailing text";
    CHECK(
        folder.read("\xEF\xBB\xBFIESNA: LM-63-1995\r\n[MORE] not TILT=INCLUDE\r\ntilt =  NONE\r\n" + numbers)
            .peak() == 1000);
    const IntensityDistribution d = folder.read(ies(
        "2 3 0 45 90\n1 0.9 0.8\n1 -1 1 2 1 1 2 0 0 0\n1 1 10 0 90 0 1000 500", "IESNA91", "TILT=INCLUDE"));
    CHECK(d.peak() == 1000);
    REQUIRE(d.warnings.size() == 1);
    check_says(d.warnings[0], {"stays horizontal", "0.8 to 1", "0° to 90°", "untilted, 1"});
    const auto tilted = [&](const std::string& factors) {
        return ies(factors + "\n1 -1 1 2 1 1 2 0 0 0\n1 1 10 0 90 0 1000 500", "IESNA91", "TILT=INCLUDE");
    };
    CHECK(folder.read(tilted("1 2 0 90 0.5 1")).peak() == 500);
    CHECK(folder.read(tilted("1 2 0 90 1 1")).warnings.empty());
    check_says(folder.complaint(tilted("1 2 90 0 1 1")), {"must rise"});
    check_says(folder.complaint(tilted("4 2 0 90 1 1")), {"geometry"});
    check_says(folder.complaint(tilted("1 2 0 90 1 -1")), {"must be 0 to 10"});
    const std::string beside = ies("1 -1 1 2 1 1 2 0 0 0 1 1 10 0 90 0 1000 500", "Maker's own", "TILT=lamp.tlt");
    check_says(folder.read(beside).warnings.at(0), {"TILT=lamp.tlt", "no such file"});
    write_text(folder.folder / "lamp.tlt", "1\n2\n0 90\n0.5, 1\n");
    CHECK(folder.read(beside).peak() == 500);
    write_text(folder.folder / "lamp.tlt", "1\n2\n0 90\n0.5 x\n");
    CHECK_THROWS_WITH_AS(folder.read(beside), doctest::Contains("lamp.tlt: line 4"), Error);
    CHECK(folder.read(ies("1 -1 1 2 1 1 2 0 0 0 1 0 10 0 90 0 1000 -5", "IESNA91")).warnings.size() == 2);
    CHECK(folder.read(ies("1 -1 1 2 1 1 2 0 0 0 1 0 10 0 90 0 1000 -5", "IESNA91"), "LAMP.IES")
              .intensity(0, 90) == 0);
}

TEST_CASE("photometry: luminous openings by the signs of every edition") {
    const Folder folder;
    struct Case {
        const char *sizes, *version;
        Kind kind;
        int axis;
        glm::dvec3 size;  // length, width, height
    };
    const char *old = "IESNA:LM-63-1995", *recent = "IESNA:LM-63-2002";
    for (const Case& c : std::vector<Case>{{"0 0 0", recent, Kind::point, 2, {0, 0, 0}},
                                           {".2 .3 0", recent, Kind::rectangle, 2, {.3, .2, 0}},
                                           {".2 .3 .1", recent, Kind::box, 2, {.3, .2, .1}},
                                           {"-.2 -.2 0", recent, Kind::disk, 2, {.2, .2, 0}},
                                           {"-.2 -.3 0", recent, Kind::ellipse, 2, {.3, .2, 0}},
                                           {"-.2 -.2 .1", recent, Kind::cylinder, 2, {.2, .2, .1}},
                                           {"-.2 -.2 -.2", recent, Kind::sphere, 2, {.2, .2, .2}},
                                           {"-.2 .3 -.2", recent, Kind::cylinder, 0, {.3, .2, .2}},
                                           {".2 -.3 -.3", recent, Kind::cylinder, 1, {.3, .2, .3}},
                                           {"-.2 0 -.2", recent, Kind::disk, 0, {0, .2, .2}},
                                           {"-.2 0 0", old, Kind::disk, 2, {.2, .2, 0}},
                                           {"-.2 0 -.2", old, Kind::sphere, 2, {.2, .2, .2}},
                                           {"-.2 0 .1", old, Kind::cylinder, 2, {.2, .2, .1}},
                                           {"0 .3 -.1", old, Kind::cylinder, 0, {.3, .1, .1}},
                                           {".3 0 -.1", old, Kind::cylinder, 1, {.1, .3, .1}}}) {
        CAPTURE(c.sizes);
        const LuminousOpening o = folder.read(with_opening(c.sizes, c.version)).opening;
        CHECK(int(o.kind) == int(c.kind));
        CHECK(o.axis == c.axis);
        CHECK(glm::length(o.size - c.size) < 1e-12);
    }
}

TEST_CASE("photometry: bad files are told in one line, with its number") {
    for (const auto& [file, words] : std::vector<std::pair<std::string, std::vector<std::string>>>{
             {"own_bad_angles_fall.ies", {"line 6", "30°, after 60°", "rise"}},
             {"own_bad_truncated.ies", {"line 8", "ends before intensity 3 of 5"}}}) {
        std::string line = "no error";
        try {
            own(file);
        } catch (const Error& e) {
            line = e.what();
        }
        check_says(line, words);
        check_says(line, {file});
    }
    const Folder folder;
    check_says(folder.complaint("no lamp at all"), {"TILT"});
    check_says(folder.complaint(""), {"TILT"});
    check_says(folder.complaint(ies("1 -1 one 2 1 1 2 0 0 0")), {"line 4", "'one'", "multiplier"});
    check_says(folder.complaint(ies("1 -1 1 2000000000 2000000000 1 2 0 0 0")),
               {"line 4", "vertical angles"});
    check_says(folder.complaint(ies("1 -1 1 90000 90000 1 2 0 0 0")), {"line 4", "at most"});
    check_says(folder.complaint(ies("1 -1 1 90000 100 1 2 0 0 0\n1 1 10\n0 1")), {"ends before"});
    check_says(folder.complaint(ies("1 -1 1 2 1 4 2 0 0 0")), {"photometric type", "1 to 3"});
    check_says(folder.complaint(ies("1 -1 1 2 1 1 3 0 0 0")), {"unit of length"});
    check_says(folder.complaint(ies("1 -1 -1 2 1 1 2 0 0 0\n1 1 10")), {"line 5", "at least 0"});
    check_says(folder.complaint(ies("1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 190\n0\n1 1")), {"line 6", "190"});
    check_says(folder.complaint("ACME\n1\n9\n", "lamp.ldt"), {"line 3", "symmetry", "0 to 4"});
    check_says(folder.complaint("ACME\n1\n2\n7\n", "lamp.ldt"), {"line 4", "7 C planes"});
    check_says(folder.complaint("ACME\n1\n", "lamp.ldt"), {"line 2", "ends before the symmetry"});
    check_says(folder.complaint("", "lamp.txt"), {".ies, .ldt"});
    std::string text = read_text(source_path("tests/host/photometry/own_isym1_lambert.ldt"));
    check_says(folder.complaint(text.substr(0, text.size() - 40), "lamp.ldt"),
               {"ends before intensity", "of 19"});
}

TEST_CASE("photometry: decimal commas of EULUMDAT") {
    std::string text = read_text(source_path("tests/host/photometry/own_isym2_asym.ldt"));
    std::replace(text.begin(), text.end(), '.', ',');
    const Folder folder;
    CHECK(folder.read(text, "lamp.ldt").flux() == doctest::Approx(999.3649).epsilon(1e-6));
}

TEST_CASE("photometry: what is written is read again") {
    const Folder folder;
    const PhotometricLabels labels{"ACME", "Lamp [x]\nTILT=NONE", "7", "", "2026-01-01"};
    for (const char* file : {"own_asym_0_360.ies", "own_lambert_1986_commas_feet.ies", "own_isym4_asym.ldt",
                             "own_isym1_lambert.ldt", "own_lambert_type_b.ies"}) {
        CAPTURE(file);
        IntensityDistribution d = in_c_planes(own(file));
        d.watts = 12.5;
        for (double& v : d.candela) v *= 1.234567;
        for (const bool is_ies : {true, false}) {
            CAPTURE(is_ies);
            const IntensityDistribution again = folder.read(
                is_ies ? ies_text(d, labels) : ldt_text(d, labels), is_ies ? "again.ies" : "again.ldt");
            CHECK(again.planes == d.planes);
            CHECK(again.angles == d.angles);
            REQUIRE(again.candela.size() == d.candela.size());
            double worst = 0;
            for (size_t i = 0; i < d.candela.size(); ++i)
                worst = std::max(worst,
                                 std::abs(again.candela[i] - d.candela[i]) / std::max(d.candela[i], 1e-300));
            CHECK(worst < 1e-6);
            CHECK(again.watts == d.watts);
            CHECK(again.warnings.empty());
            CHECK(int(again.opening.kind) == int(d.opening.kind));
            CHECK(glm::length(again.opening.size - d.opening.size) < 1e-8);
        }
    }
    for (const char* sizes :
         {"-.2 -.3 0", "-.2 -.2 .1", "-.2 .3 -.2", ".2 -.3 -.3", "-.2 0 -.2", "-.2 -.2 -.2"}) {
        const IntensityDistribution d = folder.read(with_opening(sizes, "IES:LM-63-2019"));
        CHECK(folder.read(ies_text(d, labels)).opening == d.opening);
    }
    const std::string text = ies_text(own("own_asym_0_360.ies"), labels);
    CHECK(text.starts_with("IES:LM-63-2019\r\n"));
    check_says(text, {"\r\n1 1.00010 50\r\n"});
    check_says(ldt_text(own("own_asym_0_360.ies"), labels), {"\r\n100\r\n100\r\n1\r\n0\r\n1\r\n-1\r\n"});
}
