// Compiled for AVX2 and FMA (trace/CMakeLists.txt).
#include "trace/lanes/lane_paths.h"

#include "trace/lanes/functions.h"
#include "trace/lanes/lanes.h"
#include "trace/lanes/records.h"

namespace heliodon::trace {
namespace lanes {

#include "lane_kernel.inl"

template <class T>
auto loaded(const T (&from)[lane_count]) {
    decltype(lift(T{})) result;
    __builtin_memcpy(&result, from, sizeof result);
    return result;
}
template <class T>
void keep(T (&to)[lane_count], decltype(lift(T{})) from) {
    __builtin_memcpy(to, &from, sizeof from);
}
static Mask mask_of(unsigned bits) {
    const Uint lane = {1, 2, 4, 8, 16, 32, 64, 128};
    return (lane & bits) != 0u;
}

using Word [[gnu::may_alias]] = std::uint32_t;

/// Makes lane `i` of `to` what lane `j` of `from` is.
static void copy_lane(PathState& to, int i, const PathState& from, int j) {
    Word* target = reinterpret_cast<Word*>(&to) + i;
    const Word* source = reinterpret_cast<const Word*>(&from) + j;
    for (std::size_t word = 0; word < sizeof(PathState) / sizeof(Word); word += lane_count) target[word] = source[word];
}

/// Eight paths on their way, and others that wait for a lane. All take their first step in the company of other first
/// steps and wait then: lanes of a kind do the same work.
class Follower {
public:
    Follower(const LaneScene& scene, const LanePath* paths, std::size_t count, LaneRadiance* results)
        : k_(scene), paths_(paths), count_(count), results_(results) {}

    std::uint64_t follow() {
        while (take_up()) step(state_);
        return rays_;
    }

private:
    static constexpr int pack_count = 16;

    /// Stores what has ended and takes up waiting paths in its place; false when nothing is on its way.
    bool take_up() {
        const unsigned done = bits(state_.stage == shading::kernel_stage_done);
        for (unsigned left = done; left; left &= left - 1) {
            const int i = __builtin_ctz(left);
            if (active_ >> i & 1u) store(state_, i, number_[i]);
            active_ &= ~(1u << i);
            if (waiting_ == 0 && !begin_some()) continue;
            const Waiting& next = queue_[--waiting_];
            copy_lane(state_, i, packs_[next.pack], next.lane);
            number_[i] = next.number;
            active_ |= 1u << i;
        }
        return active_ != 0;
    }

    /// Begins packs of paths; false where none is left that waits for another step.
    bool begin_some() {
        while (waiting_ == 0 && next_ < count_)
            for (int pack = 0; pack < pack_count && next_ < count_; ++pack) begin_pack(pack);
        return waiting_ > 0;
    }

    void begin_pack(int pack) {
        alignas(Uint) std::uint32_t x[lane_count] = {}, y[lane_count] = {}, sample[lane_count] = {};
        const std::size_t first = next_;
        for (int i = 0; i < lane_count && next_ < count_; ++i, ++next_)
            x[i] = paths_[next_].x, y[i] = paths_[next_].y, sample[i] = paths_[next_].sample;
        const unsigned begun = (1u << (next_ - first)) - 1u;
        PathState& state = packs_[pack];
        state = path_begin(k_, mask_of(begun), loaded(x), loaded(y), loaded(sample));
        assign(mask_of(~begun), state.stage, shading::kernel_stage_done);
        step(state);
        const unsigned done = bits(state.stage == shading::kernel_stage_done);
        for (unsigned left = begun; left; left &= left - 1) {
            const int i = __builtin_ctz(left);
            if (done >> i & 1u)
                store(state, i, first + i);
            else
                queue_[waiting_++] = {first + i, pack, i};
        }
    }

    void store(const PathState& state, int i, std::size_t number) const {
        const Vec3<Float>&radiance = state.radiance, &direct = state.direct;
        results_[number] = {{radiance.x[i], radiance.y[i], radiance.z[i]}, {direct.x[i], direct.y[i], direct.z[i]}};
    }

    /// Scatter rays, then shadow rays.
    void step(PathState& state) {
        answer(state, shading::kernel_stage_scatter);
        answer(state, shading::kernel_stage_shadow);
    }

    /// Answers the rays of the lanes at `stage`.
    void answer(PathState& state, std::uint32_t stage) {
        const Mask m = state.stage == stage;
        if (!any(m)) return;
        const bool shadow = stage == shading::kernel_stage_shadow;
        const Vec3<Float>& origin = shadow ? state.shadow_origin : state.origin;
        const Vec3<Float>& direction = shadow ? state.shadow_direction : state.direction;
        KernelRays8 rays;
        keep(rays.valid, m);
        keep(rays.origin[0], origin.x), keep(rays.origin[1], origin.y), keep(rays.origin[2], origin.z);
        keep(rays.direction[0], direction.x), keep(rays.direction[1], direction.y),
            keep(rays.direction[2], direction.z);
        keep(rays.t_max, shadow ? state.shadow_t_max : lift(shading::kernel_infinity));
        rays.kind = shadow ? shading::kernel_ray_shadow : shading::kernel_ray_scatter;
        KernelHits8 hits;
        k_.embree->trace(rays, hits);
        rays_ += __builtin_popcount(bits(m));
        path_take_hit(k_, m, state,
                      {.object_normal = {loaded(hits.object_normal[0]), loaded(hits.object_normal[1]),
                                         loaded(hits.object_normal[2])},
                       .t = loaded(hits.t),
                       .barycentric = {loaded(hits.barycentric[0]), loaded(hits.barycentric[1])},
                       .instance = loaded(hits.instance),
                       .primitive = loaded(hits.primitive),
                       .kind = loaded(hits.kind)});
    }

    struct Waiting {
        std::size_t number;  // of the path
        int pack, lane;      // where it is
    };

    const LaneScene& k_;
    const LanePath* paths_;
    std::size_t count_, next_ = 0;
    LaneRadiance* results_;
    PathState state_{};                    // all done
    std::size_t number_[lane_count] = {};  // of the path in each lane
    unsigned active_ = 0;
    PathState packs_[pack_count];
    Waiting queue_[pack_count * lane_count];
    int waiting_ = 0;
    std::uint64_t rays_ = 0;
};

}  // namespace lanes

std::uint64_t follow_in_lanes(const LaneScene& scene, const LanePath* paths, std::size_t count, LaneRadiance* results) {
    return lanes::Follower(scene, paths, count, results).follow();
}

}  // namespace heliodon::trace
