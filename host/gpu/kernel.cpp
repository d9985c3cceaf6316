#include "host/gpu/kernel.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include "host/error.h"
#include "host/gpu/buffer_addresses.h"

namespace etendue {
namespace {

constexpr uint32_t max_timed_dispatches = 1024;  // a command list; later ones run untimed

constexpr uint64_t least_texel_bytes = 4;

VkFormat texel_format(uint32_t words) {
    return words == 4 ? VK_FORMAT_R32G32B32A32_UINT : words == 2 ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32_UINT;
}

}  // namespace

std::set<std::string> beyond_texels(const Device& device, const BufferTable& buffers) {
    std::set<std::string> names;
    for (const auto& [name, buffer] : buffers)
        if (buffer && buffer->bytes() / least_texel_bytes > device.description.max_texels) names.insert(name);
    return names;
}

Program::Program(Device& device, const CompiledShader& shader, const std::set<std::string>& not_texels)
    : device_(device),
      name_(shader.name),
      layout_(reflect_shader(shader.spirv)),
      spirv_bytes_(shader.spirv.size() * 4),
      file_(shader.file) {
    TexelShader texels{shader.spirv, {}};
    if (device.description.max_texels > 0)
        texels = use_texels(shader.spirv, not_texels, device.description.max_texel_buffers);
    texel_views_ = texels.views;
    const AddressedShader addressed = use_addresses(texels.spirv);
    addressed_blocks_ = addressed.blocks;
    address_binding_ = addressed.binding;
    std::set<uint32_t> bound;  // several blocks may be views of one binding
    for (const BlockLayout& block : layout_.blocks)
        if (std::find(addressed.blocks.begin(), addressed.blocks.end(), block.block_name) ==
                addressed.blocks.end() &&
            !has_texels(block.block_name))
            bound.insert(block.binding);
    if (!addressed.blocks.empty()) bound.insert(addressed.binding);
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const uint32_t binding : bound)
        bindings.push_back(
            {binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    for (const TexelShader::View& view : texel_views_)
        bindings.push_back(
            {view.binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set_info.bindingCount = uint32_t(bindings.size());
    set_info.pBindings = bindings.data();
    check(vkCreateDescriptorSetLayout(device.handle, &set_info, nullptr, &set_layout_),
          "vkCreateDescriptorSetLayout");

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, (layout_.push_constant_size + 3) / 4 * 4};
    VkPipelineLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout_info.setLayoutCount = 1;
    layout_info.pSetLayouts = &set_layout_;
    layout_info.pushConstantRangeCount = range.size ? 1 : 0;
    layout_info.pPushConstantRanges = &range;
    check(vkCreatePipelineLayout(device.handle, &layout_info, nullptr, &pipeline_layout_),
          "vkCreatePipelineLayout");

    VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module_info.codeSize = addressed.spirv.size() * 4;
    module_info.pCode = addressed.spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.handle, &module_info, nullptr, &module), "vkCreateShaderModule");
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = pipeline_layout_;
    const VkResult made =
        vkCreateComputePipelines(device.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
    vkDestroyShaderModule(device.handle, module, nullptr);
    check(made, "vkCreateComputePipelines");
    set_debug_name(device, VK_OBJECT_TYPE_PIPELINE, uint64_t(pipeline_), name_);
}

bool Program::has_texels(const std::string& block) const {
    return std::any_of(texel_views_.begin(), texel_views_.end(),
                       [&](auto& view) { return view.block == block; });
}

Program::~Program() {
    vkDestroyPipeline(device_.handle, pipeline_, nullptr);
    vkDestroyPipelineLayout(device_.handle, pipeline_layout_, nullptr);
    vkDestroyDescriptorSetLayout(device_.handle, set_layout_, nullptr);
}

Kernel::Kernel(Device& device, std::shared_ptr<const Program> program, const BufferTable& buffers)
    : device_(&device), program_(std::move(program)) {
    const std::vector<std::string>& addressed = program_->addressed_blocks_;
    std::vector<uint64_t> addresses(addressed.size());
    std::map<uint32_t, const Buffer*> bound, texels;
    for (const BlockLayout& block : layout().blocks) {
        const auto found = buffers.find(block.name);
        if (found == buffers.end())
            fail_device("kernel {} reads buffer {}, which the host does not bind", name(), block.name);
        if (program_->has_texels(block.block_name)) {
            for (const TexelShader::View& view : program_->texel_views_)
                if (view.block == block.block_name) texels[view.binding] = found->second;
            continue;
        }
        const auto place = std::find(addressed.begin(), addressed.end(), block.block_name);
        if (place != addressed.end()) {
            addresses[size_t(place - addressed.begin())] = found->second->address();
            continue;
        }
        if (found->second->bytes() > device.description.max_buffer_range)
            fail_device("{} needs {:.0f} MiB in one binding; this device allows {:.0f} MiB", block.name,
                        double(found->second->bytes()) / 1048576.0,
                        double(device.description.max_buffer_range) / 1048576.0);
        bound[block.binding] = found->second;
    }
    if (!addresses.empty()) {
        addresses_ = create_buffer(device, std::span<const uint64_t>(addresses), name() + " addresses");
        bound[program_->address_binding_] = &addresses_;
    }

    std::vector<VkDescriptorPoolSize> sizes{
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::max<uint32_t>(1, uint32_t(bound.size()))}};
    if (!texels.empty()) sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, uint32_t(texels.size())});
    VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = uint32_t(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    check(vkCreateDescriptorPool(device.handle, &pool_info, nullptr, &pool_), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo set_allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    set_allocation.descriptorPool = pool_;
    set_allocation.descriptorSetCount = 1;
    set_allocation.pSetLayouts = &program_->set_layout_;
    check(vkAllocateDescriptorSets(device.handle, &set_allocation, &set_), "vkAllocateDescriptorSets");
    for (const auto& [binding, buffer] : bound) {
        const VkDescriptorBufferInfo buffer_info{buffer->handle(), 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set_;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &buffer_info;
        vkUpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
    }
    for (const TexelShader::View& view : program_->texel_views_) bind_texels(view, *texels.at(view.binding));
}

void Kernel::bind_texels(const TexelShader::View& view, const Buffer& buffer) {
    if (buffer.bytes() / 4 / view.words > device_->description.max_texels)
        fail_device("{} needs {:.0f} MiB in one texel buffer; this device allows {:.0f} MiB", view.block,
                    double(buffer.bytes()) / 1048576.0,
                    double(device_->description.max_texels * 4 * view.words) / 1048576.0);
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer.handle();
    info.format = texel_format(view.words);
    info.range = buffer.bytes();
    VkBufferView made = VK_NULL_HANDLE;
    check(vkCreateBufferView(device_->handle, &info, nullptr, &made), "vkCreateBufferView");
    texel_views_.push_back(made);
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.dstBinding = view.binding;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    write.pTexelBufferView = &made;
    vkUpdateDescriptorSets(device_->handle, 1, &write, 0, nullptr);
}

Kernel::~Kernel() {
    if (pool_) vkDestroyDescriptorPool(device_->handle, pool_, nullptr);
    for (const VkBufferView view : texel_views_) vkDestroyBufferView(device_->handle, view, nullptr);
}

void Kernel::swap(Kernel& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(program_, other.program_);
    std::swap(addresses_, other.addresses_);
    std::swap(texel_views_, other.texel_views_);
    std::swap(pool_, other.pool_);
    std::swap(set_, other.set_);
}

CommandList::CommandList(Device& device) : device_(device) {
    if (device.timestamp_period == 0) return;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2 * max_timed_dispatches;
    check(vkCreateQueryPool(device.handle, &info, nullptr, &queries_), "vkCreateQueryPool");
}

CommandList::~CommandList() {
    if (commands_) vkFreeCommandBuffers(device_.handle, device_.command_pool, 1, &commands_);
    if (queries_) vkDestroyQueryPool(device_.handle, queries_, nullptr);
}

void CommandList::begin() {
    if (commands_) return;
    commands_ = begin_commands(device_);
    timed_.clear();
    if (queries_) vkCmdResetQueryPool(commands_, queries_, 0, 2 * max_timed_dispatches);
}

void CommandList::barrier() {
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                           VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
    const auto stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(commands_, stages, stages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, 0, 1, &memory, 0,
                         nullptr, 0, nullptr);
}

void CommandList::stamp(VkPipelineStageFlagBits stage) {
    if (!queries_ || timed_.size() > max_timed_dispatches) return;
    const uint32_t pair = uint32_t(timed_.size()) - 1;
    vkCmdWriteTimestamp(commands_, stage, queries_,
                        2 * pair + (stage == VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT));
}

void CommandList::prepare(const Kernel& kernel, const std::vector<PushValue>& values) {
    begin();
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.program_->pipeline_);
    vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.program_->pipeline_layout_, 0,
                            1, &kernel.set_, 0, nullptr);
    if (const uint32_t size = (kernel.layout().push_constant_size + 3) / 4 * 4) {
        std::vector<uint32_t> words(size / 4, 0u);
        for (const PushValue& value : values) {
            const auto& members = kernel.layout().push_constants;
            const auto member =
                std::find_if(members.begin(), members.end(), [&](auto& m) { return m.name == value.name; });
            if (member != members.end()) words[member->offset / 4] = value.bits;
        }
        vkCmdPushConstants(commands_, kernel.program_->pipeline_layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, size,
                           words.data());
    }
    timed_.push_back(kernel.name());
    stamp(VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT);
}

void CommandList::dispatch(const Kernel& kernel, uint32_t groups, const std::vector<PushValue>& values) {
    prepare(kernel, values);
    vkCmdDispatch(commands_, groups, 1, 1);
    stamp(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT);
    barrier();
}

void CommandList::dispatch_indirect(const Kernel& kernel, const Buffer& arguments, uint64_t offset,
                                    const std::vector<PushValue>& values) {
    prepare(kernel, values);
    vkCmdDispatchIndirect(commands_, arguments.handle(), offset);
    stamp(VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT);
    barrier();
}

void CommandList::fill(const Buffer& buffer, uint32_t word, uint64_t offset, uint64_t bytes) {
    begin();
    vkCmdFillBuffer(commands_, buffer.handle(), offset, bytes, word);
    barrier();
}

void CommandList::run(KernelTimings* timings) {
    if (!commands_) return;
    submit_and_wait(device_, std::exchange(commands_, nullptr));
    if (!timings) return;
    const uint32_t count = std::min<uint32_t>(uint32_t(timed_.size()), max_timed_dispatches);
    std::vector<uint64_t> ticks(2 * count);
    if (queries_ && count)
        check(vkGetQueryPoolResults(device_.handle, queries_, 0, 2 * count, ticks.size() * 8, ticks.data(), 8,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "vkGetQueryPoolResults");
    for (uint32_t i = 0; i < timed_.size(); ++i) {
        KernelTiming& timing = (*timings)[timed_[i]];
        ++timing.dispatches;
        if (i < count && queries_)
            timing.seconds += double(ticks[2 * i + 1] - ticks[2 * i]) * device_.timestamp_period * 1e-9;
    }
}

}  // namespace etendue
