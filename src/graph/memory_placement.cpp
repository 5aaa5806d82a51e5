#include <algorithm>

#include "gpu/format.h"
#include "graph/compile_steps.h"

namespace heliodon::graph {
namespace {

VkDeviceSize round_up(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

/// Tightly packed size, where no device is there to ask.
VkMemoryRequirements estimate(const Resource& resource) {
    VkMemoryRequirements requirements{};
    requirements.alignment = 256;
    requirements.memoryTypeBits = 1;
    requirements.size = resource.buffer.size;
    if (resource.is_image) {
        const gpu::ImageDescription& image = resource.image;
        requirements.size = 0;
        for (std::uint32_t mip = 0; mip < image.mips; ++mip)
            requirements.size += gpu::level_bytes(image.format, image.extent, mip) * image.layers * image.samples;
    }
    requirements.size = round_up(requirements.size, requirements.alignment);
    return requirements;
}

bool same_time(const Placement& a, const Placement& b) {
    return a.first_pass <= b.last_pass && b.first_pass <= a.last_pass;
}

std::vector<Placement> find_lifetimes(const CompiledGraph& compiled) {
    std::vector<Placement> placements;
    for (std::uint32_t position = 0; position < compiled.order.size(); ++position) {
        for (const ResourceUse& use : compiled.passes[compiled.order[position].pass].uses) {
            if (compiled.resources[use.resource].lifetime != Lifetime::transient) continue;
            const auto known = std::ranges::find(placements, use.resource, &Placement::resource);
            if (known != placements.end())
                known->last_pass = position;
            else
                placements.push_back({use.resource, 0, 0, 0, position, position});
        }
    }
    // What is wanted after the frame is nobody else's memory at any time.
    for (Placement& placement : placements) {
        if (!compiled.resources[placement.resource].exported) continue;
        placement.first_pass = 0;
        placement.last_pass = static_cast<std::uint32_t>(compiled.order.size());
    }
    return placements;
}

/// The lowest offset where `placement` meets none of those that live at the same time.
VkDeviceSize find_offset(const std::vector<Placement>& placed, const Placement& placement, VkDeviceSize alignment,
                         bool alias) {
    std::vector<const Placement*> neighbours;
    for (const Placement& other : placed)
        if (other.heap == placement.heap && (!alias || same_time(other, placement))) neighbours.push_back(&other);
    std::ranges::sort(neighbours, {}, &Placement::offset);
    VkDeviceSize offset = 0;
    for (const Placement* neighbour : neighbours) {
        if (offset + placement.size <= neighbour->offset) break;
        offset = std::max(offset, round_up(neighbour->offset + neighbour->size, alignment));
    }
    return offset;
}

}  // namespace

bool share_memory(const Placement& a, const Placement& b) {
    return a.heap == b.heap && a.offset < b.offset + b.size && b.offset < a.offset + a.size;
}

void place_memory(CompiledGraph& compiled, const CompileOptions& options) {
    struct Wanted {
        Placement placement;
        VkDeviceSize alignment;
    };
    std::vector<Wanted> wanted;
    for (Placement placement : find_lifetimes(compiled)) {
        const Resource& resource = compiled.resources[placement.resource];
        const VkMemoryRequirements requirements =
            options.memory_requirements ? options.memory_requirements(resource) : estimate(resource);
        auto heap = std::ranges::find(compiled.heaps, requirements.memoryTypeBits, &Heap::memory_types);
        if (heap == compiled.heaps.end())
            heap = compiled.heaps.insert(compiled.heaps.end(), Heap{requirements.memoryTypeBits, 0, 1});
        heap->alignment = std::max(heap->alignment, requirements.alignment);
        placement.heap = static_cast<std::uint32_t>(heap - compiled.heaps.begin());
        placement.size = requirements.size;
        wanted.push_back({placement, requirements.alignment});
        compiled.unaliased_bytes += requirements.size;
    }
    // The largest first: small ones fill the gaps. Stable, so that the result does not depend on the library.
    std::ranges::stable_sort(wanted, std::ranges::greater(), [](const Wanted& w) { return w.placement.size; });
    for (Wanted& want : wanted) {
        Placement& placement = want.placement;
        placement.offset = find_offset(compiled.placements, placement, want.alignment, options.alias);
        Heap& heap = compiled.heaps[placement.heap];
        heap.size = std::max(heap.size, placement.offset + placement.size);
        compiled.placements.push_back(placement);
    }
    std::ranges::sort(compiled.placements, {}, &Placement::resource);
}

}  // namespace heliodon::graph
