#include "trace/render_loop.h"

#include <fmt/format.h>
#include <tbb/blocked_range2d.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

namespace heliodon::trace {
namespace {

constexpr std::array aov_names{"albedo", "normal", "depth", "position", "direct", "indirect"};

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Visit>
void each_pixel(const PathOptions& options, Visit&& visit) {
    constexpr int tile = 16;
    const tbb::blocked_range2d<int> range(0, options.height, tile, 0, options.width, tile);
    tbb::parallel_for(
        range, [&](const tbb::blocked_range2d<int>& part) { visit(part); }, tbb::simple_partitioner());
}

/// What the first surface that the camera meets through a pixel is like, summed over samples.
struct FirstSurface {
    glm::dvec3 albedo{0}, normal{0}, position{0};
    double depth = 0;
    int hits = 0;
};

void add_first_surface(CpuKernel& kernel, const EmbreeScene& scene, shading::PathState path, FirstSurface& sum) {
    for (KernelRay ray = kernel.path_next_ray(path); ray.kind == kernel_ray_scatter; ray = kernel.path_next_ray(path)) {
        const KernelHit hit = scene.trace(ray);
        if (hit.kind != kernel_hit_surface) return;
        const KernelPoint point = kernel.kernel_point(hit);
        const MaterialData& material = kernel.fetch_material(point.material);
        if (kernel.kernel_pass_through(path, point, material)) continue;
        const MaterialPoint at = kernel.material_at(material, point.texcoord0, point.texcoord1, point.color, false);
        const bool front = glm::dot(path.direction, point.geometric_normal) < 0;
        const vec3 geometric = front ? point.geometric_normal : -point.geometric_normal;
        const vec3 normal =
            usable_shading_normal(kernel.kernel_mapped_normal(hit, point, material), geometric, -path.direction);
        sum.albedo += glm::dvec3(at.surface.base_color);
        sum.normal += glm::dvec3(normal);
        sum.position += glm::dvec3(point.position);
        sum.depth += glm::dot(glm::dvec3(point.position - kernel.frame.camera_position),
                              glm::dvec3(kernel.frame.camera_forward));
        ++sum.hits;
        return;
    }
}

bool wants(const PathOptions& options, std::string_view name) {
    return std::find(options.aovs.begin(), options.aovs.end(), name) != options.aovs.end();
}

/// Albedo and normal are box-filtered like the picture (nothing counts as 0); depth and position are means over
/// what was hit.
void add_surface_layers(const CpuKernel& shared_kernel, const EmbreeScene& scene, const PathOptions& options,
                        int samples, Picture& picture) {
    const bool any =
        wants(options, "albedo") || wants(options, "normal") || wants(options, "depth") || wants(options, "position");
    if (!any) return;
    constexpr int most_samples = 64;  // enough to filter edges as the picture's are
    const int count = std::min(samples, most_samples);
    std::array<Image, 4> images{Image(options.width, options.height, 3), Image(options.width, options.height, 3),
                                Image(options.width, options.height, 1), Image(options.width, options.height, 3)};
    each_pixel(options, [&](const tbb::blocked_range2d<int>& part) {
        CpuKernel kernel = shared_kernel;
        for (int y = part.rows().begin(); y < part.rows().end(); ++y)
            for (int x = part.cols().begin(); x < part.cols().end(); ++x) {
                FirstSurface sum;
                for (int i = 0; i < count; ++i) add_first_surface(kernel, scene, kernel.path_begin(x, y, i), sum);
                const double hits = std::max(1, sum.hits);
                for (int c = 0; c < 3; ++c) {
                    images[0].at(x, y, c) = static_cast<float>(sum.albedo[c] / count);
                    images[1].at(x, y, c) = static_cast<float>(sum.normal[c] / count);
                    images[3].at(x, y, c) = static_cast<float>(sum.position[c] / hits);
                }
                images[2].at(x, y) = static_cast<float>(sum.depth / hits);
            }
    });
    for (std::size_t i = 0; i < images.size(); ++i)
        if (wants(options, aov_names[i])) picture.layers.push_back({aov_names[i], std::move(images[i])});
}

}  // namespace

PathResult follow_path(CpuKernel& kernel, const EmbreeScene& scene, shading::PathState& path, PathCounts& counts) {
    for (KernelRay ray = kernel.path_next_ray(path); ray.kind != kernel_ray_none; ray = kernel.path_next_ray(path)) {
        kernel.path_take_hit(path, scene.trace(ray));
        ++counts.rays;
    }
    if (!is_finite(path.radiance)) {
        ++counts.non_finite;
        return {};
    }
    return {glm::dvec3(path.radiance), glm::dvec3(path.direct)};
}

void run_on_threads(int threads, const std::function<void()>& work) {
    // More threads than cores need leave to start.
    std::optional<tbb::global_control> leave;
    if (threads > tbb::info::default_concurrency())
        leave.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute([&] { work(); });
}

Result<void> check_aovs(const std::vector<std::string>& names) {
    for (const std::string& name : names)
        if (std::find(aov_names.begin(), aov_names.end(), name) == aov_names.end())
            return fail("", fmt::format("expected a layer of {}, found '{}'", fmt::join(aov_names, ", "), name));
    return {};
}

Picture render_picture(const CpuKernel& shared_kernel, const EmbreeScene& scene, const PathOptions& options,
                       PathStatistics& statistics, const Progress& progress) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::vector<PathResult> sums(static_cast<std::size_t>(options.width) * options.height);
    std::atomic<std::uint64_t> rays = 0, non_finite = 0;
    const auto add_samples = [&](int begin, int end) {
        each_pixel(options, [&](const tbb::blocked_range2d<int>& part) {
            CpuKernel kernel = shared_kernel;
            PathCounts counts;
            for (int y = part.rows().begin(); y < part.rows().end(); ++y)
                for (int x = part.cols().begin(); x < part.cols().end(); ++x) {
                    PathResult& sum = sums[static_cast<std::size_t>(y) * options.width + x];
                    for (int i = begin; i < end; ++i) {
                        shading::PathState path = kernel.path_begin(x, y, i);
                        const PathResult result = follow_path(kernel, scene, path, counts);
                        sum.radiance += result.radiance;
                        sum.direct += result.direct;
                    }
                }
            rays += counts.rays;
            non_finite += counts.non_finite;
        });
    };

    Picture picture;
    int done = 0;
    run_on_threads(options.threads, [&] {
        // Whole passes over the picture: one sample each against the clock, else so many that a pass is some
        // quarter million paths, after which the caller hears of it and may stop the work.
        const std::size_t pixels = sums.size();
        const int step = options.seconds ? 1 : static_cast<int>(std::max<std::size_t>(1, (std::size_t{1} << 18) / pixels));
        const auto finished = [&] {
            return options.seconds ? done > 0 && elapsed() >= *options.seconds : done >= options.samples_per_pixel;
        };
        while (!finished()) {
            const int end = options.seconds ? done + step : std::min(done + step, options.samples_per_pixel);
            add_samples(done, end);
            done = end;
            const double fraction =
                options.seconds ? elapsed() / *options.seconds : static_cast<double>(done) / options.samples_per_pixel;
            if (progress && !progress(std::min(1.0, fraction))) break;
        }
        add_surface_layers(shared_kernel, scene, options, done, picture);
    });

    picture.image = Image(options.width, options.height, 3);
    Image direct(options.width, options.height, 3), indirect(options.width, options.height, 3);
    for (std::size_t i = 0; i < sums.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            picture.image.pixels[3 * i + c] = static_cast<float>(sums[i].radiance[c] / done);
            direct.pixels[3 * i + c] = static_cast<float>(sums[i].direct[c] / done);
            indirect.pixels[3 * i + c] = static_cast<float>((sums[i].radiance[c] - sums[i].direct[c]) / done);
        }
    if (wants(options, "direct")) picture.layers.push_back({"direct", std::move(direct)});
    if (wants(options, "indirect")) picture.layers.push_back({"indirect", std::move(indirect)});
    statistics = {elapsed(), done, rays, non_finite};
    return picture;
}

}  // namespace heliodon::trace
