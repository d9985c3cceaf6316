#include "host/preview/hidden_lines.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

constexpr double near_surface = 0.005;  // of the depth
constexpr int most_steps = 500;

// The greatest depth of the pixels around; infinite where one of them sees nothing.
double depth_around(const DepthPicture& picture, const glm::dvec2& at, double aspect_ratio) {
    const int x = int(std::floor(at.x / aspect_ratio * picture.width)),
              y = int(std::floor(at.y * picture.height));
    double depth = 0;
    for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) {
            if (u < 0 || v < 0 || u >= int(picture.width) || v >= int(picture.height)) continue;
            const float d = picture.depth[size_t(v) * picture.width + size_t(u)];
            depth = std::max(depth, d > 0 ? double(d) : INFINITY);
        }
    return depth > 0 ? depth : INFINITY;
}

// Of the point that is seen at that share of the line.
glm::dvec3 local_point(const SeenLine& line, const CameraLens& lens, double share) {
    const glm::dvec3 &a = line.local[0], &b = line.local[1];
    if (lens.parallel) return glm::mix(a, b, share);
    const double t = share * a.z / (b.z + share * (a.z - b.z));  // 1/z is linear across the picture
    return glm::mix(a, b, t);
}

}  // namespace

std::vector<LinePart> part_by_depth(const SeenLine& line, const CameraLens& lens, double aspect_ratio,
                                    const DepthPicture& picture, double step) {
    // Only what lies in the picture can be hidden; the rest is not looked at closely.
    double first = 0, last = 1;
    const glm::dvec2 way = line.at[1] - line.at[0], size(aspect_ratio, 1);
    for (int axis = 0; axis < 2; ++axis) {
        if (way[axis] == 0) continue;
        const double a = -line.at[0][axis] / way[axis], b = (size[axis] - line.at[0][axis]) / way[axis];
        first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    }
    const auto at = [&](double share) { return line.at[0] + share * way; };
    std::vector<LinePart> parts;
    const auto add = [&](double from, double to, bool hidden) {
        if (!(to > from)) return;
        if (!parts.empty() && parts.back().hidden == hidden)
            parts.back().to = at(to);
        else
            parts.push_back({at(from), at(to), hidden});
    };
    if (!(last > first)) {
        add(0, 1, false);
        return parts;
    }
    add(0, first, false);
    const int steps = std::clamp(int(std::ceil((last - first) * glm::length(way) / step)), 1, most_steps);
    for (int i = 0; i < steps; ++i) {
        const double from = first + (last - first) * i / steps, to = first + (last - first) * (i + 1) / steps,
                     middle = 0.5 * (from + to);
        const glm::dvec3 p = local_point(line, lens, middle);
        const double distance = lens.parallel ? -p.z : glm::length(p);
        add(from, to, distance * (1 - near_surface) > depth_around(picture, at(middle), aspect_ratio));
    }
    add(last, 1, false);
    return parts;
}

}  // namespace etendue
