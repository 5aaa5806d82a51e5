#include "passes/voxelize/voxelize.h"

#include <algorithm>
#include <cmath>

#include "gpu/device.h"

namespace heliodon::passes {
namespace {

using graph::PassBuilder;
using graph::PassContext;
using graph::PassKind;
using graph::Usage;
using shading::VoxelizeConstants;

constexpr VkDeviceSize word_bytes = sizeof(std::uint32_t);
constexpr std::uint32_t threads_a_group = 64;

/// Words that tell for every coarse voxel whether it is listed.
VkDeviceSize listed_words(std::uint32_t size) {
    VkDeviceSize words = 0;
    for (std::uint32_t n = size / 2; n >= 1; n /= 2) words += shading::voxel_bit_words(n);
    return std::max<VkDeviceSize>(words, 1);
}

/// Workgroups spread over rows as linear_groups.glsl counts them.
glm::uvec3 spread(std::uint32_t groups) {
    return {std::min(groups, shading::groups_a_row), (groups + shading::groups_a_row - 1) / shading::groups_a_row, 1};
}

/// The passes share what they are told and what they work on.
struct Voxelization {
    graph::Graph& graph;
    gpu::Pipelines& pipelines;
    const SceneInputs& scene;
    const VoxelizeInputs& inputs;
    VoxelSurfaces surfaces;
    graph::BufferHandle listed, tile_arguments, sources, even_surfaces;

    [[nodiscard]] VoxelizeConstants constants(bool over_tiles) const {
        return {inputs.grid,           inputs.range_count, inputs.triangle_count, surfaces.record_capacity,
                surfaces.tile_capacity, over_tiles ? 1u : 0u,  0.0f, 0, 0, inputs.shift,
                inputs.entered_only ? 1u : 0u};
    }
    using NumberedBuffers = std::vector<std::pair<std::uint32_t, graph::BufferHandle>>;
    [[nodiscard]] std::vector<gpu::Binding> bindings(const gpu::Pipeline& pipeline, const NumberedBuffers& buffers,
                                                     const PassContext& context) const {
        std::vector<NumberedBinding> own{{11, *inputs.shading_tables}, {12, *inputs.triangle_ranges}};
        for (const auto& [binding, handle] : buffers) own.emplace_back(binding, context.buffer(handle));
        return select_bindings(pipeline, scene, own);
    }
    /// A compute pass over `shader`: `indirect` arguments, or what it is over in groups of 64 where there are none.
    struct Step {
        const char* name;
        const char* shader;
        bool over_tiles = false;
        graph::BufferHandle indirect{};
        VkDeviceSize indirect_offset = 0;
        enum class Over { triangles, ranges, nothing } over = Over::triangles;  ///< nothing: a single workgroup
        NumberedBuffers buffers;
        gpu::Specialization constants{};
    };
    Result<void> add(const Step& step, const std::function<void(PassBuilder&)>& setup) const;
};

glm::uvec3 groups_over(Voxelization::Step::Over over, const VoxelizeConstants& push) {
    if (over == Voxelization::Step::Over::nothing) return glm::uvec3(1);
    const std::uint32_t threads = over == Voxelization::Step::Over::ranges ? push.range_count : push.triangle_count;
    return spread((threads + threads_a_group - 1) / threads_a_group);
}

Result<void> Voxelization::add(const Step& step, const std::function<void(PassBuilder&)>& setup) const {
    gpu::Specialization constants = step.constants;
    set_material_constants(constants, scene);
    auto pipeline = pipelines.compute(step.shader, constants);
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        step.name, PassKind::compute,
        [&](PassBuilder& pass) {
            setup(pass);
            if (step.indirect) pass.read(step.indirect, Usage::indirect);
        },
        [self = *this, step, pipeline = *pipeline](PassContext& context) {
            const auto bindings = self.bindings(*pipeline, step.buffers, context);
            const VoxelizeConstants push = self.constants(step.over_tiles);
            if (step.indirect)
                context.commands.dispatch_indirect(*pipeline, push, bindings, context.buffer(step.indirect), step.indirect_offset);
            else
                context.commands.dispatch(*pipeline, push, bindings, groups_over(step.over, push));
        });
    return {};
}

void add_clear(const Voxelization& self) {
    self.graph.add_pass(
        "voxelize clear", PassKind::transfer,
        [&](PassBuilder& pass) {
            pass.write(self.surfaces.numbers, Usage::transfer_write);
            pass.write(self.surfaces.levels, Usage::transfer_write);
            pass.write(self.listed, Usage::transfer_write);
            if (self.sources) pass.write(self.sources, Usage::transfer_write);
        },
        [self](PassContext& context) {
            const VkDeviceSize voxels = VkDeviceSize{self.surfaces.size} * self.surfaces.size * self.surfaces.size;
            context.commands.fill(context.buffer(self.surfaces.numbers), 0, 0, sizeof(shading::VoxelHeader) + voxels * word_bytes);
            context.commands.fill(context.buffer(self.surfaces.levels), 0, 0, sizeof(shading::VoxelLevelsHeader));
            context.commands.fill(context.buffer(self.listed), 0);
            if (self.sources) context.commands.fill(context.buffer(self.sources), 0);
        });
}

Result<void> add_surfaces(const Voxelization& self) {
    return self.add({.name = "voxelize surfaces", .shader = "passes/voxelize/surfaces.comp", .over = Voxelization::Step::Over::ranges,
                     .buffers = {{13, self.even_surfaces}}},
                    [&](PassBuilder& pass) { pass.write(self.even_surfaces, Usage::storage_write); });
}

Result<void> add_carry(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    return self.add({.name = "voxelize carry", .shader = "passes/voxelize/carry.comp", .indirect = s.carried.numbers,
                     .indirect_offset = offsetof(shading::VoxelHeader, record_groups),
                     .buffers = {{16, s.numbers}, {17, s.cells}, {18, self.sources}, {19, s.carried.numbers}, {20, s.carried.cells}}},
                    [&](PassBuilder& pass) {
                        pass.read_write(s.numbers, Usage::storage_read_write);
                        pass.write(s.cells, Usage::storage_write);
                        pass.read_write(self.sources, Usage::storage_read_write);
                        pass.read(s.carried.numbers, Usage::storage_read);
                        pass.read(s.carried.cells, Usage::storage_read);
                    });
}

/// `over_tiles`: of what goes over tiles alone, and not also over all triangles.
Result<void> add_arguments(const Voxelization& self, const char* name, bool over_tiles) {
    return self.add({.name = name, .shader = "passes/voxelize/arguments.comp", .over_tiles = over_tiles,
                     .over = Voxelization::Step::Over::nothing,
                     .buffers = {{16, self.surfaces.numbers}, {20, self.tile_arguments}}},
                    [&](PassBuilder& pass) {
                        pass.read_write(self.surfaces.numbers, Usage::storage_read_write);
                        pass.write(self.tile_arguments, Usage::storage_write);
                    });
}

Result<void> add_mark(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    Voxelization::Step step{.name = "voxelize mark", .shader = "passes/voxelize/mark.comp",
                            .buffers = {{16, s.numbers}, {17, s.cells}, {19, s.tiles}}};
    const auto uses = [&](PassBuilder& pass) {
        pass.read_write(s.numbers, Usage::storage_read_write);
        pass.read_write(s.cells, Usage::storage_read_write);  // those that are carried stay
        pass.write(s.tiles, Usage::storage_write);
    };
    if (auto done = self.add(step, uses); !done) return done;
    if (auto done = add_arguments(self, "voxelize tile arguments", true); !done) return done;
    step.name = "voxelize mark large";
    step.over_tiles = true;
    step.indirect = self.tile_arguments;
    const auto uses_of_tiles = [&](PassBuilder& pass) {
        pass.read_write(s.numbers, Usage::storage_read_write);
        pass.read_write(s.cells, Usage::storage_read_write);
        pass.read_write(s.tiles, Usage::storage_read_write);
    };
    if (auto done = self.add(step, uses_of_tiles); !done) return done;
    return add_arguments(self, "voxelize arguments", false);
}

Result<void> add_prepare(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    const bool carries = bool(s.carried.records);
    // Without anything to carry nothing reads the last two.
    return self.add({.name = "voxelize prepare", .shader = "passes/voxelize/prepare.comp", .indirect = s.numbers,
                     .indirect_offset = offsetof(shading::VoxelHeader, record_groups),
                     .buffers = {{16, s.numbers}, {18, s.records},
                                 {22, carries ? self.sources : s.cells}, {23, carries ? s.carried.records : s.cells}},
                     .constants = {{0, carries ? 1u : 0u}}},
                    [&](PassBuilder& pass) {
                        pass.read(s.numbers, Usage::storage_read);
                        pass.write(s.records, Usage::storage_write);
                        pass.read(carries ? self.sources : s.cells, Usage::storage_read);
                        if (carries) pass.read(s.carried.records, Usage::storage_read);
                    });
}

/// Touches nothing that the sums touch: both can be under way at once.
Result<void> add_levels(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    return self.add({.name = "voxelize levels", .shader = "passes/voxelize/levels.comp", .indirect = s.numbers,
                     .indirect_offset = offsetof(shading::VoxelHeader, record_groups),
                     .buffers = {{16, s.numbers}, {17, s.cells}, {20, s.levels}, {21, self.listed}}},
                    [&](PassBuilder& pass) {
                        pass.read(s.numbers, Usage::storage_read);
                        pass.read(s.cells, Usage::storage_read);
                        pass.read_write(s.levels, Usage::storage_read_write);
                        pass.read_write(self.listed, Usage::storage_read_write);
                    });
}

Result<void> add_sum(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    return self.add({.name = "voxelize sum", .shader = "passes/voxelize/sum.comp", .indirect = self.tile_arguments,
                     .buffers = {{13, self.even_surfaces}, {16, s.numbers}, {18, s.records}, {19, s.tiles}}},
                    [&](PassBuilder& pass) {
                        pass.read(self.even_surfaces, Usage::storage_read);
                        pass.read(s.numbers, Usage::storage_read);
                        pass.read(s.tiles, Usage::storage_read);
                        pass.read_write(s.records, Usage::storage_read_write);
                    });
}

/// How the hardware is made to find every pixel that a triangle touches.
struct Coverage {
    std::optional<float> conservative_px;  ///< by itself, triangles grown by so much
    float dilation_px = 0;                 ///< or by triangles that are drawn so much larger
};
Coverage coverage_of(const gpu::Device& device) {
    // Corners are rounded to the rasterizer's grid first: what that can take away is added.
    const float rounding = std::ldexp(1.0f, -static_cast<int>(device.limits().subPixelPrecisionBits));
    const gpu::DeviceInfo& info = device.info();
    if (info.conservative_rasterization && info.conservative_degenerates && info.conservative_extra_px >= rounding)
        return {.conservative_px = rounding};
    return {.dilation_px = 0.5f + rounding};
}

/// Draws all triangles without attachments, a pixel a column of voxels.
Result<void> add_raster(const Voxelization& self, const char* name, const char* fragment,
                        const Voxelization::NumberedBuffers& buffers, const std::function<void(PassBuilder&)>& setup) {
    const Coverage coverage = coverage_of(self.pipelines.device());
    gpu::GraphicsDescription description;
    description.name = name;
    description.vertex = "passes/voxelize/raster.vert";
    description.geometry = "passes/voxelize/raster.geom";
    description.fragment = fragment;
    description.cull_mode = VK_CULL_MODE_NONE;
    description.conservative_px = coverage.conservative_px;
    auto pipeline = self.pipelines.graphics(description);
    if (!pipeline) return tl::unexpected(pipeline.error());
    self.graph.add_pass(name, PassKind::graphics, setup, [self, buffers, coverage, pipeline = *pipeline](PassContext& context) {
        if (self.inputs.triangle_count == 0) return;
        VoxelizeConstants push = self.constants(false);
        push.dilation_px = coverage.dilation_px;
        const std::uint32_t size = self.surfaces.size;
        gpu::Rendering rendering;
        rendering.area = VkRect2D{{0, 0}, {size, size}};
        context.commands.begin_rendering(rendering);
        context.commands.bind(*pipeline, push, self.bindings(*pipeline, buffers, context));
        context.commands.draw(3 * self.inputs.triangle_count);
        context.commands.end_rendering();
    });
    return {};
}

/// The buffers that no one else sees, the clearing of all that counts, and what is carried.
Result<Voxelization> begin(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene, const VoxelizeInputs& inputs,
                           const VoxelSurfaces& surfaces) {
    Voxelization self{graph, pipelines, scene, inputs, surfaces, {}, {}, {}, {}};
    self.listed = graph.create_buffer({"listed coarse voxels", listed_words(surfaces.size) * word_bytes});
    self.tile_arguments = graph.create_buffer({"voxel tile arguments", sizeof(glm::uvec4)});
    self.even_surfaces = graph.create_buffer({"surfaces of voxels", shading::most_even_surfaces * sizeof(shading::VoxelSurface)});
    if (surfaces.carried.records) self.sources = graph.create_buffer({"sources of voxels", surfaces.record_capacity * word_bytes});
    add_clear(self);
    if (auto done = add_surfaces(self); !done) return tl::unexpected(done.error());
    if (surfaces.carried.records)
        if (auto done = add_carry(self); !done) return tl::unexpected(done.error());
    return self;
}

}  // namespace

VoxelBufferSizes voxel_buffer_sizes(std::uint32_t size, std::uint32_t record_capacity, std::uint32_t tile_capacity) {
    std::uint32_t levels = 0;
    while ((size >> (levels + 1)) > 0) ++levels;
    VoxelBufferSizes sizes;
    sizes.numbers = sizeof(shading::VoxelHeader) + VkDeviceSize{size} * size * size * word_bytes;
    sizes.cells = VkDeviceSize{record_capacity} * word_bytes;
    sizes.records = VkDeviceSize{record_capacity} * shading::voxel_faces * shading::voxel_field_count * word_bytes;
    sizes.tiles = VkDeviceSize{tile_capacity} * sizeof(shading::VoxelTile);
    sizes.levels = sizeof(shading::VoxelLevelsHeader) + shading::voxel_level_first(levels + 1, size, record_capacity) * word_bytes;
    return sizes;
}

Result<void> add_voxelize(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene, const VoxelizeInputs& inputs,
                          const VoxelSurfaces& surfaces) {
    const auto self = begin(graph, pipelines, scene, inputs, surfaces);
    if (!self) return tl::unexpected(self.error());
    if (auto done = add_mark(*self); !done) return done;
    if (auto done = add_prepare(*self); !done) return done;
    if (auto done = add_sum(*self); !done) return done;
    return add_levels(*self);
}

Result<void> add_voxelize_raster(graph::Graph& graph, gpu::Pipelines& pipelines, const SceneInputs& scene,
                                 const VoxelizeInputs& inputs, const VoxelSurfaces& surfaces) {
    const auto begun = begin(graph, pipelines, scene, inputs, surfaces);
    if (!begun) return tl::unexpected(begun.error());
    const Voxelization& self = *begun;
    auto done = add_raster(self, "voxelize mark raster", "passes/voxelize/raster_mark.frag",
                           {{16, surfaces.numbers}, {17, surfaces.cells}}, [&](PassBuilder& pass) {
                               pass.read_write(surfaces.numbers, Usage::storage_read_write);
                               pass.read_write(surfaces.cells, Usage::storage_read_write);
                           });
    if (!done) return done;
    if (done = add_arguments(self, "voxelize arguments", false); !done) return done;
    if (done = add_prepare(self); !done) return done;
    if (done = add_levels(self); !done) return done;
    return add_raster(self, "voxelize sum raster", "passes/voxelize/raster_sum.frag",
                      {{13, self.even_surfaces}, {16, surfaces.numbers}, {18, surfaces.records}}, [&](PassBuilder& pass) {
                          pass.read(self.even_surfaces, Usage::storage_read);
                          pass.read(surfaces.numbers, Usage::storage_read);
                          pass.read_write(surfaces.records, Usage::storage_read_write);
                      });
}

}  // namespace heliodon::passes
