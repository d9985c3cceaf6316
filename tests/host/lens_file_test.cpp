// Lens files: what others wrote, what is said of files that cannot be, glasses.
#include <doctest/doctest.h>

#include <cstdlib>

#include "host/error.h"
#include "host/lens/pupil_rays.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

doctest::Approx about(double value, double relative = 1e-6) {
    return doctest::Approx(value).epsilon(relative);
}

struct LensFolder {
    TemporaryFolder folder;
    Prescription read(const std::string& name, const std::string& text) const {
        write_text(folder / name, text);
        return read_prescription(folder / name);
    }
    // The one line that reading fails with.
    std::string complaint(const std::string& name, const std::string& text) const {
        try {
            read(name, text);
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            const std::string line = e.what();
            CHECK_MESSAGE(line.find((folder / name).string()) == 0, line);
            CHECK(line.find('\n') == std::string::npos);
            return line;
        }
        return "no error";
    }
};

void check_says(const std::string& line, const std::vector<std::string>& words) {
    for (const std::string& word : words) CHECK_MESSAGE(line.find(word) != std::string::npos, line);
}

ParaxialFigures figures(const Prescription& p) { return paraxial_figures(p, p.primary_nm()); }

// A biconvex lens as Zemax writes it; `more` stands in the header, `first` with the first surface.
std::string zmx(const std::string& more = "", const std::string& first = "",
                const std::string& glass = "N-BK7 0 0 1.5 40") {
    return "VERS 1\nMODE SEQ\nUNIT MM X\nENPD 10\nWAVM 1 0.5875618 1\n" + more +
           "SURF 0\n  DISZ INFINITY\nSURF 1\n  STOP\n  CURV 0.02\n  DISZ 5\n  GLAS " + glass + "\n" + first +
           "SURF 2\n  CURV -0.02\n  DISZ 45\nSURF 3\n  DISZ 0\n";
}

std::string seq(const std::string& surface = "S 50 5 NBK7_SCHOTT", const std::string& more = "") {
    return "RDM; EPD 10; WL 587.5618\nSO 0 1e11\n" + surface + "\n" + more + "S -50 45\nSI 0 0\n";
}

std::string utf16(const std::string& text, bool little) {
    std::string bytes = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char c : text) bytes += little ? std::string{c, '\0'} : std::string{'\0', c};
    return bytes;
}

}  // namespace

TEST_CASE("lens files: figures of the shared files") {
    const char* shared = std::getenv("ETENDUE_SHARED");
    const std::filesystem::path folder = std::filesystem::path(shared ? shared : "") / "photometry/lenses";
    if (!shared || !std::filesystem::exists(folder)) {
        MESSAGE("SKIPPED: ETENDUE_SHARED names no lens files; they are not read");
        return;
    }
    struct Expected {
        const char* file;
        size_t surfaces;  // the image is one
        double focal_length, rear_focus;
    };
    // The first two are told by others, the perfect parabola is half its radius; the rest is what their
    // makers state (15 mm, 3.9 mm) or what the file names (F/4 of 20.02 mm), and what was read at first, lest
    // it change.
    for (const Expected& e : {Expected{"ol_lens1.zmx", 8, 25.0000, 18.80585},
                              {"ol_cooke_triplet.seq", 7, 50.3344, 41.70975},
                              {"ro_zmax_37992.zmx", 4, 95.3, -95.3},
                              {"ol_lens_thorlabs_iso_8859_1.zmx", 3, 14.99557, 11.50634},
                              {"ol_thorlabs_lj1598l1.zmx", 3, 3.908681, 1.403404},
                              {"ro_HoO-V2C18Ex03.zmx", 4, 80.09343, 24.03504},
                              {"ro_HoO-V2C18Ex27.zmx", 10, 24.60887, 1.316763},
                              {"ro_ag_dblgauss.seq", 12, 100.0038, 61.48754},
                              {"ro_landscape_lens.seq", 4, 10, 10.150245},
                              {"ro_questar35.seq", 5, 1282.7, 259.4682},
                              {"ro_singlet.seq", 3, 13.10546, 12.66024},
                              {"ol_circular_aperture_example_with_aperture.zmx", 23, 18.54433, 39.68447},
                              {"ro_US05831776-1.zmx", 43, 494.0203, -110.4473},
                              {"ol_curved_transmission_grating.zmx", 4, -96.74482, -96.74482},
                              {"ol_curved_reflective_grating.zmx", 2, -35, 35}}) {
        CAPTURE(e.file);
        const Prescription p = read_prescription(folder / e.file);
        CHECK(p.surfaces.size() == e.surfaces);
        CHECK(figures(p).focal_length == about(e.focal_length, 2e-6));
        CHECK(figures(p).rear_focus == about(e.rear_focus, 2e-6));
    }
    const Prescription cooke = read_prescription(folder / "ol_cooke_triplet.seq");
    CHECK(paraxial_figures(cooke, 486.1).focal_length == about(50.2984));
    CHECK(paraxial_figures(cooke, 656.3).focal_length == about(50.3843));
    CHECK(figures(read_prescription(folder / "ol_lens1.zmx")).f_number == about(3));
    CHECK(figures(read_prescription(folder / "ro_HoO-V2C18Ex03.zmx")).f_number == about(4));
    // A flat mirror at 45 degrees: the light goes up, and comes to the image straight.
    const Prescription mirror = read_prescription(folder / "ol_one_mirror_up_45deg.zmx");
    const auto frames = lens_frames(mirror);
    CHECK(glm::distance(frames.back().shift, glm::dvec3(0, 20, 40)) < 1e-12);
    const TracedRay ray = LensTracer(mirror, 550).trace({{0, 3, 0}, {0, 0, 1}});
    CHECK(glm::distance(frames.back().turn * ray.at_image().direction, glm::dvec3(0, 1, 0)) < 1e-12);
    // Surfaces that cross where the file fixes no apertures end there.
    const Prescription stepper = read_prescription(folder / "ro_US05831776-1.zmx");
    CHECK(stepper.warnings.size() == 6);
    CHECK(lens_spot(stepper, figures(stepper), stepper.fields[1], 16).rms < 0.003);
}

TEST_CASE("Zemax files in every encoding, unit and kind of aperture") {
    const LensFolder f;
    const double focal = figures(f.read("a.zmx", zmx())).focal_length;
    const double n = find_glass("N-BK7")->index(587.5618);  // the lensmaker's equation
    CHECK(focal == about(1 / ((n - 1) * (0.04 - (n - 1) * 5 * 0.0004 / n)), 1e-12));
    CHECK(figures(f.read("a.zmx", utf16(zmx(), true))).focal_length == focal);
    CHECK(figures(f.read("a.zmx", utf16(zmx(), false))).focal_length == focal);
    CHECK(figures(f.read("a.zmx", "\xEF\xBB\xBF" + zmx())).focal_length == focal);
    CHECK(figures(f.read("a.zmx", zmx("NAME \xF8 18 mm\n"))).focal_length == focal);
    CHECK(figures(f.read("a.zmx", zmx("UNIT IN X\n"))).focal_length == about(25.4 * focal));
    CHECK(figures(f.read("a.zmx", zmx("FNUM 8 0\n"))).entrance_diameter == about(focal / 8));
    CHECK(figures(f.read("a.zmx", zmx("FLOA\n", "  DIAM 4 1\n"))).entrance_diameter == about(8));
    // Even aspheres state r² first.
    const Prescription bent = f.read("a.zmx", zmx("", "  TYPE EVENASPH\n  PARM 1 0.001\n  PARM 3 1e-9\n"));
    CHECK(bent.surfaces[0].shape.coefficients == std::vector<double>{0.001, 0, 1e-9});
    CHECK(bent.surfaces[0].shape.vertex_curvature() == about(0.022));
    CHECK(f.read("a.zmx", zmx("UNIT CM\n", "  TYPE EVENASPH\n  PARM 2 1\n"))
              .surfaces[0]
              .shape.coefficients[1] == about(1e-3));
    // A model glass; N-BK7 by its nd and vd has the index of the d line, and nearly that of the others.
    const Glass model = f.read("a.zmx", zmx("", "", "___BLANK 1 0 1.516798 64.17")).surfaces[0].glass;
    CHECK(model.index(587.5618) == about(1.516798));
    CHECK(model.index(486.1327) - model.index(656.2725) == about(0.516798 / 64.17));
    CHECK(f.read("a.zmx", zmx("", "  CLAP 0 3 0\n  OBDC 1 2\n")).surfaces[0].aperture.contains({1, 4.9, 0}));
    CHECK_FALSE(
        f.read("a.zmx", zmx("", "  CLAP 0 3 0\n  OBDC 1 2\n")).surfaces[0].aperture.contains({1, -1.1, 0}));
    CHECK_FALSE(f.read("a.zmx", zmx("", "  SQAP 3 2\n")).surfaces[0].aperture.contains({0, 2.1, 0}));
    CHECK_FALSE(f.read("a.zmx", zmx("", "  OBSC 0 1\n")).surfaces[0].aperture.contains({0.5, 0, 0}));
}

TEST_CASE("CODE V sequences: curvatures, several commands a line, decentred surfaces") {
    const LensFolder f;
    const double focal = figures(f.read("a.seq", seq())).focal_length;
    CHECK(focal == about(figures(f.read("a.zmx", zmx())).focal_length));
    CHECK(
        figures(f.read("a.seq",
                       "rdm n;epd 10 ! remark; S 1 1\nso 0 1e11\ns 0.02 5 nbk7_schott; s -0.02 45\nsi 0 0\n"))
            .focal_length == about(focal));
    const Prescription bent = f.read("a.seq", seq("S 50 5 517642", "ASP; K -0.5; A 1e-6; C 2e-12\n CIR 6\n"));
    CHECK(bent.surfaces[0].shape.conic == -0.5);
    CHECK(bent.surfaces[0].shape.coefficients == std::vector<double>{0, 1e-6, 0, 2e-12});
    CHECK(bent.surfaces[0].glass.index(587.5618) == about(1.517));
    CHECK_FALSE(bent.surfaces[0].aperture.contains({0, 6.1, 0}));
    // Decentred and returned, the lens behind stands where it stood; basically decentred, it moves along.
    const Prescription returned = f.read("a.seq", seq("S 50 5 NBK7_SCHOTT", "YDE 1; ADE 10; DAR\n"));
    REQUIRE(returned.surfaces.size() == 5);
    CHECK(glm::distance(lens_frames(returned)[3].shift, glm::dvec3(0, 0, 5)) < 1e-14);
    CHECK(glm::distance(lens_frames(returned)[1].turn[2],
                        glm::dvec3(0, std::sin(std::acos(-1) / 18), std::cos(std::acos(-1) / 18))) < 1e-14);
    const Prescription moved = f.read("a.seq", seq("S 50 5 NBK7_SCHOTT", "YDE 1\n"));
    CHECK(glm::distance(lens_frames(moved)[2].shift, glm::dvec3(0, 1, 5)) < 1e-14);
    // A mirror that bends the axis: at 45 degrees, the image stands above or below.
    const Prescription fold =
        f.read("a.seq", "RDM;EPD 1;SO 0 1e11\nS 0 30\nS 0 -20 REFL\nADE 45; BEN\nSI 0 0\n");
    const TracedRay ray = LensTracer(fold, 550).trace({{0, 0.3, 0}, {0, 0, 1}});
    REQUIRE(ray.fate == TracedRay::Fate::arrives);
    CHECK(std::abs(ray.at_image().direction.z) == about(1, 1e-12));
    // Edges of the pupil: 0.2 cut off above, 0.4 below.
    const LensField field =
        f.read("a.seq", seq("YAN 0 5\nVUY 0 0.2\nVLY 0 0.4\nS 50 5 NBK7_SCHOTT")).fields[1];
    CHECK(field.pupil_shift.y == about(0.1));
    CHECK(field.pupil_compression.y == about(0.3));
}

TEST_CASE("tables: remarks, fields, glasses, aspheres") {
    const LensFolder f;
    const Prescription p =
        f.read("a.txt",
               "title A lens\nfields 0 7\nwavelengths 486.1 587.6 656.3 # F d C\nobject 500\n"
               "50 5 N-BK7 20 -0.5 1e-6 2e-9\n-50 2 air 20\n0, 40, 1, 15, stop\n");
    CHECK(p.title == "A lens");
    CHECK(p.fields.size() == 2);
    CHECK(p.wavelengths.size() == 3);
    CHECK(p.primary_nm() == 587.6);
    CHECK(p.object_distance == 500);
    CHECK(p.stop == 2);
    CHECK(p.surfaces[0].shape.coefficients == std::vector<double>{0, 1e-6, 2e-9});
    CHECK(p.surfaces[0].aperture.semi_diameter == 10);
}

TEST_CASE("glasses: by maker, as files write them, and where their data hold") {
    CHECK(find_glass("N-BK7")->index(587.5618) == about(1.516798));
    for (const char* name : {"NBK7_SCHOTT", "n-bk7", "N-BK7_schott"})
        CHECK(find_glass(name)->index(550) == find_glass("N-BK7")->index(550));
    CHECK(find_glass("S-LAH64")->index(587.5618) == about(1.788001));
    CHECK(find_glass("SILICA")->index(248) == about(1.508, 5e-4));
    CHECK(find_glass("N-BK7_HOYA") == nullptr);
    CHECK(find_glass("UNOBTAINIUM") == nullptr);
    CHECK(find_glass("F2")->index(587.5618) == about(1.62004));
    CHECK_FALSE(find_glass("F2")->covers(248));
}

TEST_CASE("lens files that cannot be are refused with one line") {
    const LensFolder f;
    check_says(f.complaint("a.zmx", zmx("", "", "UNOBTAINIUM 0 0 1.5 40")),
               {"line 12", "UNOBTAINIUM", "SCHOTT"});
    check_says(f.complaint("a.zmx", zmx("", "", "LOST")), {"line 12", "LOST"});
    check_says(f.complaint("a.zmx", zmx("", "  TYPE ZERNSAG\n")), {"line 8", "ZERNSAG", "EVENASPH"});
    check_says(f.complaint("a.zmx", zmx("MODE NSC\n")), {"line 6", "NSC", "SEQ"});
    check_says(f.complaint("a.zmx", zmx("UNIT FT X\n")), {"line 6", "FT", "MM"});
    check_says(f.complaint("a.zmx", zmx("FTYP 4 0 1 1\n")), {"line 6", "FTYP is 4"});
    check_says(f.complaint("a.zmx", zmx("ENPD -3\n")), {"pupil", "-3"});
    check_says(f.complaint("a.zmx", zmx("ENPD\n")), {"line 6", "ENPD has 0 value(s)"});
    check_says(f.complaint("a.zmx", zmx("", "  CURV fast\n")), {"line 13", "fast", "number"});
    check_says(f.complaint("a.zmx", zmx("", "  CURV 1e400\n")), {"line 13"});
    check_says(f.complaint("a.zmx", zmx("", "  DISZ INFINITY\n")), {"surface 1", "infinitely"});
    check_says(f.complaint("a.zmx", zmx("", "  DIAM 51 1\n")),
               {"surface 1", "51 mm", "a sphere of radius 50", "at most 50"});
    check_says(f.complaint("a.zmx", zmx("", "  CONI 3\n  DIAM 26 1\n")),
               {"surface 1", "26 mm", "constant 3", "at most 25"});
    check_says(f.complaint("a.zmx", zmx("WAVM 1 0.2 1\n")), {"surface 1", "N-BK7", "200 nm"});
    check_says(f.complaint("a.zmx", zmx("WAVM 1 0 1\n")), {"wavelength", "0 nm"});
    check_says(f.complaint("a.zmx", "SURF 0\n"), {"0 surface(s)"});
    check_says(f.complaint("a.zmx", ""), {"no line SURF"});
    check_says(f.complaint("a.zmx", utf16("hello\n", true)), {"no line SURF"});
    check_says(f.complaint("a.zmx", zmx("OBNA 0.1 0\n")), {"the object is inf mm"});
    check_says(f.complaint("a.zmx", zmx("PWAV 0\n")), {"line 6", "PWAV is 0"});
    check_says(f.complaint("a.seq", seq("S 50 5 NOGLASS_SCHOTT")), {"line 3", "NOGLASS"});
    check_says(f.complaint("a.seq", seq("S 50")), {"line 3", "S has 1 value(s)"});
    check_says(f.complaint("a.seq", seq("S 50 5 NBK7_SCHOTT", "XTO\n")), {"line 4", "XTO"});
    check_says(f.complaint("a.seq", "STO\n"), {"line 1", "STO"});
    check_says(f.complaint("a.seq", "EPD 3\n"), {"no surface"});
    check_says(f.complaint("a.seq", "DIM F\n"), {"line 1", "DIM F"});
    check_says(f.complaint("a.seq", seq("S 50 5 NBK7_SCHOTT", "CIR -1\n")), {"line 4", "-1"});
    check_says(f.complaint("a.txt", "50 3 1.5\n"), {"line 1", "3 values"});
    check_says(f.complaint("a.txt", "50 3 0.5 20\n"), {"line 1", "0.5", "from 1 to 10"});
    check_says(f.complaint("a.txt", "50 3 1.5 0\n"), {"line 1", "diameter"});
    check_says(f.complaint("a.txt", "# nothing\n"), {"0 surface(s)"});
    // Biconvex, and too thin for its edge.
    check_says(f.complaint("a.txt", "50 3 1.5 30\n-50 10 1 30\n"),
               {"surfaces 1 and 2 cross 12", "within their apertures"});
    check_says(f.complaint("a.txt", "50 8 1.5 30\n-50 1 1 30\n50 8 1.5 34\n60 10 1 130\n"),
               {"surface 4", "a sphere of radius 60"});
    std::string many;
    for (int i = 0; i < 1001; ++i) many += "0 1 1 10\n";
    check_says(f.complaint("a.txt", many), {"1002 surfaces", "at most 1000"});
    std::string fields = "fields";
    for (int i = 0; i < 101; ++i) fields += " 1";
    check_says(f.complaint("a.txt", fields + "\n50 10 1.5 30\n"), {"101 fields", "at most 100"});
    check_says(f.complaint("a.txt", "50 1e300 1.5 30\n"), {"line 1", "thickness"});
}
