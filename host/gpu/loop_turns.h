// How long loops may run. Vulkan knows no end of it, but Mesa's lavapipe counted the turns of all loops of a
// kernel together (up to 22.3 at least, no longer in 25.0): a subgroup that has made 65535 leaves every loop,
// the one it is in and all that follow, after one turn. What it had still to do is missing without a word.
#pragma once
#include <cstdint>

namespace etendue {

struct Device;

// Turns that the driver grants a subgroup in one run of a kernel; 0 = as many as it takes. Runs a small
// kernel where the driver is one that may count.
uint32_t find_max_loop_turns(Device& device);

}  // namespace etendue
