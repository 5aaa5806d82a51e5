#pragma once

#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "shading/scene_data.h"

namespace heliodon::passes {

/// What an image sky becomes for lighting: equirectangular RGBA32F maps in the sky's own orientation.
struct EnvironmentMaps {
    gpu::Image specular;    ///< mip k of n is prefiltered for roughness k/(n − 1)
    gpu::Image irradiance;  ///< irradiance / π by normal
};
/// The picture, with all its levels, of a sky that is a formula; in the sky's own orientation. Waits for the GPU.
[[nodiscard]] Result<gpu::Image> draw_sky(gpu::Device& device, gpu::Pipelines& pipelines, const shading::SkyData& sky);

/// Prefilters the sky in bindless slot `source` (`width` texels wide). Waits for the GPU: skies change seldom.
[[nodiscard]] Result<EnvironmentMaps> prefilter_environment(gpu::Device& device, gpu::Pipelines& pipelines,
                                                            std::uint32_t source, std::uint32_t width);

}  // namespace heliodon::passes
