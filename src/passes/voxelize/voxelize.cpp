#include "passes/voxelize/voxelize.h"

#include <algorithm>

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
    graph::BufferHandle listed, tile_arguments;

    [[nodiscard]] VoxelizeConstants constants(bool over_tiles) const {
        return {inputs.grid,           inputs.range_count, inputs.triangle_count, surfaces.record_capacity,
                surfaces.tile_capacity, over_tiles ? 1u : 0u};
    }
    /// A compute pass over `shader`: `indirect` arguments, or all triangles in groups of 64 where there are none.
    struct Step {
        const char* name;
        const char* shader;
        bool over_tiles = false;
        graph::BufferHandle indirect{};
        VkDeviceSize indirect_offset = 0;
        bool once = false;  ///< a single workgroup
        std::vector<std::pair<std::uint32_t, graph::BufferHandle>> buffers;  ///< by binding
    };
    Result<void> add(const Step& step, const std::function<void(PassBuilder&)>& setup) const;
};

Result<void> Voxelization::add(const Step& step, const std::function<void(PassBuilder&)>& setup) const {
    auto pipeline = pipelines.compute(step.shader);
    if (!pipeline) return tl::unexpected(pipeline.error());
    graph.add_pass(
        step.name, PassKind::compute,
        [&](PassBuilder& pass) {
            setup(pass);
            if (step.indirect) pass.read(step.indirect, Usage::indirect);
        },
        [self = *this, step, pipeline = *pipeline](PassContext& context) {
            std::vector<NumberedBinding> own{{11, *self.inputs.shading_tables}, {12, *self.inputs.triangle_ranges}};
            for (const auto& [binding, handle] : step.buffers) own.emplace_back(binding, context.buffer(handle));
            const auto bindings = select_bindings(*pipeline, self.scene, own);
            const VoxelizeConstants push = self.constants(step.over_tiles);
            if (step.indirect)
                context.commands.dispatch_indirect(*pipeline, push, bindings, context.buffer(step.indirect), step.indirect_offset);
            else
                context.commands.dispatch(*pipeline, push, bindings,
                                          step.once ? glm::uvec3(1)
                                                    : spread((push.triangle_count + threads_a_group - 1) / threads_a_group));
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
        },
        [self](PassContext& context) {
            const VkDeviceSize voxels = VkDeviceSize{self.surfaces.size} * self.surfaces.size * self.surfaces.size;
            context.commands.fill(context.buffer(self.surfaces.numbers), 0, 0, sizeof(shading::VoxelHeader) + voxels * word_bytes);
            context.commands.fill(context.buffer(self.surfaces.levels), 0, 0, sizeof(shading::VoxelLevelsHeader));
            context.commands.fill(context.buffer(self.listed), 0);
        });
}

Result<void> add_arguments(const Voxelization& self, const char* name) {
    return self.add({.name = name, .shader = "passes/voxelize/arguments.comp", .once = true,
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
        pass.write(s.cells, Usage::storage_write);
        pass.write(s.tiles, Usage::storage_write);
    };
    if (auto done = self.add(step, uses); !done) return done;
    if (auto done = add_arguments(self, "voxelize tile arguments"); !done) return done;
    step.name = "voxelize mark large";
    step.over_tiles = true;
    step.indirect = self.tile_arguments;
    const auto uses_of_tiles = [&](PassBuilder& pass) {
        pass.read_write(s.numbers, Usage::storage_read_write);
        pass.read_write(s.cells, Usage::storage_read_write);
        pass.read_write(s.tiles, Usage::storage_read_write);
    };
    if (auto done = self.add(step, uses_of_tiles); !done) return done;
    return add_arguments(self, "voxelize arguments");
}

Result<void> add_prepare(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    return self.add({.name = "voxelize prepare", .shader = "passes/voxelize/prepare.comp", .indirect = s.numbers,
                     .indirect_offset = offsetof(shading::VoxelHeader, face_groups),
                     .buffers = {{16, s.numbers}, {17, s.cells}, {18, s.records}, {20, s.levels}, {21, self.listed}}},
                    [&](PassBuilder& pass) {
                        pass.read(s.numbers, Usage::storage_read);
                        pass.read(s.cells, Usage::storage_read);
                        pass.write(s.records, Usage::storage_write);
                        pass.read_write(s.levels, Usage::storage_read_write);
                        pass.read_write(self.listed, Usage::storage_read_write);
                    });
}

Result<void> add_sum(const Voxelization& self) {
    const VoxelSurfaces& s = self.surfaces;
    Voxelization::Step step{.name = "voxelize sum", .shader = "passes/voxelize/sum.comp",
                            .buffers = {{16, s.numbers}, {18, s.records}, {19, s.tiles}}};
    const auto uses = [&](PassBuilder& pass) {
        pass.read(s.numbers, Usage::storage_read);
        pass.read(s.tiles, Usage::storage_read);
        pass.read_write(s.records, Usage::storage_read_write);
    };
    if (auto done = self.add(step, uses); !done) return done;
    step.name = "voxelize sum large";
    step.over_tiles = true;
    step.indirect = self.tile_arguments;
    return self.add(step, uses);
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
    Voxelization self{graph, pipelines, scene, inputs, surfaces, {}, {}};
    self.listed = graph.create_buffer({"listed coarse voxels", listed_words(surfaces.size) * word_bytes});
    self.tile_arguments = graph.create_buffer({"voxel tile arguments", sizeof(glm::uvec4)});
    add_clear(self);
    if (auto done = add_mark(self); !done) return done;
    if (auto done = add_prepare(self); !done) return done;
    return add_sum(self);
}

}  // namespace heliodon::passes
