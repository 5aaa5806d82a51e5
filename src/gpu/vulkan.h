#pragma once

#include <volk.h>

#include <string>
#include <string_view>

#include "core/result.h"

namespace heliodon::gpu {

/// "VK_ERROR_OUT_OF_DEVICE_MEMORY" and so on; an unknown code gives "VkResult <number>".
[[nodiscard]] std::string result_name(VkResult result);

/// The Error of a Vulkan call that failed: "<what>: VK_ERROR_…".
[[nodiscard]] tl::unexpected<Error> vulkan_failure(std::string where, std::string_view what, VkResult result);

/// How a resource was last accessed, or is about to be: the two ends of a barrier.
struct Access {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< images only

    friend bool operator==(const Access&, const Access&) = default;
};

/// Whether any of these accesses writes.
[[nodiscard]] bool writes(VkAccessFlags2 access);

}  // namespace heliodon::gpu
