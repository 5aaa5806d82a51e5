#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gpu/instance.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

/// The feature structures that this room knows, chained for Vulkan. Chains point into the object: link() again after
/// a copy.
struct DeviceFeatures {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features vulkan11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan12Features vulkan12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features vulkan13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT};

    VkPhysicalDeviceFeatures2* link(bool with_atomic_float);
};

[[nodiscard]] std::vector<std::string> device_extensions(VkPhysicalDevice device);
[[nodiscard]] bool contains(const std::vector<std::string>& names, const char* name);
/// The one family that this program uses: graphics, compute and timestamps.
[[nodiscard]] std::optional<std::uint32_t> graphics_queue_family(VkPhysicalDevice device);

[[nodiscard]] DeviceInfo describe(VkPhysicalDevice device, int number);
/// What Device enables: all that is required, and of the optional features those that the device has.
[[nodiscard]] DeviceFeatures features_to_enable(VkPhysicalDevice device, bool with_atomic_float);

}  // namespace heliodon::gpu
