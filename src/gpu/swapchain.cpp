#include "gpu/swapchain.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "gpu/device.h"

namespace heliodon::gpu {
namespace {

/// The swapchain extension's entry points of this device.
template <class Function>
Function entry_point(const Device& device, const char* name) {
    return reinterpret_cast<Function>(vkGetDeviceProcAddr(device.handle(), name));
}

/// The surface extension's entry points of this instance: only one with a window system has them.
template <class Function>
Function surface_function(const Device& device, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(device.instance().handle(), name));
}

/// UNORM, so that the shaders' own sRGB encoding is shown as it is.
Result<VkSurfaceFormatKHR> choose_format(const Device& device, VkSurfaceKHR surface) {
    const auto get =
        surface_function<PFN_vkGetPhysicalDeviceSurfaceFormatsKHR>(device, "vkGetPhysicalDeviceSurfaceFormatsKHR");
    std::uint32_t count = 0;
    get(device.physical_device(), surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    get(device.physical_device(), surface, &count, formats.data());
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
    return fail("window", "expected a surface with 8-bit BGRA or RGBA in sRGB");
}

VkPresentModeKHR choose_mode(const Device& device, VkSurfaceKHR surface, bool vsync) {
    if (vsync) return VK_PRESENT_MODE_FIFO_KHR;  // always offered
    const auto get = surface_function<PFN_vkGetPhysicalDeviceSurfacePresentModesKHR>(
        device, "vkGetPhysicalDeviceSurfacePresentModesKHR");
    std::uint32_t count = 0;
    get(device.physical_device(), surface, &count, nullptr);
    std::vector<VkPresentModeKHR> modes(count);
    get(device.physical_device(), surface, &count, modes.data());
    for (const VkPresentModeKHR wanted : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
        if (std::ranges::find(modes, wanted) != modes.end()) return wanted;
    return VK_PRESENT_MODE_FIFO_KHR;
}

Result<VkSemaphore> create_semaphore(const Device& device, const std::string& name) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    const VkResult result = vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore);
    if (result != VK_SUCCESS) return vulkan_failure("window", "cannot create a semaphore", result);
    device.set_name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<std::uint64_t>(semaphore), name);
    return semaphore;
}

}  // namespace

Result<Swapchain> Swapchain::create(Device& device, VkSurfaceKHR surface, VkExtent2D extent, bool vsync) {
    if (!entry_point<PFN_vkCreateSwapchainKHR>(device, "vkCreateSwapchainKHR"))
        return fail("window", "the device was not created for presenting");
    VkBool32 supported = VK_FALSE;
    surface_function<PFN_vkGetPhysicalDeviceSurfaceSupportKHR>(device, "vkGetPhysicalDeviceSurfaceSupportKHR")(
        device.physical_device(), device.queue_family(), surface, &supported);
    if (!supported) return fail("window", fmt::format("{} cannot present to it", device.info().name));
    Swapchain swapchain;
    swapchain.device_ = &device;
    swapchain.surface_ = surface;
    swapchain.vsync_ = vsync;
    if (auto built = swapchain.build(extent); !built) return tl::unexpected(built.error());
    return swapchain;
}

Result<void> Swapchain::build(VkExtent2D extent) {
    VkSurfaceCapabilitiesKHR surface{};
    VkResult result = surface_function<PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR>(
        *device_, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR")(device_->physical_device(), surface_, &surface);
    if (result != VK_SUCCESS) return vulkan_failure("window", "cannot ask for its properties", result);
    constexpr std::uint32_t free_choice = std::numeric_limits<std::uint32_t>::max();
    if (surface.currentExtent.width != free_choice) extent = surface.currentExtent;
    extent_ = {std::clamp(extent.width, surface.minImageExtent.width, surface.maxImageExtent.width),
               std::clamp(extent.height, surface.minImageExtent.height, surface.maxImageExtent.height)};
    if (extent_.width == 0 || extent_.height == 0) return {};  // minimized: there is nothing to show until resize()

    auto format = choose_format(*device_, surface_);
    if (!format) return tl::unexpected(format.error());
    format_ = format->format;
    constexpr VkImageUsageFlags needed = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if ((surface.supportedUsageFlags & needed) != needed)
        return fail("window", "its images cannot be drawn and copied to");
    // One more than needed: the GPU draws one while the others wait or are shown.
    std::uint32_t count = surface.minImageCount + 1;
    if (surface.maxImageCount > 0) count = std::min(count, surface.maxImageCount);
    const VkSwapchainKHR old = handle_;
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = count;
    info.imageFormat = format->format;
    info.imageColorSpace = format->colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = needed;
    info.preTransform = surface.currentTransform;
    info.compositeAlpha = (surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR)
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = choose_mode(*device_, surface_, vsync_);
    info.clipped = VK_TRUE;
    info.oldSwapchain = old;
    VkSwapchainKHR created = VK_NULL_HANDLE;
    result = entry_point<PFN_vkCreateSwapchainKHR>(*device_, "vkCreateSwapchainKHR")(device_->handle(), &info, nullptr,
                                                                                     &created);
    if (result != VK_SUCCESS) return vulkan_failure("window", "cannot create the swapchain", result);
    reset();
    handle_ = created;

    const auto get_images = entry_point<PFN_vkGetSwapchainImagesKHR>(*device_, "vkGetSwapchainImagesKHR");
    get_images(device_->handle(), handle_, &count, nullptr);
    std::vector<VkImage> handles(count);
    get_images(device_->handle(), handle_, &count, handles.data());
    for (std::uint32_t index = 0; index < count; ++index) {
        ImageDescription description;
        description.name = fmt::format("window {}", index);
        description.format = format_;
        description.extent = {extent_.width, extent_.height, 1};
        description.usage = needed;
        images_.push_back(Image::borrow(*device_, description, handles[index]));
        for (auto* semaphores : {&acquired_, &finished_}) {
            auto semaphore = create_semaphore(*device_, description.name);
            if (!semaphore) return tl::unexpected(semaphore.error());
            semaphores->push_back(*semaphore);
        }
    }
    // One more: an image is acquired before it is known which semaphore its last use has freed.
    auto spare = create_semaphore(*device_, "window acquired");
    if (!spare) return tl::unexpected(spare.error());
    acquired_.push_back(*spare);
    uses_.assign(acquired_.size(), 0);
    return {};
}

Result<std::optional<Swapchain::Frame>> Swapchain::acquire() {
    if (!handle_ || extent_.width == 0 || extent_.height == 0) return std::optional<Frame>{};
    next_ = (next_ + 1) % acquired_.size();
    // The submission that waited for this semaphore before must be over.
    if (auto waited = device_->wait(uses_[next_]); !waited) return tl::unexpected(waited.error());
    std::uint32_t index = 0;
    const VkResult result = entry_point<PFN_vkAcquireNextImageKHR>(*device_, "vkAcquireNextImageKHR")(
        device_->handle(), handle_, std::numeric_limits<std::uint64_t>::max(), acquired_[next_], VK_NULL_HANDLE,
        &index);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) return std::optional<Frame>{};
    if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR)
        return vulkan_failure("window", "cannot acquire an image", result);
    // The semaphore is waited for in all stages; the old picture is not kept.
    images_[index].set_state({VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED});
    return std::optional<Frame>(Frame{&images_[index], acquired_[next_], finished_[index], index});
}

Result<bool> Swapchain::present(const Frame& frame) {
    uses_[next_] = device_->submitted();
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &frame.finished;
    info.swapchainCount = 1;
    info.pSwapchains = &handle_;
    info.pImageIndices = &frame.index;
    const VkResult result = entry_point<PFN_vkQueuePresentKHR>(*device_, "vkQueuePresentKHR")(device_->queue(), &info);
    if (result == VK_SUCCESS) return true;
    if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR) return false;
    return vulkan_failure("window", "cannot present", result);
}

Result<void> Swapchain::resize(VkExtent2D extent) {
    if (auto waited = device_->wait_idle(); !waited) return waited;
    return build(extent);
}

void Swapchain::reset() {
    if (!device_) return;
    // Presentation is no submission of ours: only an idle queue is done with the images and semaphores.
    if (handle_) vkQueueWaitIdle(device_->queue());
    images_.clear();
    for (auto* semaphores : {&acquired_, &finished_}) {
        for (const VkSemaphore semaphore : *semaphores) vkDestroySemaphore(device_->handle(), semaphore, nullptr);
        semaphores->clear();
    }
    if (handle_)
        device_->retire([device = device_->handle(), handle = handle_,
                         destroy = entry_point<PFN_vkDestroySwapchainKHR>(*device_, "vkDestroySwapchainKHR")] {
            destroy(device, handle, nullptr);
        });
    handle_ = VK_NULL_HANDLE;
    next_ = 0;
}

Swapchain::~Swapchain() {
    reset();
}

Swapchain::Swapchain(Swapchain&& other) noexcept {
    *this = std::move(other);
}

Swapchain& Swapchain::operator=(Swapchain&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(surface_, other.surface_);
    std::swap(handle_, other.handle_);
    std::swap(extent_, other.extent_);
    std::swap(format_, other.format_);
    std::swap(vsync_, other.vsync_);
    std::swap(images_, other.images_);
    std::swap(acquired_, other.acquired_);
    std::swap(finished_, other.finished_);
    std::swap(uses_, other.uses_);
    std::swap(next_, other.next_);
    return *this;
}

}  // namespace heliodon::gpu
