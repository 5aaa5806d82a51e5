#include "trace/measure.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/units.h"

namespace heliodon::trace {
namespace {

constexpr int batch_count = 32;
constexpr double student_95 = 2.0395134;  // two-sided 95 % quantile of Student's t, 31 degrees of freedom

shading::PathState begin(CpuKernel& kernel, const Sensor& sensor, float offset_m, std::uint32_t stream,
                         std::uint32_t sample) {
    const vec3 direction = glm::normalize(sensor.direction);
    // A sensor on a surface looks out from it.
    const vec3 position = sensor.position + offset_m * direction;
    return sensor.type == SensorType::illuminance ? kernel.path_begin_illuminance(stream, sample, position, direction)
                                                  : kernel.path_begin_along(stream, sample, position, direction);
}

/// Tells of batches as threads end them, and whether to go on.
class BatchProgress {
public:
    BatchProgress(const Progress& progress, std::size_t count) : progress_(progress), count_(count) {}

    void done() {
        const std::lock_guard lock(mutex_);
        ++done_;
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

}  // namespace

std::vector<SensorReading> measure_sensors(const Scene& scene, const CpuKernel& shared_kernel,
                                           const EmbreeScene& embree, const PathOptions& options,
                                           const Progress& progress) {
    constexpr float offset = 1e-4f;  // of the scene's size
    const Bounds bounds = shared_kernel.flat.bounds();
    const float offset_m = bounds.empty() ? 0.0f : offset * bounds.diagonal();
    const int samples = std::max(1, (options.samples_per_pixel + batch_count - 1) / batch_count);
    std::vector<SensorReading> readings;
    BatchProgress batches(progress, batch_count * scene.sensors().size());
    scene.sensors().each([&](SensorId, const Sensor& sensor) {
        if (batches.stopped()) return;
        const auto index = static_cast<std::uint32_t>(readings.size());
        glm::dvec3 means[batch_count];
        run_on_threads(options.threads, [&] {
            tbb::parallel_for(0, batch_count, [&](int batch) {
                if (batches.stopped()) return;
                CpuKernel kernel = shared_kernel;
                PathCounts counts;
                glm::dvec3 sum(0);
                // Batches are independent: each scrambles the sequence its own way.
                const std::uint32_t stream = index * batch_count + static_cast<std::uint32_t>(batch);
                for (int i = 0; i < samples; ++i) {
                    shading::PathState path = begin(kernel, sensor, offset_m, stream, static_cast<std::uint32_t>(i));
                    sum += follow_path(kernel, embree, path, counts).radiance;
                }
                means[batch] = sum / static_cast<double>(samples);
                batches.done();
            });
        });
        if (batches.stopped()) return;
        glm::dvec3 mean(0);
        for (const glm::dvec3& value : means) mean += value / static_cast<double>(batch_count);
        double squares = 0;
        for (const glm::dvec3& value : means) squares += std::pow(units::luminance(value) - units::luminance(mean), 2);
        const double half_width = student_95 * std::sqrt(squares / (batch_count - 1) / batch_count);
        readings.push_back({sensor.name, sensor.type, units::luminance(mean), mean, half_width});
    });
    return readings;
}

}  // namespace heliodon::trace
