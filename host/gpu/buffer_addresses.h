// Storage buffers read through their addresses instead of bindings, by a change to a kernel's SPIR-V.
//
// Kernels are written with storage buffer blocks. Mesa's lavapipe compiles a read through a binding into a
// branch a lane and a bounds check a component, some fifty basic blocks for a vec3, and one through an
// address into gathers: kernels that are compiled in a third to a fifteenth of the time and run 1.3 to 2
// times as fast (Mesa 25, LLVM 15). It also lifts the limits on the size and number of bindings.
#pragma once
#include <string>
#include <vector>

#include "host/gpu/shader_compiler.h"

namespace etendue {

struct AddressedShader {
    Spirv spirv;
    uint32_t binding = 0;             // of the storage buffer in set 0 with the addresses, 8 bytes each
    std::vector<std::string> blocks;  // whose addresses it holds, in this order
};

// Blocks that end in an array of run-time size are read and written by address, others stay bound. Nothing
// changes (and `blocks` is empty) where there are none. Reads beyond a buffer's end are no longer caught by
// the driver.
AddressedShader use_addresses(const Spirv& spirv);

}  // namespace etendue
