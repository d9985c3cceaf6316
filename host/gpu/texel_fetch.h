// The instructions that fetch from a texel buffer what a kernel loads from a storage block (texel_reads.h).
#pragma once
#include <map>
#include <vector>

#include "host/gpu/spirv_declarations.h"

namespace etendue {

// What a pointer into a storage block points to; it starts at the sum of index * stride and known bytes.
struct BlockPlace {
    uint32_t variable = 0;       // the block
    uint32_t type = 0;           // of what stands there
    uint32_t bytes = 0;          // known ones
    uint32_t matrix_stride = 0;  // of the matrices there, where they are any
    struct Index {
        uint32_t id, stride;  // bytes
    };
    std::vector<Index> indices;

    // To a member, element, column or component of what stands there; `index` is the id of its number.
    void step(const SpirvDeclarations& declared, uint32_t index);
};

// Words of a texel that every index steps over whole ones of: 1, 2 or 4.
uint32_t texel_words(const BlockPlace& place);

class TexelFetches {
  public:
    // Of a module that is being written to `out`, and declares at least what is `declared`.
    TexelFetches(const SpirvDeclarations& declared, SpirvModule& out) : declared_(declared), out_(out) {}

    // Texel buffers of unsigned integers, by these variables. Once, behind all other declarations.
    void declare(const std::vector<uint32_t>& variables);

    // What stands at `place`, from the texel buffer `variable`, under the id `result`.
    void load(const BlockPlace& place, uint32_t variable, uint32_t result);

    // Numbers that the loads turned out to need, behind what `declare` has declared. Once, after all loads.
    void declare_constants();

  private:
    class Load;

    uint32_t constant(uint32_t value);

    const SpirvDeclarations& declared_;
    SpirvModule& out_;
    uint32_t uint_ = 0, uvec4_ = 0, image_ = 0;  // types
    size_t constants_at_ = 0;                    // in the instructions
    std::map<uint32_t, uint32_t> constants_;     // by value
};

}  // namespace etendue
