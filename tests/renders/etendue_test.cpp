// Étendue, the volume in phase space (x, y, n kx, n ky) that light takes up: lossless optics keep it, and
// bodies that mix what enters them fill all of theirs.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "host/measure/measurement.h"
#include "host/measure/ray_export.h"
#include "tests/support/render_probe.h"
#include "tests/support/statistics.h"

using namespace etendue;

namespace {

constexpr double pi = std::numbers::pi;

// ---- Rays written down, of a Lambert disk whose luminance is 1: a ray stands for as much étendue, m² sr, as
// it carries lumens.

constexpr double disk_radius = 1e-3, disk_etendue = pi * pi * disk_radius * disk_radius;

void add_disk(SceneBuilder& s, double z) {
    s.shape({{"class", "disk"}, {"radius", disk_radius}}, s.black_emitter(1), at(0, 0, z));
}

// What `recorder`, a receiver of the class `rays`, sees come along +z.
std::vector<SourceRay> record(SceneBuilder& s, nlohmann::json recorder, double z) {
    constexpr double rays = 1 << 19;
    recorder["class"] = "rays";
    s.placed("receiver", recorder, {{0, 0, z}, {1, 0, 0, 0}});
    Scene scene = compile_test_scene(s.import());
    RenderSettings settings;
    settings.algorithm = Algorithm::forward, settings.forward_paths = rays / 16;
    MeasurementRun run(test_device(), scene, {&scene.receivers.front()}, settings);
    REQUIRE(run.add({0, 16}, [] { return false; }));
    CHECK(run.measurement().meters.front().rays.is_whole());
    const auto file = recorded_rays(run.measurement().meters.front());
    REQUIRE(file.has_value());
    return file->rays;
}

double flux_of(const std::vector<SourceRay>& rays) {
    double sum = 0;
    for (const SourceRay& ray : rays) sum += ray.flux;
    return sum;
}

// Light that fills a disk in position (`radius`, m) and for each of its points one in direction (`sine`; both
// times n where there is glass), must have the luminance 1 in every cell within: so it fills the volume that
// its flux tells. Cells are tenths of both diameters along each of the four axes; those that reach beyond
// nine tenths of a disk are left out.
class PhaseSpace {
  public:
    PhaseSpace(double radius, double sine) : radius_(radius), sine_(sine) {}

    void add(const SourceRay& ray, double n, double weight) {
        const double at[] = {1e-3 * ray.position.x / radius_, 1e-3 * ray.position.y / radius_,
                             n * ray.direction.x / sine_, n * ray.direction.y / sine_};
        size_t place = 0;
        for (const double v : at) {
            const double cell = std::floor((v + 1) / 2 * cells);
            if (!(cell >= 0 && cell < cells)) return;
            place = place * cells + size_t(cell);
        }
        ++counts_[place], flux_[place] += weight * ray.flux;
    }

    void check() const {
        const double volume = std::pow(4 * radius_ * sine_ / (cells * cells), 2);
        std::vector<double> counts, expected;
        double rays = 0, flux = 0, inner = 0;
        for (size_t i = 0; i < counts_.size(); ++i) {
            if (!is_inner(i / (cells * cells)) || !is_inner(i % (cells * cells))) continue;
            rays += counts_[i], flux += flux_[i], inner += volume;
            counts.push_back(counts_[i]);
        }
        const double luminance = flux / inner, error = luminance / std::sqrt(rays);
        // As many rays in every cell, if each carries the same.
        expected.assign(counts.size(), rays / double(counts.size()));
        const ChiSquared even = chi_squared_test(counts, expected);
        MESSAGE(counts.size(), " cells, ", rays, " rays: luminance ", luminance, " +- ", error, ", p ",
                even.p_value);
        CHECK(std::abs(luminance - 1) < 3 * error);
        CHECK(error < 0.003);
        CHECK(even.p_value > 1e-4);
    }

  private:
    static constexpr int cells = 10;
    static bool is_inner(size_t i) {
        const auto farthest = [](size_t k) {
            return std::abs(double(k) + (k < cells / 2 ? 0 : 1) - cells / 2);
        };
        return std::hypot(farthest(i / cells), farthest(i % cells)) < 0.9 * cells / 2;
    }
    double radius_, sine_;
    std::vector<double> counts_ = std::vector<double>(cells * cells * cells * cells), flux_ = counts_;
};

}  // namespace

TEST_CASE("a Lambert disk of 1 mm has an etendue of 9.8696e-6 m² sr, however large what records it is") {
    CHECK(1e6 * disk_etendue == doctest::Approx(9.8696).epsilon(1e-5));
    for (const double radius : {2e-3, 0.3, 10.0}) {
        CAPTURE(radius);
        SceneBuilder s;
        add_disk(s, 0);
        CHECK(flux_of(record(s, {{"radius", radius}}, 0)) / disk_etendue == doctest::Approx(1).epsilon(1e-5));
    }
}

// Luneburg's lens has the index 1 at its surface, so that nothing is reflected there. What touches it becomes
// a beam as wide as the lens, and as narrow in angle as the disk is small: area times 10000, solid angle
// through it.
TEST_CASE("a lens keeps the etendue: a disk becomes a beam of the same luminance") {
    constexpr double radius = 0.1;
    SceneBuilder s;
    add_disk(s, -radius - 1e-6);
    const double c = -0.5 / (radius * radius);
    s.medium("lens", {{"class", "gradient_index"},
                      {"ior", std::numbers::sqrt2},
                      {"radial", {c, 0, 0}},
                      {"axial", {0, c, 0}}});
    s.sphere(radius, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "lens"}}), at(0, 0, 0));
    const std::vector<SourceRay> rays = record(s, {{"size", {0.25, 0.25}}}, radius + 1e-3);
    // Of the disk, whose rim is 6 µm off the lens, 1e-4 passes beside it.
    CHECK(flux_of(rays) / disk_etendue == doctest::Approx(1).epsilon(3e-4));
    PhaseSpace behind(radius, disk_radius / radius);
    for (const SourceRay& ray : rays) behind.add(ray, 1, 1);
    behind.check();
}

// Beneath a face of glass directions are narrower, by as much as n² raises the luminance; over n², less what
// Fresnel's equations reflect, it is what it was.
TEST_CASE("in glass light keeps its etendue, which counts n k") {
    constexpr double n = 1.5;
    SceneBuilder s;
    add_disk(s, -1e-6);
    s.medium("glass", {{"ior", n}});
    s.rectangle(0.02, 0.02, s.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                {{0, 0, 0}, {1, 0, 0, 0}});
    const std::vector<SourceRay> rays = record(s, {{"size", {0.02, 0.02}}}, 1e-6);
    double whole = 0;
    PhaseSpace beneath(disk_radius, 1);
    for (const SourceRay& ray : rays) {
        const double inside = -ray.direction.z, outside = std::sqrt(1 - n * n * (1 - inside * inside));
        if (!(outside > 1e-3)) continue;  // where nothing but rounding is
        const double rs = (outside - n * inside) / (outside + n * inside),
                     rp = (n * outside - inside) / (n * outside + inside);
        const double weight = 1 / (1 - (rs * rs + rp * rp) / 2);
        whole += weight * ray.flux;
        beneath.add(ray, n, weight);
    }
    CHECK(whole / disk_etendue == doctest::Approx(1).epsilon(0.003));
    beneath.check();
}

namespace {

// ---- A slab of glass, with dents of air in both faces or smooth, in a box that shines evenly, with
// luminance 1.

constexpr double ior = 1.49, width = 1, thickness = 0.2;

struct Slab {
    SceneBuilder scene;
    double volume = width * width * thickness;  // m³, of the glass
};

Slab slab_in_even_light(bool dented, double absorption) {
    Slab slab;
    SceneBuilder& s = slab.scene;
    s.medium("glass", {{"ior", ior}, {"absorption", absorption}});
    s.medium("air", {{"ior", 1}});
    const auto body = [&](const char* medium, int priority) {
        return s.material(
            {{"surface", {{"class", "dielectric"}}}, {"inside", medium}, {"priority", priority}},
            {{"name", medium}});
    };
    add_box(s, {width, thickness, width}, body("glass", 1), false, at(0, 0, 0));
    constexpr int columns = 6;
    constexpr double pitch = width / columns, radius = 0.45 * pitch;
    const int air = body("air", 2);
    for (const int side : {-1, 1}) {
        const int count = side < 0 ? columns : columns - 1;  // above between those below
        for (int i = 0; dented && i < count * count; ++i) {
            const auto place = [&](int k) { return (k - (count - 1) / 2.0) * pitch; };
            s.sphere(radius, air, at(place(i / count), side * thickness / 2, place(i % count)));
            slab.volume -= 2 * pi / 3 * std::pow(radius, 3);
        }
    }
    // Clear of the balls, so that all of it shines in the same medium.
    add_box(s, {1.02f, 0.36f, 1.02f}, s.black_emitter(1), true, at(0, 0, 0));
    return slab;
}

// A mean path l of what comes to a body takes a part l times the absorption of it: of 1 lm/m² pi times the
// surface, and where the light within is n² on all ways, n² 4 pi times the volume. This: the part of it over
// the absorption, with 2 pi volume for 1. It is the mean path over the thickness of a slab without end.
double relative_path(bool dented, double absorption, uint32_t seed) {
    constexpr double paths = 1 << 17;
    Slab slab = slab_in_even_light(dented, absorption);
    slab.scene.perspective(1, at(0, 0.177, 0));
    Scene scene = compile_test_scene(slab.scene.import());
    RenderSettings settings;
    settings.width = settings.height = 4;
    settings.receiver = scene.receivers.front().ref;
    settings.algorithm = Algorithm::forward, settings.forward_paths = paths / 16;
    settings.seed = seed, settings.ledger = true;
    Renderer renderer(test_device(), scene, settings);
    renderer.render_passes(1);
    const RenderCounters& c = renderer.counters();
    CHECK(c.forward_depth_limit == 0);
    return c.absorbed_by.at("medium glass") / c.emitted * scene.power / (2 * pi * slab.volume * absorption);
}

}  // namespace

// The mean of what an absorption of 1e-3/m takes, less what twice as much takes less: 0.05 % are left,
// squared. Light within the cuboid that is trapped has no way in, unless dents mix it.
TEST_CASE(
    "the mean path through a slab: 2 n² thicknesses with lossless dents, less what a smooth one traps") {
    const double trapped = 3 * std::sqrt(1 - 1 / (ior * ior)) - 2;
    for (const bool dented : {true, false}) {
        const double expected = 2 * ior * ior * (dented ? 1 : 1 - trapped);
        if (dented) CHECK(expected == doctest::Approx(4.4402).epsilon(1e-5));
        Moments paths;
        for (uint32_t seed = 1; seed <= (dented ? 8 : 4); ++seed)
            paths.add(2 * relative_path(dented, 1e-3, seed) - relative_path(dented, 2e-3, seed));
        MESSAGE(paths.mean, " +- ", paths.standard_error(), ", expected ", expected);
        CHECK(std::abs(paths.mean - expected) < 3 * paths.standard_error() + 1e-4 * expected);
        CHECK(paths.standard_error() < 3e-3 * expected);
    }
}

TEST_CASE("within a slab with lossless dents in even light the luminance is n² everywhere") {
    Slab slab = slab_in_even_light(true, 0);
    slab.scene.perspective(2, {{0.1, 0.01, 0.05}, {0.3, 0.5, 0.1, 0.806}});
    RenderPlan plan;
    plan.width = plan.height = 16, plan.passes = 16;
    const Estimates e = render_estimates(slab.scene.import(), plan);
    const WindowMean all = window_mean(e);
    MESSAGE(all.mean, " +- ", all.standard_error);
    CHECK(std::abs(all.mean / (ior * ior) - 1) < 1e-4 + 3 * all.standard_error);
    CHECK(all.standard_error < 1e-3);
    CHECK(e.counters.depth_limit == 0);
}
