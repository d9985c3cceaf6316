#include "host/gpu/device.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "host/error.h"
#include "host/gpu/loop_turns.h"
#include "host/gpu/program_store.h"

namespace etendue {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

// Everything that the shaders rely on, asked for in one chain and enabled by the same chain.
struct Features {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES};
    VkPhysicalDeviceBufferDeviceAddressFeatures address{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES};
    Features() {
        core.pNext = &scalar;
        scalar.pNext = &address;
    }
    Features(const Features&) = delete;
};

VKAPI_ATTR VkBool32 VKAPI_CALL on_validation_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                     void* device) {
    static_cast<Device*>(device)->validation_messages.emplace_back(data->pMessage);
    return VK_FALSE;
}

bool has_layer(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [&](auto& l) { return !std::strcmp(l.layerName, name); });
}

bool has_instance_extension(const char* name) {
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](auto& e) { return !std::strcmp(e.extensionName, name); });
}

VkInstance create_instance(bool validation, bool debug_utils, std::vector<const char*> extensions = {}) {
    // Mesa's shader cache does not tell kernels of different vector widths apart: a folder for each.
    if (const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH"))
        if (const char* home = std::getenv("HOME"))
            setenv("MESA_SHADER_CACHE_DIR", fmt::format("{}/.cache/etendue/mesa-{}", home, width).c_str(), 0);
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "etendue";
    application.apiVersion = VK_API_VERSION_1_2;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (validation) info.enabledLayerCount = 1, info.ppEnabledLayerNames = &validation_layer;
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        fail_device("no Vulkan driver found; install one (on Debian: mesa-vulkan-drivers)");
    check(result, "vkCreateInstance");
    return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    return devices;
}

bool has_device_extension(VkPhysicalDevice device, const char* name) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](auto& e) { return !std::strcmp(e.extensionName, name); });
}

// The first queue family with all those flags; -1 where there is none.
int find_family(VkPhysicalDevice device, VkQueueFlags flags, uint32_t* timestamp_bits = nullptr) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & flags) == flags) {
            if (timestamp_bits) *timestamp_bits = families[i].timestampValidBits;
            return int(i);
        }
    return -1;
}

const char* type_name(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return "discrete GPU";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return "integrated GPU";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return "virtual GPU";
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return "CPU";
        default:
            return "other";
    }
}

VkQueueFlags queue_flags(bool for_windows) {
    return VK_QUEUE_COMPUTE_BIT | (for_windows ? VK_QUEUE_GRAPHICS_BIT : 0);
}

// Than storage buffers (host/gpu/texel_reads.h)? Lavapipe compiles the fetch of a texel once for all kernels
// since Mesa 23.3; with AVX-512 it gathers from storage buffers by one instruction. ETENDUE_READS=texels or
// =addresses decides for whoever measures.
bool reads_texels_faster(const VkPhysicalDeviceDriverProperties& driver, uint32_t version) {
    if (const char* reads = std::getenv("ETENDUE_READS")) return std::string_view(reads) == "texels";
    if (driver.driverID != VK_DRIVER_ID_MESA_LLVMPIPE || version < VK_MAKE_VERSION(24, 0, 0)) return false;
#if defined(__x86_64__) || defined(__i386__)
    return !__builtin_cpu_supports("avx512f");
#else
    return true;
#endif
}

DeviceDescription describe(VkPhysicalDevice device, uint32_t index, bool for_windows) {
    DeviceDescription d;
    d.index = index;
    VkPhysicalDeviceMaintenance3Properties maintenance{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                            &maintenance};
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
                                                &driver};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup};
    vkGetPhysicalDeviceProperties2(device, &properties);
    const VkPhysicalDeviceProperties& p = properties.properties;
    d.name = p.deviceName;
    d.api_version = p.apiVersion;
    d.type = type_name(p.deviceType);
    d.driver = driver.driverName;
    if (driver.driverInfo[0]) d.driver += fmt::format(" {}", driver.driverInfo);
    d.subgroup_size = subgroup.subgroupSize;
    d.max_buffer_range = p.limits.maxStorageBufferRange;
    d.max_allocation = maintenance.maxMemoryAllocationSize;
    d.compiles_choices = driver.driverID != VK_DRIVER_ID_GOOGLE_SWIFTSHADER;
    if (reads_texels_faster(driver, p.driverVersion)) {
        d.max_texels = p.limits.maxTexelBufferElements;
        d.max_texel_buffers = p.limits.maxPerStageDescriptorSampledImages;
    }
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
            d.memory = std::max<uint64_t>(d.memory, memory.memoryHeaps[i].size);

    if (p.apiVersion < VK_API_VERSION_1_2) {
        d.missing.push_back("Vulkan 1.2");
        return d;
    }
    Features features;
    vkGetPhysicalDeviceFeatures2(device, &features.core);
    if (!features.scalar.scalarBlockLayout) d.missing.push_back("scalarBlockLayout");
    if (!features.address.bufferDeviceAddress) d.missing.push_back("bufferDeviceAddress");
    if (find_family(device, queue_flags(false)) < 0) d.missing.push_back("a compute queue");
    if (for_windows && find_family(device, queue_flags(true)) < 0)
        d.missing.push_back("a queue that draws and computes");
    if (for_windows && !has_device_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
        d.missing.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    const auto operations = VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                            VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BASIC_BIT;
    if ((subgroup.supportedOperations & operations) != operations)
        d.missing.push_back("subgroup ballot, vote and arithmetic");
    return d;
}

std::vector<DeviceDescription> describe_all(VkInstance instance, bool for_windows = false) {
    std::vector<DeviceDescription> result;
    for (VkPhysicalDevice device : physical_devices(instance))
        result.push_back(describe(device, uint32_t(result.size()), for_windows));
    return result;
}

uint32_t choose(const std::vector<DeviceDescription>& devices, const std::string& selector) {
    if (devices.empty())
        fail_device("no Vulkan device found; install a driver (on Debian: mesa-vulkan-drivers)");
    std::string known;
    for (const auto& d : devices)
        known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", d.index, d.name);
    int chosen = -1;
    if (selector.empty()) {
        chosen = default_device(devices);
        if (chosen < 0)
            fail_device("no usable Vulkan device: {} lacks {}", devices[0].name,
                        fmt::join(devices[0].missing, ", "));
    } else {
        for (const auto& d : devices)
            if (selector == std::to_string(d.index) ||
                (chosen < 0 && d.name.find(selector) != std::string::npos))
                chosen = int(d.index);
        if (chosen < 0) fail_device("--device {}: no such device; there are: {}", selector, known);
        if (!devices[chosen].missing.empty())
            fail_device("--device {}: {} lacks {}", selector, devices[chosen].name,
                        fmt::join(devices[chosen].missing, ", "));
    }
    return uint32_t(chosen);
}

}  // namespace

void check(VkResult result, const char* call) {
    switch (result) {
        case VK_SUCCESS:
            return;
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            fail_device("out of memory ({})", call);
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            fail_device("out of device memory ({})", call);
        case VK_ERROR_DEVICE_LOST:
            throw DeviceLost(ExitCode::device_failed, fmt::format("the device was lost ({})", call));
        case VK_ERROR_SURFACE_LOST_KHR:
            throw DeviceLost(ExitCode::device_failed,
                             fmt::format("the window's surface was lost ({})", call));
        default:
            fail_device("{} failed with VkResult {}", call, int(result));
    }
}

int default_device(const std::vector<DeviceDescription>& devices) {
    for (const char* type : {"discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"})
        for (const auto& d : devices)
            if (d.type == type && d.missing.empty()) return int(d.index);
    return -1;
}

std::vector<DeviceDescription> list_devices() {
    VkInstance instance = create_instance(false, false);
    auto result = describe_all(instance);
    vkDestroyInstance(instance, nullptr);
    return result;
}

std::unique_ptr<Device> create_device(const DeviceOptions& given) {
    auto device = std::make_unique<Device>();
    DeviceOptions options = given;
    if (std::getenv("ETENDUE_VALIDATION")) options.validation = device->print_validation = true;
    if (options.validation && !has_layer(validation_layer))
        fail_device("the validation layer {} is not installed", validation_layer);
    device->debug_names = options.validation && has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const bool for_windows = !options.window_extensions.empty();
    for (const char* extension : options.window_extensions)
        if (!has_instance_extension(extension))
            fail_device("the Vulkan driver lacks {}, which the window needs", extension);
    device->instance = create_instance(options.validation, device->debug_names, options.window_extensions);
    if (options.validation) {
        VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
        info.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        info.pfnUserCallback = on_validation_message;
        info.pUserData = device.get();
        auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(device->instance, "vkCreateDebugUtilsMessengerEXT"));
        check(create(device->instance, &info, nullptr, &device->messenger), "vkCreateDebugUtilsMessengerEXT");
    }

    const uint32_t chosen = choose(describe_all(device->instance, for_windows), options.selector);
    device->physical = physical_devices(device->instance)[chosen];
    device->description = describe(device->physical, chosen, for_windows);
    vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory_properties);
    uint32_t timestamp_bits = 0;
    device->queue_family = uint32_t(find_family(device->physical, queue_flags(for_windows), &timestamp_bits));
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device->physical, &properties);
    if (timestamp_bits) device->timestamp_period = properties.limits.timestampPeriod;

    Features features;
    features.scalar.scalarBlockLayout = VK_TRUE;
    features.address.bufferDeviceAddress = VK_TRUE;
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = device->queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    if (for_windows) info.enabledExtensionCount = 1, info.ppEnabledExtensionNames = &swapchain;
    check(vkCreateDevice(device->physical, &info, nullptr, &device->handle), "vkCreateDevice");
    vkGetDeviceQueue(device->handle, device->queue_family, 0, &device->queue);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = device->queue_family;
    check(vkCreateCommandPool(device->handle, &pool, nullptr, &device->command_pool), "vkCreateCommandPool");
    device->description.max_loop_turns = find_max_loop_turns(*device);
    return device;
}

Device::Device() : programs(std::make_unique<ProgramStore>()) {}

Device::~Device() {
    programs.reset();
    if (print_validation)
        for (const std::string& message : validation_messages)
            fmt::print(stderr, "validation: {}\n", message);
    if (handle) {
        vkDeviceWaitIdle(handle);
        if (command_pool) vkDestroyCommandPool(handle, command_pool, nullptr);
        vkDestroyDevice(handle, nullptr);
    }
    if (messenger) {
        auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger, nullptr);
    }
    if (instance) vkDestroyInstance(instance, nullptr);
}

void set_debug_name(const Device& device, VkObjectType type, uint64_t handle, const std::string& name) {
    if (!device.debug_names) return;
    auto set = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetDeviceProcAddr(device.handle, "vkSetDebugUtilsObjectNameEXT"));
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    if (set) set(device.handle, &info);
}

}  // namespace etendue
