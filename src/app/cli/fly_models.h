#pragma once

#include "scene/scene.h"

namespace heliodon::cli {

/// Stand-ins, built in code, for the three models of the published table, each with the same number of triangles within
/// half a percent, a camera and a lawn, without light.
/// A furnished pavilion between trees: 138 thousand, most of them leaves.
[[nodiscard]] Scene garden_scene();
/// A furnished office tower of thirty storeys: 107 thousand, all of boxes.
[[nodiscard]] Scene tower_scene();
/// A car's body and wheels, finely cut curved surfaces: 313 thousand.
[[nodiscard]] Scene car_scene();

}  // namespace heliodon::cli
