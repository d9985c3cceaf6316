#include "host/preview/window/presenter.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include "host/error.h"

namespace etendue {
namespace {

constexpr uint64_t acquire_nanoseconds = 10'000'000;

void check_panels(VkResult result) {
    if (result < 0) check(result, "drawing the panels");
}

bool same(VkExtent2D a, VkExtent2D b) { return a.width == b.width && a.height == b.height; }

void change_layout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    const bool is_target = to == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.srcAccessMask = is_target ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = is_target
                                ? VK_ACCESS_TRANSFER_WRITE_BIT
                                : VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    barrier.oldLayout = from, barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
        is_target ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0, 0,
        nullptr, 0, nullptr, 1, &barrier);
}

// One colour attachment that keeps what was copied there.
VkRenderPass make_render_pass(const Device& device, VkFormat format) {
    VkAttachmentDescription attachment{};
    attachment.format = format;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = 1;
    info.pAttachments = &attachment;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VkRenderPass pass = VK_NULL_HANDLE;
    check(vkCreateRenderPass(device.handle, &info, nullptr, &pass), "vkCreateRenderPass");
    return pass;
}

}  // namespace

Presenter::Presenter(GLFWwindow* window, const std::filesystem::path& shaders) : window_(window) {
    uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!extensions) fail_device("the Vulkan driver cannot show pictures in a window of this display");
    DeviceOptions options;
    options.window_extensions.assign(extensions, extensions + count);
    device_ = create_device(options);
    check(glfwCreateWindowSurface(device_->instance, window, nullptr, &surface_), "glfwCreateWindowSurface");
    VkBool32 supported = VK_FALSE;
    check(
        vkGetPhysicalDeviceSurfaceSupportKHR(device_->physical, device_->queue_family, surface_, &supported),
        "vkGetPhysicalDeviceSurfaceSupportKHR");
    if (!supported)
        fail_device("{} cannot show pictures in a window of this display", device_->description.name);
    format_ = choose_format(*device_, surface_);
    render_pass_ = make_render_pass(*device_, format_.format);

    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
    check(vkCreateFence(device_->handle, &fence, nullptr, &fence_), "vkCreateFence");
    VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocation.commandPool = device_->command_pool;
    allocation.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device_->handle, &allocation, &frame_commands_),
          "vkAllocateCommandBuffers");

    ShaderSources sources;
    sources.folder = shaders;
    CompileOptions compile;
    compile.cache_folder = default_cache_folder();
    const auto program = [&](const char* file) {
        return std::make_shared<const Program>(*device_, compile_shader(sources, file, compile));
    };
    encode_program_ = program("kernels/encode_picture.comp");
    enlarge_program_ = program("kernels/enlarge_picture.comp");
    view_ = Buffer(*device_, sizeof(ViewTransform), "ViewTable");
    commands_ = std::make_unique<CommandList>(*device_);
    start_panels();
    warm_up();
}

void Presenter::resized() {
    if (swapchain_) swapchain_->set_outdated();
}

Presenter::~Presenter() {
    if (device_->handle) vkDeviceWaitIdle(device_->handle);
    if (has_panels_) ImGui_ImplVulkan_Shutdown();
    swapchain_.reset();
    if (fence_) vkDestroyFence(device_->handle, fence_, nullptr);
    if (descriptors_) vkDestroyDescriptorPool(device_->handle, descriptors_, nullptr);
    if (render_pass_) vkDestroyRenderPass(device_->handle, render_pass_, nullptr);
    if (surface_) vkDestroySurfaceKHR(device_->instance, surface_, nullptr);
}

void Presenter::start_panels() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};  // the font
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    check(vkCreateDescriptorPool(device_->handle, &pool, nullptr, &descriptors_), "vkCreateDescriptorPool");
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device_->instance;
    info.PhysicalDevice = device_->physical;
    info.Device = device_->handle;
    info.QueueFamily = device_->queue_family;
    info.Queue = device_->queue;
    info.DescriptorPool = descriptors_;
    info.MinImageCount = 2;
    info.ImageCount = 2;  // one frame is drawn at a time
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = check_panels;
    ImGui_ImplVulkan_Init(&info, render_pass_);
    VkCommandBuffer commands = begin_commands(*device_);
    ImGui_ImplVulkan_CreateFontsTexture(commands);
    submit_and_wait(*device_, commands);
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    has_panels_ = true;
}

// Some more than is asked for, so that a window that is drawn larger does not want another at every step.
void Presenter::reserve(Buffer& buffer, uint64_t bytes, const std::string& name) {
    if (buffer && buffer.bytes() >= bytes) return;
    buffer = Buffer();
    buffer = Buffer(*device_, bytes + bytes / 2, name);
    encode_ = Kernel();
    enlarge_ = Kernel();
}

void Presenter::bind() {
    if (encode_) return;
    const BufferTable buffers = {
        {"Picture", &picture_}, {"ViewTable", &view_}, {"Encoded", &encoded_}, {"Enlarged", &enlarged_}};
    encode_ = Kernel(*device_, encode_program_, buffers);
    enlarge_ = Kernel(*device_, enlarge_program_, buffers);
}

// Drivers finish compiling at the first dispatch.
void Presenter::warm_up() {
    reserve(picture_, 16, "Picture");
    reserve(encoded_, 16, "Encoded");
    reserve(enlarged_, 16, "Enlarged");
    bind();
    commands_->dispatch(encode_, 1);
    commands_->dispatch(enlarge_, 1);
    commands_->run();
}

void Presenter::develop(const PreviewPicture& picture, const ViewTransform& view) {
    const std::vector<glm::vec3>& values = picture.shown.empty() ? picture.radiance : picture.shown;
    reserve(picture_, values.size() * sizeof(glm::vec3), "Picture");
    reserve(encoded_, values.size() * 4, "Encoded");
    picture_.write(values.data(), values.size() * sizeof(glm::vec3));
    view_.write(&view, sizeof view);
    picture_extent_ = {picture.width, picture.height};
    is_encoded_ = false;
    shown_extent_ = {};
}

// The picture to the window's size, in `encoded_` where it has that size, else in `enlarged_`.
void Presenter::enlarge() {
    const VkExtent2D extent = swapchain_->extent();
    if (picture_extent_.width == 0 || same(shown_extent_, extent)) return;
    const uint32_t pixels = extent.width * extent.height,
                   picture_pixels = picture_extent_.width * picture_extent_.height;
    reserve(enlarged_, uint64_t(pixels) * 4, "Enlarged");
    bind();
    const auto groups = [](const Kernel& kernel, uint32_t items) {
        return (items + kernel.group_size() - 1) / kernel.group_size();
    };
    if (!is_encoded_)
        commands_->dispatch(encode_, groups(encode_, picture_pixels),
                            {{"pixels", picture_pixels},
                             {"blue_first", uint32_t(format_.format == VK_FORMAT_B8G8R8A8_UNORM)}});
    if (!same(picture_extent_, extent))
        commands_->dispatch(enlarge_, groups(enlarge_, pixels),
                            {{"width", extent.width},
                             {"height", extent.height},
                             {"picture_width", picture_extent_.width},
                             {"picture_height", picture_extent_.height}});
    commands_->run();
    is_encoded_ = true;
    shown_extent_ = extent;
}

void Presenter::record_frame(VkCommandBuffer commands, const Swapchain::Frame& frame, ImDrawData* panels) {
    const VkExtent2D extent = swapchain_->extent();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    change_layout(commands, frame.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    if (shown_extent_.width > 0) {
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {extent.width, extent.height, 1};
        const Buffer& shown = same(picture_extent_, extent) ? encoded_ : enlarged_;
        vkCmdCopyBufferToImage(commands, shown.handle(), frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &copy);
    } else {
        const VkClearColorValue black{{0.0f, 0.0f, 0.0f, 1.0f}};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
    }
    change_layout(commands, frame.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    VkRenderPassBeginInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    pass.renderPass = render_pass_;
    pass.framebuffer = frame.framebuffer;
    pass.renderArea.extent = extent;
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(panels, commands);
    vkCmdEndRenderPass(commands);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

bool Presenter::draw(ImDrawData* panels) {
    check(vkWaitForFences(device_->handle, 1, &fence_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    if (!swapchain_ || swapchain_->is_outdated()) {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_, &width, &height);
        swapchain_ = Swapchain::create(*device_, surface_, format_, render_pass_,
                                       {uint32_t(width), uint32_t(height)}, std::move(swapchain_));
        if (!swapchain_) return false;
    }
    enlarge();
    const auto frame = swapchain_->acquire(acquire_nanoseconds);
    if (!frame) return false;
    check(vkResetFences(device_->handle, 1, &fence_), "vkResetFences");
    record_frame(frame_commands_, *frame, panels);
    swapchain_->present(*frame, frame_commands_, fence_);
    return true;
}

}  // namespace etendue
