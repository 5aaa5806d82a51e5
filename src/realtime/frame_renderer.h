#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "convert/mean_albedo.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "gpu/timestamps.h"
#include "graph/executor.h"
#include "passes/ambient_occlusion/ambient_occlusion.h"
#include "passes/compute_raster/compute_raster.h"
#include "passes/cone_trace/cone_trace.h"
#include "passes/environment/environment.h"
#include "passes/meter/meter.h"
#include "passes/sensors/sensors.h"
#include "passes/shade/shade.h"
#include "passes/shadow/shadow.h"
#include "passes/tonemap/tonemap_shared.h"
#include "realtime/gpu_scene.h"
#include "realtime/renderer.h"
#include "realtime/shadow_plan.h"
#include "realtime/shadow_volumes.h"
#include "realtime/voxel_volume.h"

namespace heliodon::realtime {

/// One jittered sample of a picture.
struct FrameSample {
    std::uint32_t index = 0;         ///< in its picture
    std::uint32_t count = 1;         ///< samples of the picture; 0: live, without end
    glm::vec2 jitter{0};             ///< pixels, −½ … ½
    std::uint32_t shadow_index = 0;  ///< shadow maps are rendered anew where this changes
    bool jitter_shadows = false;     ///< move the shadow maps' texel grid by `shadow_index`, and look up single texels
    bool force_shadows = false;      ///< render them although nothing changed (for timing)
    bool timed_whole = false;        ///< its beginning and end, instead of its passes
    bool environment = true;
    bool measures = false;           ///< light at points, not a picture: shadow maps as fine as they get
    bool cone_traced = false;        ///< indirect light and the sky by cones through the voxel volume
    bool occludes_sky = false;       ///< without cones: what the picture shows hides the sky, if the scene wants that
    VolumesBehind volumes_behind = VolumesBehind::fewest;
    std::uint32_t aov = shading::frame_aov_none;
    std::uint32_t seed = 0;
    bool replace = true;             ///< the accumulated sum starts anew
    struct Display {
        float sample_scale = 1;      ///< 1 / samples in the sum
        float seconds = 0;           ///< since the frame before, for the exposure to adapt
    } display;                       ///< live
    float texture_gradient_scale = 1.0f;
};

struct PassTimes {
    std::vector<PassTime> passes;
    double total_ms = 0;
};

/// What of a picture is found ahead of light: handles in the graph that finds it, or in one that reads it.
struct SurfacesAhead {
    passes::Surfaces surfaces;
    passes::ConeWeights weights;
};

/// Renders samples of a picture on one device: owns the GPU scene, the shadow maps, the frame graphs and the
/// accumulated sum. What is on the GPU follows from the last update() and resize().
class FrameRenderer {
public:
    [[nodiscard]] static Result<std::unique_ptr<FrameRenderer>> create(gpu::Device& device, const std::string& shader_directory);
    ~FrameRenderer();
    FrameRenderer(const FrameRenderer&) = delete;
    FrameRenderer& operator=(const FrameRenderer&) = delete;

    [[nodiscard]] Result<RealtimeUpdate> update(const Scene& scene);
    /// Pictures of this size; `display`: also a tone-mapped RGBA8 image.
    [[nodiscard]] Result<void> resize(int width, int height, bool display);
    /// Renders and submits one sample of every batch of lights. `times`, if wanted, waits for the GPU.
    [[nodiscard]] Result<void> render(const Camera& camera, const FrameSample& sample, PassTimes* times = nullptr);
    /// Times of a sample rendered a little earlier; never waits.
    [[nodiscard]] PassTimes latest_times();
    /// Whether the shadow maps are so many that a frame renders a part of them: those of a moving scene lag behind.
    [[nodiscard]] bool refreshes_in_turns() const;
    /// Whether some shadow maps still show an older scene.
    [[nodiscard]] bool shadows_lag() const { return stale_views_ > 0; }
    /// The accumulated sum as RGBA floats; waits.
    [[nodiscard]] Result<std::vector<float>> read_sum();
    /// Illuminance in lux (RGB) on planes: light from the lights with shadows and from the open sky, or, cone traced,
    /// from the sky that is seen and other surfaces; waits.
    struct Receiver {
        glm::vec3 position, normal;
    };
    struct Illuminance {
        glm::vec3 lux{0};
        double half_width_95 = 0;  ///< of its luminance: of the noise of shadows and of lights with an extent
    };
    [[nodiscard]] Result<std::vector<Illuminance>> illuminances(const std::vector<Receiver>& receivers, bool environment,
                                                                bool cone_traced);
    /// Times of the sky's filtering, as if it had just changed; waits.
    [[nodiscard]] Result<PassTimes> time_sky();
    /// Whether blended fragments found no room since the last call; if so, makes room, and the picture must
    /// be rendered again. Waits.
    [[nodiscard]] Result<bool> grow_fragments();

    /// The same for the voxel volume's surfaces, of which a moving scene may have more than before.
    [[nodiscard]] Result<bool> grow_volume();

    [[nodiscard]] const gpu::Image& display() const { return display_; }
    [[nodiscard]] const GpuScene& scene() const { return gpu_scene_; }
    [[nodiscard]] const VoxelVolume& voxels() const { return voxels_; }
    /// Of the last picture; nothing where no light casts any.
    [[nodiscard]] const ShadowVolumeStatistics* shadow_volumes() const { return key_.volumes ? &volumes_.statistics() : nullptr; }
    /// The scene's render block as of the last update.
    [[nodiscard]] const RenderSettings& settings() const { return settings_; }
    [[nodiscard]] gpu::Device& device() const { return device_; }
    [[nodiscard]] gpu::Pipelines& pipelines() { return pipelines_; }
    /// Indirect draws that the last render() recorded.
    [[nodiscard]] std::uint32_t draw_calls() const { return draw_calls_; }
    /// Shadow maps that have been drawn so far: one that shows the scene as it is is not drawn again.
    [[nodiscard]] std::uint64_t shadow_maps_drawn() const { return shadow_maps_drawn_; }
    /// Whether any light has an extent: its shadow maps then belong to one point of it at a time.
    [[nodiscard]] bool has_area_lights() const { return has_area_lights_; }
    [[nodiscard]] std::size_t light_batches() const { return plan_.batches.size(); }

private:
    /// What the graphs depend on; they are rebuilt when it changes.
    struct GraphKey {
        int width = 0, height = 0;
        bool display = false, metered = false, blended = false;
        passes::SceneFeatures features;
        bool aov = false, cone_traced = false, cone_shadows = false, shadows_traced = false;
        std::uint32_t cone_spacing = 1;  // pixels
        bool sky_occluded = false, ambient = false;
        bool surfaces_ahead = false;  // what the camera sees is found beside voxelization
        bool volumes = false;           // a directional light casts its shadows by them
        bool maps_after_volumes = false;  // and by maps, where surfaces cast no volume
        bool computed_visibility = false, computed_shadows = false, tests_opacity = false;  // rasterized by compute
        std::uint32_t instance_capacity = 0, shadow_layers = 0, shadow_views = 0;
        int shadow_size = 0;
        std::uint32_t fragment_capacity = 0;
        std::uint64_t volume = 0;  // VoxelVolume::texture_revision
        bool operator==(const GraphKey&) const = default;
    };
    /// Which shadow maps are resident.
    struct ShadowKey {
        std::uint64_t scene_revision = ~0ull;
        std::size_t batch = 0;
        std::uint32_t index = 0;
        bool jittered = false;
        bool operator==(const ShadowKey&) const = default;
    };

    /// What the voxel volume shows.
    struct VolumeKey {
        std::uint64_t scene = ~0ull, placement = ~0ull, shadow_places = 0;
        int bounces = 0;
        bool sky = true, narrow = false;
        float radiance_unit = 1;
        std::uint32_t effects = 0;
        bool operator==(const VolumeKey&) const = default;
    };

    FrameRenderer(gpu::Device& device, const std::string& shader_directory);
    [[nodiscard]] Result<void> open();
    [[nodiscard]] Result<void> plan_lights();
    [[nodiscard]] ShadowPlan plan_shadow_maps() const;
    /// The brightest directional light, if volumes are wanted; or no_light.
    [[nodiscard]] std::uint32_t choose_volume_light() const;
    [[nodiscard]] std::optional<std::uint32_t> light_without_maps(const FrameSample& sample) const;
    [[nodiscard]] Result<void> prepare_volumes(const FrameSample& sample);
    /// What the frame's sample needs to know of them.
    void place_volumes(shading::FrameData& frame, std::size_t batch);
    /// `lists`: what the camera sees, if it has been culled.
    [[nodiscard]] Result<graph::ImageHandle> add_shadow_volumes(graph::Graph& graph, VkExtent2D extent, passes::DrawLists lists);
    void use_shadow_plan(ShadowPlan plan);
    /// Without a size in the scene's settings shadow maps are as fine as the picture can tell.
    void fit_shadow_maps(const Camera& camera, const FrameSample& sample);
    [[nodiscard]] Result<void> upload_visible_lights();
    [[nodiscard]] Result<void> record_sensor_batch(const gpu::Buffer& sensors, std::uint32_t count, const FrameSample& sample,
                                                   std::size_t batch, const passes::SensorLights& lights);
    /// Which views of a batch are rendered now.
    [[nodiscard]] std::span<const ShadowPlan::View> views_due(const FrameSample& sample, const ShadowBatch& batch,
                                                              const ShadowKey& wanted);
    [[nodiscard]] Result<void> place_area_lights(const FrameSample& sample, std::span<const ShadowPlan::View> views);
    [[nodiscard]] std::vector<shading::ShadowViewData> shadow_views_at(std::span<const ShadowPlan::View> views,
                                                                       const FrameSample& sample) const;
    [[nodiscard]] Result<void> draw_shadow_maps(gpu::Commands& commands, const FrameSample& sample,
                                                std::span<const shading::ShadowViewData> views, gpu::Timestamps* timestamps);
    [[nodiscard]] Result<void> record_light_grid(gpu::Commands& commands, const FrameSample& sample, std::size_t batch,
                                                 gpu::Timestamps* timestamps);
    [[nodiscard]] Result<void> prepare(const Camera& camera, const FrameSample& sample);
    [[nodiscard]] Result<void> prepare_volume(const Camera& camera);
    /// Brings the volume up to date for a still picture: until light has converged. Waits.
    [[nodiscard]] Result<void> converge_volume(const FrameSample& sample);
    /// Voxelizes now, waits, and says whether all surfaces found room; if not, the next prepare() makes it.
    [[nodiscard]] Result<bool> surfaces_find_room();
    /// Tells the volume what it is asked for and finds out what is due.
    [[nodiscard]] Result<void> update_volume(const Camera& camera, const FrameSample& sample);
    [[nodiscard]] Result<void> update_surfaces(const Camera& camera, const FrameSample& sample);
    /// What a live frame does for the volume.
    [[nodiscard]] Result<void> record_volume(gpu::Commands& commands, const FrameSample& sample, std::size_t batch);
    /// `lights`: those to be lit with the bounce, if they are not yet.
    [[nodiscard]] Result<void> record_volume_bounces(gpu::Commands& commands, const ShadowBatch* lights);
    /// Whether anything but lights brings light.
    [[nodiscard]] bool emission_or_sky() const;
    void surfaces_voxelized();
    /// How the live picture is exposed and toned, by the scene's settings.
    void set_display(const Camera& camera, const FrameSample::Display& display);
    [[nodiscard]] Result<void> submit(gpu::Commands commands, PassTimes* times);
    [[nodiscard]] Result<void> make_images();
    /// Sets which of the wanted pictures compute rasterizes, and keeps what it reads up to date.
    [[nodiscard]] Result<void> choose_rasterizer();
    [[nodiscard]] Result<void> list_raster_triangles();
    [[nodiscard]] Result<void> place_raster_views(passes::ComputeRasterInputs& inputs, GrowingBuffer& buffer,
                                                  std::vector<shading::RasterView> views, std::uint64_t key_capacity);
    [[nodiscard]] std::uint64_t shadow_key_capacity(const GraphKey& key) const;
    [[nodiscard]] Result<void> place_raster_camera(const glm::mat4& world_to_clip);
    [[nodiscard]] Result<void> place_raster_shadows(std::span<const shading::ShadowViewData> views);
    [[nodiscard]] Result<void> add_shadow_maps(graph::Graph& graph, const passes::ShadowMaps& maps);
    /// `lists`: what was culled, by the hardware's rasterizer alone.
    [[nodiscard]] Result<passes::Visibility> add_visibility(graph::Graph& graph, VkExtent2D extent, passes::DrawLists& lists);
    [[nodiscard]] Result<void> build_shadow_graph();
    /// What is seen and what cones need to know of it: light has no part in it.
    [[nodiscard]] Result<void> build_surface_graph();
    [[nodiscard]] Result<void> build_frame_graph();
    [[nodiscard]] Result<void> record_shadows(gpu::Commands& commands, const FrameSample& sample, std::size_t batch,
                                              gpu::Timestamps* timestamps);
    [[nodiscard]] Result<void> render_batch(const Camera& camera, const FrameSample& sample, std::size_t batch, PassTimes* times);
    [[nodiscard]] Result<void> prefilter_sky();
    [[nodiscard]] Result<void> filter_sky(bool sky, PassTimes* times);
    /// What the shell that stands for surroundings follows from.
    struct AmbientKey {
        AmbientLight kind = AmbientLight::none;
        bool in_the_open = false;
        std::uint64_t surfaces = 0, lights = 0, sky = 0;
        bool operator==(const AmbientKey&) const = default;
    };
    /// Finds out what stands for the light of surroundings, if the scene wants that.
    [[nodiscard]] Result<void> place_ambient();
    [[nodiscard]] Result<void> set_ambient(const AmbientKey& key);
    /// None with global illumination.
    [[nodiscard]] AmbientLight ambient() const;
    /// Whether and how a sample finds out what hides the sky.
    void occlude_sky(const FrameSample& sample);

    gpu::Device& device_;
    gpu::Pipelines pipelines_;
    GpuScene gpu_scene_;
    std::unique_ptr<graph::Executor> shadow_executor_, surface_executor_, frame_executor_;
    SurfacesAhead ahead_;  // in surface_executor_
    gpu::Timestamps timestamps_, sky_timestamps_;

    VoxelVolume voxels_;
    ShadowVolumes volumes_;
    std::uint32_t volume_light_ = shading::no_light;  // in the light table
    RenderSettings settings_;
    VolumeKey volume_key_;
    bool voxelize_ = false, relight_ = false;  // due in this frame
    std::uint64_t voxelized_texture_ = 0;
    std::uint64_t voxelized_surfaces_ = ~0ull, voxelized_placement_ = ~0ull;  // GpuScene's and VoxelVolume's revisions
    int bounce_frames_ = 0, gather_side_ = 0;  // since the volume last changed; of the last frame

    ShadowPlan plan_;
    std::optional<ShadowDetail> shadow_detail_;  // that it is made for
    std::uint64_t shadow_places_ = 0;            // goes up when maps lie elsewhere or change in size
    bool shadow_maps_fit_picture_ = false;
    bool cone_shadows_ = false;  // lights with an extent are to cast their shadows by cones
    bool has_cone_shadows_ = false;
    std::vector<shading::LightData> lights_;         // the scene's; those with shadows by cones at their centre
    std::vector<shading::LightData> placed_lights_;  // the scene's, those with an extent at one point of it
    bool has_area_lights_ = false;
    std::uint64_t planned_lights_ = ~0ull, prefiltered_sky_ = ~0ull;
    std::uint32_t planned_instances_ = 0;  // as a capacity
    ShadowKey resident_shadows_;
    std::vector<shading::ShadowViewData> resident_views_;
    ShadowCascades cascades_, drawn_cascades_;  // as the camera stands now, and as it stood when maps were last drawn
    std::uint64_t shadow_maps_drawn_ = 0;
    std::pair<std::uint64_t, std::size_t> light_grid_key_{~0ull, 0};  // scene revision, batch
    bool forced_shadows_ = false;  // in this frame, already
    int shadow_map_size_ = 2048, planned_size_ = 0;
    std::uint32_t next_view_ = 0, stale_views_ = 0;  // in turns: whose turn it is, and how many show an older scene

    GraphKey key_, wanted_;
    passes::SceneInputs inputs_;
    passes::LightingInputs lighting_;
    passes::ShadowInputs shadow_inputs_;
    passes::ComputeRasterInputs camera_raster_, shadow_raster_;
    std::uint64_t raster_revision_ = ~0ull;  // of the scene whose triangles are listed
    std::uint32_t camera_view_count_ = 1;
    bool replace_sum_ = true;
    passes::ExposureInputs exposure_;
    shading::TonemapConstants tonemap_{};
    std::uint32_t draw_calls_ = 0;

    gpu::Buffer frame_buffer_, camera_view_, shadow_cull_views_, shadow_views_, shading_tables_, fragments_;
    gpu::Image shadow_depth_, shadow_slope_, sum_, display_;
    GrowingBuffer visible_lights_{"visible lights", 0}, light_grid_{"light grid", 0};
    GrowingBuffer raster_ranges_{"raster ranges", 0}, camera_raster_view_{"camera raster view", 0},
        shadow_raster_views_{"shadow raster views", 0};
    passes::EnvironmentMaps sky_maps_;
    std::optional<std::uint32_t> sky_specular_slot_, sky_irradiance_slot_, sky_picture_slot_, sky_reflected_slot_;
    AmbientKey ambient_key_;
    convert::MeanAlbedo mean_albedo_;
    AmbientLight reflected_sky_ = AmbientLight::none;  // what the shell's map is filtered for
    shading::AmbientOcclusionConstants occlusion_{};
    std::deque<gpu::TimelineValue> in_flight_;
};

}  // namespace heliodon::realtime
