// The Vulkan device: instance, choice of physical device, required features, one compute queue.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/error.h"

namespace etendue {

class ProgramStore;

// What `etendue devices` prints of one physical device.
struct DeviceDescription {
    uint32_t index = 0;
    std::string name, driver;  // driver: name, version and information as the driver gives them
    std::string type;          // discrete GPU, integrated GPU, virtual GPU, CPU, other
    uint32_t api_version = 0;
    uint32_t subgroup_size = 0;
    uint64_t max_buffer_range = 0;  // bytes of one storage buffer binding
    uint64_t max_allocation = 0;    // bytes
    // Of one texel buffer, and how many a kernel may have; 0 where reading storage buffers is as fast
    // (host/gpu/texel_reads.h).
    uint64_t max_texels = 0;
    uint32_t max_texel_buffers = 0;
    // Straight code of many choices compiles (host/geometry/unrolled_traversal.h): SwiftShader takes minutes
    // and all memory.
    bool compiles_choices = true;
    uint64_t memory = 0;          // bytes of the largest device-local heap
    uint32_t max_loop_turns = 0;  // host/gpu/loop_turns.h; 0 = no end. Known of a device that was created
    std::vector<std::string> missing;  // what étendue needs and the device lacks; empty = usable
};

struct DeviceOptions {
    std::string selector;  // index, or part of the name; empty = the default device
    // Khronos validation layer; its messages are collected in Device::validation_messages. The environment
    // variable ETENDUE_VALIDATION turns it on for any program, which then prints them at its end.
    bool validation = false;
    // For a device that shows pictures in windows: the instance extensions that the window system wants.
    // Where there are any, the device must draw and have swapchains, too.
    std::vector<const char*> window_extensions;
};

struct Device {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queue_family = 0;
    VkCommandPool command_pool = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_properties{};
    DeviceDescription description;
    double timestamp_period = 0;  // nanoseconds a tick; 0 = no timestamps
    bool debug_names = false;
    uint64_t bytes_allocated = 0, peak_bytes_allocated = 0;
    std::vector<std::string> validation_messages;
    bool print_validation = false;
    std::unique_ptr<ProgramStore> programs;  // compiled for the device

    Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device();
};

// The default is the first discrete GPU, then an integrated or virtual one, then a CPU implementation; of
// equals the first that Vulkan lists. Errors (exit code 3): no Vulkan, no device, none usable (with what it
// lacks), selector that matches none (lists the devices).
std::unique_ptr<Device> create_device(const DeviceOptions& options = {});

std::vector<DeviceDescription> list_devices();
// Index into list_devices() of the one that create_device chooses by default; -1 where none is usable.
int default_device(const std::vector<DeviceDescription>& devices);

// The device, or the surface that it shows pictures on: all that was made for it is gone, another may do.
struct DeviceLost : Error {
    using Error::Error;
};

// Fails with exit code 3 and one line that names the call; out-of-memory results say so. DeviceLost where the
// device or its surface was lost.
void check(VkResult result, const char* call);

void set_debug_name(const Device& device, VkObjectType type, uint64_t handle, const std::string& name);

}  // namespace etendue
