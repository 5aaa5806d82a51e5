#include "convert/pack_luminaire.h"

#include <algorithm>
#include <cmath>

#include "shading/sampling.h"

namespace heliodon::convert {
namespace {

glm::vec3 unit_or(const glm::vec3& vector, const glm::vec3& fallback) {
    const float length = glm::length(vector);
    return length > 0.0f && std::isfinite(length) ? vector / length : fallback;
}

/// The luminaire's axes (0: C0, 1: up, 2: C270) that are the table's x, y and z, signs aside.
glm::ivec3 table_axes(PhotometricWeb::Axis axis) {
    return axis == PhotometricWeb::Axis::vertical ? glm::ivec3(0, 2, 1) : glm::ivec3(1, 2, 0);
}

std::uint32_t opening_code(const LuminousOpening& opening, glm::ivec3 axes) {
    switch (opening.shape) {
        case OpeningShape::point:
        case OpeningShape::box:
            return shading::opening_box;
        case OpeningShape::ellipsoid:
            return shading::opening_ellipsoid;
        default: {
            const int along = static_cast<int>(opening.shape) - static_cast<int>(OpeningShape::cylinder_x);
            return along == axes.x   ? shading::opening_cylinder_x
                   : along == axes.y ? shading::opening_cylinder_y
                                     : shading::opening_cylinder_z;
        }
    }
}

}  // namespace

std::uint32_t LuminaireTables::place(const std::shared_ptr<const Luminaire>& luminaire) {
    const auto [known, is_new] = places_.try_emplace(luminaire, static_cast<std::uint32_t>(values_.size()));
    if (!is_new) return known->second;
    const PhotometricWeb& web = luminaire->web;
    values_.reserve(values_.size() + 2 + web.polar_rad.size() + web.azimuth_rad.size() + web.candela.size());
    values_.push_back(static_cast<float>(web.polar_rad.size()));
    values_.push_back(static_cast<float>(web.azimuth_rad.size()));
    for (const double angle : web.polar_rad) values_.push_back(static_cast<float>(angle));
    for (const double angle : web.azimuth_rad) values_.push_back(static_cast<float>(angle));
    const double peak = luminaire->peak_cd > 0 ? luminaire->peak_cd : 1;
    for (const double candela : web.candela) values_.push_back(static_cast<float>(candela / peak));
    return known->second;
}

void LuminaireTables::clear() {
    places_.clear();
    values_.clear();
}

shading::LightData pack_luminaire(const Light& light, const glm::mat4& world, std::uint32_t table) {
    const Luminaire& luminaire = *light.luminaire;
    const glm::mat3 linear(world);
    const bool vertical = luminaire.web.axis == PhotometricWeb::Axis::vertical;
    const glm::vec3 nadir(0, -1, 0), polar = vertical ? nadir : glm::vec3(-1, 0, 0);
    const glm::vec3 start = vertical ? glm::vec3(1, 0, 0) : nadir;
    shading::LightData data{};
    data.type = shading::light_type_luminaire;
    data.shadow = shading::no_texture;
    data.position = glm::vec3(world[3]);
    data.axis = unit_or(linear * polar, polar);
    const glm::vec3 turned = linear * start;
    data.tangent = unit_or(turned - data.axis * glm::dot(data.axis, turned), shading::frame_from_normal(data.axis).tangent);
    const float tilt = std::acos(std::clamp(glm::dot(unit_or(linear * nadir, nadir), nadir), -1.0f, 1.0f));
    data.intensity = light.intensity * static_cast<float>(luminaire.factor_at_tilt(tilt));
    data.flux_factor = static_cast<float>(flux_per_candela(light));
    data.table = table;
    const glm::ivec3 axes = table_axes(luminaire.web.axis);
    const bool extended = luminaire.opening.shape != OpeningShape::point;
    const glm::vec3 half = extended ? 0.5f * luminaire.opening.size_m : glm::vec3(0);
    data.half_extent = glm::vec3(half[axes.x], half[axes.y], half[axes.z]);
    data.radius = glm::length(half);
    data.opening = opening_code(luminaire.opening, axes);
    if (glm::determinant(linear) < 0) data.opening |= shading::opening_mirrored;
    return data;
}

}  // namespace heliodon::convert
