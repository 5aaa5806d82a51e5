#include "app/cli/bench_equal_error.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "app/cli/terminal.h"
#include "shading/tone.h"
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

struct References {
    Image a, b;
    float scale = 1;  // of exposure
};

NoiselessError error_of(const Image& test, const References& references) {
    constexpr double confidence_95 = 1.96;  // standard deviations
    constexpr double relmse_floor = 0.01;
    double sum = 0, squares = 0;
    const std::size_t count = test.pixels.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double value = references.scale * test.pixels[i];
        const double a = references.scale * references.a.pixels[i], b = references.scale * references.b.pixels[i];
        const double r = (a + b) / 2;
        const double term = (value - a) * (value - b) / (r * r + relmse_floor);
        sum += term;
        squares += term * term;
    }
    const double mean = sum / count;
    return {mean, confidence_95 * std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

void solve(EqualError& result) {
    double sum = 0, weights = 0;
    for (const EqualError::Measured& path : result.path) {
        const double weight = 1 / std::pow(path.samples * std::max(path.error.half_width_95, 1e-12), 2);
        sum += weight * path.samples * path.error.relmse;
        weights += weight;
    }
    const double a = sum / weights, a_half_width = 1 / std::sqrt(weights);
    if (!(result.frame.relmse > result.frame.half_width_95) || !(a > a_half_width)) return;
    result.path_samples = std::max(1.0, a / result.frame.relmse);
    result.path_seconds = *result.path_samples * result.path[1].seconds / result.path[1].samples;
}

}  // namespace

Result<EqualError> find_equal_error(const Scene& scene, const Camera& camera, const Image& frame, double path_seconds) {
    Tracing tracing(scene, camera, frame.width, frame.height);
    if (auto prepared = tracing.prepare(); !prepared) return tl::unexpected(prepared.error());
    constexpr double reference_share = 0.4;  // of the time, for each; a quarter and a sixteenth of it for the others
    auto first = tracing.render(reference_share * path_seconds, most_samples_per_pixel, "path reference");
    if (!first) return tl::unexpected(first.error());
    EqualError result;
    result.threads = std::max(1u, std::thread::hardware_concurrency());
    result.reference_samples = first->statistics.samples_per_pixel;
    auto second = tracing.render(std::nullopt, result.reference_samples, "path reference");
    if (!second) return tl::unexpected(second.error());
    result.reference_seconds = first->statistics.seconds + second->statistics.seconds;

    const References references{std::move(first->image), std::move(second->image),
                                shading::exposure_scale(camera.ev100())};
    result.frame = error_of(frame, references);
    const int few = std::max(1, result.reference_samples / 16), many = std::max(2 * few, result.reference_samples / 4);
    for (int i = 0; i < 2; ++i) {
        const auto traced = tracing.render(std::nullopt, i == 0 ? few : many, "path tracing");
        if (!traced) return tl::unexpected(traced.error());
        result.path[i] = {traced->statistics.samples_per_pixel, traced->statistics.seconds,
                          error_of(traced->image, references)};
    }
    solve(result);
    return result;
}

}  // namespace heliodon::cli
