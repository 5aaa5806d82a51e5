#pragma once

#include "scene/geometry.h"

namespace heliodon::import {

/// Faces that meet at less than this angle share a smooth normal where a file gives none (60°).
inline constexpr float crease_angle_rad = 1.0471976f;

/// Makes normals for a mesh without any: each corner's is the mean of the faces round its position, weighted
/// by their angle there (Thürmer & Wüthrich 1998), over those within `crease_rad` of its own face. Positions
/// that coincide exactly count as one; vertices split along creases. `crease_rad` 0 gives flat normals.
void make_normals(Mesh& mesh, float crease_rad);

/// Makes tangents along the growth of the first texture coordinate: per-face gradients weighted by the
/// face's angle at the vertex, orthonormalized against the normal. An arbitrary perpendicular where the
/// coordinates are degenerate. Needs normals and `texcoords[texcoord_set]`.
void make_tangents(Mesh& mesh, int texcoord_set);

/// Unit normals everywhere: scales what is not unit and replaces what is too short to have a direction by
/// the mean of the faces round it. Returns how many were replaced.
std::size_t repair_normals(Mesh& mesh);

/// Drops triangles whose height is below single precision's resolution of their longest side (so those of
/// zero area too); returns how many.
std::size_t drop_degenerate_triangles(Mesh& mesh);

/// Keeps only vertices that a triangle uses, in their order.
void drop_unused_vertices(Mesh& mesh);

/// Replaces every vertex attribute by the ones of `sources[i]`, one entry a new vertex.
void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& sources);

}  // namespace heliodon::import
