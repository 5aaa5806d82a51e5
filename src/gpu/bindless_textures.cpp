#include "gpu/bindless_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/device.h"

namespace heliodon::gpu {

Result<std::unique_ptr<BindlessTextures>> BindlessTextures::create(Device& device, std::uint32_t capacity) {
    std::unique_ptr<BindlessTextures> textures(new BindlessTextures(device));
    if (auto opened = textures->open(capacity); !opened) return tl::unexpected(opened.error());
    return textures;
}

Result<void> BindlessTextures::open(std::uint32_t capacity) {
    VkPhysicalDeviceVulkan12Properties limits{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &limits;
    vkGetPhysicalDeviceProperties2(device_.physical_device(), &properties);
    // A combined image sampler counts against the limits of both; some are left to the passes' own sets.
    constexpr std::uint32_t reserved = 64;
    const std::uint32_t most = std::min(
        {limits.maxPerStageDescriptorUpdateAfterBindSampledImages, limits.maxPerStageDescriptorUpdateAfterBindSamplers,
         limits.maxDescriptorSetUpdateAfterBindSampledImages, limits.maxDescriptorSetUpdateAfterBindSamplers});
    capacity_ = std::clamp(capacity, 1u, std::max(most, reserved + 1) - reserved);

    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, capacity_,
                                               VK_SHADER_STAGE_ALL, nullptr};
    const VkDescriptorBindingFlags flags = VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT |
                                           VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT |
                                           VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo binding_flags{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
    binding_flags.bindingCount = 1;
    binding_flags.pBindingFlags = &flags;
    VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    layout.pNext = &binding_flags;
    layout.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
    layout.bindingCount = 1;
    layout.pBindings = &binding;
    VkResult result = vkCreateDescriptorSetLayout(device_.handle(), &layout, nullptr, &layout_);
    if (result != VK_SUCCESS) return vulkan_failure("bindless textures", "cannot create the layout", result);

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, capacity_};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    result = vkCreateDescriptorPool(device_.handle(), &pool, nullptr, &pool_);
    if (result != VK_SUCCESS) return vulkan_failure("bindless textures", "cannot create the pool", result);
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout_;
    result = vkAllocateDescriptorSets(device_.handle(), &allocate, &set_);
    if (result != VK_SUCCESS) return vulkan_failure("bindless textures", "cannot allocate the table", result);
    device_.set_name(VK_OBJECT_TYPE_DESCRIPTOR_SET, reinterpret_cast<std::uint64_t>(set_), "bindless textures");

    ImageDescription white;
    white.name = "default texture";
    auto image = Image::create(device_, white);
    if (!image) return tl::unexpected(image.error());
    default_image_ = std::move(*image);
    constexpr std::array texel = {std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}};
    if (auto uploaded = device_.upload(default_image_, texel); !uploaded) return uploaded;
    auto sampler = device_.sampler({});
    if (!sampler) return tl::unexpected(sampler.error());
    default_sampler_ = *sampler;
    auto view = default_image_.view({&default_image_}, VK_IMAGE_VIEW_TYPE_2D);
    if (!view) return tl::unexpected(view.error());
    for (std::uint32_t slot = 0; slot < capacity_; ++slot) write(slot, *view, default_sampler_);
    return {};
}

BindlessTextures::~BindlessTextures() {
    vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
    vkDestroyDescriptorSetLayout(device_.handle(), layout_, nullptr);
}

void BindlessTextures::write(std::uint32_t slot, VkImageView view, VkSampler sampler) {
    const VkDescriptorImageInfo image{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.dstArrayElement = slot;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
}

Result<std::uint32_t> BindlessTextures::add(const Image& image, VkSampler sampler) {
    if (free_.empty() && next_ == capacity_)
        return fail(image.name(), fmt::format("the table of {} textures is full", capacity_));
    const std::uint32_t slot = free_.empty() ? next_ : free_.back();
    if (auto replaced = replace(slot, image, sampler); !replaced) return tl::unexpected(replaced.error());
    if (free_.empty())
        ++next_;
    else
        free_.pop_back();
    ++used_;
    return slot;
}

Result<void> BindlessTextures::replace(std::uint32_t slot, const Image& image, VkSampler sampler) {
    if (slot >= capacity_) return fail(image.name(), fmt::format("no texture slot {} of {}", slot, capacity_));
    auto view = image.view({&image}, VK_IMAGE_VIEW_TYPE_2D);
    if (!view) return tl::unexpected(view.error());
    write(slot, *view, sampler ? sampler : default_sampler_);
    return {};
}

void BindlessTextures::remove(std::uint32_t slot) {
    // Until the GPU is done with the slot it may still be read: the default comes back and the slot is given
    // again only then.
    device_.retire([this, slot] {
        if (auto view = default_image_.view({&default_image_}, VK_IMAGE_VIEW_TYPE_2D))
            write(slot, *view, default_sampler_);
        free_.push_back(slot);
        --used_;
    });
}

}  // namespace heliodon::gpu
