#include "host/gpu/texel_reads.h"

#include <algorithm>
#include <map>
#include <optional>

#include "host/gpu/spirv.h"

namespace etendue {
namespace {

struct Type {
    spv::Op op = spv::OpNop;
    SpirvWords operands;  // behind the result id
};

// What a pointer into a block points to: the sum of index * stride, and of what is known.
struct Place {
    uint32_t variable = 0;
    uint32_t type = 0;   // of what stands there
    uint32_t bytes = 0;  // known
    uint32_t matrix_stride = 0;  // of the matrices there, where they are any
    struct Index {
        uint32_t id, stride;
    };
    std::vector<Index> indices;
};

class Rewriter {
  public:
    Rewriter(const Spirv& spirv, const std::set<std::string>& not_texels, uint32_t most_views)
        : in_(split_spirv(spirv)), bound_(in_.header[3]), most_views_(most_views) {
        read_declarations();
        find_blocks(not_texels);
        choose_views();
    }

    TexelShader run(const Spirv& unchanged) {
        if (blocks_.empty()) return {unchanged, {}};
        TexelShader result;
        for (const auto& [key, view] : views_)
            result.views.push_back({blocks_.at(key.first).name, view.binding, key.second});
        for (const SpirvWords& words : in_.instructions) rewrite(words);
        std::vector<SpirvWords> constants;
        for (const auto& [value, id] : made_constants_)
            constants.push_back(spirv_instruction(spv::OpConstant, {uint_, id, value}));
        out_.insert(out_.begin() + long(functions_at_), constants.begin(), constants.end());
        SpirvModule out{in_.header, std::move(out_)};
        out.header[3] = bound_;
        result.spirv = join_spirv(out);
        return result;
    }

  private:
    struct Block {
        std::string name;
        uint32_t type;  // its struct
    };
    struct View {
        uint32_t variable, binding;
    };

    uint32_t new_id() { return bound_++; }
    void put(spv::Op op, std::initializer_list<uint32_t> operands) {
        out_.push_back(spirv_instruction(op, operands));
    }

    void read_declarations() {
        for (const SpirvWords& w : in_.instructions) switch (spv::Op(w[0])) {
                case spv::OpTypeInt:
                case spv::OpTypeFloat:
                case spv::OpTypeVector:
                case spv::OpTypeMatrix:
                case spv::OpTypeArray:
                case spv::OpTypeRuntimeArray:
                case spv::OpTypeStruct:
                case spv::OpTypePointer:
                case spv::OpTypeImage:
                    types_[w[1]] = {spv::Op(w[0]), {w.begin() + 2, w.end()}};
                    if (w[0] == spv::OpTypeInt && w[2] == 32 && w[3] == 0) uint_ = w[1];
                    if (w[0] == spv::OpTypeVector && w[2] == uint_ && w[3] == 4) uvec4_ = w[1];
                    if (w[0] == spv::OpTypeImage) has_images_ = true;
                    break;
                case spv::OpConstant:
                    if (w.size() == 4) constants_[w[2]] = w[3];
                    break;
                case spv::OpName:
                    names_[w[1]] = spirv_text(w, 2);
                    break;
                case spv::OpDecorate:
                    if (w[2] == spv::DecorationArrayStride) strides_[w[1]] = w[3];
                    if (w[2] == spv::DecorationBinding) bindings_[w[1]] = w[3];
                    break;
                case spv::OpMemberDecorate:
                    if (w[3] == spv::DecorationOffset) offsets_[{w[1], w[2]}] = w[4];
                    if (w[3] == spv::DecorationMatrixStride) matrix_strides_[{w[1], w[2]}] = w[4];
                    if (w[3] == spv::DecorationRowMajor || w[3] == spv::DecorationVolatile ||
                        w[3] == spv::DecorationCoherent)
                        left_alone_.insert(w[1]);
                    break;
                default:
                    break;
            }
    }

    // Of words of 32 bits alone, by columns?
    bool is_readable(uint32_t id) const {
        const Type& type = types_.at(id);
        switch (type.op) {
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
                return type.operands[0] == 32;
            case spv::OpTypeStruct:
                return !left_alone_.count(id) && std::all_of(type.operands.begin(), type.operands.end(),
                                                             [&](uint32_t member) { return is_readable(member); });
            default:
                return is_readable(type.operands[0]);
        }
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

    // Variables of readable blocks that end in a run-time array and that only loads through access chains use.
    void find_blocks(const std::set<std::string>& not_texels) {
        if (has_images_) return;
        std::map<uint32_t, uint32_t> root;  // of pointers into blocks: the variable
        std::set<uint32_t> used_otherwise;
        for (const SpirvWords& w : in_.instructions) {
            const auto op = spv::Op(w[0]);
            if (op == spv::OpVariable && w[3] == spv::StorageClassStorageBuffer) {
                const uint32_t type = types_.at(w[1]).operands[1];
                const Type& block = types_.at(type);
                if (block.op != spv::OpTypeStruct || types_.at(block.operands.back()).op != spv::OpTypeRuntimeArray)
                    continue;
                root[w[2]] = w[2];
                const std::string& name = names_.at(type);
                if (not_texels.count(name.substr(0, name.find("__"))) || !is_readable(type)) used_otherwise.insert(w[2]);
                blocks_[w[2]] = {name, type};
            } else if (op == spv::OpAccessChain || op == spv::OpInBoundsAccessChain) {
                if (root.count(w[3])) root[w[2]] = root[w[3]];
            } else if (takes_pointers(op)) {
                for (size_t i = 1; i < w.size(); ++i)
                    if (const auto found = root.find(w[i]); found != root.end()) used_otherwise.insert(found->second);
            }
        }
        std::set<uint32_t> written;  // bindings: a block may be one of several views of a buffer
        for (const uint32_t variable : used_otherwise) written.insert(bindings_.at(variable));
        for (auto i = blocks_.begin(); i != blocks_.end();)
            i = written.count(bindings_.at(i->first)) ? blocks_.erase(i) : std::next(i);
    }

    std::optional<Place> place_of(const SpirvWords& chain) const {
        Place place;
        if (const auto known = places_.find(chain[3]); known != places_.end())
            place = known->second;
        else if (const auto block = blocks_.find(chain[3]); block != blocks_.end())
            place.variable = chain[3], place.type = block->second.type;
        else
            return std::nullopt;
        for (size_t i = 4; i < chain.size(); ++i) step(place, chain[i]);
        return place;
    }

    // Bytes from one part of an array, matrix or vector to the next.
    uint32_t stride_of(uint32_t id, uint32_t matrix_stride) const {
        const spv::Op op = types_.at(id).op;
        if (op == spv::OpTypeArray || op == spv::OpTypeRuntimeArray) return strides_.at(id);
        return op == spv::OpTypeMatrix ? matrix_stride : 4;
    }

    void step(Place& place, uint32_t index) const {
        const Type& type = types_.at(place.type);
        if (type.op == spv::OpTypeStruct) {
            const uint32_t member = constants_.at(index);
            place.bytes += offsets_.at({place.type, member});
            const auto columns = matrix_strides_.find({place.type, member});
            if (columns != matrix_strides_.end()) place.matrix_stride = columns->second;
            place.type = type.operands[member];
            return;
        }
        const uint32_t stride = stride_of(place.type, place.matrix_stride);
        const auto known = constants_.find(index);
        if (known != constants_.end())
            place.bytes += stride * known->second;
        else
            place.indices.push_back({index, stride});
        place.type = type.operands[0];
    }

    // Words of a texel that every index steps over whole ones of.
    static uint32_t texel_words(const Place& place) {
        uint32_t words = 4;
        for (const Place::Index& index : place.indices)
            while (index.stride % (4 * words) != 0) words /= 2;
        return words;
    }

    // A view for each size of texel that the loads from a block want. Blocks that would exceed the limit go without.
    void choose_views() {
        std::map<uint32_t, std::set<uint32_t>> wanted;  // variable -> words
        for (const SpirvWords& w : in_.instructions) {
            if (w[0] == spv::OpAccessChain || w[0] == spv::OpInBoundsAccessChain) {
                if (auto place = place_of(w)) places_[w[2]] = *place;
            } else if (w[0] == spv::OpLoad && places_.count(w[3])) {
                wanted[places_.at(w[3]).variable].insert(texel_words(places_.at(w[3])));
            }
        }
        uint32_t binding = 0;
        for (const auto& [variable, number] : bindings_) binding = std::max(binding, number + 1);
        for (auto i = blocks_.begin(); i != blocks_.end();) {
            const std::set<uint32_t>& sizes = wanted[i->first];
            if (sizes.empty() || views_.size() + sizes.size() > most_views_) {
                i = blocks_.erase(i);
                continue;
            }
            for (const uint32_t words : sizes) views_[{i->first, words}] = {new_id(), binding++};
            ++i;
        }
        for (auto i = places_.begin(); i != places_.end();)
            i = blocks_.count(i->second.variable) ? std::next(i) : places_.erase(i);
    }

    void declare() {
        if (!uint_) put(spv::OpTypeInt, {uint_ = new_id(), 32, 0});
        if (!uvec4_) put(spv::OpTypeVector, {uvec4_ = new_id(), uint_, 4});
        image_ = new_id();
        const uint32_t pointer = new_id();
        put(spv::OpTypeImage, {image_, uint_, spv::DimBuffer, 0, 0, 0, 1, spv::ImageFormatUnknown});
        put(spv::OpTypePointer, {pointer, spv::StorageClassUniformConstant, image_});
        for (const auto& [key, view] : views_)
            put(spv::OpVariable, {pointer, view.variable, spv::StorageClassUniformConstant});
        functions_at_ = out_.size();
    }

    // Those that the functions turn out to need are put before them at the end.
    uint32_t constant(uint32_t value) {
        const auto [at, is_new] = made_constants_.try_emplace(value, 0);
        if (is_new) at->second = new_id();
        return at->second;
    }

    // The words of a load, each texel fetched once.
    class Fetch {
      public:
        Fetch(Rewriter& r, const Place& place) : r_(r), words_(texel_words(place)) {
            for (const Place::Index& index : place.indices) {
                uint32_t texels = index.id;
                if (index.stride != 4 * words_) {
                    texels = r.new_id();
                    r.put(spv::OpIMul, {r.uint_, texels, index.id, r.constant(index.stride / (4 * words_))});
                }
                if (start_) {
                    const uint32_t sum = r.new_id();
                    r.put(spv::OpIAdd, {r.uint_, sum, start_, texels});
                    texels = sum;
                }
                start_ = texels;
            }
            image_ = r.new_id();
            r.put(spv::OpLoad, {r.image_, image_, r.views_.at({place.variable, words_}).variable});
        }

        uint32_t texel(uint32_t number) {
            const auto [at, is_new] = texels_.try_emplace(number, 0);
            if (!is_new) return at->second;
            uint32_t where = r_.constant(number);
            if (start_ && number > 0) {
                const uint32_t sum = r_.new_id();
                r_.put(spv::OpIAdd, {r_.uint_, sum, start_, where});
                where = sum;
            } else if (start_) {
                where = start_;
            }
            r_.put(spv::OpImageFetch, {r_.uvec4_, at->second = r_.new_id(), image_, where});
            return at->second;
        }

        // What stands `bytes` behind the indices, as the type `id`; in the place of `result` where that is not 0.
        uint32_t value(uint32_t id, uint32_t bytes, uint32_t matrix_stride, uint32_t result = 0) {
            const Type& type = r_.types_.at(id);
            if (!result) result = r_.new_id();
            if (type.op == spv::OpTypeInt || type.op == spv::OpTypeFloat) {
                const uint32_t word = bytes / 4, from = texel(word / words_);
                const bool is_uint = id == r_.uint_;
                const uint32_t bits = is_uint ? result : r_.new_id();
                r_.put(spv::OpCompositeExtract, {r_.uint_, bits, from, word % words_});
                if (!is_uint) r_.put(spv::OpBitcast, {id, result, bits});
                return result;
            }
            SpirvWords construct = spirv_instruction(spv::OpCompositeConstruct, {id, result});
            if (type.op == spv::OpTypeStruct) {
                for (uint32_t i = 0; i < type.operands.size(); ++i) {
                    const auto columns = r_.matrix_strides_.find({id, i});
                    construct.push_back(value(type.operands[i], bytes + r_.offsets_.at({id, i}),
                                              columns == r_.matrix_strides_.end() ? 0 : columns->second));
                }
            } else {
                const bool is_array = type.op == spv::OpTypeArray;
                const uint32_t count = is_array ? r_.constants_.at(type.operands[1]) : type.operands[1];
                const uint32_t stride = r_.stride_of(id, matrix_stride);
                for (uint32_t i = 0; i < count; ++i)
                    construct.push_back(value(type.operands[0], bytes + i * stride, matrix_stride));
            }
            r_.out_.push_back(std::move(construct));
            return result;
        }

      private:
        Rewriter& r_;
        uint32_t words_, start_ = 0, image_ = 0;
        std::map<uint32_t, uint32_t> texels_;
    };

    void rewrite(SpirvWords words) {
        const auto op = spv::Op(words[0]);
        switch (op) {
            case spv::OpCapability:
                if (!has_capability_) put(spv::OpCapability, {spv::CapabilitySampledBuffer});
                has_capability_ = true;
                break;
            case spv::OpEntryPoint:
                words.erase(std::remove_if(words.begin() + 3, words.end(),
                                           [&](uint32_t id) { return blocks_.count(id) > 0; }),
                            words.end());
                for (const auto& [key, view] : views_) words.push_back(view.variable);
                break;
            case spv::OpName:
                if (blocks_.count(words[1])) return;
                break;
            case spv::OpDecorate:
                if (!has_decorations_)
                    for (const auto& [key, view] : views_) {
                        put(spv::OpDecorate, {view.variable, spv::DecorationDescriptorSet, 0});
                        put(spv::OpDecorate, {view.variable, spv::DecorationBinding, view.binding});
                    }
                has_decorations_ = true;
                if (blocks_.count(words[1]) || places_.count(words[1])) return;
                break;
            case spv::OpVariable:
                if (blocks_.count(words[2])) return;
                break;
            case spv::OpFunction:
                if (!image_) declare();
                break;
            case spv::OpAccessChain:
            case spv::OpInBoundsAccessChain:
                if (places_.count(words[2])) return;
                break;
            case spv::OpLoad:
                if (const auto place = places_.find(words[3]); place != places_.end()) {
                    Fetch(*this, place->second)
                        .value(words[1], place->second.bytes, place->second.matrix_stride, words[2]);
                    return;
                }
                break;
            default:
                break;
        }
        out_.push_back(std::move(words));
    }

    SpirvModule in_;
    std::vector<SpirvWords> out_;
    size_t functions_at_ = 0;  // in out_
    uint32_t bound_, most_views_;
    std::map<uint32_t, Type> types_;
    std::map<uint32_t, uint32_t> constants_, strides_, bindings_;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> offsets_, matrix_strides_;  // of members
    std::map<uint32_t, std::string> names_;
    std::set<uint32_t> left_alone_;  // structs
    bool has_images_ = false, has_capability_ = false, has_decorations_ = false;
    uint32_t uint_ = 0, uvec4_ = 0, image_ = 0;
    std::map<uint32_t, Block> blocks_;  // by variable: those that become texel buffers
    std::map<uint32_t, Place> places_;        // of pointers into them
    std::map<std::pair<uint32_t, uint32_t>, View> views_;  // by variable and words of a texel
    std::map<uint32_t, uint32_t> made_constants_;
};

}  // namespace

TexelShader use_texels(const Spirv& spirv, const std::set<std::string>& not_texels, uint32_t most_views) {
    return Rewriter(spirv, not_texels, most_views).run(spirv);
}

}  // namespace etendue
