#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "core/result.h"
#include "realtime/shadow_volume_statistics.h"
#include "scene/scene.h"
#include "scene/sensor_reading.h"

namespace heliodon {

struct DeviceInfo {
    int number = 0;
    std::string name;
    std::string driver;
    std::string api_version;
    bool is_cpu = false;
    bool usable = false;              ///< has all the renderer needs
    std::string missing;              ///< what it lacks when not usable
    bool ray_query = false, ray_tracing_pipeline = false, mesh_shader = false, conservative_rasterization = false;
    std::uint64_t memory_bytes = 0;
};
/// The Vulkan devices of this machine, usable or not.
[[nodiscard]] Result<std::vector<DeviceInfo>> list_devices();

struct RealtimeSettings {
    std::string device;            ///< number or part of a name; empty: the best usable one
    bool validation = false;       ///< Vulkan's validation layer with synchronization checks
    std::string shader_directory;  ///< non-empty: GLSL is compiled from there at run time (reload)
};
struct RealtimeOptions {
    int width = 1024, height = 768;
    int samples = 64;           ///< jittered frames accumulated into a still picture; 0: none, to time frames alone
    std::uint32_t seed = 0;
    std::string gi = "none";    ///< or vct: voxel cone tracing, as the scene's render block has it
    bool environment = true;    ///< false: the sky gives no light and is black
    VolumesBehind volumes_behind = VolumesBehind::fewest;  ///< of render.sun_shadows volumes: to compare
    int frames_timed = 0;       ///< > 0: time this many frames after warm-up
    bool keep_shadows = false;  ///< timed frames draw their shadow maps once, not anew each
    /// albedo normal depth position direct indirect illuminance: depth is the distance along the view axis in metres; depth
    /// and position are means over what was hit (0 where nothing was), as is illuminance (lux on the side that is seen); the
    /// others are box-filtered like the picture. ao: openness of the hemisphere by cosine, by cones, or by what the picture shows.
    /// With vct also voxels and opacity (the volume as the camera sees it).
    std::vector<std::string> aovs;
};
struct PassTime {
    std::string name;
    double gpu_ms = 0;  ///< median
};
struct RealtimeStatistics {
    std::vector<PassTime> passes;
    double gpu_ms_total = 0, cpu_ms = 0;  ///< of a frame, medians
    double gpu_ms_mean = 0;               ///< of a frame
    std::vector<PassTime> sky_passes;     ///< of filtering the sky, where it changes; with frames_timed alone
    double sky_gpu_ms = 0;                ///< likewise, in all
    std::string device;
    std::uint64_t gpu_memory_bytes = 0;
    std::uint64_t vertex_bytes = 0;  ///< of them, attributes of vertices (convert.vertex_precision)
    std::uint64_t shadow_maps_drawn = 0;  ///< in the frames that were timed, or in all of the still picture
    int draw_calls = 0;      ///< indirect draws of one frame, whatever the number of nodes
    std::optional<ShadowVolumeStatistics> shadow_volumes;  ///< render.sun_shadows
    int light_batches = 0;   ///< lights whose shadow maps do not fit together are lit in several batches
};

/// What one update of the GPU scene uploaded (tests read it).
struct RealtimeUpdate {
    int meshes_uploaded = 0, textures_uploaded = 0, materials_uploaded = 0, instances_uploaded = 0, lights_uploaded = 0;
    std::uint64_t bytes_uploaded = 0;
};

/// The real-time engine, headless: composes the passes of src/passes/ into a frame graph by its settings.
class RealtimeRenderer {
public:
    [[nodiscard]] static Result<RealtimeRenderer> create(const RealtimeSettings& settings);
    ~RealtimeRenderer();
    RealtimeRenderer(RealtimeRenderer&&) noexcept;
    RealtimeRenderer& operator=(RealtimeRenderer&&) noexcept;

    /// Follows the scene's journal; always the same scene object.
    [[nodiscard]] Result<RealtimeUpdate> update(const Scene& scene);
    /// Radiance in cd/m² of a still picture: `options.samples` jittered frames averaged.
    [[nodiscard]] Result<Picture> render(const Scene& scene, const Camera& camera, const RealtimeOptions& options,
                                         RealtimeStatistics* statistics = nullptr, const Progress& progress = {});
    /// Every sensor of the scene, direct light and sky (no noise).
    [[nodiscard]] Result<std::vector<SensorReading>> measure(const Scene& scene, const RealtimeOptions& options);
    /// What Vulkan's validation layer said so far (nothing without RealtimeSettings::validation).
    [[nodiscard]] std::vector<std::string> validation_messages() const;

private:
    struct State;
    explicit RealtimeRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace heliodon
