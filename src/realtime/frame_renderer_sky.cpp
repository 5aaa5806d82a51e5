// The parts of FrameRenderer that run outside its frame graphs: the sky's prefiltered maps and sensors.
#include <array>
#include <cmath>

#include "core/units.h"
#include "gpu/bindless_textures.h"
#include "passes/environment/environment.h"
#include "passes/sensors/sensors.h"
#include "passes/sensors/sensors_shared.h"
#include "realtime/frame_renderer.h"
#include "shading/sky.h"

namespace heliodon::realtime {
namespace {

// Samples of a sensor: points of lights with an extent, or what panes and veils let through; else moved shadow grids.
constexpr std::uint32_t samples_of_chance = 256, samples_of_grids = 16;
constexpr std::uint32_t spread_batches = 16;
constexpr double student_95 = 2.1314495;  // two-sided 95 % quantile of Student's t, 15 degrees of freedom

/// A sensor's readings, sample by sample.
struct Spread {
    std::array<double, spread_batches> batches{};
    /// Adds a share of the mean that sample `index` of `count` brings.
    void add(std::uint32_t index, std::uint32_t count, double share) { batches[index * spread_batches / count] += share; }
    /// 95 % half-width of the mean, from that of the batches.
    [[nodiscard]] double half_width_95() const {
        double mean = 0, squares = 0;
        for (const double batch : batches) mean += batch / spread_batches;
        for (const double batch : batches) squares += (batch - mean) * (batch - mean);
        // Each batch holds a sixteenth of the mean.
        return student_95 * spread_batches * std::sqrt(squares / (spread_batches - 1.0) / spread_batches);
    }
};

gpu::SamplerDescription sky_sampler() {
    gpu::SamplerDescription sampler;
    sampler.address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    return sampler;
}

}  // namespace

Result<void> FrameRenderer::prefilter_sky() {
    prefiltered_sky_ = gpu_scene_.sky_revision();
    const shading::SkyData& sky = gpu_scene_.flat().sky();
    const bool formula = shading::sky_is_formula(sky);
    if (!formula && !gpu_scene_.sky_image()) {
        sky_maps_.specular = {};
        return gpu_scene_.set_sky_maps({});
    }
    const int width = formula ? 0 : gpu_scene_.flat().textures()[sky.texture_index]->width;
    const auto made_anew = passes::reserve_environment(device_, sky_maps_, static_cast<std::uint32_t>(width));
    if (!made_anew) return tl::unexpected(made_anew.error());
    auto linear = device_.sampler(sky_sampler());
    if (!linear) return tl::unexpected(linear.error());
    const auto place = [&](std::optional<std::uint32_t>& slot, const gpu::Image& map) -> Result<void> {
        if (slot && !*made_anew) return {};
        if (slot) return device_.textures().replace(*slot, map, *linear);
        auto added = device_.textures().add(map, *linear);
        if (!added) return tl::unexpected(added.error());
        slot = *added;
        return {};
    };
    GpuScene::SkyMaps maps;
    if (formula) {
        if (auto done = place(sky_picture_slot_, sky_maps_.picture); !done) return done;
        maps.picture = *sky_picture_slot_;
        if (auto done = device_.upload(sky_maps_.record, std::span(&sky, 1)); !done) return done;
    }
    if (auto done = place(sky_specular_slot_, sky_maps_.specular); !done) return done;
    if (auto done = place(sky_irradiance_slot_, sky_maps_.irradiance); !done) return done;
    if (auto done = place(sky_reflected_slot_, sky_maps_.reflected); !done) return done;
    maps.specular = *sky_specular_slot_;
    maps.irradiance = *sky_irradiance_slot_;
    maps.specular_levels = sky_maps_.specular.mips();
    return gpu_scene_.set_sky_maps(maps).and_then([&] { return filter_sky(true, nullptr); });
}

Result<void> FrameRenderer::filter_sky(bool sky, PassTimes* times) {
    auto commands = device_.begin_commands("environment");
    if (!commands) return tl::unexpected(commands.error());
    auto linear = device_.sampler(sky_sampler());
    if (!linear) return tl::unexpected(linear.error());
    const passes::EnvironmentWork work{shading::sky_is_formula(gpu_scene_.flat().sky()) ? nullptr : gpu_scene_.sky_image(), *linear, sky,
                                       ambient() != AmbientLight::none, ambient() == AmbientLight::constant};
    sky_timestamps_.begin_frame();
    if (auto done = passes::record_environment(*commands, pipelines_, sky_maps_, work, sky_timestamps_); !done) return done;
    auto submitted = device_.submit(std::move(*commands));
    if (!submitted) return tl::unexpected(submitted.error());
    reflected_sky_ = ambient();
    if (!times) return {};
    auto taken = sky_timestamps_.wait();
    if (!taken) return tl::unexpected(taken.error());
    for (const gpu::ScopeTime& scope : taken->scopes) times->passes.push_back({scope.name, scope.milliseconds});
    times->total_ms = taken->total_milliseconds;
    return {};
}

Result<PassTimes> FrameRenderer::time_sky() {
    PassTimes times;
    if (sky_maps_.specular.handle() == VK_NULL_HANDLE) return times;
    auto done = filter_sky(true, &times);
    return done ? Result<PassTimes>(std::move(times)) : tl::unexpected(done.error());
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

Result<std::vector<FrameRenderer::Illuminance>> FrameRenderer::illuminances(const std::vector<Receiver>& receivers, bool environment,
                                                                            bool cone_traced) {
    std::vector<Illuminance> result(receivers.size());
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

    const std::uint32_t points = has_area_lights_ || gpu_scene_.has_blended() ? samples_of_chance : samples_of_grids;
    std::vector<Spread> spreads(receivers.size());
    for (std::uint32_t point = 0; point < points; ++point) {
        FrameSample sample;
        sample.count = points;
        sample.index = sample.shadow_index = point;
        sample.jitter_shadows = true;
        for (std::size_t batch = 0; batch < plan_.batches.size(); ++batch) {
            const passes::SensorLights lights{plan_.batches[batch].first_light, plan_.batches[batch].light_count,
                                              environment && !cone_traced && batch == 0, !cone_traced && batch == 0};
            if (auto done = record_sensor_batch(*buffer, static_cast<std::uint32_t>(sensors.size()), sample, batch, lights); !done)
                return tl::unexpected(done.error());
            auto read = device_.read_back_as<shading::SensorData>(*buffer);
            if (!read) return tl::unexpected(read.error());
            for (std::size_t i = 0; i < result.size(); ++i) {
                const glm::vec3 share = (*read)[i].illuminance / static_cast<float>(points);
                result[i].lux += share;
                spreads[i].add(point, points, units::luminance(glm::dvec3(share)));
            }
        }
    }
    for (std::size_t i = 0; i < result.size(); ++i) result[i].half_width_95 = spreads[i].half_width_95();
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
    for (std::size_t i = 0; i < result.size(); ++i) result[i].lux += (*indirect)[i].illuminance;
    return result;
}

}  // namespace heliodon::realtime
