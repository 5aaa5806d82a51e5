#include "gpu/sampler.h"

#include <algorithm>

#include "gpu/device.h"

namespace heliodon::gpu {
namespace {

SamplerDescription clamped(VkFilter filter, VkSamplerMipmapMode mipmap_mode, VkSamplerAddressMode address) {
    SamplerDescription description;
    description.filter = filter;
    description.mipmap_mode = mipmap_mode;
    description.address_u = description.address_v = description.address_w = address;
    return description;
}

}  // namespace

SamplerDescription SamplerDescription::linear_clamp() {
    return clamped(VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
}

SamplerDescription SamplerDescription::nearest_clamp() {
    return clamped(VK_FILTER_NEAREST, VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
}

SamplerDescription SamplerDescription::shadow(VkCompareOp compare_op) {
    SamplerDescription description =
        clamped(VK_FILTER_LINEAR, VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER);
    description.compare = true;
    description.compare_op = compare_op;
    return description;
}

Result<VkSampler> Device::sampler(const SamplerDescription& description) {
    for (const auto& [known, handle] : samplers_)
        if (known == description) return handle;
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(physical_device_, &features);

    VkSamplerReductionModeCreateInfo reduction{VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO};
    reduction.reductionMode = description.reduction;
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    if (description.reduction != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE) info.pNext = &reduction;
    info.magFilter = info.minFilter = description.filter;
    info.mipmapMode = description.mipmap_mode;
    info.addressModeU = description.address_u;
    info.addressModeV = description.address_v;
    info.addressModeW = description.address_w;
    info.maxAnisotropy = std::min(description.max_anisotropy, limits().maxSamplerAnisotropy);
    info.anisotropyEnable = features.samplerAnisotropy && info.maxAnisotropy > 1.0f;
    info.compareEnable = description.compare;
    info.compareOp = description.compare_op;
    info.borderColor = description.border;
    info.maxLod = VK_LOD_CLAMP_NONE;
    VkSampler handle = VK_NULL_HANDLE;
    if (const VkResult result = vkCreateSampler(handle_, &info, nullptr, &handle); result != VK_SUCCESS)
        return vulkan_failure("", "cannot create a sampler", result);
    samplers_.emplace_back(description, handle);
    return handle;
}

}  // namespace heliodon::gpu
