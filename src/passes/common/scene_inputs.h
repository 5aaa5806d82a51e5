#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "gpu/commands.h"
#include "gpu/pipeline.h"

namespace heliodon::passes {

/// What the scene has of what whole branches of shaders are for: pipelines are chosen by it, and leave out the rest. A CPU
/// that runs every branch for all of a vector's lanes gains most.
struct SceneFeatures {
    static constexpr std::uint32_t any_kind = 0xffffffffu;  ///< several, or nothing is known

    bool extended = false;    ///< some material is more than the standard model's core
    bool luminaires = false;  ///< some light is one
    bool textures = true;     ///< some surface has textures or vertex colours
    bool sky = true;
    bool many_lights = true;     ///< than are summed one by one (light_grid_shared.h)
    bool visible_lights = true;  ///< some light has an extent
    std::uint32_t only_model = any_kind;  ///< material_model_… of all materials
    std::uint32_t only_light = any_kind;  ///< light_type_… of all lights, none with an extent
    bool operator==(const SceneFeatures&) const = default;
};

/// What the passes need of the scene in the frame being recorded. Its owner keeps it at one address and
/// brings it up to date before each frame.
struct SceneInputs {
    std::vector<gpu::Binding> tables;  ///< bindings 0 to 7 of scene_tables.glsl
    const gpu::Buffer* luminaires = nullptr;  ///< luminaires.glsl
    const gpu::Buffer* index_buffer = nullptr;
    std::uint32_t instance_count = 0;
    bool has_tested = false;   ///< something visible is alpha-masked
    bool has_blended = false;  ///< something visible is alpha-blended
    SceneFeatures features;
    bool ambient = false;  ///< surroundings reflect light though none is traced (ambient_shared.h)
    std::uint32_t draw_calls = 0;  ///< indirect draws recorded; the passes count
};

/// Constants of every shader that evaluates materials or the sky (shading/surface.h, scene_tables.glsl).
inline void set_material_constants(gpu::Specialization& constants, const SceneInputs& scene) {
    constants[9] = scene.features.extended ? 1u : 0u;
    constants[11] = scene.features.textures ? 1u : 0u;
    constants[12] = scene.features.only_model;
    constants[13] = scene.features.sky ? 1u : 0u;
    constants[18] = scene.ambient ? 1u : 0u;
}

/// Constants of every shader that asks lights for what they send (luminaires.glsl, scene_tables.glsl).
inline void set_light_constants(gpu::Specialization& constants, const SceneInputs& scene) {
    constants[10] = scene.features.luminaires ? 1u : 0u;
    constants[14] = scene.features.only_light;
    constants[15] = scene.features.many_lights ? 1u : 0u;
    constants[16] = scene.features.visible_lights ? 1u : 0u;
}

using NumberedBinding = std::pair<std::uint32_t, gpu::Binding>;

/// The bindings that a pipeline's shaders declare, in its order: the scene's tables by their numbers, the
/// others from `own`.
[[nodiscard]] std::vector<gpu::Binding> select_bindings(const gpu::Pipeline& pipeline, const SceneInputs& scene,
                                                        std::span<const NumberedBinding> own);
[[nodiscard]] inline std::vector<gpu::Binding> select_bindings(const gpu::Pipeline& pipeline, const SceneInputs& scene,
                                                               std::initializer_list<NumberedBinding> own) {
    return select_bindings(pipeline, scene, std::span(own.begin(), own.size()));
}

}  // namespace heliodon::passes
