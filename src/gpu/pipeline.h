#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/shader.h"
#include "gpu/vulkan.h"

namespace heliodon::gpu {

class Device;

/// Values of specialization constants by constant_id (bit patterns; floats by std::bit_cast).
using Specialization = std::map<std::uint32_t, std::uint32_t>;

/// The shaders' common interface: set 0 holds the pass's own resources, set 1 the bindless textures.
class PipelineLayout {
public:
    /// Error when two stages disagree about a binding, or a set other than 0 and 1 is used.
    [[nodiscard]] static Result<PipelineLayout> create(Device& device, const std::string& name,
                                                       std::span<const std::shared_ptr<const Shader>> shaders);
    PipelineLayout() = default;
    ~PipelineLayout();
    PipelineLayout(PipelineLayout&& other) noexcept;
    PipelineLayout& operator=(PipelineLayout&& other) noexcept;

    [[nodiscard]] VkPipelineLayout handle() const { return handle_; }
    [[nodiscard]] VkDescriptorSetLayout set_layout() const { return set_layout_; }
    /// Set 0, by binding number.
    [[nodiscard]] const std::vector<ShaderBinding>& bindings() const { return bindings_; }
    /// Descriptors of set 0, array elements counted one by one.
    [[nodiscard]] std::uint32_t descriptor_count() const { return descriptor_count_; }
    [[nodiscard]] std::uint32_t push_constant_bytes() const { return push_constant_bytes_; }
    [[nodiscard]] VkShaderStageFlags push_constant_stages() const { return push_constant_stages_; }
    [[nodiscard]] bool uses_textures() const { return uses_textures_; }
    /// Set 0 is pushed into the command buffer; otherwise it is allocated.
    [[nodiscard]] bool push_descriptors() const { return push_descriptors_; }

private:
    [[nodiscard]] Result<void> create_handles(const std::string& name);

    Device* device_ = nullptr;
    VkPipelineLayout handle_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    std::vector<ShaderBinding> bindings_;
    std::uint32_t descriptor_count_ = 0, push_constant_bytes_ = 0;
    VkShaderStageFlags push_constant_stages_ = 0;
    bool uses_textures_ = false, push_descriptors_ = false;
};

/// What compute and graphics pipelines share: a name, a layout and the Vulkan pipeline.
class Pipeline {
public:
    Pipeline() = default;
    ~Pipeline();
    Pipeline(Pipeline&& other) noexcept;
    Pipeline& operator=(Pipeline&& other) noexcept;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] VkPipeline handle() const { return handle_; }
    [[nodiscard]] const PipelineLayout& layout() const { return layout_; }

protected:
    Device* device_ = nullptr;
    std::string name_;
    VkPipeline handle_ = VK_NULL_HANDLE;
    PipelineLayout layout_;
};

class ComputePipeline : public Pipeline {
public:
    [[nodiscard]] static Result<ComputePipeline> create(Device& device, std::shared_ptr<const Shader> shader,
                                                        const Specialization& specialization = {});
    [[nodiscard]] const std::array<std::uint32_t, 3>& workgroup_size() const { return workgroup_size_; }

private:
    std::array<std::uint32_t, 3> workgroup_size_{1, 1, 1};
};

enum class Blend {
    none,
    keep,           ///< nothing is written
    alpha,          ///< source-over, straight alpha
    premultiplied,  ///< source-over, premultiplied alpha
    additive,
};

/// What becomes of the stencil under a fragment on one side of a triangle. The reference is 0.
struct StencilSide {
    VkCompareOp compare = VK_COMPARE_OP_ALWAYS;
    VkStencilOp pass = VK_STENCIL_OP_KEEP, depth_fail = VK_STENCIL_OP_KEEP;
};
struct StencilTest {
    StencilSide front, back;
};

/// Defaults: vertices pulled from buffers by the shader, triangles, back faces culled with counter-clockwise fronts
/// (as seen in a y-up clip space, i.e. with the flipped viewport that Commands::begin_rendering sets), depth tested
/// and written when there is a depth format.
struct GraphicsDescription {
    std::string name;                        ///< unique among the pipelines of one Pipelines
    std::string vertex, fragment, geometry;  ///< shader names; `fragment` and `geometry` may be empty
    Specialization specialization;           ///< of all stages
    std::vector<VkFormat> color_formats;
    VkFormat depth_format = VK_FORMAT_UNDEFINED;
    std::vector<Blend> blend;  ///< by colour attachment; missing ones: none
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPolygonMode polygon_mode = VK_POLYGON_MODE_FILL;
    VkCullModeFlags cull_mode = VK_CULL_MODE_BACK_BIT;
    VkFrontFace front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    bool depth_test = true, depth_write = true;
    VkCompareOp depth_compare = VK_COMPARE_OP_LESS;
    std::optional<StencilTest> stencil;  ///< the depth format must have one
    bool depth_clamp = false;
    float depth_bias_constant = 0, depth_bias_slope = 0;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    std::uint32_t view_mask = 0;  ///< multiview: one bit a layer
    /// Conservative rasterization: every pixel is drawn that a primitive grown by so many pixels touches. The device
    /// must have it (DeviceInfo::conservative_rasterization).
    std::optional<float> conservative_px;
    std::vector<VkVertexInputBindingDescription> vertex_buffers;
    std::vector<VkVertexInputAttributeDescription> vertex_attributes;
};

class GraphicsPipeline : public Pipeline {
public:
    [[nodiscard]] static Result<GraphicsPipeline> create(Device& device, const GraphicsDescription& description,
                                                         std::span<const std::shared_ptr<const Shader>> shaders);
};

/// The pipelines of a renderer by name, made on first use; their addresses stay valid as long as this lives, also
/// over a reload, which swaps in the new code.
class Pipelines {
public:
    Pipelines(Device& device, ShaderLibrary shaders);

    /// `name` is a shader's ("passes/shade/shade.comp").
    [[nodiscard]] Result<const ComputePipeline*> compute(const std::string& name,
                                                         const Specialization& specialization = {});
    [[nodiscard]] Result<const GraphicsPipeline*> graphics(const GraphicsDescription& description);
    /// Compiles changed shaders and remakes their pipelines; on an error the old ones stay in use.
    [[nodiscard]] ShaderReload reload();
    [[nodiscard]] Device& device() const { return *device_; }
    [[nodiscard]] ShaderLibrary& shaders() { return shaders_; }

private:
    struct Compute {
        std::string shader;
        Specialization specialization;
        ComputePipeline pipeline;
    };
    struct Graphics {
        GraphicsDescription description;
        GraphicsPipeline pipeline;
    };
    [[nodiscard]] Result<ComputePipeline> make(const std::string& shader, const Specialization& specialization);
    [[nodiscard]] Result<GraphicsPipeline> make(const GraphicsDescription& description);

    Device* device_;
    ShaderLibrary shaders_;
    std::vector<std::unique_ptr<Compute>> compute_;
    std::vector<std::unique_ptr<Graphics>> graphics_;
};

}  // namespace heliodon::gpu
