#include "passes/compute_raster/compute_raster.h"

#include <algorithm>

#include "gpu/device.h"

namespace heliodon::passes {
namespace {

using graph::PassBuilder;
using graph::PassContext;
using graph::Usage;
using shading::ComputeRasterConstants;
using shading::RasterView;

constexpr std::uint64_t key_bytes = sizeof(std::uint64_t);
constexpr std::uint64_t key_budget_bytes = 256ull << 20;
constexpr std::uint32_t threads_a_group = 64;

// Window coordinates stay within ±2¹⁴ pixels of the view's centre, so that edge functions fit 64 bits by far …
constexpr float largest_coordinate_px = 16384;
// … and within twice the view, so that depths interpolated there lose little.
constexpr float widest_guard = 2;

std::uint32_t groups_of(std::uint32_t count, std::uint32_t size) {
    return static_cast<std::uint32_t>((std::uint64_t{count} + size - 1) / size);
}

/// Workgroups spread over rows as linear_groups.glsl counts them.
glm::uvec3 spread(std::uint32_t groups, std::uint32_t layers = 1) {
    return {std::min(groups, shading::groups_a_row), (groups + shading::groups_a_row - 1) / shading::groups_a_row,
            layers};
}

/// What both uses share.
struct ComputeRaster {
    const SceneInputs& scene;
    const ComputeRasterInputs& inputs;
    graph::BufferHandle keys, strips, large_triangles;
    const gpu::ComputePipeline *triangles = nullptr, *strip_rows = nullptr, *resolve = nullptr;

    void declare(PassBuilder& pass) const {
        pass.read_write(keys, Usage::storage_read_write);
        pass.read_write(strips, Usage::storage_read_write);
    }
    using Outputs = std::vector<NumberedBinding>;  ///< what the resolving shader writes
    // The three steps of a batch, in order.
    void record_triangles(PassContext& context, const RasterBatch& batch) const;
    void record_strips(PassContext& context, const RasterBatch& batch) const;
    void record_resolve(PassContext& context, const RasterBatch& batch, const Outputs& outputs) const;
    /// All of them of all batches.
    void record(PassContext& context, const Outputs& outputs) const;

private:
    [[nodiscard]] ComputeRasterConstants constants(const RasterBatch& batch) const {
        return {inputs.range_count,    inputs.triangle_count, batch.view_first,      batch.view_count,
                batch.tile_count,      inputs.strip_capacity, inputs.large_capacity, inputs.random_seed};
    }
    [[nodiscard]] std::vector<gpu::Binding> bindings(const PassContext& context, const gpu::Pipeline& pipeline,
                                                     const Outputs& outputs = {}) const {
        std::vector<NumberedBinding> own{{8, *inputs.views},
                                         {12, *inputs.triangle_ranges},
                                         {13, context.buffer(keys)},
                                         {14, context.buffer(strips)},
                                         {17, context.buffer(large_triangles)}};
        own.insert(own.end(), outputs.begin(), outputs.end());
        return select_bindings(pipeline, scene, own);
    }
};

void ComputeRaster::record_triangles(PassContext& context, const RasterBatch& batch) const {
    if (inputs.triangle_count == 0) return;
    const std::uint32_t view_groups = groups_of(batch.view_count, shading::raster_views_a_thread);
    context.commands.dispatch(*triangles, constants(batch), bindings(context, *triangles),
                              spread(groups_of(inputs.triangle_count, threads_a_group), view_groups));
}

void ComputeRaster::record_strips(PassContext& context, const RasterBatch& batch) const {
    if (inputs.triangle_count == 0) return;
    context.commands.dispatch(*strip_rows, constants(batch), bindings(context, *strip_rows), {shading::raster_strip_groups, 1, 1});
}

void ComputeRaster::record_resolve(PassContext& context, const RasterBatch& batch, const Outputs& outputs) const {
    context.commands.dispatch(*resolve, constants(batch), bindings(context, *resolve, outputs), spread(batch.tile_count));
}

void ComputeRaster::record(PassContext& context, const Outputs& outputs) const {
    for (const RasterBatch& batch : inputs.batches) {
        if (&batch != inputs.batches.data()) context.commands.compute_barrier();
        record_triangles(context, batch);
        context.commands.compute_barrier();
        record_strips(context, batch);
        context.commands.compute_barrier();
        record_resolve(context, batch, outputs);
    }
}

Result<ComputeRaster> begin(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                            const ComputeRasterInputs& inputs, const std::string& name, std::uint64_t key_count,
                            bool keeps_slope) {
    ComputeRaster self{scene, inputs, {}, {}, {}};
    const gpu::Specialization specialization{{0, keeps_slope ? 1u : 0u}, {1, inputs.tests_opacity ? 1u : 0u}};
    auto triangles = pipelines.compute("passes/compute_raster/triangles.comp", specialization);
    if (!triangles) return tl::unexpected(triangles.error());
    self.triangles = *triangles;
    auto strip_rows = pipelines.compute("passes/compute_raster/strips.comp", specialization);
    if (!strip_rows) return tl::unexpected(strip_rows.error());
    self.strip_rows = *strip_rows;
    auto resolve = pipelines.compute(keeps_slope ? "passes/compute_raster/resolve_shadow.comp"
                                                 : "passes/compute_raster/resolve_visibility.comp");
    if (!resolve) return tl::unexpected(resolve.error());
    self.resolve = *resolve;
    // Zero at first, and left so by each frame.
    self.keys = graph.create_persistent_buffer({name + " keys", key_count * key_bytes});
    self.strips = graph.create_persistent_buffer(
        {name + " strips", sizeof(shading::RasterStrips) + inputs.strip_capacity * sizeof(glm::uvec2)});
    self.large_triangles =
        graph.create_buffer({name + " large triangles", inputs.large_capacity * sizeof(shading::WindowTriangle)});
    return self;
}

}  // namespace

std::uint64_t raster_key_capacity(const gpu::Device& device, std::uint64_t pixels) {
    return std::min<std::uint64_t>(
        {pixels, key_budget_bytes / key_bytes, device.limits().maxStorageBufferRange / key_bytes});
}

bool can_raster_by_compute(const gpu::Device& device, std::uint64_t pixels_a_view) {
    return device.info().buffer_int64_atomics && raster_key_capacity(device, pixels_a_view) == pixels_a_view;
}

RasterView raster_view(const glm::mat4& world_to_clip, glm::uvec2 corner, glm::uvec2 size, std::uint32_t layer,
                       std::uint32_t number) {
    RasterView view{};
    view.world_to_clip = world_to_clip;
    view.width = size.x;
    view.height = size.y;
    view.corner_x = corner.x;
    view.corner_y = corner.y;
    view.layer = layer;
    view.number = number;
    view.guard =
        std::clamp(2 * largest_coordinate_px / static_cast<float>(std::max(size.x, size.y)), 1.0f, widest_guard);
    return view;
}

std::vector<RasterBatch> raster_batches(std::span<RasterView> views, std::uint64_t key_capacity) {
    const auto tiles = [](std::uint32_t pixels) {
        return (pixels + shading::raster_tile_edge - 1) / shading::raster_tile_edge;
    };
    std::vector<RasterBatch> batches;
    for (std::uint32_t i = 0; i < views.size(); ++i) {
        const std::uint32_t keys = views[i].width * views[i].height;
        if (batches.empty() || batches.back().key_count + std::uint64_t{keys} > key_capacity)
            batches.push_back({i, 0, 0, 0});
        RasterBatch& batch = batches.back();
        views[i].first_key = batch.key_count;
        views[i].first_tile = batch.tile_count;
        batch.key_count += keys;
        batch.tile_count += tiles(views[i].width) * tiles(views[i].height);
        ++batch.view_count;
    }
    return batches;
}

Result<Visibility> add_visibility_by_compute(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                             const ComputeRasterInputs& inputs, VkExtent2D extent) {
    auto raster =
        begin(graph, pipelines, scene, inputs, "visibility", std::uint64_t{extent.width} * extent.height, false);
    if (!raster) return tl::unexpected(raster.error());
    Visibility result;
    const VkExtent3D size{extent.width, extent.height, 1};
    result.ids = graph.create_image({.name = "visibility", .format = VK_FORMAT_R32G32_UINT, .extent = size});
    result.depth = graph.create_image({.name = "depth", .format = computed_depth_format, .extent = size});
    // A view is a batch. Its steps are passes of their own: others can go beside each.
    graph.add_pass(
        "visibility", graph::PassKind::compute,
        [&](PassBuilder& pass) {
            raster->declare(pass);
            pass.write(raster->large_triangles, Usage::storage_write);
        },
        [self = *raster](PassContext& context) { self.record_triangles(context, self.inputs.batches.front()); });
    graph.add_pass(
        "visibility strips", graph::PassKind::compute,
        [&](PassBuilder& pass) {
            raster->declare(pass);
            pass.read(raster->large_triangles, Usage::storage_read);
        },
        [self = *raster](PassContext& context) { self.record_strips(context, self.inputs.batches.front()); });
    graph.add_pass(
        "visibility resolve", graph::PassKind::compute,
        [&](PassBuilder& pass) {
            raster->declare(pass);
            pass.read(raster->large_triangles, Usage::storage_read);
            pass.write(result.ids, Usage::storage_write);
            pass.write(result.depth, Usage::storage_write);
        },
        [self = *raster, result](PassContext& context) {
            self.record_resolve(context, self.inputs.batches.front(), {{15, context.image(result.ids)}, {16, context.image(result.depth)}});
        });
    return result;
}

Result<void> add_shadow_by_compute(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                   const ComputeRasterInputs& inputs, const ShadowMaps& maps,
                                   std::uint64_t key_capacity) {
    auto raster = begin(graph, pipelines, scene, inputs, "shadow", key_capacity, true);
    if (!raster) return tl::unexpected(raster.error());
    graph.add_pass(
        "shadow", graph::PassKind::compute,
        [&](PassBuilder& pass) {
            raster->declare(pass);
            pass.write(raster->large_triangles, Usage::storage_write);
            // Maps that are not drawn now stay.
            pass.read_write(maps.depth, Usage::storage_read_write);
            pass.read_write(maps.slope, Usage::storage_read_write);
        },
        [self = *raster, maps](PassContext& context) {
            self.record(context, {{15, context.image(maps.depth)}, {16, context.image(maps.slope)}});
        });
    return {};
}

}  // namespace heliodon::passes
