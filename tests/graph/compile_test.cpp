// compile() makes no Vulkan call: no entry point is loaded here, so one would crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "graph/compiled_graph.h"

namespace heliodon::graph {
namespace {

constexpr auto compute_stage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr auto fragment_stage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr auto vertex_stage = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
constexpr auto color_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr gpu::Access compute_write{compute_stage, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL};
constexpr gpu::Access compute_sampled{compute_stage, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

gpu::ImageDescription square(const std::string& name, std::uint32_t side = 64, std::uint32_t mips = 1,
                             std::uint32_t layers = 1) {
    return {.name = name,
            .format = VK_FORMAT_R32G32B32A32_SFLOAT,
            .extent = {side, side, 1},
            .mips = mips,
            .layers = layers};
}

/// The names of the passes in the order they run.
std::vector<std::string> order_of(const CompiledGraph& compiled) {
    std::vector<std::string> names;
    for (const CompiledPass& pass : compiled.order) names.push_back(compiled.passes[pass.pass].name);
    return names;
}
using Names = std::vector<std::string>;

const Placement& placement_of(const CompiledGraph& compiled, ImageHandle image) {
    return *std::ranges::find(compiled.placements, image.index, &Placement::resource);
}

std::vector<Barrier> barriers_of(const CompiledGraph& compiled, std::size_t position, ImageHandle image) {
    std::vector<Barrier> found;
    for (const Barrier& barrier : compiled.order[position].barriers)
        if (barrier.resource == image.index) found.push_back(barrier);
    return found;
}

class FrameGraph : public testing::Test {
protected:
    PassHandle pass(const std::string& name, const std::function<void(PassBuilder&)>& setup,
                    PassKind kind = PassKind::compute) {
        return graph.add_pass(name, kind, setup, {});
    }
    PassHandle writer(const std::string& name, ImageHandle target) {
        return pass(name, [&](PassBuilder& p) { p.write(target, Usage::storage_write); });
    }
    PassHandle filter(const std::string& name, ImageHandle source, ImageHandle target) {
        return pass(name, [&](PassBuilder& p) { p.read(source, Usage::sampled).write(target, Usage::storage_write); });
    }
    CompiledGraph compiled(const CompileOptions& options = {}) {
        auto result = compile(graph, options);
        if (!result) throw std::runtime_error(result.error().text());
        return std::move(*result);
    }
    std::string error() {
        const auto result = compile(graph);
        return result ? "" : result.error().text();
    }

    Graph graph;
};

TEST_F(FrameGraph, RunsPassesInTheOrderOfTheirDeclaration) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b"));
    graph.export_image(b);
    writer("first", a);
    filter("second", a, b);
    EXPECT_EQ(order_of(compiled()), (Names{"first", "second"}));
}

TEST_F(FrameGraph, RunsAPassDeclaredTooEarlyAfterTheOneItReads) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b"));
    graph.export_image(b);
    filter("second", a, b);
    writer("first", a);
    EXPECT_EQ(order_of(compiled()), (Names{"first", "second"}));
}

TEST_F(FrameGraph, RunsAReaderBeforeTheNextWriter) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c"));
    graph.export_image(a);
    graph.export_image(b);
    writer("write a", a);
    filter("read a late", c, b);  // waits for c, which is declared last
    pass("read a", [&](PassBuilder& p) { p.read(a, Usage::sampled).write(c, Usage::storage_write); });
    writer("write a again", a);
    const auto order = order_of(compiled());
    EXPECT_EQ(order, (Names{"write a", "read a", "read a late", "write a again"}));
}

TEST_F(FrameGraph, RunsAPassAfterAnotherWhenTold) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c"));
    graph.export_image(a);
    graph.export_image(b);
    // Declared first, but told to run after the one that comes next.
    pass("second", [&](PassBuilder& p) { p.read(c, Usage::sampled).write(a, Usage::storage_write); });
    const PassHandle first = writer("first", b);
    pass("third", [&](PassBuilder& p) { p.write(c, Usage::storage_write).after(first); });
    EXPECT_EQ(order_of(compiled()), (Names{"first", "third", "second"}));
}

TEST_F(FrameGraph, RefusesACycleAndNamesItsPasses) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b"));
    graph.export_image(a);
    filter("chicken", a, b);
    filter("egg", b, a);
    EXPECT_EQ(error(), "frame graph: the passes wait for each other: 'chicken' → 'egg' → 'chicken'");
}

TEST_F(FrameGraph, RefusesToReadWhatNoPassWrites) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b"));
    graph.export_image(b);
    filter("reader", a, b);
    EXPECT_EQ(error(), "pass 'reader': reads 'a', which no pass writes");
}

TEST_F(FrameGraph, RefusesToReadAMipThatNoPassWrites) {
    const ImageHandle a = graph.create_image(square("a", 64, 2)), b = graph.create_image(square("b"));
    graph.export_image(b);
    pass("writer", [&](PassBuilder& p) { p.write({a, 0, 1}, Usage::storage_write); });
    pass("reader", [&](PassBuilder& p) { p.read({a, 1, 1}, Usage::sampled).write(b, Usage::storage_write); });
    EXPECT_EQ(error(), "pass 'reader': reads 'a', which no pass writes");
}

TEST_F(FrameGraph, RefusesTwoIncompatibleUsesInOnePass) {
    const ImageHandle a = graph.create_image(square("a"));
    graph.export_image(a);
    writer("first", a);
    pass("both", [&](PassBuilder& p) { p.read(a, Usage::sampled).write(a, Usage::storage_write); });
    EXPECT_EQ(error(), "pass 'both': uses 'a' both as sampled and as storage_write");
}

TEST_F(FrameGraph, RefusesMistakenDeclarations) {
    const ImageHandle image = graph.create_image(square("image"));
    pass("wrong", [&](PassBuilder& p) { p.write(image, Usage::sampled); });
    EXPECT_EQ(error(), "pass 'wrong': 'image' is written as sampled, which only reads");
    graph = {};
    pass("nothing", [&](PassBuilder& p) { p.read(ImageHandle{}, Usage::sampled); });
    EXPECT_EQ(error(), "pass 'nothing': an image handle names no image");
    graph = {};
    const ImageHandle small = graph.create_image(square("small"));
    pass("far", [&](PassBuilder& p) { p.write({small, 3, 1}, Usage::storage_write); });
    EXPECT_EQ(error(), "pass 'far': image 'small' has 1 mips and 1 layers, not mips 3+1 of layers 0+1");
    graph = {};
    const BufferHandle buffer = graph.create_buffer({.name = "buffer", .size = 4});
    pass("sampler", [&](PassBuilder& p) { p.read(buffer, Usage::sampled); });
    EXPECT_EQ(error(), "pass 'sampler': buffer 'buffer' cannot be used as sampled");
}

TEST_F(FrameGraph, CullsPassesWhoseOutputsNobodyUses) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c"));
    graph.export_image(a);
    writer("wanted", a);
    writer("feeds the unused", b);
    filter("unused", b, c);
    const CompiledGraph result = compiled();
    EXPECT_EQ(order_of(result), Names{"wanted"});
    EXPECT_EQ(result.culled, (std::vector<std::uint32_t>{1, 2}));
    EXPECT_EQ(result.placements.size(), 1u) << "and their resources take no memory";
}

TEST_F(FrameGraph, KeepsPassesWithSideEffectsAndWhatTheyRead) {
    const ImageHandle a = graph.create_image(square("a"));
    writer("source", a);
    pass("effect", [&](PassBuilder& p) { p.read(a, Usage::sampled).side_effect(); });
    EXPECT_EQ(order_of(compiled()), (Names{"source", "effect"}));
}

TEST_F(FrameGraph, KeepsWritersOfImportedAndOfPersistentResourcesThatAreRead) {
    const ImageHandle imported = graph.import_image(square("imported"));
    const auto history = graph.create_history(square("history"));
    const auto unused = graph.create_history(square("unused"));
    filter("resolve", history.previous, imported);
    writer("accumulate", history.current);
    writer("forgotten", unused.current);
    const CompiledGraph result = compiled();
    EXPECT_EQ(order_of(result), (Names{"resolve", "accumulate"}));
    EXPECT_TRUE(result.placements.empty()) << "neither lies in shared memory";
}

TEST_F(FrameGraph, PutsExactlyTheBarriersThatAreNeeded) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b"));
    graph.export_image(b);
    writer("write", a);
    filter("filter", a, b);
    const CompiledGraph result = compiled();

    ASSERT_EQ(result.order[0].barriers.size(), 1u);
    // Its memory was last used by these two passes in the frame before.
    EXPECT_EQ(result.order[0].barriers[0],
              (Barrier{a.index,
                       {compute_stage, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED},
                       compute_write,
                       true}));
    ASSERT_EQ(result.order[1].barriers.size(), 2u);
    EXPECT_EQ(result.order[1].barriers[0], (Barrier{a.index, compute_write, compute_sampled}));
    EXPECT_EQ(result.order[1].barriers[1].resource, b.index);
    EXPECT_TRUE(result.order[1].barriers[1].discard);
    EXPECT_TRUE(result.final_barriers.empty());
    ASSERT_EQ(result.final_states.size(), 1u);
    EXPECT_EQ(result.final_states[0].state, compute_write);
}

TEST_F(FrameGraph, LetsPassesWaitTogetherSoThatThoseThatShareNothingRunSideBySide) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c")), d = graph.create_image(square("d"));
    graph.export_image(c);
    graph.export_image(d);
    writer("write a", a);
    writer("write b", b);
    filter("a to c", a, c);
    filter("b to d", b, d);
    const CompiledGraph result = compiled();
    EXPECT_EQ(result.order[0].barriers.size(), 2u);
    EXPECT_TRUE(result.order[1].barriers.empty());
    EXPECT_EQ(result.order[2].barriers.size(), 4u) << "both inputs and both outputs";
    EXPECT_TRUE(result.order[3].barriers.empty());
}

TEST_F(FrameGraph, WaitsForNothingBeforeItsLastUse) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c"));
    graph.export_image(c);
    writer("write a", a);
    filter("a to b", a, b);
    pass("b and a to c", [&](PassBuilder& p) {
        p.read(b, Usage::sampled).read_write(a, Usage::storage_read_write).write(c, Usage::storage_write);
    });
    const CompiledGraph result = compiled();
    EXPECT_EQ(barriers_of(result, 1, a).size(), 1u);
    EXPECT_EQ(barriers_of(result, 2, a).size(), 1u) << "the pass before reads it";
    EXPECT_EQ(barriers_of(result, 2, b).size(), 1u) << "the pass before writes it";
}

TEST_F(FrameGraph, PutsOneBarrierBeforeSeveralReadsInAllTheirStages) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c"));
    graph.export_image(b);
    graph.export_image(c);
    writer("write", a);
    filter("first reader", a, b);
    pass(
        "second reader", [&](PassBuilder& p) { p.read(a, Usage::sampled).write(c, Usage::color_attachment); },
        PassKind::graphics);
    const CompiledGraph result = compiled();
    const auto first = barriers_of(result, 1, a);
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].after.stages, compute_stage | vertex_stage | fragment_stage);
    EXPECT_EQ(first[0].after.layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    EXPECT_TRUE(barriers_of(result, 2, a).empty()) << "no barrier between reads";
}

TEST_F(FrameGraph, WaitsForReadsBeforeAWriteWithoutFlushingAnything) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b"));
    graph.export_image(a);
    graph.export_image(b);
    writer("write", a);
    filter("read", a, b);
    pass(
        "draw", [&](PassBuilder& p) { p.write(a, Usage::color_attachment); }, PassKind::graphics);
    const auto barriers = barriers_of(compiled(), 2, a);
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_EQ(barriers[0].before,
              (gpu::Access{compute_stage, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}));
    EXPECT_EQ(barriers[0].after.stages, color_stage);
    EXPECT_EQ(barriers[0].after.layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

TEST_F(FrameGraph, PutsBarriersOnTheMipsThatChangeOnly) {
    const ImageHandle pyramid = graph.create_image(square("pyramid", 64, 3, 2));
    graph.export_image(pyramid, Usage::sampled);
    pass("base", [&](PassBuilder& p) { p.write({pyramid, 0, 1}, Usage::storage_write); });
    pass("mip 1", [&](PassBuilder& p) {
        p.read({pyramid, 0, 1}, Usage::sampled).write({pyramid, 1, 1}, Usage::storage_write);
    });
    pass("mip 2", [&](PassBuilder& p) {
        p.read({pyramid, 1, 1}, Usage::sampled).write({pyramid, 2, 1}, Usage::storage_write);
    });
    const CompiledGraph result = compiled();
    const auto second = barriers_of(result, 1, pyramid);
    ASSERT_EQ(second.size(), 2u);
    EXPECT_EQ(second[0], (Barrier{pyramid.index, compute_write, compute_sampled, false, false, 0, 1, 0, 2}));
    EXPECT_EQ(second[1].base_mip, 1u);
    EXPECT_TRUE(second[1].discard);
    // All mips are left ready for reading: by any shader, as was asked for.
    ASSERT_EQ(result.final_barriers.size(), 2u);
    EXPECT_EQ(result.final_barriers[0].base_mip, 0u);
    EXPECT_EQ(result.final_barriers[0].mips, 2u);
    EXPECT_EQ(result.final_barriers[1],
              (Barrier{pyramid.index, compute_write, result.final_states[0].state, false, false, 2, 1, 0, 2}));
    EXPECT_EQ(result.final_states[0].state.layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST_F(FrameGraph, LeavesImportedResourcesToTheirRealState) {
    const ImageHandle texture = graph.import_image(square("texture")), target = graph.create_image(square("target"));
    const BufferHandle arguments = graph.import_buffer({.name = "arguments", .size = 12});
    graph.export_image(target);
    pass("use", [&](PassBuilder& p) {
        p.read(texture, Usage::sampled).read(arguments, Usage::indirect).read(arguments, Usage::storage_read);
        p.write(target, Usage::storage_write);
    });
    const CompiledGraph result = compiled();
    const auto& barriers = result.order[0].barriers;
    ASSERT_EQ(barriers.size(), 3u);
    EXPECT_TRUE(barriers[0].external);
    EXPECT_FALSE(barriers[0].discard);
    const auto buffer = std::ranges::find(barriers, arguments.index, &Barrier::resource);
    EXPECT_EQ(buffer->after.stages, compute_stage | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT) << "both reads, one barrier";
}

TEST_F(FrameGraph, PresentsWhatItExportsForAWindow) {
    const ImageHandle window = graph.import_image(square("window"));
    graph.export_image(window, Usage::present);
    pass(
        "draw", [&](PassBuilder& p) { p.write(window, Usage::color_attachment); }, PassKind::graphics);
    const CompiledGraph result = compiled();
    ASSERT_EQ(result.final_barriers.size(), 1u);
    EXPECT_EQ(result.final_barriers[0].after.layout, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

TEST_F(FrameGraph, SharesMemoryBetweenResourcesThatDoNotLiveAtTheSameTime) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c")), d = graph.create_image(square("d"));
    graph.export_image(d);
    writer("write a", a);
    filter("a to b", a, b);
    filter("b to c", b, c);
    filter("c to d", c, d);
    const CompiledGraph result = compiled();
    const Placement &pa = placement_of(result, a), &pb = placement_of(result, b), &pc = placement_of(result, c),
                    &pd = placement_of(result, d);
    const auto apart = [](const Placement& x, const Placement& y) {
        return x.offset + x.size <= y.offset || y.offset + y.size <= x.offset;
    };
    EXPECT_TRUE(apart(pa, pb)) << "alive together in the second pass";
    EXPECT_TRUE(apart(pb, pc));
    EXPECT_EQ(pa.offset, pc.offset) << "a is dead when c is born";
    for (const Placement* other : {&pa, &pb, &pc})
        EXPECT_TRUE(apart(pd, *other)) << "an exported resource shares with none";
    EXPECT_EQ(result.heaps[0].size, 3 * pa.size);
    EXPECT_EQ(result.unaliased_bytes, 4 * pa.size);

    CompileOptions options;
    options.alias = false;
    EXPECT_EQ(compiled(options).heaps[0].size, 4 * pa.size);
}

TEST_F(FrameGraph, WaitsForTheUsersOfSharedMemoryBeforeItsNextUse) {
    const ImageHandle a = graph.create_image(square("a")), b = graph.create_image(square("b")),
                      c = graph.create_image(square("c"));
    graph.export_image(b);
    pass(
        "draw a", [&](PassBuilder& p) { p.write(a, Usage::color_attachment); }, PassKind::graphics);
    pass("use a", [&](PassBuilder& p) { p.read(a, Usage::sampled).write(b, Usage::storage_write); });
    writer("write c", c);
    pass("use c", [&](PassBuilder& p) { p.read(c, Usage::sampled).read_write(b, Usage::storage_read_write); });
    const CompiledGraph result = compiled();
    ASSERT_EQ(placement_of(result, a).offset, placement_of(result, c).offset);
    const auto barriers = barriers_of(result, 2, c);
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_TRUE(barriers[0].discard);
    EXPECT_EQ(barriers[0].before.stages, color_stage | compute_stage);
    EXPECT_EQ(barriers[0].before.access, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

TEST_F(FrameGraph, PlacesResourcesOfDifferentMemoryTypesApart) {
    const ImageHandle a = graph.create_image(square("a"));
    const BufferHandle b = graph.create_buffer({.name = "b", .size = 100});
    pass("write",
         [&](PassBuilder& p) { p.write(a, Usage::storage_write).write(b, Usage::storage_write).side_effect(); });
    CompileOptions options;
    options.memory_requirements = [](const Resource& resource) {
        return VkMemoryRequirements{resource.is_image ? 4096u : 128u, 64, resource.is_image ? 2u : 1u};
    };
    const CompiledGraph result = compiled(options);
    ASSERT_EQ(result.heaps.size(), 2u);
    EXPECT_EQ(result.placements[0].offset, 0u);
    EXPECT_EQ(result.placements[1].offset, 0u);
    EXPECT_NE(result.placements[0].heap, result.placements[1].heap);
}

TEST_F(FrameGraph, AddsTheUsageFlagsThatItsPassesNeed) {
    const ImageHandle a = graph.create_image(square("a"));
    const auto history = graph.create_history(square("history"));
    graph.export_image(a);
    filter("filter", history.previous, a);
    pass(
        "draw", [&](PassBuilder& p) { p.write(history.current, Usage::color_attachment); }, PassKind::graphics);
    const CompiledGraph result = compiled();
    EXPECT_EQ(result.resources[a.index].image.usage, VK_IMAGE_USAGE_STORAGE_BIT);
    constexpr VkImageUsageFlags both = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    EXPECT_EQ(result.resources[history.current.index].image.usage, both);
    EXPECT_EQ(result.resources[history.previous.index].image.usage, both) << "they change places";
}

TEST_F(FrameGraph, DescribesItselfAsTextAndAsAGraph) {
    const ImageHandle a = graph.create_image(square("albedo")), b = graph.create_image(square("color"));
    graph.export_image(b);
    writer("gbuffer", a);
    filter("shade", a, b);
    const CompiledGraph result = compiled();
    EXPECT_NE(result.text().find("image 'albedo': general → shader read-only"), std::string::npos) << result.text();
    EXPECT_NE(result.dot().find("resource0 -> pass1"), std::string::npos) << result.dot();
}

}  // namespace
}  // namespace heliodon::graph
