// Files of measured surfaces: what is read of them, and what is said of bad ones.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "host/error.h"
#include "host/measured/measured_bsdf.h"
#include "host/spectra/color.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

using std::numbers::pi;

struct Folder {
    TemporaryFolder folder;
    MeasuredBsdf read(const std::string& text, const std::string& name) const {
        write_text(folder / name, text);
        return read_measured_bsdf(folder / name);
    }
    // The one line that reading fails with.
    std::string complaint(const std::string& text, const std::string& name) const {
        try {
            read(text, name);
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            const std::string line = e.what();
            CHECK_MESSAGE(line.find('\n') == std::string::npos, line);
            CHECK_MESSAGE(line.find(name) != std::string::npos, line);
            return line;
        }
        return "no error";
    }
};

void check_says(const std::string& line, const std::vector<std::string>& words) {
    for (const std::string& word : words) CHECK_MESSAGE(line.find(word) != std::string::npos, line);
}

json small_table() {
    json table = {{"theta_i", {0, 60}}, {"theta_r", {0, 45, 90}}, {"phi", {0, 180}}};
    table["reflection"] = table_side(table, [](double, double, double) { return json(0.1); });
    return table;
}

TensorFields small_rgl(const std::vector<double>& wavelengths = {}) {
    RglResolution resolution;
    resolution.theta_i = {0, 0.7, 1.4}, resolution.points = 8, resolution.value_points = 4;
    return rgl_fields({0.5, 0.5, [](double, size_t) { return 0.5; }}, wavelengths, resolution);
}

TensorData& field(TensorFields& fields, const std::string& name) {
    for (auto& [key, data] : fields)
        if (key == name) return data;
    FAIL("no field ", name);
    return fields[0].second;
}

// The integral of a slice of a map, as its points say.
double integral(const MeasuredBsdf& bsdf, const MeasuredMap& map, uint32_t slice) {
    return bsdf.points[map.first + slice * map.height * (map.width + 1) + map.height - 1].x;
}

}  // namespace

TEST_CASE("a table of constant values holds them, out to 0 and 90 degrees and once around") {
    const Folder folder;
    json table = {{"theta_i", {0, 30, 60}}, {"theta_r", {20, 70}}, {"phi", {0, 90, 180}}};
    table["transmission"] = table_side(table, [](double, double, double) { return json({0.3, 0.2, 0.1}); });
    const MeasuredBsdf bsdf = folder.read(table.dump(), "t.json");
    const MeasuredRef& ref = bsdf.ref;
    CHECK((ref.kind & (measured_halfway | measured_anisotropic)) == 0);
    CHECK((ref.kind & measured_transmits) != 0);
    CHECK(ref.theta_count == 3);
    CHECK(ref.density.width == 4);
    CHECK(ref.density.height == 5);
    CHECK(bsdf.points[ref.theta_first + 2].x == doctest::Approx(0.75));
    CHECK(bsdf.points[ref.swept_first + 1].x == doctest::Approx(std::pow(std::sin(pi / 9), 2)));
    CHECK(bsdf.points[ref.swept_first + 3].x == 1);
    CHECK(bsdf.points[ref.turn_first + 3].x == doctest::Approx(0.75));
    for (uint32_t slice = 0; slice < 6; ++slice)
        CHECK(integral(bsdf, ref.density, slice) == doctest::Approx(slice < 3 ? 0 : 0.2));
    CHECK(bsdf.colors.size() == 6 * 20 * 3);
    CHECK(bsdf.colors[3 * 60] == 0.3f);
    CHECK(ref.channels == 0);
}

TEST_CASE("values in wavelengths keep those that are visible, and have the colour they have under D65") {
    const Folder folder;
    json table = {{"theta_i", {0}},
                  {"theta_r", {0, 90}},
                  {"phi", {0, 180}},
                  {"wavelengths", {200, 300, 400, 500, 650, 800, 900, 1000}}};
    const std::vector<double> values = {1, 0.9, 0.1, 0.2, 0.25, 0.15, 0.8, 0.9};
    table["reflection"] = table_side(table, [&](double, double, double) { return json(values); });
    for (auto& around : table["reflection"][0])
        for (auto& v : around)
            for (auto& x : v) x = x.get<double>() / 4;
    const MeasuredBsdf bsdf = folder.read(table.dump(), "t.json");
    CHECK(bsdf.ref.channels == 6);  // 300 to 900 nm
    CHECK(bsdf.spectra[0] == doctest::Approx(0.225));
    REQUIRE(bsdf.place.table);
    CHECK(bsdf.place.table->at(400) == doctest::Approx(1));
    CHECK(bsdf.place.table->at(575) == doctest::Approx(2.5));
    CHECK(bsdf.place.table->at(830) == doctest::Approx(4.3));
    const std::vector<double> nm = {200, 300, 400, 500, 650, 800, 900, 1000};
    const glm::dvec3 rgb = rgb_of_factor(interpolate(nm, values, Outside::hold)) / 4.0;
    for (int k = 0; k < 3; ++k) CHECK(bsdf.colors[size_t(k)] == doctest::Approx(rgb[k]).epsilon(1e-5));
}

TEST_CASE("an RGL file's maps are read, densities scaled to one") {
    const Folder folder;
    for (const bool spectral : {false, true}) {
        const auto nm = spectral ? even_angles(360, 1000, 17) : std::vector<double>();
        const MeasuredBsdf bsdf = folder.read(tensor_file_bytes(small_rgl(nm)), "m.bsdf");
        CHECK(bsdf.ref.kind == (measured_halfway | 1u << measured_symmetry));
        CHECK(bsdf.ref.visible.width == 8);
        CHECK(bsdf.ref.density.height == 4);
        for (uint32_t slice = 0; slice < 3; ++slice) {
            CHECK(integral(bsdf, bsdf.ref.density, slice) == doctest::Approx(1));
            CHECK(integral(bsdf, bsdf.ref.visible, slice) == doctest::Approx(1));
        }
        CHECK(bsdf.ref.channels == (spectral ? 13 : 0));  // to 840 nm
        CHECK(bsdf.colors.size() == 3 * 3 * 16);
        CHECK(bsdf.spectra.size() == bsdf.ref.channels * 3 * 16);
        // An even reflectance is grey.
        for (size_t i = 0; i < bsdf.colors.size(); i += 3)
            CHECK(bsdf.colors[i] == doctest::Approx(bsdf.colors[i + 2]).epsilon(1e-3));
    }
}

TEST_CASE("a bad table is one line: the place, and what is allowed") {
    const Folder folder;
    const auto says = [&](json table, const std::vector<std::string>& words) {
        check_says(folder.complaint(table.dump(), "t.json"), words);
    };
    check_says(folder.complaint("{\"theta_i\": [", "t.json"), {"not JSON"});
    check_says(folder.complaint("", "t.json"), {"not JSON"});
    check_says(folder.complaint("[]", "t.json"), {"object"});
    json t = small_table();
    t["albedo\n"] = 1;
    says(t, {"/\"albedo\\n\"", "unknown", "transmission"});
    t = small_table(), t.erase("phi");
    says(t, {"/phi", "array"});
    t = small_table(), t["theta_i"] = {0, 60, 50};
    says(t, {"/theta_i/2", "rise", "[0, 90]"});
    t = small_table(), t["theta_r"] = {0, 45, 91};
    says(t, {"/theta_r/2", "[0, 90]"});
    t = small_table(), t["theta_i"] = even_angles(0, 90, 1025);
    says(t, {"/theta_i", "1024"});
    t = small_table(), t["phi"] = {0, 90};
    says(t, {"/phi", "180"});
    t = small_table(), t["wavelengths"] = "all";
    says(t, {"/wavelengths"});
    t = small_table(), t.erase("reflection");
    says(t, {"reflection and transmission"});
    t = small_table(), t["reflection"][1].erase(2);
    says(t, {"/reflection/1", "3", "theta_r"});
    t = small_table(), t["reflection"][1][2] = 5;
    says(t, {"/reflection/1/2", "2", "phi"});
    t = small_table(), t["reflection"][1][2][0] = -0.1;
    says(t, {"/reflection/1/2/0", "-0.1", "1/sr"});
    t = small_table(), t["reflection"][1][2][0] = {1, 2};
    says(t, {"/reflection/1/2/0", "[r, g, b]"});
    t = small_table(), t["wavelengths"] = {400, 500, 600, 700};
    says(t, {"/reflection/0/0/0", "4 numbers", "wavelength"});
    t = small_table();
    for (auto& around : t["reflection"][1])
        for (auto& v : around) v = 3;
    says(t, {"/theta_i/1", "60", "9.42", "1/sr"});
    CHECK(folder.complaint(small_table().dump(), "t.json") == "no error");
}

TEST_CASE("a bad RGL file is one line: the field, and what is allowed") {
    const Folder folder;
    const auto says = [&](const TensorFields& fields, const std::vector<std::string>& words) {
        check_says(folder.complaint(tensor_file_bytes(fields), "m.bsdf"), words);
    };
    const std::string good = tensor_file_bytes(small_rgl());
    CHECK(folder.complaint(good, "m.bsdf") == "no error");
    check_says(folder.complaint("", "m.bsdf"), {"tensor_file"});
    check_says(folder.complaint("tensor_fool" + good.substr(11), "m.bsdf"), {"tensor_file"});
    check_says(folder.complaint(good.substr(0, 12) + '\2' + good.substr(13), "m.bsdf"),
               {"version 2.0", "1.0"});
    check_says(folder.complaint(good.substr(0, 30), "m.bsdf"), {"list of fields"});
    check_says(folder.complaint(good.substr(0, 60), "m.bsdf"), {"description", "60 bytes"});
    check_says(folder.complaint(good.substr(0, good.size() - 1), "m.bsdf"), {"beyond the end", "rgb"});
    for (const char* name : {"theta_i", "phi_i", "ndf", "sigma", "vndf", "luminance", "rgb", "jacobian"}) {
        TensorFields fields = small_rgl();
        std::erase_if(fields, [&](const auto& f) { return f.first == name; });
        says(fields, {name, "missing"});
    }
    TensorFields f = small_rgl();
    field(f, "vndf").shape[0] = uint64_t(1) << 62;
    says(f, {"vndf", "beyond the end"});
    f = small_rgl(), field(f, "vndf").type = 11;
    says(f, {"vndf"});
    f = small_rgl(), field(f, "vndf").type = 77;
    says(f, {"vndf", "77"});
    f = small_rgl(), field(f, "vndf").shape = {3, 1, 8, 8};
    CHECK(folder.complaint(tensor_file_bytes(f), "m.bsdf") == "no error");  // as many tables
    f = small_rgl(), field(f, "vndf").shape = {1, 2, 12, 8};
    says(f, {"vndf", "2", "3"});
    f = small_rgl(), field(f, "vndf").shape = {192};
    says(f, {"vndf", "192", "4"});
    f = small_rgl(), field(f, "luminance").shape = {1, 3, 2, 8};
    says(f, {"luminance", "rgb"});
    f = small_rgl(), field(f, "theta_i") = float_tensor({3}, {0.f, 0.7f, 0.6f});
    says(f, {"theta_i", "rise"});
    f = small_rgl(), field(f, "theta_i") = float_tensor({3}, {0.f, 0.7f, 60.f});
    says(f, {"theta_i", "60"});
    f = small_rgl();
    const float nan = std::nanf("");
    std::memcpy(&field(f, "rgb").bytes[8], &nan, 4);
    says(f, {"rgb", "number 2", "finite"});
    // Three azimuths over a third of a turn.
    f = small_rgl(), field(f, "phi_i") = float_tensor({3}, {-3.f, -2.f, -1.f});
    field(f, "theta_i") = float_tensor({1}, {0.5f});
    says(f, {"phi_i", "half"});
}

TEST_CASE("whatever becomes of the bytes of a file, reading it ends with the surface or with one line") {
    const Folder folder;
    const std::string rgl = tensor_file_bytes(small_rgl({400, 500, 600})), table = small_table().dump();
    std::mt19937 random(5);
    size_t read = 0, refused = 0;
    for (int i = 0; i < 3000; ++i) {
        const bool is_rgl = i % 2 == 0;
        std::string bytes = is_rgl ? rgl : table;
        const size_t header = is_rgl ? 400 : bytes.size();  // where a change matters most
        for (uint32_t k = random() % 4; k > 0; --k) bytes[random() % header] = char(random());
        if (random() % 4 == 0) bytes.resize(random() % bytes.size());
        const std::string line = folder.complaint(bytes, is_rgl ? "m.bsdf" : "t.json");
        (line == "no error" ? read : refused)++;
    }
    CHECK(read > 100);
    CHECK(refused > 1000);
}
