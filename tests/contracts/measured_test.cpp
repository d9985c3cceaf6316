// Measured surfaces on the device, from files that are made from formulas, against those formulas.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/contracts/surface_configurations.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using nlohmann::json;

namespace {

using std::numbers::pi;

std::string file_place(const std::string& name) {
    static const TemporaryFolder folder;
    return (folder / name).string();
}

std::string write_table(const std::string& name, const json& table) {
    write_text(file_place(name), table.dump());
    return file_place(name);
}

std::string write_rgl(const std::string& name, const TensorFields& fields) {
    write_text(file_place(name), tensor_file_bytes(fields));
    return file_place(name);
}

GgxMetal gold(double alpha_x, double alpha_y) {
    return {alpha_x, alpha_y, [](double cosine, size_t channel) {
                const double eta[3] = {0.143, 0.375, 1.442}, k[3] = {3.983, 2.386, 1.603};
                return conductor_reflectance(cosine, eta[channel], k[channel]);
            }};
}

GgxMetal grey(double alpha, double reflectance) {
    return {alpha, alpha, [=](double, size_t) { return reflectance; }};
}

json gold_table(double alpha, size_t angles) {
    json table = {{"theta_i", even_angles(0, 90, angles)},
                  {"theta_r", even_angles(0, 90, angles)},
                  {"phi", even_angles(0, 180, 2 * angles)}};
    table["reflection"] = table_side(table, [=](double i, double r, double p) {
        json rgb;
        for (size_t c = 0; c < 3; ++c) rgb.push_back(ggx_bsdf(gold(alpha, alpha), c, i, r, p));
        return rgb;
    });
    return table;
}

json constant_table(double reflection, const json& transmission) {
    json table = {{"theta_i", {0, 40}}, {"theta_r", {10, 80}}, {"phi", {0, 90, 180}}};
    table["reflection"] = table_side(table, [=](double, double, double) { return json(reflection / pi); });
    if (!transmission.is_null())
        table["transmission"] = table_side(table, [=](double, double, double) {
            json rgb;
            for (const double t : transmission) rgb.push_back(t / pi);
            return rgb;
        });
    return table;
}

// Brighter from one angle than back along the way, and from one side of the plane of incidence than from the
// other.
json lopsided_table() {
    json table = {
        {"theta_i", {0, 30, 55, 80}}, {"theta_r", {5, 20, 50, 70, 88}}, {"phi", even_angles(0, 360, 13)}};
    const auto value = [](double scale) {
        return [=](double i, double r, double p) {
            return json(scale * (1 + i / 90) * (1.3 + std::cos((p - 40) * pi / 180)) * (r > 60 ? 0.02 : 1));
        };
    };
    table["reflection"] = table_side(table, value(0.06));
    table["transmission"] = table_side(table, value(0.04));
    return table;
}

std::vector<double> visible_wavelengths() { return even_angles(380, 780, 21); }

// Redder at longer wavelengths.
GgxMetal spectral_metal() {
    return {0.25, 0.25, [](double, size_t channel) { return 0.2 + 0.03 * double(channel); }};
}

RglResolution quarter_turn() {
    RglResolution resolution;
    resolution.phi_i = even_angles(-pi, -pi / 2, 9);
    resolution.points = 48, resolution.value_points = 24;
    return resolution;
}

// How values on the device differ from what they should be: the mean error over the mean.
struct Difference {
    double mean = 0, of_albedo = 0;
};

// Over random directions for some fixed ones.
Difference difference(const std::string& file, const std::string& class_name, const json& parameters) {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    SurfaceProbe measured(registry, "measured", {{{"file", file}}}),
        exact(registry, class_name, {parameters});
    double error = 0, sum = 0;
    glm::dvec3 albedo(0), exact_albedo(0);
    for (const double cosine : {0.98, 0.75, 0.5, 0.25})
        for (const double azimuth : {-2.5, 0.4, 2.0}) {
            const double s = std::sqrt(1 - cosine * cosine);
            const glm::vec3 wo(s * std::cos(azimuth), s * std::sin(azimuth), cosine);
            std::vector<DirectionPair> pairs;
            constexpr int n =
                20000;  // points of a lattice by the golden ratio, even in projected solid angle
            for (int i = 0; i < n; ++i) {
                const double r = std::sqrt((i + 0.5) / n),
                             phi = 2 * pi * std::fmod(i * 0.6180339887498949, 1.0);
                pairs.push_back({wo, glm::vec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r))});
            }
            const auto a = measured.evaluate(0, {}, pairs), b = exact.evaluate(0, {}, pairs);
            for (size_t i = 0; i < pairs.size(); ++i) {
                const double z = pairs[i].wi.z;
                albedo += glm::dvec3(a[i].f_cos) / z, exact_albedo += glm::dvec3(b[i].f_cos) / z;
                for (int c = 0; c < 3; ++c) {
                    error += std::abs(double(a[i].f_cos[c]) - b[i].f_cos[c]) / z;
                    sum += b[i].f_cos[c] / z;
                }
            }
        }
    const glm::dvec3 ratio = glm::abs(albedo / exact_albedo - 1.0);
    return {error / sum, std::max({ratio.x, ratio.y, ratio.z})};
}

}  // namespace

namespace etendue {

std::vector<SurfaceConfiguration> measured_files() {
    using C = SurfaceConfiguration;
    const auto table = [](const char* name, const json& content) {
        return json{{"file", write_table(name, content)}};
    };
    const auto rgl = [](const char* name, const TensorFields& fields) {
        return json{{"file", write_rgl(name, fields)}};
    };
    C lopsided{"lopsided table", table("lopsided.json", lopsided_table()), 1, 1.5f};
    C isotropic{"gold, alpha .3, RGL", rgl("gold.bsdf", rgl_fields(gold(0.3, 0.3), {}))};
    C spectral{"metal in wavelengths, RGL",
               rgl("spectral.bsdf", rgl_fields(spectral_metal(), visible_wavelengths()))};
    C brushed{"brushed gold, RGL", rgl("brushed.bsdf", rgl_fields(gold(0.15, 0.4), {}, quarter_turn()))};
    for (C* c : {&lopsided, &isotropic, &spectral, &brushed}) c->is_reciprocal = false;
    return {C{"white table", table("white.json", constant_table(1, {})), 1, 1, 1.0},
            C{"paper table under water", table("paper.json", constant_table(0.4, {0.6, 0.5, 0.3})), 1.33f, 1},
            C{"gold, alpha .4, table", table("gold.json", gold_table(0.4, 19))},
            lopsided,
            isotropic,
            spectral,
            brushed};
}

}  // namespace etendue

TEST_CASE("a table made from Lambert's law is Lambert's law") {
    const std::string file = write_table("lambert.json", constant_table(0.6, {}));
    const Difference d = difference(file, "lambertian", {{"reflectance", 0.6}});
    CHECK(d.mean < 1e-6);
}

TEST_CASE("a table made from a rough metal is that metal, the nearer the finer it is") {
    const json metal = {{"eta", {0.143, 0.375, 1.442}}, {"k", {3.983, 2.386, 1.603}}, {"alpha", 0.4}};
    const Difference coarse = difference(write_table("coarse.json", gold_table(0.4, 13)), "conductor", metal);
    const Difference fine = difference(write_table("fine.json", gold_table(0.4, 37)), "conductor", metal);
    CAPTURE(coarse.mean);
    CAPTURE(fine.mean);
    CHECK(coarse.mean < 0.02);
    CHECK(fine.mean < 0.25 * coarse.mean);
    CHECK(fine.of_albedo < 0.01);
}

TEST_CASE("an RGL file made from a rough metal is that metal, the nearer the finer it is") {
    const auto metal = [](double alpha) {
        return json{{"eta", {0.143, 0.375, 1.442}}, {"k", {3.983, 2.386, 1.603}}, {"alpha", alpha}};
    };
    for (const double alpha : {0.4, 0.1}) {
        RglResolution fine;
        fine.points = 160, fine.value_points = 64;
        const Difference coarse = difference(write_rgl("coarse.bsdf", rgl_fields(gold(alpha, alpha), {})),
                                             "conductor", metal(alpha)),
                         d = difference(write_rgl("fine.bsdf", rgl_fields(gold(alpha, alpha), {}, fine)),
                                        "conductor", metal(alpha));
        CAPTURE(alpha);
        CAPTURE(coarse.mean);
        CAPTURE(d.mean);
        CAPTURE(d.of_albedo);
        CHECK(coarse.mean < 0.015);
        CHECK(d.mean < 0.004);
        CHECK(d.of_albedo < 0.005);
    }
}

TEST_CASE("a brushed metal's RGL file is that metal, whichever part of a turn it holds") {
    // The class of glTF materials has anisotropic metal of one colour at all angles where its edge is as the
    // rest.
    const double alpha_x = 0.4, alpha_y = 0.2;
    GgxMetal metal{alpha_x, alpha_y, [](double, size_t) { return 1.0; }};
    json first;
    std::vector<SurfaceValue> quarter;
    for (const double last : {-pi / 2, 0.0, pi}) {
        RglResolution resolution;
        resolution.phi_i = even_angles(-pi, last, size_t(std::lround((last + pi) / (pi / 2))) * 12 + 1);
        resolution.theta_i = {0, 0.3, 0.6, 0.9, 1.2, 1.5};
        resolution.points = 96, resolution.value_points = 16;
        ShaderSources sources;
        sources.folder = source_path("shaders");
        ClassRegistry registry(sources);
        SurfaceProbe probe(registry, "measured",
                           {{{"file", write_rgl("part.bsdf", rgl_fields(metal, {}, resolution))}}});
        std::vector<DirectionPair> pairs;
        for (int i = 0; i < 4000; ++i) {
            const auto on_disk = [](double u, double v) {
                const double r = std::sqrt(0.9 * u), phi = 2 * pi * v;
                return glm::vec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r));
            };
            pairs.push_back(
                {on_disk(std::fmod(i * 0.7548776662466927, 1.0), std::fmod(i * 0.5698402909980532, 1.0)),
                 on_disk(std::fmod(i * 0.8191725133961645, 1.0), std::fmod(i * 0.6710436067037893, 1.0))});
        }
        const auto values = probe.evaluate(0, {}, pairs);
        double error = 0, sum = 0, apart = 0;
        for (size_t i = 0; i < pairs.size(); ++i) {
            const glm::dvec3 a = pairs[i].wo, b = pairs[i].wi, h = glm::normalize(a + b);
            const auto seen = [&](const glm::dvec3& w) {
                return 0.5 *
                       (w.z + std::sqrt(w.z * w.z + std::pow(alpha_x * w.x, 2) + std::pow(alpha_y * w.y, 2)));
            };
            const double q = std::pow(h.x / alpha_x, 2) + std::pow(h.y / alpha_y, 2) + h.z * h.z;
            const double exact = b.z / (pi * alpha_x * alpha_y * q * q * 4 * seen(a) * seen(b));
            error += std::abs(values[i].f_cos.x - exact), sum += exact;
            if (!quarter.empty()) apart += std::abs(values[i].f_cos.x - quarter[i].f_cos.x);
        }
        CAPTURE(last);
        CHECK(error < 0.03 * sum);
        CHECK(apart < 0.002 * sum);
        if (quarter.empty()) quarter = values;
    }
}

TEST_CASE("samples of a measured metal weigh what it reflects") {
    // The density follows the values: weights differ by the colours alone.
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    const std::string table = write_table("grey.json", [] {
        json t = gold_table(0.4, 13);
        t["reflection"] = table_side(
            t, [](double i, double r, double p) { return json(ggx_bsdf(grey(0.4, 0.5), 0, i, r, p)); });
        return t;
    }());
    SurfaceProbe probe(
        registry, "measured",
        {{{"file", table}}, {{"file", write_rgl("grey.bsdf", rgl_fields(grey(0.2, 0.5), {}))}}});
    for (size_t record = 0; record < 2; ++record) {
        const auto drawn = probe.sample(record, {}, glm::vec3(0.6f, 0, 0.8f), 20000, 5);
        double sum = 0, squares = 0, count = 0;
        for (const SurfaceSample& s : drawn.samples)
            if (s.event) sum += s.weight.x, squares += double(s.weight.x) * s.weight.x, count++;
        const double mean = sum / count,
                     spread = std::sqrt(std::max(squares / count - mean * mean, 0.0)) / mean;
        CAPTURE(record);
        CAPTURE(mean);
        CHECK(spread < (record == 0 ? 1e-3 : 0.05));
    }
}
