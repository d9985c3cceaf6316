#include "host/gpu/spirv_declarations.h"

#include <algorithm>

namespace etendue {
namespace {

template <class Key>
std::optional<uint32_t> find_literal(const std::map<Key, uint32_t>& literals, const Key& key) {
    const auto found = literals.find(key);
    return found == literals.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

std::optional<uint32_t> SpirvDeclarations::decoration(uint32_t id, spv::Decoration kind) const {
    return find_literal(decorations, {id, kind});
}

std::optional<uint32_t> SpirvDeclarations::member_decoration(uint32_t id, uint32_t member,
                                                             spv::Decoration kind) const {
    return find_literal(member_decorations, {id, member, kind});
}

uint32_t SpirvDeclarations::find_type(spv::Op op, const SpirvWords& operands) const {
    const auto found = std::find_if(types.begin(), types.end(), [&](const auto& type) {
        return type.second.op == op && type.second.operands == operands;
    });
    return found == types.end() ? 0 : found->first;
}

uint32_t SpirvDeclarations::free_binding() const {
    uint32_t free = 0;
    for (const auto& [key, literal] : decorations)
        if (key.second == spv::DecorationBinding) free = std::max(free, literal + 1);
    return free;
}

SpirvDeclarations read_declarations(const SpirvModule& module) {
    SpirvDeclarations declared;
    for (const SpirvWords& w : module.instructions) {
        const auto op = spv::Op(w[0]);
        if (op == spv::OpFunction) break;  // all declarations stand before the functions
        if (op >= spv::OpTypeVoid && op <= spv::OpTypeFunction)
            declared.types[w[1]] = {op, {w.begin() + 2, w.end()}};
        else if (op == spv::OpConstant && w.size() == 4)
            declared.constants[w[2]] = w[3];
        else if (op == spv::OpVariable)
            declared.variables.push_back(
                {w[2], declared.types.at(w[1]).operands[1], spv::StorageClass(w[3])});
        else if (op == spv::OpName)
            declared.names[w[1]] = spirv_text(w, 2);
        else if (op == spv::OpMemberName)
            declared.member_names[{w[1], w[2]}] = spirv_text(w, 3);
        else if (op == spv::OpDecorate)
            declared.decorations[{w[1], spv::Decoration(w[2])}] = w.size() > 3 ? w[3] : 0;
        else if (op == spv::OpMemberDecorate)
            declared.member_decorations[{w[1], w[2], spv::Decoration(w[3])}] = w.size() > 4 ? w[4] : 0;
    }
    return declared;
}

std::vector<StorageBlock> find_storage_blocks(const SpirvDeclarations& declared) {
    std::vector<StorageBlock> blocks;
    for (const SpirvDeclarations::Variable& variable : declared.variables) {
        const SpirvType& type = declared.types.at(variable.type);
        if (variable.storage != spv::StorageClassStorageBuffer || type.op != spv::OpTypeStruct) continue;
        const uint32_t last = type.operands.back();
        blocks.push_back({variable.id, variable.type,
                          declared.decoration(variable.id, spv::DecorationBinding).value(),
                          declared.types.at(last).op == spv::OpTypeRuntimeArray ? last : 0,
                          declared.names.at(variable.type)});
    }
    return blocks;
}

}  // namespace etendue
