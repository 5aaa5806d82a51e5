#include "realtime/shadow_cascades.h"

#include <algorithm>
#include <cmath>

#include "realtime/shadow_plan.h"

namespace heliodon::realtime {
namespace {

// Of a map: how far the camera goes until it is drawn anew, and by how much it is wider than its slice for that.
constexpr double step_share = 1.0 / 32;

std::uint32_t step_texels(std::uint32_t size) { return std::max(1u, static_cast<std::uint32_t>(size * step_share)); }

/// What the width of maps follows from changes by such ratios alone, or every step of the camera would change it.
double rounded_down(double value, int steps_an_octave) { return std::exp2(std::floor(steps_an_octave * std::log2(value)) / steps_an_octave); }
double rounded_up(double value, int steps_an_octave) { return std::exp2(std::ceil(steps_an_octave * std::log2(value)) / steps_an_octave); }
constexpr int depth_steps = 4, angle_steps = 1024;

}  // namespace

ShadowCascades shadow_cascades(const ShadowCascadeSettings& settings, const ShadowDetail& camera) {
    ShadowCascades cascades{.count = settings.count, .blend = settings.blend};
    const glm::dvec3 eye(camera.position), forward(camera.forward), low(camera.low), high(camera.high);
    // A pixel's ray goes anywhere within the pixel.
    const double tan_x = 0.5 * (camera.width + 1) * glm::length(glm::dvec3(camera.ray_dx));
    const double tan_y = 0.5 * (camera.height + 1) * glm::length(glm::dvec3(camera.ray_dy));
    const double tan2 = rounded_up(tan_x * tan_x + tan_y * tan_y, angle_steps);
    const double nearest = glm::distance(eye, glm::clamp(eye, low, high)) / std::sqrt(1 + tan2);
    const double farthest = glm::length(glm::max(glm::abs(low - eye), glm::abs(high - eye)));
    if (!(farthest > camera.near_m)) return cascades;
    const double near = nearest > camera.near_m ? std::max(rounded_down(nearest, depth_steps), double(camera.near_m)) : camera.near_m;
    double far = rounded_up(farthest, depth_steps);
    cascades.reaches_all = settings.distance_m <= 0 || settings.distance_m >= farthest;
    if (!cascades.reaches_all) far = settings.distance_m;
    if (!(far > near)) return cascades;
    double begin = near;
    for (int i = 1; i <= settings.count; ++i) {
        // Zhang, Sun, Xu & Lun 2006, "Parallel-split shadow maps for large-scale virtual environments", eq. 6.
        const double share = double(i) / settings.count;
        const double end = glm::mix(near + (far - near) * share, near * std::pow(far / near, share), double(settings.split));
        // The smallest sphere round a frustum from `near` to `end`: through the corners of both ends, or of the far one.
        const double center = std::min(end, 0.5 * (near + end) * (1 + tan2));
        const double radius = std::hypot(end - center, end * std::sqrt(tan2));
        cascades.slices.push_back({static_cast<float>(begin), static_cast<float>(end), glm::vec3(eye + center * forward), static_cast<float>(radius)});
        begin = end;
    }
    return cascades;
}

double cascade_half_width(const ShadowSlice& slice, float blend, std::uint32_t size) {
    // The slice lies within the border, wherever within a step the centre is, and taps beside it within the map.
    const double within = std::min(1.0 - double(blend), 1 - 2 * shadow_guard_texels / size);
    return slice.radius / std::max(within - double(step_texels(size)) / size, 0.25);
}

glm::dvec2 snapped_center(glm::dvec2 center, double half_width, std::uint32_t size) {
    const double step = 2 * half_width / size * step_texels(size);
    return glm::floor(center / step + 0.5) * step;
}

}  // namespace heliodon::realtime
