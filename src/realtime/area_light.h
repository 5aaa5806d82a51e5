#pragma once

#include "core/math.h"
#include "shading/scene_data.h"

namespace heliodon::realtime {

/// A light without extent that stands for one point `u` (unit square) of a light with a radius: the mean over
/// all points is the whole light, its soft shadows included.
///  - a point light's sphere: a uniform point of its surface, which emits by the cosine of its normal;
///  - a spot's (or Lambertian light's) sphere: the hemisphere on the side of its axis, uniform as seen from there;
///  - a luminaire's opening: a point of its surface, of faces that send more more often, both sides of flat ones;
///  - a directional light's disc: a uniform direction of its cone.
[[nodiscard]] shading::LightData point_of_area_light(const shading::LightData& light, glm::vec2 u);
/// The same light shrunk to its centre.
[[nodiscard]] shading::LightData center_of_area_light(shading::LightData light);

}  // namespace heliodon::realtime
