#pragma once

#include <string>

#include "gpu/pipeline.h"

namespace heliodon::passes {

/// Push constants of every raster pass: which of its views it draws.
struct RasterConstants {
    std::uint32_t view = 0;
    std::uint32_t random_seed = 0;
};

/// What the raster passes share: both sides drawn, reversed 32-bit depth.
[[nodiscard]] inline gpu::GraphicsDescription raster_description(std::string name, std::string vertex, std::string fragment) {
    gpu::GraphicsDescription description;
    description.name = std::move(name);
    description.vertex = std::move(vertex);
    description.fragment = std::move(fragment);
    description.depth_format = VK_FORMAT_D32_SFLOAT;
    description.cull_mode = VK_CULL_MODE_NONE;
    description.depth_compare = VK_COMPARE_OP_GREATER;
    return description;
}

}  // namespace heliodon::passes
