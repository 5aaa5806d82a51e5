#pragma once

#include "gpu/vulkan.h"

namespace heliodon::graph {

/// Which shaders a pass runs; shader accesses of its declared usages happen in these stages.
enum class PassKind { compute, graphics, transfer };

/// How a pass uses a resource.
enum class Usage {
    sampled,             ///< read through a sampler or texelFetch; images in SHADER_READ_ONLY_OPTIMAL
    storage_read,        ///< buffer, or storage image in GENERAL
    storage_write,       ///< as above
    storage_read_write,  ///< as above: keeps what is there, atomics
    uniform,             ///< uniform buffer
    color_attachment,    ///< written; declared with read_write() it also keeps what is there (load, blending)
    depth_attachment,    ///< tested and written
    depth_stencil_attachment,  ///< likewise, with a stencil
    depth_read,          ///< tested only
    index_buffer,
    vertex_buffer,
    indirect,  ///< draw or dispatch arguments and counts
    transfer_read,
    transfer_write,
    host_read,  ///< read by the CPU after the frame
    present,    ///< shown by a window system
};

[[nodiscard]] const char* usage_name(Usage usage);
/// Stages, accesses and layout of a usage. `reads` and `writes`: what the pass declared.
[[nodiscard]] gpu::Access access_of(Usage usage, PassKind kind, bool reads, bool writes);
[[nodiscard]] VkImageUsageFlags image_usage(Usage usage);
[[nodiscard]] VkBufferUsageFlags buffer_usage(Usage usage);
[[nodiscard]] bool usage_reads(Usage usage);
[[nodiscard]] bool usage_writes(Usage usage);

}  // namespace heliodon::graph
