#include <fmt/format.h>
#include <spirv_cross_c.h>

#include <algorithm>
#include <memory>

#include "gpu/shader.h"

namespace heliodon::gpu {
namespace {

struct ContextDeleter {
    void operator()(spvc_context context) const { spvc_context_destroy(context); }
};
using Context = std::unique_ptr<spvc_context_s, ContextDeleter>;

Result<VkShaderStageFlagBits> stage_from(const std::string& name, SpvExecutionModel model) {
    switch (model) {
        case SpvExecutionModelVertex:
            return VK_SHADER_STAGE_VERTEX_BIT;
        case SpvExecutionModelTessellationControl:
            return VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT;
        case SpvExecutionModelTessellationEvaluation:
            return VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT;
        case SpvExecutionModelGeometry:
            return VK_SHADER_STAGE_GEOMETRY_BIT;
        case SpvExecutionModelFragment:
            return VK_SHADER_STAGE_FRAGMENT_BIT;
        case SpvExecutionModelGLCompute:
            return VK_SHADER_STAGE_COMPUTE_BIT;
        default:
            return fail(name, "expected a vertex, tessellation, geometry, fragment or compute shader");
    }
}

VkImageViewType view_type_of(spvc_type type) {
    const bool arrayed = spvc_type_get_image_arrayed(type);
    switch (spvc_type_get_image_dimension(type)) {
        case SpvDim1D:
            return arrayed ? VK_IMAGE_VIEW_TYPE_1D_ARRAY : VK_IMAGE_VIEW_TYPE_1D;
        case SpvDim3D:
            return VK_IMAGE_VIEW_TYPE_3D;
        case SpvDimCube:
            return arrayed ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
        default:
            return arrayed ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    }
}

struct Kind {
    spvc_resource_type resources;
    VkDescriptorType descriptor;
    bool image;
};
constexpr Kind kinds[] = {
    {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, false},
    {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, false},
    {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, true},
    {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, true},
    {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, true},
    {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, VK_DESCRIPTOR_TYPE_SAMPLER, false},
};

ShaderBinding binding_of(spvc_compiler compiler, const spvc_reflected_resource& resource, const Kind& kind,
                         VkShaderStageFlags stage) {
    const spvc_type type = spvc_compiler_get_type_handle(compiler, resource.type_id);
    ShaderBinding binding;
    // Blocks without an instance name are known by their block's.
    const char* instance = spvc_compiler_get_name(compiler, resource.id);
    binding.name = instance && *instance ? instance : resource.name;
    binding.set = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationDescriptorSet);
    binding.binding = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationBinding);
    binding.type = kind.descriptor;
    binding.stages = stage;
    for (unsigned dimension = 0; dimension < spvc_type_get_num_array_dimensions(type); ++dimension)
        binding.count *= spvc_type_get_array_dimension(type, dimension);
    if (kind.image) binding.view_type = view_type_of(type);
    return binding;
}

std::uint32_t push_constant_bytes(spvc_compiler compiler, spvc_resources resources) {
    const spvc_reflected_resource* list = nullptr;
    std::size_t count = 0;
    spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &list, &count);
    std::size_t size = 0;
    if (count > 0)
        spvc_compiler_get_declared_struct_size(compiler, spvc_compiler_get_type_handle(compiler, list[0].base_type_id),
                                               &size);
    return static_cast<std::uint32_t>(size);
}

void reflect_workgroup(spvc_compiler compiler, ShaderReflection& reflection) {
    spvc_specialization_constant constants[3]{};
    spvc_compiler_get_work_group_size_specialization_constants(compiler, &constants[0], &constants[1], &constants[2]);
    for (unsigned side = 0; side < 3; ++side) {
        reflection.workgroup_size[side] =
            spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, side);
        if (constants[side].id == 0) continue;
        reflection.workgroup_constants[side] = constants[side].constant_id;
        const spvc_constant value = spvc_compiler_get_constant_handle(compiler, constants[side].id);
        reflection.workgroup_size[side] = spvc_constant_get_scalar_u32(value, 0, 0);
    }
}

}  // namespace

Result<ShaderReflection> reflect(const std::string& name, std::span<const std::uint32_t> code) {
    spvc_context raw = nullptr;
    if (spvc_context_create(&raw) != SPVC_SUCCESS) return fail(name, "out of memory for shader reflection");
    const Context context(raw);
    const auto failure = [&] {
        return fail(name, fmt::format("cannot read the SPIR-V: {}", spvc_context_get_last_error_string(raw)));
    };
    spvc_parsed_ir parsed = nullptr;
    spvc_compiler compiler = nullptr;
    spvc_resources resources = nullptr;
    if (spvc_context_parse_spirv(raw, code.data(), code.size(), &parsed) != SPVC_SUCCESS ||
        spvc_context_create_compiler(raw, SPVC_BACKEND_NONE, parsed, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler) !=
            SPVC_SUCCESS ||
        spvc_compiler_create_shader_resources(compiler, &resources) != SPVC_SUCCESS)
        return failure();

    ShaderReflection reflection;
    auto stage = stage_from(name, spvc_compiler_get_execution_model(compiler));
    if (!stage) return tl::unexpected(stage.error());
    reflection.stage = *stage;
    for (const Kind& kind : kinds) {
        const spvc_reflected_resource* list = nullptr;
        std::size_t count = 0;
        if (spvc_resources_get_resource_list_for_type(resources, kind.resources, &list, &count) != SPVC_SUCCESS)
            return failure();
        for (std::size_t index = 0; index < count; ++index)
            reflection.bindings.push_back(binding_of(compiler, list[index], kind, reflection.stage));
    }
    std::ranges::sort(reflection.bindings, {}, [](const ShaderBinding& b) { return std::pair(b.set, b.binding); });
    reflection.push_constant_bytes = push_constant_bytes(compiler, resources);
    if (reflection.stage == VK_SHADER_STAGE_COMPUTE_BIT) reflect_workgroup(compiler, reflection);
    return reflection;
}

}  // namespace heliodon::gpu
