#pragma once

#include <array>

#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"

struct ImDrawData;

namespace heliodon::editor {

/// Draws what Dear ImGui lists, by our own pipeline, so that no version of its Vulkan backend matters.
class Overlay {
public:
    /// An ImGui context must be current: its font atlas becomes a texture.
    [[nodiscard]] static Result<Overlay> create(gpu::Device& device, gpu::Pipelines& pipelines, VkFormat target_format);

    /// Draws over `target`, which must be a colour attachment of `extent` pixels.
    [[nodiscard]] Result<void> record(gpu::Commands& commands, const ImDrawData& data, const gpu::Image& target);

private:
    struct FrameBuffers {
        gpu::Buffer vertices, indices;
    };
    [[nodiscard]] Result<void> upload_font();
    [[nodiscard]] Result<FrameBuffers*> fill(const ImDrawData& data);

    gpu::Device* device_ = nullptr;
    const gpu::GraphicsPipeline* pipeline_ = nullptr;
    gpu::Image font_;
    std::uint32_t font_slot_ = 0;
    // The CPU writes one set while the GPU reads those of the frames before it.
    std::array<FrameBuffers, 3> frames_;
    std::size_t frame_ = 0;
};

}  // namespace heliodon::editor
