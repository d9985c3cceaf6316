// Which parts of lines lie behind what the picture shows.
#pragma once
#include <vector>

#include "host/preview/camera_control.h"

namespace etendue {

// What the pixels of a picture see first.
struct DepthPicture {
    uint32_t width = 0, height = 0;   // of `depth`; rows from the top
    const std::vector<float>& depth;  // m along the ray; 0 = nothing is there
};

struct LinePart {
    glm::dvec2 from{0}, to{0};  // as SeenLine::at
    bool hidden = false;
};

// The line from its first end to the second, parted where it goes behind a surface or comes out. What is near
// to a surface, or behind only some of the pixels around, counts as seen. `step`: how finely, heights of the
// view, > 0.
std::vector<LinePart> part_by_depth(const SeenLine& line, const CameraLens& lens, double aspect_ratio,
                                    const DepthPicture& picture, double step);

}  // namespace etendue
