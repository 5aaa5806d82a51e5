#include "graph/compiled_graph.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/format.h"
#include "graph/compile_steps.h"

namespace heliodon::graph {
namespace {

void add_usage_flags(CompiledGraph& compiled) {
    for (const CompiledPass& pass : compiled.order) {
        for (const ResourceUse& use : compiled.passes[pass.pass].uses) {
            compiled.resources[use.resource].image.usage |= image_usage(use.usage);
            compiled.resources[use.resource].buffer.usage |= buffer_usage(use.usage);
        }
    }
    // The two images of a history change places, so each is used as both.
    for (Resource& previous : compiled.resources) {
        if (previous.history_of == ~0u) continue;
        Resource& current = compiled.resources[previous.history_of];
        current.image.usage |= previous.image.usage;
        previous.image.usage = current.image.usage;
    }
}

const char* layout_name(VkImageLayout layout) {
    switch (layout) {
        case VK_IMAGE_LAYOUT_UNDEFINED:
            return "undefined";
        case VK_IMAGE_LAYOUT_GENERAL:
            return "general";
        case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
            return "color attachment";
        case VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL:
            return "depth attachment";
        case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL:
            return "depth read-only";
        case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
            return "shader read-only";
        case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
            return "transfer source";
        case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
            return "transfer target";
        case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR:
            return "present";
        default:
            return "other";
    }
}

std::string barrier_text(const CompiledGraph& compiled, const Barrier& barrier) {
    const Resource& resource = compiled.resources[barrier.resource];
    if (!resource.is_image)
        return fmt::format("    buffer '{}': {}\n", resource.name(), barrier.discard ? "first use" : "wait");
    std::string part;
    if (barrier.mips != resource.mips()) part += fmt::format(" mips {}+{}", barrier.base_mip, barrier.mips);
    if (barrier.layers != resource.layers()) part += fmt::format(" layers {}+{}", barrier.base_layer, barrier.layers);
    const char* from = barrier.external
                           ? "as it is"
                           : layout_name(barrier.discard ? VK_IMAGE_LAYOUT_UNDEFINED : barrier.before.layout);
    return fmt::format("    image '{}'{}: {} → {}\n", resource.name(), part, from, layout_name(barrier.after.layout));
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\\\"") : std::string(1, c);
    return result + "\"";
}

}  // namespace

Result<CompiledGraph> compile(const Graph& graph, const CompileOptions& options) {
    auto ordered = order_passes(graph);
    if (!ordered) return tl::unexpected(ordered.error());
    CompiledGraph compiled;
    compiled.resources = graph.resources();
    compiled.passes = graph.passes();
    compiled.culled = std::move(ordered->culled);
    for (const std::uint32_t pass : ordered->order) compiled.order.push_back({pass, {}});
    add_usage_flags(compiled);
    place_memory(compiled, options);
    place_barriers(compiled);
    return compiled;
}

std::string CompiledGraph::text() const {
    std::string text;
    for (std::uint32_t position = 0; position < order.size(); ++position) {
        const PassDeclaration& pass = passes[order[position].pass];
        text += fmt::format("{:2} {}\n", position, pass.name);
        for (const Barrier& barrier : order[position].barriers) text += barrier_text(*this, barrier);
        for (const ResourceUse& use : pass.uses)
            text += fmt::format("    {} '{}' as {}\n", use.reads ? (use.writes ? "changes" : "reads") : "writes",
                                resources[use.resource].name(), usage_name(use.usage));
    }
    for (const std::uint32_t pass : culled) text += fmt::format(" - {} (culled)\n", passes[pass].name);
    for (const Placement& placement : placements)
        text += fmt::format("memory {} at {}, {} bytes: '{}' in passes {} to {}\n", placement.heap, placement.offset,
                            placement.size, resources[placement.resource].name(), placement.first_pass,
                            placement.last_pass);
    VkDeviceSize bytes = 0;
    for (const Heap& heap : heaps) bytes += heap.size;
    text += fmt::format("{} bytes of transient memory; {} without sharing\n", bytes, unaliased_bytes);
    return text;
}

std::string CompiledGraph::dot() const {
    std::string text =
        "digraph frame {\n    rankdir=LR;\n    node [shape=box, style=filled, fillcolor=lightsteelblue];\n";
    std::vector<bool> used(resources.size(), false);
    for (const CompiledPass& compiled_pass : order) {
        const PassDeclaration& pass = passes[compiled_pass.pass];
        text += fmt::format("    pass{} [label={}];\n", compiled_pass.pass, quoted(pass.name));
        for (const ResourceUse& use : pass.uses) {
            used[use.resource] = true;
            const char* label = usage_name(use.usage);
            if (use.reads)
                text +=
                    fmt::format("    resource{} -> pass{} [label=\"{}\"];\n", use.resource, compiled_pass.pass, label);
            if (use.writes)
                text +=
                    fmt::format("    pass{} -> resource{} [label=\"{}\"];\n", compiled_pass.pass, use.resource, label);
        }
    }
    for (std::uint32_t index = 0; index < resources.size(); ++index) {
        if (!used[index]) continue;
        const bool transient = resources[index].lifetime == Lifetime::transient;
        text +=
            fmt::format("    resource{} [label={}, shape={}, fillcolor={}];\n", index, quoted(resources[index].name()),
                        resources[index].is_image ? "ellipse" : "cylinder", transient ? "white" : "lightgoldenrod");
    }
    return text + "}\n";
}

}  // namespace heliodon::graph
