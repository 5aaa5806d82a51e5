#include "trace/render_loop.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
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

#include "trace/illuminance_layer.h"
#include "trace/resume.h"

namespace heliodon::trace {
namespace {

constexpr std::array aov_names{"albedo", "normal", "depth", "position", "direct", "indirect", "variance", "samples", "illuminance"};

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Blocks are the pieces of work that threads take. `visit(block)` gets each once.
template <class Visit>
void each_block(const Blocks& blocks, Visit&& visit) {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, blocks.count()),
        [&](const tbb::blocked_range<int>& part) {
            for (int block = part.begin(); block < part.end(); ++block) visit(block);
        },
        tbb::simple_partitioner());
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
    const Blocks blocks{options.width, options.height};
    each_block(blocks, [&](int block) {
        CpuKernel kernel = shared_kernel;
        blocks.each_pixel(block, [&](int x, int y) {
            FirstSurface sum;
            for (int i = 0; i < count; ++i) add_first_surface(kernel, scene, kernel.path_begin(x, y, i), sum);
            const double hits = std::max(1, sum.hits);
            for (int c = 0; c < 3; ++c) {
                images[0].at(x, y, c) = static_cast<float>(sum.albedo[c] / count);
                images[1].at(x, y, c) = static_cast<float>(sum.normal[c] / count);
                images[3].at(x, y, c) = static_cast<float>(sum.position[c] / hits);
            }
            images[2].at(x, y) = static_cast<float>(sum.depth / hits);
        });
    });
    for (std::size_t i = 0; i < images.size(); ++i)
        if (wants(options, aov_names[i])) picture.layers.push_back({aov_names[i], std::move(images[i])});
}

/// Adds samples begin to end of one block's pixels, as far as they are still wanted.
void add_block_samples(CpuKernel& kernel, const EmbreeScene& scene, int block, int begin, int end,
                       Accumulation& picture, PathCounts& counts) {
    const AdaptiveSampling::Want want =
        picture.adaptive ? picture.adaptive->want(block) : AdaptiveSampling::Want{{true, true}, {false, false}};
    if (!want.any()) return;
    picture.blocks.each_pixel(block, [&](int x, int y) {
        const std::size_t pixel = static_cast<std::size_t>(y) * picture.blocks.width + x;
        for (int i = begin; i < end; ++i) {
            const int half = i & 1;
            if (!want.half(half)) continue;
            shading::PathState path = kernel.path_begin(x, y, i);
            const PathResult result = follow_path(kernel, scene, path, counts);
            if (want.picture[half]) picture.sums.add(pixel, i, result);
            if (want.decision[half]) picture.adaptive->add(pixel, i, units::luminance(result.radiance));
        }
    });
}

/// The sums' pictures and how much work they are.
void write_layers(const Accumulation& accumulation, const PathOptions& options, Picture& picture,
                  PathStatistics& statistics) {
    const Blocks& blocks = accumulation.blocks;
    const SampleSums& sums = accumulation.sums;
    picture.image = Image(options.width, options.height, 3);
    const bool split = wants(options, "direct") || wants(options, "indirect");
    Image direct, indirect, variance, samples(options.width, options.height, 1);
    if (split) direct = indirect = picture.image;
    if (wants(options, "variance")) variance = samples;
    std::atomic<std::int64_t> total = 0;
    each_block(blocks, [&](int block) {
        const SamplesTaken taken = accumulation.taken(block);
        const int count = samples_in_half(taken.half[0], 0) + samples_in_half(taken.half[1], 1);
        std::int64_t of_block = 0;
        blocks.each_pixel(block, [&](int x, int y) {
            const std::size_t pixel = static_cast<std::size_t>(y) * options.width + x;
            const glm::dvec3 mean = pixel_mean(sums, sums.radiance, pixel, taken);
            const glm::dvec3 part = split ? pixel_mean(sums, sums.direct, pixel, taken) : glm::dvec3(0);
            for (int c = 0; c < 3; ++c) {
                picture.image.at(x, y, c) = static_cast<float>(mean[c]);
                if (!split) continue;
                direct.at(x, y, c) = static_cast<float>(part[c]);
                indirect.at(x, y, c) = static_cast<float>(mean[c] - part[c]);
            }
            if (!variance.pixels.empty()) variance.at(x, y) = static_cast<float>(pixel_variance(sums, pixel, taken));
            samples.at(x, y) = static_cast<float>(count);
            of_block += count;
        });
        total += of_block;
    });
    statistics.mean_samples_per_pixel = static_cast<double>(total) / (static_cast<double>(options.width) * options.height);
    const auto keep = [&](const char* name, Image& image) {
        if (wants(options, name)) picture.layers.push_back({name, std::move(image)});
    };
    keep("direct", direct);
    keep("indirect", indirect);
    keep("variance", variance);
    keep("samples", samples);
}

Accumulation begin_picture(const PathOptions& options, double floor_nits) {
    const std::size_t pixels = static_cast<std::size_t>(options.width) * options.height;
    const bool split = wants(options, "direct") || wants(options, "indirect");
    Accumulation picture;
    picture.blocks = {options.width, options.height};
    picture.sums = SampleSums(pixels, wants_variance(options), split);
    if (options.target_error) picture.adaptive.emplace(picture.blocks, *options.target_error, floor_nits);
    return picture;
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

bool wants_variance(const PathOptions& options) {
    return options.target_error || wants(options, "variance");
}

Result<Picture> render_picture(const CpuKernel& shared_kernel, const EmbreeScene& scene, const PathOptions& options,
                               double floor_nits, PathStatistics& statistics, const Progress& progress,
                               const AddSamples& other) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    Accumulation work = begin_picture(options, floor_nits);
    if (options.resume)
        if (auto restored = restore_state(*options.resume, render_identity(shared_kernel, options), work); !restored)
            return fail(options.resume_name, restored.error().message);
    const int begin = work.done, most = options.samples_per_pixel;
    if (begin > most)
        return fail(options.resume_name,
                    fmt::format("expected at most {} samples a pixel to go on from, found {}", most, begin));

    std::atomic<std::uint64_t> rays = 0, non_finite = 0;
    const auto count = [&](const PathCounts& counts) {
        rays += counts.rays;
        non_finite += counts.non_finite;
    };
    std::optional<IlluminanceLayer> illuminance;
    if (wants(options, "illuminance")) illuminance.emplace(options.width, options.height);
    const auto add_samples = [&](int end) {
        if (other)
            count(other(work, end));
        else
            each_block(work.blocks, [&](int block) {
                CpuKernel kernel = shared_kernel;
                PathCounts counts;
                add_block_samples(kernel, scene, block, work.done, end, work, counts);
                count(counts);
            });
        work.done = end;
        if (illuminance) count(illuminance->add_samples(shared_kernel, scene, end));
    };
    const auto finished = [&] {
        if (work.done >= most || (work.adaptive && work.adaptive->finished())) return true;
        return options.seconds && work.done > begin && elapsed() >= *options.seconds;
    };
    // Whole passes over the picture, of so many paths that what a pass costs beside them does not count, among it that
    // threads wait for the last at its end; after each the caller hears of it and may stop the work.
    const auto paths_a_pass = [&] {
        const double threads = tbb::this_task_arena::max_concurrency();
        return options.seconds ? std::max(threads, 2.0) * (1 << 14) : std::max(threads, 4.0) * (1 << 16);
    };
    const auto next_stop = [&] {
        const double pixels = static_cast<double>(options.width) * options.height;
        const double running = pixels * (work.adaptive ? work.adaptive->running() : 1.0);
        const int end = work.done + static_cast<int>(std::clamp(paths_a_pass() / running, 1.0, 1.0 + (most - work.done)));
        return std::min({end, most, work.adaptive ? AdaptiveSampling::next_check(work.done) : most});
    };
    const auto fraction = [&] {
        const double by_samples = static_cast<double>(work.done) / most;
        const double by_error = work.adaptive ? work.adaptive->reached() : 0.0;
        return std::min(1.0, std::max({by_samples, by_error, options.seconds ? elapsed() / *options.seconds : 0.0}));
    };

    Picture picture;
    bool stopped = false;
    run_on_threads(options.threads, [&] {
        // Of the samples that a picture to go on from has, illuminance is not kept with it.
        while (illuminance && !stopped && illuminance->samples() < begin) {
            const double more = paths_a_pass() / (static_cast<double>(options.width) * options.height);
            const int end = illuminance->samples() + static_cast<int>(std::clamp(more, 1.0, 1.0 + begin));
            count(illuminance->add_samples(shared_kernel, scene, std::min(end, begin)));
            stopped = progress && !progress(fraction());
        }
        while (!stopped && !finished()) {
            const int end = next_stop();
            const bool check = work.adaptive && end == AdaptiveSampling::next_check(work.done);
            add_samples(end);
            if (check) work.adaptive->check(end);
            stopped = progress && !progress(fraction());
        }
        add_surface_layers(shared_kernel, scene, options, work.done, picture);
        if (illuminance) picture.layers.push_back({"illuminance", illuminance->image()});
        statistics.seconds = elapsed();
        write_layers(work, options, picture, statistics);
    });
    statistics.samples_per_pixel = work.done;
    statistics.rays = rays;
    statistics.non_finite_samples = non_finite;
    statistics.stopped = stopped && !finished();
    if (work.adaptive) statistics.target_reached = work.adaptive->reached();
    if (options.keep_state == KeepState::always || (options.keep_state == KeepState::when_stopped && statistics.stopped))
        store_state(work, render_identity(shared_kernel, options), picture);
    return picture;
}

}  // namespace heliodon::trace
