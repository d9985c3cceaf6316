#include "host/bench/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
        const RenderCounters& c = renderer.counters();
        status.passes = renderer.passes();
        status.rays = double(c.rays + c.shadow_rays);
        status.seconds = renderer.seconds() - before;
        show_progress(progress, status);
    }
    progress.last_shown = 0;  // the next render's clock
    return renderer.seconds() - before;
}

// The most complete comes first: what a backward or a forward path alone cannot find, no image of them shows,
// nor does their estimate of the error.
Contestant& most_complete(std::vector<Contestant>& contestants) {
    for (const Algorithm algorithm :
         {Algorithm::bidirectional, Algorithm::backward, Algorithm::automatic, Algorithm::forward})
        for (Contestant& contestant : contestants)
            if (contestant.algorithm == algorithm) return contestant;
    return contestants.front();
}

}  // namespace

std::optional<Reference> render_reference(std::vector<Contestant>& contestants, double seconds, uint32_t seed,
                                          Progress& progress) {
    Contestant& best = most_complete(contestants);
    const char* name = algorithm_name(best.algorithm);
    show_note(progress, fmt::format("reference: {}, about {:.3g} s", name, seconds));
    // The largest power of two that two halves have the time for, by the speed of a short render.
    uint64_t passes = 1;
    double took = 0;
    do {
        const auto trial = render(*best.renderer, seed + reference_seeds, passes, progress);
        if (!trial) return std::nullopt;
        took = *trial;
        if (took < 0.02 * seconds) passes *= 2;
    } while (took < 0.02 * seconds);
    const double room = 0.5 * seconds / (took / double(passes));
    passes = uint64_t(1) << int(std::log2(std::max(1.0, room)));
    Image halves[2];
    double all_seconds = 0;
    for (uint32_t i = 0; i < 2; ++i) {
        const auto half = render(*best.renderer, seed + reference_seeds + 1 + i, passes, progress);
        if (!half) return std::nullopt;
        all_seconds += *half;
        halves[i] = best.renderer->develop();
    }
    Reference reference = average_reference(halves[0], halves[1]);
    reference.origin =
        fmt::format("rendered {} with seeds {} and {}, 2 × {} passes in {:.3g} s", name,
                    seed + reference_seeds + 1, seed + reference_seeds + 2, passes, all_seconds);
    show_note(progress, fmt::format("reference: 2 × {} passes, own relMSE {:.2g}", passes, reference.relmse));
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
        point.rays_backward = counters.rays, point.rays_shadow = counters.shadow_rays;
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
