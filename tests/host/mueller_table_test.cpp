// Files of measured Mueller matrices: what is read of them, and what is said of bad ones.
#include "host/measured/mueller_table.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "host/error.h"
#include "host/measured/mueller_matrix.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using Matrix = std::array<double, 16>;

namespace {

using std::numbers::pi;

constexpr Matrix grey = {0.2, 0.05, 0, 0, 0.05, 0.1, 0, 0, 0, 0, -0.1, 0.02, 0, 0, -0.02, -0.1};

struct Folder {
    TemporaryFolder folder;
    MuellerTables lists;
    MuellerFile read(const TensorFields& fields, size_t bytes = std::string::npos) {
        lists = {};
        write_text(folder / "m.pbsdf", tensor_file_bytes(fields).substr(0, bytes));
        return read_mueller_file(folder / "m.pbsdf", 2, lists);
    }
    void refuses(const TensorFields& fields, const std::vector<std::string>& words,
                 size_t bytes = std::string::npos) {
        std::string line = "no error";
        try {
            read(fields, bytes);
        } catch (const Error& e) {
            CHECK(e.code == ExitCode::bad_input);
            line = e.what();
        }
        CHECK_MESSAGE(line.find('\n') == std::string::npos, line);
        for (const std::string& word : words) CHECK_MESSAGE(line.find(word) != std::string::npos, line);
    }
    // A matrix of the lists, as the device has it.
    Matrix matrix(size_t i) const {
        Matrix m;
        for (size_t k = 0; k < 16; ++k) {
            const uint32_t word = lists.ratios[2 * i + k / 8][int(k % 8 / 2)];
            m[k] = double(int16_t(k % 2 ? word >> 16 : word)) / 32767 * lists.intensities[i];
        }
        return m;
    }
    // … and the one at [phi_d][theta_d][theta_h][wavelength].
    Matrix matrix(const MuellerTable& t, size_t phi, size_t d, size_t h, size_t nm) const {
        return matrix(t.matrices + ((phi * t.nodes.y + d) * t.nodes.z + h) * t.wavelengths + nm);
    }
};

TensorFields small_file(const std::vector<uint16_t>& nm = {500, 600}) {
    return mueller_fields(even_nodes(9, 4, 6), nm, [](double, const auto&, const auto&) { return grey; });
}

TensorData& field(TensorFields& fields, const std::string& name) {
    for (auto& [key, data] : fields)
        if (key == name) return data;
    FAIL("no field ", name);
    return fields[0].second;
}

void set_matrix(TensorFields& fields, size_t i, const Matrix& m) {
    for (size_t k = 0; k < 16; ++k) {
        const float x = float(m[k]);
        std::memcpy(&field(fields, "M").bytes[(16 * i + k) * sizeof(float)], &x, sizeof(float));
    }
}

double greatest_difference(const Matrix& a, const Matrix& b) {
    double result = 0;
    for (size_t k = 0; k < 16; ++k) result = std::max(result, std::fabs(a[k] - b[k]));
    return result;
}

}  // namespace

TEST_CASE(
    "matrices are kept to 1.2e-4 of the first element, which is exact, once around and at their "
    "wavelengths") {
    Folder folder;
    const MuellerFile file = folder.read(small_file({300, 340, 500, 600, 900, 1000}));
    const MuellerTable& t = file.table;
    CHECK(t.nodes == glm::uvec3(9, 4, 6));
    CHECK(t.wavelengths == 4);  // 340 to 900 nm
    CHECK(folder.lists.numbers[t.axes.x + 8] == doctest::Approx(pi));
    CHECK(file.place.table->at(550) == doctest::Approx(1.5));
    CHECK(file.place.rgb.z == doctest::Approx(1 - 36 / 160.0));
    CHECK(folder.lists.intensities.size() == 9 * 4 * 6 * 4);
    for (size_t i = 0; i < folder.lists.intensities.size(); ++i) {
        if (folder.lists.intensities[i] == 0) continue;
        CHECK(folder.lists.intensities[i] == 0.2f);
        CHECK(greatest_difference(folder.matrix(i), grey) < 1.2e-4 * 0.2);
    }
    // The last node around may be left out.
    MuellerNodes nodes = even_nodes(9, 4, 6);
    nodes.phi_d.pop_back();
    const MuellerTable open = folder
                                  .read(mueller_fields(nodes, {500},
                                                       [](double, const auto& from, const auto&) {
                                                           Matrix m = grey;
                                                           m[0] = 0.2 + 0.1 * from.y;
                                                           return m;
                                                       }))
                                  .table;
    CHECK(open.nodes.x == 9);
    CHECK(folder.matrix(open, 0, 2, 1, 0) == folder.matrix(open, 8, 2, 1, 0));
    CHECK(folder.matrix(open, 0, 2, 1, 0) != folder.matrix(open, 2, 2, 1, 0));
}

TEST_CASE("what was not measured is as the nearest theta_h that was, else the nearest theta_d, else black") {
    Folder folder;
    TensorFields fields =
        mueller_fields(even_nodes(5, 3, 4), {500},
                       [](double, const auto& from, const auto& to) { return Matrix{from.z + to.z}; });
    const Matrix none = {NAN}, other = {7};
    set_matrix(fields, 1, other);  // [0][0][1]
    for (const size_t i : {2, 3}) set_matrix(fields, i, none);
    for (const size_t i : {4, 5, 6, 7}) set_matrix(fields, i, none);  // [0][1]
    for (size_t i = 12; i < 24; ++i) set_matrix(fields, i, none);     // [1]
    set_matrix(fields, 13, {1, NAN});
    const MuellerTable t = folder.read(fields).table;
    CHECK(folder.matrix(t, 0, 0, 0, 0)[0] == 2);
    for (const size_t h : {1, 2, 3}) CHECK(folder.matrix(t, 0, 0, h, 0)[0] == 7);
    for (const size_t h : {1, 2, 3}) CHECK(folder.matrix(t, 0, 1, h, 0)[0] == 7);
    for (size_t i = 12; i < 24; ++i) CHECK(folder.matrix(t.matrices + i)[0] == 0);
}

// Whatever a file says, no vector has more polarization than light behind a matrix that is read of it.
TEST_CASE("matrices that noise has made unphysical become physical") {
    Folder folder;
    TensorFields fields = small_file();
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0, 1);
    const size_t count = field(fields, "M").bytes.size() / 64;
    size_t unphysical = 0;
    for (size_t i = 0; i < count; ++i) {
        Matrix m = grey;
        for (double& x : m) x += (i % 2 ? 0.05 : 0.3) * noise(random);
        set_matrix(fields, i, m);
        unphysical += !flaw_of(m).empty();
    }
    CHECK(unphysical > count / 2);
    folder.read(fields);
    size_t black = 0;
    for (size_t i = 0; i < folder.lists.intensities.size(); ++i) {
        const Matrix m = folder.matrix(i);
        black += m[0] == 0;
        CHECK(m[0] >= 0);
        Matrix ratios = m;  // flaw_of wants no more light than came
        for (double& x : ratios) x *= m[0] > 0 ? 0.25 / m[0] : 0;
        CHECK(flaw_of(ratios) == "");
        for (int k = 0; k < 20; ++k) {
            glm::dvec3 s(noise(random), noise(random), noise(random));
            s /= glm::length(s);
            double out[4];
            for (size_t r = 0; r < 4; ++r)
                out[r] = m[4 * r] + m[4 * r + 1] * s.x + m[4 * r + 2] * s.y + m[4 * r + 3] * s.z;
            CHECK(out[0] >= std::hypot(out[1], out[2], out[3]));
        }
    }
    CHECK(black > 10);
    CHECK(black < count / 2);
}

TEST_CASE("samples follow the light that facets reflect, and integrate to one") {
    Folder folder;
    const auto lobe_of = [&](double floor) {
        const MuellerTable t = folder
                                   .read(mueller_fields(even_nodes(9, 10, 31), {500},
                                                        [=](double, const auto& from, const auto& to) {
                                                            const double z = glm::normalize(from + to).z;
                                                            return Matrix{floor + std::pow(z, 400)};
                                                        }))
                                   .table;
        const float* x = &folder.lists.numbers[t.lobe];
        double sum = 0, narrow = 0;
        for (size_t i = 1; i < t.lobe_nodes; ++i) {
            CHECK(x[i] > x[i - 1]);
            const double part = 0.5 * (x[t.lobe_nodes + i] + x[t.lobe_nodes + i - 1]) * (x[i] - x[i - 1]);
            sum += part;
            if (x[i] < 0.03) narrow += part;
            CHECK(x[2 * t.lobe_nodes + i] == doctest::Approx(sum).epsilon(1e-5));
        }
        CHECK(sum == doctest::Approx(1));
        return std::pair<double, double>(narrow, t.cosine_part);
    };
    const auto glossy = lobe_of(0), matte = lobe_of(1), both = lobe_of(0.01);
    CHECK(glossy.first > 0.95);
    CHECK(glossy.second == doctest::Approx(0.1));
    CHECK(matte.first < 0.1);
    CHECK(matte.second == doctest::Approx(0.9));
    CHECK(both.second > 0.3);
    CHECK(both.second < 0.9);
}

TEST_CASE("a bad file of matrices is one line: the field, and what is allowed") {
    Folder folder;
    const TensorFields good = small_file();
    folder.read(good);
    folder.refuses(good, {"M", "beyond the end"}, tensor_file_bytes(good).size() - 1);
    folder.refuses(good, {"list of fields"}, 40);
    folder.refuses(good, {"tensor_file"}, 5);
    for (const char* name : {"phi_d", "theta_d", "theta_h", "wvls", "M"}) {
        TensorFields fields = good;
        std::erase_if(fields, [&](const auto& f) { return f.first == name; });
        folder.refuses(fields, {"m.pbsdf", name, "missing"});
        fields = good, field(fields, name).type = 11;
        folder.refuses(fields, {"m.pbsdf", name});
    }
    const auto with = [&](const char* name, const TensorData& data) {
        TensorFields fields = good;
        field(fields, name) = data;
        return fields;
    };
    folder.refuses(with("theta_d", float_tensor({1, 4}, {0, 0.5f, 0.4f, 1})),
                   {"theta_d", "number 2", "rise"});
    folder.refuses(with("theta_h", float_tensor({1, 6}, {0, 10, 20, 30, 40, 50})), {"theta_h", "10"});
    folder.refuses(with("theta_d", float_tensor({1, 4}, {0, 0.5f, NAN, 1})), {"theta_d", "not finite"});
    folder.refuses(with("theta_d", float_tensor({4}, {0, 0.5f, 0.7f, 1})),
                   {"theta_d", "[4]", "2 dimensions"});
    folder.refuses(with("theta_d", {10, {0, 4}, {}}), {"theta_d", "[0 x 4]", "none empty"});
    folder.refuses(with("theta_d", float_tensor({1, 1}, {0})), {"theta_d", "at least 2"});
    folder.refuses(with("theta_d", float_tensor({1, 3}, {0, 0.5f, 1})),
                   {"M", "[9 x 4 x 6 x 2 x 4 x 4]", "[9 x 3"});
    folder.refuses(with("phi_d", float_tensor({1, 9}, {-1, -0.8f, -0.5f, 0, 0.2f, 0.4f, 0.6f, 0.8f, 1})),
                   {"phi_d", "once around"});
    const auto nm = [](uint16_t a, uint16_t b) {
        return TensorData{3, {2}, {uint8_t(a), uint8_t(a >> 8), uint8_t(b), uint8_t(b >> 8)}};
    };
    folder.refuses(with("wvls", nm(600, 500)), {"wvls", "number 1", "500", "rise"});
    folder.refuses(with("wvls", nm(0, 500)), {"wvls", "number 0"});
    TensorFields fields = good;
    field(fields, "M").shape = {9, 4, 6, 2, 16};
    folder.refuses(fields, {"M", "6 dimensions"});
    field(fields, "M").shape = {9, 4, 6, 2, 2, 8};
    folder.refuses(fields, {"M", "[9 x 4 x 6 x 2 x 2 x 8]"});
    CHECK_THROWS_AS(read_mueller_file(folder.folder / "none.pbsdf", 2, folder.lists), Error);
}
