#include "convert/mesh_edges.h"

#include <gtest/gtest.h>

#include <map>

namespace heliodon::tests {
namespace {

Mesh mesh_of(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices) {
    Mesh mesh;
    for (const glm::vec3& p : positions) mesh.positions.push_back(p);
    for (const std::uint32_t i : indices) mesh.indices.push_back(i);
    return mesh;
}

TEST(MeshEdges, EachEdgeOfATetrahedronIsGoneAlongOnceEachWayThoughEveryFaceHasItsOwnVertices) {
    const glm::vec3 a(0), b(1, 0, 0), c(0, 1, 0), d(0, -0.0f, 1);
    const Mesh mesh = mesh_of({a, c, b, a, b, d, b, c, d, c, a, d}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
    const auto edges = convert::mesh_edges(mesh);
    EXPECT_EQ(edges.edges.size(), 6u);
    EXPECT_EQ(edges.uses.size(), 12u);
    for (const auto& edge : edges.edges) {
        ASSERT_EQ(edge.use_count, 2u);
        EXPECT_NE(edges.uses[edge.first_use] & 1, edges.uses[edge.first_use + 1] & 1);
        EXPECT_LT(edge.a, edge.b);
    }
}

TEST(MeshEdges, AnyNumberOfTrianglesMayMeetInAnEdgeAndThoseWithoutAreaHaveNone) {
    const Mesh mesh = mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                              {0, 1, 2, 0, 5, 3, 1, 0, 4, 1, 5, 2});
    const auto edges = convert::mesh_edges(mesh);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> uses;
    for (const auto& edge : edges.edges)
        for (std::uint32_t i = 0; i < edge.use_count; ++i) uses[{edge.a, edge.b}].push_back(edges.uses[edge.first_use + i]);
    EXPECT_EQ(uses.size(), 7u);
    EXPECT_EQ((uses[{0, 1}]), (std::vector<std::uint32_t>{0, 2, 5}));
    EXPECT_EQ((uses[{0, 2}]), (std::vector<std::uint32_t>{1}));
}

}  // namespace
}  // namespace heliodon::tests
