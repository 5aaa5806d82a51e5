#pragma once

#include <utility>
#include <vector>

#include "gpu/vulkan.h"

namespace heliodon::gpu {

struct SamplerDescription {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerMipmapMode mipmap_mode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    VkSamplerAddressMode address_u = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode address_v = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode address_w = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    float max_anisotropy = 1.0f;                           ///< clamped to what the device has
    bool compare = false;                                  ///< a shadow sampler
    VkCompareOp compare_op = VK_COMPARE_OP_LESS_OR_EQUAL;  ///< with `compare`
    VkBorderColor border = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    VkSamplerReductionMode reduction = VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;  ///< min and max where supported

    friend bool operator==(const SamplerDescription&, const SamplerDescription&) = default;
    /// Linear, edges clamped.
    [[nodiscard]] static SamplerDescription linear_clamp();
    [[nodiscard]] static SamplerDescription nearest_clamp();
    /// Linear percentage-closer comparison; outside the map is lit (white border).
    [[nodiscard]] static SamplerDescription shadow(VkCompareOp compare = VK_COMPARE_OP_LESS_OR_EQUAL);
};

/// The samplers made so far, few and shared; owned by Device.
using SamplerCache = std::vector<std::pair<SamplerDescription, VkSampler>>;

}  // namespace heliodon::gpu
