#include "scene/procedural.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <tuple>
#include <utility>

#include "shared_data.h"

namespace heliodon {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Corner positions on a grid of 10 µm, so that vertices that only differ in texture coordinates meet.
using Corner = std::tuple<long, long, long>;
Corner corner(glm::vec3 p) {
    return {std::lround(p.x * 1e5), std::lround(p.y * 1e5), std::lround(p.z * 1e5)};
}

/// How often each directed edge occurs; a closed, consistently oriented surface has each as often as its
/// opposite.
std::map<std::pair<Corner, Corner>, int> directed_edges(const Mesh& mesh) {
    std::map<std::pair<Corner, Corner>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Corner a = corner(mesh.positions[mesh.indices[i + k]]);
            const Corner b = corner(mesh.positions[mesh.indices[i + (k + 1) % 3]]);
            if (a != b) ++edges[{a, b}];
        }
    }
    return edges;
}

/// Edges that have no opposite: the surface's rims.
int open_edges(const Mesh& mesh) {
    const auto edges = directed_edges(mesh);
    int open = 0;
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        if (opposite == edges.end() || opposite->second != count) ++open;
    }
    return open;
}

/// Volume inside a closed surface that faces outward (divergence theorem).
double enclosed_volume(const Mesh& mesh) {
    double volume = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                         c = mesh.positions[mesh.indices[i + 2]];
        volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return volume;
}

void expect_sound(const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    ASSERT_EQ(mesh.normals.size(), count);
    ASSERT_EQ(mesh.tangents.size(), count);
    ASSERT_EQ(mesh.texcoords[0].size(), count);
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 normal = mesh.normals[i], tangent = glm::vec3(mesh.tangents[i]);
        ASSERT_NEAR(glm::length(normal), 1.0f, 1e-5f) << i;
        ASSERT_NEAR(glm::length(tangent), 1.0f, 1e-5f) << i;
        ASSERT_NEAR(glm::dot(normal, tangent), 0.0f, 1e-5f) << i;
        ASSERT_EQ(std::abs(mesh.tangents[i].w), 1.0f);
    }
    for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, count);
}

/// The least cosine between a triangle's face and its vertices' normals.
float least_agreement(const Mesh& mesh) {
    float least = 1.0f;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const glm::vec3 face = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t k : {a, b, c})
            least = std::min(least, glm::dot(mesh.normals[k], glm::normalize(face)));
    }
    return least;
}

/// The least cosine between what the texture coordinates say u and v directions are on each triangle and the
/// tangent frames of its vertices. glTF's v runs down, so the bitangent goes against it.
float least_tangent_agreement(const Mesh& mesh) {
    float least = 1.0f;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const glm::vec2 uv1 = mesh.texcoords[0][b] - mesh.texcoords[0][a],
                        uv2 = mesh.texcoords[0][c] - mesh.texcoords[0][a];
        const glm::vec3 e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
        const float determinant = uv1.x * uv2.y - uv2.x * uv1.y;
        const glm::vec3 along_u = glm::normalize((e1 * uv2.y - e2 * uv1.y) / determinant);
        const glm::vec3 along_v = glm::normalize((e2 * uv1.x - e1 * uv2.x) / determinant);
        for (const std::uint32_t k : {a, b, c}) {
            const glm::vec3 tangent(mesh.tangents[k]),
                bitangent = mesh.tangents[k].w * glm::cross(mesh.normals[k], tangent);
            least = std::min({least, glm::dot(tangent, along_u), glm::dot(bitangent, -along_v)});
        }
    }
    return least;
}

TEST(Teapot, StandsOnTheGroundOneMetreHighWithItsSpoutTowardsX) {
    const Mesh mesh = teapot_mesh(12);
    expect_sound(mesh);
    EXPECT_EQ(mesh.positions.size(), 32u * 13 * 13);
    const Bounds bounds = mesh.bounds();
    EXPECT_NEAR(bounds.min.y, 0.0f, 1e-6f);
    EXPECT_NEAR(bounds.max.y, 1.0f, 1e-6f);
    // Newell's own extents: handle to −3, spout to about 3.434, body to ±2, all over 3.15.
    EXPECT_NEAR(bounds.min.x, -3.0f / 3.15f, 0.01f);
    EXPECT_NEAR(bounds.max.x, 3.434f / 3.15f, 0.01f);
    EXPECT_NEAR(bounds.min.z, -2.0f / 3.15f, 1e-3f);
    EXPECT_NEAR(bounds.max.z, 2.0f / 3.15f, 1e-3f);
}

// An independent tessellation of Newell's patches, ten cells a side, in his units: the same points exactly.
TEST(Teapot, GoesThroughEveryVertexOfAnIndependentTessellation) {
    const auto path = tests::shared_path("models/teapot.obj");
    if (!path) GTEST_SKIP() << "without the shared data";
    const Mesh mesh = teapot_mesh(10);
    std::vector<glm::vec3> points(mesh.positions.begin(), mesh.positions.end());
    std::ifstream file(*path);
    int vertices = 0, faces = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        faces += keyword == "f";
        if (keyword != "v") continue;
        glm::vec3 p;
        words >> p.x >> p.y >> p.z;
        ++vertices;
        float nearest = 1e9f;
        for (const glm::vec3 q : points) nearest = std::min(nearest, glm::distance(p / 3.15f, q));
        ASSERT_LT(nearest, 2e-5f) << "vertex " << vertices << ": " << line;
    }
    EXPECT_GT(vertices, 3000);
    EXPECT_EQ(static_cast<std::size_t>(faces), mesh.triangle_count());
}

TEST(Teapot, FacesOutwardWithSmoothNormalsAndTexturedTangents) {
    const Mesh mesh = teapot_mesh(24);
    EXPECT_GT(least_agreement(mesh), 0.5f) << "the spout's lip bends most";
    EXPECT_GT(enclosed_volume(mesh), 0.0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (mesh.positions[i].y < 1e-6f) EXPECT_LT(mesh.normals[i].y, -0.99f) << "the bottom looks down";
        if (mesh.positions[i].y > 1.0f - 1e-6f) EXPECT_GT(mesh.normals[i].y, 0.99f) << "the knob's top looks up";
    }
}

TEST(Teapot, IsOpenOnlyWhereTheOriginalIs) {
    constexpr int subdivisions = 8;
    const Mesh mesh = teapot_mesh(subdivisions);
    // Rims: the lid's and the opening's (four quarters each), and both ends of handle and spout (two halves each).
    const int rims = 2 * 4 * subdivisions + 2 * 2 * 2 * subdivisions;
    EXPECT_EQ(open_edges(mesh), rims);
}

TEST(Teapot, MeetsItselfWithTheSameNormalWhereSmoothPatchesJoin) {
    const Mesh mesh = teapot_mesh(10);
    // The body, rows between the rim and the foot: quarters and the two profiles join smoothly.
    std::map<Corner, glm::vec3> seen;
    int shared = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        if (p.y * 3.15f < 0.2f || p.y * 3.15f > 2.3f || std::hypot(p.x, p.z) * 3.15f < 1.5f) continue;
        if (std::hypot(p.x, p.z) * 3.15f > 2.001f || std::abs(p.z) < 0.02f) continue;  // not the handle and the spout
        const auto [found, inserted] = seen.emplace(corner(p), mesh.normals[i]);
        if (inserted) continue;
        ++shared;
        EXPECT_GT(glm::dot(found->second, mesh.normals[i]), 0.9995f);
    }
    EXPECT_GT(shared, 20);
}

TEST(Teapot, WithAnySubdivisionIsSound) {
    for (const int subdivisions : {-3, 0, 1, 2, 3, 7}) expect_sound(teapot_mesh(subdivisions));
    EXPECT_EQ(teapot_mesh(0).positions.size(), teapot_mesh(1).positions.size());
}

struct Knot {
    int p, q;
};

class TorusKnot : public ::testing::TestWithParam<Knot> {};

TEST_P(TorusKnot, IsClosedAndFacesOutward) {
    const Mesh mesh = torus_knot_mesh(GetParam().p, GetParam().q, 0.6f, 0.05f, 300);
    expect_sound(mesh);
    EXPECT_EQ(open_edges(mesh), 0);
    EXPECT_GT(least_agreement(mesh), 0.8f);
    EXPECT_GT(least_tangent_agreement(mesh), 0.8f);
    const Bounds bounds = mesh.bounds();
    EXPECT_LE(bounds.max.x, 0.65f + 1e-5f);
    EXPECT_GE(bounds.min.y, -0.25f - 1e-5f);
    EXPECT_GT(bounds.diagonal(), 1.0f);
}

INSTANTIATE_TEST_SUITE_P(Windings, TorusKnot,
                         ::testing::Values(Knot{2, 3}, Knot{3, 2}, Knot{1, 1}, Knot{5, 3}, Knot{2, 7}),
                         [](const auto& info) {
                             return "p" + std::to_string(info.param.p) + "q" + std::to_string(info.param.q);
                         });

TEST(TorusKnot, HasTheVolumeOfATubeAndSamplesItExactly) {
    constexpr float tube = 0.03f;
    const Mesh mesh = torus_knot_mesh(2, 3, 0.6f, tube, 2000);
    // Length of the centre line r(t) = (2 + cos 3t)/3 · (cos 2t, ·, sin 2t), sin 3t/3, times 0.6.
    double length = 0;
    constexpr int steps = 20000;
    const auto centre = [](double t) {
        const double reach = 0.4 + 0.2 * std::cos(3 * t);
        return glm::dvec3(reach * std::cos(2 * t), 0.2 * std::sin(3 * t), reach * std::sin(2 * t));
    };
    for (int i = 0; i < steps; ++i)
        length += glm::distance(centre(2 * pi * i / steps), centre(2 * pi * (i + 1) / steps));
    // Pappus: cross-section times the length of the centroids' path; the polygon's area is a little smaller.
    EXPECT_NEAR(enclosed_volume(mesh), pi * tube * tube * length, 0.01 * pi * tube * tube * length);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 97) {
        const glm::vec3 on_centre_line = mesh.positions[i] - tube * mesh.normals[i];
        double nearest = 1e9;
        for (int k = 0; k < steps; ++k)
            nearest = std::min(nearest, glm::distance(glm::dvec3(on_centre_line), centre(2 * pi * k / steps)));
        ASSERT_LT(nearest, 2e-4) << "the normal goes straight out from the centre line";
    }
}

TEST(TorusKnot, OfSillyNumbersIsSound) {
    expect_sound(torus_knot_mesh(0, -2, 1.0f, 0.1f, -5));
    expect_sound(torus_knot_mesh(2, 3, 1.0f, 1e-4f, 10));
}

}  // namespace
}  // namespace heliodon
