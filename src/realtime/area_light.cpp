#include "realtime/area_light.h"

#include <cmath>

#include "shading/daylight.h"
#include "shading/light.h"
#include "shading/luminaire_shape.h"
#include "shading/sampling.h"

namespace heliodon::realtime {

namespace {

shading::LightData point_of_luminaire(shading::LightData light, glm::vec2 u) {
    const shading::OpeningPoint point =
        shading::opening_surface_point(light.opening & shading::opening_shape_bits, light.half_extent, light.face_weights, u);
    // Openings are symmetric: it is the same whichever way azimuths run.
    const glm::mat3 to_world(light.tangent, glm::cross(light.tangent, light.axis), light.axis);
    light.position += to_world * point.position;
    light.weighted_normal = to_world * point.weighted_normal;
    return light;
}

}  // namespace

shading::LightData center_of_area_light(shading::LightData light) {
    if (light.opening == shading::opening_sun && light.radius > 0) {
        // Of a setting sun that of what is above the horizon.
        const glm::vec2 across = glm::vec2(light.axis.x, light.axis.z);
        const double elevation = std::atan2(-light.axis.y, glm::length(across));
        const shading::DiscAbove above = shading::disc_above(elevation, light.radius);
        if (above.share < 1) {
            const glm::vec2 level = static_cast<float>(std::cos(above.elevation)) * glm::normalize(across);
            light.axis = {level.x, static_cast<float>(-std::sin(above.elevation)), level.y};
            light.intensity *= static_cast<float>(above.share);
        }
    }
    light.radius = 0;
    return light;
}

shading::LightData point_of_area_light(const shading::LightData& light, glm::vec2 u) {
    if (light.radius <= 0) return light;
    shading::LightData point = light;
    point.radius = 0;
    if (light.type == shading::light_type_directional) {
        const float half = std::sin(0.5f * light.radius);
        const float one_minus_cos = 2 * half * half;
        const glm::vec3 local = shading::sample_cone(u, one_minus_cos);
        point.axis = glm::normalize(shading::to_world(shading::frame_from_normal(light.axis), local));
        // The disc's radiance E/(π sin² α) times its solid angle 2π(1 − cos α) is 2E/(1 + cos α).
        point.intensity = light.intensity * (2.0f / (2.0f - one_minus_cos));
        const float sine = std::sin(light.radius);
        if (light.opening == shading::opening_sun)
            point.intensity *= point.axis.y > 0 ? 0 : shading::limb_darkening((local.x * local.x + local.y * local.y) / (sine * sine));
        return point;
    }
    if (light.type == shading::light_type_point) {
        const glm::vec3 normal = shading::sample_uniform_sphere(u);
        point.position = light.position + light.radius * normal;
        // A sphere's radiance I/(πr²) over its area 4πr², by the cosine at the point.
        point.type = shading::light_type_lambertian;
        point.axis = normal;
        point.intensity = light.intensity * 4.0f;
        return point;
    }
    if (light.type == shading::light_type_luminaire) return point_of_luminaire(point, u);
    const glm::vec3 local = shading::sample_cosine_hemisphere(u);
    point.position = light.position + light.radius * shading::to_world(shading::frame_from_normal(light.axis), local);
    return point;
}

}  // namespace heliodon::realtime
