// Storage buffers that a kernel only reads, read as texel buffers, by a change to its SPIR-V.
//
// Kernels are written with storage buffer blocks. Mesa's lavapipe compiles a read of one, through a binding
// or an address, into gathers with a mask, one a word; on processors without AVX-512 LLVM takes each of them
// apart into a branch a lane. A fetch from a texel buffer is a call of a function that brings four words to
// all lanes. Measured for reads of 64 bytes (Mesa 25.0.7, LLVM 15, GALLIUM_OVERRIDE_CPU_CAPS=avx against
// none): compiled in a fifth of the time and run five times as fast; with AVX-512 alike.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "host/gpu/shader_compiler.h"

namespace etendue {

struct TexelShader {
    struct View {
        std::string block;  // the whole name of the block (BlockLayout::block_name)
        uint32_t binding;   // of the uniform texel buffer, in set 0
        uint32_t words;     // of a texel of unsigned integers: 1, 2 or 4
    };
    Spirv spirv;
    std::vector<View> views;  // a block may have several
};

// Blocks that end in an array of run-time size and that nothing is written to become texel buffers, up to
// `most_views`. All others stay what they are, and so do those of the buffers `not_texels`
// (BlockLayout::name). Reads beyond a buffer's end give zero.
TexelShader use_texels(const Spirv& spirv, const std::set<std::string>& not_texels, uint32_t most_views);

}  // namespace etendue
