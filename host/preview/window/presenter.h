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
    void reserve(Buffer& buffer, uint64_t bytes, const std::string& name);
    void bind();
    void warm_up();
    void enlarge();
    GLFWwindow* window_;
    std::unique_ptr<Device> device_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkRenderPass render_pass_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    std::unique_ptr<Swapchain> swapchain_;
    std::shared_ptr<const Program> encode_program_, enlarge_program_;
    Buffer picture_, view_, encoded_, enlarged_;
    Kernel encode_, enlarge_;  // none until their buffers are there
    std::unique_ptr<CommandList> commands_;
    VkFence fence_ = VK_NULL_HANDLE;
    VkCommandBuffer frame_commands_ = VK_NULL_HANDLE;
    VkExtent2D picture_extent_{};  // nothing = none yet
    VkExtent2D shown_extent_{};    // that the picture is ready for; nothing = none
    bool has_panels_ = false, is_encoded_ = false;
};

}  // namespace etendue
