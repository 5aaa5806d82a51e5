#include "import/mesh_completion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "import/import.h"

namespace heliodon {
namespace {

/// A cube of eight shared corners, faces outward.
Mesh cube() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
    const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : quads) mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    return mesh;
}

/// An open tube round z with `sides` quads and duplicated vertices at its seam.
Mesh tube(int sides) {
    Mesh mesh;
    for (int i = 0; i <= sides; ++i) {
        const float angle = float(i % sides) * 2 * std::numbers::pi_v<float> / float(sides);
        for (int z = 0; z < 2; ++z) {
            mesh.positions.push_back({std::cos(angle), std::sin(angle), z});
            mesh.texcoords[0].push_back({float(i) / float(sides), 1 - z});
        }
    }
    for (std::uint32_t i = 0; i < std::uint32_t(sides); ++i)
        mesh.indices.insert(mesh.indices.end(), {2 * i, 2 * i + 2, 2 * i + 3, 2 * i, 2 * i + 3, 2 * i + 1});
    return mesh;
}

TEST(MeshCompletion, CreasesOfACubeStay) {
    Mesh mesh = cube();
    complete_mesh(mesh);
    EXPECT_EQ(mesh.positions.size(), 24u);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(glm::length(mesh.normals[v]), 1, 1e-6);
        EXPECT_NEAR(glm::dot(mesh.normals[v], mesh.positions[v]), 1, 1e-6) << "outward along an axis";
    }
}

TEST(MeshCompletion, NormalsOfATubeAreSmoothAcrossItsSeam) {
    Mesh mesh = tube(24);
    complete_mesh(mesh);
    EXPECT_EQ(mesh.positions.size(), 50u) << "nothing splits";
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        EXPECT_NEAR(glm::dot(mesh.normals[v], glm::vec3(mesh.positions[v].x, mesh.positions[v].y, 0)), 1, 1e-5);
}

TEST(MeshCompletion, NormalsAreWeightedByAngleNotByTriangles) {
    // A cube corner whose three faces are split unevenly: the mean must not lean to the face with two triangles.
    Mesh mesh = cube();
    import::make_normals(mesh, std::numbers::pi_v<float>);
    ASSERT_EQ(mesh.positions.size(), 8u);
    for (std::size_t v = 0; v < 8; ++v)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mesh.normals[v][c], mesh.positions[v][c] / std::sqrt(3.0f), 1e-6);
}

TEST(MeshCompletion, TangentsFollowUAndAreOrthonormal) {
    Mesh mesh = tube(24);
    complete_mesh(mesh);
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3 round(-mesh.positions[v].y, mesh.positions[v].x, 0), tangent(mesh.tangents[v]);
        EXPECT_NEAR(glm::length(tangent), 1, 1e-5);
        EXPECT_NEAR(glm::dot(tangent, mesh.normals[v]), 0, 1e-5);
        EXPECT_GT(glm::dot(tangent, round), 0.98);
        // Along −v, the picture's up, which is z here.
        const glm::vec3 bitangent = mesh.tangents[v].w * glm::cross(mesh.normals[v], tangent);
        EXPECT_GT(bitangent.z, 0.98);
    }
}

TEST(MeshCompletion, MirroredTextureCoordinatesTurnTheHandedness) {
    Mesh mesh = tube(24);
    for (glm::vec2& uv : mesh.texcoords[0]) uv.x = -uv.x;
    complete_mesh(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_EQ(mesh.tangents[v].w, -1.0f);
        const glm::vec3 bitangent = mesh.tangents[v].w * glm::cross(mesh.normals[v], glm::vec3(mesh.tangents[v]));
        EXPECT_GT(bitangent.z, 0.98);
    }
}

TEST(MeshCompletion, DegenerateTextureCoordinatesGiveAnyPerpendicular) {
    Mesh mesh = tube(8);
    for (glm::vec2& uv : mesh.texcoords[0]) uv = glm::vec2(0.5f);
    complete_mesh(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(glm::length(glm::vec3(mesh.tangents[v])), 1, 1e-5);
        EXPECT_NEAR(glm::dot(glm::vec3(mesh.tangents[v]), mesh.normals[v]), 0, 1e-5);
    }
}

TEST(MeshCompletion, NormalsThatAreThereStay) {
    Mesh mesh = cube();
    mesh.normals.assign(8, glm::vec3(0, 0, 1));
    complete_mesh(mesh);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_TRUE(mesh.tangents.empty()) << "no texture coordinates to follow";
}

TEST(MeshCompletion, NormalsWithoutLengthAreReplaced) {
    Mesh mesh = cube();
    for (const glm::vec3& p : mesh.positions) mesh.normals.push_back(3.0f * p);
    mesh.normals[5] = glm::vec3(0);
    EXPECT_EQ(import::repair_normals(mesh), 1u);
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_NEAR(glm::dot(mesh.normals[v], glm::normalize(mesh.positions[v])), 1, 1e-6);
}

TEST(MeshCompletion, ThinTrianglesStayAndFlatOnesGo) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-5f, 0}, {0.5f, 0, 0}, {0.5f, 1e-9f, 0}};
    mesh.indices = {0, 1, 2, 0, 1, 3, 0, 1, 4, 1, 1, 2};
    EXPECT_EQ(import::drop_degenerate_triangles(mesh), 3u);
    EXPECT_EQ(mesh.indices.size(), 3u);
    EXPECT_EQ(mesh.indices[2], 2u);
}

TEST(MeshCompletion, ManyFacesAtOnePlaceAreStillQuick) {
    Mesh mesh;
    constexpr std::uint32_t faces = 60000;
    mesh.positions.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < faces; ++i) {
        const float angle = float(i) * 2 * std::numbers::pi_v<float> / float(faces);
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % faces});
    }
    complete_mesh(mesh);
    EXPECT_EQ(mesh.positions[0], glm::vec3(0, 0, 1));
    EXPECT_NEAR(mesh.normals[mesh.indices[0]].z, 1, 1e-3);
}

}  // namespace
}  // namespace heliodon
