#include "host/gpu/texel_reads.h"

#include <algorithm>
#include <map>

#include "host/gpu/spirv_declarations.h"
#include "host/gpu/texel_fetch.h"

namespace etendue {
namespace {

class Rewriter {
  public:
    Rewriter(const Spirv& spirv, const std::set<std::string>& not_texels, uint32_t most_views)
        : in_(split_spirv(spirv)),
          out_{in_.header, {}},
          declared_(read_declarations(in_)),
          fetches_(declared_, out_) {
        find_blocks(not_texels);
        choose_views(most_views);
    }

    TexelShader run(const Spirv& unchanged) {
        if (blocks_.empty()) return {unchanged, {}};
        TexelShader result;
        std::vector<uint32_t> variables;
        for (const auto& [key, view] : views_) {
            result.views.push_back({blocks_.at(key.first).name, view.binding, key.second});
            variables.push_back(view.variable);
        }
        bool in_functions = false;
        for (SpirvWords& words : in_.instructions) {
            if (words[0] == spv::OpFunction && !in_functions) {
                in_functions = true;
                fetches_.declare(variables);
            }
            rewrite(words);
        }
        fetches_.declare_constants();
        result.spirv = join_spirv(out_);
        return result;
    }

  private:
    struct View {
        uint32_t variable, binding;
    };

    // Of words of 32 bits alone, by columns, and neither volatile nor coherent?
    bool is_readable(uint32_t id) const {
        const SpirvType& type = declared_.types.at(id);
        if (type.op == spv::OpTypeInt || type.op == spv::OpTypeFloat) return type.operands[0] == 32;
        if (type.op != spv::OpTypeStruct) return is_readable(type.operands[0]);
        for (uint32_t i = 0; i < type.operands.size(); ++i) {
            for (const spv::Decoration kind :
                 {spv::DecorationRowMajor, spv::DecorationVolatile, spv::DecorationCoherent})
                if (declared_.member_decoration(id, i, kind)) return false;
            if (!is_readable(type.operands[i])) return false;
        }
        return true;
    }

    // Instructions but loads and access chains that a pointer may be given to.
    static bool takes_pointers(spv::Op op) {
        switch (op) {
            case spv::OpStore:
            case spv::OpCopyMemory:
            case spv::OpCopyMemorySized:
            case spv::OpArrayLength:
            case spv::OpFunctionCall:
            case spv::OpCopyObject:
            case spv::OpSelect:
            case spv::OpPhi:
            case spv::OpReturnValue:
            case spv::OpPtrAccessChain:
            case spv::OpAtomicFAddEXT:
                return true;
            default:
                return op >= spv::OpAtomicLoad && op <= spv::OpAtomicXor;
        }
    }

    // Readable blocks that end in a run-time array and that only loads through access chains use.
    void find_blocks(const std::set<std::string>& not_texels) {
        for (const auto& [id, type] : declared_.types)
            if (type.op == spv::OpTypeImage) return;
        std::set<uint32_t> left_alone;  // bindings: a block may be one of several views of a buffer
        for (const StorageBlock& block : find_storage_blocks(declared_)) {
            if (!block.array) continue;
            if (not_texels.count(block.buffer()) || !is_readable(block.type))
                left_alone.insert(block.binding);
            blocks_[block.variable] = block;
            places_[block.variable] = {block.variable, block.type};
        }
        for (const SpirvWords& w : in_.instructions) {
            const auto op = spv::Op(w[0]);
            if ((op == spv::OpAccessChain || op == spv::OpInBoundsAccessChain) && places_.count(w[3])) {
                BlockPlace place = places_.at(w[3]);
                for (size_t i = 4; i < w.size(); ++i) place.step(declared_, w[i]);
                places_[w[2]] = place;
            } else if (takes_pointers(op)) {
                for (size_t i = 1; i < w.size(); ++i)
                    if (const auto place = places_.find(w[i]); place != places_.end())
                        left_alone.insert(blocks_.at(place->second.variable).binding);
            }
        }
        std::erase_if(blocks_, [&](const auto& block) { return left_alone.count(block.second.binding); });
    }

    // A view for each size of texel that the loads from a block want. Blocks that would exceed the limit go
    // without.
    void choose_views(uint32_t most_views) {
        std::map<uint32_t, std::set<uint32_t>> wanted;  // variable -> words
        for (const SpirvWords& w : in_.instructions)
            if (const auto place = places_.find(w[0] == spv::OpLoad ? w[3] : 0); place != places_.end())
                wanted[place->second.variable].insert(texel_words(place->second));
        uint32_t binding = declared_.free_binding();
        std::erase_if(blocks_, [&](const auto& block) {
            const std::set<uint32_t>& sizes = wanted[block.first];
            if (sizes.empty() || views_.size() + sizes.size() > most_views) return true;
            for (const uint32_t words : sizes) views_[{block.first, words}] = {out_.new_id(), binding++};
            return false;
        });
        std::erase_if(places_, [&](const auto& place) { return !blocks_.count(place.second.variable); });
    }

    void rewrite(SpirvWords& words) {
        const auto op = spv::Op(words[0]);
        switch (op) {
            case spv::OpCapability:
                if (!has_capability_) out_.put(spv::OpCapability, {spv::CapabilitySampledBuffer});
                has_capability_ = true;
                break;
            case spv::OpEntryPoint:
                words.erase(std::remove_if(words.begin() + 3, words.end(),
                                           [&](uint32_t id) { return blocks_.count(id); }),
                            words.end());
                for (const auto& [key, view] : views_) words.push_back(view.variable);
                break;
            case spv::OpName:
                if (blocks_.count(words[1])) return;
                break;
            case spv::OpDecorate:
                if (!has_decorations_)
                    for (const auto& [key, view] : views_) {
                        out_.put(spv::OpDecorate, {view.variable, spv::DecorationDescriptorSet, 0});
                        out_.put(spv::OpDecorate, {view.variable, spv::DecorationBinding, view.binding});
                    }
                has_decorations_ = true;
                if (places_.count(words[1])) return;
                break;
            case spv::OpVariable:
                if (blocks_.count(words[2])) return;
                break;
            case spv::OpAccessChain:
            case spv::OpInBoundsAccessChain:
                if (places_.count(words[2])) return;
                break;
            case spv::OpLoad:
                if (const auto place = places_.find(words[3]); place != places_.end()) {
                    const BlockPlace& from = place->second;
                    fetches_.load(from, views_.at({from.variable, texel_words(from)}).variable, words[2]);
                    return;
                }
                break;
            default:
                break;
        }
        out_.instructions.push_back(words);
    }

    SpirvModule in_, out_;
    SpirvDeclarations declared_;
    TexelFetches fetches_;
    std::map<uint32_t, StorageBlock> blocks_;              // by variable: those that become texel buffers
    std::map<uint32_t, BlockPlace> places_;                // of pointers into them
    std::map<std::pair<uint32_t, uint32_t>, View> views_;  // by variable and words of a texel
    bool has_capability_ = false, has_decorations_ = false;
};

}  // namespace

TexelShader use_texels(const Spirv& spirv, const std::set<std::string>& not_texels, uint32_t most_views) {
    return Rewriter(spirv, not_texels, most_views).run(spirv);
}

}  // namespace etendue
