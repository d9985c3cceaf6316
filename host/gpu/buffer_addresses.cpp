#include "host/gpu/buffer_addresses.h"

#include <algorithm>
#include <map>
#include <set>

#include "host/gpu/spirv.h"

namespace etendue {
namespace {

struct Block {
    uint32_t variable, type;  // ids; the type is the block's struct
    uint32_t address;         // id of the Private variable that holds its address
    std::string name;
};

// Of a vector in a block.
struct Component {
    SpirvWords access;  // the access chain that names it
    uint32_t vector;    // type
};

class Rewriter {
  public:
    explicit Rewriter(const Spirv& spirv) : in_(split_spirv(spirv)) {
        read_types();
        find_blocks();
    }

    AddressedShader run(const Spirv& unchanged) {
        AddressedShader result;
        if (blocks_.empty()) return {unchanged, 0, {}};
        for (const Block& block : blocks_) result.blocks.push_back(block.name);
        result.binding = binding_;
        bool in_functions = false;
        for (SpirvWords& words : in_.instructions) {
            const auto op = spv::Op(words[0]);
            if (op == spv::OpFunction && !in_functions) {
                in_functions = true;
                declare();
            }
            rewrite(op, words);
        }
        SpirvModule out{in_.header, std::move(out_)};
        out.header[3] = bound_;
        result.spirv = join_spirv(out);
        return result;
    }

  private:
    uint32_t new_id() { return bound_++; }
    void put(SpirvWords words) { out_.push_back(std::move(words)); }

    void read_types() {
        bound_ = in_.header[3];
        for (const SpirvWords& w : in_.instructions) switch (spv::Op(w[0])) {
                case spv::OpTypeRuntimeArray:
                    run_time_arrays_.insert(w[1]);
                    [[fallthrough]];
                case spv::OpTypeArray:
                case spv::OpTypeMatrix:
                    elements_[w[1]] = w[2];
                    break;
                case spv::OpConstant:
                    constants_[w[2]] = w[3];
                    break;
                case spv::OpTypeStruct:
                    struct_members_[w[1]] = {w.begin() + 2, w.end()};
                    break;
                case spv::OpTypePointer:
                    if (w[2] == spv::StorageClassStorageBuffer) pointees_[w[1]] = w[3];
                    break;
                case spv::OpTypeInt:
                    if (w[2] == 32 && w[3] == 0) uint_ = w[1];
                    if (w[2] == 64) has_wide_types_ = true;
                    break;
                case spv::OpTypeFloat:
                    if (w[2] == 64) has_wide_types_ = true;
                    break;
                case spv::OpTypeVector:
                    vectors_[w[1]] = w[2];
                    if (w[2] == uint_ && w[3] == 2) uvec2_ = w[1];
                    break;
                case spv::OpName:
                    names_[w[1]] = spirv_text(w, 2);
                    break;
                case spv::OpDecorate:
                    if (w[2] == spv::DecorationBinding) bindings_[w[1]] = w[3];
                    break;
                default:
                    break;
            }
    }

    // Variables of blocks that end in a run-time array and are used by access chains alone.
    void find_blocks() {
        for (const SpirvWords& w : in_.instructions) {
            if (w[0] != spv::OpVariable || w[3] != spv::StorageClassStorageBuffer) continue;
            const uint32_t type = pointees_.at(w[1]);
            const auto members = struct_members_.find(type);
            if (members == struct_members_.end() || !run_time_arrays_.count(members->second.back())) continue;
            blocks_.push_back({w[2], type, 0, names_.at(type)});
        }
        const auto is_used_otherwise = [&](const Block& block) {
            return std::any_of(in_.instructions.begin(), in_.instructions.end(), [&](const SpirvWords& w) {
                return (w[0] == spv::OpArrayLength || w[0] == spv::OpFunctionCall ||
                        w[0] == spv::OpCopyObject) &&
                       std::find(w.begin() + 3, w.end(), block.variable) != w.end();
            });
        };
        blocks_.erase(std::remove_if(blocks_.begin(), blocks_.end(), is_used_otherwise), blocks_.end());
        for (const auto& [variable, binding] : bindings_) binding_ = std::max(binding_, binding + 1);
        for (Block& block : blocks_) block.address = new_id();
        if (!blocks_.empty()) table_ = new_id(), table_type_ = new_id();
    }

    const Block* find_block(uint32_t variable) const {
        const auto found =
            std::find_if(blocks_.begin(), blocks_.end(), [&](auto& b) { return b.variable == variable; });
        return found == blocks_.end() ? nullptr : &*found;
    }

    // The table of addresses, the variables that keep them, and pointer types, behind all other declarations.
    void declare() {
        if (!uint_) put(spirv_instruction(spv::OpTypeInt, {uint_ = new_id(), 32, 0}));
        if (!uvec2_) put(spirv_instruction(spv::OpTypeVector, {uvec2_ = new_id(), uint_, 2}));
        SpirvWords table = spirv_instruction(spv::OpTypeStruct, {table_type_});
        table.insert(table.end(), blocks_.size(), uvec2_);
        put(table);
        const uint32_t to_table = new_id(), to_address = new_id();
        put(spirv_instruction(spv::OpTypePointer, {to_table, spv::StorageClassStorageBuffer, table_type_}));
        put(spirv_instruction(spv::OpVariable, {to_table, table_, spv::StorageClassStorageBuffer}));
        put(spirv_instruction(spv::OpTypePointer,
                              {table_pointer_ = new_id(), spv::StorageClassStorageBuffer, uvec2_}));
        put(spirv_instruction(spv::OpTypePointer, {to_address, spv::StorageClassPrivate, uvec2_}));
        for (uint32_t i = 0; i < blocks_.size(); ++i) {
            put(spirv_instruction(spv::OpVariable,
                                  {to_address, blocks_[i].address, spv::StorageClassPrivate}));
            put(spirv_instruction(spv::OpConstant, {uint_, new_id(), i}));
            indices_.push_back(bound_ - 1);
        }
        // Of every type that a pointer into a block may have; few are used, which costs nothing.
        std::set<uint32_t> types;
        for (const auto& [pointer, pointee] : pointees_) types.insert(pointee);
        for (const auto& [vector, component] : vectors_)
            if (types.count(component)) types.insert(vector);
        for (const uint32_t type : types)
            put(spirv_instruction(spv::OpTypePointer, {by_address_[type] = new_id(),
                                                       spv::StorageClassPhysicalStorageBuffer, type}));
    }

    void decorate_table() {
        put(spirv_instruction(spv::OpDecorate, {table_type_, spv::DecorationBlock}));
        put(spirv_instruction(spv::OpDecorate, {table_, spv::DecorationDescriptorSet, 0}));
        put(spirv_instruction(spv::OpDecorate, {table_, spv::DecorationBinding, binding_}));
        for (uint32_t i = 0; i < blocks_.size(); ++i) {
            put(spirv_instruction(spv::OpMemberDecorate, {table_type_, i, spv::DecorationOffset, 8 * i}));
            put(spirv_instruction(spv::OpMemberDecorate, {table_type_, i, spv::DecorationNonWritable}));
        }
    }

    // At the start of the kernel: every address once.
    void load_addresses() {
        for (size_t i = 0; i < blocks_.size(); ++i) {
            const uint32_t at = new_id(), address = new_id();
            put(spirv_instruction(spv::OpAccessChain, {table_pointer_, at, table_, indices_[i]}));
            put(spirv_instruction(spv::OpLoad, {uvec2_, address, at}));
            put(spirv_instruction(spv::OpStore, {blocks_[i].address, address}));
        }
    }

    // Accesses through an address state its alignment: that of the widest scalar.
    void align(SpirvWords& words, size_t mask_at) {
        if (words.size() <= mask_at) words.push_back(0);
        if (words[mask_at] & spv::MemoryAccessAlignedMask) return;
        words[mask_at] |= spv::MemoryAccessAlignedMask;
        words.insert(words.begin() + long(mask_at) + 1, has_wide_types_ ? 8 : 4);
    }

    void rewrite_access(SpirvWords& chain) {
        uint32_t type = 0;  // of what the chain starts at
        if (const Block* block = find_block(chain[3])) {
            const uint32_t address = new_id(), pointer = new_id();
            put(spirv_instruction(spv::OpLoad, {uvec2_, address, block->address}));
            put(spirv_instruction(spv::OpBitcast, {by_address_.at(block->type), pointer, address}));
            chain[3] = pointer;
            type = block->type;
        } else if (const auto from = addressed_.find(chain[3]); from != addressed_.end()) {
            type = from->second;
        } else {
            return;
        }
        const uint32_t pointee = pointees_.at(chain[1]);
        chain[1] = by_address_.at(pointee);
        addressed_[chain[2]] = pointee;
        if (const uint32_t vector = vector_of_component(chain, type)) components_[chain[2]] = {chain, vector};
    }

    // The type of the vector of which an access chain into `type` names a component; 0 where it names none.
    uint32_t vector_of_component(const SpirvWords& chain, uint32_t type) const {
        for (size_t i = 4; i < chain.size(); ++i) {
            if (vectors_.count(type)) return type;
            const auto members = struct_members_.find(type);
            type = members == struct_members_.end() ? elements_.at(type)
                                                    : members->second.at(constants_.at(chain[i]));
        }
        return 0;
    }

    // By way of the whole vector: for any component that is read by address Mesa 22.3 takes the first one,
    // where the vector has been read or written before.
    void load_component(const SpirvWords& load) {
        const Component& component = components_.at(load[3]);
        SpirvWords chain = component.access, whole = load;
        const uint32_t index = chain.back(), pointer = new_id(), vector = new_id();
        chain.pop_back();
        chain[1] = by_address_.at(component.vector);
        chain[2] = whole[3] = pointer;
        whole[1] = component.vector;
        whole[2] = vector;
        put(chain);
        put(whole);
        put(spirv_instruction(spv::OpVectorExtractDynamic, {load[1], load[2], vector, index}));
    }

    void rewrite(spv::Op op, SpirvWords& words) {
        // Variables of the function stand before all else in its first block.
        if (at_start_ && op != spv::OpVariable) {
            load_addresses();
            at_start_ = false;
        }
        switch (op) {
            case spv::OpMemoryModel:
                words[1] = spv::AddressingModelPhysicalStorageBuffer64;
                break;
            case spv::OpCapability:
                if (!has_capability_)
                    put(spirv_instruction(spv::OpCapability,
                                          {spv::CapabilityPhysicalStorageBufferAddresses}));
                has_capability_ = true;
                if (words[1] == spv::CapabilityPhysicalStorageBufferAddresses) return;
                break;
            case spv::OpEntryPoint:
                entry_ = words[2];
                words.erase(std::remove_if(words.begin() + 3, words.end(),
                                           [&](uint32_t id) { return find_block(id); }),
                            words.end());
                words.push_back(table_);
                for (const Block& block : blocks_) words.push_back(block.address);
                break;
            case spv::OpName:
            case spv::OpVariable:
                if (find_block(words[op == spv::OpName ? 1 : 2])) return;
                break;
            case spv::OpDecorate:
                if (!has_decorations_) decorate_table();
                has_decorations_ = true;
                if (find_block(words[1])) return;
                break;
            case spv::OpFunction:
                in_entry_ = words[2] == entry_;
                break;
            case spv::OpAccessChain:
            case spv::OpInBoundsAccessChain:
                rewrite_access(words);
                break;
            case spv::OpLoad:
                if (addressed_.count(words[3])) align(words, 4);
                if (components_.count(words[3])) return load_component(words);
                break;
            case spv::OpStore:
                if (addressed_.count(words[1])) align(words, 3);
                break;
            default:
                break;
        }
        put(words);
        if (op == spv::OpLabel && in_entry_) at_start_ = true, in_entry_ = false;
    }

    SpirvModule in_;
    std::vector<SpirvWords> out_;
    uint32_t bound_ = 0, binding_ = 0;
    std::set<uint32_t> run_time_arrays_;
    std::map<uint32_t, SpirvWords> struct_members_;
    std::map<uint32_t, uint32_t> elements_;   // of arrays and matrices: type -> type
    std::map<uint32_t, uint32_t> vectors_;    // type -> type of the components
    std::map<uint32_t, uint32_t> constants_;  // id -> value, its first word
    std::map<uint32_t, uint32_t> pointees_;   // of pointers to storage buffers
    std::map<uint32_t, uint32_t> bindings_;
    std::map<uint32_t, std::string> names_;
    bool has_wide_types_ = false;
    std::vector<Block> blocks_;
    uint32_t uint_ = 0, uvec2_ = 0, table_ = 0, table_type_ = 0, table_pointer_ = 0;
    std::vector<uint32_t> indices_;             // constants 0, 1, …
    std::map<uint32_t, uint32_t> by_address_;   // pointee -> pointer by address
    std::map<uint32_t, uint32_t> addressed_;    // pointers by address -> pointee
    std::map<uint32_t, Component> components_;  // such pointers to components
    uint32_t entry_ = 0;
    bool has_capability_ = false, has_decorations_ = false, in_entry_ = false, at_start_ = false;
};

}  // namespace

AddressedShader use_addresses(const Spirv& spirv) { return Rewriter(spirv).run(spirv); }

}  // namespace etendue
