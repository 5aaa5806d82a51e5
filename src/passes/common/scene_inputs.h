#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "gpu/commands.h"
#include "gpu/pipeline.h"

namespace heliodon::passes {

/// What the passes need of the scene in the frame being recorded. Its owner keeps it at one address and
/// brings it up to date before each frame.
struct SceneInputs {
    std::vector<gpu::Binding> tables;  ///< bindings 0 to 7 of scene_tables.glsl
    const gpu::Buffer* luminaires = nullptr;  ///< luminaires.glsl
    const gpu::Buffer* index_buffer = nullptr;
    std::uint32_t instance_count = 0;
    bool has_tested = false;   ///< something visible is alpha-masked
    bool has_blended = false;  ///< something visible is alpha-blended
    bool has_extended = false;  ///< some material is more than the standard model's core; pipelines are chosen by it
    bool has_luminaires = false;  ///< pipelines are chosen by it, too
    std::uint32_t draw_calls = 0;  ///< indirect draws recorded; the passes count
};

/// Constant 9 of every shader that evaluates materials (shading/surface.h).
inline void set_material_constants(gpu::Specialization& constants, const SceneInputs& scene) {
    constants[9] = scene.has_extended ? 1u : 0u;
}

/// Constant 10 of every shader that asks lights for what they send (luminaires.glsl).
inline void set_light_constants(gpu::Specialization& constants, const SceneInputs& scene) {
    constants[10] = scene.has_luminaires ? 1u : 0u;
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
