#include "host/gpu/buffer_addresses.h"

#include <algorithm>
#include <map>
#include <set>

#include "host/gpu/spirv_declarations.h"

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
    explicit Rewriter(const Spirv& spirv)
        : in_(split_spirv(spirv)), out_{in_.header, {}}, declared_(read_declarations(in_)) {
        for (const auto& [id, type] : declared_.types)
            if ((type.op == spv::OpTypeInt || type.op == spv::OpTypeFloat) && type.operands[0] == 64)
                alignment_ = 8;
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
        result.spirv = join_spirv(out_);
        return result;
    }

  private:
    // Variables of blocks that end in a run-time array and are used by access chains alone.
    void find_blocks() {
        for (const StorageBlock& block : find_storage_blocks(declared_))
            if (block.array) blocks_.push_back({block.variable, block.type, 0, block.name});
        const auto is_used_otherwise = [&](const Block& block) {
            return std::any_of(in_.instructions.begin(), in_.instructions.end(), [&](const SpirvWords& w) {
                return (w[0] == spv::OpArrayLength || w[0] == spv::OpFunctionCall ||
                        w[0] == spv::OpCopyObject) &&
                       std::find(w.begin() + 3, w.end(), block.variable) != w.end();
            });
        };
        blocks_.erase(std::remove_if(blocks_.begin(), blocks_.end(), is_used_otherwise), blocks_.end());
        binding_ = declared_.free_binding();
        for (Block& block : blocks_) block.address = out_.new_id();
        if (!blocks_.empty()) table_ = out_.new_id(), table_type_ = out_.new_id();
    }

    const Block* find_block(uint32_t variable) const {
        const auto found =
            std::find_if(blocks_.begin(), blocks_.end(), [&](auto& b) { return b.variable == variable; });
        return found == blocks_.end() ? nullptr : &*found;
    }

    // The table of addresses, the variables that keep them, and pointer types, behind all other declarations.
    void declare() {
        uint_ = declared_.find_type(spv::OpTypeInt, {32, 0});
        if (!uint_) out_.put(spv::OpTypeInt, {uint_ = out_.new_id(), 32, 0});
        uvec2_ = declared_.find_type(spv::OpTypeVector, {uint_, 2});
        if (!uvec2_) out_.put(spv::OpTypeVector, {uvec2_ = out_.new_id(), uint_, 2});
        out_.put(spv::OpTypeStruct, {table_type_});
        out_.instructions.back().insert(out_.instructions.back().end(), blocks_.size(), uvec2_);
        const uint32_t to_table = out_.new_id(), to_address = out_.new_id();
        out_.put(spv::OpTypePointer, {to_table, spv::StorageClassStorageBuffer, table_type_});
        out_.put(spv::OpVariable, {to_table, table_, spv::StorageClassStorageBuffer});
        out_.put(spv::OpTypePointer,
                 {table_pointer_ = out_.new_id(), spv::StorageClassStorageBuffer, uvec2_});
        out_.put(spv::OpTypePointer, {to_address, spv::StorageClassPrivate, uvec2_});
        for (uint32_t i = 0; i < blocks_.size(); ++i) {
            out_.put(spv::OpVariable, {to_address, blocks_[i].address, spv::StorageClassPrivate});
            indices_.push_back(out_.new_id());
            out_.put(spv::OpConstant, {uint_, indices_[i], i});
        }
        // Of every type that a pointer into a block may have; few are used, which costs nothing.
        std::set<uint32_t> pointees;
        for (const auto& [pointer, type] : declared_.types)
            if (type.op == spv::OpTypePointer && type.operands[0] == spv::StorageClassStorageBuffer)
                pointees.insert(type.operands[1]);
        for (const auto& [vector, type] : declared_.types)
            if (type.op == spv::OpTypeVector && pointees.count(type.operands[0])) pointees.insert(vector);
        for (const uint32_t pointee : pointees)
            out_.put(spv::OpTypePointer,
                     {by_address_[pointee] = out_.new_id(), spv::StorageClassPhysicalStorageBuffer, pointee});
    }

    void decorate_table() {
        out_.put(spv::OpDecorate, {table_type_, spv::DecorationBlock});
        out_.put(spv::OpDecorate, {table_, spv::DecorationDescriptorSet, 0});
        out_.put(spv::OpDecorate, {table_, spv::DecorationBinding, binding_});
        for (uint32_t i = 0; i < blocks_.size(); ++i) {
            out_.put(spv::OpMemberDecorate, {table_type_, i, spv::DecorationOffset, 8 * i});
            out_.put(spv::OpMemberDecorate, {table_type_, i, spv::DecorationNonWritable});
        }
    }

    // At the start of the kernel: every address once.
    void load_addresses() {
        for (size_t i = 0; i < blocks_.size(); ++i) {
            const uint32_t at = out_.new_id(), address = out_.new_id();
            out_.put(spv::OpAccessChain, {table_pointer_, at, table_, indices_[i]});
            out_.put(spv::OpLoad, {uvec2_, address, at});
            out_.put(spv::OpStore, {blocks_[i].address, address});
        }
    }

    // Accesses through an address state its alignment.
    void align(SpirvWords& words, size_t mask_at) {
        if (words.size() <= mask_at) words.push_back(0);
        if (words[mask_at] & spv::MemoryAccessAlignedMask) return;
        words[mask_at] |= spv::MemoryAccessAlignedMask;
        words.insert(words.begin() + long(mask_at) + 1, alignment_);
    }

    void rewrite_access(SpirvWords& chain) {
        uint32_t type = 0;  // of what the chain starts at
        if (const Block* block = find_block(chain[3])) {
            const uint32_t address = out_.new_id(), pointer = out_.new_id();
            out_.put(spv::OpLoad, {uvec2_, address, block->address});
            out_.put(spv::OpBitcast, {by_address_.at(block->type), pointer, address});
            chain[3] = pointer;
            type = block->type;
        } else if (const auto from = addressed_.find(chain[3]); from != addressed_.end()) {
            type = from->second;
        } else {
            return;
        }
        const uint32_t pointee = declared_.types.at(chain[1]).operands[1];
        chain[1] = by_address_.at(pointee);
        addressed_[chain[2]] = pointee;
        if (const uint32_t vector = vector_of_component(chain, type)) components_[chain[2]] = {chain, vector};
    }

    // The type of the vector of which an access chain into `type` names a component; 0 where it names none.
    uint32_t vector_of_component(const SpirvWords& chain, uint32_t type) const {
        for (size_t i = 4; i < chain.size(); ++i) {
            const SpirvType& t = declared_.types.at(type);
            if (t.op == spv::OpTypeVector) return type;
            type =
                t.op == spv::OpTypeStruct ? t.operands.at(declared_.constants.at(chain[i])) : t.operands[0];
        }
        return 0;
    }

    // By way of the whole vector: for any component that is read by address Mesa 22.3 takes the first one,
    // where the vector has been read or written before.
    void load_component(const SpirvWords& load) {
        const Component& component = components_.at(load[3]);
        SpirvWords chain = component.access, whole = load;
        const uint32_t index = chain.back(), pointer = out_.new_id(), vector = out_.new_id();
        chain.pop_back();
        chain[1] = by_address_.at(component.vector);
        chain[2] = whole[3] = pointer;
        whole[1] = component.vector;
        whole[2] = vector;
        out_.instructions.push_back(chain);
        out_.instructions.push_back(whole);
        out_.put(spv::OpVectorExtractDynamic, {load[1], load[2], vector, index});
    }

    void rewrite(spv::Op op, SpirvWords& words) {
        // Variables of the function stand before all else in its first block.
        if (at_start_ && op != spv::OpVariable) load_addresses(), at_start_ = false;
        switch (op) {
            case spv::OpMemoryModel:
                words[1] = spv::AddressingModelPhysicalStorageBuffer64;
                break;
            case spv::OpCapability:
                if (!has_capability_)
                    out_.put(spv::OpCapability, {spv::CapabilityPhysicalStorageBufferAddresses});
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
        out_.instructions.push_back(words);
        if (op == spv::OpLabel && in_entry_) at_start_ = true, in_entry_ = false;
    }

    SpirvModule in_, out_;
    SpirvDeclarations declared_;
    std::vector<Block> blocks_;
    uint32_t binding_ = 0;    // of the table
    uint32_t alignment_ = 4;  // of the widest scalar
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
