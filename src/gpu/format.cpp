#include "gpu/format.h"

#include <algorithm>
#include <array>

namespace heliodon::gpu {
namespace {

struct NamedFormat {
    VkFormat format;
    const char* name;
    FormatInfo info;
};

constexpr FormatInfo texel(std::uint32_t bytes, std::uint32_t channels, FormatKind kind) {
    return {bytes, 1, channels, kind, VK_IMAGE_ASPECT_COLOR_BIT};
}
constexpr FormatInfo block(std::uint32_t bytes, std::uint32_t channels, FormatKind kind) {
    return {bytes, 4, channels, kind, VK_IMAGE_ASPECT_COLOR_BIT};
}
constexpr FormatInfo depth(std::uint32_t bytes) {
    return {bytes, 1, 1, FormatKind::depth, VK_IMAGE_ASPECT_DEPTH_BIT};
}

constexpr FormatInfo depth_and_stencil(std::uint32_t bytes) {
    return {bytes, 1, 2, FormatKind::depth, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT};
}

constexpr auto floating = FormatKind::floating;
constexpr auto normalized = FormatKind::normalized;
constexpr auto integer = FormatKind::integer;

// Vulkan specification 1.3, section 34.1 (format definition).
constexpr std::array formats = {
    NamedFormat{VK_FORMAT_R8_UNORM, "R8_UNORM", texel(1, 1, normalized)},
    NamedFormat{VK_FORMAT_R8_UINT, "R8_UINT", texel(1, 1, integer)},
    NamedFormat{VK_FORMAT_R8G8_UNORM, "R8G8_UNORM", texel(2, 2, normalized)},
    NamedFormat{VK_FORMAT_R8G8_SNORM, "R8G8_SNORM", texel(2, 2, normalized)},
    NamedFormat{VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM", texel(4, 4, normalized)},
    NamedFormat{VK_FORMAT_R8G8B8A8_SNORM, "R8G8B8A8_SNORM", texel(4, 4, normalized)},
    NamedFormat{VK_FORMAT_R8G8B8A8_SRGB, "R8G8B8A8_SRGB", texel(4, 4, normalized)},
    NamedFormat{VK_FORMAT_R8G8B8A8_UINT, "R8G8B8A8_UINT", texel(4, 4, integer)},
    NamedFormat{VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8_UNORM", texel(4, 4, normalized)},
    NamedFormat{VK_FORMAT_B8G8R8A8_SRGB, "B8G8R8A8_SRGB", texel(4, 4, normalized)},
    NamedFormat{VK_FORMAT_A2B10G10R10_UNORM_PACK32, "A2B10G10R10_UNORM", texel(4, 4, normalized)},
    NamedFormat{VK_FORMAT_R16_UNORM, "R16_UNORM", texel(2, 1, normalized)},
    NamedFormat{VK_FORMAT_R16_UINT, "R16_UINT", texel(2, 1, integer)},
    NamedFormat{VK_FORMAT_R16_SFLOAT, "R16_SFLOAT", texel(2, 1, floating)},
    NamedFormat{VK_FORMAT_R16G16_UNORM, "R16G16_UNORM", texel(4, 2, normalized)},
    NamedFormat{VK_FORMAT_R16G16_SNORM, "R16G16_SNORM", texel(4, 2, normalized)},
    NamedFormat{VK_FORMAT_R16G16_SFLOAT, "R16G16_SFLOAT", texel(4, 2, floating)},
    NamedFormat{VK_FORMAT_R16G16B16A16_UNORM, "R16G16B16A16_UNORM", texel(8, 4, normalized)},
    NamedFormat{VK_FORMAT_R16G16B16A16_SNORM, "R16G16B16A16_SNORM", texel(8, 4, normalized)},
    NamedFormat{VK_FORMAT_R16G16B16A16_UINT, "R16G16B16A16_UINT", texel(8, 4, integer)},
    NamedFormat{VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT", texel(8, 4, floating)},
    NamedFormat{VK_FORMAT_R32_UINT, "R32_UINT", texel(4, 1, integer)},
    NamedFormat{VK_FORMAT_R32_SINT, "R32_SINT", texel(4, 1, integer)},
    NamedFormat{VK_FORMAT_R32_SFLOAT, "R32_SFLOAT", texel(4, 1, floating)},
    NamedFormat{VK_FORMAT_R32G32_UINT, "R32G32_UINT", texel(8, 2, integer)},
    NamedFormat{VK_FORMAT_R32G32_SFLOAT, "R32G32_SFLOAT", texel(8, 2, floating)},
    NamedFormat{VK_FORMAT_R32G32B32_SFLOAT, "R32G32B32_SFLOAT", texel(12, 3, floating)},
    NamedFormat{VK_FORMAT_R32G32B32A32_UINT, "R32G32B32A32_UINT", texel(16, 4, integer)},
    NamedFormat{VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT", texel(16, 4, floating)},
    NamedFormat{VK_FORMAT_B10G11R11_UFLOAT_PACK32, "B10G11R11_UFLOAT", texel(4, 3, floating)},
    NamedFormat{VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, "E5B9G9R9_UFLOAT", texel(4, 3, floating)},
    NamedFormat{VK_FORMAT_D16_UNORM, "D16_UNORM", depth(2)},
    NamedFormat{VK_FORMAT_D32_SFLOAT, "D32_SFLOAT", depth(4)},
    NamedFormat{VK_FORMAT_D32_SFLOAT_S8_UINT, "D32_SFLOAT_S8_UINT", depth_and_stencil(5)},
    NamedFormat{VK_FORMAT_BC1_RGBA_UNORM_BLOCK, "BC1_RGBA_UNORM", block(8, 4, normalized)},
    NamedFormat{VK_FORMAT_BC1_RGBA_SRGB_BLOCK, "BC1_RGBA_SRGB", block(8, 4, normalized)},
    NamedFormat{VK_FORMAT_BC3_UNORM_BLOCK, "BC3_UNORM", block(16, 4, normalized)},
    NamedFormat{VK_FORMAT_BC3_SRGB_BLOCK, "BC3_SRGB", block(16, 4, normalized)},
    NamedFormat{VK_FORMAT_BC4_UNORM_BLOCK, "BC4_UNORM", block(8, 1, normalized)},
    NamedFormat{VK_FORMAT_BC5_UNORM_BLOCK, "BC5_UNORM", block(16, 2, normalized)},
    NamedFormat{VK_FORMAT_BC6H_UFLOAT_BLOCK, "BC6H_UFLOAT", block(16, 3, floating)},
    NamedFormat{VK_FORMAT_BC7_UNORM_BLOCK, "BC7_UNORM", block(16, 4, normalized)},
    NamedFormat{VK_FORMAT_BC7_SRGB_BLOCK, "BC7_SRGB", block(16, 4, normalized)},
};

const NamedFormat* find(VkFormat format) {
    const auto found = std::ranges::find(formats, format, &NamedFormat::format);
    return found == formats.end() ? nullptr : &*found;
}

}  // namespace

FormatInfo format_info(VkFormat format) {
    const NamedFormat* found = find(format);
    return found ? found->info : FormatInfo{};
}

const char* format_name(VkFormat format) {
    const NamedFormat* found = find(format);
    return found ? found->name : "unknown format";
}

VkExtent3D level_extent(VkExtent3D extent, std::uint32_t mip) {
    return {std::max(1u, extent.width >> mip), std::max(1u, extent.height >> mip), std::max(1u, extent.depth >> mip)};
}

std::uint32_t full_mip_count(VkExtent3D extent) {
    std::uint32_t side = std::max({extent.width, extent.height, extent.depth});
    std::uint32_t count = 1;
    while (side >>= 1) ++count;
    return count;
}

VkDeviceSize level_bytes(VkFormat format, VkExtent3D extent, std::uint32_t mip) {
    const FormatInfo info = format_info(format);
    const VkExtent3D level = level_extent(extent, mip);
    const auto blocks = [&](std::uint32_t texels) {
        return VkDeviceSize{(texels + info.block_extent - 1) / info.block_extent};
    };
    return blocks(level.width) * blocks(level.height) * level.depth * info.block_bytes;
}

}  // namespace heliodon::gpu
