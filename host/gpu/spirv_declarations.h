// What a SPIR-V module declares, by id: types, constants, variables, names, decorations.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "host/gpu/spirv.h"

namespace etendue {

struct SpirvType {
    spv::Op op = spv::OpNop;
    SpirvWords operands;  // behind the result id
};

struct SpirvDeclarations {
    struct Variable {
        uint32_t id, type;  // the type is what it points to
        spv::StorageClass storage;
    };
    std::map<uint32_t, SpirvType> types;
    std::map<uint32_t, uint32_t> constants;  // numbers of up to 32 bits
    std::vector<Variable> variables;         // but those of functions, in their order
    std::map<uint32_t, std::string> names;
    std::map<std::pair<uint32_t, uint32_t>, std::string> member_names;  // by struct and member
    // The first literal, 0 where there is none; of members by struct and member.
    std::map<std::pair<uint32_t, spv::Decoration>, uint32_t> decorations;
    std::map<std::tuple<uint32_t, uint32_t, spv::Decoration>, uint32_t> member_decorations;

    // Nothing where there is no such decoration.
    std::optional<uint32_t> decoration(uint32_t id, spv::Decoration kind) const;
    std::optional<uint32_t> member_decoration(uint32_t id, uint32_t member, spv::Decoration kind) const;

    uint32_t find_type(spv::Op op, const SpirvWords& operands) const;  // 0 where it is not declared
    uint32_t free_binding() const;  // beyond all that are taken, in any set
};

SpirvDeclarations read_declarations(const SpirvModule& module);

// A variable that is a storage buffer block.
struct StorageBlock {
    uint32_t variable, type;  // the type is its struct
    uint32_t binding;
    uint32_t array;    // the type of its last member where that is of run-time size, else 0
    std::string name;  // of the struct

    // A block called "Table__part" is one of several views of the buffer "Table".
    std::string buffer() const { return name.substr(0, name.find("__")); }
};

// In the order of the variables.
std::vector<StorageBlock> find_storage_blocks(const SpirvDeclarations& declared);

}  // namespace etendue
