#include "shading/tables.h"
#include "trace/cpu_kernel.h"
#include "trace/lanes/lane_paths.h"

namespace heliodon::trace {

namespace {

const float* shading_tables() {
    static const float* const values = shading::shading_tables().data();
    return values;
}

}  // namespace

LaneScene lane_scene(const CpuKernel& kernel, const EmbreeScene& scene) {
    const EmitterTable& emitters = kernel.emitter_table;
    return {.frame = &kernel.frame,
            .instances = kernel.flat.instances().data(),
            .materials = kernel.flat.materials().data(),
            .lights = kernel.flat.lights().data(),
            .sky = &kernel.flat.sky(),
            .geometries = kernel.geometry_table.data(),
            .emitters = emitters.emitters.data(),
            .light_nodes = emitters.light_nodes.data(),
            .first_emitter = emitters.first_emitter.data(),
            .light_emitter = emitters.light_emitter.data(),
            .visible_lights = emitters.visible_lights.data(),
            .sky_cumulative = emitters.sky_cumulative.data(),
            .luminaire_table = kernel.flat.luminaire_table().data(),
            .shading_tables = shading_tables,
            .textures = kernel.textures.contents(),
            .embree = &scene};
}

bool lanes_available() {
#ifdef HELIODON_LANES
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
    return false;
#endif
}

#ifndef HELIODON_LANES
std::uint64_t follow_in_lanes(const LaneScene&, const LanePath*, std::size_t, LaneRadiance*) {
    return 0;
}
#endif

}  // namespace heliodon::trace
