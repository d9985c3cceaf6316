// Pictures and panels on a window's screen, by a Vulkan device of its own: the renderer's kernels may take
// seconds, and a queue works off what it is given in order, so that sharing one would hold up the window. The
// picture crosses over through host memory.
#pragma once
#include <string>

#include "host/gpu/kernel.h"
#include "host/preview/preview.h"
#include "host/preview/view_transform.h"
#include "host/preview/window/swapchain.h"

struct ImDrawData;

namespace etendue {

class Presenter {
  public:
    // An ImGui context is there, for that window. Fails (exit code 3) where no device can show pictures in
    // the window. `shaders`: folder, or empty.
    Presenter(GLFWwindow* window, const std::filesystem::path& shaders);
    ~Presenter();
    Presenter(const Presenter&) = delete;

    // Develops a picture for the next frames; `shown` in place of its radiance where it is not empty.
    void develop(const PreviewPicture& picture, const ViewTransform& view);
    // A frame: the picture, enlarged to the window, and the panels on it. False: there is no room for one
    // now.
    bool draw(ImDrawData* panels);
    void resized();  // the window has another size
    const std::string& device_name() const { return device_->description.name; }
    uint64_t device_bytes() const { return device_->bytes_allocated; }

  private:
    void start_panels();
    void record_frame(VkCommandBuffer commands, const Swapchain::Frame& frame, ImDrawData* panels);
    void reserve(Buffer& buffer, uint64_t bytes);
    void enlarge();  // the picture to the window's size
    GLFWwindow* window_;
    std::unique_ptr<Device> device_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkRenderPass render_pass_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    std::unique_ptr<Swapchain> swapchain_;
    CompiledShader shader_;
    Buffer picture_, view_, shown_;
    Kernel show_picture_;
    std::unique_ptr<CommandList> commands_;
    VkFence fence_ = VK_NULL_HANDLE;
    VkCommandBuffer frame_commands_ = VK_NULL_HANDLE;
    uint32_t picture_width_ = 0, picture_height_ = 0;  // 0 = none yet
    uint32_t shown_width_ = 0, shown_height_ = 0;      // of what shown_ holds
    bool has_panels_ = false, is_bound_ = false;       // the kernel, to the buffers
};

}  // namespace etendue
