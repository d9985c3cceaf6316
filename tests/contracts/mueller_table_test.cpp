// Tables of Mueller matrices on the device, from files that are made from formulas, against those formulas.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/contracts/mueller_frames.h"
#include "tests/contracts/surface_configurations.h"
#include "tests/support/bsdf_files.h"
#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;
using glm::dmat4;
using glm::dvec3;
using nlohmann::json;

namespace {

using std::numbers::pi;

const std::vector<uint16_t> channel_nm = {464, 549, 611};  // what B, G and R stand for

json write_file(const std::string& name, const TensorFields& fields) {
    static const TemporaryFolder folder;
    write_text(folder / name, tensor_file_bytes(fields));
    return {{"file", (folder / name).string()}};
}

PolarizedMetal gold(double alpha) {
    return {alpha, [](double nm) -> std::complex<double> {
                if (nm < 500) return {1.442, -1.603};
                return nm < 580 ? std::complex(0.375, -2.386) : std::complex(0.143, -3.983);
            }};
}

TensorFields gold_fields(double alpha, const MuellerNodes& nodes) {
    return mueller_fields(nodes, channel_nm, [=](double nm, const dvec3& from, const dvec3& to) {
        return metal_matrix(gold(alpha), nm, from, to);
    });
}

// Brighter on one side of the plane of incidence than on the other, and not of two blocks; and yet
// reciprocal, but for what is brighter `one_way`.
std::array<double, 16> handed(double one_way, const dvec3& from, const dvec3& to) {
    const double twist = glm::cross(from, to).z * (from.z - to.z);
    const double f = 0.12 * (1 + 0.9 * twist + one_way * (from.z - to.z)), a = 0.1 * f * std::tanh(4 * twist);
    return {f, 0, a, 0, 0, 0.3 * f, 0, 0, -a, 0, -0.3 * f, 0, 0, 0, 0, 0.2 * f};
}

TensorFields handed_fields(double one_way, const MuellerNodes& nodes) {
    return mueller_fields(
        nodes, {600}, [=](double, const dvec3& from, const dvec3& to) { return handed(one_way, from, to); });
}

ClassRegistry registry() {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    return ClassRegistry(sources);
}

// Pairs of directions well above the horizon, where tables have no edge.
std::vector<MuellerQuery> queries(size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part;
    std::vector<MuellerQuery> result;
    while (result.size() < count) {
        const auto drawn = [&] {
            return direction(std::acos(std::lerp(0.45, 1.0, part(random))), 2 * pi * part(random));
        };
        result.push_back({drawn(), drawn(), 0});
    }
    return result;
}

dvec3 across(const MuellerQuery& q) { return glm::normalize(glm::cross(dvec3(q.from), dvec3(q.to))); }

// In units of the first element, in frames whose x lies across the plane of both directions.
dmat4 in_plane(const MuellerQuery& q, const MuellerAnswer& a, int lane) {
    return rotator(a.to, across(q), q.to) * matrix(a, lane) * rotator(across(q), a.from, -dvec3(q.from));
}

double greatest_difference(const dmat4& found, const std::array<double, 16>& expected) {
    double apart = 0;
    for (int k = 0; k < 16; ++k)
        apart = std::max(apart, std::fabs(found[k % 4][k / 4] - expected[size_t(k)] / expected[0]));
    return apart;
}

struct Difference {
    double intensity = 0, matrix = 0;  // mean over the mean; greatest, of ratios
};

// From the formulas of the metal, and the class conductor.
Difference difference(SurfaceProbe& table, SurfaceProbe& metal, double alpha) {
    const auto asked = queries(2000);
    std::vector<DirectionPair> pairs;
    for (const MuellerQuery& q : asked) pairs.push_back({q.to, q.from});
    const auto values = table.evaluate(0, {}, pairs), exact = metal.evaluate(0, {}, pairs);
    const auto matrices = table.polarize(0, {}, asked), of_metal = metal.polarize(0, {}, asked);
    Difference d;
    double sum = 0;
    for (size_t i = 0; i < asked.size(); ++i)
        for (int lane = 0; lane < 3; ++lane) {
            const auto expected =
                metal_matrix(gold(alpha), channel_nm[size_t(2 - lane)], asked[i].from, asked[i].to);
            REQUIRE(exact[i].f_cos[lane] == doctest::Approx(expected[0] * asked[i].from.z).epsilon(1e-4));
            d.intensity += std::fabs(values[i].f_cos[lane] / asked[i].from.z - expected[0]),
                sum += expected[0];
            d.matrix =
                std::max(d.matrix, greatest_difference(in_plane(asked[i], matrices[i], lane), expected));
            REQUIRE(greatest_difference(in_plane(asked[i], of_metal[i], lane), expected) < 1e-4);
        }
    d.intensity /= sum;
    return d;
}

}  // namespace

namespace etendue {

std::vector<SurfaceConfiguration> mueller_files() {
    using C = SurfaceConfiguration;
    return {C{"gold, alpha .4, table", write_file("gold.pbsdf", gold_fields(0.4, even_nodes(25, 10, 19)))},
            C{"handed table", write_file("handed.pbsdf", handed_fields(0, even_nodes(33, 9, 13)))}};
}

}  // namespace etendue

TEST_CASE("a table made from a rough metal is that metal, the nearer the finer it is") {
    ClassRegistry classes = registry();
    SurfaceProbe metal(classes, "conductor",
                       {{{"eta", {0.143, 0.375, 1.442}}, {"k", {3.983, 2.386, 1.603}}, {"alpha", 0.4}}});
    const auto of_table = [&](const MuellerNodes& nodes) {
        SurfaceProbe probe(classes, "mueller_table", {write_file("metal.pbsdf", gold_fields(0.4, nodes))});
        return difference(probe, metal, 0.4);
    };
    const Difference coarse = of_table(even_nodes(19, 7, 13)), fine = of_table(even_nodes(37, 19, 37));
    MESSAGE("coarse ", coarse.intensity, ", ", coarse.matrix, "; fine ", fine.intensity, ", ", fine.matrix);
    CHECK(coarse.intensity < 0.05);
    CHECK(fine.intensity < 0.2 * coarse.intensity);
    CHECK(coarse.matrix < 0.15);
    CHECK(fine.matrix < 0.2 * coarse.matrix);
}

TEST_CASE("a handed table is handed the same way from both sides, and for light of both directions") {
    ClassRegistry classes = registry();
    SurfaceProbe probe(classes, "mueller_table",
                       {write_file("fine.pbsdf", handed_fields(0.4, even_nodes(65, 19, 31)))});
    const auto above = queries(1000);
    auto turned = above;
    for (MuellerQuery& q : turned)
        for (glm::vec3* w : {&q.from, &q.to}) w->y = -w->y, w->z = -w->z;
    for (const auto& asked : {above, turned})
        for (const bool importance : {false, true}) {
            std::vector<DirectionPair> pairs;
            for (const MuellerQuery& q : asked)
                pairs.push_back(importance ? DirectionPair{q.from, q.to} : DirectionPair{q.to, q.from});
            const SurfaceSurroundings at{1, 1, importance};
            const auto values = probe.evaluate(0, at, pairs);
            const auto matrices = probe.polarize(0, at, asked);
            double worst = 0, most_handed = 0;
            for (size_t i = 0; i < asked.size(); ++i) {
                const auto expected = handed(0.4, above[i].from, above[i].to);
                const double f = values[i].f_cos.x / std::fabs(pairs[i].wi.z);
                worst = std::max({worst, std::fabs(f / expected[0] - 1),
                                  greatest_difference(in_plane(asked[i], matrices[i], 0), expected)});
                most_handed = std::max(most_handed, std::fabs(expected[2] / expected[0]));
            }
            CAPTURE(importance);
            CHECK(worst < 0.02);
            CHECK(most_handed > 0.06);
        }
}
