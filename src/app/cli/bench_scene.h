#pragma once

#include "scene/scene.h"

namespace heliodon::cli {

/// The stand-in for the published test scene, built in code: a box 2 m wide, open to the camera, with a torus knot of
/// mirror metal, a sphere of glass (index of refraction 3), a glazed box and a teapot of green clay; some 450 thousand
/// triangles as there. Lit by a bulb of 100 cd named "bulb" or, `emissive`, by its back wall of 60 cd/m² alone.
[[nodiscard]] Scene natus_scene(bool emissive);

/// The same box with `copies` (at least 1) of one mesh of some 45 thousand triangles in place of the objects, and
/// `lights` (at least 1) bulbs below the ceiling that share 100 cd.
[[nodiscard]] Scene crowded_scene(int copies, int lights);

/// Triangles drawn, instances counted each.
[[nodiscard]] std::size_t triangle_count(const Scene& scene);

}  // namespace heliodon::cli
