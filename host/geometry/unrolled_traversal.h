// Scenes of few primitives: find_hit and find_occlusion as straight code with the primitives as constants.
//
// Up to about 64 tests cost less than a walk through a hierarchy: nothing is fetched, nothing diverges. Pairs
// of coplanar triangles become parallelograms; directions that several faces share (boxes) are projected on
// once.
#pragma once
#include <string>

#include "host/scene/description.h"
#include "host/geometry/world.h"

namespace etendue {

struct UnrolledTraversal {
    std::string glsl;  // of "generated/unrolled_traversal.glsl"; empty: this world keeps to its hierarchy
    uint32_t primitives = 0;  // unrolled
    uint32_t tests = 0;       // after merging
};

// Worlds of more than `max_tests` tests, with instances, with shapes other than spheres, disks and
// rectangles, or with spheres and disks that are not placed by similarities, are left to the hierarchy. What
// the code has to look up of the primitive it has hit is appended to world.nodes.
UnrolledTraversal unroll_traversal(World& world, const SceneDescription& scene, uint32_t max_tests = 64);

}  // namespace etendue
