// Measures the algorithms of one scene: a reference, then renders of growing length, in turn.
#pragma once
#include <functional>
#include <memory>

#include "host/bench/results.h"
#include "host/options.h"
#include "host/progress.h"
#include "host/render/renderer.h"

namespace etendue {

struct Contestant {
    Algorithm algorithm;
    std::unique_ptr<Renderer> renderer;
    Image image;           // of the longest render
    uint64_t longest = 0;  // its passes
    uint32_t renders = 0;
    double seconds = 0;  // of rendering, of all renders
};

// Renders a reference in about `seconds`, with seeds of its own: the mean of two independent halves.
// Bidirectional where that is among the contestants, unless backward paths show the same with less noise.
// nullopt where it was interrupted.
std::optional<Reference> render_reference(std::vector<Contestant>& contestants, double seconds, uint32_t seed,
                                          Progress& progress);

// Gives every contestant `seconds` of rendering, in rounds. A round of a contestant renders 1, 2, 4, …
// passes, each afresh with another seed; the first takes up to three quarters of its time, so that others
// follow with the rest of it. `found` gets every point as it is made, without the scene's name. Ends early
// where interrupted.
void measure_contestants(std::vector<Contestant>& contestants, const Reference& reference, double seconds,
                         uint32_t seed, Progress& progress, const std::function<void(BenchPoint)>& found);

}  // namespace etendue
