#pragma once

#include <optional>

#include "scene/scene.h"
#include "shading/scene_data.h"

namespace heliodon::convert {

/// The scene's records in the form both engines read. Texture indices are the scene's texture slots; stale
/// handles become no_texture.
[[nodiscard]] shading::MaterialData pack_material(const Scene& scene, const Material& material);
/// `world` moves and turns the light; it scales neither its radius nor its intensity.
[[nodiscard]] shading::LightData pack_light(const Light& light, const glm::mat4& world);
[[nodiscard]] shading::LightData no_light();
[[nodiscard]] shading::InstanceData pack_instance(const glm::mat4& world, std::uint32_t geometry, std::uint32_t material,
                                                  bool visible);
[[nodiscard]] shading::SkyData pack_sky(const Scene& scene);
/// The sun of a daylight sky as the directional light that it is, of its whole disc, what is below the horizon included;
/// none where it has set or the sky shows no disc.
[[nodiscard]] std::optional<shading::LightData> pack_sun(const Sky& sky);
/// The first mip level of `texture` whose sides are within `size_limit` texels (0: no limit).
[[nodiscard]] std::uint32_t first_level(const Texture& texture, int size_limit);

}  // namespace heliodon::convert
