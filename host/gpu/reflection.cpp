#include "host/gpu/reflection.h"

#include <algorithm>
#include <map>
#include <spirv/unified1/spirv.hpp>

#include "host/error.h"

namespace etendue {
namespace {

struct Type {
    spv::Op op = spv::OpNop;
    std::vector<uint32_t> operands;  // behind the result id
};

// The parts of a module that describe its interface (SPIR-V specification, section 3: instructions).
struct Module {
    std::map<uint32_t, std::string> names;
    std::map<uint32_t, std::vector<std::string>> member_names;
    std::map<uint32_t, std::map<uint32_t, uint32_t>> member_offsets;  // struct -> member -> byte offset
    std::map<uint32_t, uint32_t> bindings, array_strides;
    std::map<uint32_t, Type> types;
    std::map<uint32_t, uint32_t> constants;
    struct Variable {
        uint32_t id, type;
        spv::StorageClass storage;
    };
    std::vector<Variable> variables;
    std::array<uint32_t, 3> local_size{1, 1, 1};
};

std::string literal_string(const uint32_t* words, size_t count) {
    const char* text = reinterpret_cast<const char*>(words);
    return std::string(text, strnlen(text, count * 4));
}

Module read_module(const Spirv& spirv) {
    Module m;
    for (size_t at = 5; at < spirv.size();) {
        const uint32_t* word = &spirv[at];
        const size_t count = word[0] >> 16;
        const auto op = spv::Op(word[0] & 0xFFFF);
        if (count == 0) fail_device("a compiled shader is not valid SPIR-V");
        switch (op) {
            case spv::OpName:
                m.names[word[1]] = literal_string(word + 2, count - 2);
                break;
            case spv::OpMemberName: {
                auto& names = m.member_names[word[1]];
                names.resize(std::max<size_t>(names.size(), word[2] + 1));
                names[word[2]] = literal_string(word + 3, count - 3);
                break;
            }
            case spv::OpDecorate:
                if (word[2] == spv::DecorationBinding) m.bindings[word[1]] = word[3];
                if (word[2] == spv::DecorationArrayStride) m.array_strides[word[1]] = word[3];
                break;
            case spv::OpMemberDecorate:
                if (word[3] == spv::DecorationOffset) m.member_offsets[word[1]][word[2]] = word[4];
                break;
            case spv::OpExecutionMode:
                if (word[2] == spv::ExecutionModeLocalSize) m.local_size = {word[3], word[4], word[5]};
                break;
            case spv::OpTypeBool:
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
            case spv::OpTypeVector:
            case spv::OpTypeMatrix:
            case spv::OpTypeArray:
            case spv::OpTypeRuntimeArray:
            case spv::OpTypeStruct:
            case spv::OpTypePointer:
                m.types[word[1]] = {op, {word + 2, word + count}};
                break;
            case spv::OpConstant:
                m.constants[word[2]] = word[3];
                break;
            case spv::OpVariable:
                m.variables.push_back({word[2], word[1], spv::StorageClass(word[3])});
                break;
            default:
                break;
        }
        at += count;
    }
    return m;
}

std::string scalar_name(const Type& type) {
    if (type.op == spv::OpTypeFloat) return "float";
    if (type.op == spv::OpTypeInt) return type.operands[1] ? "int" : "uint";
    return "bool";
}

std::vector<MemberLayout> struct_members(const Module& m, uint32_t id);

// GLSL name and size in bytes of a type in a buffer; scalar layout packs vectors and matrix columns tightly.
MemberLayout describe_type(const Module& m, uint32_t id) {
    const Type& type = m.types.at(id);
    MemberLayout result;
    switch (type.op) {
        case spv::OpTypeVector: {
            const MemberLayout part = describe_type(m, type.operands[0]);
            const char* prefix = part.type == "float" ? "" : part.type == "int" ? "i" : "u";
            result.type = fmt::format("{}vec{}", prefix, type.operands[1]);
            result.size = part.size * type.operands[1];
            break;
        }
        case spv::OpTypeMatrix: {
            const Type& column = m.types.at(type.operands[0]);
            result.type = fmt::format("mat{}x{}", type.operands[1], column.operands[1]);
            result.size = 4 * type.operands[1] * column.operands[1];
            break;
        }
        case spv::OpTypeStruct: {
            result.type = m.names.count(id) ? m.names.at(id) : "";
            result.members = struct_members(m, id);
            if (!result.members.empty())
                result.size = result.members.back().offset + result.members.back().size;
            break;
        }
        case spv::OpTypeArray: {
            const MemberLayout part = describe_type(m, type.operands[0]);
            const uint32_t length = m.constants.at(type.operands[1]);
            result.type = fmt::format("{}[{}]", part.type, length);
            result.size = m.array_strides.at(id) * length;
            break;
        }
        case spv::OpTypeRuntimeArray:
            result.type = describe_type(m, type.operands[0]).type + "[]";
            break;
        default:
            result.type = scalar_name(type);
            result.size = type.operands.empty() ? 4 : type.operands[0] / 8;
    }
    return result;
}

std::vector<MemberLayout> struct_members(const Module& m, uint32_t id) {
    std::vector<MemberLayout> members;
    const Type& type = m.types.at(id);
    for (uint32_t i = 0; i < type.operands.size(); ++i) {
        MemberLayout member = describe_type(m, type.operands[i]);
        const auto names = m.member_names.find(id);
        if (names != m.member_names.end() && i < names->second.size()) member.name = names->second[i];
        const auto offsets = m.member_offsets.find(id);
        if (offsets != m.member_offsets.end() && offsets->second.count(i))
            member.offset = offsets->second.at(i);
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
    const Module m = read_module(spirv);
    ShaderLayout layout;
    layout.local_size = m.local_size;
    for (const auto& variable : m.variables) {
        const auto pointer = m.types.find(variable.type);
        if (pointer == m.types.end() || pointer->second.op != spv::OpTypePointer) continue;
        const uint32_t pointee = pointer->second.operands[1];
        if (variable.storage == spv::StorageClassPushConstant) {
            layout.push_constants = struct_members(m, pointee);
            for (const auto& member : layout.push_constants)
                layout.push_constant_size = std::max(layout.push_constant_size, member.offset + member.size);
        } else if (variable.storage == spv::StorageClassStorageBuffer) {
            BlockLayout block;
            block.block_name = m.names.at(pointee);
            block.name = block.block_name.substr(0, block.block_name.find("__"));
            block.binding = m.bindings.at(variable.id);
            const Type& type = m.types.at(pointee);
            const uint32_t last = type.operands.back();
            if (m.types.at(last).op == spv::OpTypeRuntimeArray) {
                const uint32_t element = m.types.at(last).operands[0];
                const MemberLayout described = describe_type(m, element);
                block.element_type = described.type;
                block.element_members = described.members;
                block.stride = m.array_strides.at(last);
            }
            layout.blocks.push_back(std::move(block));
        }
    }
    return layout;
}

}  // namespace etendue
