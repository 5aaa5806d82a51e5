#pragma once

#include "convert/flat_scene.h"

namespace heliodon::convert {

/// Mean of what visible opaque surfaces reflect of an even light, by area (each side's counts once): of textures the mean of
/// their texels. 0 where there is no such surface. Takes a few nanoseconds a triangle.
[[nodiscard]] glm::vec3 mean_albedo(const FlatScene& scene);

}  // namespace heliodon::convert
