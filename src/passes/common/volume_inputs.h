#pragma once

#include "gpu/buffer.h"
#include "gpu/image.h"

namespace heliodon::passes {

/// The volume that cones are traced through; its owner keeps it at one address and up to date.
struct VolumeInputs {
    const gpu::Image* faces = nullptr;     ///< RGBA16F, as VolumeData says
    const gpu::Buffer* data = nullptr;     ///< VolumeData
    VkSampler trilinear = VK_NULL_HANDLE;  ///< linear within a level, nearest level, edges clamped
};

}  // namespace heliodon::passes
