// Device memory: one storage buffer each, written and read by the host through plain calls.
#pragma once
#include <vulkan/vulkan.h>

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "host/gpu/device.h"

namespace etendue {

// Usable as storage buffer, by address, as transfer source and target and for indirect dispatch. Owns its
// memory; movable. Must not outlive its device.
class Buffer {
  public:
    Buffer() = default;
    Buffer(Device& device, uint64_t bytes,
           std::string name);  // contents undefined; at least 16 bytes are allocated
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer();

    void write(const void* data, uint64_t bytes, uint64_t offset = 0);
    void read(void* data, uint64_t bytes, uint64_t offset = 0) const;
    // The first `bytes`, a multiple of 4.
    void fill(uint32_t word, uint64_t bytes = VK_WHOLE_SIZE);

    template <class T>
    std::vector<T> read_array(uint64_t count, uint64_t first = 0) const {
        std::vector<T> result(count);
        read(result.data(), count * sizeof(T), first * sizeof(T));
        return result;
    }

    VkBuffer handle() const { return buffer_; }
    uint64_t bytes() const { return bytes_; }
    uint64_t address() const;  // buffer_device_address
    const std::string& name() const { return name_; }
    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

  private:
    void swap(Buffer& other) noexcept;
    Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t bytes_ = 0, allocated_ = 0;
    void* mapped_ =
        nullptr;  // null where the host cannot see the memory: then transfers go through a staging buffer
    std::string name_;
};

template <class T>
Buffer create_buffer(Device& device, std::span<const T> data, std::string name) {
    Buffer buffer(device, data.size_bytes(), std::move(name));
    const uint32_t zeros[4] = {};
    buffer.write(zeros, sizeof zeros,
                 buffer.bytes() - sizeof zeros);  // behind the data, up to the rounded size
    if (!data.empty()) buffer.write(data.data(), data.size_bytes());
    return buffer;
}
template <class T>
Buffer create_buffer(Device& device, const std::vector<T>& data, std::string name) {
    return create_buffer(device, std::span<const T>(data), std::move(name));
}

VkCommandBuffer begin_commands(Device& device);
void submit_and_wait(Device& device, VkCommandBuffer commands);  // frees the command buffer

}  // namespace etendue
