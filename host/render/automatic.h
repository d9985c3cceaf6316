// --algorithm auto: what a scene is rendered with, and why.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "host/render/renderer.h"

namespace etendue {

// Backward rays alone where no surface scatters into narrow lobes, nor a medium the light of points or narrow
// beams, or no light is compact: then they find all light. Both ways where a light has rays that only forward
// ones bring. Elsewhere a pilot renders a small image both ways.
// Backward rays are trusted only where both images agree (they may have missed a caustic altogether); then
// the smaller error at equal time wins. For bidirectional rendering the pilot also measures how the variance
// of a pixel depends on the number of forward paths, a sum of one term for each direction (Ershov & Voloboy
// 2021), and chooses the number with the least error at equal time.
//
// The choice depends on measured times, by powers of two in the number of paths and never in what the image
// converges to. `interrupt` is asked between passes of the pilot; once it says true the choice means nothing.
AlgorithmChoice choose_algorithm(Device& device, Scene& scene, const RenderSettings& settings,
                                 const std::function<bool()>& interrupt = {});
// Whether a render of so many backward paths, one a pixel and pass, is large enough for a pilot: the pilot's
// paths are at most a tenth of them.
bool deserves_pilot(double backward_paths);
// The choice where it takes no pilot: for several receivers, and for those far away, there is none.
std::optional<AlgorithmChoice> choose_without_pilot(Device& device, Scene& scene,
                                                    const std::vector<FilmView>& views);
// Both ways for want of a pilot, with so many forward paths that the device is busy.
AlgorithmChoice choose_both_ways(const std::vector<FilmView>& views, std::string reason);
// A warning where the algorithm leaves out light that only forward rays bring; else empty.
std::string missed_light(const Scene& scene, Algorithm algorithm);

}  // namespace etendue
