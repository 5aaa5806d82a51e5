#include "convert/pack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/units.h"
#include "shading/cie_sky.h"
#include "shading/daylight.h"
#include "shading/sky.h"
#include "shading/fresnel.h"
#include "shading/metals.h"
#include "shading/quadrature.h"

namespace heliodon::convert {
namespace {

using shading::InstanceData;
using shading::LightData;
using shading::MaterialData;
using shading::TextureRef;

// std430 places these members where C++ does; a vec3 that is not followed by a scalar would break that.
static_assert(sizeof(TextureRef) == 32);
static_assert(offsetof(MaterialData, metallic) == 48 && offsetof(MaterialData, base_color_texture) == 96);
static_assert(offsetof(MaterialData, transmittance) == 96 + 11 * 32 && offsetof(MaterialData, sheen_color) == 96 + 12 * 32);
static_assert(offsetof(MaterialData, anisotropy_axis) == 560 && offsetof(MaterialData, anisotropy_texture) == 592);
static_assert(sizeof(MaterialData) == 592 + 5 * 32);
static_assert(sizeof(LightData) == 112 && offsetof(LightData, intensity) == 32 && offsetof(LightData, weighted_normal) == 96);
static_assert(sizeof(InstanceData) == 144);
static_assert(sizeof(shading::SkyData) == 240 && offsetof(shading::SkyData, sun_direction) == 48 && offsetof(shading::SkyData, daylight) == 80);

TextureRef pack_texture(const Scene& scene, const TextureUse& use) {
    const bool present = scene.textures().contains(use.texture);
    return {glm::vec4(use.uv_matrix[0], use.uv_matrix[1]), use.uv_offset,
            present ? use.texture.index : shading::no_texture, static_cast<std::uint32_t>(use.texcoord)};
}

std::uint32_t pack_flags(const Material& material) {
    std::uint32_t flags = 0;
    if (material.two_sided) flags |= shading::material_flag_two_sided;
    if (material.alpha_mode == AlphaMode::mask) flags |= shading::material_flag_alpha_mask;
    if (material.alpha_mode == AlphaMode::blend) flags |= shading::material_flag_alpha_blend;
    const glm::vec3 emission = material.emission_nits;
    if (std::max({emission.r, emission.g, emission.b}) > 0.0f) flags |= shading::material_flag_emissive;
    // A pane has no other side, and what it does not mirror passes.
    if (material.model == MaterialModel::thin)
        flags = shading::material_flag_two_sided | shading::material_flag_alpha_blend;
    return flags;
}

/// What a pane reflects is a mirror's. Where no angle is known it counts as its mean under an even sky:
/// 2 ∫ τ(c) c dc = Σ 2 kᵢ/(i + 2).
void pack_thin(const Material& material, MaterialData& data) {
    const auto& k = material.transmittance;
    data.transmittance = {k[0], k[1], k[2], k[3]};
    data.transmittance_high = {k[4], k[5]};
    data.reflectance = material.reflectance;
    data.base_color = glm::vec3(1);
    data.metallic = 1;
    data.roughness = data.transmission = data.clearcoat = 0;
    data.emission_nits = glm::vec3(0);
    float mean = 0;
    for (std::size_t i = 0; i < k.size(); ++i) mean += 2 * k[i] / static_cast<float>(i + 2);
    data.opacity = 1 - std::clamp(mean, 0.0f, 1.0f);
}

bool is_transmissive(const Material& material) {
    return material.model == MaterialModel::dielectric ||
           (material.model == MaterialModel::standard && material.transmission > 0.0f);
}

/// 1/m, by Beer & Lambert's law. What is black after the distance is nearly so: 10⁻⁶.
glm::vec3 absorption(const Material& material) {
    if (!is_transmissive(material) || material.thin_walled || !std::isfinite(material.attenuation_distance_m)) return glm::vec3(0);
    return -glm::log(glm::max(material.attenuation_color, glm::vec3(1e-6f))) / material.attenuation_distance_m;
}

/// Metals of this model are the standard model's with another reflectance; its colour is that at normal incidence.
void pack_conductor(const Material& material, MaterialData& data) {
    shading::ConductorIndices indices{material.conductor_eta, material.conductor_k};
    if (material.metal != NamedMetal::none)
        indices = shading::metal_indices(static_cast<shading::Metal>(static_cast<int>(material.metal) - 1));
    static_assert(static_cast<int>(NamedMetal::gold) - 1 == static_cast<int>(shading::Metal::gold) &&
                  static_cast<int>(NamedMetal::chromium) - 1 == static_cast<int>(shading::Metal::chromium));
    data.conductor_eta = indices.eta;
    data.conductor_k = indices.k;
    const shading::GaussLegendre<32> rule;
    for (int c = 0; c < 3; ++c) {
        double average = 0;
        for (std::size_t i = 0; i < rule.x.size(); ++i)
            average += 2 * rule.weight[i] * rule.x[i] * shading::fresnel_conductor(static_cast<float>(rule.x[i]), indices.eta[c], indices.k[c]);
        data.conductor_average[c] = static_cast<float>(average);
        data.base_color[c] = shading::fresnel_conductor(1.0f, indices.eta[c], indices.k[c]);
    }
    data.metallic = 1;
    data.transmission = data.clearcoat = 0;
    data.base_color_texture.texture_index = shading::no_texture;
}

void pack_dielectric(MaterialData& data) {
    data.base_color = data.specular_color = glm::vec3(1);
    data.specular = data.transmission = 1;
    data.metallic = data.clearcoat = 0;
    data.base_color_texture.texture_index = shading::no_texture;
}

void pack_extended(const Scene& scene, const Material& material, MaterialData& data) {
    using enum MaterialModel;
    if (material.model == conductor) pack_conductor(material, data);
    if (material.model == dielectric) pack_dielectric(data);
    if (material.model == disney || material.model == oren_nayar) data.transmission = 0;
    data.anisotropy = material.anisotropy;
    data.anisotropy_axis = {std::cos(material.anisotropy_rotation_rad), std::sin(material.anisotropy_rotation_rad)};
    data.sheen_color = material.sheen_color;
    data.sheen_roughness = material.sheen_roughness;
    data.iridescence = material.iridescence;
    data.film_ior = material.iridescence_ior;
    data.film_thickness_nm = material.iridescence_thickness_nm;
    data.film_thinnest_nm = material.iridescence_thinnest_nm;
    data.absorption = absorption(material);
    data.subsurface = material.subsurface;
    data.specular_tint = material.specular_tint;
    data.sheen = material.sheen;
    data.sheen_tint = material.sheen_tint;
    data.clearcoat_gloss = material.clearcoat_gloss;
    data.sigma = material.sigma_rad.value_or(-1.0f);
    data.anisotropy_texture = pack_texture(scene, material.anisotropy_texture);
    data.sheen_color_texture = pack_texture(scene, material.sheen_color_texture);
    data.sheen_roughness_texture = pack_texture(scene, material.sheen_roughness_texture);
    data.iridescence_texture = pack_texture(scene, material.iridescence_texture);
    data.film_thickness_texture = pack_texture(scene, material.iridescence_thickness_texture);
    const bool sheet = material.thin_walled && is_transmissive(material);
    // A sheet has no inside: both of its sides are alike.
    if (sheet) data.flags |= shading::material_flag_thin_walled | shading::material_flag_two_sided;
    const bool layers = material.model == standard && (material.anisotropy > 0 || material.sheen_color != glm::vec3(0) || material.iridescence > 0);
    if (sheet || layers || material.model == disney || material.model == oren_nayar || material.model == conductor ||
        data.absorption != glm::vec3(0))
        data.flags |= shading::material_flag_extended;
}

glm::vec3 unit_or(const glm::vec3& vector, const glm::vec3& fallback) {
    const float length = glm::length(vector);
    return length > 0.0f && std::isfinite(length) ? vector / length : fallback;
}

}  // namespace

MaterialData pack_material(const Scene& scene, const Material& material) {
    MaterialData data{};
    data.base_color = material.base_color;
    data.opacity = material.opacity;
    data.emission_nits = material.emission_nits;
    data.alpha_cutoff = material.alpha_cutoff;
    data.specular_color = material.specular_color;
    data.specular = material.specular;
    data.metallic = material.metallic;
    data.roughness = material.roughness;
    data.ior = material.ior;
    data.transmission = material.transmission;
    data.clearcoat = material.clearcoat;
    data.clearcoat_roughness = material.clearcoat_roughness;
    data.normal_scale = material.normal_scale;
    data.bump_scale_m = material.bump_scale_m;
    data.occlusion_strength = material.occlusion_strength;
    data.model = static_cast<std::uint32_t>(material.model);
    data.flags = pack_flags(material);
    data.base_color_texture = pack_texture(scene, material.base_color_texture);
    data.orm_texture = pack_texture(scene, material.orm_texture);
    data.occlusion_texture = pack_texture(scene, material.occlusion_texture);
    data.normal_texture = pack_texture(scene, material.normal_texture);
    data.bump_texture = pack_texture(scene, material.bump_texture);
    data.emission_texture = pack_texture(scene, material.emission_texture);
    data.transmission_texture = pack_texture(scene, material.transmission_texture);
    data.specular_texture = pack_texture(scene, material.specular_texture);
    data.specular_color_texture = pack_texture(scene, material.specular_color_texture);
    data.clearcoat_texture = pack_texture(scene, material.clearcoat_texture);
    data.clearcoat_roughness_texture = pack_texture(scene, material.clearcoat_roughness_texture);
    if (material.model == MaterialModel::thin) pack_thin(material, data);
    pack_extended(scene, material, data);
    // The standard model that nothing mirrors, passes or coats is Lambert's, which is the faster to evaluate.
    const bool extended = data.flags & shading::material_flag_extended;
    if (material.model == MaterialModel::standard && !extended && data.specular <= 0 && data.metallic <= 0 && data.transmission <= 0 &&
        data.clearcoat <= 0)
        data.model = shading::material_model_lambert;
    return data;
}

LightData pack_light(const Light& light, const glm::mat4& world) {
    LightData data{};
    const glm::vec3 forward(0.0f, 0.0f, -1.0f);
    const bool directional = light.type == LightType::directional;
    const glm::vec3 local_axis = directional ? unit_or(light.direction, forward) : forward;
    data.position = glm::vec3(world[3]);
    data.axis = unit_or(glm::mat3(world) * local_axis, forward);
    data.radius = directional ? 0.5f * light.angular_diameter_rad : light.radius_m;
    data.intensity = light.intensity;
    data.cos_inner = std::cos(light.inner_rad);
    data.cos_outer = std::cos(light.outer_rad);
    data.shadow = shading::no_texture;
    switch (light.type) {
        case LightType::point: data.type = light.lambertian ? shading::light_type_lambertian : shading::light_type_point; break;
        case LightType::spot: data.type = shading::light_type_spot; break;
        case LightType::directional: data.type = shading::light_type_directional; break;
        case LightType::luminaire: return no_light();  // pack_luminaire's
    }
    return data;
}

LightData no_light() {
    LightData data{};
    data.axis = glm::vec3(0.0f, 0.0f, -1.0f);
    data.type = shading::light_type_none;
    data.shadow = shading::no_texture;
    return data;
}

InstanceData pack_instance(const glm::mat4& world, std::uint32_t geometry, std::uint32_t material, bool visible) {
    InstanceData data{};
    const glm::mat3 linear(world);
    const float determinant = glm::determinant(linear);
    // A node scaled to nothing has no surface and no inverse.
    const bool invertible = determinant != 0.0f && std::isfinite(determinant) && std::isfinite(1.0f / determinant);
    data.object_to_world = world;
    data.normal_to_world = invertible ? glm::mat4(glm::transpose(glm::inverse(linear))) : glm::mat4(1.0f);
    data.geometry = geometry;
    data.material = material;
    if (visible && invertible) data.flags = shading::instance_flag_visible;
    if (visible && world == glm::mat4(1.0f)) data.flags |= shading::instance_flag_in_place;
    data.determinant_sign = determinant < 0.0f ? -1.0f : 1.0f;
    return data;
}

namespace {

std::uint32_t daylight_model(const Sky& sky) {
    return sky.model == SkyModel::hosek ? shading::sky_model_hosek : shading::sky_model_preetham;
}

shading::Sunlight sunlight(const Sky& sky) {
    if (!sky.is_daylight() || !sky.sun_disc) return {};
    return shading::sunlight(daylight_model(sky), sky.turbidity, sky.sun_elevation_rad, sky.sun_angular_diameter_rad);
}

}  // namespace

std::optional<LightData> pack_sun(const Sky& sky) {
    const shading::Sunlight sun = sunlight(sky);
    if (!(units::luminance(sun.normal()) > 0)) return std::nullopt;
    Light light;
    light.type = LightType::directional;
    light.intensity = glm::vec3(sun.whole_disc);
    light.direction = -shading::direction_from_azimuth(sky.sun_azimuth_rad, sky.sun_elevation_rad, sky.north_rad);
    light.angular_diameter_rad = sky.sun_angular_diameter_rad;
    LightData data = pack_light(light, glm::mat4(1));
    data.opening = shading::opening_sun;
    return data;
}

shading::SkyData pack_sky(const Scene& scene) {
    const Sky& sky = scene.sky();
    shading::SkyData data{};
    data.luminance = sky.luminance_nits;
    data.model = sky.model == SkyModel::constant ? shading::sky_model_constant : shading::sky_model_none;
    data.texture_index = shading::no_texture;
    data.north_rad = sky.north_rad;
    if (sky.is_daylight())
        shading::set_daylight_sky({daylight_model(sky), sky.turbidity, sky.ground_albedo, sky.sun_azimuth_rad, sky.sun_elevation_rad,
                                   sunlight(sky)},
                                  data);
    if (sky.model == SkyModel::cie) shading::set_cie_sky(sky.cie_type, sky.zenith_luminance_nits, sky.ground_albedo,
                                                         sky.sun_azimuth_rad, sky.sun_elevation_rad, data);
    if (sky.model == SkyModel::image && scene.textures().contains(sky.image)) {
        data.model = shading::sky_model_image;
        data.texture_index = sky.image.index;
    }
    return data;
}

std::uint32_t first_level(const Texture& texture, int size_limit) {
    std::uint32_t level = 0;
    if (size_limit <= 0) return level;
    while (level + 1 < texture.levels.size() && std::max(texture.width >> level, texture.height >> level) > size_limit)
        ++level;
    return level;
}

}  // namespace heliodon::convert
