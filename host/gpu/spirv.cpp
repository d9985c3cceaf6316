#include "host/gpu/spirv.h"

#include <cstring>

#include "host/error.h"

namespace etendue {

SpirvWords spirv_instruction(spv::Op op, std::initializer_list<uint32_t> operands) {
    SpirvWords words{uint32_t(op)};
    words.insert(words.end(), operands);
    return words;
}

std::string spirv_text(const SpirvWords& words, size_t at) {
    const char* text = reinterpret_cast<const char*>(words.data() + at);
    return std::string(text, strnlen(text, (words.size() - at) * 4));
}

SpirvModule split_spirv(const Spirv& spirv) {
    SpirvModule module;
    if (spirv.size() < 5) fail_device("a compiled shader is not valid SPIR-V");
    module.header.assign(spirv.begin(), spirv.begin() + 5);
    for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16) {
        const size_t count = spirv[at] >> 16;
        if (count == 0 || at + count > spirv.size()) fail_device("a compiled shader is not valid SPIR-V");
        module.instructions.emplace_back(spirv.begin() + long(at), spirv.begin() + long(at + count));
        module.instructions.back()[0] &= 0xFFFF;
    }
    return module;
}

Spirv join_spirv(const SpirvModule& module) {
    Spirv spirv = module.header;
    for (const SpirvWords& words : module.instructions) {
        spirv.push_back(uint32_t(words.size()) << 16 | words[0]);
        spirv.insert(spirv.end(), words.begin() + 1, words.end());
    }
    return spirv;
}

}  // namespace etendue
