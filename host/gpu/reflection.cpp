#include "host/gpu/reflection.h"

#include <algorithm>

#include "host/error.h"
#include "host/gpu/spirv_declarations.h"

namespace etendue {
namespace {

std::string scalar_name(const SpirvType& type) {
    if (type.op == spv::OpTypeFloat) return "float";
    if (type.op == spv::OpTypeInt) return type.operands[1] ? "int" : "uint";
    return "bool";
}

std::vector<MemberLayout> struct_members(const SpirvDeclarations& declared, uint32_t id);

// GLSL name and size in bytes of a type in a buffer; scalar layout packs vectors and matrix columns tightly.
MemberLayout describe_type(const SpirvDeclarations& declared, uint32_t id) {
    const SpirvType& type = declared.types.at(id);
    MemberLayout result;
    switch (type.op) {
        case spv::OpTypeVector: {
            const MemberLayout part = describe_type(declared, type.operands[0]);
            const char* prefix = part.type == "float" ? "" : part.type == "int" ? "i" : "u";
            result.type = fmt::format("{}vec{}", prefix, type.operands[1]);
            result.size = part.size * type.operands[1];
            break;
        }
        case spv::OpTypeMatrix: {
            const SpirvType& column = declared.types.at(type.operands[0]);
            result.type = fmt::format("mat{}x{}", type.operands[1], column.operands[1]);
            result.size = 4 * type.operands[1] * column.operands[1];
            break;
        }
        case spv::OpTypeStruct: {
            result.type = declared.names.count(id) ? declared.names.at(id) : "";
            result.members = struct_members(declared, id);
            if (!result.members.empty())
                result.size = result.members.back().offset + result.members.back().size;
            break;
        }
        case spv::OpTypeArray: {
            const MemberLayout part = describe_type(declared, type.operands[0]);
            const uint32_t length = declared.constants.at(type.operands[1]);
            result.type = fmt::format("{}[{}]", part.type, length);
            result.size = declared.decoration(id, spv::DecorationArrayStride).value() * length;
            break;
        }
        case spv::OpTypeRuntimeArray:
            result.type = describe_type(declared, type.operands[0]).type + "[]";
            break;
        default:
            result.type = scalar_name(type);
            result.size = type.operands.empty() ? 4 : type.operands[0] / 8;
    }
    return result;
}

std::vector<MemberLayout> struct_members(const SpirvDeclarations& declared, uint32_t id) {
    std::vector<MemberLayout> members;
    const SpirvType& type = declared.types.at(id);
    for (uint32_t i = 0; i < type.operands.size(); ++i) {
        MemberLayout member = describe_type(declared, type.operands[i]);
        const auto name = declared.member_names.find({id, i});
        if (name != declared.member_names.end()) member.name = name->second;
        member.offset = declared.member_decoration(id, i, spv::DecorationOffset).value_or(0);
        members.push_back(std::move(member));
    }
    return members;
}

}  // namespace

uint32_t ShaderLayout::element_bytes(const std::string& buffer) const {
    for (const BlockLayout& block : blocks)
        if (block.name == buffer && block.stride > 0) return block.stride;
    fail_device("a kernel has no array {}", buffer);
}

ShaderLayout reflect_shader(const Spirv& spirv) {
    const SpirvModule module = split_spirv(spirv);
    const SpirvDeclarations declared = read_declarations(module);
    ShaderLayout layout;
    for (const SpirvWords& w : module.instructions)
        if (w[0] == spv::OpExecutionMode && w[2] == spv::ExecutionModeLocalSize)
            layout.local_size = {w[3], w[4], w[5]};
    for (const SpirvDeclarations::Variable& variable : declared.variables) {
        if (variable.storage != spv::StorageClassPushConstant) continue;
        layout.push_constants = struct_members(declared, variable.type);
        for (const MemberLayout& member : layout.push_constants)
            layout.push_constant_size = std::max(layout.push_constant_size, member.offset + member.size);
    }
    for (const StorageBlock& found : find_storage_blocks(declared)) {
        BlockLayout block{found.buffer(), found.name, found.binding};
        if (found.array) {
            MemberLayout element = describe_type(declared, declared.types.at(found.array).operands[0]);
            block.element_type = std::move(element.type);
            block.element_members = std::move(element.members);
            block.stride = declared.decoration(found.array, spv::DecorationArrayStride).value();
        }
        layout.blocks.push_back(std::move(block));
    }
    return layout;
}

}  // namespace etendue
