// Ray files: the same rays in every format, what is said of bad files, and files that are written and read
// again.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <span>

#include "host/error.h"
#include "host/photometry/ray_file.h"
#include "tests/support/source_path.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

std::filesystem::path own(const std::string& name) { return source_path("tests/host/rays/" + name); }

void check_says(const std::string& line, const std::vector<std::string>& words) {
    for (const std::string& word : words) CHECK_MESSAGE(line.find(word) != std::string::npos, line);
    CHECK(line.find('\n') == std::string::npos);
}

// The one line that reading fails with.
std::string complaint(const std::filesystem::path& file) {
    try {
        read_ray_file(file);
    } catch (const Error& e) {
        CHECK(e.code == ExitCode::bad_input);
        const std::string line = e.what();
        CHECK_MESSAGE(line.find(file.string()) == 0, line);
        return line;
    }
    return "no error";
}

// A sound file whose bytes are changed before it is read.
struct Damaged {
    TemporaryFolder folder;
    std::string bytes, name;
    explicit Damaged(const std::string& sound) : bytes(read_text(own(sound))), name(sound) {}
    template <class T>
    Damaged& put(size_t at, T value) {
        std::memcpy(bytes.data() + at, &value, sizeof value);
        return *this;
    }
    std::string complaint() const {
        write_text(folder / name, bytes);
        return ::complaint(folder / name);
    }
    RayFile read() const {
        write_text(folder / name, bytes);
        return read_ray_file(folder / name);
    }
};

bool mentions(const std::vector<std::string>& warnings, const std::string& word) {
    for (const std::string& line : warnings)
        if (line.find(word) != std::string::npos) return true;
    return false;
}

// The three rays of all these files, in watts.
std::vector<SourceRay> three_rays() {
    const float third = float(1 / std::sqrt(3.0));
    return {{{0, 0, 0}, {0, 0, 1}, 0.5f},
            {{1, -2, 0.5f}, {0.6f, 0, 0.8f}, 0.25f},
            {{-0.25f, 0.125f, -1}, {third, third, third}, 0.25f}};
}

void check_three_rays(const RayFile& file, float flux_scale, double tolerance) {
    const std::vector<SourceRay> expected = three_rays();
    REQUIRE(file.rays.size() == expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        CHECK(glm::length(glm::dvec3(file.rays[i].position) - glm::dvec3(expected[i].position)) <= tolerance);
        CHECK(file.rays[i].direction == expected[i].direction);
        CHECK(file.rays[i].flux == expected[i].flux * flux_scale);
    }
}

constexpr uint64_t header = 36288;  // bytes of TM-25

}  // namespace

TEST_CASE("ray files: a set of rays is the same in every format") {
    struct Case {
        const char* file;
        const char* format;
        RayFile::Unit unit;
        float scale;           // of the fluxes
        double tolerance = 0;  // mm
        bool has_wavelengths = false;
    };
    constexpr auto watt = RayFile::Unit::watt, lumen = RayFile::Unit::lumen;
    for (const Case& c : std::vector<Case>{{"own_3rays_flux.tm25ray", "TM-25", watt, 1},
                                           {"own_3rays_lumen_extra_column_text.tm25ray", "TM-25", lumen, 100},
                                           {"own_3rays_wavelength.tm25ray", "TM-25", watt, 1, 0, true},
                                           {"own_3rays_two_spectra.tm25ray", "TM-25", watt, 1},
                                           {"own_3rays_zemax_watt.dat", "Zemax", watt, 1},
                                           {"own_3rays_zemax_old_ident.dat", "Zemax", watt, 1},
                                           {"own_3rays_zemax_lumen_inch.dat", "Zemax", lumen, 100, 1e-6},
                                           {"own_3rays_zemax_spectral.sdf", "Zemax", watt, 1, 0, true},
                                           {"own_3rays_lighttools_watt.ray", "LightTools", watt, 1},
                                           {"own_3rays_speos.ray", "Speos", watt, 1, 0, true}}) {
        CAPTURE(c.file);
        const RayFile file = read_ray_file(own(c.file));
        CHECK(file.format == c.format);
        CHECK(file.unit == c.unit);
        CHECK(file.warnings.empty());
        check_three_rays(file, c.scale, c.tolerance);
        CHECK(file.flux() == doctest::Approx(c.scale));
        if (c.has_wavelengths)
            CHECK(file.wavelengths == std::vector<float>{450, 550, 650});
        else
            CHECK(file.wavelengths.empty());
    }
}

TEST_CASE("ray files: spectra, texts and totals of TM-25") {
    const RayFile two = read_ray_file(own("own_3rays_two_spectra.tm25ray"));
    REQUIRE(two.spectra.size() == 2);
    CHECK(two.spectra[0] == RaySpectrum{{440, 450, 460}, {0, 1, 0}});
    CHECK(two.spectra[1] == RaySpectrum{{500, 600, 650, 700}, {0, 1, 0.5f, 0}});
    CHECK(two.spectrum_of == std::vector<uint32_t>{0, 1, 1});
    CHECK(two.stated_watts == 1);
    CHECK(two.stated_lumens == 0);
    CHECK(two.texts[0] == "own synthetic, CC0");
    CHECK(two.texts[1] == "étendue");
    CHECK(two.texts[7] == "Ω ж 光");

    const RayFile lambert = read_ray_file(own("own_lambert_1mm_4k.tm25ray"));
    CHECK(lambert.rays.size() == 4000);
    CHECK(lambert.flux() == doctest::Approx(1).epsilon(1e-6));

    // The byte-swapped NaN of a vendor is unknown, too.
    Damaged swapped("own_3rays_flux.tm25ray");
    CHECK(swapped.put(12, uint32_t(0x0000C07F)).read().stated_lumens == 0);

    Damaged one("own_3rays_flux.tm25ray");
    one.put(60, int32_t(1)).put(64, 632.8f);
    CHECK(one.read().wavelengths == std::vector<float>(3, 632.8f));
    Damaged table("own_3rays_flux.tm25ray");
    table.put(60, int32_t(3)).put(76, int32_t(1));
    std::string points(32, '\0');
    const int32_t two_points = 2;
    const float pairs[] = {500, 1, 510, 3};
    std::memcpy(points.data(), &two_points, 4);
    std::memcpy(points.data() + 4, pairs, 16);
    table.bytes.insert(header, points);
    const RayFile tabulated = table.read();
    CHECK(tabulated.spectra == std::vector<RaySpectrum>{{{500, 510}, {1, 3}}});
    CHECK(tabulated.spectrum_of.empty());
    check_three_rays(tabulated, 1, 0);
}

TEST_CASE("ray files: what is odd is corrected, and said") {
    const RayFile odd = read_ray_file(own("own_odd_unnormalised.tm25ray"));
    CHECK(odd.rays[0].direction == glm::vec3(0, 0, 1));
    CHECK(mentions(odd.warnings, "1 of 1 directions were no unit vectors"));

    Damaged kind("own_3rays_zemax_watt.dat");
    const RayFile lumens = kind.put(196, int32_t(2)).read();
    CHECK(lumens.unit == RayFile::Unit::lumen);
    CHECK(mentions(lumens.warnings, "kind of flux is 2"));

    Damaged stated("own_3rays_flux.tm25ray");
    CHECK(mentions(stated.put(16, 2.0f).read().warnings, "carry 1 W, the header states 2"));

    Damaged unit("own_3rays_lighttools_watt.ray");
    CHECK(mentions(unit.put(24, int32_t(0)).read().warnings, "taken as mm"));
    CHECK(mentions(unit.put(28, 5.0f).read().warnings, "origin is not 0"));
    CHECK(unit.put(24, int32_t(3)).read().rays[1].position.x == 1000);
}

TEST_CASE("ray files: Zemax text, with and without wavelengths") {
    const TemporaryFolder folder;
    write_text(folder / "rays.dat", "2 1 some words of a program\n");
    check_says(complaint(folder / "rays.dat"), {"no ray file begins so"});
    write_text(folder / "rays.dat", "2 1\n 1 2 3 0 0.6 +0.8 5e-1\r\n\n-1,0,0, 0,0,-1, 2\n");
    const RayFile plain = read_ray_file(folder / "rays.dat");
    CHECK(plain.format == "Zemax text");
    CHECK(plain.unit == RayFile::Unit::watt);
    REQUIRE(plain.rays.size() == 2);
    CHECK(glm::length(plain.rays[0].position - glm::vec3(25.4f, 50.8f, 76.2f)) < 1e-5f);
    CHECK(plain.rays[0].direction == glm::vec3(0, 0.6f, 0.8f));
    CHECK(plain.rays[1].flux == 2);
    write_text(folder / "rays.dat", "1 4\n0 0 0 0 0 1 1 0.55\n");
    CHECK(read_ray_file(folder / "rays.dat").wavelengths == std::vector<float>{550});
    const std::vector<std::pair<std::string, std::vector<std::string>>> bad = {
        {"0 4\n", {"line 1", "number of rays, from 1"}},
        {"1e30 4\n", {"line 1", "number of rays"}},
        {"90000000 4\n", {"line 1", "do not hold as many"}},
        {"1 5\n0 0 0 0 0 1 1\n", {"line 1", "unit of length is 5", "from 0 to 4"}},
        {"1 4\n0 0 0 0 0 1\n", {"line 2", "6 numbers", "7 in every line"}},
        {"2 4\n0 0 0 0 0 1 1\n0 0 0 0 0 1 1 0.5\n", {"line 3", "8 numbers"}},
        {"2 4\n0.000000 0.000000 0.000000 0 0 1 1\n", {"line 2", "ends after 1 rays", "the 2 of"}},
        {"1 4\n0 0 0 0 0 1 1\n0 0 0 0 0 1 1\n", {"line 3", "one ray more"}},
        {"1 4\n0 0 0 0 0 1 1-1\n", {"line 2", "'1-1'", "must be a number"}},
        {"1 4\n0 0 0 0 0 0 1\n", {"ray 1", "direction (0, 0, 0)", "unit vector"}},
        {"1 4\n0 0 0 0 0 1 -1\n", {"ray 1", "flux of -1"}},
        {"1 4\n0 0 0 0 0 1 1 0\n", {"ray 1", "wavelength of 0 nm"}},
    };
    for (const auto& [text, words] : bad) {
        CAPTURE(text);
        write_text(folder / "rays.dat", text);
        check_says(complaint(folder / "rays.dat"), words);
    }
}

TEST_CASE("ray files: bad ones are refused in one line with place and reason") {
    check_says(complaint(own("own_bad_magic.tm25ray")), {"byte 0", "no ray file begins so"});
    check_says(complaint(own("own_bad_version.tm25ray")), {"byte 4", "version 2099", "must be 2013"});
    check_says(complaint(own("own_bad_count.tm25ray")),
               {"byte 20", "1000000000000000 rays of 28 bytes", "has 28 bytes"});
    check_says(complaint(own("own_bad_truncated.tm25ray")),
               {"byte 20", "3 rays of 28 bytes", "has 74 bytes"});
    check_says(complaint(own("nowhere.tm25ray")), {"cannot be read"});

    const auto flux = [] { return Damaged("own_3rays_flux.tm25ray"); };
    const float nan = NAN;
    struct Case {
        size_t at;
        float value;
        std::vector<std::string> words;
    };
    for (const Case& c : std::vector<Case>{{header, nan, {"ray 1", "starts at (nan, 0, 0) mm"}},
                                           {header + 28, 1e30f, {"ray 2", "must be at most 1e+09 mm"}},
                                           {header + 20, 0, {"ray 1", "direction (0, 0, 0)", "unit vector"}},
                                           {header + 20, nan, {"ray 1", "direction"}},
                                           {header + 24, -1, {"ray 1", "flux of -1", "[0, 1e15]"}},
                                           {header + 24, nan, {"ray 1", "flux of nan"}}})
        check_says(flux().put(c.at, c.value).complaint(), c.words);
    struct Field {
        size_t at;
        int32_t value;
        std::vector<std::string> words;
    };
    for (const Field& c :
         std::vector<Field>{{60, 5, {"byte 60", "kind of spectrum is 5", "from 0 to 4"}},
                            {60, 2, {"byte 268", "spectra of kind 2"}},
                            {60, 4, {"byte 284", "spectra of kind 4"}},
                            {60, 3, {"byte 76", "0 spectral tables"}},
                            {76, -1, {"byte 76", "-1"}},
                            {76, 1, {"byte 76", "1 spectral tables"}},
                            {80, 1000000, {"byte 80", "additional columns"}},
                            {84, 33, {"byte 84", "33 bytes of additional text", "multiple of 32"}},
                            {256, 0, {"byte 256", "no positions"}},
                            {260, 0, {"byte 260", "no directions"}},
                            {264, 0, {"byte 264", "no flux"}},
                            {280, 1, {"byte 280", "tristimulus"}},
                            {276, 7, {"byte 276", "flag of Stokes is 7"}},
                            {20, 0, {"byte 20", "0 rays of 28 bytes"}}})
        check_says(flux().put(c.at, c.value).complaint(), c.words);
    Damaged dark = flux();
    for (int i = 0; i < 3; ++i) dark.put(header + 24 + 28 * size_t(i), 0.0f);
    check_says(dark.complaint(), {"none of its 3 rays carries any flux"});
    Damaged one_wavelength = flux();
    check_says(one_wavelength.put(60, int32_t(1)).complaint(), {"byte 64", "wavelength of all rays is nan"});

    Damaged cut("own_3rays_flux.tm25ray");
    cut.bytes.resize(300);
    check_says(cut.complaint(), {"byte 288", "ends after 300 bytes"});
    Damaged tables("own_3rays_two_spectra.tm25ray");
    check_says(tables.put(header, int32_t(0)).complaint(), {"byte 36288", "points of a spectral table is 0"});
    check_says(tables.put(header, int32_t(900000)).complaint(),
               {"byte 36288", "900000 points", "ends before"});
    check_says(tables.put(header, int32_t(3)).put(header + 12, 430.0f).complaint(),
               {"byte 36300", "430 nm", "rise"});
    check_says(tables.put(header + 12, 450.0f).put(header + 8, -1.0f).complaint(),
               {"byte 36296", "weight -1"});
    tables.put(header + 8, 0.0f);
    check_says(tables.put(header + 64 + 28, 3.0f).complaint(),
               {"byte 36352", "ray 1 has the spectral table 3", "from 1 to 2"});

    Damaged zemax("own_3rays_zemax_watt.dat");
    check_says(zemax.put(4, uint32_t(4)).complaint(), {"byte 4", "4 rays of 28 bytes", "must be 112"});
    check_says(zemax.put(4, uint32_t(3)).put(136, uint32_t(5)).complaint(),
               {"byte 136", "unit of length is 5"});
    check_says(zemax.put(136, uint32_t(4)).put(192, int32_t(1)).complaint(),
               {"byte 192", "layout of rays is 1"});
    check_says(zemax.put(192, int32_t(0)).put(196, int32_t(3)).complaint(),
               {"byte 196", "kind of flux is 3"});
    zemax.bytes.resize(100);
    check_says(zemax.complaint(), {"ends after 100 bytes"});

    Damaged lighttools("own_3rays_lighttools_watt.ray");
    check_says(lighttools.put(4, uint32_t(4)).complaint(), {"byte 4", "version is 4", "from 2 to 3"});
    check_says(lighttools.put(4, uint32_t(2)).put(16, int32_t(2)).complaint(), {"byte 16", "far field is 2"});
    check_says(lighttools.put(16, int32_t(0)).put(20, int32_t(1)).complaint(),
               {"byte 20", "kind of colour is 1", "tristimulus values (1) are not read"});
    check_says(lighttools.put(20, int32_t(0)).put(128, 'X').complaint(), {"byte 128", "must be 'LTRFEND'"});
    lighttools.bytes.resize(130);
    check_says(lighttools.complaint(), {"byte 44", "must be a multiple of 28"});

    Damaged stokes("own_3rays_lighttools_watt.ray");
    stokes.put(4, uint32_t(3)).bytes.insert(44, std::string("\1\0\0\0", 4));
    check_says(stokes.complaint(), {"byte 44", "Stokes vectors", "must be 0"});

    Damaged speos("own_3rays_speos.ray");
    check_says(speos.put(0, 0.0f).complaint(), {"byte 0", "flux is 0 W"});
    speos.put(0, 1.0f).bytes.resize(120);
    check_says(speos.complaint(), {"no ray file begins so"});
}

TEST_CASE("ray files: LightTools of version 3, and of the far field") {
    Damaged third("own_3rays_lighttools_watt.ray");
    third.put(4, uint32_t(3)).bytes.insert(44, std::string(4, '\0'));
    check_three_rays(third.read(), 1, 0);

    // Without positions: rays start at the origin.
    Damaged far("own_3rays_lighttools_watt.ray");
    far.put(16, int32_t(1)).put(28, 1.0f).put(32, -2.0f);
    for (size_t i = 0; i < 3; ++i) far.bytes.erase(44 + 16 * i, 12);
    const RayFile file = far.read(), near = read_ray_file(own("own_3rays_lighttools_watt.ray"));
    REQUIRE(file.rays.size() == 3);
    CHECK(file.warnings.empty());
    for (size_t i = 0; i < 3; ++i) {
        CHECK(file.rays[i].position == glm::vec3(1, -2, 0));
        CHECK(file.rays[i].direction == near.rays[i].direction);
        CHECK(file.rays[i].flux == near.rays[i].flux);
    }
}

TEST_CASE("ray files: polarization, of TM-25 as Stokes parameters, of Speos as ellipses") {
    const TemporaryFolder folder;
    const auto path = folder / "polarized.tm25ray";
    const auto with = [&](const glm::vec3& stokes, const glm::vec3& axis) {
        RayFile file = read_ray_file(own("own_3rays_flux.tm25ray"));  // the first goes along z
        file.polarization = {{stokes, axis}, {{0, 0, 0}, {0, 0, 0}}, {{0, 0, -1}, {0, 0, 0}}};
        write_tm25(path, file);
    };
    with({0.6f, 0, 0.8f}, {0, 2, 5});
    const RayFile good = read_ray_file(path);
    CHECK(good.warnings.empty());
    CHECK(good.polarization[0] == RayPolarization{{0.6f, 0, 0.8f}, {0, 2, 5}});
    with({0.9f, 0, 0.9f}, {1, 0, 0});
    check_says(complaint(path), {"ray 1", "Stokes parameters (0.9, 0, 0.9)", "at most 1 together"});
    with({NAN, 0, 0}, {1, 0, 0});
    check_says(complaint(path), {"ray 1", "Stokes parameters (nan, 0, 0)"});
    with({0, 0.5f, 0}, {0, 0, 1});
    check_says(complaint(path), {"ray 1", "axis of polarization (0, 0, 1)", "must lie across it"});

    Damaged speos("own_3rays_speos.ray");
    const std::string plain = speos.bytes.substr(28);
    speos.bytes.resize(28);
    const float ellipses[3][5] = {{0, 1, 0, 0, 0}, {0, 1, 0, 1, 1}, {0.70710678f, -0.70710678f, 0, 0.5f, 0}};
    for (size_t i = 0; i < 3; ++i)
        speos.bytes += plain.substr(32 * i, 32) + std::string(reinterpret_cast<const char*>(ellipses[i]), 20);
    const RayFile file = speos.read();
    CHECK(file.warnings.empty());
    check_three_rays(file, 1, 0);
    REQUIRE(file.polarization.size() == 3);
    CHECK(file.polarization[0] == RayPolarization{{1, 0, 0}, {0, 1, 0}});
    CHECK(file.polarization[1] == RayPolarization{{0, 0, -1}, {0, 1, 0}});
    CHECK(file.polarization[2].stokes == glm::vec3(0.6f, 0, 0.8f));
}

TEST_CASE("ray files: what is written as TM-25 reads back to the same") {
    const TemporaryFolder folder;
    const auto path = folder / "written.tm25ray";
    const auto check_same = [&](const RayFile& file) {
        write_tm25(path, file, "2026-11-30T08:00:00+00:00");
        const RayFile again = read_ray_file(path);
        CHECK(again.unit == file.unit);
        CHECK(again.rays == file.rays);
        CHECK(again.lumens == file.lumens);
        CHECK(again.wavelengths == file.wavelengths);
        CHECK(again.tristimulus == file.tristimulus);
        CHECK(again.spectra == file.spectra);
        CHECK(again.spectrum_of == file.spectrum_of);
        CHECK(again.polarization == file.polarization);
        CHECK(again.texts == file.texts);
    };
    for (const char* name :
         {"own_3rays_flux.tm25ray", "own_3rays_lumen_extra_column_text.tm25ray",
          "own_3rays_wavelength.tm25ray", "own_3rays_two_spectra.tm25ray", "own_3rays_zemax_lumen_inch.dat",
          "own_3rays_speos.ray", "own_lambert_1mm_4k.tm25ray"}) {
        CAPTURE(name);
        check_same(read_ray_file(own(name)));
    }
    CHECK(read_text(path).substr(28, 25) == "2026-11-30T08:00:00+00:00");
    RayFile full = read_ray_file(own("own_3rays_wavelength.tm25ray"));
    full.lumens = {1, 2, 3};
    full.polarization = {{{1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}, {{0, 0, 0.5f}, {1, 0, 0}}};
    full.texts[8] = "x Ω 光 🜂";
    check_same(full);
    RayFile colored = read_ray_file(own("own_3rays_flux.tm25ray"));
    colored.unit = RayFile::Unit::lumen;
    colored.tristimulus = {{0.95f, 1.09f}, {2, -0.01f}, {0, 3}};
    check_same(colored);
    RayFile one = read_ray_file(own("own_3rays_flux.tm25ray"));
    one.spectra = {{{400, 500.5f}, {1, 2}}};
    check_same(one);

    // As its maker wrote it, but for what the header says of nothing.
    const std::string before = read_text(own("own_3rays_wavelength.tm25ray"));
    write_tm25(path, read_ray_file(own("own_3rays_wavelength.tm25ray")));
    CHECK(read_text(path).substr(header) == before.substr(header));
}

TEST_CASE("ray files: those of other programs") {
    const char* shared = std::getenv("ETENDUE_SHARED");
    if (!shared) {
        MESSAGE("SKIPPED: ETENDUE_SHARED is not set; shared ray files are not read");
        return;
    }
    const std::filesystem::path folder = std::filesystem::path(shared) / "photometry/rays";
    const RayFile cylinder = read_ray_file(folder / "jmo_Cyl10k.tm25ray");
    CHECK(cylinder.rays.size() == 10000);
    CHECK(cylinder.unit == RayFile::Unit::lumen);
    CHECK(cylinder.flux() == doctest::Approx(10000).epsilon(1e-6));
    CHECK(mentions(cylinder.warnings, "the rays count"));  // its header states 1 lm

    const RayFile watts = read_ray_file(folder / "jmo_ThreeRays_PowerOnly.1.ray"),
                  spectral = read_ray_file(folder / "jmo_ThreeRays_Wavelength.1.ray"),
                  back = read_ray_file(folder / "jmo_ThreeRays_Wavelength_ZMW_to_LT.ray"),
                  zemax = read_ray_file(folder / "jmo_ThreeRays_Wavelength_ZMX.ray");
    CHECK(zemax.format == "Zemax");  // whatever its name ends in
    for (const RayFile* other : {&spectral, &back, &zemax}) {
        CHECK(other->rays == watts.rays);
        REQUIRE(other->wavelengths.size() == 3);
        for (size_t i = 0; i < 3; ++i)
            CHECK(other->wavelengths[i] == doctest::Approx(spectral.wavelengths[i]).epsilon(1e-6));
    }
    CHECK(spectral.wavelengths == std::vector<float>{550, 450, 620});

    const RayFile text = read_ray_file(folder / "jmo_ZemaxText.txt"),
                  with_wavelengths = read_ray_file(folder / "jmo_ZemaxWavelengthText.txt");
    CHECK(text.rays.size() == 9);
    CHECK(text.rays[8].flux == 2.968579f);
    CHECK(with_wavelengths.wavelengths[8] == 450);
    CHECK(glm::length(with_wavelengths.rays[3].position - 10.0f * text.rays[3].position) < 1e-3f);  // cm, mm
    complaint(folder / "jmo_LEDWhite.txt");
}
