#include "passes/sensors/sensors.h"

#include "passes/sensors/sensors_shared.h"

namespace heliodon::passes {

Result<void> record_sensors(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                            const LightingInputs& lighting, const gpu::Image& shadow_depth,
                            const gpu::Image& shadow_slope, const gpu::Buffer& sensors, std::uint32_t count,
                            const SensorLights& lights) {
    gpu::Specialization constants = cone_constants(*lighting.volume, lighting.cone_shadows);
    set_light_constants(constants, scene);
    constants[18] = scene.ambient ? 1u : 0u;
    auto pipeline = pipelines.compute("passes/sensors/sensors.comp", constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    const shading::SensorConstants push{count, lights.first, lights.count, lights.sky ? 1u : 0u, lights.ambient ? 1u : 0u};
    const auto bindings = select_bindings(**pipeline, scene, with_volume(*lighting.volume,
                                          {{9, *lighting.shadow_views},
                                           {10, gpu::Binding(shadow_depth, lighting.nearest)},
                                           {15, gpu::Binding(shadow_slope, lighting.nearest)},
                                           {11, *lighting.shading_tables},
                                           {24, *lighting.light_grid},
                                           {12, sensors}}));
    commands.dispatch_threads(**pipeline, push, bindings, {count, 1, 1});
    return {};
}

Result<void> record_cone_sensors(gpu::Commands& commands, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                 const VolumeInputs& volume, const gpu::Buffer& sensors, std::uint32_t count) {
    auto pipeline = pipelines.compute("passes/sensors/cone_sensors.comp", cone_constants(volume));
    if (!pipeline) return tl::unexpected(pipeline.error());
    const auto bindings = select_bindings(**pipeline, scene, with_volume(volume, {{12, sensors}}));
    commands.dispatch_threads(**pipeline, shading::SensorConstants{count}, bindings, {count, 1, 1});
    return {};
}

}  // namespace heliodon::passes
