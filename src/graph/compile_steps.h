#pragma once

// The steps of compile(); none makes a Vulkan call.
#include <cstdint>
#include <vector>

#include "graph/compiled_graph.h"

namespace heliodon::graph {

struct PassOrder {
    std::vector<std::uint32_t> order;  // live passes, first to last
    std::vector<std::uint32_t> culled;
};
/// Which passes run, and in which order.
[[nodiscard]] Result<PassOrder> order_passes(const Graph& graph);

/// Lifetimes, sizes and offsets of the transient resources, from `compiled.order`.
void place_memory(CompiledGraph& compiled, const CompileOptions& options);

/// The barriers before each pass and at the end, from `compiled.order` and `compiled.placements`.
void place_barriers(CompiledGraph& compiled);

/// Whether two uses touch a common part of one resource.
[[nodiscard]] bool overlap(const ResourceUse& a, const ResourceUse& b);
/// Whether two transient resources lie in the same memory.
[[nodiscard]] bool share_memory(const Placement& a, const Placement& b);

}  // namespace heliodon::graph
