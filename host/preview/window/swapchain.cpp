#include "host/preview/window/swapchain.h"

#include <algorithm>

#include "host/error.h"

namespace etendue {
namespace {

VkPresentModeKHR choose_mode(const Device& device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical, surface, &count, nullptr);
    std::vector<VkPresentModeKHR> modes(count);
    vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical, surface, &count, modes.data());
    const bool mailbox = std::find(modes.begin(), modes.end(), VK_PRESENT_MODE_MAILBOX_KHR) != modes.end();
    return mailbox ? VK_PRESENT_MODE_MAILBOX_KHR : VK_PRESENT_MODE_FIFO_KHR;  // FIFO is always there
}

VkSemaphore make_semaphore(const Device& device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check(vkCreateSemaphore(device.handle, &info, nullptr, &semaphore), "vkCreateSemaphore");
    return semaphore;
}

}  // namespace

VkSurfaceFormatKHR choose_format(const Device& device, VkSurfaceKHR surface) {
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, surface, &count, formats.data());
    for (const VkSurfaceFormatKHR& f : formats)
        if (f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM) return f;
    fail_device("the window's surface has no format of 8 bits a channel");
}

std::unique_ptr<Swapchain> Swapchain::create(Device& device, VkSurfaceKHR surface, VkSurfaceFormatKHR format,
                                             VkRenderPass render_pass, VkExtent2D wanted,
                                             std::unique_ptr<Swapchain> old) {
    VkSurfaceCapabilitiesKHR limits;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical, surface, &limits),
          "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    if (!(limits.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        fail_device("the window's surface cannot be copied to");
    VkExtent2D extent = limits.currentExtent;
    if (extent.width == UINT32_MAX) extent = wanted;  // the surface takes the swapchain's size
    extent.width = std::clamp(extent.width, limits.minImageExtent.width, limits.maxImageExtent.width);
    extent.height = std::clamp(extent.height, limits.minImageExtent.height, limits.maxImageExtent.height);
    if (extent.width == 0 || extent.height == 0) return nullptr;

    std::unique_ptr<Swapchain> made(new Swapchain(device, extent));
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface;
    info.minImageCount = limits.minImageCount + 1;
    if (limits.maxImageCount) info.minImageCount = std::min(info.minImageCount, limits.maxImageCount);
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = limits.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = choose_mode(device, surface);
    info.clipped = VK_TRUE;
    info.oldSwapchain = old ? old->handle_ : VK_NULL_HANDLE;
    check(vkCreateSwapchainKHR(device.handle, &info, nullptr, &made->handle_), "vkCreateSwapchainKHR");
    old.reset();

    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device.handle, made->handle_, &count, nullptr), "vkGetSwapchainImagesKHR");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device.handle, made->handle_, &count, images.data()),
          "vkGetSwapchainImagesKHR");
    made->acquired_ = make_semaphore(device);
    for (VkImage image : images) {
        made->images_.push_back({image, VK_NULL_HANDLE, VK_NULL_HANDLE, make_semaphore(device)});
        Image& made_image = made->images_.back();
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format.format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        check(vkCreateImageView(device.handle, &view, nullptr, &made_image.view), "vkCreateImageView");
        VkFramebufferCreateInfo framebuffer{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
        framebuffer.renderPass = render_pass;
        framebuffer.attachmentCount = 1;
        framebuffer.pAttachments = &made_image.view;
        framebuffer.width = extent.width, framebuffer.height = extent.height;
        framebuffer.layers = 1;
        check(vkCreateFramebuffer(device.handle, &framebuffer, nullptr, &made_image.framebuffer),
              "vkCreateFramebuffer");
    }
    return made;
}

Swapchain::~Swapchain() {
    vkDeviceWaitIdle(device_.handle);
    for (const Image& image : images_) {
        if (image.framebuffer) vkDestroyFramebuffer(device_.handle, image.framebuffer, nullptr);
        if (image.view) vkDestroyImageView(device_.handle, image.view, nullptr);
        vkDestroySemaphore(device_.handle, image.drawn, nullptr);
    }
    if (acquired_) vkDestroySemaphore(device_.handle, acquired_, nullptr);
    if (handle_) vkDestroySwapchainKHR(device_.handle, handle_, nullptr);
}

std::optional<Swapchain::Frame> Swapchain::acquire(uint64_t wait) {
    uint32_t index = 0;
    const VkResult result =
        vkAcquireNextImageKHR(device_.handle, handle_, wait, acquired_, VK_NULL_HANDLE, &index);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) outdated_ = true;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_NOT_READY || result == VK_TIMEOUT)
        return std::nullopt;
    if (result == VK_SUBOPTIMAL_KHR)
        outdated_ = true;  // this image can be shown all the same
    else
        check(result, "vkAcquireNextImageKHR");
    return Frame{index, images_[index].image, images_[index].framebuffer};
}

void Swapchain::present(const Frame& frame, VkCommandBuffer commands, VkFence fence) {
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &acquired_;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &images_[frame.index].drawn;
    check(vkQueueSubmit(device_.queue, 1, &submit, fence), "vkQueueSubmit");
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &images_[frame.index].drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &handle_;
    info.pImageIndices = &frame.index;
    const VkResult result = vkQueuePresentKHR(device_.queue, &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        outdated_ = true;
    else
        check(result, "vkQueuePresentKHR");
}

}  // namespace etendue
