#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/scene.h"
#include "scene/time_of_day.h"

namespace heliodon {
namespace {

/// Where a time falls among the keys: between `key` and `key + 1` at `fraction` of the way, `span_s` apart.
struct KeyInterval {
    std::size_t key = 0;
    float fraction = 0;
    float span_s = 0;
};

KeyInterval find_interval(std::span<const float> times_s, double time_s) {
    if (time_s <= times_s.front()) return {};
    if (time_s >= times_s.back()) return {times_s.size() - 1, 0, 0};
    const auto next = std::upper_bound(times_s.begin(), times_s.end(), time_s);
    const std::size_t key = static_cast<std::size_t>(next - times_s.begin()) - 1;
    const double span = static_cast<double>(times_s[key + 1]) - times_s[key];
    return {key, static_cast<float>((time_s - times_s[key]) / span), static_cast<float>(span)};
}

glm::vec4 normalized(glm::vec4 quaternion) {
    const float length = glm::length(quaternion);
    return length > 0 ? quaternion / length : glm::vec4(0, 0, 0, 1);
}

glm::vec4 slerp(glm::vec4 a, glm::vec4 b, float fraction) {
    const glm::quat result = glm::slerp(glm::quat(a.w, a.x, a.y, a.z), glm::quat(b.w, b.x, b.y, b.z), fraction);
    return {result.x, result.y, result.z, result.w};
}

/// The channel's values, `components` floats each.
class Keys {
public:
    explicit Keys(const AnimationChannel& channel)
        : channel_(channel),
          components_(static_cast<std::size_t>(component_count(channel.property))),
          per_key_(channel.interpolation == Interpolation::cubic ? 3 : 1) {}

    [[nodiscard]] bool complete() const {
        return !channel_.times_s.empty() && channel_.values.size() == channel_.times_s.size() * per_key_ * components_;
    }
    [[nodiscard]] glm::vec4 value_at(double time_s) const {
        const bool rotation = channel_.property == AnimatedProperty::node_rotation;
        const KeyInterval at = find_interval(channel_.times_s, time_s);
        const glm::vec4 value = interpolate(at, rotation);
        return rotation ? normalized(value) : value;
    }

private:
    static constexpr std::size_t in_tangent = 0, cubic_value = 1, out_tangent = 2;

    [[nodiscard]] glm::vec4 read(std::size_t key, std::size_t slot) const {
        glm::vec4 result(0);
        for (std::size_t i = 0; i < components_; ++i)
            result[static_cast<int>(i)] = channel_.values[(key * per_key_ + slot) * components_ + i];
        return result;
    }
    [[nodiscard]] glm::vec4 value(std::size_t key) const { return read(key, per_key_ == 3 ? cubic_value : 0); }

    [[nodiscard]] glm::vec4 interpolate(const KeyInterval& at, bool rotation) const {
        const glm::vec4 from = value(at.key);
        if (at.span_s <= 0 || channel_.interpolation == Interpolation::step) return from;
        const glm::vec4 to = value(at.key + 1);
        const float t = at.fraction;
        if (channel_.interpolation == Interpolation::linear)
            return rotation ? slerp(normalized(from), normalized(to), t) : glm::mix(from, to, t);
        // Cubic Hermite spline (glTF 2.0 specification, appendix C.5).
        const float t2 = t * t, t3 = t2 * t;
        return (2 * t3 - 3 * t2 + 1) * from + at.span_s * (t3 - 2 * t2 + t) * read(at.key, out_tangent) +
               (3 * t2 - 2 * t3) * to + at.span_s * (t3 - t2) * read(at.key + 1, in_tangent);
    }

    const AnimationChannel& channel_;
    std::size_t components_;
    std::size_t per_key_;
};

float unit_interval(float value) {
    return std::clamp(value, 0.0f, 1.0f);
}
glm::vec3 not_negative(glm::vec4 value) {
    return glm::max(glm::vec3(value), glm::vec3(0));
}

}  // namespace

int component_count(AnimatedProperty property) {
    switch (property) {
        case AnimatedProperty::node_rotation:
            return 4;
        case AnimatedProperty::node_translation:
        case AnimatedProperty::node_scale:
        case AnimatedProperty::light_intensity:
        case AnimatedProperty::light_direction:
        case AnimatedProperty::camera_position:
        case AnimatedProperty::camera_target:
        case AnimatedProperty::material_base_color:
        case AnimatedProperty::material_emission_nits:
        case AnimatedProperty::sky_luminance_nits:
            return 3;
        default:
            return 1;
    }
}

void Scene::apply_animations(double time_s) {
    animations_.each([&](AnimationId, const Animation& animation) {
        for (const AnimationChannel& channel : animation.channels) apply(channel, time_s);
    });
}

double Scene::animation_duration_s() const {
    double last = 0;
    animations_.each([&](AnimationId, const Animation& animation) {
        for (const AnimationChannel& channel : animation.channels)
            if (!channel.times_s.empty()) last = std::max(last, static_cast<double>(channel.times_s.back()));
    });
    return last;
}

void Scene::apply(const AnimationChannel& channel, double time_s) {
    const Keys keys(channel);
    if (!keys.complete()) return;
    const glm::vec4 value = keys.value_at(time_s);
    if (channel.property == AnimatedProperty::sky_luminance_nits) {
        apply_to_sky(not_negative(value));
    } else if (channel.property == AnimatedProperty::sky_time) {
        set_sky(sky_at(sky_, {channel.origin.unix_s + value.x, channel.origin.offset_min}));
    } else if (const NodeId* node = std::get_if<NodeId>(&channel.target)) {
        apply_to_node(*node, channel.property, value);
        apply_to_light(*node, channel.property, value);
    } else if (const CameraId* camera = std::get_if<CameraId>(&channel.target)) {
        apply_to_camera(*camera, channel.property, value);
    } else if (const MaterialId* material = std::get_if<MaterialId>(&channel.target)) {
        apply_to_material(*material, channel.property, value);
    }
}

void Scene::apply_to_node(NodeId id, AnimatedProperty property, glm::vec4 value) {
    const Node* node = nodes_.find(id);
    if (!node) return;
    Transform transform = node->transform;
    switch (property) {
        case AnimatedProperty::node_translation:
            transform.translation = value;
            break;
        case AnimatedProperty::node_rotation:
            transform.rotation = glm::quat(value.w, value.x, value.y, value.z);
            break;
        case AnimatedProperty::node_scale:
            transform.scale = value;
            break;
        case AnimatedProperty::node_visible:
            set_visible(id, value.x >= 0.5f);
            return;
        default:
            return;
    }
    set_transform(id, transform);
}

// Cubic curves may overshoot: values come back into the range that a scene file allows.
void Scene::apply_to_light(NodeId id, AnimatedProperty property, glm::vec4 value) {
    const Node* node = nodes_.find(id);
    if (!node || !node->light) return;
    Light light = *node->light;
    constexpr float widest_rad = std::numbers::pi_v<float> / 2;
    const auto set_scalar = [&](float& field, float scalar) { return std::exchange(field, scalar) != scalar; };
    const auto set_vector = [&](glm::vec3& field, glm::vec3 vector) { return std::exchange(field, vector) != vector; };
    bool changed = false;
    switch (property) {
        case AnimatedProperty::light_intensity:
            changed = set_vector(light.intensity, not_negative(value));
            break;
        case AnimatedProperty::light_inner_rad:
            changed = set_scalar(light.inner_rad, std::clamp(value.x, 0.0f, widest_rad));
            light.outer_rad = std::max(light.outer_rad, light.inner_rad);
            break;
        case AnimatedProperty::light_outer_rad:
            changed = set_scalar(light.outer_rad, std::clamp(value.x, light.inner_rad, widest_rad));
            break;
        case AnimatedProperty::light_radius_m:
            changed = set_scalar(light.radius_m, std::max(value.x, 0.0f));
            break;
        case AnimatedProperty::light_direction:
            if (glm::length(glm::vec3(value)) > 0)
                changed = set_vector(light.direction, glm::normalize(glm::vec3(value)));
            break;
        default:
            return;
    }
    if (changed) set_light(id, light);
}

void Scene::apply_to_camera(CameraId id, AnimatedProperty property, glm::vec4 value) {
    const Camera* present = cameras_.find(id);
    if (!present) return;
    Camera camera = *present;
    switch (property) {
        case AnimatedProperty::camera_position:
            camera.position = value;
            break;
        case AnimatedProperty::camera_target:
            camera.target = value;
            break;
        case AnimatedProperty::camera_vertical_fov_rad:
            camera.vertical_fov_rad = value.x;
            break;
        case AnimatedProperty::camera_ev100:
            camera.ev100_override = value.x;
            break;
        default:
            return;
    }
    const bool changed = camera.position != present->position || camera.target != present->target ||
                         camera.vertical_fov_rad != present->vertical_fov_rad ||
                         camera.ev100_override != present->ev100_override;
    if (changed) set_camera(id, std::move(camera));
}

void Scene::apply_to_material(MaterialId id, AnimatedProperty property, glm::vec4 value) {
    const Material* present = materials_.find(id);
    if (!present) return;
    const auto set = [&](auto Material::*field, auto animated) {
        if (present->*field == animated) return;
        Material material = *present;
        material.*field = animated;
        set_material(id, std::move(material));
    };
    switch (property) {
        case AnimatedProperty::material_base_color:
            set(&Material::base_color, glm::clamp(glm::vec3(value), 0.0f, 1.0f));
            break;
        case AnimatedProperty::material_opacity:
            set(&Material::opacity, unit_interval(value.x));
            break;
        case AnimatedProperty::material_metallic:
            set(&Material::metallic, unit_interval(value.x));
            break;
        case AnimatedProperty::material_roughness:
            set(&Material::roughness, unit_interval(value.x));
            break;
        case AnimatedProperty::material_emission_nits:
            set(&Material::emission_nits, not_negative(value));
            break;
        case AnimatedProperty::material_transmission:
            set(&Material::transmission, unit_interval(value.x));
            break;
        case AnimatedProperty::material_ior:
            set(&Material::ior, std::max(value.x, 1.0f));
            break;
        default:
            return;
    }
}

void Scene::apply_to_sky(glm::vec3 luminance_nits) {
    if (sky_.luminance_nits == luminance_nits) return;
    Sky sky = sky_;
    sky.luminance_nits = luminance_nits;
    set_sky(sky);
}

}  // namespace heliodon
