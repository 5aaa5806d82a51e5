#include "trace/lanes/lane_loop.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "trace/lanes/lane_paths.h"
#include "trace/resume.h"

namespace heliodon::trace {
namespace {

using Want = AdaptiveSampling::Want;

/// What one thread does at a time: the new samples of a few blocks.
struct Batch {
    std::vector<LanePath> paths;
    std::vector<Want> wants;  ///< of each path's block
    std::vector<LaneRadiance> radiances;

    /// Those of the `slice`th of so many equal parts of a block's rows.
    void add_block(const Accumulation& picture, int block, int slice, int slices, int end) {
        const Want want = picture.adaptive ? picture.adaptive->want(block) : Want{{true, true}, {false, false}};
        if (!want.any()) return;
        picture.blocks.each_pixel(block, [&](int x, int y) {
            if (y % Blocks::side * slices / Blocks::side != slice) return;
            for (int i = picture.done; i < end; ++i) {
                if (!want.half(i & 1)) continue;
                paths.push_back(
                    {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(i)});
                wants.push_back(want);
            }
        });
    }

    PathCounts follow(const LaneScene& scene) {
        radiances.resize(paths.size());
        PathCounts counts;
        counts.rays = follow_in_lanes(scene, paths.data(), paths.size(), radiances.data());
        for (LaneRadiance& r : radiances) {
            if (std::isfinite(r.radiance[0]) && std::isfinite(r.radiance[1]) && std::isfinite(r.radiance[2])) continue;
            ++counts.non_finite;
            r = {};
        }
        return counts;
    }

    void add_to(Accumulation& picture) const {
        for (std::size_t p = 0; p < paths.size(); ++p) {
            const LanePath& path = paths[p];
            const LaneRadiance& r = radiances[p];
            const int sample = static_cast<int>(path.sample), half = sample & 1;
            const std::size_t pixel = static_cast<std::size_t>(path.y) * picture.blocks.width + path.x;
            const PathResult result{{r.radiance[0], r.radiance[1], r.radiance[2]},
                                    {r.direct[0], r.direct[1], r.direct[2]}};
            if (wants[p].picture[half]) picture.sums.add(pixel, sample, result);
            if (wants[p].decision[half]) picture.adaptive->add(pixel, sample, units::luminance(result.radiance));
        }
    }
};

}  // namespace

AddSamples lane_samples(const CpuKernel& shared_kernel, const EmbreeScene& scene) {
    return [kernel = shared_kernel, &scene](Accumulation& picture, int end) {
        const LaneScene lanes = lane_scene(kernel, scene);
        // At the end of a batch lanes run empty: enough paths that this does not count, and no more, for at the end of a pass
        // threads run empty.
        constexpr int paths_a_batch = 1024;
        const int paths_a_block = Blocks::side * Blocks::side * (end - picture.done);
        const int blocks_a_batch = std::max(1, paths_a_batch / paths_a_block);
        const int slices = std::clamp(paths_a_block / paths_a_batch, 1, Blocks::side);
        const int batches = (picture.blocks.count() + blocks_a_batch - 1) / blocks_a_batch * slices;
        std::atomic<std::uint64_t> rays = 0, non_finite = 0;
        const auto follow = [&](int number) {
            Batch batch;
            const int first = number / slices * blocks_a_batch;
            for (int block = first; block < std::min(first + blocks_a_batch, picture.blocks.count()); ++block)
                batch.add_block(picture, block, number % slices, slices, end);
            const PathCounts counts = batch.follow(lanes);
            batch.add_to(picture);
            rays += counts.rays;
            non_finite += counts.non_finite;
        };
        // One batch a task: a pass ends with the last of them.
        tbb::parallel_for(0, batches, 1, follow, tbb::simple_partitioner());
        return PathCounts{rays, non_finite};
    };
}

}  // namespace heliodon::trace
