#include "host/gpu/texel_fetch.h"

namespace etendue {
namespace {

// Bytes from one part of an array, matrix or vector to the next.
uint32_t stride_of(const SpirvDeclarations& declared, uint32_t id, uint32_t matrix_stride) {
    const spv::Op op = declared.types.at(id).op;
    if (op == spv::OpTypeArray || op == spv::OpTypeRuntimeArray)
        return declared.decoration(id, spv::DecorationArrayStride).value();
    return op == spv::OpTypeMatrix ? matrix_stride : 4;
}

}  // namespace

void BlockPlace::step(const SpirvDeclarations& declared, uint32_t index) {
    const SpirvType& whole = declared.types.at(type);
    if (whole.op == spv::OpTypeStruct) {
        const uint32_t member = declared.constants.at(index);
        bytes += declared.member_decoration(type, member, spv::DecorationOffset).value();
        matrix_stride =
            declared.member_decoration(type, member, spv::DecorationMatrixStride).value_or(matrix_stride);
        type = whole.operands[member];
        return;
    }
    const uint32_t stride = stride_of(declared, type, matrix_stride);
    const auto known = declared.constants.find(index);
    if (known != declared.constants.end())
        bytes += stride * known->second;
    else
        indices.push_back({index, stride});
    type = whole.operands[0];
}

uint32_t texel_words(const BlockPlace& place) {
    uint32_t words = 4;
    for (const BlockPlace::Index& index : place.indices)
        while (index.stride % (4 * words) != 0) words /= 2;
    return words;
}

void TexelFetches::declare(const std::vector<uint32_t>& variables) {
    uint_ = declared_.find_type(spv::OpTypeInt, {32, 0});
    if (!uint_) out_.put(spv::OpTypeInt, {uint_ = out_.new_id(), 32, 0});
    uvec4_ = declared_.find_type(spv::OpTypeVector, {uint_, 4});
    if (!uvec4_) out_.put(spv::OpTypeVector, {uvec4_ = out_.new_id(), uint_, 4});
    image_ = out_.new_id();
    const uint32_t pointer = out_.new_id();
    out_.put(spv::OpTypeImage, {image_, uint_, spv::DimBuffer, 0, 0, 0, 1, spv::ImageFormatUnknown});
    out_.put(spv::OpTypePointer, {pointer, spv::StorageClassUniformConstant, image_});
    for (const uint32_t variable : variables)
        out_.put(spv::OpVariable, {pointer, variable, spv::StorageClassUniformConstant});
    constants_at_ = out_.instructions.size();
}

uint32_t TexelFetches::constant(uint32_t value) {
    const auto [at, is_new] = constants_.try_emplace(value, 0);
    if (is_new) at->second = out_.new_id();
    return at->second;
}

void TexelFetches::declare_constants() {
    std::vector<SpirvWords> constants;
    for (const auto& [value, id] : constants_)
        constants.push_back(spirv_instruction(spv::OpConstant, {uint_, id, value}));
    out_.instructions.insert(out_.instructions.begin() + long(constants_at_), constants.begin(),
                             constants.end());
}

// The words of a load, each texel fetched once.
class TexelFetches::Load {
  public:
    Load(TexelFetches& fetches, const BlockPlace& place, uint32_t variable)
        : f_(fetches), out_(fetches.out_), words_(texel_words(place)) {
        for (const BlockPlace::Index& index : place.indices) {
            uint32_t texels = index.id;
            if (index.stride != 4 * words_) {
                texels = out_.new_id();
                out_.put(spv::OpIMul, {f_.uint_, texels, index.id, f_.constant(index.stride / (4 * words_))});
            }
            start_ = start_ ? sum(start_, texels) : texels;
        }
        image_ = out_.new_id();
        out_.put(spv::OpLoad, {f_.image_, image_, variable});
    }

    // What stands `bytes` behind the indices, as the type `id`; in the place of `result` where that is not 0.
    uint32_t value(uint32_t id, uint32_t bytes, uint32_t matrix_stride, uint32_t result = 0) {
        const SpirvDeclarations& declared = f_.declared_;
        const SpirvType& type = declared.types.at(id);
        if (!result) result = out_.new_id();
        if (type.op == spv::OpTypeInt || type.op == spv::OpTypeFloat) {
            const uint32_t word = bytes / 4, from = texel(word / words_);
            const bool is_uint = id == f_.uint_;
            const uint32_t bits = is_uint ? result : out_.new_id();
            out_.put(spv::OpCompositeExtract, {f_.uint_, bits, from, word % words_});
            if (!is_uint) out_.put(spv::OpBitcast, {id, result, bits});
            return result;
        }
        SpirvWords construct = spirv_instruction(spv::OpCompositeConstruct, {id, result});
        if (type.op == spv::OpTypeStruct) {
            for (uint32_t i = 0; i < type.operands.size(); ++i) {
                const auto member = [&](spv::Decoration kind) {
                    return declared.member_decoration(id, i, kind);
                };
                construct.push_back(value(type.operands[i], bytes + member(spv::DecorationOffset).value(),
                                          member(spv::DecorationMatrixStride).value_or(0)));
            }
        } else {
            const bool is_array = type.op == spv::OpTypeArray;
            const uint32_t count = is_array ? declared.constants.at(type.operands[1]) : type.operands[1];
            const uint32_t stride = stride_of(declared, id, matrix_stride);
            for (uint32_t i = 0; i < count; ++i)
                construct.push_back(value(type.operands[0], bytes + i * stride, matrix_stride));
        }
        out_.instructions.push_back(std::move(construct));
        return result;
    }

  private:
    uint32_t sum(uint32_t a, uint32_t b) {
        const uint32_t id = out_.new_id();
        out_.put(spv::OpIAdd, {f_.uint_, id, a, b});
        return id;
    }

    uint32_t texel(uint32_t number) {
        const auto [at, is_new] = texels_.try_emplace(number, 0);
        if (!is_new) return at->second;
        uint32_t where = f_.constant(number);
        if (start_) where = number > 0 ? sum(start_, where) : start_;
        out_.put(spv::OpImageFetch, {f_.uvec4_, at->second = out_.new_id(), image_, where});
        return at->second;
    }

    TexelFetches& f_;
    SpirvModule& out_;
    uint32_t words_, start_ = 0,
                     image_ = 0;           // words of a texel; ids, the start's 0 where no index is unknown
    std::map<uint32_t, uint32_t> texels_;  // by number
};

void TexelFetches::load(const BlockPlace& place, uint32_t variable, uint32_t result) {
    Load(*this, place, variable).value(place.type, place.bytes, place.matrix_stride, result);
}

}  // namespace etendue
