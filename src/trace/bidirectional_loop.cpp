#include "trace/bidirectional_loop.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "trace/resume.h"

namespace heliodon::trace {
namespace {

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Light that a light subpath brought to a pixel.
struct Splat {
    glm::vec3 light;
    std::uint32_t pixel;
    bool direct;
};

/// What the paths of one block's pixels leave behind.
struct BlockWork {
    std::vector<Splat> splats;
    PathCounts counts;
};

/// One light subpath and one camera subpath, and all that joins them.
PathResult follow(BidirectionalKernel& kernel, const EmbreeScene& scene, BidirectionalState& state, BlockWork& work) {
    for (KernelRay ray = kernel.path_next_ray(state.walk); ray.kind != kernel_ray_none;
         ray = kernel.path_next_ray(state.walk)) {
        kernel.bidirectional_take_hit(state, scene.trace(ray));
        ++work.counts.rays;
        if (state.splat_pixel == bidirectional_no_pixel) continue;
        if (is_finite(state.splat_light))
            work.splats.push_back({state.splat_light, state.splat_pixel, state.shadow_events <= 1});
        else
            ++work.counts.non_finite;
    }
    if (!is_finite(state.walk.radiance)) {
        ++work.counts.non_finite;
        return {};
    }
    return {glm::dvec3(state.walk.radiance), glm::dvec3(state.walk.direct)};
}

void add_splats(const std::vector<Splat>& splats, int sample, SampleSums& sums) {
    for (const Splat& splat : splats) {
        const glm::dvec3 light(splat.light);
        sums.add(splat.pixel, sample, {light, splat.direct ? light : glm::dvec3(0)});
    }
}

}  // namespace

AddSamples bidirectional_samples(const BidirectionalKernel& shared_kernel, const EmbreeScene& scene) {
    return [shared_kernel, &scene](Accumulation& picture, int end) {
        std::vector<BlockWork> works(static_cast<std::size_t>(picture.blocks.count()));
        for (int sample = picture.done; sample < end; ++sample) {
            tbb::parallel_for(0, picture.blocks.count(), [&](int block) {
                BlockWork& work = works[static_cast<std::size_t>(block)];
                BidirectionalKernel kernel = shared_kernel;
                work.splats.clear();
                picture.blocks.each_pixel(block, [&](int x, int y) {
                    BidirectionalState state = kernel.bidirectional_begin(x, y, sample, 0);
                    const PathResult result = follow(kernel, scene, state, work);
                    picture.sums.add(static_cast<std::size_t>(y) * picture.blocks.width + x, sample, result);
                });
            });
            for (const BlockWork& work : works) add_splats(work.splats, sample, picture.sums);
        }
        PathCounts counts;
        for (const BlockWork& work : works) {
            counts.rays += work.counts.rays;
            counts.non_finite += work.counts.non_finite;
        }
        return counts;
    };
}

}  // namespace heliodon::trace
