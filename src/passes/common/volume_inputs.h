#pragma once

#include "gpu/buffer.h"
#include "gpu/image.h"
#include "gpu/pipeline.h"
#include "graph/graph.h"

namespace heliodon::passes {

/// The volume that cones are traced through; its owner keeps it at one address and up to date.
struct VolumeInputs {
    const gpu::Image* faces = nullptr;     ///< RGBA16F, as VolumeData says
    const gpu::Image* depths = nullptr;    ///< R16F, likewise
    const gpu::Buffer* data = nullptr;     ///< VolumeData
    const gpu::Buffer* occupancy = nullptr;  ///< a byte a texel (passes/occupancy)
    VkSampler trilinear = VK_NULL_HANDLE;  ///< linear within a level, nearest level, edges clamped
    bool nested = false;                   ///< of several cascades; pipelines are chosen by it
};

/// Constant 6 of every shader that traces cones, and 7 of those that look for lights' shadows with them.
[[nodiscard]] inline gpu::Specialization cone_constants(const VolumeInputs& volume, bool cone_shadows = false) {
    return {{6, volume.nested ? 1u : 0u}, {7, cone_shadows ? 1u : 0u}};
}

/// Its images in a graph, and the its occupancy.
struct VolumeImages {
    graph::ImageHandle faces, depths;
    graph::BufferHandle occupancy;
};
inline void read_volume(graph::PassBuilder& pass, const VolumeImages& volume) {
    pass.read(volume.faces, graph::Usage::sampled);
    pass.read(volume.depths, graph::Usage::sampled);
    pass.read(volume.occupancy, graph::Usage::storage_read);
}

}  // namespace heliodon::passes
