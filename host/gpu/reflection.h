// What a compiled shader says of itself: bindings, push constants, workgroup size, and the layout of records.
// Read from SPIR-V, so that C++ repeats none of it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "host/gpu/shader_compiler.h"

namespace etendue {

// A member of a buffer's struct. `type` is the GLSL spelling: float, uint, int, vec3, mat4x3, or a struct's
// name.
struct MemberLayout {
    std::string name, type;
    uint32_t offset = 0, size = 0;      // bytes
    std::vector<MemberLayout> members;  // of a struct; offsets relative to the struct
};

// A storage buffer block. A block called "Table__part" is one of several views of the buffer "Table".
struct BlockLayout {
    std::string name;        // of the buffer: the block's name up to "__"
    std::string block_name;  // whole
    uint32_t binding = 0;
    std::string element_type;  // of the last, run-time sized array, if there is one
    uint32_t stride = 0;       // of that array, bytes
    std::vector<MemberLayout> element_members;
};

struct ShaderLayout {
    std::vector<BlockLayout> blocks;
    std::vector<MemberLayout> push_constants;
    uint32_t push_constant_size = 0;
    std::array<uint32_t, 3> local_size{1, 1, 1};
    // Of the run-time sized array that the block of this buffer ends with. Fails where there is none.
    uint32_t element_bytes(const std::string& buffer) const;
};

ShaderLayout reflect_shader(const Spirv& spirv);

}  // namespace etendue
