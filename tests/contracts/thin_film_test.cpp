// Thin films on the device against a transfer matrix in double precision.
#include <cmath>
#include <complex>
#include <random>

#include "host/spectra/color.h"
#include "tests/support/source_path.h"
#include "tests/support/surface_probe.h"

using namespace etendue;

namespace {

using Complex = std::complex<double>;

// Product of the matrices of two faces and the way between (Born & Wolf 1.6.2, by amplitudes to and fro), for
// one polarization. Indices n - i k; angles by Snell's law with complex cosines.
double transfer_matrix(double cosine, double n1, double film, double thickness, Complex base, double nm,
                       bool p) {
    const auto angle = [&](Complex n) {
        const Complex c = std::sqrt(1.0 - n1 * n1 * (1 - cosine * cosine) / (n * n));
        return (n * c).imag() > 0 ? -c : c;
    };
    const Complex c[3] = {cosine, angle(film), angle(base)}, n[3] = {n1, film, base};
    struct Matrix {
        Complex a, b, c, d;
    };
    const auto face = [&](int i) {
        const Complex x = p ? n[i + 1] * c[i] : n[i] * c[i], y = p ? n[i] * c[i + 1] : n[i + 1] * c[i + 1];
        const Complex r = (x - y) / (x + y), t = 2.0 * n[i] * c[i] / (x + y);
        return Matrix{1.0 / t, r / t, r / t, 1.0 / t};
    };
    const auto product = [](const Matrix& m, const Matrix& o) {
        return Matrix{m.a * o.a + m.b * o.c, m.a * o.b + m.b * o.d, m.c * o.a + m.d * o.c,
                      m.c * o.b + m.d * o.d};
    };
    const Complex phase = Complex(0, 1) * (2 * std::acos(-1.0) * thickness / nm) * n[1] * c[1];
    const Matrix m = product(product(face(0), {std::exp(phase), 0, 0, std::exp(-phase)}), face(1));
    return std::norm(m.c / m.a);
}

double exact_film(double cosine, double n1, double film, double thickness, Complex base, double nm) {
    return 0.5 * (transfer_matrix(cosine, n1, film, thickness, base, nm, false) +
                  transfer_matrix(cosine, n1, film, thickness, base, nm, true));
}

struct FilmQuery {
    float cosine, n, film, thickness, eta, k, nm;
};

// By wavelength, and in colours.
std::vector<glm::vec4> film_reflectances(const std::vector<FilmQuery>& queries) {
    Buffer in = create_buffer(test_device(), queries, "queries"),
           out(test_device(), queries.size() * 16, "reflectances");
    const Kernel kernel = make_test_kernel("probe_thin_film", R"(
        #include "features/thin_film_spectra.glsl"
        layout(local_size_x = 64) in;
        struct Query { float cosine, n, film, thickness, eta, k, nm; };
        layout(scalar, set = 0) readonly buffer Queries { Query queries[]; };
        layout(scalar, set = 0) writeonly buffer Reflectances { vec4 reflectances[]; };
        layout(push_constant) uniform Push { uint count; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= count) return;
            Query q = queries[i];
            reflectances[i] = vec4(
                film_reflectance(q.cosine, q.n, q.film, q.thickness, vec2(q.eta, q.k), q.nm, 0.0),
                thin_film_reflectance(q.cosine, q.n, Spectrum(q.film), q.thickness, Spectrum(q.eta), Spectrum(q.k)));
        }
    )",
                                           {{"Queries", &in}, {"Reflectances", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, uint32_t(queries.size() + 63) / 64, {{"count", uint32_t(queries.size())}});
    list.run();
    return out.read_array<glm::vec4>(queries.size());
}

std::vector<FilmQuery> random_films(uint32_t count, float thickest) {
    std::mt19937 random(5);
    const auto between = [&](double a, double b) {
        return float(std::uniform_real_distribution<double>(a, b)(random));
    };
    std::vector<FilmQuery> queries;
    for (uint32_t i = 0; i < count; ++i) {
        FilmQuery q{between(0.02, 1), 1,        between(1, 2.5),  between(0, thickest),
                    between(1, 3),    float(0), between(380, 780)};
        if (i % 3 == 1) q.k = between(0, 5);    // a metal
        if (i % 3 == 2) q.n = between(1, 2.5);  // total reflection at the film or below it, and through it
        queries.push_back(q);
    }
    return queries;
}

}  // namespace

TEST_CASE("thin films reflect at each wavelength what a transfer matrix in double precision says") {
    const auto queries = random_films(3000, 2000);
    const auto results = film_reflectances(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const FilmQuery& q = queries[i];
        const double exact = exact_film(q.cosine, q.n, q.film, q.thickness, {q.eta, -q.k}, q.nm);
        // Beside critical angles the tangent is vertical.
        const auto distance = [&](double n) {
            return std::abs(n * n - q.n * q.n * (1 - q.cosine * q.cosine));
        };
        const bool critical = std::min(distance(q.film), q.k == 0 ? distance(q.eta) : 1.0) < 1e-3;
        INFO("cos ", q.cosine, ", from ", q.n, ", film ", q.film, ", ", q.thickness, " nm, on ", q.eta,
             " - i ", q.k, ", at ", q.nm, " nm");
        CHECK(std::abs(results[i].x - exact) < (critical ? 5e-3 : 1e-4));
    }
}

TEST_CASE("thin films have in colours the mean reflectance of the channels under D65") {
    const auto queries = random_films(900, 800);
    const auto results = film_reflectances(queries);
    double sum = 0, worst = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const FilmQuery& q = queries[i];
        const SpectralTable exact = tabulate([&](double nm) {
            return exact_film(q.cosine, q.n, q.film, q.thickness, {q.eta, -q.k}, nm);
        });
        const glm::dvec3 expected = glm::clamp(rgb_of_factor(exact), 0.0, 1.0);
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(results[i][1 + c] - expected[c]);
            sum += error, worst = std::max(worst, error);
        }
    }
    MESSAGE("mean error ", sum / (3 * double(queries.size())), ", worst ", worst);
    CHECK(sum / (3 * double(queries.size())) < 0.004);
    CHECK(worst < 0.06);
}

TEST_CASE("a film of no thickness is not there, and one of many micrometres shows no fringes in colours") {
    ShaderSources sources;
    sources.folder = source_path("shaders");
    ClassRegistry registry(sources);
    SurfaceProbe films(
        registry, "thin_film",
        {{{"thickness", 0}, {"alpha", 0.3}}, {{"thickness", 0}, {"alpha", 0.3}, {"eta", 1.5}, {"k", 2.5}}});
    SurfaceProbe glass(registry, "dielectric", {{{"alpha", 0.3}}});
    SurfaceProbe metal(registry, "conductor", {{{"alpha", 0.3}, {"eta", 1.5}, {"k", 2.5}}});
    std::vector<DirectionPair> pairs;
    for (double z : {-0.9, -0.5, 0.2, 0.6, 0.95})
        for (double azimuth : {0.5, 3.0})
            for (const glm::vec3 wo : {glm::vec3(0.6f, 0, 0.8f), glm::vec3(0, 0.8f, -0.6f)})
                pairs.push_back({wo,
                                 {std::sqrt(1 - z * z) * std::cos(azimuth),
                                  std::sqrt(1 - z * z) * std::sin(azimuth), z}});
    const SurfaceSurroundings in_air{1, 1.5f};
    const auto film_on_glass = films.evaluate(0, in_air, pairs),
               bare_glass = glass.evaluate(0, in_air, pairs);
    const auto film_on_metal = films.evaluate(1, {}, pairs), bare_metal = metal.evaluate(0, {}, pairs);
    for (size_t i = 0; i < pairs.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            INFO("pair ", i);
            CHECK(film_on_glass[i].f_cos[c] == doctest::Approx(bare_glass[i].f_cos[c]).epsilon(1e-3));
            CHECK(film_on_metal[i].f_cos[c] == doctest::Approx(bare_metal[i].f_cos[c]).epsilon(1e-3));
        }
    // Ever thicker films change fringes at one wavelength, not colours.
    const FilmQuery thick{0.7f, 1, 1.8f, 20000, 1.5f, 2.5f, 550};
    FilmQuery thicker = thick;
    thicker.thickness += 80;  // a quarter of a fringe
    const auto r = film_reflectances({thick, thicker});
    CHECK(std::abs(r[0].x - r[1].x) > 0.05);
    for (int c = 1; c < 4; ++c) CHECK(std::abs(r[0][c] - r[1][c]) < 0.005);
}
