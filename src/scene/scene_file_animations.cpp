#include <fmt/format.h>

#include <array>

#include "scene/scene_file_parts.h"

namespace heliodon::scene_file {
namespace {

enum class Form { number, vector, number_or_vector, boolean, euler_deg, moment };

/// What a scene file calls an animated value, and how it writes it.
struct AnimatedKey {
    std::string_view table;  ///< nodes, cameras or materials
    std::string_view key;
    AnimatedProperty property;
    Form form;
    Range range = any_number;
    bool degrees = false;
};

using enum AnimatedProperty;
constexpr Range cone_deg{.low = 0, .high = 90};
constexpr Range field_of_view_deg{.low = 0, .high = 180, .low_excluded = true, .high_excluded = true};
constexpr std::array animated_keys{
    AnimatedKey{"nodes", "translate", node_translation, Form::vector},
    AnimatedKey{"nodes", "rotate_deg", node_rotation, Form::euler_deg},
    AnimatedKey{"nodes", "scale", node_scale, Form::number_or_vector, not_zero},
    AnimatedKey{"nodes", "visible", node_visible, Form::boolean},
    AnimatedKey{"nodes", "light.intensity_cd", light_intensity, Form::number_or_vector, not_negative},
    AnimatedKey{"nodes", "light.illuminance_lux", light_intensity, Form::number_or_vector, not_negative},
    AnimatedKey{"nodes", "light.inner_deg", light_inner_rad, Form::number, cone_deg, true},
    AnimatedKey{"nodes", "light.outer_deg", light_outer_rad, Form::number, cone_deg, true},
    AnimatedKey{"nodes", "light.radius_m", light_radius_m, Form::number, not_negative},
    AnimatedKey{"nodes", "light.direction", light_direction, Form::vector},
    AnimatedKey{"cameras", "position", camera_position, Form::vector},
    AnimatedKey{"cameras", "target", camera_target, Form::vector},
    AnimatedKey{"cameras", "vertical_fov_deg", camera_vertical_fov_rad, Form::number, field_of_view_deg, true},
    AnimatedKey{"cameras", "ev100", camera_ev100, Form::number},
    AnimatedKey{"materials", "base_color", material_base_color, Form::vector, unit_interval},
    AnimatedKey{"materials", "opacity", material_opacity, Form::number, unit_interval},
    AnimatedKey{"materials", "metallic", material_metallic, Form::number, unit_interval},
    AnimatedKey{"materials", "roughness", material_roughness, Form::number, unit_interval},
    AnimatedKey{"materials", "emission_nits", material_emission_nits, Form::number_or_vector, not_negative},
    AnimatedKey{"materials", "transmission", material_transmission, Form::number, unit_interval},
    AnimatedKey{"materials", "ior", material_ior, Form::number, Range{.low = 1}},
    AnimatedKey{"sky", "luminance_nits", sky_luminance_nits, Form::number_or_vector, not_negative},
    AnimatedKey{"sky", "time", sky_time, Form::moment},
};

/// The name between "table." and ".key" of `target`; empty where that is not its form.
std::string_view name_in(std::string_view target, const AnimatedKey& key) {
    const std::string before = fmt::format("{}.", key.table), after = fmt::format(".{}", key.key);
    if (target.size() <= before.size() + after.size()) return {};
    if (!target.starts_with(before) || !target.ends_with(after)) return {};
    return target.substr(before.size(), target.size() - before.size() - after.size());
}

void check_light_key(const JsonCursor& target, const AnimatedKey& key, const Light& light) {
    const bool directional = light.type == LightType::directional, spot = light.type == LightType::spot;
    const bool wrong =
        (key.key == "light.intensity_cd" && directional) || (key.key == "light.illuminance_lux" && !directional) ||
        (key.property == light_direction && !directional) || (key.property == light_radius_m && directional) ||
        ((key.property == light_inner_rad || key.property == light_outer_rad) && !spot);
    if (wrong) target.refuse("a value that the light's type has");
}

/// Sets the target of `channel` when `name` is one of `scene`'s; false otherwise.
bool resolve(const JsonCursor& target, const AnimatedKey& key, std::string_view name, const Scene& scene,
             AnimationChannel& channel) {
    channel.property = key.property;
    if (key.table == "cameras") {
        const CameraId id = scene.find_camera(name);
        channel.target = id;
        return static_cast<bool>(id);
    }
    if (key.table == "materials") {
        const MaterialId id = scene.find_material(name);
        channel.target = id;
        return static_cast<bool>(id);
    }
    const NodeId id = scene.find_node(name);
    channel.target = id;
    if (!id || !key.key.starts_with("light.")) return static_cast<bool>(id);
    const Node* node = scene.nodes().find(id);
    if (!node->light) return false;
    check_light_key(target, key, *node->light);
    return true;
}

const AnimatedKey& read_target(const JsonCursor& target, const Scene& scene, AnimationChannel& channel) {
    const std::string text = target.string();
    bool known_form = false;
    for (const AnimatedKey& key : animated_keys) {
        if (key.table == "sky" && text == fmt::format("sky.{}", key.key)) {
            if (key.property == sky_time && !scene.sky().place)
                target.refuse("a sky with latitude_deg and longitude_deg where its time moves");
            channel.property = key.property;
            return key;
        }
        const std::string_view name = name_in(text, key);
        if (name.empty()) continue;
        known_form = true;
        if (resolve(target, key, name, scene, channel)) return key;
    }
    target.refuse(known_form
                      ? "the name of something in the scene that has this value"
                      : "nodes.NAME.…, cameras.NAME.…, materials.NAME.…, sky.luminance_nits or sky.time with an animated value");
}

Interpolation read_interpolation(ObjectReader& object, const AnimatedKey& key) {
    const auto interpolation = object.find("interpolation");
    if (key.form == Form::boolean) {
        if (interpolation) (void)interpolation->one_of<bool>({{"step", true}});
        return Interpolation::step;
    }
    if (!interpolation) return Interpolation::linear;
    // Tangents of Euler angles are no tangents of a rotation; moments have none.
    if (key.form == Form::euler_deg || key.form == Form::moment)
        return interpolation->one_of<Interpolation>({{"step", Interpolation::step}, {"linear", Interpolation::linear}});
    return interpolation->one_of<Interpolation>(
        {{"step", Interpolation::step}, {"linear", Interpolation::linear}, {"cubic", Interpolation::cubic}});
}

std::vector<float> read_times(const JsonCursor& cursor) {
    std::vector<float> times;
    for (const JsonCursor& element : cursor.elements()) {
        times.push_back(element.number());
        if (times.size() > 1 && times.back() <= times[times.size() - 2])
            element.refuse(fmt::format("a time after {} s", times[times.size() - 2]));
    }
    if (times.empty()) cursor.refuse("a list of at least 1 time");
    return times;
}

void append_vector(std::vector<float>& values, glm::vec3 vector) {
    values.insert(values.end(), {vector.x, vector.y, vector.z});
}

/// Moments become seconds after the first of them.
void append_moment(AnimationChannel& channel, const JsonCursor& cursor) {
    const auto moment = parse_civil_time(cursor.name());
    if (!moment) throw Refusal{cursor.path(), moment.error().message};
    if (channel.values.empty()) channel.origin = *moment;
    channel.values.push_back(static_cast<float>(moment->unix_s - channel.origin.unix_s));
}

void append_value(AnimationChannel& channel, const JsonCursor& cursor, const AnimatedKey& key, const Range& range) {
    std::vector<float>& values = channel.values;
    switch (key.form) {
        case Form::moment:
            append_moment(channel, cursor);
            break;
        case Form::number: {
            const float number = cursor.number(range);
            values.push_back(key.degrees ? glm::radians(number) : number);
            break;
        }
        case Form::vector:
            append_vector(values, cursor.vector(range));
            break;
        case Form::number_or_vector:
            append_vector(values, cursor.number_or_vector(range));
            break;
        case Form::boolean:
            values.push_back(cursor.boolean() ? 1.0f : 0.0f);
            break;
        case Form::euler_deg: {
            const glm::quat rotation = rotation_from_euler_deg(cursor.vector());
            values.insert(values.end(), {rotation.x, rotation.y, rotation.z, rotation.w});
            break;
        }
    }
}

AnimationChannel read_channel(const JsonCursor& cursor, const Scene& scene) {
    ObjectReader object(cursor);
    AnimationChannel channel;
    const AnimatedKey key = read_target(object.require("target"), scene, channel);
    channel.interpolation = read_interpolation(object, key);
    channel.times_s = read_times(object.require("times_s"));
    const JsonCursor values = object.require("values");
    const bool cubic = channel.interpolation == Interpolation::cubic;
    const std::size_t expected = channel.times_s.size() * (cubic ? 3 : 1);
    const std::vector<JsonCursor> elements = values.elements();
    if (elements.size() != expected) values.refuse(fmt::format("a list of {}", expected));
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const bool tangent = cubic && i % 3 != 1;
        append_value(channel, elements[i], key, tangent ? any_number : key.range);
    }
    object.finish();
    return channel;
}

}  // namespace

Animation read_animation(const JsonCursor& cursor, const Scene& scene) {
    ObjectReader object(cursor);
    Animation animation;
    animation.name = object.require("name").name();
    for (const JsonCursor& channel : object.require("channels").elements())
        animation.channels.push_back(read_channel(channel, scene));
    object.finish();
    return animation;
}

}  // namespace heliodon::scene_file
