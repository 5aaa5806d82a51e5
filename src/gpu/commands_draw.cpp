// Binding of resources, dispatches and draws.
#include <fmt/format.h>

#include <algorithm>

#include "gpu/bindless_textures.h"
#include "gpu/command_recording.h"
#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/format.h"

namespace heliodon::gpu {
namespace {

const char* type_name(VkDescriptorType type) {
    switch (type) {
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
            return "a storage buffer";
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
            return "a uniform buffer";
        case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
            return "a storage image";
        case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
            return "a sampled image";
        case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
            return "an image with a sampler";
        case VK_DESCRIPTOR_TYPE_SAMPLER:
            return "a sampler";
        default:
            return "a resource of another kind";
    }
}

const char* given_name(const Binding& binding) {
    if (binding.buffer) return "a buffer";
    if (binding.view.image) return binding.sampler ? "an image with a sampler" : "an image";
    return binding.sampler ? "a sampler" : "nothing";
}

/// Descriptor contents of one set, kept together so that the writes' pointers stay valid.
struct DescriptorWrites {
    std::vector<VkDescriptorBufferInfo> buffers;
    std::vector<VkDescriptorImageInfo> images;
    std::vector<VkWriteDescriptorSet> writes;
};

Result<VkDescriptorBufferInfo> buffer_info(const ShaderBinding& declared, const Binding& given) {
    const Buffer* buffer = given.buffer;
    if (!buffer || !*buffer)
        return fail("", fmt::format("is {}, but {} was given", type_name(declared.type), given_name(given)));
    const bool uniform = declared.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (uniform && !(buffer->description().usage & VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT))
        return fail("", fmt::format("is a uniform buffer, but buffer '{}' was not created as one", buffer->name()));
    if (given.offset >= buffer->size() || (given.size != VK_WHOLE_SIZE && given.size > buffer->size() - given.offset))
        return fail("", fmt::format("reaches outside buffer '{}' of {} bytes", buffer->name(), buffer->size()));
    return VkDescriptorBufferInfo{buffer->handle(), given.offset, given.size};
}

Result<VkDescriptorImageInfo> image_info(const ShaderBinding& declared, const Binding& given) {
    const bool storage = declared.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    const bool needs_sampler = declared.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const Image* image = given.view.image;
    if (!image || !*image || (needs_sampler && !given.sampler))
        return fail("", fmt::format("is {}, but {} was given", type_name(declared.type), given_name(given)));
    if (storage && !(image->description().usage & VK_IMAGE_USAGE_STORAGE_BIT))
        return fail("", fmt::format("is a storage image, but image '{}' was not created as one", image->name()));
    ImageView part = given.view;
    if (storage && part.mips == all_remaining) part.mips = 1;  // a shader writes one level
    auto view = image->view(part, declared.view_type);
    if (!view) return tl::unexpected(view.error());
    return VkDescriptorImageInfo{given.sampler, *view,
                                 storage ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

Result<void> add_write(DescriptorWrites& all, const ShaderBinding& declared, std::uint32_t element,
                       const Binding& given) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = declared.binding;
    write.dstArrayElement = element;
    write.descriptorCount = 1;
    write.descriptorType = declared.type;
    switch (declared.type) {
        case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
        case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER: {
            auto info = buffer_info(declared, given);
            if (!info) return tl::unexpected(info.error());
            all.buffers.push_back(*info);
            write.pBufferInfo = &all.buffers.back();
            break;
        }
        case VK_DESCRIPTOR_TYPE_SAMPLER:
            if (!given.sampler) return fail("", fmt::format("is a sampler, but {} was given", given_name(given)));
            all.images.push_back({given.sampler, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
            write.pImageInfo = &all.images.back();
            break;
        default: {
            auto info = image_info(declared, given);
            if (!info) return tl::unexpected(info.error());
            all.images.push_back(*info);
            write.pImageInfo = &all.images.back();
        }
    }
    all.writes.push_back(write);
    return {};
}

/// The set's content, or what is wrong with it.
Result<void> collect_writes(DescriptorWrites& all, const Pipeline& pipeline, Bindings bindings) {
    const PipelineLayout& layout = pipeline.layout();
    const std::string where = fmt::format("pipeline '{}'", pipeline.name());
    if (bindings.size() != layout.descriptor_count()) {
        std::string names;
        for (const ShaderBinding& declared : layout.bindings())
            names += fmt::format("{}{} '{}'", names.empty() ? "" : ", ", declared.binding, declared.name);
        return fail(where, fmt::format("expected {} bindings ({}), found {}", layout.descriptor_count(), names,
                                       bindings.size()));
    }
    // Reserved, because the writes point into these.
    all.buffers.reserve(bindings.size());
    all.images.reserve(bindings.size());
    all.writes.reserve(bindings.size());
    std::size_t next = 0;
    for (const ShaderBinding& declared : layout.bindings())
        for (std::uint32_t element = 0; element < declared.count; ++element)
            if (auto added = add_write(all, declared, element, bindings[next++]); !added)
                return fail(where,
                            fmt::format("binding {} '{}' {}", declared.binding, declared.name, added.error().text()));
    return {};
}

Result<void> check_push_constants(const Pipeline& pipeline, std::size_t bytes) {
    const std::size_t declared = pipeline.layout().push_constant_bytes();
    // C++ rounds a struct's size up to its alignment, GLSL a block's does not.
    constexpr std::size_t largest_alignment = 16;
    const std::size_t padded = (declared + largest_alignment - 1) / largest_alignment * largest_alignment;
    if (bytes >= declared && bytes <= padded) return {};
    return fail(fmt::format("pipeline '{}'", pipeline.name()),
                fmt::format("expected {} bytes of push constants, found {}", declared, bytes));
}

}  // namespace

bool Commands::bind_resources(VkPipelineBindPoint point, const Pipeline& pipeline, std::span<const std::byte> push,
                              Bindings bindings) {
    if (recording_->error) return false;
    if (!pipeline.handle()) {
        fail("", "a dispatch or draw without a pipeline");
        return false;
    }
    DescriptorWrites all;
    Result<void> checked = check_push_constants(pipeline, push.size());
    if (checked) checked = collect_writes(all, pipeline, bindings);
    if (!checked) {
        fail(checked.error().where, checked.error().message);
        return false;
    }
    const PipelineLayout& layout = pipeline.layout();
    vkCmdBindPipeline(handle(), point, pipeline.handle());
    if (layout.push_constant_bytes() > 0)
        vkCmdPushConstants(handle(), layout.handle(), layout.push_constant_stages(), 0, layout.push_constant_bytes(),
                           push.data());
    const auto count = static_cast<std::uint32_t>(all.writes.size());
    if (count > 0 && layout.push_descriptors()) {
        device().functions().push_descriptor_set(handle(), point, layout.handle(), 0, count, all.writes.data());
    } else if (count > 0) {
        auto set = recording_->allocate(layout.set_layout());
        if (!set) {
            fail(set.error().where, set.error().message);
            return false;
        }
        for (auto& write : all.writes) write.dstSet = *set;
        vkUpdateDescriptorSets(device().handle(), count, all.writes.data(), 0, nullptr);
        vkCmdBindDescriptorSets(handle(), point, layout.handle(), 0, 1, &*set, 0, nullptr);
    }
    if (layout.uses_textures()) {
        const VkDescriptorSet set = device().textures().set();
        vkCmdBindDescriptorSets(handle(), point, layout.handle(), BindlessTextures::set_index, 1, &set, 0, nullptr);
    }
    return true;
}

glm::uvec3 Commands::groups_for(const ComputePipeline& pipeline, glm::uvec3 threads) {
    const auto& size = pipeline.workgroup_size();
    const glm::uvec3 group(size[0], size[1], size[2]);
    return (threads + group - 1u) / group;
}

void Commands::dispatch_bytes(const ComputePipeline& pipeline, std::span<const std::byte> push, Bindings bindings,
                              glm::uvec3 groups) {
    const auto& limit = device().limits().maxComputeWorkGroupCount;
    if (groups.x > limit[0] || groups.y > limit[1] || groups.z > limit[2])
        return fail(fmt::format("pipeline '{}'", pipeline.name()),
                    fmt::format("{}×{}×{} workgroups exceed the device's {}×{}×{}", groups.x, groups.y, groups.z,
                                limit[0], limit[1], limit[2]));
    if (!bind_resources(VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, push, bindings)) return;
    if (groups.x > 0 && groups.y > 0 && groups.z > 0) vkCmdDispatch(handle(), groups.x, groups.y, groups.z);
}

void Commands::dispatch_indirect_bytes(const ComputePipeline& pipeline, std::span<const std::byte> push,
                                       Bindings bindings, const Buffer& indirect, VkDeviceSize offset) {
    if (bind_resources(VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, push, bindings))
        vkCmdDispatchIndirect(handle(), indirect.handle(), offset);
}

void Commands::bind_bytes(const GraphicsPipeline& pipeline, std::span<const std::byte> push, Bindings bindings) {
    const bool bound = bind_resources(VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline, push, bindings);
    recording_->graphics = bound ? &pipeline : nullptr;
}

void Commands::begin_rendering(const Rendering& rendering) {
    const auto attachment = [&](const ImageView& view) {
        VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        ImageView part = view;
        if (part.mips == all_remaining) part.mips = 1;
        const bool layered = rendering.layers > 1 || rendering.view_mask != 0;
        auto handle = view.image ? view.image->view(part, layered ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D)
                                 : Result<VkImageView>(heliodon::fail("attachment", "no image was given"));
        if (handle)
            info.imageView = *handle;
        else
            fail(handle.error().where, handle.error().message);
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        return info;
    };
    std::vector<VkRenderingAttachmentInfo> color;
    for (const ColorAttachment& target : rendering.color) {
        VkRenderingAttachmentInfo info = attachment(target.view);
        info.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        info.loadOp = target.load;
        info.clearValue.color = target.clear;
        if (target.resolve.image) {
            info.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
            info.resolveImageView = attachment(target.resolve).imageView;
            info.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        }
        color.push_back(info);
    }
    VkRenderingAttachmentInfo depth{};
    bool stencil = false;
    if (rendering.depth) {
        depth = attachment(rendering.depth->view);
        stencil = rendering.depth->view.image && has_stencil(rendering.depth->view.image->format());
        depth.imageLayout = stencil                       ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                            : rendering.depth->read_only ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL
                                                         : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        depth.loadOp = rendering.depth->load;
        depth.clearValue.depthStencil.depth = rendering.depth->clear;
        if (rendering.depth->read_only) depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
    }
    if (recording_->error) return;

    VkRect2D area{};
    if (rendering.area) {
        area = *rendering.area;
    } else if (!rendering.color.empty() || rendering.depth) {
        const ImageView& first = rendering.color.empty() ? rendering.depth->view : rendering.color[0].view;
        const VkExtent3D extent = first.image->extent(first.base_mip);
        area.extent = {extent.width, extent.height};
    }
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = area;
    info.layerCount = rendering.layers;
    info.viewMask = rendering.view_mask;
    info.colorAttachmentCount = static_cast<std::uint32_t>(color.size());
    info.pColorAttachments = color.data();
    info.pDepthAttachment = rendering.depth ? &depth : nullptr;
    info.pStencilAttachment = stencil ? &depth : nullptr;
    vkCmdBeginRendering(handle(), &info);
    recording_->rendering = true;
    set_viewport(area);
}

void Commands::end_rendering() {
    if (recording_->rendering) vkCmdEndRendering(handle());
    recording_->rendering = false;
    recording_->graphics = nullptr;
}

void Commands::set_viewport(VkRect2D area) {
    const auto x = static_cast<float>(area.offset.x), y = static_cast<float>(area.offset.y);
    const auto width = static_cast<float>(area.extent.width), height = static_cast<float>(area.extent.height);
    const VkViewport viewport{x, y + height, width, -height, 0.0f, 1.0f};
    vkCmdSetViewport(handle(), 0, 1, &viewport);
    set_scissor(area);
}

void Commands::set_scissor(VkRect2D area) {
    vkCmdSetScissor(handle(), 0, 1, &area);
}

void Commands::draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t first_vertex,
                    std::uint32_t first_instance) {
    if (can_draw()) vkCmdDraw(handle(), vertices, instances, first_vertex, first_instance);
}

void Commands::bind_index_buffer(const Buffer& buffer, VkIndexType type, VkDeviceSize offset) {
    if (!(buffer.description().usage & VK_BUFFER_USAGE_INDEX_BUFFER_BIT))
        return fail(fmt::format("buffer '{}'", buffer.name()), "was not created as an index buffer");
    vkCmdBindIndexBuffer(handle(), buffer.handle(), offset, type);
}

void Commands::bind_vertex_buffer(std::uint32_t binding, const Buffer& buffer, VkDeviceSize offset) {
    const VkBuffer vertex_buffer = buffer.handle();
    vkCmdBindVertexBuffers(handle(), binding, 1, &vertex_buffer, &offset);
}

void Commands::draw_indexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t first_index,
                            std::int32_t vertex_offset, std::uint32_t first_instance) {
    if (can_draw()) vkCmdDrawIndexed(handle(), indices, instances, first_index, vertex_offset, first_instance);
}

void Commands::draw_indexed_indirect(const Buffer& commands, VkDeviceSize offset, std::uint32_t count,
                                     std::uint32_t stride) {
    if (can_draw() && count > 0) vkCmdDrawIndexedIndirect(handle(), commands.handle(), offset, count, stride);
}

void Commands::draw_indexed_indirect_count(const Buffer& commands, VkDeviceSize offset, const Buffer& count_buffer,
                                           VkDeviceSize count_offset, std::uint32_t max_count, std::uint32_t stride) {
    if (can_draw())
        vkCmdDrawIndexedIndirectCount(handle(), commands.handle(), offset, count_buffer.handle(), count_offset,
                                      max_count, stride);
}

void Commands::draw_indirect(const Buffer& commands, VkDeviceSize offset, std::uint32_t count, std::uint32_t stride) {
    if (can_draw() && count > 0) vkCmdDrawIndirect(handle(), commands.handle(), offset, count, stride);
}

bool Commands::can_draw() {
    if (recording_->error) return false;
    if (!recording_->rendering)
        fail("draw", "outside begin_rendering and end_rendering");
    else if (!recording_->graphics)
        fail("draw", "no pipeline is bound");
    return !recording_->error;
}

}  // namespace heliodon::gpu
