#include "convert/pack_luminaire.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shading/luminaire_shape.h"

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

std::uint32_t opening_code(const Luminaire& luminaire) {
    const OpeningShape shape = luminaire.opening.shape;
    if (shape == OpeningShape::point || shape == OpeningShape::box) return shading::opening_box;
    if (shape == OpeningShape::ellipsoid) return shading::opening_ellipsoid;
    const glm::ivec3 axes = table_axes(luminaire.web.axis);
    const int along = static_cast<int>(shape) - static_cast<int>(OpeningShape::cylinder_x);
    return along == axes.x   ? shading::opening_cylinder_x
           : along == axes.y ? shading::opening_cylinder_y
                             : shading::opening_cylinder_z;
}

glm::vec3 table_half_extent(const Luminaire& luminaire) {
    if (luminaire.opening.shape == OpeningShape::point) return glm::vec3(0);
    const glm::ivec3 axes = table_axes(luminaire.web.axis);
    const glm::vec3 half = 0.5f * luminaire.opening.size_m;
    return {half[axes.x], half[axes.y], half[axes.z]};
}

/// Calls `visit(direction, flux)` for pieces of the web, in its table's axes.
template <class Visit>
void each_piece(const PhotometricWeb& web, Visit&& visit) {
    constexpr std::size_t sectors = 24;  // where all azimuths are alike
    const bool even = web.azimuth_rad.size() == 1;
    for (std::size_t a = 0; a + 1 < (even ? sectors + 1 : web.azimuth_rad.size()); ++a)
        for (std::size_t p = 0; p + 1 < web.polar_rad.size(); ++p) {
            const std::size_t first = even ? 0 : a, second = even ? 0 : a + 1;
            const double width = even ? 2 * std::numbers::pi / sectors : web.azimuth_rad[a + 1] - web.azimuth_rad[a];
            const double azimuth = even ? (double(a) + 0.5) * width : web.azimuth_rad[a] + 0.5 * width;
            const double polar = 0.5 * (web.polar_rad[p] + web.polar_rad[p + 1]);
            const double candela =
                0.25 * (web.at(first, p) + web.at(first, p + 1) + web.at(second, p) + web.at(second, p + 1));
            const double solid_angle = width * (std::cos(web.polar_rad[p]) - std::cos(web.polar_rad[p + 1]));
            visit(glm::vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)),
                  candela * solid_angle);
        }
}

/// A face's share of what goes towards ω is that of the opening's outline. Every face has the least weight at least.
std::uint32_t face_weights(const Luminaire& luminaire) {
    const std::uint32_t shape = opening_code(luminaire);
    const glm::vec3 half = table_half_extent(luminaire), h = shading::opening_turn(shape, half);
    const bool box = shape == shading::opening_box;
    const glm::vec3 areas = box ? 4.0f * glm::vec3(h.y * h.z, h.x * h.z, h.x * h.y)
                                : glm::vec3(0, 0, static_cast<float>(std::numbers::pi) * h.x * h.y);
    std::array<double, 6> flux{};
    each_piece(luminaire.web, [&](glm::vec3 direction, double lumen) {
        const float outline = shading::opening_projected_area(shape, half, direction);
        if (!(outline > 0)) return;
        const glm::vec3 seen = areas * shading::opening_turn(shape, direction) / outline;
        for (int axis = 0; axis < 3; ++axis)
            flux[static_cast<std::size_t>(2 * axis + (seen[axis] < 0))] += std::abs(seen[axis]) * lumen;
        if (!box) flux[0] += (1 - std::abs(seen.z)) * lumen;
    });
    constexpr double most = 31;
    const double largest = *std::max_element(flux.begin(), flux.end());
    std::uint32_t weights = 0;
    for (std::size_t face = 0; face < flux.size(); ++face) {
        const float area = box || face >= 4 ? areas[static_cast<int>(face / 2)] : face == 0 ? h.z : 0.0f;
        const double weight =
            area > 0 ? std::clamp(std::ceil(largest > 0 ? most * flux[face] / largest : most), 1.0, most) : 0.0;
        weights |= static_cast<std::uint32_t>(weight) << (5 * face);
    }
    return weights;
}

}  // namespace

LuminaireTables::Place LuminaireTables::place(const std::shared_ptr<const Luminaire>& luminaire) {
    const auto [known, is_new] = places_.try_emplace(luminaire);
    if (!is_new) return known->second;
    known->second = {static_cast<std::uint32_t>(values_.size()), face_weights(*luminaire)};
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

shading::LightData pack_luminaire(const Light& light, const glm::mat4& world, const LuminaireTables::Place& place) {
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
    data.tangent =
        unit_or(turned - data.axis * glm::dot(data.axis, turned), shading::frame_from_normal(data.axis).tangent);
    const float tilt = std::acos(std::clamp(glm::dot(unit_or(linear * nadir, nadir), nadir), -1.0f, 1.0f));
    data.intensity = light.intensity * static_cast<float>(luminaire.factor_at_tilt(tilt));
    data.flux_factor = static_cast<float>(flux_per_candela(light));
    data.table = place.table;
    data.face_weights = place.face_weights;
    data.half_extent = table_half_extent(luminaire);
    data.radius = glm::length(data.half_extent);
    data.opening = opening_code(luminaire);
    if (glm::determinant(linear) < 0) data.opening |= shading::opening_mirrored;
    return data;
}

}  // namespace heliodon::convert
