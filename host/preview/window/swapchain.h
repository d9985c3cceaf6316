// The images that a window shows in turn, at one size.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "host/gpu/device.h"

struct GLFWwindow;

namespace etendue {

class Swapchain {
  public:
    struct Frame {
        uint32_t index;
        VkImage image;
        VkFramebuffer framebuffer;
    };

    // Null where the surface has no size now. `old` is replaced by it; nothing of it may be in use.
    static std::unique_ptr<Swapchain> create(Device& device, VkSurfaceKHR surface, VkSurfaceFormatKHR format,
                                             VkRenderPass render_pass, VkExtent2D wanted,
                                             std::unique_ptr<Swapchain> old);
    ~Swapchain();

    VkExtent2D extent() const { return extent_; }
    uint32_t image_count() const { return uint32_t(images_.size()); }
    // None: the window has changed, and another swapchain is needed; or all images are in use for longer than
    // `wait` nanoseconds.
    std::optional<Frame> acquire(uint64_t wait);
    bool is_outdated() const { return outdated_; }
    void set_outdated() { outdated_ = true; }
    // Submits the commands that draw the frame, and shows it. `fence` is signalled once they are done.
    void present(const Frame& frame, VkCommandBuffer commands, VkFence fence);

  private:
    Swapchain(Device& device, VkExtent2D extent) : device_(device), extent_(extent) {}
    Device& device_;
    VkExtent2D extent_;
    VkSwapchainKHR handle_ = VK_NULL_HANDLE;
    VkSemaphore acquired_ = VK_NULL_HANDLE;
    struct Image {
        VkImage image;
        VkImageView view;
        VkFramebuffer framebuffer;
        VkSemaphore drawn;
    };
    std::vector<Image> images_;
    bool outdated_ = false;
};

// 8 bits a channel, not encoded by the device: blue or red first.
VkSurfaceFormatKHR choose_format(const Device& device, VkSurfaceKHR surface);

}  // namespace etendue
