#pragma once

#include <cstdint>

#include "gpu/vulkan.h"

namespace heliodon::gpu {

enum class FormatKind { floating, normalized, integer, depth };

/// What the rooms need to know of a format, without asking a driver.
struct FormatInfo {
    std::uint32_t block_bytes =
        0;  ///< bytes of a texel, or of a block of a compressed format; 0: format not known here
    std::uint32_t block_extent = 1;  ///< texels along a block's side
    std::uint32_t channels = 4;
    FormatKind kind = FormatKind::floating;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};
[[nodiscard]] FormatInfo format_info(VkFormat format);
[[nodiscard]] inline bool has_stencil(VkFormat format) {
    return (format_info(format).aspect & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
}
[[nodiscard]] const char* format_name(VkFormat format);

/// Bytes of one mip level of one layer, tightly packed.
[[nodiscard]] VkDeviceSize level_bytes(VkFormat format, VkExtent3D extent, std::uint32_t mip);
/// The extent of a mip level: each side halved and rounded down, at least 1.
[[nodiscard]] VkExtent3D level_extent(VkExtent3D extent, std::uint32_t mip);
/// Levels of a full chain down to 1×1×1.
[[nodiscard]] std::uint32_t full_mip_count(VkExtent3D extent);

}  // namespace heliodon::gpu
