#include "trace/measure.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/units.h"
#include "trace/direction_guide.h"

namespace heliodon::trace {
namespace {

constexpr int batch_count = 32;
constexpr double student_95 = 2.0395134;  // two-sided 95 % quantile of Student's t, 31 degrees of freedom
constexpr int most_samples = 1 << 24;     // a sensor, where a target error is asked for

// The pilot that finds out where a sensor's light comes from: half as many paths as are then measured with at least.
constexpr int most_guide_cells = 64;  // a side
constexpr int pilot_paths_a_cell_side = 2;
constexpr std::uint32_t pilot_stream = 0x80000000u;

/// Tells of batches as threads end them, and whether to go on.
class BatchProgress {
public:
    BatchProgress(const Progress& progress, std::size_t count) : progress_(progress), count_(count) {}

    /// `counts`: one of those that were foreseen.
    void done(bool counts) {
        const std::lock_guard lock(mutex_);
        done_ += counts ? 1 : 0;
        if (progress_ && !stopped_) stopped_ = !progress_(static_cast<double>(done_) / static_cast<double>(count_));
    }
    [[nodiscard]] bool stopped() {
        const std::lock_guard lock(mutex_);
        return stopped_;
    }

private:
    const Progress& progress_;
    std::size_t count_, done_ = 0;
    std::mutex mutex_;
    bool stopped_ = false;
};

/// Measures one sensor.
class Measurement {
public:
    Measurement(const CpuKernel& kernel, const EmbreeScene& embree, const SensorPoint& point, std::uint32_t number,
                const PathOptions& options)
        : kernel_(kernel), embree_(embree), point_(point), number_(number), frame_(frame_from_normal(point.direction)) {
        if (point.sensor->type != SensorType::illuminance || !scatters()) return;
        const double cells = 0.5 * options.samples_per_pixel / (pilot_paths_a_cell_side * pilot_paths_a_cell_side);
        learn(std::min(most_guide_cells, static_cast<int>(std::sqrt(cells))));
    }

    /// Samples [begin, end) of one batch, summed. Batches are independent: each scrambles the sequence its own way.
    [[nodiscard]] glm::dvec3 sum_of(int batch, int begin, int end) const {
        CpuKernel kernel = kernel_;
        PathCounts counts;
        glm::dvec3 sum(0);
        const std::uint32_t stream = number_ * batch_count + static_cast<std::uint32_t>(batch);
        for (int i = begin; i < end; ++i) {
            const auto sample = static_cast<std::uint32_t>(i);
            shading::PathState path = point_.sensor->type == SensorType::illuminance
                                          ? begin_illuminance(kernel, stream, sample)
                                          : kernel.path_begin_along(stream, sample, point_.origin(), point_.direction);
            sum += follow_path(kernel, embree_, path, counts).radiance;
        }
        return sum;
    }

private:
    /// Whether a scattered ray can bring light that light sampling at the sensor does not.
    [[nodiscard]] bool scatters() const { return kernel_.frame.max_depth != 1 || kernel_.frame.scattered_emission != 0; }

    /// The path's scattered ray: it brings cos θ / pdf of the radiance that it meets.
    void scatter(shading::PathState& path, const DirectionGuide::Sampled& sampled) const {
        path.throughput = vec3(sampled.direction.z / sampled.pdf);
        path.scatter_pdf = sampled.pdf;
        path.scatter_origin = path.origin = point_.origin();
        path.scatter_normal = point_.direction;
        path.direction = to_world(frame_, sampled.direction);
        path.after_shadow = kernel_stage_scatter;
    }

    /// A path whose first event is the receiving plane, from which nothing leaves yet.
    [[nodiscard]] shading::PathState begin_at_plane(CpuKernel& kernel, std::uint32_t stream, std::uint32_t sample) const {
        shading::PathState path = kernel.path_begin_along(stream, sample, point_.origin(), -point_.direction);
        path.depth = 1;
        path.stage = path.after_shadow = kernel_stage_done;
        return path;
    }

    /// Aims at a light sample; false where it brings nothing.
    bool sample_light(CpuKernel& kernel, shading::PathState& path) const {
        if (kernel.frame.emitter_count == 0) return false;
        const KernelLightSample light = kernel.kernel_sample_emitters(
            point_.origin(), point_.direction, kernel.path_random_pair(path, 0, 1).x, kernel.path_random_pair(path, 0, 2));
        const float cosine = glm::dot(light.direction, point_.direction);
        if (cosine <= 0 || max_component(light.light) <= 0) return false;
        const float weight = light.pdf > 0 ? power_heuristic(light.pdf, guide_.pdf(to_local(frame_, light.direction))) : 1.0f;
        kernel.kernel_aim_shadow(path, point_.origin(), vec3(0), point_.direction, light, light.light * (cosine * weight));
        return true;
    }

    /// The illuminance is the integral of radiance · cos θ: by light sampling and the guide together.
    [[nodiscard]] shading::PathState begin_illuminance(CpuKernel& kernel, std::uint32_t stream, std::uint32_t sample) const {
        shading::PathState path = begin_at_plane(kernel, stream, sample);
        if (scatters()) {
            const DirectionGuide::Sampled sampled = guide_.sample(kernel.path_random_pair(path, 0, 3));
            if (sampled.pdf > 0) scatter(path, sampled);
        }
        if (!sample_light(kernel, path)) path.stage = path.after_shadow;
        return path;
    }

    /// What a few paths brought through one cell of directions.
    struct PilotCell {
        double scattered = 0, scattered_squares = 0, sampled = 0;  ///< by scattered rays; by light sampling
    };

    /// One path that leaves through a given part of a cell, and one that samples light, together an estimate of the
    /// illuminance like any other.
    void add_pilot_path(CpuKernel& kernel, shading::PathState path, vec3 direction, PilotCell& cell) const {
        PathCounts counts;
        shading::PathState light_path = path;
        if (const DirectionGuide::Sampled sampled{direction, cosine_hemisphere_pdf(direction.z)}; sampled.pdf > 0) {
            scatter(path, sampled);
            path.stage = kernel_stage_scatter;
            const double brought = units::luminance(follow_path(kernel, embree_, path, counts).radiance);
            cell.scattered += brought;
            cell.scattered_squares += brought * brought;
        }
        if (sample_light(kernel, light_path))
            cell.sampled += units::luminance(follow_path(kernel, embree_, light_path, counts).radiance);
    }

    /// Sends a few paths through each of side² cells. Where light sampling finds light better than even directions do,
    /// multiple importance sampling leaves it there, and the guide too.
    void learn(int side) {
        if (side < 2) return;
        constexpr int paths = pilot_paths_a_cell_side * pilot_paths_a_cell_side;
        std::vector<PilotCell> cells(static_cast<std::size_t>(side) * side);
        tbb::parallel_for(0, side, [&](int row) {
            CpuKernel kernel = kernel_;
            const std::uint32_t stream = (pilot_stream | number_) * most_guide_cells + static_cast<std::uint32_t>(row);
            for (int column = 0; column < side; ++column)
                for (int i = 0; i < paths; ++i) {
                    const shading::PathState path = begin_at_plane(kernel, stream, static_cast<std::uint32_t>(column * paths + i));
                    const vec2 corner(i % pilot_paths_a_cell_side, i / pilot_paths_a_cell_side);
                    const vec2 within = (corner + kernel.path_random_pair(path, 0, 3)) / static_cast<float>(pilot_paths_a_cell_side);
                    add_pilot_path(kernel, path, DirectionGuide::direction_in(side, column, row, within),
                                   cells[static_cast<std::size_t>(row) * side + column]);
                }
        });
        std::vector<double> light;
        double scattered = 0, all = 0;
        for (const PilotCell& cell : cells) {
            light.push_back(std::sqrt(cell.scattered_squares / paths));
            scattered += cell.scattered;
            all += cell.scattered + cell.sampled;
        }
        // Half of the light by scattered rays: light sampling finds it no better than even directions do.
        if (all > 0) guide_ = DirectionGuide(side, light, std::min(1.0, 2 * scattered / all));
    }

    const CpuKernel& kernel_;
    const EmbreeScene& embree_;
    const SensorPoint& point_;
    std::uint32_t number_;
    Frame frame_;
    DirectionGuide guide_;
};

/// The mean of the batches' sums of `samples` each, and its half-width.
SensorReading reading_of(const SensorPoint& point, const std::vector<glm::dvec3>& sums, double samples) {
    glm::dvec3 mean(0);
    for (const glm::dvec3& sum : sums) mean += sum / (samples * batch_count);
    double squares = 0;
    for (const glm::dvec3& sum : sums) squares += std::pow(units::luminance(sum / samples) - units::luminance(mean), 2);
    const double half_width = student_95 * std::sqrt(squares / (batch_count - 1) / batch_count);
    return {point.name, point.sensor->type, units::luminance(mean), mean, half_width, point.position,
            point.sensor->grid.has_value()};
}

bool is_good_enough(const SensorReading& reading, const PathOptions& options) {
    return !options.target_error ||
           reading.half_width_95 <= *options.target_error * std::max(std::abs(reading.value), options.target_floor);
}

}  // namespace

std::vector<SensorReading> measure_sensors(const Scene& scene, const CpuKernel& kernel, const EmbreeScene& embree,
                                           const PathOptions& options, const Progress& progress) {
    constexpr float offset = 1e-4f;  // of the scene's size: a sensor on a surface looks out from it
    const Bounds bounds = kernel.flat.bounds();
    const std::vector<SensorPoint> points = sensor_points(scene, bounds.empty() ? 0.0f : offset * bounds.diagonal());
    const int at_least = std::max(1, (options.samples_per_pixel + batch_count - 1) / batch_count);
    std::vector<SensorReading> readings;
    BatchProgress batches(progress, batch_count * points.size());
    run_on_threads(options.threads, [&] {
        for (const SensorPoint& point : points) {
            if (batches.stopped()) return;
            const Measurement measurement(kernel, embree, point, static_cast<std::uint32_t>(readings.size()), options);
            std::vector<glm::dvec3> sums(batch_count, glm::dvec3(0));
            SensorReading reading;
            for (int done = 0, goal = at_least;; goal *= 2) {
                tbb::parallel_for(0, batch_count, [&](int batch) {
                    if (batches.stopped()) return;
                    sums[batch] += measurement.sum_of(batch, done, goal);
                    batches.done(done == 0);
                });
                if (batches.stopped()) return;
                done = goal;
                reading = reading_of(point, sums, done);
                if (is_good_enough(reading, options) || done > most_samples / batch_count / 2) break;
            }
            readings.push_back(std::move(reading));
        }
    });
    return readings;
}

}  // namespace heliodon::trace
