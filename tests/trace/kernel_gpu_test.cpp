// The kernel compiled as GLSL against the kernel compiled as C++: the same states and hits, one step at a time.
#include <vector>

#include "device_tables.h"
#include "test_trace_shaders.h"
#include "trace/embree_scene.h"

namespace heliodon::tests {
namespace {

/// Directions, light and places agree; so do the path's decisions.
bool agree(const PathState& a, const PathState& b) {
    const bool scattered = a.stage == kernel_stage_scatter || a.after_shadow == kernel_stage_scatter;
    return a.stage == b.stage && a.depth == b.depth && a.pass_count == b.pass_count &&
           close(a.radiance, b.radiance, 1) && close(a.direct, b.direct, 1) &&
           (a.stage != kernel_stage_shadow ||
            (close(a.shadow_light, b.shadow_light, 1e-2f) && close(a.shadow_direction, b.shadow_direction, 1) &&
             close(a.shadow_origin, b.shadow_origin, 1) && a.after_shadow == b.after_shadow)) &&
           (!scattered || (close(a.origin, b.origin, 1) && close(a.direction, b.direction, 1) &&
                           close(a.throughput, b.throughput, 1e-2f)));
}

TEST(Kernel, OnTheDeviceTakesTheSameStepsAsOnTheHost) {
    gpu::InstanceSettings instance_settings;
    instance_settings.validation = true;
    const auto instance = value_of(gpu::Instance::create(instance_settings));
    gpu::DeviceSettings device_settings;
    device_settings.pipeline_cache_directory = "";
    const auto device = value_of(gpu::Device::create(instance, device_settings));

    const Scene scene = small_room();
    convert::FlatScene flat;
    EmbreeScene embree;
    ASSERT_TRUE(embree.update(flat, flat.update(scene)));
    const TextureTable textures;
    const GeometryTable geometries = build_geometry_table(flat);
    const EmitterTable emitters = build_emitters(flat, textures, true);
    CpuKernel kernel{flat, geometries, textures, emitters, {}};
    kernel.frame = small_room_frame(emitters);

    const std::uint32_t count = 64 * 64;
    DeviceTables tables(*device, kernel);
    const auto pipelines = std::make_unique<gpu::Pipelines>(*device, gpu::ShaderLibrary(embedded_shaders()));
    const gpu::ComputePipeline& pipeline = *value_of(pipelines->compute("shaders/kernel.comp"));
    const gpu::Buffer states = tables.make("states", std::span<const PathState>(std::vector<PathState>(count)));
    const gpu::Buffer hits = tables.make("hits", std::span<const KernelHit>(std::vector<KernelHit>(count)));
    const gpu::Buffer rays = tables.make("rays", std::span<const KernelRay>(std::vector<KernelRay>(count)));

    std::vector<gpu::Binding> bindings;
    for (const gpu::Buffer& buffer : tables.buffers()) bindings.emplace_back(buffer);
    for (const gpu::Buffer* buffer : {&hits, &states, &rays}) bindings.emplace_back(*buffer);
    const auto step = [&](bool begin) {
        const Push push{count, begin ? 1u : 0u, static_cast<std::uint32_t>(flat.instances().size()),
                        static_cast<std::uint32_t>(flat.lights().size())};
        EXPECT_TRUE(device->run("kernel", [&](gpu::Commands& commands) {
            commands.dispatch_threads(pipeline, push, gpu::Bindings(bindings), {count, 1, 1});
        }));
        return value_of(device->read_back_as<PathState>(states));
    };

    std::vector<PathState> host(count);
    for (std::uint32_t i = 0; i < count; ++i) host[i] = kernel.path_begin(i % 64, i / 64, 0);
    std::vector<PathState> on_device = step(true);
    int compared = 0, different = 0;
    for (int round = 0;; ++round) {
        std::uint32_t alive = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            ++compared;
            if (!agree(host[i], on_device[i])) ++different;
            alive += host[i].stage != kernel_stage_done ? 1 : 0;
        }
        if (alive == 0 || round == 12) break;
        // Both take the host's answer to the host's ray, so that one step's rounding does not add to the next.
        std::vector<KernelHit> answers(count);
        EXPECT_TRUE(device->upload(states, std::span<const PathState>(host)));
        for (std::uint32_t i = 0; i < count; ++i) {
            const KernelRay ray = kernel.path_next_ray(host[i]);
            if (ray.kind == kernel_ray_none) continue;
            answers[i] = embree.trace(ray);
            kernel.path_take_hit(host[i], answers[i]);
        }
        EXPECT_TRUE(device->upload(hits, std::span<const KernelHit>(answers)));
        on_device = step(false);
    }
    RecordProperty("steps_compared", compared);
    RecordProperty("steps_different", different);
    // Where a random number falls on the rounding of a probability, the two may decide differently.
    EXPECT_LE(different, compared / 2000) << "of " << compared;
    for (const auto& message : device->validation_messages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace heliodon::tests
