#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "core/result.h"
#include "scene/scene.h"
#include "scene/sensor_reading.h"

namespace heliodon {

/// Up to here samples are counted exactly wherever a count is stored.
inline constexpr int most_samples_per_pixel = 1 << 24;

/// Whether a picture takes along what a later render needs to go on from it (PathOptions::resume).
enum class KeepState { never, when_stopped, always };

struct PathOptions {
    int width = 1024, height = 768;
    int samples_per_pixel = 64;     ///< at most; measure: samples a sensor
    std::optional<double> seconds;  ///< stop after this long at the latest
    int max_depth = 0;              ///< scattering events; 0 = unlimited, 1 = direct light only
    bool environment = true;        ///< false: the sky gives no light and is black
    std::uint32_t seed = 0;
    int threads = 0;                ///< 0 = all cores; the picture does not depend on it
    /// measure: sample on until each 95 % half-width is this share of its value; render: the relative standard error
    /// of the luminance at which a part of the picture is done (docs/path-tracing.md).
    std::optional<double> target_error;
    double target_floor = 0;        ///< measure: to the target error smaller values count as this
    std::vector<std::string> aovs;  ///< albedo normal depth position direct indirect variance samples illuminance
    bool blue_noise = true;  ///< neighbouring pixels err apart; false: independently, as with a variance or target error
    bool light_tree = true;  ///< false: lights are selected by flux alone, wherever they stand
    bool lanes = true;       ///< eight paths at a time where the processor has AVX2; false: one by one
    int branches = 0;        ///< directions in which paths leave their first surface: 1, 2 or 4; 0: as many as pay
    KeepState keep_state = KeepState::never;
    const Picture* resume = nullptr;  ///< a picture with state, of the same scene and options, to go on from
    std::string resume_name;          ///< stands in messages about it
    Integrator integrator = Integrator::path;  ///< of pictures (docs/bidirectional.md); without target_error if bidirectional
};

struct PathStatistics {
    double seconds = 0;
    int samples_per_pixel = 0;
    std::uint64_t rays = 0;
    std::uint64_t non_finite_samples = 0;  ///< paths whose radiance was no number; they count as black
    double mean_samples_per_pixel = 0;     ///< less than samples_per_pixel where a target error was reached early
    std::optional<double> target_reached;  ///< the part of the picture that reached the target error
    bool stopped = false;                  ///< `progress` asked to stop before the end
};

/// What one update of the tracing database did (tests read it).
struct TraceUpdate {
    int geometries_built = 0;
    int instances_updated = 0;
    bool top_level_built = false;
};

/// The ground truth: unidirectional path tracing with next-event estimation and multiple importance
/// sampling over the scene's own vertex data; for pictures also bidirectional. Nothing outside the trace room knows what answers its rays.
class PathTracer {
public:
    PathTracer();
    ~PathTracer();
    PathTracer(PathTracer&&) noexcept;
    PathTracer& operator=(PathTracer&&) noexcept;

    /// Follows the scene's journal. Must be called before render or measure, and after edits; always with
    /// the same scene object, which must outlive the tracer's use of it.
    [[nodiscard]] Result<TraceUpdate> update(const Scene& scene);

    /// Radiance in cd/m² as the camera sees it, box-filtered over each pixel.
    [[nodiscard]] Result<Picture> render(const Scene& scene, const Camera& camera, const PathOptions& options,
                                         PathStatistics* statistics = nullptr, const Progress& progress = {});

    /// Every sensor of the scene with its 95 % half-width; those not finished when `progress` asks to stop are left out.
    [[nodiscard]] Result<std::vector<SensorReading>> measure(const Scene& scene, const PathOptions& options,
                                                             const Progress& progress = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace heliodon
