#pragma once

#include "scene/geometry.h"

namespace heliodon {

/// The Utah teapot from its 32 bicubic Bézier patches (Martin Newell 1975, in Blinn's proportions), each
/// cut into `subdivisions`² cells (clamped to 1..256). 1 m high from y = 0 to the knob's top, about y; the
/// spout points to +x, the handle to −x. Normals, tangents and texture coordinates are exact. As in the
/// original the surface is open at the spout's mouth and between lid and rim: a two-sided material shows
/// the inside.
[[nodiscard]] Mesh teapot_mesh(int subdivisions);

/// A tube of `tube_radius` about the (p, q) torus knot, which winds p times round the y axis and q times
/// through the torus's hole. The knot's centre line lies on a torus about the origin with radii 2/3 and 1/3
/// of `radius`, so that it reaches out to `radius`; metres. `segments` pieces along the knot (clamped to
/// 8..65536); the tube has a proportionate number round it. Closed; normals and tangents are exact. p and q
/// coprime give one closed knot; they are clamped to at least 1.
[[nodiscard]] Mesh torus_knot_mesh(int p, int q, float radius, float tube_radius, int segments);

}  // namespace heliodon
