// What the frame renderer does for scenes of very many lights.
#include "passes/light_grid/light_grid.h"
#include "realtime/frame_renderer.h"

namespace heliodon::realtime {

Result<void> FrameRenderer::record_light_grid(gpu::Commands& commands, const FrameSample& sample, std::size_t batch,
                                              gpu::Timestamps* timestamps) {
    const ShadowBatch& lights = plan_.batches[batch];
    const shading::LightGridHeader header = passes::light_grid_header(gpu_scene_.bounds(), lights.first_light, lights.light_count);
    if (header.edge == 0) return {};
    const std::pair key{gpu_scene_.revision(), batch};
    // Lights with an extent may have moved to another of their points.
    if (key == light_grid_key_ && !has_area_lights_ && !sample.force_shadows) return {};
    if (auto done = light_grid_.reserve(device_, passes::light_grid_bytes(header), 0); !done) return done;
    if (auto done = device_.upload(light_grid_.buffer(), std::span<const shading::LightGridHeader>(&header, 1)); !done) return done;
    const std::uint32_t scope = timestamps ? timestamps->begin(commands, "light grid") : 0;
    if (auto done = passes::record_light_grid(commands, pipelines_, inputs_, light_grid_.buffer(), header); !done) return done;
    if (timestamps) timestamps->end(commands, scope);
    light_grid_key_ = key;
    return {};
}

}  // namespace heliodon::realtime
