// Fresnel's equations on the device against double precision, and surfaces at the ends of their parameters'
// ranges.
#include <cmath>
#include <complex>

#include "tests/contracts/surface_configurations.h"
#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"

using namespace etendue;

namespace {

// The textbook form in complex double precision (Born & Wolf 1.5.2), which cancels where the device's does
// not.
double exact_reflectance(double cos_o, std::complex<double> eta) {
    const std::complex<double> sin2 = 1 - cos_o * cos_o, cos_i = std::sqrt(1.0 - sin2 / (eta * eta));
    const std::complex<double> s = (cos_o - eta * cos_i) / (cos_o + eta * cos_i);
    const std::complex<double> p = (eta * cos_o - cos_i) / (eta * cos_o + cos_i);
    return 0.5 * (std::norm(s) + std::norm(p));
}

struct FresnelQuery {
    float cosine, eta, k;
};

std::vector<glm::vec2> reflectances(const std::vector<FresnelQuery>& queries) {
    Buffer in = create_buffer(test_device(), queries, "queries"),
           out(test_device(), queries.size() * 8, "reflectances");
    const Kernel kernel = make_test_kernel("probe_fresnel", R"(
        #include "lib/constants.glsl"
        #include "features/spectrum.glsl"
        #include "lib/fresnel.glsl"
        layout(local_size_x = 64) in;
        layout(scalar, set = 0) readonly buffer Queries { vec3 queries[]; };
        layout(scalar, set = 0) writeonly buffer Reflectances { vec2 reflectances[]; };
        layout(push_constant) uniform Push { uint count; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= count) return;
            vec3 q = queries[i];
            reflectances[i] = vec2(fresnel_dielectric(q.x, q.y), fresnel_conductor(q.x, Spectrum(q.y), Spectrum(q.z)).x);
        }
    )",
                                           {{"Queries", &in}, {"Reflectances", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, uint32_t(queries.size() + 63) / 64, {{"count", uint32_t(queries.size())}});
    list.run();
    return out.read_array<glm::vec2>(queries.size());
}

std::vector<float> cosines() {
    std::vector<float> result = {1.0f, 0.9999999f, 1e-3f, 1e-5f, 1e-7f};
    for (int i = 1; i < 200; ++i) result.push_back(float(i) / 200);
    return result;
}

}  // namespace

TEST_CASE(
    "dielectric reflectance agrees with double precision, also for nearly matched media and at grazing "
    "angles") {
    std::vector<FresnelQuery> queries;
    for (float eta : {1.0001f, 0.9999f, 1.01f, 1.33f, 1.5f, 1 / 1.5f, 2.4f, 1 / 2.4f, 10.0f, 0.1f})
        for (float c : cosines()) queries.push_back({c, eta, 0});
    const auto results = reflectances(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const double cosine = queries[i].cosine, eta = queries[i].eta;
        const double g2 = eta * eta - 1 + cosine * cosine;
        const double exact = g2 <= 0 ? 1.0 : exact_reflectance(cosine, eta);
        // Beside the critical angle the reflectance has a vertical tangent: rounding the index moves it
        // visibly.
        const double tolerance = std::abs(g2) < 1e-3 ? 1e-3 : 1e-5 * exact + 1e-13;
        INFO("cos ", cosine, ", eta ", eta);
        CHECK(std::abs(results[i].x - exact) < tolerance);
    }
}

TEST_CASE("conductor reflectance agrees with double precision") {
    std::vector<FresnelQuery> queries;
    for (float eta : {0.0f, 0.05f, 0.143f, 1.0f, 1.442f, 3.0f, 50.0f})
        for (float k : {0.01f, 0.5f, 1.0f, 3.983f, 7.0f, 100.0f})
            for (float c : cosines()) queries.push_back({c, eta, k});
    const auto results = reflectances(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const double exact = exact_reflectance(queries[i].cosine, {queries[i].eta, -queries[i].k});
        INFO("cos ", queries[i].cosine, ", eta ", queries[i].eta, ", k ", queries[i].k);
        CHECK(std::abs(results[i].y - exact) < 2e-6);
    }
}

TEST_CASE("a conductor that does not absorb reflects as a dielectric") {
    std::vector<FresnelQuery> queries;
    for (float eta : {1.33f, 1.5f, 1 / 1.5f, 2.4f})
        for (float c : cosines()) queries.push_back({c, eta, 0});
    for (const glm::vec2& r : reflectances(queries)) CHECK(std::abs(r.x - r.y) < 1e-5);
}

TEST_CASE("nearly matched media pass light straight on") {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    SurfaceProbe probe(registry, "dielectric",
                       {{{"alpha", 0.0}}, {{"alpha", 0.3}}, {{"alpha", 1.0}, {"multiscatter", true}}});
    for (size_t record = 0; record < 3; ++record)
        for (float z : {1.0f, 0.5f, 0.05f, -0.3f}) {
            const glm::vec3 wo(std::sqrt(1 - z * z), 0, z);
            const SurfaceSamples matched = probe.sample(record, {1.5f, 1.5f}, wo, 256, 1);
            CHECK(matched.transparency == glm::vec3(1));
            for (const SurfaceSample& s : matched.samples) {
                CHECK(s.wi == -wo);
                CHECK(s.weight == glm::vec3(1));
                CHECK(s.event == (event_transmit | event_delta | event_straight));
            }
            for (const SurfaceSample& s : probe.sample(record, {1.5f, 1.50001f}, wo, 256, 1).samples) {
                if (!(s.event & event_transmit)) continue;
                CHECK(glm::length(s.wi + wo) < 1e-3f);
                CHECK(s.weight.x == doctest::Approx(1).epsilon(1e-4));
            }
        }
}

TEST_CASE("surfaces stay finite and not negative at the ends of their parameters and directions") {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    // Directions on and beside the horizon and the normal, exactly opposite and mirrored ones among their
    // pairs.
    std::vector<glm::vec3> directions;
    for (float z : {1.0f, 0.99999994f, 0.5f, 1e-3f, 1e-7f, 1e-20f, 1e-38f, 0.0f})
        for (float sign : {1.0f, -1.0f})
            for (float azimuth : {0.0f, 1.0f, 3.14159265f, 4.14159265f}) {
                const float r = std::sqrt(1 - z * z);
                directions.push_back({r * std::cos(azimuth), r * std::sin(azimuth), sign * z});
            }
    std::vector<DirectionPair> pairs;
    for (glm::vec3 wo : directions) {
        for (glm::vec3 wi : directions) pairs.push_back({wo, wi});
        pairs.push_back({wo, -wo});
    }
    const auto good = [](float x) { return std::isfinite(x) && x >= 0; };
    for (const ClassInfo& info : registry.classes(Interface::surface)) {
        std::vector<nlohmann::json> parameters;
        for (const auto& configuration : surface_configurations(info.name))
            parameters.push_back(configuration.parameters);
        if (info.name == "conductor" || info.name == "dielectric")
            for (const bool multiscatter : {false, true})
                for (float alpha : {9e-5f, 1e-4f, 1.1e-4f, 1e-3f, 1.0f})
                    parameters.push_back({{"alpha", alpha}, {"multiscatter", multiscatter}});
        if (info.name == "conductor")
            for (float eta : {0.0f, 1.0f, 1e-10f, 1e10f})
                for (float k : {0.0f, 1e-10f, 1e10f})
                    parameters.push_back({{"eta", eta}, {"k", k}, {"alpha", 0.2}});
        if (info.name == "principled")
            for (float ior : {0.0f, 1.0f, 100.0f})
                for (float roughness : {0.0f, 0.0100001f, 1.0f})
                    parameters.push_back(
                        {{"metallic", 0}, {"roughness", roughness}, {"ior", ior}, {"transmission", 0.5}});
        SurfaceProbe probe(registry, info.name, parameters);
        for (size_t record = 0; record < parameters.size(); ++record)
            for (const SurfaceSurroundings& at : {SurfaceSurroundings{1, 1},
                                                  {1, 1.5f},
                                                  {1.5f, 1.5001f},
                                                  {1.0000001f, 1},
                                                  {4, 1, true},
                                                  {1, 1.0003f, true}}) {
                size_t bad = 0;
                for (const SurfaceValue& v : probe.evaluate(record, at, pairs))
                    bad += !good(v.f_cos.x) || !good(v.f_cos.y) || !good(v.f_cos.z) || !good(v.pdf);
                for (size_t i = 0; i < directions.size(); i += 7)
                    for (const SurfaceSample& s : probe.sample(record, at, directions[i], 64, 5).samples)
                        bad += !good(s.pdf) || !good(s.weight.x) || !good(s.weight.y) || !good(s.weight.z) ||
                               !(std::abs(glm::length(s.wi) - 1) < 1e-5) || (s.event && !(s.pdf > 0));
                INFO(info.name, " ", parameters[record].dump(), ", media ", at.ior_above, " over ",
                     at.ior_below);
                CHECK(bad == 0);
            }
    }
}
