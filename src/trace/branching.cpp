#include "trace/branching.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

namespace heliodon::trace {
namespace {

constexpr std::uint32_t pilot_seed = 0x70696c6fu;
constexpr int sequences = 2, paths_a_sequence = 16;  // so long that what the sequence evens out of the rest counts little
constexpr int branch_bits = 2, branches_a_path = 1 << branch_bits;

/// A pixel's relative variance counts up to this, so that no single outlier decides; pixels darker than this share of the
/// picture's mean count as that.
constexpr double most_variance = branches_a_path, darkest = 0.1;

/// A path's luminance and rays, of its branches apart and of what comes before them.
struct PilotPath {
    double before = 0, rays_before = 0;
    std::array<double, branches_a_path> branch{};
    double branch_rays = 0;
    [[nodiscard]] double all() const { return std::accumulate(branch.begin(), branch.end(), before); }
    /// Of a branch, had it all the light that they share.
    [[nodiscard]] double branch_variance() const {
        const double mean = (all() - before) / branches_a_path;
        double squares = 0;
        for (const double light : branch) squares += (light - mean) * (light - mean);
        return squares / (branches_a_path - 1) * (branches_a_path * branches_a_path);
    }
};

PilotPath follow_pilot(CpuKernel& kernel, const EmbreeScene& scene, int x, int y, int sample) {
    PilotPath pilot;
    PathState path = kernel.path_begin(x, y, sample);
    for (KernelRay ray = kernel.path_next_ray(path); ray.kind != kernel_ray_none; ray = kernel.path_next_ray(path)) {
        const std::uint32_t begun = path.branches_begun;
        const double gathered = units::luminance(path.radiance);
        kernel.path_take_hit(path, scene.trace(ray));
        const double brought = units::luminance(path.radiance) - gathered;
        if (!std::isfinite(brought)) return {};
        (begun > 0 ? pilot.branch[begun - 1] : pilot.before) += brought;
        (begun > 0 ? pilot.branch_rays : pilot.rays_before) += 1;
    }
    return pilot;
}

/// Of a pixel: mean luminance, variance that one branch brings, and that of a path with all of them in its sequence; rays
/// of all paths before they branch, and of one branch of each.
struct Costs {
    double mean = 0, branch_variance = 0, variance = 0, branch_rays = 0, rays = 0;
};

Costs pilot_pixel(const CpuKernel& shared_kernel, const EmbreeScene& scene, std::uint32_t number) {
    const std::uint32_t chance = kernel_hash_combine(shared_kernel.frame.seed, number);
    const auto x = static_cast<int>(chance % shared_kernel.frame.width);
    const auto y = static_cast<int>(kernel_hash(chance) % shared_kernel.frame.height);
    Costs costs;
    std::array<double, sequences> means{};
    for (std::uint32_t i = 0; i < sequences; ++i) {
        CpuKernel kernel = shared_kernel;
        kernel.frame.seed = kernel_hash_combine(kernel.frame.seed, pilot_seed + i);  // independent of the picture and each other
        for (int sample = 0; sample < paths_a_sequence; ++sample) {
            const PilotPath path = follow_pilot(kernel, scene, x, y, sample);
            costs.rays += path.rays_before;
            costs.branch_rays += path.branch_rays / branches_a_path;
            costs.branch_variance += path.branch_variance();
            means[i] += path.all() / paths_a_sequence;
        }
    }
    constexpr double paths = sequences * paths_a_sequence;
    const double difference = means[0] - means[1];
    costs.mean = 0.5 * (means[0] + means[1]);
    costs.branch_variance /= paths;
    costs.variance = 0.5 * difference * difference * paths_a_sequence;
    return costs;
}

}  // namespace

Branching choose_branching(const CpuKernel& shared_kernel, const EmbreeScene& scene) {
    const auto start = std::chrono::steady_clock::now();
    CpuKernel kernel = shared_kernel;
    kernel.frame.branch_bits = branch_bits;
    kernel.frame.tile_bits = 0;
    kernel.frame.sample_streams = 1;
    constexpr std::uint32_t most_pixels = 128, pixels_a_pilot_pixel = 64;  // a part of a sample a pixel
    const std::uint32_t pixels = kernel.frame.width * kernel.frame.height;
    std::vector<Costs> each(std::clamp(pixels / pixels_a_pilot_pixel, 1u, most_pixels));
    tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
        each[i] = pilot_pixel(kernel, scene, static_cast<std::uint32_t>(i));
    });
    Costs sum;
    for (const Costs& costs : each) sum.mean += costs.mean / static_cast<double>(each.size());
    for (const Costs& costs : each) {
        const double least = darkest * sum.mean, scale = 1 / std::max(costs.mean * costs.mean + least * least, 1e-30);
        sum.branch_variance += std::min(costs.branch_variance * scale, most_variance);
        sum.variance += std::min(costs.variance * scale, most_variance);
        sum.branch_rays += costs.branch_rays;
        sum.rays += costs.rays;
    }
    Branching branching;
    branching.rays = static_cast<std::uint64_t>(std::llround(sum.rays + branches_a_path * sum.branch_rays));
    // Variance R + B/n at the cost r + n b is least at n² = B r / (R b) (Bolin & Meyer 1997, "An Error Metric for Monte Carlo
    // Ray Tracing").
    const double rest = std::max(sum.variance - sum.branch_variance / branches_a_path, 0.0);
    const double gain = sum.branch_variance * sum.rays, price = rest * sum.branch_rays;
    if (gain > 0)
        while (branching.bits < branch_bits && gain > price * std::exp2(2 * branching.bits + 1)) ++branching.bits;
    branching.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return branching;
}

}  // namespace heliodon::trace
