// Preloaded into the program, in front of the Vulkan loader: calls fail as a file says, as on a driver whose
// device or surface is lost. faults.txt in the current folder is read whenever it appears, and then removed:
//     window|renderer CALL VkResult COUNT
// The next COUNT calls of that name return that result in the place of what they do: those of the main
// thread, on which the window draws, or those of others. A device that was lost stays so until it is
// destroyed.
#include <dlfcn.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstring>
#include <mutex>

namespace {

struct Fault {
    char call[64] = "";
    int result = 0, count = 0;
    bool is_lost = false;
};
std::mutex mutex;
Fault faults[2];  // of the renderer, of the window

void read_faults() {
    if (rename("faults.txt", "faults.read") != 0) return;
    FILE* file = fopen("faults.read", "r");
    if (!file) return;
    char side[16];
    Fault fault;
    if (fscanf(file, "%15s %63s %d %d", side, fault.call, &fault.result, &fault.count) == 4)
        faults[strcmp(side, "window") == 0] = fault;
    fclose(file);
}

// What the call returns instead; VK_SUCCESS = nothing.
VkResult fault_of(const char* call) {
    const std::lock_guard lock(mutex);
    read_faults();
    Fault& fault = faults[gettid() == getpid()];
    if (fault.is_lost) return VK_ERROR_DEVICE_LOST;
    if (fault.count == 0 || strcmp(call, fault.call) != 0) return VK_SUCCESS;
    --fault.count;
    fault.is_lost = fault.result == VK_ERROR_DEVICE_LOST;
    return VkResult(fault.result);
}

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define NEXT(name) next<PFN_##name>(#name)

extern "C" {

VkResult vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence) {
    const VkResult fault = fault_of("vkQueueSubmit");
    return fault ? fault : NEXT(vkQueueSubmit)(queue, count, submits, fence);
}

VkResult vkQueueWaitIdle(VkQueue queue) {
    const VkResult fault = fault_of("vkQueueWaitIdle"), result = NEXT(vkQueueWaitIdle)(queue);
    return fault ? fault : result;
}

VkResult vkWaitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all,
                         uint64_t wait) {
    const VkResult fault = fault_of("vkWaitForFences");
    return fault ? fault : NEXT(vkWaitForFences)(device, count, fences, all, wait);
}

VkResult vkAcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain, uint64_t wait,
                               VkSemaphore semaphore, VkFence fence, uint32_t* index) {
    const VkResult fault = fault_of("vkAcquireNextImageKHR");
    if (fault < 0) return fault;
    const VkResult result = NEXT(vkAcquireNextImageKHR)(device, swapchain, wait, semaphore, fence, index);
    return result == VK_SUCCESS ? fault : result;  // suboptimal: with an image all the same
}

VkResult vkQueuePresentKHR(VkQueue queue, const VkPresentInfoKHR* info) {
    const VkResult fault = fault_of("vkQueuePresentKHR");
    const VkResult result = NEXT(vkQueuePresentKHR)(queue, info);  // takes the semaphores in any case
    return fault ? fault : result;
}

void vkDestroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
    {
        const std::lock_guard lock(mutex);
        faults[gettid() == getpid()].is_lost = false;
    }
    NEXT(vkDestroyDevice)(device, allocator);
}

}  // extern "C"
