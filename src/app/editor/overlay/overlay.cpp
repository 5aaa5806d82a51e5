#include "app/editor/overlay/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cstring>

#include "app/editor/overlay/overlay_shared.h"
#include "gpu/bindless_textures.h"

namespace heliodon::editor {
namespace {

static_assert(sizeof(ImDrawVert) == 20 && sizeof(ImDrawIdx) == 2, "overlay.vert reads this layout");

Result<void> grow(gpu::Device& device, gpu::Buffer& buffer, const char* name, std::size_t bytes, VkBufferUsageFlags usage) {
    if (buffer && buffer.size() >= bytes) return {};
    auto grown = gpu::Buffer::create(device, {name, std::max<VkDeviceSize>(2 * bytes, 65536), usage, gpu::BufferMemory::upload});
    if (!grown) return tl::unexpected(grown.error());
    buffer = std::move(*grown);
    return {};
}

VkRect2D scissor(const ImVec4& clip, const ImDrawData& data, VkExtent3D extent) {
    const auto inside = [](float value, std::uint32_t limit) { return std::clamp(static_cast<int>(value), 0, static_cast<int>(limit)); };
    const int left = inside(clip.x - data.DisplayPos.x, extent.width), right = inside(clip.z - data.DisplayPos.x, extent.width);
    const int top = inside(clip.y - data.DisplayPos.y, extent.height), bottom = inside(clip.w - data.DisplayPos.y, extent.height);
    return {{left, top}, {static_cast<std::uint32_t>(std::max(right - left, 0)), static_cast<std::uint32_t>(std::max(bottom - top, 0))}};
}

}  // namespace

Result<Overlay> Overlay::create(gpu::Device& device, gpu::Pipelines& pipelines, VkFormat target_format) {
    Overlay overlay;
    overlay.device_ = &device;
    gpu::GraphicsDescription description;
    description.name = "overlay";
    description.vertex = "app/editor/overlay/overlay.vert";
    description.fragment = "app/editor/overlay/overlay.frag";
    description.color_formats = {target_format};
    description.blend = {gpu::Blend::alpha};
    description.cull_mode = VK_CULL_MODE_NONE;
    const auto pipeline = pipelines.graphics(description);
    if (!pipeline) return tl::unexpected(pipeline.error());
    overlay.pipeline_ = *pipeline;
    if (auto uploaded = overlay.upload_font(); !uploaded) return tl::unexpected(uploaded.error());
    return overlay;
}

Result<void> Overlay::upload_font() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    gpu::ImageDescription description;
    description.name = "overlay font";
    description.extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1};
    auto image = gpu::Image::create(*device_, description);
    if (!image) return tl::unexpected(image.error());
    font_ = std::move(*image);
    const std::span bytes(reinterpret_cast<const std::byte*>(pixels), std::size_t{4} * width * height);
    if (auto uploaded = device_->upload(font_, bytes); !uploaded) return uploaded;
    const auto sampler = device_->sampler(gpu::SamplerDescription::linear_clamp());
    if (!sampler) return tl::unexpected(sampler.error());
    const auto slot = device_->textures().add(font_, *sampler);
    if (!slot) return tl::unexpected(slot.error());
    font_slot_ = *slot;
    return {};
}

Result<Overlay::FrameBuffers*> Overlay::fill(const ImDrawData& data) {
    frame_ = (frame_ + 1) % frames_.size();
    FrameBuffers& frame = frames_[frame_];
    const std::size_t vertex_bytes = data.TotalVtxCount * sizeof(ImDrawVert), index_bytes = data.TotalIdxCount * sizeof(ImDrawIdx);
    if (auto grown = grow(*device_, frame.vertices, "overlay vertices", vertex_bytes, 0); !grown) return tl::unexpected(grown.error());
    if (auto grown = grow(*device_, frame.indices, "overlay indices", index_bytes, VK_BUFFER_USAGE_INDEX_BUFFER_BIT); !grown)
        return tl::unexpected(grown.error());
    std::byte* vertex = frame.vertices.mapped().data();
    std::byte* index = frame.indices.mapped().data();
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        std::memcpy(vertex, list.VtxBuffer.Data, list.VtxBuffer.size_in_bytes());
        std::memcpy(index, list.IdxBuffer.Data, list.IdxBuffer.size_in_bytes());
        vertex += list.VtxBuffer.size_in_bytes();
        index += list.IdxBuffer.size_in_bytes();
    }
    return &frame;
}

Result<void> Overlay::record(gpu::Commands& commands, const ImDrawData& data, const gpu::Image& target) {
    if (data.TotalIdxCount == 0) return {};
    const auto frame = fill(data);
    if (!frame) return tl::unexpected(frame.error());
    gpu::Rendering rendering;
    rendering.color = {{.view = {&target}, .load = VK_ATTACHMENT_LOAD_OP_LOAD}};
    commands.begin_rendering(rendering);
    // The viewport is flipped (clip-space y up), the overlay's y runs down.
    shading::OverlayPush push{};
    push.scale = {2.0f / data.DisplaySize.x, -2.0f / data.DisplaySize.y};
    push.shift = {-1.0f - data.DisplayPos.x * push.scale.x, 1.0f - data.DisplayPos.y * push.scale.y};
    push.texture_slot = font_slot_;
    commands.bind(*pipeline_, push, {(*frame)->vertices});
    commands.bind_index_buffer((*frame)->indices, VK_INDEX_TYPE_UINT16);
    std::uint32_t first_index = 0;
    std::int32_t first_vertex = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const VkRect2D area = scissor(command.ClipRect, data, target.extent());
            if (command.UserCallback || area.extent.width == 0 || area.extent.height == 0) continue;
            commands.set_scissor(area);
            commands.draw_indexed(command.ElemCount, 1, first_index + command.IdxOffset,
                                  first_vertex + static_cast<std::int32_t>(command.VtxOffset));
        }
        first_index += static_cast<std::uint32_t>(list.IdxBuffer.Size);
        first_vertex += list.VtxBuffer.Size;
    }
    commands.end_rendering();
    return {};
}

}  // namespace heliodon::editor
