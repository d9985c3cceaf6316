#include "host/gpu/buffer.h"

#include <algorithm>
#include <utility>

#include "host/error.h"

namespace etendue {
namespace {

constexpr uint64_t staging_bytes = 16 << 20;

int find_memory_type(const Device& device, uint32_t allowed, VkMemoryPropertyFlags wanted) {
    for (uint32_t i = 0; i < device.memory_properties.memoryTypeCount; ++i)
        if ((allowed >> i & 1) && (device.memory_properties.memoryTypes[i].propertyFlags & wanted) == wanted)
            return int(i);
    return -1;
}

// Host-visible device memory is used for everything only where all device memory is host-visible (CPU,
// integrated GPUs, resizable BAR); a small visible window would run out.
bool all_memory_visible(const Device& device) {
    const auto& p = device.memory_properties;
    for (uint32_t i = 0; i < p.memoryTypeCount; ++i) {
        const auto flags = p.memoryTypes[i].propertyFlags;
        const bool both =
            (flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) && (flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT);
        if (both && p.memoryHeaps[p.memoryTypes[i].heapIndex].size >= device.description.memory) return true;
    }
    return false;
}

struct Allocation {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t bytes = 0;
    bool visible = false;
};

Allocation allocate(Device& device, uint64_t bytes, VkBufferUsageFlags usage, bool host_visible,
                    const std::string& name) {
    Allocation result;
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage;
    check(vkCreateBuffer(device.handle, &info, nullptr, &result.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle, result.buffer, &needs);
    const VkMemoryPropertyFlags visible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    if (host_visible) wanted = visible;
    if (!host_visible && all_memory_visible(device)) wanted |= visible;
    int type = find_memory_type(device, needs.memoryTypeBits, wanted);
    if (type < 0) type = find_memory_type(device, needs.memoryTypeBits, 0);
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    if (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT)
        flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = uint32_t(type);
    VkResult made = needs.size > device.description.max_allocation
                        ? VK_ERROR_OUT_OF_DEVICE_MEMORY
                        : vkAllocateMemory(device.handle, &allocation, nullptr, &result.memory);
    if (made != VK_SUCCESS) {
        vkDestroyBuffer(device.handle, result.buffer, nullptr);
        fail_device("out of device memory: {} needs {:.1f} MiB beside the {:.1f} MiB in use", name,
                    double(needs.size) / 1048576.0, double(device.bytes_allocated) / 1048576.0);
    }
    check(vkBindBufferMemory(device.handle, result.buffer, result.memory, 0), "vkBindBufferMemory");
    result.bytes = needs.size;
    result.visible =
        device.memory_properties.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    return result;
}

// Copies through host-visible memory in pieces: for device memory that the host cannot see.
template <class Copy>
void through_staging(Device& device, uint64_t bytes, Copy&& copy) {
    const auto usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Allocation staging = allocate(device, std::min(bytes, staging_bytes), usage, true, "staging");
    void* mapped = nullptr;
    check(vkMapMemory(device.handle, staging.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    for (uint64_t done = 0; done < bytes; done += staging_bytes)
        copy(staging.buffer, mapped, done, std::min(staging_bytes, bytes - done));
    vkDestroyBuffer(device.handle, staging.buffer, nullptr);
    vkFreeMemory(device.handle, staging.memory, nullptr);
}

void copy_buffer(Device& device, VkBuffer from, uint64_t from_offset, VkBuffer to, uint64_t to_offset,
                 uint64_t bytes) {
    VkCommandBuffer commands = begin_commands(device);
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(commands, from, to, 1, &region);
    submit_and_wait(device, commands);
}

}  // namespace

Buffer::Buffer(Device& device, uint64_t bytes, std::string name)
    : device_(&device), bytes_(std::max<uint64_t>((bytes + 15) / 16 * 16, 16)), name_(std::move(name)) {
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                               VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    if (device.description.max_texels > 0) usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    const Allocation made = allocate(device, bytes_, usage, false, name_);
    buffer_ = made.buffer;
    memory_ = made.memory;
    allocated_ = made.bytes;
    device.bytes_allocated += allocated_;
    device.peak_bytes_allocated = std::max(device.peak_bytes_allocated, device.bytes_allocated);
    if (made.visible)
        check(vkMapMemory(device.handle, memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
    set_debug_name(device, VK_OBJECT_TYPE_BUFFER, uint64_t(buffer_), name_);
}

Buffer::~Buffer() {
    if (!buffer_) return;
    device_->bytes_allocated -= allocated_;
    vkDestroyBuffer(device_->handle, buffer_, nullptr);
    vkFreeMemory(device_->handle, memory_, nullptr);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    std::swap(allocated_, other.allocated_);
    std::swap(mapped_, other.mapped_);
    std::swap(name_, other.name_);
}

void Buffer::write(const void* data, uint64_t bytes, uint64_t offset) {
    if (mapped_) {
        std::memcpy(static_cast<char*>(mapped_) + offset, data, bytes);
        return;
    }
    through_staging(*device_, bytes, [&](VkBuffer staging, void* mapped, uint64_t done, uint64_t piece) {
        std::memcpy(mapped, static_cast<const char*>(data) + done, piece);
        copy_buffer(*device_, staging, 0, buffer_, offset + done, piece);
    });
}

void Buffer::read(void* data, uint64_t bytes, uint64_t offset) const {
    if (mapped_) {
        std::memcpy(data, static_cast<const char*>(mapped_) + offset, bytes);
        return;
    }
    through_staging(*device_, bytes, [&](VkBuffer staging, void* mapped, uint64_t done, uint64_t piece) {
        copy_buffer(*device_, buffer_, offset + done, staging, 0, piece);
        std::memcpy(static_cast<char*>(data) + done, mapped, piece);
    });
}

void Buffer::fill(uint32_t word, uint64_t bytes) {
    VkCommandBuffer commands = begin_commands(*device_);
    vkCmdFillBuffer(commands, buffer_, 0, bytes, word);
    submit_and_wait(*device_, commands);
}

uint64_t Buffer::address() const {
    VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    info.buffer = buffer_;
    return vkGetBufferDeviceAddress(device_->handle, &info);
}

VkCommandBuffer begin_commands(Device& device) {
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = device.command_pool;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device.handle, &info, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    return commands;
}

void submit_and_wait(Device& device, VkCommandBuffer commands) {
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(device.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(device.queue), "vkQueueWaitIdle");
    vkFreeCommandBuffers(device.handle, device.command_pool, 1, &commands);
}

}  // namespace etendue
