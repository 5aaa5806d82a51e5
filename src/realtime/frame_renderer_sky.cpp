// The parts of FrameRenderer that run outside its frame graphs: the sky's prefiltered maps and sensors.
#include "gpu/bindless_textures.h"
#include "passes/environment/environment.h"
#include "passes/sensors/sensors.h"
#include "passes/sensors/sensors_shared.h"
#include "realtime/frame_renderer.h"
#include "shading/sky.h"

namespace heliodon::realtime {
namespace {

constexpr std::uint32_t points_of_area_light = 256;  // of a light with an extent, for a sensor's mean

}  // namespace

Result<void> FrameRenderer::prefilter_sky() {
    prefiltered_sky_ = gpu_scene_.sky_revision();
    const shading::SkyData& sky = gpu_scene_.flat().sky();
    gpu::SamplerDescription sampler;
    sampler.address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    auto linear = device_.sampler(sampler);
    if (!linear) return tl::unexpected(linear.error());
    const auto place = [&](std::optional<std::uint32_t>& slot, const gpu::Image& image) -> Result<void> {
        if (slot) return device_.textures().replace(*slot, image, *linear);
        auto added = device_.textures().add(image, *linear);
        if (!added) return tl::unexpected(added.error());
        slot = *added;
        return {};
    };
    GpuScene::SkyMaps maps;
    std::optional<std::uint32_t> source = gpu_scene_.sky_slot();
    std::uint32_t width = source ? static_cast<std::uint32_t>(gpu_scene_.flat().textures()[sky.texture_index]->width) : 0;
    if (shading::sky_is_formula(sky)) {
        auto drawn = passes::draw_sky(device_, pipelines_, sky);
        if (!drawn) return tl::unexpected(drawn.error());
        sky_picture_ = std::move(*drawn);
        if (auto done = place(sky_picture_slot_, sky_picture_); !done) return done;
        source = maps.picture = *sky_picture_slot_;
        width = sky_picture_.extent().width;
    }
    if (source) {
        auto made = passes::prefilter_environment(device_, pipelines_, *source, width);
        if (!made) return tl::unexpected(made.error());
        sky_specular_ = std::move(made->specular);
        sky_irradiance_ = std::move(made->irradiance);
        if (auto done = place(sky_specular_slot_, sky_specular_); !done) return done;
        if (auto done = place(sky_irradiance_slot_, sky_irradiance_); !done) return done;
        maps.specular = *sky_specular_slot_;
        maps.irradiance = *sky_irradiance_slot_;
        maps.specular_levels = sky_specular_.mips();
    }
    return gpu_scene_.set_sky_maps(maps);
}

Result<void> FrameRenderer::record_sensor_batch(const gpu::Buffer& sensors, std::uint32_t count, const FrameSample& sample,
                                                std::size_t batch, const passes::SensorLights& lights) {
    Result<void> status;
    auto done = device_.run("sensors", [&](gpu::Commands& commands) {
        status = record_shadows(commands, sample, batch, nullptr);
        if (!status) return;
        const gpu::Access sampled{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        commands.transition(shadow_depth_, sampled);
        commands.transition(shadow_slope_, sampled);
        status = passes::record_sensors(commands, pipelines_, inputs_, lighting_, shadow_depth_, shadow_slope_, sensors, count, lights);
    });
    return status ? done : status;
}

Result<std::vector<glm::vec3>> FrameRenderer::illuminances(const std::vector<Receiver>& receivers, bool environment,
                                                           bool cone_traced) {
    std::vector<glm::vec3> result(receivers.size(), glm::vec3(0));
    if (receivers.empty()) return result;
    if (wanted_.width == 0)
        if (auto done = resize(1, 1, false); !done) return tl::unexpected(done.error());
    FrameSample still;
    still.environment = environment;
    still.cone_traced = cone_traced;
    still.measures = true;
    const Camera camera;  // its exposure and place only scale and centre the volume
    if (auto done = cone_traced ? update_surfaces(camera, still) : prepare(camera, still); !done) return tl::unexpected(done.error());
    if (cone_traced && relight_)
        if (auto done = converge_volume(still); !done) return tl::unexpected(done.error());
    std::vector<shading::SensorData> sensors;
    for (const Receiver& receiver : receivers) sensors.push_back({receiver.position, 0, receiver.normal, 0, glm::vec3(0), 0});
    auto buffer = gpu::Buffer::create(device_, {"sensors", sensors.size() * sizeof(shading::SensorData)});
    if (!buffer) return tl::unexpected(buffer.error());
    if (auto done = device_.upload<shading::SensorData>(*buffer, sensors); !done) return tl::unexpected(done.error());

    const std::uint32_t points = has_area_lights_ ? points_of_area_light : 1;
    for (std::uint32_t point = 0; point < points; ++point) {
        FrameSample sample;
        sample.count = points;
        sample.index = sample.shadow_index = point;
        sample.jitter_shadows = has_area_lights_;
        for (std::size_t batch = 0; batch < plan_.batches.size(); ++batch) {
            const passes::SensorLights lights{plan_.batches[batch].first_light, plan_.batches[batch].light_count,
                                              environment && !cone_traced && batch == 0};
            if (auto done = record_sensor_batch(*buffer, static_cast<std::uint32_t>(sensors.size()), sample, batch, lights); !done)
                return tl::unexpected(done.error());
            auto read = device_.read_back_as<shading::SensorData>(*buffer);
            if (!read) return tl::unexpected(read.error());
            for (std::size_t i = 0; i < result.size(); ++i)
                result[i] += (*read)[i].illuminance / static_cast<float>(points);
        }
    }
    if (!cone_traced) return result;
    if (auto done = device_.upload<shading::SensorData>(*buffer, sensors); !done) return tl::unexpected(done.error());
    Result<void> status;
    auto traced = device_.run("cone sensors", [&](gpu::Commands& commands) {
        status = passes::record_cone_sensors(commands, pipelines_, inputs_, voxels_.inputs(), *buffer,
                                             static_cast<std::uint32_t>(sensors.size()));
    });
    if (!status) return tl::unexpected(status.error());
    if (!traced) return tl::unexpected(traced.error());
    auto indirect = device_.read_back_as<shading::SensorData>(*buffer);
    if (!indirect) return tl::unexpected(indirect.error());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += (*indirect)[i].illuminance;
    return result;
}

}  // namespace heliodon::realtime
