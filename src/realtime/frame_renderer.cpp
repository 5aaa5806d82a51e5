#include "realtime/frame_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "gpu/bindless_textures.h"
#include "heliodon_passes_shaders.h"
#include "passes/blend/blend.h"
#include "passes/cull/cull.h"
#include "passes/light_grid/light_grid_shared.h"
#include "passes/shadow_cones/shadow_cones.h"
#include "passes/visibility/visibility.h"
#include "realtime/area_light.h"
#include "realtime/camera_frame.h"
#include "shading/tables.h"

namespace heliodon::realtime {
namespace {

// A map whose size no one stated is as large as the picture can tell, up to this.
constexpr int largest_fitted_shadow_map = 2048;
constexpr std::size_t frames_in_flight = 2;
constexpr std::uint32_t fragments_per_pixel = 4;  // room for blended surfaces to begin with

}  // namespace


FrameRenderer::FrameRenderer(gpu::Device& device, const std::string& shader_directory)
    : device_(device),
      pipelines_(device, gpu::ShaderLibrary(passes::embedded_shaders(), shader_directory)),
      gpu_scene_(device),
      shadow_executor_(std::make_unique<graph::Executor>(device)),
      surface_executor_(std::make_unique<graph::Executor>(device)),
      frame_executor_(std::make_unique<graph::Executor>(device)),
      voxels_(device, pipelines_),
      volumes_(device, pipelines_) {}

FrameRenderer::~FrameRenderer() {
    // Nothing is left to report an error to; what failed has been reported by the call that submitted it.
    (void)device_.wait_idle();
    if (sky_specular_slot_) device_.textures().remove(*sky_specular_slot_);
    if (sky_irradiance_slot_) device_.textures().remove(*sky_irradiance_slot_);
    if (sky_picture_slot_) device_.textures().remove(*sky_picture_slot_);
    if (sky_reflected_slot_) device_.textures().remove(*sky_reflected_slot_);
}

Result<std::unique_ptr<FrameRenderer>> FrameRenderer::create(gpu::Device& device, const std::string& shader_directory) {
    std::unique_ptr<FrameRenderer> renderer(new FrameRenderer(device, shader_directory));
    if (auto opened = renderer->open(); !opened) return tl::unexpected(opened.error());
    return renderer;
}

Result<void> FrameRenderer::open() {
    const auto make = [&](gpu::Buffer& buffer, std::string name, VkDeviceSize size, VkBufferUsageFlags usage = 0) -> Result<void> {
        auto made = gpu::Buffer::create(device_, {std::move(name), size, usage});
        if (!made) return tl::unexpected(made.error());
        buffer = std::move(*made);
        return {};
    };
    if (auto done = make(frame_buffer_, "frame", sizeof(shading::FrameData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT); !done) return done;
    if (auto done = make(camera_view_, "camera view", sizeof(shading::ViewData)); !done) return done;
    const auto tables = shading::shading_tables();
    if (auto done = make(shading_tables_, "shading tables", tables.size_bytes()); !done) return done;
    if (auto done = device_.upload(shading_tables_, tables); !done) return done;
    auto timestamps = gpu::Timestamps::create(device_);
    if (!timestamps) return tl::unexpected(timestamps.error());
    timestamps_ = std::move(*timestamps);
    auto sky_timestamps = gpu::Timestamps::create(device_);
    if (!sky_timestamps) return tl::unexpected(sky_timestamps.error());
    sky_timestamps_ = std::move(*sky_timestamps);
    auto nearest = device_.sampler(gpu::SamplerDescription::nearest_clamp());
    if (!nearest) return tl::unexpected(nearest.error());
    lighting_ = {&frame_buffer_, &shadow_views_, &shading_tables_, *nearest, &visible_lights_.buffer(), &voxels_.inputs()};
    if (auto done = voxels_.open(); !done) return done;
    lighting_.light_grid = &light_grid_.buffer();
    shadow_inputs_.views = &shadow_cull_views_;
    return light_grid_.reserve(device_, sizeof(shading::LightGridHeader), 0);
}

Result<RealtimeUpdate> FrameRenderer::update(const Scene& scene) {
    auto update = gpu_scene_.update(scene);
    if (!update) return update;
    const bool cone_shadows = scene.render_settings().gi == "vct" && scene.render_settings().vct.shadows;
    if (cone_shadows != cone_shadows_) planned_lights_ = ~0ull;
    cone_shadows_ = cone_shadows;
    if (scene.render_settings().shadow_cascades.count != settings_.shadow_cascades.count) planned_lights_ = ~0ull;
    if (scene.render_settings().sun_shadows != settings_.sun_shadows) planned_lights_ = ~0ull;
    settings_ = scene.render_settings();
    const int stated = settings_.shadow_map_size;
    shadow_maps_fit_picture_ = stated == 0;
    const int size = std::clamp(stated == 0 ? largest_fitted_shadow_map : stated, 1, static_cast<int>(device_.limits().maxImageDimension2D));
    if (size != shadow_map_size_) planned_lights_ = ~0ull;
    shadow_map_size_ = size;
    if (planned_lights_ != gpu_scene_.light_revision() || planned_instances_ != instance_capacity(gpu_scene_.instance_count()))
        if (auto done = plan_lights(); !done) return tl::unexpected(done.error());
    if (prefiltered_sky_ != gpu_scene_.sky_revision())
        if (auto done = prefilter_sky(); !done) return tl::unexpected(done.error());
    if (auto done = place_ambient(); !done) return tl::unexpected(done.error());
    return update;
}

Result<void> FrameRenderer::resize(int width, int height, bool display) {
    const int limit = static_cast<int>(device_.limits().maxImageDimension2D);
    if (width < 1 || height < 1 || width > limit || height > limit)
        return fail("", fmt::format("a picture of {}x{}: each side must be 1 to {}", width, height, limit));
    wanted_.width = width;
    wanted_.height = height;
    wanted_.display = display;
    return {};
}

Result<void> FrameRenderer::prepare(const Camera& camera, const FrameSample& sample) {
    fit_shadow_maps(camera, sample);
    std::uint32_t layers = 1, views = 1;
    for (const ShadowBatch& batch : plan_.batches) {
        layers = std::max(layers, batch.layer_count);
        views = std::max(views, batch.view_count);
    }
    wanted_.metered = settings_.display.exposure.mode != ExposureMode::camera || settings_.display.tone.estimate_white;
    wanted_.blended = gpu_scene_.has_blended();
    wanted_.instance_capacity = std::max(instance_capacity(gpu_scene_.instance_count()), key_.instance_capacity);
    // Layers and fragments are kept once made: lights that blink cost no reallocation.
    wanted_.shadow_size = plan_.views.empty() ? 1 : shadow_map_size_;
    wanted_.shadow_layers = wanted_.shadow_size == key_.shadow_size ? std::max(layers, key_.shadow_layers) : layers;
    wanted_.shadow_views = std::max(views, key_.shadow_views);
    if (wanted_.instance_capacity != key_.instance_capacity) wanted_.shadow_views = views;  // their product is what fits
    if (wanted_.blended)
        wanted_.fragment_capacity = std::max(wanted_.fragment_capacity,
                                             static_cast<std::uint32_t>(wanted_.width) * wanted_.height * fragments_per_pixel);
    inputs_.tables.clear();
    gpu_scene_.append_bindings(inputs_.tables);
    inputs_.luminaires = &gpu_scene_.luminaire_buffer();
    inputs_.index_buffer = &gpu_scene_.index_buffer();
    inputs_.instance_count = gpu_scene_.instance_count();
    inputs_.has_tested = gpu_scene_.has_tested();
    inputs_.has_blended = gpu_scene_.has_blended();
    if (inputs_.features != gpu_scene_.features()) voxels_.forget_passes();
    inputs_.features = wanted_.features = gpu_scene_.features();
    wanted_.aov = sample.aov != shading::frame_aov_none;
    wanted_.cone_shadows = has_cone_shadows_;
    wanted_.shadows_traced = has_cone_shadows_ && std::ranges::all_of(plan_.batches, [](const ShadowBatch& batch) {
        return batch.light_count <= passes::most_lights_traced;
    });
    if (lighting_.cone_shadows != has_cone_shadows_ || lighting_.shadows_traced != wanted_.shadows_traced) voxels_.forget_passes();
    lighting_.cone_shadows = has_cone_shadows_;
    lighting_.shadows_traced = wanted_.shadows_traced;
    wanted_.cone_traced = sample.cone_traced;
    wanted_.cone_spacing = sample.cone_traced ? 1u << static_cast<unsigned>(settings_.vct.resolution) : 1u;
    wanted_.ambient = inputs_.ambient;
    occlude_sky(sample);
    if (auto done = prepare_volumes(sample); !done) return done;
    wanted_.volume = key_.volume;
    if (auto done = choose_rasterizer(); !done) return done;
    wanted_.surfaces_ahead = wanted_.cone_traced && wanted_.computed_visibility && !wanted_.aov;
    if (!(wanted_ == key_)) {
        if (auto done = device_.wait_idle(); !done) return done;
        // After a failure some of it is of the old size and some of the new: the next frame makes all anew.
        if (auto made = make_images(); !made) return key_ = {}, made;
    }
    if (sample.cone_traced)
        if (auto done = prepare_volume(camera); !done) return key_ = {}, done;
    if (wanted_ == key_) return {};
    if (auto done = device_.wait_idle(); !done) return done;
    const Result<void> rebuilt = build_shadow_graph().and_then([&] { return build_surface_graph(); }).and_then([&] { return build_frame_graph(); });
    key_ = rebuilt ? wanted_ : decltype(key_){};
    return rebuilt;
}

Result<void> FrameRenderer::make_images() {
    const auto make = [&](gpu::Image& image, const gpu::ImageDescription& description) -> Result<void> {
        auto made = gpu::Image::create(device_, description);
        if (!made) return tl::unexpected(made.error());
        image = std::move(*made);
        return {};
    };
    const VkExtent3D extent{static_cast<std::uint32_t>(wanted_.width), static_cast<std::uint32_t>(wanted_.height), 1};
    if (wanted_.width != key_.width || wanted_.height != key_.height || wanted_.display != key_.display) {
        if (auto done = make(sum_, {.name = "accumulated", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = extent,
                                    .usage = VK_IMAGE_USAGE_STORAGE_BIT}); !done)
            return done;
        display_ = {};
        if (wanted_.display)
            if (auto done = make(display_, {.name = "display", .format = VK_FORMAT_R8G8B8A8_UNORM, .extent = extent,
                                            .usage = VK_IMAGE_USAGE_STORAGE_BIT}); !done)
                return done;
    }
    if (wanted_.shadow_layers != key_.shadow_layers || wanted_.shadow_size != key_.shadow_size ||
        wanted_.computed_shadows != key_.computed_shadows) {
        const auto size = static_cast<std::uint32_t>(wanted_.shadow_size);
        const bool computed = wanted_.computed_shadows;
        gpu::ImageDescription maps{.name = "shadow depth", .extent = {size, size, 1}, .layers = wanted_.shadow_layers};
        maps.format = computed ? passes::computed_depth_format : passes::shadow_depth_format;
        maps.usage = computed ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        if (auto done = make(shadow_depth_, maps); !done) return done;
        maps.name = "shadow slope";
        maps.format = passes::shadow_slope_format;
        maps.usage = computed ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        if (auto done = make(shadow_slope_, maps); !done) return done;
        resident_shadows_ = {};
        voxels_.forget_passes();
    }
    if (wanted_.shadow_views != key_.shadow_views) {
        auto cull_views = gpu::Buffer::create(device_, {"shadow cull views", wanted_.shadow_views * sizeof(shading::ViewData)});
        if (!cull_views) return tl::unexpected(cull_views.error());
        shadow_cull_views_ = std::move(*cull_views);
        auto views = gpu::Buffer::create(device_, {"shadow views", wanted_.shadow_views * sizeof(shading::ShadowViewData)});
        if (!views) return tl::unexpected(views.error());
        shadow_views_ = std::move(*views);
        resident_shadows_ = {};
    }
    if (wanted_.fragment_capacity != key_.fragment_capacity) {
        const VkDeviceSize bytes = passes::blend_buffer_bytes(wanted_.fragment_capacity);
        if (bytes > device_.limits().maxStorageBufferRange)
            return fail("", fmt::format("blended surfaces overlap {} times in this picture, more than the device's largest "
                                        "storage buffer holds", wanted_.fragment_capacity));
        auto fragments = gpu::Buffer::create(device_, {"blend fragments", bytes});
        if (!fragments) return tl::unexpected(fragments.error());
        fragments_ = std::move(*fragments);
        const std::uint32_t zeros[4] = {};
        if (auto done = device_.upload(fragments_, std::span<const std::uint32_t>(zeros)); !done) return done;
    }
    return {};
}

Result<void> FrameRenderer::render_batch(const Camera& camera, const FrameSample& sample, std::size_t batch, PassTimes* times) {
    auto commands = device_.begin_commands("frame");
    if (!commands) return tl::unexpected(commands.error());
    shading::FrameData frame = camera_frame(camera, gpu_scene_.bounds(), wanted_.width, wanted_.height, sample.jitter);
    frame.sample_index = sample.index;
    frame.texture_gradient_scale = sample.texture_gradient_scale;
    frame.sky_enabled = sample.environment ? 1 : 0;
    frame.instance_count = inputs_.instance_count;
    frame.light_first = plan_.batches[batch].first_light;
    frame.light_count = plan_.batches[batch].light_count;
    frame.batch = static_cast<std::uint32_t>(batch);
    frame.aov = sample.aov;
    frame.cone_traced = sample.cone_traced ? 1 : 0;
    // Live, a picture in motion has the cones in the middle of their cells; all other samples fill the cells.
    if (sample.index > 0 || sample.count > 1) frame.cone_shift = sample_position(sample.index, sample.count, sample.seed + 1);
    frame.cone_share = settings_.vct.narrow ? 1.0f / static_cast<float>(std::max(sample.count, sample.index + 1)) : 1.0f;
    frame.shadow_filter = sample.jitter_shadows ? shading::shadow_filter_nearest : shading::shadow_filter_contact_hardening;
    frame.fragment_capacity = wanted_.fragment_capacity;
    frame.random_seed = sample.index * 9781u + sample.seed;
    place_volumes(frame, batch);
    const shading::ViewData view{frame.world_to_clip};
    if (auto done = device_.upload(frame_buffer_, std::span<const shading::FrameData>(&frame, 1)); !done) return done;
    if (auto done = device_.upload(camera_view_, std::span<const shading::ViewData>(&view, 1)); !done) return done;
    if (auto done = place_raster_camera(frame.world_to_clip); !done) return done;
    timestamps_.begin_frame(sample.timed_whole ? gpu::Timestamps::Detail::whole : gpu::Timestamps::Detail::scopes);
    if (key_.surfaces_ahead)
        if (auto begun = surface_executor_->begin(*commands); !begun) return begun;
    if (sample.cone_traced && plan_.batches.size() == 1)
        if (auto done = record_volume(*commands, sample, batch); !done) return done;
    if (auto done = record_shadows(*commands, sample, batch, &timestamps_); !done) return done;
    if (key_.surfaces_ahead) surface_executor_->finish(*commands, &timestamps_);
    replace_sum_ = sample.replace && batch == 0;
    // Batches of lights add up to one picture: it adapts once.
    set_display(camera, {sample.display.sample_scale, batch + 1 == plan_.batches.size() ? sample.display.seconds : 0});
    if (auto done = frame_executor_->execute(*commands, &timestamps_); !done) return done;
    timestamps_.end_frame(*commands);
    return submit(std::move(*commands), times);
}

Result<void> FrameRenderer::submit(gpu::Commands commands, PassTimes* times) {
    auto submitted = device_.submit(std::move(commands));
    if (!submitted) return tl::unexpected(submitted.error());
    in_flight_.push_back(*submitted);
    if (in_flight_.size() > frames_in_flight) {
        if (auto done = device_.wait(in_flight_.front()); !done) return done;
        in_flight_.pop_front();
    }
    if (!times) return {};
    auto frame_times = timestamps_.wait();
    if (!frame_times) return tl::unexpected(frame_times.error());
    for (const gpu::ScopeTime& scope : frame_times->scopes) {
        const auto same = std::find_if(times->passes.begin(), times->passes.end(),
                                       [&](const PassTime& pass) { return pass.name == scope.name; });
        if (same != times->passes.end()) same->gpu_ms += scope.milliseconds;
        else times->passes.push_back({scope.name, scope.milliseconds});
    }
    times->total_ms += frame_times->total_milliseconds;
    return {};
}

Result<void> FrameRenderer::render(const Camera& camera, const FrameSample& sample, PassTimes* times) {
    if (auto done = sample.cone_traced ? update_surfaces(camera, sample) : prepare(camera, sample); !done) return done;
    inputs_.draw_calls = 0;
    forced_shadows_ = false;
    if (sample.cone_traced && relight_ && (sample.count > 0 || plan_.batches.size() > 1))
        if (auto done = converge_volume(sample); !done) return done;
    for (std::size_t batch = 0; batch < plan_.batches.size(); ++batch)
        if (auto done = render_batch(camera, sample, batch, times); !done) return done;
    draw_calls_ = inputs_.draw_calls;
    return {};
}

PassTimes FrameRenderer::latest_times() {
    PassTimes times;
    const gpu::FrameTimes& latest = timestamps_.latest();
    for (const gpu::ScopeTime& scope : latest.scopes) times.passes.push_back({scope.name, scope.milliseconds});
    times.total_ms = latest.total_milliseconds;
    return times;
}

Result<std::vector<float>> FrameRenderer::read_sum() { return device_.read_back_as<float>(sum_); }

Result<bool> FrameRenderer::grow_fragments() {
    if (!key_.blended) return false;
    auto header = device_.read_back(fragments_, 0, 16);
    if (!header) return tl::unexpected(header.error());
    std::uint32_t demand[4];
    std::copy_n(header->data(), sizeof(demand), reinterpret_cast<std::byte*>(demand));
    if (demand[1] <= key_.fragment_capacity) return false;
    wanted_.fragment_capacity = demand[1] + demand[1] / 4;
    return true;
}

}  // namespace heliodon::realtime
