#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "graph/graph.h"

namespace heliodon::graph {

/// A transition of a resource (or a part of an image) before a pass.
struct Barrier {
    std::uint32_t resource = 0;
    gpu::Access before, after;
    bool discard = false;  ///< the old content is not kept (layout UNDEFINED)
    bool external =
        false;  ///< first use of an imported or persistent resource: Executor puts its real state in `before`
    std::uint32_t base_mip = 0, mips = 1, base_layer = 0, layers = 1;

    friend bool operator==(const Barrier&, const Barrier&) = default;
};

struct CompiledPass {
    std::uint32_t pass = 0;  ///< index in Graph::passes()
    std::vector<Barrier> barriers;
};

/// How the frame leaves a resource that outlives it.
struct FinalState {
    std::uint32_t resource = 0;
    gpu::Access state;
};

/// Where a transient resource lies.
struct Placement {
    std::uint32_t resource = 0;
    std::uint32_t heap = 0;  ///< resources that can share memory have the same heap
    VkDeviceSize offset = 0, size = 0;
    std::uint32_t first_pass = 0, last_pass = 0;  ///< lifetime, as positions in CompiledGraph::order
};
struct Heap {
    std::uint32_t memory_types = 0;  ///< VkMemoryRequirements::memoryTypeBits
    VkDeviceSize size = 0, alignment = 1;
};

/// A Graph made ready: plain data, the same for every frame.
struct CompiledGraph {
    std::vector<CompiledPass> order;
    std::vector<std::uint32_t> culled;     ///< passes whose outputs nobody uses
    std::vector<Barrier> final_barriers;   ///< bring imported and persistent resources to one state for all their parts
    std::vector<FinalState> final_states;  ///< how the frame leaves them
    std::vector<Placement> placements;     ///< of transient resources that live passes use
    std::vector<Heap> heaps;
    std::vector<Resource> resources;      ///< with the usage flags their uses need
    std::vector<PassDeclaration> passes;  ///< as declared
    VkDeviceSize unaliased_bytes = 0;     ///< what the placed resources would take without sharing

    /// One line a pass, with its barriers, then the placements.
    [[nodiscard]] std::string text() const;
    /// For Graphviz: passes and the resources between them.
    [[nodiscard]] std::string dot() const;
};

struct CompileOptions {
    /// Size, alignment and memory types of a resource; unset: estimated from its description.
    std::function<VkMemoryRequirements(const Resource&)> memory_requirements;
    bool alias = true;  ///< false: every transient resource has its own memory
};

/// Orders, culls, places barriers and memory; makes no Vulkan call. Errors: a cycle, a transient resource read but
/// never written, one resource used in two incompatible ways by a pass, mistakes of declaration.
[[nodiscard]] Result<CompiledGraph> compile(const Graph& graph, const CompileOptions& options = {});

}  // namespace heliodon::graph
