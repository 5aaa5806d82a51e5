#pragma once

// The scene's tables on a Vulkan device, for the kernels that tests compile as GLSL.
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "scene_building.h"
#include "shading/tables.h"
#include "trace/cpu_kernel.h"

namespace heliodon::tests {

using namespace heliodon::trace;

template <class T>
T value_of(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(*result);
}

struct Push {
    std::uint32_t path_count, begin, instance_count, light_count;
};

/// The kernel's tables on the device, in the order of the shader's bindings 0 to 12.
class DeviceTables {
public:
    DeviceTables(gpu::Device& device, const CpuKernel& kernel) : device_(device) {
        std::vector<std::uint32_t> places, indices, emitter_indices = kernel.emitter_table.first_emitter;
        std::vector<glm::vec3> positions, normals;
        std::vector<KernelGeometry> geometries;
        for (std::size_t i = 0; i < kernel.geometry_table.size(); ++i) {
            const Mesh& mesh = kernel.flat.geometries()[i]->mesh;
            places.insert(places.end(),
                          {static_cast<std::uint32_t>(positions.size()), static_cast<std::uint32_t>(indices.size())});
            positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
            normals.insert(normals.end(), mesh.normals.begin(), mesh.normals.end());
            indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
            geometries.push_back(kernel.geometry_table[i].kernel);
        }
        const auto append = [&](const auto& more) {
            emitter_indices.insert(emitter_indices.end(), more.begin(), more.end());
        };
        append(kernel.emitter_table.light_emitter);
        append(kernel.emitter_table.visible_lights);
        append(std::span(reinterpret_cast<const std::uint32_t*>(kernel.emitter_table.light_nodes.data()),
                         16 * kernel.emitter_table.light_nodes.size()));
        add("frames", std::span(&kernel.frame, 1));
        add("instances", kernel.flat.instances());
        add("materials", kernel.flat.materials());
        add("lights", kernel.flat.lights());
        add("skies", std::span(&kernel.flat.sky(), 1));
        add("geometries", std::span(geometries));
        add("places", std::span(places));
        add("indices", std::span(indices));
        add("positions", std::span(positions));
        add("normals", std::span(normals));
        add("emitters", std::span(kernel.emitter_table.emitters));
        add("emitter indices", std::span(emitter_indices));
        add("tables", shading::shading_tables());
    }
    template <class T>
    gpu::Buffer make(const std::string& name, std::span<const T> values) {
        gpu::Buffer buffer =
            value_of(gpu::Buffer::create(device_, {name, std::max<std::size_t>(values.size_bytes(), 16)}));
        if (!values.empty()) {
            EXPECT_TRUE(device_.upload(buffer, values));
        }
        return buffer;
    }
    [[nodiscard]] const std::vector<gpu::Buffer>& buffers() const { return buffers_; }

private:
    template <class T, std::size_t extent>
    void add(const std::string& name, std::span<T, extent> values) {
        buffers_.push_back(make(name, std::span<const std::remove_const_t<T>>(values)));
    }
    gpu::Device& device_;
    std::vector<gpu::Buffer> buffers_;
};

/// |a − b| relative to the greater, or absolute where both are small.
inline bool close(const glm::vec3& a, const glm::vec3& b, float scale) {
    constexpr float tolerance = 1e-4f;
    const glm::vec3 allowed = tolerance * (glm::max(glm::abs(a), glm::abs(b)) + glm::vec3(scale));
    return glm::all(glm::lessThanEqual(glm::abs(a - b), allowed));
}

/// Pictures of 64 × 64 pixels, into small_room.
inline KernelFrame small_room_frame(const EmitterTable& emitters) {
    return {.camera_position = {0, 1, 3.4f},
            .width = 64,
            .camera_forward = {0, 0, -1},
            .height = 64,
            .camera_right = {.36f, 0, 0},
            .max_depth = 0,
            .camera_up = {0, .36f, 0},
            .seed = 7,
            .emitter_count = static_cast<std::uint32_t>(emitters.emitters.size()),
            .visible_light_count = static_cast<std::uint32_t>(emitters.visible_lights.size()),
            .environment = 1,
            .sky_emitter = emitters.sky_emitter,
            .sky_columns = 0,
            .sky_rows = 0,
            .scattered_emission = 1,
            .sample_streams = 1,
            .distant_emitters = emitters.distant_emitters,
            .light_node_count = static_cast<std::uint32_t>(emitters.light_nodes.size()),
            .tile_bits = 4,
            .branch_bits = 1};
}

}  // namespace heliodon::tests
