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

// What a film reflects and lets through of the amplitude, the latter so that its square is the power.
struct FilmAmplitudes {
    Complex r, t;
};

// Product of the matrices of two faces and the way between (Born & Wolf 1.6.2, by amplitudes to and fro), for
// one polarization. Indices n - i k; angles by Snell's law with complex cosines; Verdet's signs.
FilmAmplitudes film_amplitudes(double cosine, double n1, double film, double thickness, Complex base,
                               double nm, bool p) {
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
    const double through = (n[2] * (p ? std::conj(c[2]) : c[2])).real() / (n1 * cosine);
    return {m.c / m.a, std::sqrt(std::max(through, 0.0)) / m.a};
}

double transfer_matrix(double cosine, double n1, double film, double thickness, Complex base, double nm,
                       bool p) {
    return std::norm(film_amplitudes(cosine, n1, film, thickness, base, nm, p).r);
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

namespace {

// film_moments() of what is reflected and what passes, at a wavelength and averaged over a band of phases.
struct Moments {
    glm::vec4 reflected, passed, mean_reflected, mean_passed;
};

std::vector<Moments> moments_of(const std::vector<FilmQuery>& queries, float phase_range) {
    Buffer in = create_buffer(test_device(), queries, "queries"),
           out(test_device(), queries.size() * sizeof(Moments), "moments");
    const Kernel kernel = make_test_kernel("probe_film_moments", R"(
        #include "features/thin_film_spectra.glsl"
        layout(local_size_x = 64) in;
        struct Query { float cosine, n, film, thickness, eta, k, nm; };
        layout(scalar, set = 0) readonly buffer Queries { Query queries[]; };
        layout(scalar, set = 0) writeonly buffer AllMoments { vec4 moments[]; };
        layout(push_constant) uniform Push { uint count; float phase_range; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i >= count) return;
            Query q = queries[i];
            FilmStack stack = film_stack(q.cosine, q.n, q.film, q.thickness, vec2(q.eta, q.k), q.nm);
            for (uint j = 0u; j < 4u; ++j)
                moments[4u * i + j] = film_moments(stack, (j & 1u) == 0u, j < 2u ? 0.0 : phase_range);
        }
    )",
                                           {{"Queries", &in}, {"AllMoments", &out}});
    CommandList list(test_device());
    list.dispatch(kernel, uint32_t(queries.size() + 63) / 64,
                  {{"count", uint32_t(queries.size())}, {"phase_range", phase_range}});
    list.run();
    return out.read_array<Moments>(queries.size());
}

glm::dvec4 exact_moments(const FilmQuery& q, bool reflects, double nm) {
    const Complex base(q.eta, -double(q.k));
    const FilmAmplitudes s = film_amplitudes(q.cosine, q.n, q.film, q.thickness, base, nm, false),
                         p = film_amplitudes(q.cosine, q.n, q.film, q.thickness, base, nm, true);
    const Complex a = reflects ? s.r : s.t, b = reflects ? p.r : p.t, both = b * std::conj(a);
    return {std::norm(a), std::norm(b), both.real(), both.imag()};
}

}  // namespace

TEST_CASE("films polarize as their amplitudes say") {
    // MgF2 on glass and soap: Rs, Rp and by how much p is ahead.
    const float cos45 = std::sqrt(0.5f);
    const std::vector<FilmQuery> known = {{cos45, 1, 1.38f, 550 / (4 * 1.38f), 1.5168f, 0, 550},
                                          {0.5f, 1, 1.38f, 550 / (4 * 1.38f), 1.5168f, 0, 550},
                                          {cos45, 1, 1.33f, 300, 1, 0, 550}};
    const double expected[][3] = {{0.040479143, 0.001393631, 165.481},
                                  {0.101396053, 0.005976358, 17.540},
                                  {0.091779117, 0.004750698, -177.167}};
    const auto found = moments_of(known, 0.05f);
    for (size_t i = 0; i < known.size(); ++i) {
        CAPTURE(i);
        const glm::vec4& m = found[i].reflected;
        CHECK(m.x == doctest::Approx(expected[i][0]).epsilon(1e-5));
        CHECK(m.y == doctest::Approx(expected[i][1]).epsilon(1e-4));
        CHECK(std::atan2(m.w, m.z) * 180 / std::acos(-1.0) == doctest::Approx(expected[i][2]).epsilon(1e-4));
    }
    // Any films against transfer matrices; and of so wide a band that no fringes are left, the mean over a
    // period of them.
    const auto films = random_films(2000, 1500);
    const auto all = moments_of(films, 1e4f);
    double worst = 0, worst_mean = 0;
    size_t passing = 0;
    for (size_t i = 0; i < films.size(); ++i) {
        const FilmQuery& q = films[i];
        const double sine2 = q.n * q.n * (1 - double(q.cosine) * q.cosine), film2 = double(q.film) * q.film;
        if (std::abs(sine2 - film2) < 1e-2 || (q.k == 0 && std::abs(sine2 - q.eta * q.eta) < 1e-2)) continue;
        for (const bool reflects : {true, false}) {
            // Only what is clear lets anything through that can be told apart from what it absorbs.
            if (!reflects && (q.k > 0 || sine2 > std::min(double(q.eta) * q.eta, film2))) continue;
            passing += !reflects;
            const glm::dvec4 found_single = reflects ? all[i].reflected : all[i].passed,
                             found_mean = reflects ? all[i].mean_reflected : all[i].mean_passed;
            worst = std::max(worst, glm::length(found_single - exact_moments(q, reflects, q.nm)));
            if (sine2 > film2) continue;
            glm::dvec4 mean(0);
            constexpr int steps = 400;
            for (int k = 0; k < steps; ++k) {
                FilmQuery other = q;
                other.thickness = float(k * 0.5 * q.nm / std::sqrt(film2 - sine2) / steps);
                mean += exact_moments(other, reflects, q.nm) / double(steps);
            }
            worst_mean = std::max(worst_mean, glm::length(found_mean - mean));
        }
    }
    CAPTURE(passing);
    CHECK(passing > 100);
    CHECK(worst < 1e-3);  // a driver's sines may be off by 2^-11; 8e-6 where they are not
    CHECK(worst_mean < 5e-3);
}
