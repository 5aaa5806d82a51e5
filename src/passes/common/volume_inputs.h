#pragma once

#include "gpu/buffer.h"
#include "gpu/image.h"
#include "gpu/pipeline.h"
#include "graph/graph.h"
#include "passes/common/scene_inputs.h"

namespace heliodon::passes {

/// The volume that cones are traced through; its owner keeps it at one address and up to date.
struct VolumeInputs {
    const gpu::Image* faces = nullptr;     ///< RGBA16F, as VolumeData says
    const gpu::Image* depths = nullptr;    ///< R16F, likewise
    const gpu::Image* lobes = nullptr;     ///< RGBA16F, likewise; a texel a side where there are none
    const gpu::Buffer* data = nullptr;     ///< VolumeData
    const gpu::Buffer* occupancy = nullptr;  ///< a byte a texel (passes/occupancy)
    VkSampler trilinear = VK_NULL_HANDLE;  ///< linear within a level, nearest level, edges clamped
    bool nested = false;                   ///< of several cascades; pipelines are chosen by it
    bool has_lobes = false;                ///< likewise: what lights' light surfaces reflect specularly stands in `lobes`
};

/// Constants 6 and 22 of every shader that traces cones, and 7 of those that look for lights' shadows with them.
[[nodiscard]] inline gpu::Specialization cone_constants(const VolumeInputs& volume, bool cone_shadows = false) {
    return {{6, volume.nested ? 1u : 0u}, {7, cone_shadows ? 1u : 0u}, {22, volume.has_lobes ? 1u : 0u}};
}

/// `own` and the bindings of volume.glsl.
[[nodiscard]] inline std::vector<NumberedBinding> with_volume(const VolumeInputs& volume, std::vector<NumberedBinding> own) {
    own.insert(own.end(), {{20, gpu::Binding(*volume.faces, volume.trilinear)},
                           {21, *volume.data},
                           {22, gpu::Binding(*volume.depths, volume.trilinear)},
                           {23, *volume.occupancy},
                           {30, gpu::Binding(*volume.lobes, volume.trilinear)}});
    return own;
}

/// Its images in a graph, and its occupancy.
struct VolumeImages {
    graph::ImageHandle faces, depths, lobes;
    graph::BufferHandle occupancy;
};
inline void read_volume(graph::PassBuilder& pass, const VolumeImages& volume) {
    pass.read(volume.faces, graph::Usage::sampled);
    pass.read(volume.depths, graph::Usage::sampled);
    pass.read(volume.lobes, graph::Usage::sampled);
    pass.read(volume.occupancy, graph::Usage::storage_read);
}

}  // namespace heliodon::passes
