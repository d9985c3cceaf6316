// Sheets that are made of two triangles, one for each side: leaves of older files, cards. Both lie at the same place, so a
// ray would meet the one or the other by rounding. The hierarchy holds one of them, and a ray that comes from behind sees
// the other, its twin (shaders/features/twins.glsl).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/geometry/world.h"

namespace etendue {

// Of each primitive: the triangle with the same corners that faces the other way, or no_record. Of two that are twins
// each is the other's. Only of materials that are one-sided and bound no medium.
std::vector<uint32_t> find_twins(std::span<const PrimitiveRecord> primitives,
                                 std::span<const MaterialDescription> materials);

// Turns a twin of `p`, and with it `indices` unless they are null, so that its corners are v0, v2 and v1 of `p`:
// barycentric coordinates change places.
void turn_to(const PrimitiveRecord& p, PrimitiveRecord& twin, glm::uvec3* indices);

}  // namespace etendue
