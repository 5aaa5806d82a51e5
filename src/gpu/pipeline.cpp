#include "gpu/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gpu/bindless_textures.h"
#include "gpu/device.h"
#include "gpu/format.h"

namespace heliodon::gpu {
namespace {

/// VkSpecializationInfo and the arrays it points to.
struct SpecializationData {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    VkSpecializationInfo info{};

    explicit SpecializationData(const Specialization& specialization) {
        for (const auto& [id, value] : specialization) {
            entries.push_back(
                {id, static_cast<std::uint32_t>(values.size() * sizeof(std::uint32_t)), sizeof(std::uint32_t)});
            values.push_back(value);
        }
        info.mapEntryCount = static_cast<std::uint32_t>(entries.size());
        info.pMapEntries = entries.data();
        info.dataSize = values.size() * sizeof(std::uint32_t);
        info.pData = values.data();
    }
};

/// A shader module for as long as a pipeline is made from it.
class Module {
public:
    Module(const Device& device, const Shader& shader) : device_(device) {
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        info.codeSize = shader.code.size() * sizeof(std::uint32_t);
        info.pCode = shader.code.data();
        result_ = vkCreateShaderModule(device.handle(), &info, nullptr, &handle_);
        if (result_ == VK_SUCCESS)
            device.set_name(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<std::uint64_t>(handle_), shader.name);
    }
    ~Module() {
        if (handle_) vkDestroyShaderModule(device_.handle(), handle_, nullptr);
    }
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;
    [[nodiscard]] VkShaderModule handle() const { return handle_; }
    [[nodiscard]] VkResult result() const { return result_; }

private:
    const Device& device_;
    VkShaderModule handle_ = VK_NULL_HANDLE;
    VkResult result_ = VK_SUCCESS;
};

VkPipelineShaderStageCreateInfo stage_info(const Shader& shader, const Module& module, const SpecializationData& data) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = shader.reflection.stage;
    info.module = module.handle();
    info.pName = "main";
    info.pSpecializationInfo = data.entries.empty() ? nullptr : &data.info;
    return info;
}

VkPipelineColorBlendAttachmentState blend_state(Blend blend) {
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    if (blend == Blend::keep) state.colorWriteMask = 0;
    state.blendEnable = blend != Blend::none && blend != Blend::keep;
    state.srcColorBlendFactor = blend == Blend::alpha ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
    state.dstColorBlendFactor = blend == Blend::additive ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.colorBlendOp = VK_BLEND_OP_ADD;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstAlphaBlendFactor = state.dstColorBlendFactor;
    state.alphaBlendOp = VK_BLEND_OP_ADD;
    return state;
}

VkStencilOpState stencil_state(const StencilSide& side) {
    constexpr std::uint32_t all_bits = 0xff;
    return {VK_STENCIL_OP_KEEP, side.pass, side.depth_fail, side.compare, all_bits, all_bits, 0};
}

/// The fixed-function state of a graphics pipeline; Vulkan's structures point into this object.
class GraphicsStates {
public:
    explicit GraphicsStates(const GraphicsDescription& description) {
        set_input(description);
        set_rasterization(description);
        set_output(description);
    }
    GraphicsStates(const GraphicsStates&) = delete;
    GraphicsStates& operator=(const GraphicsStates&) = delete;

    [[nodiscard]] VkGraphicsPipelineCreateInfo create_info() const {
        VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
        info.pNext = &rendering_;
        info.pVertexInputState = &vertex_input_;
        info.pInputAssemblyState = &assembly_;
        info.pViewportState = &viewport_;
        info.pRasterizationState = &raster_;
        info.pMultisampleState = &multisample_;
        info.pDepthStencilState = &depth_;
        info.pColorBlendState = &blend_;
        info.pDynamicState = &dynamic_;
        return info;
    }

private:
    void set_input(const GraphicsDescription& description) {
        vertex_input_.vertexBindingDescriptionCount = static_cast<std::uint32_t>(description.vertex_buffers.size());
        vertex_input_.pVertexBindingDescriptions = description.vertex_buffers.data();
        vertex_input_.vertexAttributeDescriptionCount =
            static_cast<std::uint32_t>(description.vertex_attributes.size());
        vertex_input_.pVertexAttributeDescriptions = description.vertex_attributes.data();
        assembly_.topology = description.topology;
        viewport_.viewportCount = viewport_.scissorCount = 1;
        dynamic_.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states_.size());
        dynamic_.pDynamicStates = dynamic_states_.data();
    }

    void set_rasterization(const GraphicsDescription& description) {
        raster_.depthClampEnable = description.depth_clamp;
        raster_.polygonMode = description.polygon_mode;
        raster_.cullMode = description.cull_mode;
        raster_.frontFace = description.front_face;
        raster_.depthBiasEnable = description.depth_bias_constant != 0 || description.depth_bias_slope != 0;
        raster_.depthBiasConstantFactor = description.depth_bias_constant;
        raster_.depthBiasSlopeFactor = description.depth_bias_slope;
        raster_.lineWidth = 1.0f;
        if (description.conservative_px) {
            conservative_.conservativeRasterizationMode = VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
            conservative_.extraPrimitiveOverestimationSize = *description.conservative_px;
            raster_.pNext = &conservative_;
        }
        multisample_.rasterizationSamples = description.samples;
        depth_.depthTestEnable = description.depth_format != VK_FORMAT_UNDEFINED && description.depth_test;
        depth_.depthWriteEnable = depth_.depthTestEnable && description.depth_write;
        depth_.depthCompareOp = description.depth_compare;
        depth_.stencilTestEnable = description.stencil.has_value();
        if (description.stencil) {
            depth_.front = stencil_state(description.stencil->front);
            depth_.back = stencil_state(description.stencil->back);
        }
    }

    void set_output(const GraphicsDescription& description) {
        for (std::size_t index = 0; index < description.color_formats.size(); ++index)
            attachments_.push_back(
                blend_state(index < description.blend.size() ? description.blend[index] : Blend::none));
        blend_.attachmentCount = static_cast<std::uint32_t>(attachments_.size());
        blend_.pAttachments = attachments_.data();
        rendering_.viewMask = description.view_mask;
        rendering_.colorAttachmentCount = static_cast<std::uint32_t>(description.color_formats.size());
        rendering_.pColorAttachmentFormats = description.color_formats.data();
        rendering_.depthAttachmentFormat = description.depth_format;
        if (has_stencil(description.depth_format)) rendering_.stencilAttachmentFormat = description.depth_format;
    }

    std::array<VkDynamicState, 2> dynamic_states_{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    std::vector<VkPipelineColorBlendAttachmentState> attachments_;
    VkPipelineVertexInputStateCreateInfo vertex_input_{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly_{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    VkPipelineViewportStateCreateInfo viewport_{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    VkPipelineRasterizationStateCreateInfo raster_{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    VkPipelineRasterizationConservativeStateCreateInfoEXT conservative_{
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT};
    VkPipelineMultisampleStateCreateInfo multisample_{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    VkPipelineDepthStencilStateCreateInfo depth_{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    VkPipelineColorBlendStateCreateInfo blend_{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    VkPipelineDynamicStateCreateInfo dynamic_{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    VkPipelineRenderingCreateInfo rendering_{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
};

/// Merges one stage's binding into the set's; error when it contradicts another stage.
Result<void> merge(std::vector<ShaderBinding>& bindings, const ShaderBinding& added, const std::string& where) {
    const auto known = std::ranges::find(bindings, added.binding, &ShaderBinding::binding);
    if (known == bindings.end()) {
        bindings.push_back(added);
        return {};
    }
    if (known->type != added.type || known->count != added.count)
        return fail(where, fmt::format("binding {} is '{}' in one stage and a different '{}' in another", added.binding,
                                       known->name, added.name));
    known->stages |= added.stages;
    return {};
}

}  // namespace

Result<PipelineLayout> PipelineLayout::create(Device& device, const std::string& name,
                                              std::span<const std::shared_ptr<const Shader>> shaders) {
    const std::string where = fmt::format("pipeline '{}'", name);
    PipelineLayout layout;
    layout.device_ = &device;
    for (const auto& shader : shaders) {
        const ShaderReflection& reflection = shader->reflection;
        for (const ShaderBinding& binding : reflection.bindings) {
            if (binding.set == BindlessTextures::set_index) {
                layout.uses_textures_ = true;
                continue;
            }
            if (binding.set != 0 || binding.count == 0)
                return fail(where, fmt::format("'{}' is in set {}: passes have set 0 (arrays of known length) and the "
                                               "bindless textures set {}",
                                               binding.name, binding.set, BindlessTextures::set_index));
            if (auto merged = merge(layout.bindings_, binding, where); !merged) return tl::unexpected(merged.error());
        }
        if (reflection.push_constant_bytes > 0) {
            layout.push_constant_bytes_ = std::max(layout.push_constant_bytes_, reflection.push_constant_bytes);
            layout.push_constant_stages_ |= reflection.stage;
        }
    }
    if (layout.push_constant_bytes_ > device.limits().maxPushConstantsSize)
        return fail(where, fmt::format("{} bytes of push constants exceed the device's {}", layout.push_constant_bytes_,
                                       device.limits().maxPushConstantsSize));
    if (auto made = layout.create_handles(name); !made) return tl::unexpected(made.error());
    return layout;
}

Result<void> PipelineLayout::create_handles(const std::string& name) {
    const std::string where = fmt::format("pipeline '{}'", name);
    std::ranges::sort(bindings_, {}, &ShaderBinding::binding);
    std::vector<VkDescriptorSetLayoutBinding> set_bindings;
    for (const ShaderBinding& binding : bindings_) {
        set_bindings.push_back({binding.binding, binding.type, binding.count, binding.stages, nullptr});
        descriptor_count_ += binding.count;
    }
    // Vulkan 1.3, table "required limits": a device with push descriptors takes at least 32 of them.
    constexpr std::uint32_t most_push_descriptors = 32;
    push_descriptors_ = device_->functions().push_descriptor_set && descriptor_count_ <= most_push_descriptors;

    VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set_info.flags = push_descriptors_ ? VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR : 0;
    set_info.bindingCount = static_cast<std::uint32_t>(set_bindings.size());
    set_info.pBindings = set_bindings.data();
    VkResult result = vkCreateDescriptorSetLayout(device_->handle(), &set_info, nullptr, &set_layout_);
    if (result != VK_SUCCESS) return vulkan_failure(where, "cannot create the descriptor layout", result);

    const VkDescriptorSetLayout sets[] = {set_layout_, device_->textures().layout()};
    const std::uint32_t push_bytes = (push_constant_bytes_ + 3) / 4 * 4;
    const VkPushConstantRange range{push_constant_stages_, 0, push_bytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = uses_textures_ ? 2 : 1;
    info.pSetLayouts = sets;
    info.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    result = vkCreatePipelineLayout(device_->handle(), &info, nullptr, &handle_);
    if (result != VK_SUCCESS) return vulkan_failure(where, "cannot create the pipeline layout", result);
    device_->set_name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, reinterpret_cast<std::uint64_t>(handle_), name);
    return {};
}

PipelineLayout::~PipelineLayout() {
    if (!device_ || (!handle_ && !set_layout_)) return;
    device_->retire([device = device_->handle(), layout = handle_, set_layout = set_layout_] {
        vkDestroyPipelineLayout(device, layout, nullptr);
        vkDestroyDescriptorSetLayout(device, set_layout, nullptr);
    });
}

PipelineLayout::PipelineLayout(PipelineLayout&& other) noexcept {
    *this = std::move(other);
}

PipelineLayout& PipelineLayout::operator=(PipelineLayout&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(set_layout_, other.set_layout_);
    std::swap(bindings_, other.bindings_);
    std::swap(descriptor_count_, other.descriptor_count_);
    std::swap(push_constant_bytes_, other.push_constant_bytes_);
    std::swap(push_constant_stages_, other.push_constant_stages_);
    std::swap(uses_textures_, other.uses_textures_);
    std::swap(push_descriptors_, other.push_descriptors_);
    return *this;
}

Pipeline::~Pipeline() {
    if (!handle_) return;
    device_->retire([device = device_->handle(), handle = handle_] { vkDestroyPipeline(device, handle, nullptr); });
}

Pipeline::Pipeline(Pipeline&& other) noexcept {
    *this = std::move(other);
}

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(name_, other.name_);
    std::swap(handle_, other.handle_);
    std::swap(layout_, other.layout_);
    return *this;
}

Result<ComputePipeline> ComputePipeline::create(Device& device, std::shared_ptr<const Shader> shader,
                                                const Specialization& specialization) {
    const std::string where = fmt::format("pipeline '{}'", shader->name);
    if (shader->reflection.stage != VK_SHADER_STAGE_COMPUTE_BIT) return fail(where, "expected a compute shader");
    ComputePipeline pipeline;
    pipeline.device_ = &device;
    pipeline.name_ = shader->name;
    auto layout = PipelineLayout::create(device, shader->name, {&shader, 1});
    if (!layout) return tl::unexpected(layout.error());
    pipeline.layout_ = std::move(*layout);
    for (std::size_t side = 0; side < 3; ++side) {
        const auto set = specialization.find(shader->reflection.workgroup_constants[side]);
        pipeline.workgroup_size_[side] =
            set != specialization.end() ? set->second : shader->reflection.workgroup_size[side];
    }
    const Module module(device, *shader);
    if (module.result() != VK_SUCCESS) return vulkan_failure(where, "cannot load the shader", module.result());
    const SpecializationData data(specialization);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stage_info(*shader, module, data);
    info.layout = pipeline.layout_.handle();
    const VkResult result =
        vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline.handle_);
    if (result != VK_SUCCESS) return vulkan_failure(where, "cannot create it", result);
    device.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline.handle_), pipeline.name_);
    return pipeline;
}

Result<GraphicsPipeline> GraphicsPipeline::create(Device& device, const GraphicsDescription& description,
                                                  std::span<const std::shared_ptr<const Shader>> shaders) {
    const std::string where = fmt::format("pipeline '{}'", description.name);
    const DeviceInfo& able = device.info();
    if (description.conservative_px && (!able.conservative_rasterization || *description.conservative_px > able.conservative_extra_px))
        return fail(where, fmt::format("needs conservative rasterization of triangles grown by {} pixels, which {} cannot do",
                                       *description.conservative_px, able.name));
    if (!description.geometry.empty() && !able.geometry_shader)
        return fail(where, fmt::format("needs geometry shaders, which {} has not", able.name));
    GraphicsPipeline pipeline;
    pipeline.device_ = &device;
    pipeline.name_ = description.name;
    auto layout = PipelineLayout::create(device, description.name, shaders);
    if (!layout) return tl::unexpected(layout.error());
    pipeline.layout_ = std::move(*layout);

    const SpecializationData data(description.specialization);
    std::vector<std::unique_ptr<Module>> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const auto& shader : shaders) {
        modules.push_back(std::make_unique<Module>(device, *shader));
        if (modules.back()->result() != VK_SUCCESS)
            return vulkan_failure(where, "cannot load " + shader->name, modules.back()->result());
        stages.push_back(stage_info(*shader, *modules.back(), data));
    }
    const GraphicsStates states(description);
    VkGraphicsPipelineCreateInfo info = states.create_info();
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.layout = pipeline.layout_.handle();
    const VkResult result =
        vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline.handle_);
    if (result != VK_SUCCESS) return vulkan_failure(where, "cannot create it", result);
    device.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline.handle_), pipeline.name_);
    return pipeline;
}

}  // namespace heliodon::gpu
