#pragma once

#include <optional>

#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "gpu/timestamps.h"
#include "shading/scene_data.h"

namespace heliodon::passes {

/// What a sky becomes for lighting: equirectangular RGBA32F maps in the sky's own orientation.
struct EnvironmentMaps {
    gpu::Image picture;     ///< with all its levels, of a sky that is a formula; else none
    gpu::Buffer record;     ///< SkyData that it is drawn from
    gpu::Image specular;    ///< mip k of n is prefiltered for roughness k/(n − 1)
    gpu::Image irradiance;  ///< irradiance / π by normal
    gpu::Image reflected;   ///< the irradiance map's own: what a shell about the scene reflects of the sky (shading/ambient.h)
};
/// Makes room for the maps of a sky `width` texels wide, or of a formula (0). True where images were made anew.
[[nodiscard]] Result<bool> reserve_environment(gpu::Device& device, EnvironmentMaps& maps, std::uint32_t width);

struct EnvironmentWork {
    const gpu::Image* image = nullptr;  ///< of the sky; none of a formula
    VkSampler sampler = VK_NULL_HANDLE;
    bool sky = true;         ///< draws and filters it; or its maps are there
    bool reflected = false;  ///< also what surroundings reflect
    bool even = false;       ///< its mean over all directions, whatever the normal
};
/// Draws the picture of a sky that is a formula (of `maps.record`, uploaded before) and filters the sky, as far as is asked.
[[nodiscard]] Result<void> record_environment(gpu::Commands& commands, gpu::Pipelines& pipelines, const EnvironmentMaps& maps,
                                              const EnvironmentWork& work, gpu::Timestamps& timestamps);

}  // namespace heliodon::passes
