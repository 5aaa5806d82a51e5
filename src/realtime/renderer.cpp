#include "realtime/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

#include "core/units.h"
#include "realtime/camera_frame.h"
#include "realtime/frame_renderer.h"

namespace heliodon {
namespace {

using realtime::FrameRenderer;
using realtime::FrameSample;
using realtime::PassTimes;

// Shadow maps with a moved texel grid that a still picture averages over.
constexpr int shadow_grids = 16;
constexpr int warm_up_frames = 3;
constexpr int most_overflow_repeats = 4;

struct AovKind {
    const char* name;
    std::uint32_t code;
    int channels;
    bool over_hits;            // the mean over what was hit alone; else nothing counts as 0
    bool cone_traced = false;  // made by cones
    bool needs_cones = false;  // and by nothing else
    bool occludes_sky = false; // without cones: by what the picture shows
};
constexpr std::array<AovKind, 10> aov_kinds{{{"albedo", shading::frame_aov_albedo, 3, false},
                                            {"normal", shading::frame_aov_normal, 3, false},
                                            {"depth", shading::frame_aov_depth, 1, true},
                                            {"position", shading::frame_aov_position, 3, true},
                                            {"direct", shading::frame_aov_none, 3, false, false, false, true},
                                            {"indirect", shading::frame_aov_indirect, 3, false, true},
                                            {"illuminance", shading::frame_aov_illuminance, 3, true, true, false, true},
                                            {"ao", shading::frame_aov_occlusion, 1, true, true, false, true},
                                            {"voxels", shading::frame_aov_voxels, 3, false, true, true},
                                            {"opacity", shading::frame_aov_opacity, 1, false, true, true}}};

Result<AovKind> find_aov(const std::string& name, bool cone_traced) {
    const auto found = std::find_if(aov_kinds.begin(), aov_kinds.end(), [&](const AovKind& kind) { return name == kind.name; });
    if (found == aov_kinds.end())
        return fail("aovs", fmt::format("expected albedo, normal, depth, position, direct, indirect, illuminance, ao, "
                                        "voxels or opacity, found \"{}\"", name));
    if (found->needs_cones && !cone_traced) return fail("aovs", fmt::format("{} is made by voxel cones: expected gi vct with it", name));
    return *found;
}

/// Whether light bounces in the voxel volume.
Result<bool> traces_cones(const RealtimeOptions& options) {
    if (options.gi == "none") return false;
    if (options.gi == "vct") return true;
    return fail("gi", fmt::format("expected none or vct, found \"{}\"", options.gi));
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

Image image_of(const std::vector<float>& sum, int width, int height, const AovKind& kind, int samples) {
    Image image(width, height, kind.channels);
    for (std::size_t pixel = 0; pixel < sum.size() / 4; ++pixel) {
        const float hits = sum[pixel * 4 + 3];
        const float count = kind.over_hits ? std::max(hits, 1.0f) : static_cast<float>(samples);
        for (int c = 0; c < kind.channels; ++c) image.pixels[pixel * kind.channels + c] = sum[pixel * 4 + c] / count;
    }
    return image;
}

/// Milliseconds of many frames, by pass.
struct TimeSeries {
    std::vector<std::string> order;
    std::map<std::string, std::vector<double>> by_pass;
    std::vector<double> totals, cpu;

    void add(const PassTimes& times, double cpu_ms) {
        add_passes(times);
        add_whole(times, cpu_ms);
    }
    void add_passes(const PassTimes& times) {
        std::map<std::string, double> frame;  // a pass may run several times in it
        for (const PassTime& pass : times.passes) {
            if (!by_pass.contains(pass.name) && !frame.contains(pass.name)) order.push_back(pass.name);
            frame[pass.name] += pass.gpu_ms;
        }
        for (const auto& [name, gpu_ms] : frame) by_pass[name].push_back(gpu_ms);
    }
    void add_whole(const PassTimes& times, double cpu_ms) {
        totals.push_back(times.total_ms);
        cpu.push_back(cpu_ms);
    }
    void write(RealtimeStatistics& statistics) const {
        for (const std::string& name : order) statistics.passes.push_back({name, median(by_pass.at(name))});
        statistics.gpu_ms_total = median(totals);
        statistics.gpu_ms_mean = std::accumulate(totals.begin(), totals.end(), 0.0) / std::max<double>(1, totals.size());
        statistics.cpu_ms = median(cpu);
    }
};

FrameSample still_sample(const RealtimeOptions& options, int index, int count) {
    FrameSample sample;
    sample.index = static_cast<std::uint32_t>(index);
    sample.count = static_cast<std::uint32_t>(count);
    sample.jitter = realtime::sample_position(sample.index, sample.count, options.seed) - 0.5f;
    sample.jitter_shadows = count > 1;
    sample.shadow_index = static_cast<std::uint32_t>(index * std::min(count, shadow_grids) / count);
    sample.environment = options.environment;
    sample.volumes_behind = options.volumes_behind;
    sample.seed = options.seed;
    sample.replace = index == 0;
    sample.texture_gradient_scale = 1.0f / std::sqrt(static_cast<float>(count));
    return sample;
}

}  // namespace

struct RealtimeRenderer::State {
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<FrameRenderer> frames;  // after the device, so destroyed before it

    /// The mean of `count` samples of one AOV (or of the radiance).
    Result<Image> accumulate(const Camera& camera, const RealtimeOptions& options, const AovKind& kind,
                             TimeSeries* series, const Progress& progress) {
        const int count = std::max(1, options.samples);
        for (int repeat = 0; repeat < most_overflow_repeats; ++repeat) {
            int done = 0;
            for (; done < count; ++done) {
                FrameSample sample = still_sample(options, done, count);
                if (count == 1) sample.jitter = glm::vec2(0);
                // Each sample draws anew what blended surfaces let through and the point of a light with an extent, or takes
                // its turn with very many shadow maps.
                if (frames->scene().has_blended() || frames->has_area_lights() || frames->refreshes_in_turns())
                    sample.shadow_index = sample.index;
                sample.aov = kind.code;
                sample.cone_traced = options.gi == "vct" && kind.cone_traced;
                sample.occludes_sky = options.gi == "none" && kind.occludes_sky;
                PassTimes times;
                const auto begin = std::chrono::steady_clock::now();
                if (auto rendered = frames->render(camera, sample, series ? &times : nullptr); !rendered)
                    return tl::unexpected(rendered.error());
                const std::chrono::duration<double, std::milli> cpu = std::chrono::steady_clock::now() - begin;
                if (series) series->add(times, cpu.count());
                if (progress && !progress(static_cast<double>(done + 1) / count)) {
                    ++done;
                    break;
                }
            }
            auto grown = frames->grow_fragments();
            if (!grown) return tl::unexpected(grown.error());
            if (*grown) continue;
            auto sum = frames->read_sum();
            if (!sum) return tl::unexpected(sum.error());
            return image_of(*sum, options.width, options.height, kind, std::max(1, done));
        }
        return fail("", "more blended surfaces overlap in this picture than there is room for");
    }

    Result<void> time_frames(const Camera& camera, const RealtimeOptions& options, RealtimeStatistics& statistics) {
        TimeSeries series;
        // Timestamps between passes keep apart what a GPU could overlap: its frame's own time is that of every other frame,
        // without. A CPU overlaps none.
        const bool overlaps = !device->info().is_cpu;
        const int count = warm_up_frames + (overlaps ? 2 : 1) * options.frames_timed;
        std::uint64_t shadow_maps = 0;
        for (int i = 0; i < count; ++i) {
            if (i == warm_up_frames) shadow_maps = frames->shadow_maps_drawn();
            FrameSample sample = still_sample(options, i, count);
            sample.timed_whole = overlaps && i >= warm_up_frames && (i - warm_up_frames) % 2 == 1;
            sample.jitter_shadows = false;
            sample.shadow_index = 0;
            sample.force_shadows = !options.keep_shadows;
            sample.count = 0;  // as in motion: nothing is left to later frames
            sample.cone_traced = options.gi == "vct";
            sample.occludes_sky = options.gi == "none";
            const auto begin = std::chrono::steady_clock::now();
            if (auto done = frames->render(camera, sample); !done) return done;
            const std::chrono::duration<double, std::milli> cpu = std::chrono::steady_clock::now() - begin;
            if (auto done = device->wait_idle(); !done) return done;
            if (i < warm_up_frames) continue;
            const PassTimes times = frames->latest_times();
            if (!sample.timed_whole) series.add_passes(times);
            if (sample.timed_whole || !overlaps) series.add_whole(times, cpu.count());
        }
        series.write(statistics);
        statistics.shadow_maps_drawn = frames->shadow_maps_drawn() - shadow_maps;
        return time_sky(options.frames_timed, statistics);
    }

    /// What filtering the sky takes, which frames do only where it changed.
    Result<void> time_sky(int count, RealtimeStatistics& statistics) {
        TimeSeries series;
        for (int i = 0; i < count; ++i) {
            const auto times = frames->time_sky();
            if (!times) return tl::unexpected(times.error());
            if (times->passes.empty()) return {};
            series.add(*times, 0);
        }
        RealtimeStatistics sky;
        series.write(sky);
        statistics.sky_passes = std::move(sky.passes);
        statistics.sky_gpu_ms = sky.gpu_ms_total;
        return {};
    }

    Result<SensorReading> luminance_along(const SensorPoint& point, bool environment, bool cone_traced);
};

RealtimeRenderer::RealtimeRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
RealtimeRenderer::~RealtimeRenderer() = default;
RealtimeRenderer::RealtimeRenderer(RealtimeRenderer&&) noexcept = default;
RealtimeRenderer& RealtimeRenderer::operator=(RealtimeRenderer&&) noexcept = default;

Result<std::vector<DeviceInfo>> list_devices() {
    auto found = gpu::list_devices();
    if (!found) return tl::unexpected(found.error());
    std::vector<DeviceInfo> devices;
    for (const gpu::DeviceInfo& device : *found) {
        DeviceInfo info;
        info.number = device.number;
        info.name = device.name;
        info.driver = device.driver;
        info.api_version = device.api_version;
        info.is_cpu = device.is_cpu;
        info.usable = device.usable;
        info.missing = device.missing;
        info.ray_query = device.ray_query;
        info.ray_tracing_pipeline = device.ray_tracing_pipeline;
        info.mesh_shader = device.mesh_shader;
        info.conservative_rasterization = device.conservative_rasterization;
        info.memory_bytes = device.memory_bytes;
        devices.push_back(std::move(info));
    }
    return devices;
}

Result<RealtimeRenderer> RealtimeRenderer::create(const RealtimeSettings& settings) try {
    auto instance = gpu::Instance::create({.validation = settings.validation});
    if (!instance) return tl::unexpected(instance.error());
    auto device = gpu::Device::create(*instance, {.device = settings.device});
    if (!device) return tl::unexpected(device.error());
    auto state = std::make_unique<State>();
    state->device = std::move(*device);
    auto frames = FrameRenderer::create(*state->device, settings.shader_directory);
    if (!frames) return tl::unexpected(frames.error());
    state->frames = std::move(*frames);
    return RealtimeRenderer(std::move(state));
} catch (const std::exception& exception) {
    return fail("", fmt::format("the real-time renderer could not start: {}", exception.what()));
}

Result<RealtimeUpdate> RealtimeRenderer::update(const Scene& scene) try {
    return state_->frames->update(scene);
} catch (const std::exception& exception) {
    return fail("", fmt::format("updating the GPU scene: {}", exception.what()));
}

Result<Picture> RealtimeRenderer::render(const Scene& scene, const Camera& camera, const RealtimeOptions& options,
                                         RealtimeStatistics* statistics, const Progress& progress) try {
    const auto cone_traced = traces_cones(options);
    if (!cone_traced) return tl::unexpected(cone_traced.error());
    std::vector<AovKind> aovs;
    for (const std::string& name : options.aovs) {
        auto kind = find_aov(name, *cone_traced);
        if (!kind) return tl::unexpected(kind.error());
        aovs.push_back(*kind);
    }
    if (auto updated = update(scene); !updated) return tl::unexpected(updated.error());
    FrameRenderer& frames = *state_->frames;
    if (auto done = frames.resize(options.width, options.height, false); !done) return tl::unexpected(done.error());

    TimeSeries series;
    const std::uint64_t shadow_maps = frames.shadow_maps_drawn();
    const bool time_still = statistics && options.frames_timed <= 0;
    const AovKind radiance{"", shading::frame_aov_none, 3, false, true, false, true};
    Picture picture;
    if (options.samples > 0) {
        auto image = state_->accumulate(camera, options, radiance, time_still ? &series : nullptr, progress);
        if (!image) return tl::unexpected(image.error());
        picture.image = std::move(*image);
    }
    picture.ev100 = camera.ev100();
    picture.has_ev100 = true;
    if (statistics) {
        *statistics = {};
        statistics->shadow_maps_drawn = frames.shadow_maps_drawn() - shadow_maps;
        if (time_still) series.write(*statistics);
        else if (auto done = state_->time_frames(camera, options, *statistics); !done) return tl::unexpected(done.error());
        statistics->device = state_->device->info().name;
        statistics->gpu_memory_bytes = state_->device->memory_bytes();
        statistics->vertex_bytes = frames.scene().vertex_bytes();
        statistics->draw_calls = static_cast<int>(frames.draw_calls());
        if (const ShadowVolumeStatistics* volumes = frames.shadow_volumes()) statistics->shadow_volumes = *volumes;
        statistics->light_batches = static_cast<int>(frames.light_batches());
    }
    for (const AovKind& kind : aovs) {
        auto layer = state_->accumulate(camera, options, kind, nullptr, {});
        if (!layer) return tl::unexpected(layer.error());
        picture.layers.push_back({kind.name, std::move(*layer)});
    }
    return picture;
} catch (const std::exception& exception) {
    return fail("", fmt::format("rendering in real time: {}", exception.what()));
}

std::vector<std::string> RealtimeRenderer::validation_messages() const { return state_->device->validation_messages(); }

Result<SensorReading> RealtimeRenderer::State::luminance_along(const SensorPoint& point, bool environment, bool cone_traced) {
    Camera camera;
    camera.position = point.origin();
    camera.target = camera.position + point.direction;
    camera.vertical_fov_rad = 1e-3f;  // the middle of one pixel is the ray; its size only chooses texture levels
    if (auto done = frames->resize(1, 1, false); !done) return tl::unexpected(done.error());
    // Several shadow grids, one ray: the mean of still samples without their movement in the pixel.
    RealtimeOptions options;
    options.environment = environment;
    glm::dvec3 sum(0);
    double squares = 0;
    for (int i = 0; i < shadow_grids; ++i) {
        FrameSample sample = still_sample(options, i, shadow_grids);
        sample.jitter = glm::vec2(0);
        sample.texture_gradient_scale = 1.0f;
        sample.cone_traced = cone_traced;
        if (auto done = frames->render(camera, sample); !done) return tl::unexpected(done.error());
        auto so_far = frames->read_sum();
        if (!so_far) return tl::unexpected(so_far.error());
        const glm::dvec3 all((*so_far)[0], (*so_far)[1], (*so_far)[2]);
        squares += std::pow(units::luminance(all - sum), 2);
        sum = all;
    }
    constexpr double student_95 = 2.1314495;  // two-sided 95 % quantile of Student's t, 15 degrees of freedom
    const double value = units::luminance(sum) / shadow_grids;
    // Single precision sums leave the variance of equal samples a little above or below 0.
    const double variance = std::max(0.0, squares / shadow_grids - value * value);
    const bool noisy = variance > 1e-12 * value * value;
    SensorReading reading;
    reading.rgb = sum / static_cast<double>(shadow_grids);
    reading.value = value;
    reading.half_width_95 = noisy ? student_95 * std::sqrt(variance / (shadow_grids - 1)) : 0;
    return reading;
}

Result<std::vector<SensorReading>> RealtimeRenderer::measure(const Scene& scene, const RealtimeOptions& options) try {
    const auto cone_traced = traces_cones(options);
    if (!cone_traced) return tl::unexpected(cone_traced.error());
    if (auto updated = update(scene); !updated) return tl::unexpected(updated.error());
    FrameRenderer& frames = *state_->frames;
    // A sensor on a surface looks out from it.
    const std::vector<SensorPoint> points = sensor_points(scene, 1e-4f * frames.scene().bounds().diagonal());
    std::vector<FrameRenderer::Receiver> receivers;
    for (const SensorPoint& point : points) receivers.push_back({point.origin(), point.direction});
    auto illuminances = frames.illuminances(receivers, options.environment, *cone_traced);
    if (!illuminances) return tl::unexpected(illuminances.error());
    std::vector<SensorReading> readings;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SensorPoint& point = points[i];
        SensorReading reading;
        if (point.sensor->type == SensorType::luminance) {
            auto luminance = state_->luminance_along(point, options.environment, *cone_traced);
            if (!luminance) return tl::unexpected(luminance.error());
            reading = *luminance;
        } else {
            reading.rgb = (*illuminances)[i].lux;
            reading.value = units::luminance(reading.rgb);
            reading.half_width_95 = (*illuminances)[i].half_width_95;
        }
        reading.name = point.name;
        reading.type = point.sensor->type;
        reading.position = point.position;
        reading.in_grid = point.sensor->grid.has_value();
        readings.push_back(std::move(reading));
    }
    return readings;
} catch (const std::exception& exception) {
    return fail("", fmt::format("measuring in real time: {}", exception.what()));
}

}  // namespace heliodon
