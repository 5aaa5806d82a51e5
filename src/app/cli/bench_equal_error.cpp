#include "app/cli/bench_equal_error.h"

#include <algorithm>
#include <thread>

#include "app/cli/terminal.h"
#include "core/metrics.h"
#include "trace/path_tracer.h"

namespace heliodon::cli {
namespace {

struct Traced {
    Image image;
    PathStatistics statistics;
};

class Tracing {
public:
    Tracing(const Scene& scene, const Camera& camera, int width, int height) : scene_(scene), camera_(camera) {
        options_.width = width;
        options_.height = height;
    }
    Result<void> prepare() {
        if (auto updated = tracer_.update(scene_); !updated) return tl::unexpected(updated.error());
        return {};
    }
    /// Each picture with random numbers of its own: their errors must not go together.
    Result<Traced> render(std::optional<double> seconds, int samples, const char* label) {
        options_.seconds = seconds;
        options_.samples_per_pixel = samples;
        ++options_.seed;
        Traced traced;
        ProgressBar bar(label);
        auto picture = tracer_.render(scene_, camera_, options_, &traced.statistics, bar.callback());
        if (interrupted()) return fail("", "interrupted");
        if (!picture) return tl::unexpected(picture.error());
        traced.image = std::move(picture->image);
        return traced;
    }

private:
    const Scene& scene_;
    const Camera& camera_;
    PathTracer tracer_;
    PathOptions options_;
};

Result<double> relmse(const Image& reference, const Image& test, const Camera& camera) {
    auto metrics = compare(reference, test, camera.ev100());
    if (!metrics) return tl::unexpected(metrics.error());
    return metrics->relmse;
}

/// Solves E(N) = a/N + b through both measured pictures, and E(N) = the frame's error.
void solve(EqualError& result) {
    const auto& [few, many] = result.path;
    const double a = (few.relmse - many.relmse) / (1.0 / few.samples - 1.0 / many.samples);
    result.reference_noise = std::max(0.0, many.relmse - a / many.samples);
    const double own = result.relmse - result.reference_noise;
    if (!(a > 0) || !(own > 0)) return;
    result.path_samples = std::max(1.0, a / own);
    result.path_seconds = *result.path_samples * many.seconds / many.samples;
}

}  // namespace

Result<EqualError> find_equal_error(const Scene& scene, const Camera& camera, const Image& frame, double path_seconds) {
    Tracing tracing(scene, camera, frame.width, frame.height);
    if (auto prepared = tracing.prepare(); !prepared) return tl::unexpected(prepared.error());
    const auto reference = tracing.render(path_seconds, 1, "path reference");
    if (!reference) return tl::unexpected(reference.error());
    EqualError result;
    result.threads = std::max(1u, std::thread::hardware_concurrency());
    result.reference_samples = reference->statistics.samples_per_pixel;
    result.reference_seconds = reference->statistics.seconds;
    const auto error = relmse(reference->image, frame, camera);
    if (!error) return tl::unexpected(error.error());
    result.relmse = *error;
    const int few = std::max(1, result.reference_samples / 16), many = std::max(2 * few, result.reference_samples / 4);
    for (int i = 0; i < 2; ++i) {
        const auto traced = tracing.render(std::nullopt, i == 0 ? few : many, "path tracing");
        if (!traced) return tl::unexpected(traced.error());
        const auto own = relmse(reference->image, traced->image, camera);
        if (!own) return tl::unexpected(own.error());
        result.path[i] = {traced->statistics.samples_per_pixel, traced->statistics.seconds, *own};
    }
    solve(result);
    return result;
}

}  // namespace heliodon::cli
