#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/image.h"
#include "gpu/pipeline.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

class Device;
struct CommandRecording;

/// One descriptor's content. What it becomes (storage or sampled, 2D or cube …) the shader's declaration says;
/// images are expected in SHADER_READ_ONLY_OPTIMAL when sampled and in GENERAL when storage.
struct Binding {
    Binding(const Buffer& buffer_, VkDeviceSize offset_ = 0, VkDeviceSize size_ = VK_WHOLE_SIZE)
        : buffer(&buffer_), offset(offset_), size(size_) {}
    Binding(const Image& image_, VkSampler sampler_ = VK_NULL_HANDLE) : view{&image_}, sampler(sampler_) {}
    Binding(const ImageView& view_, VkSampler sampler_ = VK_NULL_HANDLE) : view(view_), sampler(sampler_) {}
    explicit Binding(VkSampler sampler_) : sampler(sampler_) {}

    const Buffer* buffer = nullptr;
    VkDeviceSize offset = 0, size = VK_WHOLE_SIZE;
    ImageView view;
    VkSampler sampler = VK_NULL_HANDLE;
};
using Bindings = std::span<const Binding>;

/// Push constants of a shader that has none.
struct NoPushConstants {};

struct ColorAttachment {
    ImageView view;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_CLEAR;
    VkClearColorValue clear{};
    ImageView resolve;  ///< of a multisampled `view`; none by default
};
/// And the stencil, where the format has one: it is cleared to 0.
struct DepthAttachment {
    ImageView view;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_CLEAR;
    float clear = 1.0f;
    bool read_only = false;
};
struct Rendering {
    std::vector<ColorAttachment> color;
    std::optional<DepthAttachment> depth;
    std::uint32_t layers = 1;
    std::uint32_t view_mask = 0;
    /// Pixels; by default the whole first attachment, and required where there is none. The viewport is flipped: clip-space +y is up in the picture.
    std::optional<VkRect2D> area;
};

/// A command buffer being recorded. Every call that cannot be recorded (wrong binding, wrong push constants)
/// records nothing and keeps the first error, with pass, pipeline and binding named; Device::submit then refuses.
class Commands {
public:
    Commands(Commands&&) noexcept;
    Commands& operator=(Commands&&) noexcept;
    ~Commands();

    [[nodiscard]] VkCommandBuffer handle() const;
    [[nodiscard]] Device& device() const;
    [[nodiscard]] const std::optional<Error>& error() const;
    void fail(std::string where, std::string message);

    /// `groups` workgroups. Bindings are those of set 0 in order of binding number, arrays element by element.
    template <class Push>
    void dispatch(const ComputePipeline& pipeline, const Push& push, std::initializer_list<Binding> bindings,
                  glm::uvec3 groups) {
        dispatch_bytes(pipeline, bytes_of(push), Bindings(bindings.begin(), bindings.size()), groups);
    }
    template <class Push>
    void dispatch(const ComputePipeline& pipeline, const Push& push, Bindings bindings, glm::uvec3 groups) {
        dispatch_bytes(pipeline, bytes_of(push), bindings, groups);
    }
    /// At least `threads` invocations: as many workgroups as cover them.
    template <class Push>
    void dispatch_threads(const ComputePipeline& pipeline, const Push& push, std::initializer_list<Binding> bindings,
                          glm::uvec3 threads) {
        dispatch_bytes(pipeline, bytes_of(push), Bindings(bindings.begin(), bindings.size()),
                       groups_for(pipeline, threads));
    }
    template <class Push>
    void dispatch_threads(const ComputePipeline& pipeline, const Push& push, Bindings bindings, glm::uvec3 threads) {
        dispatch_bytes(pipeline, bytes_of(push), bindings, groups_for(pipeline, threads));
    }
    /// The group counts are a VkDispatchIndirectCommand in `indirect` (created with indirect usage).
    template <class Push>
    void dispatch_indirect(const ComputePipeline& pipeline, const Push& push, std::initializer_list<Binding> bindings,
                           const Buffer& indirect, VkDeviceSize offset = 0) {
        dispatch_indirect_bytes(pipeline, bytes_of(push), Bindings(bindings.begin(), bindings.size()), indirect,
                                offset);
    }
    template <class Push>
    void dispatch_indirect(const ComputePipeline& pipeline, const Push& push, Bindings bindings, const Buffer& indirect,
                           VkDeviceSize offset = 0) {
        dispatch_indirect_bytes(pipeline, bytes_of(push), bindings, indirect, offset);
    }

    /// Viewport and scissor are set to the area.
    void begin_rendering(const Rendering& rendering);
    void end_rendering();
    void set_viewport(VkRect2D area);  ///< y up, and the scissor with it
    void set_scissor(VkRect2D area);
    /// Pipeline, push constants and set 0 for the draws that follow.
    template <class Push>
    void bind(const GraphicsPipeline& pipeline, const Push& push, std::initializer_list<Binding> bindings) {
        bind_bytes(pipeline, bytes_of(push), Bindings(bindings.begin(), bindings.size()));
    }
    template <class Push>
    void bind(const GraphicsPipeline& pipeline, const Push& push, Bindings bindings) {
        bind_bytes(pipeline, bytes_of(push), bindings);
    }
    void draw(std::uint32_t vertices, std::uint32_t instances = 1, std::uint32_t first_vertex = 0,
              std::uint32_t first_instance = 0);
    void bind_index_buffer(const Buffer& buffer, VkIndexType type = VK_INDEX_TYPE_UINT32, VkDeviceSize offset = 0);
    void bind_vertex_buffer(std::uint32_t binding, const Buffer& buffer, VkDeviceSize offset = 0);
    void draw_indexed(std::uint32_t indices, std::uint32_t instances = 1, std::uint32_t first_index = 0,
                      std::int32_t vertex_offset = 0, std::uint32_t first_instance = 0);
    /// `count` VkDrawIndexedIndirectCommand.
    void draw_indexed_indirect(const Buffer& commands, VkDeviceSize offset, std::uint32_t count,
                               std::uint32_t stride = sizeof(VkDrawIndexedIndirectCommand));
    /// As many as the 32-bit number in `count_buffer` says, at most `max_count`.
    void draw_indexed_indirect_count(const Buffer& commands, VkDeviceSize offset, const Buffer& count_buffer,
                                     VkDeviceSize count_offset, std::uint32_t max_count,
                                     std::uint32_t stride = sizeof(VkDrawIndexedIndirectCommand));
    void draw_indirect(const Buffer& commands, VkDeviceSize offset, std::uint32_t count,
                       std::uint32_t stride = sizeof(VkDrawIndirectCommand));

    void fill(const Buffer& buffer, std::uint32_t value, VkDeviceSize offset = 0, VkDeviceSize size = VK_WHOLE_SIZE);
    void copy(const Buffer& from, const Buffer& to, VkDeviceSize bytes, VkDeviceSize from_offset = 0,
              VkDeviceSize to_offset = 0);
    /// Same extent and format, mip 0 and layer 0 of each part; TRANSFER_SRC and TRANSFER_DST layouts.
    void copy(const ImageView& from, const ImageView& to);
    void copy(const ImageView& from, const Buffer& to, VkDeviceSize to_offset = 0);
    /// With scaling and format conversion.
    void blit(const ImageView& from, const ImageView& to, VkFilter filter = VK_FILTER_LINEAR);
    /// The image must be in TRANSFER_DST_OPTIMAL.
    void clear(const ImageView& view, VkClearColorValue value);
    void clear_depth(const ImageView& view, float value);

    /// Barriers by hand, for steps inside one pass; between passes the frame graph places them.
    void barrier(const ImageView& view, const Access& before, const Access& after);
    void memory_barrier(const Access& before, const Access& after);
    /// What compute shaders wrote is seen by the compute shaders that follow.
    void compute_barrier();
    void barriers(std::span<const VkImageMemoryBarrier2> images, std::span<const VkMemoryBarrier2> memory);
    /// Brings the whole image from its tracked state to this one, and tracks it.
    void transition(const Image& image, const Access& after);

    void begin_label(const std::string& name);
    void end_label();

private:
    friend class Device;
    explicit Commands(std::unique_ptr<CommandRecording> recording);

    template <class Push>
    [[nodiscard]] static std::span<const std::byte> bytes_of(const Push& push) {
        static_assert(std::is_trivially_copyable_v<Push>);
        if constexpr (std::is_empty_v<Push>)
            return {};
        else
            return std::as_bytes(std::span<const Push, 1>(&push, 1));
    }
    [[nodiscard]] static glm::uvec3 groups_for(const ComputePipeline& pipeline, glm::uvec3 threads);
    void dispatch_bytes(const ComputePipeline& pipeline, std::span<const std::byte> push, Bindings bindings,
                        glm::uvec3 groups);
    void dispatch_indirect_bytes(const ComputePipeline& pipeline, std::span<const std::byte> push, Bindings bindings,
                                 const Buffer& indirect, VkDeviceSize offset);
    void bind_bytes(const GraphicsPipeline& pipeline, std::span<const std::byte> push, Bindings bindings);
    [[nodiscard]] bool can_draw();
    [[nodiscard]] bool bind_resources(VkPipelineBindPoint point, const Pipeline& pipeline,
                                      std::span<const std::byte> push, Bindings bindings);

    std::unique_ptr<CommandRecording> recording_;
};

}  // namespace heliodon::gpu
