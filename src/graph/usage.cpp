#include "graph/usage.h"

namespace heliodon::graph {
namespace {

VkPipelineStageFlags2 shader_stages(PassKind kind) {
    constexpr auto compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    constexpr auto graphics = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    switch (kind) {
        case PassKind::compute:
            return compute;
        case PassKind::graphics:
            return graphics;
        case PassKind::transfer:
            break;
    }
    return compute | graphics;
}

}  // namespace

const char* usage_name(Usage usage) {
    switch (usage) {
        case Usage::sampled:
            return "sampled";
        case Usage::storage_read:
            return "storage_read";
        case Usage::storage_write:
            return "storage_write";
        case Usage::storage_read_write:
            return "storage_read_write";
        case Usage::uniform:
            return "uniform";
        case Usage::color_attachment:
            return "color_attachment";
        case Usage::depth_attachment:
            return "depth_attachment";
        case Usage::depth_stencil_attachment:
            return "depth_stencil_attachment";
        case Usage::depth_read:
            return "depth_read";
        case Usage::index_buffer:
            return "index_buffer";
        case Usage::vertex_buffer:
            return "vertex_buffer";
        case Usage::indirect:
            return "indirect";
        case Usage::transfer_read:
            return "transfer_read";
        case Usage::transfer_write:
            return "transfer_write";
        case Usage::host_read:
            return "host_read";
        case Usage::present:
            return "present";
    }
    return "unknown";
}

gpu::Access access_of(Usage usage, PassKind kind, bool reads, bool writes) {
    constexpr VkPipelineStageFlags2 depth_stages =
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkAccessFlags2 none = VK_ACCESS_2_NONE;
    switch (usage) {
        case Usage::sampled:
            return {shader_stages(kind), VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        case Usage::storage_read:
        case Usage::storage_write:
        case Usage::storage_read_write:
            return {shader_stages(kind),
                    (reads ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT : none) |
                        (writes ? VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT : none),
                    VK_IMAGE_LAYOUT_GENERAL};
        case Usage::uniform:
            return {shader_stages(kind), VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};
        case Usage::color_attachment:
            return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        case Usage::depth_attachment:
            return {depth_stages,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
        case Usage::depth_stencil_attachment:
            return {depth_stages,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
        case Usage::depth_read:
            return {depth_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                    VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
        case Usage::index_buffer:
            return {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED};
        case Usage::vertex_buffer:
            return {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
                    VK_IMAGE_LAYOUT_UNDEFINED};
        case Usage::indirect:
            return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                    VK_IMAGE_LAYOUT_UNDEFINED};
        case Usage::transfer_read:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
        case Usage::transfer_write:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
        case Usage::host_read:
            return {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
        case Usage::present:
            return {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
    }
    return {};
}

VkImageUsageFlags image_usage(Usage usage) {
    switch (usage) {
        case Usage::sampled:
            return VK_IMAGE_USAGE_SAMPLED_BIT;
        case Usage::storage_read:
        case Usage::storage_write:
        case Usage::storage_read_write:
            return VK_IMAGE_USAGE_STORAGE_BIT;
        case Usage::color_attachment:
            return VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        case Usage::depth_attachment:
        case Usage::depth_stencil_attachment:
        case Usage::depth_read:
            return VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        case Usage::transfer_read:
            return VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        case Usage::transfer_write:
            return VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        default:
            return 0;
    }
}

VkBufferUsageFlags buffer_usage(Usage usage) {
    switch (usage) {
        case Usage::storage_read:
        case Usage::storage_write:
        case Usage::storage_read_write:
            return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        case Usage::uniform:
            return VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
        case Usage::index_buffer:
            return VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
        case Usage::vertex_buffer:
            return VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
        case Usage::indirect:
            return VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
        case Usage::transfer_read:
            return VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        case Usage::transfer_write:
            return VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        default:
            return 0;
    }
}

bool usage_writes(Usage usage) {
    return usage == Usage::storage_write || usage == Usage::storage_read_write || usage == Usage::color_attachment ||
           usage == Usage::depth_attachment || usage == Usage::depth_stencil_attachment || usage == Usage::transfer_write;
}

bool usage_reads(Usage usage) {
    return !usage_writes(usage) || usage == Usage::storage_read_write;
}

}  // namespace heliodon::graph
