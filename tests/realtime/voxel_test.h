#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "gpu/device.h"
#include "heliodon_passes_shaders.h"
#include "passes/voxelize/voxelize.h"
#include "realtime/gpu_scene.h"
#include "shading/tables.h"
#include "test_scenes.h"

namespace heliodon::tests {

using shading::VoxelGrid;

/// The value, or a failed test that says the error.
template <class T>
T value_of(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

constexpr std::uint32_t record_words = shading::voxel_faces * shading::voxel_field_count;
using VoxelRecord = std::array<std::uint32_t, record_words>;

/// What voxelization left, read back.
struct Voxels {
    VoxelGrid grid{};
    shading::VoxelHeader header{};
    shading::VoxelLevelsHeader levels{};
    std::vector<std::vector<std::uint32_t>> level_lists;  ///< [0] is unused
    std::vector<std::uint32_t> number;                    ///< by voxel
    std::map<std::uint32_t, VoxelRecord> records;         ///< by voxel

    [[nodiscard]] std::uint32_t index(glm::ivec3 v) const { return v.x + grid.size * (v.y + grid.size * v.z); }
    [[nodiscard]] glm::ivec3 voxel(std::uint32_t index) const {
        return glm::ivec3(index % grid.size, index / grid.size % grid.size, index / (grid.size * grid.size));
    }
    [[nodiscard]] bool occupied(glm::ivec3 v) const { return number[index(v)] != 0; }
    /// In the unit that the field is a sum of.
    [[nodiscard]] static double field(const VoxelRecord& record, int face, std::uint32_t field) {
        return static_cast<std::int32_t>(record[face * shading::voxel_field_count + field]) / double{shading::voxel_fixed_one};
    }
    /// Sum over all records.
    [[nodiscard]] double total(int face, std::uint32_t field_number) const {
        double sum = 0;
        for (const auto& [place, record] : records) sum += field(record, face, field_number);
        return sum;
    }
};

/// Each edge of the cube `from` … `from` + `edge_m` in `size` voxels.
inline VoxelGrid grid_over(glm::vec3 from, float edge_m, std::uint32_t size) {
    return {from, edge_m / static_cast<float>(size), size, 1.0f, 1.0f, 0};
}

/// Voxelizes scenes under validation; every test ends without a message.
class VoxelTest : public ::testing::Test {
protected:
    using AddVoxelize = decltype(&passes::add_voxelize);
    struct Capacity {
        std::uint32_t records = 1 << 16, tiles = 1 << 14;
    };

    static void SetUpTestSuite() {
        gpu::InstanceSettings settings;
        settings.validation = true;
        gpu::DeviceSettings device_settings;
        device_settings.pipeline_cache_directory = "";
        device_ = value_of(gpu::Device::create(value_of(gpu::Instance::create(settings)), device_settings));
        pipelines_ = std::make_unique<gpu::Pipelines>(*device_, gpu::ShaderLibrary(passes::embedded_shaders()));
    }
    static void TearDownTestSuite() {
        pipelines_.reset();
        device_.reset();
    }
    void TearDown() override {
        value_of(device().wait_idle());
        for (const auto& message : device().validation_messages()) ADD_FAILURE() << message;
    }
    static gpu::Device& device() { return *device_; }

    template <class T>
    gpu::Buffer filled(const char* name, std::span<const T> values) {
        auto buffer = value_of(gpu::Buffer::create(device(), {name, std::max<VkDeviceSize>(values.size_bytes(), 16)}));
        if (!values.empty()) value_of(device().upload(buffer, values));
        return buffer;
    }

    Voxels voxelize(const Scene& scene, const VoxelGrid& grid, Capacity capacity, AddVoxelize add = &passes::add_voxelize) {
        realtime::GpuScene gpu_scene(device());
        value_of(gpu_scene.update(scene));
        passes::SceneInputs tables;
        gpu_scene.append_bindings(tables.tables);
        tables.index_buffer = &gpu_scene.index_buffer();
        tables.instance_count = gpu_scene.instance_count();

        passes::VoxelizeInputs inputs;
        std::vector<passes::TriangleRange> ranges;
        const auto instances = gpu_scene.flat().instances();
        for (std::uint32_t i = 0; i < instances.size(); ++i) {
            const Geometry* geometry = gpu_scene.flat().geometries()[instances[i].geometry];
            if (!(instances[i].flags & shading::instance_flag_visible) || !geometry) continue;
            ranges.push_back({inputs.triangle_count, i});
            inputs.triangle_count += static_cast<std::uint32_t>(geometry->mesh.triangle_count());
        }
        const gpu::Buffer range_buffer = filled("ranges", std::span<const passes::TriangleRange>(ranges));
        const gpu::Buffer shading_tables = filled("shading tables", shading::shading_tables());
        inputs.grid = grid;
        inputs.triangle_ranges = &range_buffer;
        inputs.range_count = static_cast<std::uint32_t>(ranges.size());
        inputs.shading_tables = &shading_tables;

        graph::Graph graph;
        const auto sizes = passes::voxel_buffer_sizes(grid.size, capacity.records, capacity.tiles);
        const auto make = [&](const char* name, VkDeviceSize bytes) {
            const graph::BufferHandle handle = graph.create_persistent_buffer({name, bytes});
            graph.export_buffer(handle);
            return handle;
        };
        const passes::VoxelSurfaces surfaces{make("numbers", sizes.numbers), make("cells", sizes.cells),
                                             make("records", sizes.records), make("tiles", sizes.tiles),
                                             make("levels", sizes.levels), grid.size, capacity.records, capacity.tiles};
        value_of(add(graph, *pipelines_, tables, inputs, surfaces));
        graph::Executor executor(device());
        value_of(executor.set_graph(graph));
        auto commands = value_of(device().begin_commands("voxelize"));
        value_of(executor.execute(commands));
        value_of(device().submit(std::move(commands)));
        return read_back(executor, surfaces, grid);
    }

    Voxels read_back(const graph::Executor& executor, const passes::VoxelSurfaces& surfaces, const VoxelGrid& grid) {
        const auto words = [&](graph::BufferHandle handle) {
            return value_of(device().read_back_as<std::uint32_t>(executor.buffer(handle)));
        };
        Voxels voxels;
        voxels.grid = grid;
        const auto numbers = words(surfaces.numbers), levels = words(surfaces.levels);
        std::memcpy(&voxels.header, numbers.data(), sizeof voxels.header);
        voxels.number.assign(numbers.begin() + sizeof voxels.header / 4, numbers.end());
        std::memcpy(&voxels.levels, levels.data(), sizeof voxels.levels);
        voxels.level_lists.resize(1);
        for (std::uint32_t level = 1; (grid.size >> level) > 0; ++level) {
            const auto first = levels.begin() + sizeof voxels.levels / 4 +
                               shading::voxel_level_first(level, grid.size, surfaces.record_capacity);
            voxels.level_lists.emplace_back(first, first + voxels.levels.groups[level].w);
        }
        const auto cells = words(surfaces.cells), records = words(surfaces.records);
        for (std::uint32_t i = 0; i < voxels.header.record_count; ++i) {
            EXPECT_EQ(voxels.number[cells[i]], i + 1);
            std::copy_n(records.begin() + i * record_words, record_words, voxels.records[cells[i]].begin());
        }
        return voxels;
    }

private:
    static inline std::unique_ptr<gpu::Device> device_;
    static inline std::unique_ptr<gpu::Pipelines> pipelines_;
};

inline NodeId add_mesh(Scene& scene, Mesh mesh, MaterialId material, const Transform& transform = {}) {
    Geometry geometry;
    geometry.mesh = std::move(mesh);
    Node node;
    node.transform = transform;
    node.parts.push_back({scene.add_geometry(std::move(geometry)), material});
    return scene.add_node(std::move(node));
}

/// Each triangle of `mesh` in `n`² of its shape.
inline Mesh subdivided(const Mesh& mesh, std::uint32_t n) {
    Mesh fine;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        const glm::dvec3 a = mesh.positions[mesh.indices[3 * t]], b = mesh.positions[mesh.indices[3 * t + 1]],
                         c = mesh.positions[mesh.indices[3 * t + 2]];
        const auto first = static_cast<std::uint32_t>(fine.positions.size());
        const auto row = [&](std::uint32_t i) { return first + i * (2 * (n + 1) - i + 1) / 2; };  // of n + 1 − i points
        for (std::uint32_t i = 0; i <= n; ++i)
            for (std::uint32_t j = 0; j + i <= n; ++j)
                fine.positions.push_back(glm::vec3(a + (b - a) * (double(j) / n) + (c - a) * (double(i) / n)));
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j + i < n; ++j) {
                for (const std::uint32_t v : {row(i) + j, row(i) + j + 1, row(i + 1) + j}) fine.indices.push_back(v);
                if (j + i + 1 < n)
                    for (const std::uint32_t v : {row(i) + j + 1, row(i + 1) + j + 1, row(i + 1) + j}) fine.indices.push_back(v);
            }
    }
    return fine;
}

/// World positions of the scene's triangles, three each.
inline std::vector<glm::dvec3> world_triangles(const Scene& scene) {
    std::vector<glm::dvec3> corners;
    scene.nodes().each([&](NodeId id, const Node& node) {
        const glm::mat4 matrix = scene.world_matrix(id);
        for (const Part& part : node.parts) {
            const Mesh& mesh = scene.geometries().find(part.geometry)->mesh;
            for (const std::uint32_t index : mesh.indices)
                corners.push_back(glm::dvec3(glm::vec3(matrix * glm::vec4(mesh.positions[index], 1))));
        }
    });
    return corners;
}

}  // namespace heliodon::tests
