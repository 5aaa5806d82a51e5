#pragma once

#include "gpu/buffer.h"
#include "gpu/image.h"
#include "graph/graph.h"

namespace heliodon::passes {

/// The volume that cones are traced through; its owner keeps it at one address and up to date.
struct VolumeInputs {
    const gpu::Image* faces = nullptr;     ///< RGBA16F, as VolumeData says
    const gpu::Image* depths = nullptr;    ///< R16F, likewise
    const gpu::Buffer* data = nullptr;     ///< VolumeData
    VkSampler trilinear = VK_NULL_HANDLE;  ///< linear within a level, nearest level, edges clamped
};

/// Its images in a graph.
struct VolumeImages {
    graph::ImageHandle faces, depths;
};
inline void read_volume(graph::PassBuilder& pass, const VolumeImages& volume) {
    pass.read(volume.faces, graph::Usage::sampled);
    pass.read(volume.depths, graph::Usage::sampled);
}

}  // namespace heliodon::passes
