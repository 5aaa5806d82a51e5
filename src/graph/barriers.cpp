#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "graph/compile_steps.h"

namespace heliodon::graph {
namespace {

/// A stretch of passes that use a subresource alike: one write, or reads in one layout.
struct Phase {
    std::uint32_t position = 0;  // of its first pass
    gpu::Access access;
    bool writes = false;
};

struct PositionedUse {
    std::uint32_t position;
    const ResourceUse* use;
    PassKind kind;
};

/// A barrier before it is known how far it reaches.
struct PartBarrier {
    std::uint32_t position;  // number of passes: at the end of the frame
    Barrier barrier;         // of one subresource
};

gpu::Access access_of_use(const PositionedUse& user, bool is_image) {
    gpu::Access access = access_of(user.use->usage, user.kind, user.use->reads, user.use->writes);
    if (!is_image) access.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    return access;
}

/// What an access leaves to be waited for: its stages, and its writes to be made available.
gpu::Access source_of(const Phase& phase) {
    constexpr VkAccessFlags2 write_bits =
        VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    return {phase.access.stages, phase.access.access & write_bits, phase.access.layout};
}

bool touches(const ResourceUse& use, std::uint32_t mip, std::uint32_t layer) {
    return mip >= use.base_mip && mip < use.base_mip + use.mips && layer >= use.base_layer &&
           layer < use.base_layer + use.layers;
}

std::vector<Phase> phases_of(const std::vector<PositionedUse>& uses, bool is_image, std::uint32_t mip,
                             std::uint32_t layer) {
    std::vector<Phase> phases;
    for (const PositionedUse& user : uses) {
        if (!touches(*user.use, mip, layer)) continue;
        const gpu::Access access = access_of_use(user, is_image);
        const bool same_pass = !phases.empty() && phases.back().position == user.position;
        const bool joins = !phases.empty() && !phases.back().writes && !user.use->writes &&
                           phases.back().access.layout == access.layout;
        if (joins || same_pass) {
            phases.back().access.stages |= access.stages;
            phases.back().access.access |= access.access;
            phases.back().writes |= user.use->writes;
        } else {
            phases.push_back({user.position, access, user.use->writes});
        }
    }
    return phases;
}

/// Joins equal barriers of single subresources into rectangles of mips and layers.
std::vector<PartBarrier> join(const std::vector<PartBarrier>& parts) {
    std::vector<PartBarrier> joined;
    const auto alike = [](const PartBarrier& a, const PartBarrier& b) {
        return a.position == b.position && a.barrier.before == b.barrier.before && a.barrier.after == b.barrier.after &&
               a.barrier.discard == b.barrier.discard && a.barrier.external == b.barrier.external;
    };
    // Parts come layer by layer, mip by mip: first runs of mips within a layer, then equal runs of neighbour layers.
    for (const PartBarrier& part : parts) {
        const auto run = std::ranges::find_if(joined, [&](const PartBarrier& known) {
            return alike(known, part) && known.barrier.base_layer == part.barrier.base_layer &&
                   known.barrier.base_mip + known.barrier.mips == part.barrier.base_mip;
        });
        if (run != joined.end())
            ++run->barrier.mips;
        else
            joined.push_back(part);
    }
    std::vector<PartBarrier> rectangles;
    for (const PartBarrier& run : joined) {
        const auto above = std::ranges::find_if(rectangles, [&](const PartBarrier& known) {
            return alike(known, run) && known.barrier.base_mip == run.barrier.base_mip &&
                   known.barrier.mips == run.barrier.mips &&
                   known.barrier.base_layer + known.barrier.layers == run.barrier.base_layer;
        });
        if (above != rectangles.end())
            ++above->barrier.layers;
        else
            rectangles.push_back(run);
    }
    return rectangles;
}

/// The uses of everything that lies in the memory of a transient resource, itself included: before its first use
/// they must be over, those of the frame before too.
gpu::Access users_of_memory(const CompiledGraph& compiled, const std::vector<std::vector<PositionedUse>>& uses,
                            std::uint32_t resource) {
    gpu::Access all;
    const auto own = std::ranges::find(compiled.placements, resource, &Placement::resource);
    if (own == compiled.placements.end()) return all;
    for (const Placement& other : compiled.placements) {
        if (!share_memory(*own, other)) continue;
        for (const PositionedUse& user : uses[other.resource]) {
            const gpu::Access access =
                source_of({0, access_of_use(user, compiled.resources[other.resource].is_image), true});
            all.stages |= access.stages;
            all.access |= access.access;
        }
    }
    return all;
}

class BarrierPlacer {
public:
    explicit BarrierPlacer(CompiledGraph& compiled) : compiled_(compiled), uses_(compiled.resources.size()) {
        for (std::uint32_t position = 0; position < compiled.order.size(); ++position) {
            const PassDeclaration& pass = compiled.passes[compiled.order[position].pass];
            for (const ResourceUse& use : pass.uses) uses_[use.resource].push_back({position, &use, pass.kind});
        }
    }

    void place() {
        for (std::uint32_t resource = 0; resource < compiled_.resources.size(); ++resource)
            if (!uses_[resource].empty()) place_resource(resource);
    }

private:
    void place_resource(std::uint32_t index) {
        const Resource& resource = compiled_.resources[index];
        const bool transient = resource.lifetime == Lifetime::transient;
        const gpu::Access memory_users = transient ? users_of_memory(compiled_, uses_, index) : gpu::Access{};
        const auto end = static_cast<std::uint32_t>(compiled_.order.size());
        const bool outlives = !transient || resource.exported;
        const gpu::Access final_state = outlives ? final_state_of(index) : gpu::Access{};

        std::vector<PartBarrier> parts;
        for (std::uint32_t layer = 0; layer < resource.layers(); ++layer) {
            for (std::uint32_t mip = 0; mip < resource.mips(); ++mip) {
                const auto add = [&](std::uint32_t position, gpu::Access before, gpu::Access after, bool first) {
                    parts.push_back(
                        {position, {index, before, after, first && transient, first && !transient, mip, 1, layer, 1}});
                };
                const std::vector<Phase> phases = phases_of(uses_[index], resource.is_image, mip, layer);
                gpu::Access before = transient ? memory_users : resource.initial;
                bool first = true;
                for (const Phase& phase : phases) {
                    add(phase.position, before, phase.access, first);
                    before = source_of(phase);
                    first = false;
                }
                const bool as_left = !phases.empty() && phases.back().access == final_state;
                // A part of a transient image that no pass touches has no content to keep.
                if (outlives && !as_left && !(transient && phases.empty())) add(end, before, final_state, first);
            }
        }
        for (const PartBarrier& part : join(parts)) {
            if (part.position == end)
                compiled_.final_barriers.push_back(part.barrier);
            else
                compiled_.order[part.position].barriers.push_back(part.barrier);
        }
        if (outlives) compiled_.final_states.push_back({index, final_state});
    }

    /// What was asked for, or the state that the last pass left, for all parts.
    [[nodiscard]] gpu::Access final_state_of(std::uint32_t index) const {
        const Resource& resource = compiled_.resources[index];
        if (resource.final_usage) {
            gpu::Access access =
                access_of(*resource.final_usage, PassKind::transfer, true, usage_writes(*resource.final_usage));
            if (!resource.is_image) access.layout = VK_IMAGE_LAYOUT_UNDEFINED;
            return access;
        }
        std::optional<Phase> last;
        for (std::uint32_t layer = 0; layer < resource.layers(); ++layer)
            for (std::uint32_t mip = 0; mip < resource.mips(); ++mip)
                for (const Phase& phase : phases_of(uses_[index], resource.is_image, mip, layer))
                    if (!last || phase.position > last->position) last = phase;
        return last ? last->access : gpu::Access{};
    }

    CompiledGraph& compiled_;
    std::vector<std::vector<PositionedUse>> uses_;
};

/// Where in the frame a barrier of the pass at `position` may stand at the earliest: after the last use of what it waits for.
std::uint32_t earliest_position(const CompiledGraph& compiled, const Barrier& barrier, std::uint32_t position) {
    const auto own = std::ranges::find(compiled.placements, barrier.resource, &Placement::resource);
    const auto concerns = [&](const ResourceUse& use) {
        if (use.resource == barrier.resource) return true;
        if (!barrier.discard || own == compiled.placements.end()) return false;
        const auto other = std::ranges::find(compiled.placements, use.resource, &Placement::resource);
        return other != compiled.placements.end() && share_memory(*own, *other);
    };
    while (position > 0 && std::ranges::none_of(compiled.passes[compiled.order[position - 1].pass].uses, concerns)) --position;
    return position;
}

/// Where all that a pass waits for may be waited for together with what an earlier pass does, the pass waits for nothing: it
/// runs beside those between.
void join_waits(CompiledGraph& compiled) {
    std::uint32_t last = 0;  // that has barriers
    for (std::uint32_t position = 1; position < compiled.order.size(); ++position) {
        std::vector<Barrier>& barriers = compiled.order[position].barriers;
        if (barriers.empty()) continue;
        const bool early = std::ranges::all_of(
            barriers, [&](const Barrier& barrier) { return earliest_position(compiled, barrier, position) <= last; });
        if (early)
            std::ranges::move(std::exchange(barriers, {}), std::back_inserter(compiled.order[last].barriers));
        else
            last = position;
    }
}

}  // namespace

void place_barriers(CompiledGraph& compiled) {
    BarrierPlacer(compiled).place();
    join_waits(compiled);
}

}  // namespace heliodon::graph
