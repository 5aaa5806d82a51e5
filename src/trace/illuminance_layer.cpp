#include "trace/illuminance_layer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <optional>

namespace heliodon::trace {
namespace {

struct Receiver {
    vec3 position, normal;
    bool front = true;
};

/// Where a camera's path first meets something that is no pane or veil.
std::optional<Receiver> first_surface(CpuKernel& kernel, const EmbreeScene& scene, shading::PathState path,
                                     PathCounts& counts) {
    for (uint pass = 0; pass < kernel_most_passes; ++pass) {
        const KernelHit hit = scene.trace(kernel.path_next_ray(path));
        ++counts.rays;
        if (hit.kind != kernel_hit_surface) return std::nullopt;
        const KernelPoint point = kernel.kernel_point(hit);
        const MaterialData& material = kernel.fetch_material(point.material);
        const bool blended = (material.flags & material_flag_alpha_blend) != 0 || material.model == material_model_thin;
        if (blended || kernel.material_opacity_at(material, point.texcoord0, point.texcoord1, point.color.w) <= 0) {
            path.origin = kernel.kernel_offset(point.position, point.error, point.geometric_normal, path.direction);
            continue;
        }
        const bool front = glm::dot(path.direction, point.geometric_normal) < 0;
        const vec3 geometric = front ? point.geometric_normal : -point.geometric_normal;
        const vec3 mapped = kernel.kernel_mapped_normal(hit, point, material);
        const vec3 normal = usable_shading_normal(front ? mapped : -mapped, geometric, -path.direction);
        return Receiver{kernel.kernel_offset(point.position, point.error, geometric, geometric), normal,
                        front || (material.flags & material_flag_two_sided) != 0};
    }
    return std::nullopt;
}

}  // namespace

IlluminanceLayer::IlluminanceLayer(int width, int height)
    : width_(width), height_(height), sums_(static_cast<std::size_t>(width) * height) {}

PathCounts IlluminanceLayer::add_samples(const CpuKernel& shared_kernel, const EmbreeScene& scene, int end) {
    std::atomic<std::uint64_t> rays = 0, non_finite = 0;
    tbb::parallel_for(0, height_, [&](int y) {
        CpuKernel camera = shared_kernel, sensor = shared_kernel;
        sensor.frame.branch_bits = 0;
        PathCounts counts;
        for (int x = 0; x < width_; ++x) {
            const auto pixel = static_cast<uint>(y * width_ + x);
            Sum& sum = sums_[pixel];
            for (int i = done_; i < end; ++i) {
                const auto receiver = first_surface(camera, scene, camera.path_begin(x, y, i), counts);
                if (!receiver) continue;
                ++sum.hits;
                if (!receiver->front) continue;
                shading::PathState path =
                    sensor.path_begin_illuminance(pixel, static_cast<uint>(i), receiver->position, receiver->normal);
                sum.lux += follow_path(sensor, scene, path, counts).radiance;
            }
        }
        rays += counts.rays;
        non_finite += counts.non_finite;
    });
    done_ = std::max(done_, end);
    return {rays, non_finite};
}

Image IlluminanceLayer::image() const {
    Image image(width_, height_, 3);
    for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel)
        for (int c = 0; c < 3; ++c)
            image.pixels[3 * pixel + c] = static_cast<float>(sums_[pixel].lux[c] / std::max(1, sums_[pixel].hits));
    return image;
}

}  // namespace heliodon::trace
