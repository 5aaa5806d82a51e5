#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace heliodon::realtime {

/// Compact forms of vertex attributes, one 32-bit word each, as passes/common/scene_tables.glsl reads them.
/// Unit vectors are octahedral: normals 2 × 16 bits, tangents 16 and 15 bits and the bitangent's sign.
[[nodiscard]] std::vector<std::uint32_t> pack_normals(std::span<const glm::vec3> normals);
[[nodiscard]] std::vector<std::uint32_t> pack_tangents(std::span<const glm::vec4> tangents);

/// True where 16 bits resolve the coordinates well: they span no more than 16 repetitions of the texture, so
/// that a step is at most 1/4096 of it.
[[nodiscard]] bool packs_texcoords(std::span<const glm::vec2> texcoords);
/// The lowest coordinates and the step of a unit (four floats), then a word of 2 × 16 bits a vertex.
[[nodiscard]] std::vector<std::uint32_t> pack_texcoords(std::span<const glm::vec2> texcoords);

}  // namespace heliodon::realtime
