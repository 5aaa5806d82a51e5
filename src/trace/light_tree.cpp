#include "trace/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace heliodon::trace {
namespace {

using shading::KernelLightNode;

constexpr double pi = std::numbers::pi;

/// The smallest cone round two (Pharr, Jakob & Humphreys 2023, section 3.8.4).
void join_cones(LightBounds& a, const LightBounds& b) {
    const double apart = std::acos(std::clamp<double>(glm::dot(a.axis, b.axis), -1, 1));
    if (std::min(apart + b.normals_rad, pi) <= a.normals_rad) return;
    if (std::min(apart + a.normals_rad, pi) <= b.normals_rad) {
        a.axis = b.axis;
        a.normals_rad = b.normals_rad;
        return;
    }
    const double half = (a.normals_rad + apart + b.normals_rad) / 2;
    const glm::dvec3 pole = glm::cross(glm::dvec3(a.axis), glm::dvec3(b.axis));
    if (half >= pi || !(glm::dot(pole, pole) > 0)) {
        a.normals_rad = pi;
        return;
    }
    // The axis turned towards b's: both axes lie in the plane of the turn.
    const glm::dvec3 sideways = glm::cross(glm::normalize(pole), glm::dvec3(a.axis));
    const double turn = half - a.normals_rad;
    a.axis = glm::vec3(glm::normalize(glm::dvec3(a.axis) * std::cos(turn) + sideways * std::sin(turn)));
    a.normals_rad = half;
}

LightBounds joined(LightBounds a, const LightBounds& b) {
    if (!(a.intensity_cd > 0)) return b;
    if (!(b.intensity_cd > 0)) return a;
    join_cones(a, b);
    a.box.include(b.box);
    a.emission_rad = std::max(a.emission_rad, b.emission_rad);
    a.intensity_cd += b.intensity_cd;
    a.two_sided = a.two_sided || b.two_sided;
    return a;
}

/// Expected cost of a node, up to a factor: intensity × area × solid angle of emission (Conty Estevez & Kulla 2018, eq.
/// 1 and section 4.4), with their factor against thin boxes, longest side over the side that is split.
double cost(const LightBounds& bounds, const glm::vec3& parent_extent, int axis) {
    const auto area_of = [](const glm::dvec3& e) { return e.x * e.y + e.y * e.z + e.z * e.x; };
    const glm::dvec3 e = bounds.box.max - bounds.box.min;
    // Lights in a row have no area: then what counts is how far they spread.
    const double area = area_of(parent_extent) > 0 ? area_of(e) : e.x + e.y + e.z;
    const double o = bounds.normals_rad, w = std::min(o + bounds.emission_rad, pi);
    const double angle = 2 * pi * (1 - std::cos(o)) +
                         pi / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
    const double regular = std::max({parent_extent.x, parent_extent.y, parent_extent.z}) / parent_extent[axis];
    return bounds.intensity_cd * area * angle * regular;
}

class Builder {
public:
    Builder(std::span<const LightBounds> lights, std::span<const std::uint32_t> emitters,
            std::vector<std::uint32_t>& leaf_of)
        : lights_(lights), emitters_(emitters), leaf_of_(leaf_of), order_(lights.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        leaf_of_.assign(lights.size(), 0);
        nodes_.reserve(2 * lights.size());
        nodes_.emplace_back();
        build(0, order_);
    }
    [[nodiscard]] std::vector<KernelLightNode> take() { return std::move(nodes_); }

private:
    void build(std::uint32_t index, std::span<std::uint32_t> part) {
        LightBounds bounds;
        for (const std::uint32_t light : part) bounds = joined(bounds, lights_[light]);
        const std::uint32_t parent = nodes_[index].parent;
        nodes_[index] = node_of(bounds);
        nodes_[index].parent = parent;
        if (part.size() == 1) {
            nodes_[index].flags |= shading::kernel_light_node_leaf;
            nodes_[index].child = emitters_[part[0]];
            leaf_of_[part[0]] = index;
            return;
        }
        const std::size_t middle = split(part);
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        nodes_[index].child = first;
        nodes_.resize(nodes_.size() + 2);
        nodes_[first].parent = nodes_[first + 1].parent = index;
        build(first, part.first(middle));
        build(first + 1, part.subspan(middle));
    }

    static KernelLightNode node_of(const LightBounds& bounds) {
        // Rounding must not make bounds say that nothing is lit where something is.
        constexpr double slack_rad = 1e-3;
        KernelLightNode node{};
        node.bounds_min = bounds.box.min;
        node.bounds_max = bounds.box.max;
        node.axis = bounds.axis;
        node.cos_normals = static_cast<float>(std::cos(std::min(bounds.normals_rad, pi)));
        node.cos_emission = static_cast<float>(std::cos(std::min(bounds.emission_rad + slack_rad, pi)));
        node.intensity = static_cast<float>(bounds.intensity_cd);
        node.flags = bounds.two_sided ? shading::kernel_light_node_two_sided : 0u;
        return node;
    }

    /// Orders `part` so that its first lights make the first child; tells how many.
    std::size_t split(std::span<std::uint32_t> part) const {
        constexpr int bucket_count = 12;
        Bounds centers, boxes;
        for (const std::uint32_t light : part) {
            centers.include(lights_[light].box.center());
            boxes.include(lights_[light].box);
        }
        const glm::vec3 extent = centers.max - centers.min;
        double best = std::numeric_limits<double>::infinity();
        int best_axis = -1, best_bucket = 0;
        const auto bucket = [&](std::uint32_t light, int axis) {
            const float t = (lights_[light].box.center()[axis] - centers.min[axis]) / extent[axis];
            return std::clamp(static_cast<int>(t * bucket_count), 0, bucket_count - 1);
        };
        for (int axis = 0; axis < 3; ++axis) {
            if (!(extent[axis] > 0)) continue;
            std::array<LightBounds, bucket_count> buckets{}, above{};
            for (const std::uint32_t light : part) {
                LightBounds& into = buckets[bucket(light, axis)];
                into = joined(into, lights_[light]);
            }
            for (int i = bucket_count - 2; i >= 0; --i) above[i] = joined(above[i + 1], buckets[i + 1]);
            LightBounds below;
            for (int i = 0; i + 1 < bucket_count; ++i) {
                below = joined(below, buckets[i]);
                if (!(below.intensity_cd > 0) || !(above[i].intensity_cd > 0)) continue;
                const glm::vec3 whole = boxes.extent();
                const double value = cost(below, whole, axis) + cost(above[i], whole, axis);
                if (value < best) {
                    best = value;
                    best_axis = axis;
                    best_bucket = i;
                }
            }
        }
        if (best_axis < 0) return part.size() / 2;  // all in one place
        const auto middle = std::partition(
            part.begin(), part.end(), [&](std::uint32_t light) { return bucket(light, best_axis) <= best_bucket; });
        return static_cast<std::size_t>(middle - part.begin());
    }

    std::span<const LightBounds> lights_;
    std::span<const std::uint32_t> emitters_;
    std::vector<std::uint32_t>& leaf_of_;
    std::vector<std::uint32_t> order_;
    std::vector<KernelLightNode> nodes_;
};

}  // namespace

std::vector<KernelLightNode> build_light_tree(std::span<const LightBounds> lights,
                                              std::span<const std::uint32_t> emitters,
                                              std::vector<std::uint32_t>& leaf_of) {
    leaf_of.clear();
    if (lights.empty()) return {};
    return Builder(lights, emitters, leaf_of).take();
}

}  // namespace heliodon::trace
