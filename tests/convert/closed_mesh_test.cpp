#include "convert/closed_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "import/import.h"
#include "scene/procedural.h"
#include "shared_data.h"

namespace heliodon::convert {
namespace {

void append(Mesh& mesh, const Mesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const std::uint32_t index : more.indices) mesh.indices.push_back(first + index);
}

Mesh inverted(Mesh mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    return mesh;
}

Mesh box() { return tessellate(Box{{0.1f, -0.3f, 17.3f}, {0.7f, 0.9f, 17.9f}}, 4); }
Mesh ball(glm::vec3 center) { return tessellate(Sphere{center, 0.7f}, 37); }

TEST(ClosedMesh, SolidShapesAreClosed) {
    EXPECT_TRUE(is_closed(box()));
    EXPECT_TRUE(is_closed(ball({0, 0, 0})));
    EXPECT_TRUE(is_closed(ball({1000.3f, -2, 0.7f})));
    EXPECT_TRUE(is_closed(torus_knot_mesh(2, 3, 1.0f, 0.1f, 200)));
}

TEST(ClosedMesh, SheetsAndTheTeapotAreNot) {
    EXPECT_FALSE(is_closed(tessellate(Quad{}, 4)));
    EXPECT_FALSE(is_closed(tessellate(Disk{}, 16)));
    EXPECT_FALSE(is_closed(teapot_mesh(8)));
    EXPECT_FALSE(is_closed(Mesh{}));
}

TEST(ClosedMesh, WithoutAnyOneTriangleASphereIsOpen) {
    const Mesh whole = tessellate(Sphere{}, 12);
    for (std::size_t triangle = 0; triangle < whole.triangle_count(); ++triangle) {
        Mesh open = whole;
        const auto first = open.indices.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
        open.indices.erase(first, first + 3);
        EXPECT_FALSE(is_closed(open)) << triangle;
    }
}

TEST(ClosedMesh, AHoleOfLessThanAThousandthOfTheAreaStaysUnseen) {
    Mesh scanned = tessellate(Sphere{}, 128);  // 16 128 triangles
    scanned.indices.resize(scanned.indices.size() / 2);
    EXPECT_FALSE(is_closed(scanned));
    scanned = tessellate(Sphere{}, 128);
    const auto equator = scanned.indices.begin() + static_cast<std::ptrdiff_t>(scanned.indices.size() / 2);
    scanned.indices.erase(equator, equator + 6);
    EXPECT_TRUE(is_closed(scanned));
}

TEST(ClosedMesh, ATriangleThatIsTurnedRoundOpensABox) {
    Mesh mesh = box();
    std::swap(mesh.indices[0], mesh.indices[1]);
    EXPECT_FALSE(is_closed(mesh));
}

TEST(ClosedMesh, WhatFacesInwardIsOpen) {
    EXPECT_FALSE(is_closed(inverted(box())));
    Mesh two = ball({0, 0, 0});
    append(two, ball({3, 0, 0}));
    EXPECT_TRUE(is_closed(two));
    Mesh one_inside_out = ball({0, 0, 0});
    append(one_inside_out, inverted(tessellate(Sphere{{3, 0, 0}, 0.1f}, 37)));
    EXPECT_FALSE(is_closed(one_inside_out));
}

TEST(ClosedMesh, TrianglesWithoutAreaAndLooseVerticesDoNotCount) {
    Mesh mesh = box();
    mesh.positions.insert(mesh.positions.end(), {{5, 5, 5}, {6, 5, 5}});
    const auto loose = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    for (const std::uint32_t index : {0u, 0u, 1u, loose, loose - 1, loose}) mesh.indices.push_back(index);
    EXPECT_TRUE(is_closed(mesh));
    mesh.indices.assign({0u, 0u, 1u});
    EXPECT_FALSE(is_closed(mesh));
}

TEST(ClosedMesh, ATJunctionIsAHole) {
    Mesh mesh = box();
    // The first triangle a b c becomes a m c and m b c: the edge a b of its neighbour is left alone.
    const std::uint32_t a = mesh.indices[0], b = mesh.indices[1], c = mesh.indices[2];
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
    mesh.indices[1] = middle;
    for (const std::uint32_t index : {middle, b, c}) mesh.indices.push_back(index);
    EXPECT_FALSE(is_closed(mesh));
}

TEST(ClosedMesh, FourFacesMayMeetInAnEdge) {
    Mesh mesh = tessellate(Box{{0, 0, 0}, {1, 1, 1}}, 4);
    append(mesh, tessellate(Box{{1, 1, 0}, {2, 2, 1}}, 4));
    EXPECT_TRUE(is_closed(mesh));
}

TEST(ClosedMesh, ScansWithAFewHolesAreClosedAndModelsOfOpenSheetsAreNot) {
    for (const auto& [file, closed] : {std::pair("models/dragon.glb", true), std::pair("models/lucy.glb", true),
                                       std::pair("models/suzanne.glb", false), std::pair("models/teapot.obj", false)}) {
        const auto path = tests::shared_path(file);
        if (!path) GTEST_SKIP();
        Warnings warnings;
        const auto scene = load_scene(*path, {}, warnings);
        ASSERT_TRUE(scene) << scene.error().text();
        scene->geometries().each([&](GeometryId, const Geometry& geometry) { EXPECT_EQ(is_closed(geometry.mesh), closed) << file; });
    }
}

}  // namespace
}  // namespace heliodon::convert
