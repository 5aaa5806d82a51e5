#pragma once

#include <cstddef>
#include <cstdint>

#include "shading/kernel_state.h"
#include "shading/scene_data.h"
#include "trace/embree_scene.h"
#include "trace/geometry_table.h"
#include "trace/texture_table.h"

namespace heliodon::trace {

struct CpuKernel;

/// CpuKernel's tables as plain pointers: code compiled for AVX2 calls no inline function of another header, lest the
/// linker keep its copy for everyone.
struct LaneScene {
    const shading::KernelFrame* frame;
    const shading::InstanceData* instances;
    const shading::MaterialData* materials;
    const shading::LightData* lights;
    const shading::SkyData* sky;
    const GeometryArrays* geometries;
    const shading::KernelEmitter* emitters;
    const shading::KernelLightNode* light_nodes;
    const std::uint32_t* first_emitter;
    const std::uint32_t* light_emitter;
    const std::uint32_t* visible_lights;
    const float* sky_cumulative;
    const float* luminaire_table;
    const float* (*shading_tables)();  // computed when a path first asks: scenes of plain diffuse surfaces never do
    TextureTable::Contents textures;
    const EmbreeScene* embree;
};

/// `kernel`, its tables and `scene` must outlive the result.
[[nodiscard]] LaneScene lane_scene(const CpuKernel& kernel, const EmbreeScene& scene);

struct LanePath {
    std::uint32_t x, y, sample;
};
struct LaneRadiance {
    float radiance[3], direct[3];
};

/// Whether this build has lanes and this processor AVX2 and FMA.
[[nodiscard]] bool lanes_available();

/// Follows `count` paths, eight at a time: a lane whose path has ended takes up the next. What a path brings does not
/// depend on those beside it. Returns the number of rays traced. Only where lanes_available().
std::uint64_t follow_in_lanes(const LaneScene& scene, const LanePath* paths, std::size_t count, LaneRadiance* results);

}  // namespace heliodon::trace
