#pragma once

#include <vector>

#include "shading/bidirectional_vertex.h"
#include "shading/light_emission.h"
#include "trace/emission_table.h"
#include "trace/render_loop.h"

namespace heliodon::trace {

/// The bidirectional kernel over the flat scene's tables, for one path at a time. Copying it copies references only.
struct BidirectionalKernel : CpuKernel {
    const EmissionTable& emission_table;
    uvec2 only_strategy{bidirectional_any};
    std::vector<SubpathVertex> light_path{};  ///< its unused end is kept for the next path

    BidirectionalKernel(const CpuKernel& kernel, const EmissionTable& emission)
        : CpuKernel(kernel), emission_table(emission) {}

    vec4 scene_sphere() const { return emission_table.scene_sphere; }
    uint emission_count() const { return static_cast<uint>(emission_table.cumulative.size()); }
    float fetch_emission_cumulative(uint i) const { return emission_table.cumulative[i]; }
    const SubpathVertex& fetch_light_vertex(uint /*slot*/, uint i) const { return light_path[i]; }
    void store_light_vertex(uint /*slot*/, uint i, const SubpathVertex& vertex) {
        if (i < light_path.size())
            light_path[i] = vertex;
        else
            light_path.push_back(vertex);
    }
    uvec2 fetch_only_strategy() const { return only_strategy; }

#include "shading/bidirectional_kernel.h"
};

/// Pictures by bidirectional path tracing, for render_picture. Light that light subpaths bring to the camera is collected
/// a block and a sample and added in that order: the sums depend on neither the threads nor on where work is interrupted.
[[nodiscard]] AddSamples bidirectional_samples(const BidirectionalKernel& kernel, const EmbreeScene& scene);

}  // namespace heliodon::trace
