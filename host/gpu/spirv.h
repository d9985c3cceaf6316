// SPIR-V as a list of instructions, for those who change it.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <spirv/unified1/spirv.hpp>
#include <string>
#include <vector>

#include "host/gpu/shader_compiler.h"

namespace etendue {

// One instruction: its words, the first without the count. Operand positions follow the SPIR-V specification,
// section 3.49 (instructions).
using SpirvWords = std::vector<uint32_t>;

SpirvWords spirv_instruction(spv::Op op, std::initializer_list<uint32_t> operands);

// The text that starts at word `at` of an instruction.
std::string spirv_text(const SpirvWords& words, size_t at);

// A module: its header (word 3 is the bound of its ids), and its instructions.
struct SpirvModule {
    SpirvWords header;
    std::vector<SpirvWords> instructions;

    uint32_t new_id() { return header[3]++; }
    void put(spv::Op op, std::initializer_list<uint32_t> operands) {
        instructions.push_back(spirv_instruction(op, operands));
    }
};

SpirvModule split_spirv(const Spirv& spirv);  // fails where it is none
Spirv join_spirv(const SpirvModule& module);

}  // namespace etendue
