// The error that a film states, against its true difference from a long run, over many seeds.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/gltf/gltf.h"
#include "tests/support/render_probe.h"

using namespace etendue;

namespace {

constexpr uint32_t size = 32;
constexpr uint32_t long_seed = 100000;  // of the long runs

struct Layers {
    std::vector<float> values, errors;  // plane after plane: red, green, blue
};

Layers layers(const Renderer& renderer) {
    const Image image = renderer.develop();
    Layers result;
    for (const char* channel : {"R", "G", "B"}) {
        const auto values = plane(image, size_t(find_channel(image, channel))),
                   errors = plane(image, size_t(find_channel(image, std::string("error.") + channel)));
        result.values.insert(result.values.end(), values.begin(), values.end());
        result.errors.insert(result.errors.end(), errors.begin(), errors.end());
    }
    return result;
}

// A scene, its renderer, and a long run of it.
class Subject {
  public:
    Subject(const SceneDescription& description, uint32_t truth_passes)
        : scene_(compile_test_scene(description)), renderer(test_device(), scene_, settings(scene_)) {
        pass(truth_passes);
        truth = layers(renderer);
        for (int c = 0; c < 3; ++c)
            for (size_t i = 0; i < size * size; ++i)
                means[c] += double(truth.values[size_t(c) * size * size + i]) / (size * size);
    }
    void pass(uint64_t total) {
        while (renderer.passes() < total)
            renderer.render_passes(uint32_t(std::min<uint64_t>(total - renderer.passes(), 256)));
    }
    double true_relmse(const Layers& l) const {
        double sum = 0;
        for (size_t i = 0; i < l.values.size(); ++i) {
            const double mean = means[i / (size * size)], t = truth.values[i], d = l.values[i] - t;
            sum += d * d / (t * t + 0.01 * mean * mean) / double(l.values.size());
        }
        return sum;
    }

  private:
    static RenderSettings settings(const Scene& scene) {
        RenderSettings s;
        s.width = s.height = size;
        s.receiver = scene.receivers.front().ref;
        s.seed = long_seed;
        return s;
    }
    Scene scene_;

  public:
    Renderer renderer;
    Layers truth;
    double means[3] = {};
};

struct Honesty {
    double rms_z = 0, within_one = 0, within_two = 0;  // of the values that vary at all
    double rms_most = 0;  // of z without its largest thousandth: pixels whose light no sample has met
    double estimate = 0;  // root of estimated by true relMSE
    double covered = 0;   // images whose true relMSE lies below its bound
};

Honesty measure(Subject& subject, const std::string& name, uint32_t passes, uint32_t seeds) {
    Honesty h;
    double estimated = 0, actual = 0;
    std::vector<double> squares;
    for (uint32_t seed = 1; seed <= seeds; ++seed) {
        subject.renderer.restart(seed);
        subject.pass(passes);
        const Layers l = layers(subject.renderer);
        for (size_t i = 0; i < l.values.size(); ++i) {
            const double t = subject.truth.values[i], d = l.values[i] - t;
            const double error = std::hypot(l.errors[i], subject.truth.errors[i]);
            // What is seen directly and does not vary is the same in every run.
            if (std::fabs(d) <= 1e-6 * t && error <= 1e-6 * t) continue;
            const double z = d / error;
            squares.push_back(z * z);
            h.within_one += std::fabs(z) <= 1, h.within_two += std::fabs(z) <= 2;
        }
        const double relmse = subject.true_relmse(l);
        const RelativeError error = subject.renderer.relative_error();
        estimated += error.mean_square, actual += relmse;
        h.covered += std::sqrt(relmse) <= error.bound() ? 1.0 / seeds : 0.0;
    }
    const double count = double(squares.size());
    std::sort(squares.begin(), squares.end());
    for (size_t i = 0; i < squares.size(); ++i) {
        h.rms_z += squares[i] / count;
        if (i < squares.size() - squares.size() / 1000) h.rms_most += squares[i] / (0.999 * count);
    }
    h.rms_z = std::sqrt(h.rms_z), h.rms_most = std::sqrt(h.rms_most);
    h.within_one /= count, h.within_two /= count;
    h.estimate = std::sqrt(estimated / actual);
    MESSAGE(
        fmt::format("{}, {} passes, {} seeds: rms z {:.3f}, without the largest 0.1 % {:.3f}, within 1 error "
                    "{:.3f}, within 2 {:.3f}; relative error "
                    "{:.4f}, estimated {:.3f} times that, below the bound {:.3f}",
                    name, passes, seeds, h.rms_z, h.rms_most, h.within_one, h.within_two,
                    std::sqrt(actual / seeds), h.estimate, h.covered));
    return h;
}

// A caustic of a glass sphere on a diffuse floor, which backward rays find by chance only.
SceneDescription caustic() {
    SceneBuilder scene;
    scene.medium("glass", {{"ior", 1.5}});
    scene.rectangle(4, 4, scene.lambertian(0.7),
                    Place{{0, 0, 0}, {-0.70710678118654752, 0, 0, 0.70710678118654752}});
    scene.sphere(0.5, scene.material({{"surface", {{"class", "dielectric"}}}, {"inside", "glass"}}),
                 at(0, 0.6, 0));
    scene.sphere(0.4, scene.black_emitter({30, 25, 20}), at(0.6, 3, 0.2));
    scene.perspective(0.8, Place{{0, 2.2, 2.2}, {-0.38268343236509, 0, 0, 0.92387953251129}});
    return scene.import();
}

std::optional<SceneDescription> reference_scene(const std::string& name) {
    const auto file = shared_file("reference/" + name + "/scene.gltf");
    if (!file) return std::nullopt;
    return import_gltf(*file);
}

struct Tolerance {
    double rms_low, rms_high, within_one, within_two;  // of the fractions: the least
};

void check(const Honesty& h, const Tolerance& t, double least_covered) {
    CHECK(h.rms_z > t.rms_low);
    CHECK(h.rms_z < t.rms_high);
    CHECK(h.within_one > t.within_one);
    CHECK(h.within_two > t.within_two);
    CHECK(h.covered >= least_covered);
}

// In how many of `seeds` runs stopping for an error of `goal` leaves no more than that.
double stops_rightly(Subject& subject, double goal, uint32_t seeds) {
    double right = 0, passes = 0;
    for (uint32_t seed = 1; seed <= seeds; ++seed) {
        subject.renderer.restart(seed);
        ErrorGoal stop{goal};
        for (bool done = false; !done;) {
            subject.renderer.render_passes(4);
            if (stop.is_due(subject.renderer.passes()))
                done = stop.look(subject.renderer.passes(), subject.renderer.relative_error());
        }
        passes += double(subject.renderer.passes()) / seeds;
        right += std::sqrt(subject.true_relmse(layers(subject.renderer))) <= goal ? 1.0 / seeds : 0.0;
    }
    MESSAGE(fmt::format("stopping at {}: after {:.0f} passes on average, rightly in {:.3f} of the runs", goal,
                        passes, right));
    return right;
}

}  // namespace

TEST_CASE("the error layer of the Cornell box is honest, and so is stopping for an error") {
    const auto scene = reference_scene("cornell_rgb");
    if (!scene) return;
    Subject subject(*scene, 4096);
    check(measure(subject, "cornell", 64, 8), {0.9, 1.15, 0.63, 0.92}, 0.6);
    // 95 % of 16 runs, less three standard deviations.
    CHECK(stops_rightly(subject, 0.15, 16) >= 0.78);
}

TEST_SUITE("long") {
    // Fractions of a normal distribution: 0.683 and 0.954. What is left over is the uncertainty of the error
    // itself (the factor comes from a few dozen pixels) and the pixels unlike their neighbours: silhouettes
    // and small highlights, which are a large part of so small an image.
    TEST_CASE("the error layer is honest over 64 seeds: the Cornell box") {
        const auto scene = reference_scene("cornell_rgb");
        if (!scene) return;
        Subject subject(*scene, 65536);
        check(measure(subject, "cornell", 4, 64), {0.9, 1.3, 0.63, 0.92}, 0.85);
        for (const uint32_t passes : {16u, 64u, 256u})
            check(measure(subject, "cornell", passes, 64), {0.95, 1.07, 0.65, 0.93}, 0.85);
        for (const double goal : {0.15, 0.08}) CHECK(stops_rightly(subject, goal, 64) >= 0.87);
    }
    TEST_CASE("the error layer is honest over 64 seeds: glossy plates") {
        const auto scene = reference_scene("veach_mis");
        if (!scene) return;
        Subject subject(*scene, 65536);
        // Lights smaller than a pixel, missed by all of 16 samples, are in the largest thousandth: 1.4 with
        // them.
        const Honesty few = measure(subject, "plates", 16, 64);
        check(few, {0.9, 1.9, 0.65, 0.93}, 0.85);
        CHECK(few.rms_most < 1.1);
        check(measure(subject, "plates", 64, 64), {0.9, 1.25, 0.65, 0.93}, 0.85);
        check(measure(subject, "plates", 256, 64), {0.9, 1.1, 0.65, 0.93}, 0.85);
        CHECK(stops_rightly(subject, 0.1, 64) >= 0.87);
    }
    TEST_CASE("the error layer is honest over 64 seeds: spheres in a furnace") {
        const auto scene = reference_scene("furnace");
        if (!scene) return;
        Subject subject(*scene, 65536);
        // Silhouettes are half of what varies here.
        for (const uint32_t passes : {64u, 256u})
            check(measure(subject, "furnace", passes, 64), {0.9, 2.3, 0.6, 0.87}, 0.85);
        CHECK(stops_rightly(subject, 0.02, 64) >= 0.87);
    }
    TEST_CASE("the error layer is honest over many seeds: a caustic, brought by merging") {
        Subject subject(caustic(), 16384);
        REQUIRE(subject.renderer.choice().algorithm == Algorithm::bidirectional);
        for (const uint32_t passes : {64u, 256u})
            check(measure(subject, "caustic", passes, 64), {0.9, 1.1, 0.65, 0.93}, 0.85);
        check(measure(subject, "caustic", 1024, 32), {0.9, 1.1, 0.65, 0.93}, 0.85);
    }
}
