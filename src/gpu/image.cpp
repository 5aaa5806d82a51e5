#include "gpu/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gpu/device.h"
#include "gpu/format.h"
#include "gpu/memory.h"

namespace heliodon::gpu {
namespace {

VkImageCreateInfo create_info(const ImageDescription& description) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    if (description.shape == ImageShape::cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    info.imageType = description.shape == ImageShape::volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = description.format;
    info.extent = description.extent;
    info.mipLevels = description.mips;
    info.arrayLayers = description.layers;
    info.samples = description.samples;
    info.usage = description.usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return info;
}

std::string place(const ImageDescription& description) {
    VkDeviceSize bytes = 0;
    for (std::uint32_t mip = 0; mip < description.mips; ++mip)
        bytes += level_bytes(description.format, description.extent, mip) * description.layers * description.samples;
    return fmt::format("image '{}' ({}×{}×{}, {} layers, {} mips, {}, about {} bytes)", description.name,
                       description.extent.width, description.extent.height, description.extent.depth,
                       description.layers, description.mips, format_name(description.format), bytes);
}

Result<void> check(const Device& device, const ImageDescription& description) {
    const VkExtent3D extent = description.extent;
    if (extent.width == 0 || extent.height == 0 || extent.depth == 0)
        return fail(place(description), "expected at least one texel");
    if (description.mips == 0 || description.mips > full_mip_count(extent))
        return fail(place(description), fmt::format("expected 1 to {} mips", full_mip_count(extent)));
    if (description.shape == ImageShape::cube && (description.layers % 6 != 0 || extent.width != extent.height))
        return fail(place(description), "a cube needs square faces and a multiple of 6 layers");
    const VkImageCreateInfo info = create_info(description);
    VkImageFormatProperties limits{};
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        device.physical_device(), info.format, info.imageType, info.tiling, info.usage, info.flags, &limits);
    if (result == VK_ERROR_FORMAT_NOT_SUPPORTED)
        return fail(place(description),
                    fmt::format("{} does not support this format for this use", device.info().name));
    if (result != VK_SUCCESS) return vulkan_failure(place(description), "cannot ask for its limits", result);
    if (extent.width > limits.maxExtent.width || extent.height > limits.maxExtent.height ||
        extent.depth > limits.maxExtent.depth || description.layers > limits.maxArrayLayers)
        return fail(place(description),
                    fmt::format("{} allows at most {}×{}×{} and {} layers", device.info().name, limits.maxExtent.width,
                                limits.maxExtent.height, limits.maxExtent.depth, limits.maxArrayLayers));
    if (!(limits.sampleCounts & description.samples))
        return fail(place(description), fmt::format("{} does not support {} samples a pixel", device.info().name,
                                                    static_cast<int>(description.samples)));
    return {};
}

VkImageViewType natural_type(const ImageDescription& description, std::uint32_t layers) {
    switch (description.shape) {
        case ImageShape::volume:
            return VK_IMAGE_VIEW_TYPE_3D;
        case ImageShape::cube:
            if (layers == 6) return VK_IMAGE_VIEW_TYPE_CUBE;
            if (layers % 6 == 0) return VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
            break;
        case ImageShape::flat:
            break;
    }
    return layers == 1 ? VK_IMAGE_VIEW_TYPE_2D : VK_IMAGE_VIEW_TYPE_2D_ARRAY;
}

bool same_part(const ImageView& a, const ImageView& b) {
    return a.base_mip == b.base_mip && a.mips == b.mips && a.base_layer == b.base_layer && a.layers == b.layers;
}

}  // namespace

VkMemoryRequirements Image::memory_requirements(const Device& device, const ImageDescription& description) {
    const VkImageCreateInfo info = create_info(description);
    VkDeviceImageMemoryRequirements query{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS};
    query.pCreateInfo = &info;
    VkMemoryRequirements2 requirements{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetDeviceImageMemoryRequirements(device.handle(), &query, &requirements);
    return requirements.memoryRequirements;
}

Result<Image> Image::create(Device& device, const ImageDescription& description) {
    if (auto checked = check(device, description); !checked) return tl::unexpected(checked.error());
    const VkImageCreateInfo info = create_info(description);
    VmaAllocationCreateInfo allocation{};
    allocation.usage = VMA_MEMORY_USAGE_AUTO_PREFER_DEVICE;
    Image image;
    image.device_ = &device;
    image.description_ = description;
    const VkResult result =
        vmaCreateImage(device.allocator(), &info, &allocation, &image.handle_, &image.allocation_, nullptr);
    if (result != VK_SUCCESS) return vulkan_failure(place(description), "cannot allocate it", result);
    vmaSetAllocationName(device.allocator(), image.allocation_, description.name.c_str());
    device.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image.handle_), description.name);
    return image;
}

Result<Image> Image::create_in(Device& device, const ImageDescription& description, SharedMemory memory) {
    if (auto checked = check(device, description); !checked) return tl::unexpected(checked.error());
    const VkImageCreateInfo info = create_info(description);
    Image image;
    image.device_ = &device;
    image.description_ = description;
    const VkResult result =
        vmaCreateAliasingImage2(device.allocator(), memory.allocation, memory.offset, &info, &image.handle_);
    if (result != VK_SUCCESS) return vulkan_failure(place(description), "cannot place it in shared memory", result);
    device.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<std::uint64_t>(image.handle_), description.name);
    return image;
}

Image Image::borrow(Device& device, const ImageDescription& description, VkImage handle) {
    Image image;
    image.device_ = &device;
    image.description_ = description;
    image.handle_ = handle;
    image.borrowed_ = true;
    return image;
}

VkExtent3D Image::extent(std::uint32_t mip) const {
    return level_extent(description_.extent, mip);
}

Result<VkImageView> Image::view(const ImageView& asked, VkImageViewType type) const {
    ImageView part = asked;
    if (part.mips == all_remaining) part.mips = description_.mips - std::min(part.base_mip, description_.mips);
    if (part.layers == all_remaining)
        part.layers = description_.layers - std::min(part.base_layer, description_.layers);
    if (part.mips == 0 || part.layers == 0 || part.base_mip + part.mips > description_.mips ||
        part.base_layer + part.layers > description_.layers)
        return fail(place(description_), fmt::format("no mips {}+{} of layers {}+{}", part.base_mip, part.mips,
                                                     part.base_layer, part.layers));
    if (type == VK_IMAGE_VIEW_TYPE_MAX_ENUM) type = natural_type(description_, part.layers);
    for (const CachedView& cached : views_)
        if (cached.type == type && same_part(cached.part, part)) return cached.handle;

    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = handle_;
    info.viewType = type;
    info.format = description_.format;
    info.subresourceRange = {format_info(description_.format).aspect, part.base_mip, part.mips, part.base_layer,
                             part.layers};
    VkImageView handle = VK_NULL_HANDLE;
    if (const VkResult result = vkCreateImageView(device_->handle(), &info, nullptr, &handle); result != VK_SUCCESS)
        return vulkan_failure(place(description_), "cannot create a view", result);
    device_->set_name(VK_OBJECT_TYPE_IMAGE_VIEW, reinterpret_cast<std::uint64_t>(handle), description_.name);
    views_.push_back({part, type, handle});
    return handle;
}

Image::~Image() {
    reset();
}

void Image::reset() {
    if (!handle_) return;
    device_->retire([device = device_->handle(), allocator = device_->allocator(), handle = handle_,
                     allocation = allocation_, borrowed = borrowed_, views = std::move(views_)] {
        for (const CachedView& view : views) vkDestroyImageView(device, view.handle, nullptr);
        if (borrowed) return;
        if (allocation)
            vmaDestroyImage(allocator, handle, allocation);
        else
            vkDestroyImage(device, handle, nullptr);
    });
    views_.clear();
    handle_ = VK_NULL_HANDLE;
}

Image::Image(Image&& other) noexcept {
    *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
    if (this == &other) return *this;
    reset();
    device_ = other.device_;
    handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
    allocation_ = std::exchange(other.allocation_, nullptr);
    borrowed_ = other.borrowed_;
    description_ = std::move(other.description_);
    views_ = std::exchange(other.views_, {});
    state_ = other.state_;
    return *this;
}

}  // namespace heliodon::gpu
