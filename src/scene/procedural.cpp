#include "scene/procedural.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace heliodon {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Where a surface is and how it runs at one parameter: u to the right and v down, seen from outside.
struct SurfacePoint {
    dvec3 position, along_u, along_v;
};

void add_vertex(Mesh& mesh, const SurfacePoint& point, dvec2 texcoord) {
    const dvec3 normal = glm::normalize(glm::cross(point.along_v, point.along_u));
    const dvec3 tangent = glm::normalize(point.along_u - normal * glm::dot(normal, point.along_u));
    mesh.positions.emplace_back(point.position);
    mesh.normals.emplace_back(normal);
    mesh.tangents.emplace_back(glm::vec3(tangent), 1.0f);  // normal × tangent points up: against v
    mesh.texcoords[0].emplace_back(texcoord);
}

/// Two triangles for each cell of a grid of vertices that starts at `first`, row by row down v; a cell that
/// narrows to a pole gets one.
void add_grid_triangles(Mesh& mesh, std::uint32_t first, std::uint32_t columns, std::uint32_t rows) {
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& p = mesh.positions;
        if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t upper = first + row * (columns + 1) + column, lower = upper + columns + 1;
            add(upper, lower, upper + 1);
            add(upper + 1, lower, lower + 1);
        }
    }
}

// ---- the teapot

/// Control points [along v][along u], in Newell's units with y up.
using Patch = std::array<std::array<dvec3, 4>, 4>;

struct Bernstein {
    std::array<double, 4> value, derivative;
};

/// Cubic Bernstein polynomials and their derivatives.
Bernstein bernstein(double t) {
    const double s = 1 - t;
    return {{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t},
            {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t}};
}

dvec3 combine(const Patch& patch, const std::array<double, 4>& v_weights, const std::array<double, 4>& u_weights) {
    dvec3 sum(0);
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t column = 0; column < 4; ++column)
            sum += v_weights[row] * u_weights[column] * patch[row][column];
    }
    return sum;
}

SurfacePoint evaluate(const Patch& patch, double u, double v) {
    const Bernstein bu = bernstein(u), bv = bernstein(v);
    SurfacePoint point{combine(patch, bv.value, bu.value), combine(patch, bv.value, bu.derivative),
                       combine(patch, bv.derivative, bu.value)};
    constexpr double pole = 1e-9;
    if (glm::length(point.along_u) < pole) {
        // A row of one point: near it ∂P/∂u is the mixed derivative times the distance to that row.
        point.along_u = combine(patch, bv.derivative, bu.derivative) * (v < 0.5 ? 1.0 : -1.0);
    }
    return point;
}

/// Height of the original to the top of its knob; the mesh is 1 m high.
constexpr double newell_height = 3.15;

void add_patch(Mesh& mesh, const Patch& patch, int subdivisions, dvec2 texcoord_min, dvec2 texcoord_max) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int row = 0; row <= subdivisions; ++row) {
        for (int column = 0; column <= subdivisions; ++column) {
            const dvec2 uv = dvec2(column, row) / static_cast<double>(subdivisions);
            SurfacePoint point = evaluate(patch, uv.x, uv.y);
            point.position /= newell_height;
            add_vertex(mesh, point, glm::mix(texcoord_min, texcoord_max, uv));
        }
    }
    const auto cells = static_cast<std::uint32_t>(subdivisions);
    add_grid_triangles(mesh, first, cells, cells);
}

/// A control point of the profile that is turned about the axis. A quarter turn's inner control points stand
/// off its ends by `arm` of the radius: Newell's 0.56 (0.5523 would be closest to a circle).
struct ProfilePoint {
    double radius, height;
    double arm = 0.56;
};

// Newell's teapot is six cubic profiles turned by four quarters, each from its upper to its lower end …
constexpr std::array<std::array<ProfilePoint, 4>, 6> profiles = {{
    {{{0, 3.15}, {0.8, 3.15, 0.5625}, {0, 2.85}, {0.2, 2.7}}},         // knob
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},              // lid
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}},                // upper body
    {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},                // lower body
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0}, {0, 0}}},                 // bottom
}};

/// A row of control points across a tube's half: from `inner` in the plane of symmetry out to `half_width`,
/// over to `outer` and back into the plane.
struct TubeRow {
    dvec2 inner, outer;
    double half_width;
};
using Tube = std::array<TubeRow, 7>;  ///< two patches that share the middle row

// … and two tubes, each of two patches along and two mirrored halves.
constexpr Tube handle = {{{{-1.6, 2.025}, {-1.5, 2.25}, 0.3},
                          {{-2.3, 2.025}, {-2.5, 2.25}, 0.3},
                          {{-2.7, 2.025}, {-3.0, 2.25}, 0.3},
                          {{-2.7, 1.8}, {-3.0, 1.8}, 0.3},
                          {{-2.7, 1.575}, {-3.0, 1.35}, 0.3},
                          {{-2.5, 1.125}, {-2.65, 0.9375}, 0.3},
                          {{-2.0, 0.9}, {-1.9, 0.6}, 0.3}}};
constexpr Tube spout = {{{{1.7, 0.6}, {1.7, 1.425}, 0.66},
                         {{3.1, 0.825}, {2.6, 1.425}, 0.66},
                         {{2.4, 2.025}, {2.3, 2.1}, 0.25},
                         {{3.3, 2.4}, {2.7, 2.4}, 0.25},
                         {{3.525, 2.49375}, {2.8, 2.475}, 0.25},
                         {{3.45, 2.5125}, {2.9, 2.475}, 0.15},
                         {{3.2, 2.4}, {2.8, 2.4}, 0.15}}};

/// The quarter turn from the horizontal direction `from` to `to`, counter-clockwise seen from above.
Patch revolved_patch(const std::array<ProfilePoint, 4>& profile, dvec3 from, dvec3 to) {
    Patch patch;
    for (std::size_t row = 0; row < 4; ++row) {
        const auto [radius, height, arm] = profile[row];
        const dvec3 axis(0, height, 0);
        patch[row] = {axis + radius * from, axis + radius * (from + arm * to), axis + radius * (arm * from + to),
                      axis + radius * to};
    }
    return patch;
}

/// Rows first_row..first_row + 3 of one half of a tube: its right-hand (z > 0) or left-hand side, with u
/// counter-clockwise seen along the tube's way back.
Patch tube_patch(const Tube& tube, std::size_t first_row, bool right_hand, bool outer_first) {
    Patch patch;
    for (std::size_t row = 0; row < 4; ++row) {
        const auto& [inner, outer, half_width] = tube[first_row + row];
        const double z = right_hand ? half_width : -half_width;
        patch[row] = {dvec3(inner, 0), dvec3(inner, z), dvec3(outer, z), dvec3(outer, 0)};
        if (outer_first) std::reverse(patch[row].begin(), patch[row].end());
    }
    return patch;
}

void add_tube(Mesh& mesh, const Tube& tube, bool outer_first, int subdivisions) {
    for (const std::size_t half : {0u, 1u}) {
        for (const std::size_t piece : {0u, 1u}) {
            // The halves run against each other, so that both face outward and u goes once round.
            const Patch patch = tube_patch(tube, 3 * piece, half == 0, outer_first == (half == 0));
            const dvec2 corner(0.5 * static_cast<double>(half), 0.5 * static_cast<double>(piece));
            add_patch(mesh, patch, subdivisions, corner, corner + 0.5);
        }
    }
}

// ---- the torus knot

/// The knot's centre line with a frame across it: the normal of the torus that it lies on and the binormal.
/// That frame closes on itself, which a Frenet or a transported one need not.
struct KnotFrame {
    dvec3 position, velocity;
    dvec3 normal, normal_rate;
    dvec3 binormal, binormal_rate;
};

KnotFrame knot_frame(int p, int q, double radius, double t) {
    const double cp = std::cos(p * t), sp = std::sin(p * t), cq = std::cos(q * t), sq = std::sin(q * t);
    const dvec3 out(cp, 0, sp), around = static_cast<double>(p) * dvec3(-sp, 0, cp), up(0, 1, 0);
    const double minor = radius / 3, reach = 2 * minor + minor * cq, reach_rate = -minor * q * sq;
    KnotFrame frame;
    frame.position = reach * out + minor * sq * up;
    frame.velocity = reach_rate * out + reach * around + minor * q * cq * up;
    const dvec3 acceleration =
        -minor * q * q * cq * out + 2 * reach_rate * around - reach * p * p * out - minor * q * q * sq * up;
    frame.normal = cq * out + sq * up;
    frame.normal_rate = -q * sq * out + cq * around + q * cq * up;
    const double speed = glm::length(frame.velocity);
    const dvec3 tangent = frame.velocity / speed;
    const dvec3 tangent_rate = (acceleration - tangent * glm::dot(tangent, acceleration)) / speed;
    frame.binormal = glm::cross(tangent, frame.normal);
    frame.binormal_rate = glm::cross(tangent_rate, frame.normal) + glm::cross(tangent, frame.normal_rate);
    return frame;
}

double knot_length(int p, int q, double radius, int segments) {
    double length = 0;
    for (int i = 0; i < segments; ++i) {
        const double t = 2 * std::numbers::pi * i / segments;
        length += glm::length(knot_frame(p, q, radius, t).velocity) * 2 * std::numbers::pi / segments;
    }
    return length;
}

}  // namespace

Mesh teapot_mesh(int subdivisions) {
    subdivisions = std::clamp(subdivisions, 1, 256);
    Mesh mesh;
    constexpr std::array<dvec3, 5> quarters = {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0, 0, -1), dvec3(-1, 0, 0),
                                               dvec3(0, 0, 1)};
    for (std::size_t piece = 0; piece < profiles.size(); ++piece) {
        for (std::size_t quarter = 0; quarter < 4; ++quarter) {
            const Patch patch = revolved_patch(profiles[piece], quarters[quarter], quarters[quarter + 1]);
            const dvec2 cell(1.0 / 4.0, 1.0 / static_cast<double>(profiles.size()));
            const dvec2 corner = cell * dvec2(quarter, piece);
            add_patch(mesh, patch, subdivisions, corner, corner + cell);
        }
    }
    add_tube(mesh, handle, true, subdivisions);
    add_tube(mesh, spout, false, subdivisions);
    return mesh;
}

Mesh torus_knot_mesh(int p, int q, float radius, float tube_radius, int segments) {
    p = std::max(p, 1);
    q = std::max(q, 1);
    segments = std::clamp(segments, 8, 65536);
    const double across = 2 * std::numbers::pi * tube_radius * segments / knot_length(p, q, radius, segments);
    const int sides = static_cast<int>(std::clamp(std::round(across), 8.0, 1024.0));
    Mesh mesh;
    for (int row = 0; row <= sides; ++row) {
        // The last row and column repeat the first with other texture coordinates, bit by bit.
        const double angle = 2 * std::numbers::pi * (row % sides) / sides;
        const double c = tube_radius * std::cos(angle), s = tube_radius * std::sin(angle);
        for (int column = 0; column <= segments; ++column) {
            const KnotFrame frame = knot_frame(p, q, radius, 2 * std::numbers::pi * (column % segments) / segments);
            add_vertex(mesh,
                       {frame.position + c * frame.normal + s * frame.binormal,
                        frame.velocity + c * frame.normal_rate + s * frame.binormal_rate,
                        c * frame.binormal - s * frame.normal},
                       dvec2(static_cast<double>(column) / segments, static_cast<double>(row) / sides));
        }
    }
    add_grid_triangles(mesh, 0, static_cast<std::uint32_t>(segments), static_cast<std::uint32_t>(sides));
    return mesh;
}

}  // namespace heliodon
