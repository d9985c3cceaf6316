#include "host/bench/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/image/compare.h"
#include "host/interrupt.h"

namespace etendue {
namespace {

constexpr double batch_seconds = 0.25;  // of work between two looks at the interrupt
constexpr double first_round = 0.75;    // of the time
constexpr double worth_a_round = 0.9;   // of the time used up: what is left makes short renders only
constexpr uint32_t most_rounds = 8;
constexpr uint32_t reference_seeds = 1u << 31;  // added to the seed; those of the points stay below

// Renders `passes` passes afresh; the seconds that took. nullopt where it was interrupted.
std::optional<double> render(Renderer& renderer, uint32_t seed, uint64_t passes, Progress& progress) {
    renderer.restart(seed);
    const double before = renderer.seconds();
    RenderStatus status;
    status.passes_goal = passes;
    while (renderer.passes() < passes) {
        if (interrupted()) return std::nullopt;
        const uint64_t left = passes - renderer.passes();
        renderer.render_passes(uint32_t(std::min<uint64_t>(renderer.passes_in(batch_seconds), left)));
        status.passes = renderer.passes();
        status.rays = double(all_rays(renderer.counters()));
        status.seconds = renderer.seconds() - before;
        show_progress(progress, status);
    }
    progress.last_shown = 0;  // the next render's clock
    return renderer.seconds() - before;
}

struct Trial {
    Image image;
    uint64_t passes = 1;
    double seconds = 0;
    double cost() const { return std::pow(estimated_relative_error(image), 2) * seconds; }
};

// A render that takes at least `seconds`, with numbers of passes tried from 1. nullopt where interrupted.
std::optional<Trial> try_out(Renderer& renderer, double seconds, uint32_t seed, Progress& progress) {
    Trial trial;
    for (;; trial.passes *= 2) {
        const auto took = render(renderer, seed, trial.passes, progress);
        if (!took) return std::nullopt;
        trial.seconds = *took;
        if (*took >= seconds && trial.passes >= 4) break;
    }
    trial.image = renderer.develop();
    trial.image.attributes["passes"] = double(trial.passes);
    return trial;
}

Contestant* find(std::vector<Contestant>& contestants, Algorithm algorithm) {
    for (Contestant& contestant : contestants)
        if (contestant.algorithm == algorithm) return &contestant;
    return nullptr;
}

}  // namespace

std::optional<Reference> render_reference(std::vector<Contestant>& contestants, double seconds, uint32_t seed,
                                          Progress& progress) {
    // What backward or forward paths alone cannot find shows neither in their images nor in their estimates
    // of the error: bidirectional ones come first, and give way to backward ones only where these show the
    // same with less noise.
    const double trial_seconds = 0.05 * seconds;
    Contestant* chosen = find(contestants, Algorithm::bidirectional);
    Contestant* backward = find(contestants, Algorithm::backward);
    for (const Algorithm algorithm : {Algorithm::backward, Algorithm::automatic, Algorithm::forward})
        if (!chosen) chosen = find(contestants, algorithm);
    show_note(progress, fmt::format("reference: about {:.3g} s", seconds));
    auto trial = try_out(*chosen->renderer, trial_seconds, seed + reference_seeds, progress);
    if (trial && backward && chosen->algorithm == Algorithm::bidirectional) {
        auto other = try_out(*backward->renderer, trial_seconds, seed + reference_seeds + 3, progress);
        if (!other) return std::nullopt;
        const auto test = compare_images(other->image, trial->image).tile_test;
        if (test && test->passes && other->cost() < trial->cost())
            chosen = backward, trial = std::move(other);
    }
    if (!trial) return std::nullopt;
    const char* name = algorithm_name(chosen->algorithm);
    // The largest power of two that two halves have the time for.
    const double room = 0.5 * seconds / (trial->seconds / double(trial->passes));
    const uint64_t passes = uint64_t(1) << int(std::log2(std::max(1.0, room)));
    Image halves[2];
    double all_seconds = 0;
    for (uint32_t i = 0; i < 2; ++i) {
        const auto half = render(*chosen->renderer, seed + reference_seeds + 1 + i, passes, progress);
        if (!half) return std::nullopt;
        all_seconds += *half;
        halves[i] = chosen->renderer->develop();
    }
    Reference reference = average_reference(halves[0], halves[1]);
    reference.origin =
        fmt::format("rendered {} with seeds {} and {}, 2 × {} passes in {:.3g} s", name,
                    seed + reference_seeds + 1, seed + reference_seeds + 2, passes, all_seconds);
    show_note(progress,
              fmt::format("reference: {}, 2 × {} passes, own relMSE {:.2g}", name, passes, reference.relmse));
    return reference;
}

void measure_contestants(std::vector<Contestant>& contestants, const Reference& reference, double seconds,
                         uint32_t seed, Progress& progress, const std::function<void(BenchPoint)>& found) {
    const auto measure = [&](Contestant& c, uint64_t passes) {
        BenchPoint point;
        point.algorithm = algorithm_name(c.algorithm);
        point.seed = (seed + c.renders) % reference_seeds;
        point.passes = passes;
        const auto took = render(*c.renderer, uint32_t(point.seed), passes, progress);
        if (!took) return false;
        ++c.renders;
        c.seconds += *took;
        point.seconds = *took;
        const RenderCounters& counters = c.renderer->counters();
        point.rays_backward = counters.rays, point.rays_forward = counters.forward_rays;
        point.rays_shadow = counters.shadow_rays + counters.forward_shadow_rays;
        Image image = c.renderer->develop();
        compare_with_reference(image, reference, point);
        if (passes > c.longest) c.image = std::move(image), c.longest = passes;
        show_note(progress,
                  fmt::format("{}: {} {}, {:.3g} s, relMSE {:.3g}, bias {:+.2f} %", point.algorithm, passes,
                              passes == 1 ? "pass" : "passes", *took, point.relmse, 100 * point.bias));
        found(std::move(point));
        return true;
    };
    for (uint32_t round = 0; round < most_rounds; ++round)
        for (Contestant& c : contestants) {
            if (round > 0 && c.seconds > worth_a_round * seconds) continue;
            const double limit = round == 0 ? first_round * seconds : seconds;
            double next = 0;  // what the next render will take: as long as the last, twice
            for (uint64_t passes = 1; passes <= (uint64_t(1) << 31); passes *= 2) {
                const bool least = round == 0 && passes == 1;  // one point at least
                if (!least && c.seconds + next > limit) break;
                const double before = c.seconds;
                if (interrupted() || !measure(c, passes)) return;
                next = 2 * (c.seconds - before);
            }
        }
}

}  // namespace etendue
