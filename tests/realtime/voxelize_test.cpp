#include <deque>
#include <random>
#include <set>

#include "scene/procedural.h"
#include "voxel_test.h"

namespace heliodon::tests {
namespace {

using namespace shading;

/// By voxel: reached from the grid's sides through voxels without a surface.
std::vector<bool> flooded(const Voxels& voxels) {
    const int n = static_cast<int>(voxels.grid.size);
    std::vector<bool> reached(voxels.number.size(), false);
    std::deque<glm::ivec3> open;
    const auto enter = [&](glm::ivec3 v) {
        if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, glm::ivec3(n)))) return;
        const std::uint32_t index = voxels.index(v);
        if (reached[index] || voxels.occupied(v)) return;
        reached[index] = true;
        open.push_back(v);
    };
    for (std::uint32_t index = 0; index < voxels.number.size(); ++index) {
        const glm::ivec3 v = voxels.voxel(index);
        if (glm::any(glm::equal(v, glm::ivec3(0))) || glm::any(glm::equal(v, glm::ivec3(n - 1)))) enter(v);
    }
    while (!open.empty()) {
        const glm::ivec3 v = open.front();
        open.pop_front();
        for (int axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                glm::ivec3 next = v;
                next[axis] += step;
                enter(next);
            }
    }
    return reached;
}

/// Whether a voxel's centre lies inside the surface: an odd number of crossings along +x.
std::vector<bool> enclosed(const Voxels& voxels, const std::vector<glm::dvec3>& corners) {
    const auto n = voxels.grid.size;
    std::vector<std::vector<double>> crossings(n * n);  // by y + n z, in voxels
    constexpr double aside = 1.2345e-4;                 // off every edge
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        std::array<glm::dvec3, 3> p;
        for (int k = 0; k < 3; ++k) p[k] = (corners[t + k] - glm::dvec3(voxels.grid.origin)) / double{voxels.grid.voxel_m};
        const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const auto low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
        for (int z = int(low.z) - 1; z <= int(high.z); ++z)
            for (int y = int(low.y) - 1; y <= int(high.y); ++y) {
                const glm::dvec2 at(y + 0.5 + aside, z + 0.5 + 1.7 * aside);
                bool inside = normal.x != 0;
                for (int k = 0; k < 3 && inside; ++k) {
                    const glm::dvec3 a = p[k], b = p[(k + 1) % 3];
                    inside = ((b.y - a.y) * (at.y - a.z) - (b.z - a.z) * (at.x - a.y)) * normal.x > 0;
                }
                if (inside)
                    crossings[y + n * z].push_back(p[0].x - (normal.y * (at.x - p[0].y) + normal.z * (at.y - p[0].z)) / normal.x);
            }
    }
    std::vector<bool> result(voxels.number.size());
    for (std::uint32_t index = 0; index < result.size(); ++index) {
        const glm::ivec3 v = voxels.voxel(index);
        const auto& row = crossings[v.y + n * v.z];
        result[index] = std::ranges::count_if(row, [&](double x) { return x > v.x + 0.5; }) % 2 == 1;
    }
    return result;
}

class Voxelization : public VoxelTest {
protected:
    Scene scene;
    MaterialId grey = scene.add_material(lambert({0.25f, 0.5f, 0.75f}));

    void expect_sealed(const VoxelGrid& grid) {
        const Voxels voxels = voxelize(scene, grid, {});
        EXPECT_EQ(voxels.header.record_count, voxels.header.record_demand);
        EXPECT_EQ(voxels.header.tile_count, voxels.header.tile_demand);
        const auto reached = flooded(voxels), inside = enclosed(voxels, world_triangles(scene));
        int hollow = 0, leaks = 0;
        for (std::uint32_t index = 0; index < reached.size(); ++index) {
            if (voxels.number[index] != 0 || !inside[index]) continue;
            ++hollow;
            leaks += reached[index];
        }
        EXPECT_GT(hollow, 100) << "the check must have something to check";
        EXPECT_EQ(leaks, 0);
    }
};

TEST_F(Voxelization, AClosedSurfaceVoxelizesClosed) {
    const Transform turned{.translation = {0.02f, 0.01f, -0.03f}, .rotation = rotation_from_euler_deg({20, 35, 50})};
    const std::vector<Mesh> meshes{tessellate(Sphere{{0, 0, 0}, 0.8f}, 64), tessellate(Box{glm::vec3(-0.5f), glm::vec3(0.5f)}, 8),
                                   torus_knot_mesh(2, 3, 0.85f, 0.16f, 160)};
    for (const Mesh& mesh : meshes) {
        const NodeId node = add_mesh(scene, mesh, grey, turned);
        for (const std::uint32_t size : {32u, 64u}) expect_sealed(grid_over(glm::vec3(-1), 2, size));
        scene.remove(node);
    }
}

TEST_F(Voxelization, ASheetWithoutThicknessSealsABox) {
    const glm::vec3 low(-0.613f, -0.5f, -0.571f), high(0.617f, 0.3f, 0.589f);
    Mesh box = tessellate(Box{low, high}, 8);
    // The box loses its lid; a tilted sheet from rim to rim closes it.
    PaddedArray<std::uint32_t> open;
    for (std::size_t t = 0; t < box.indices.size(); t += 3)
        if (!(box.positions[box.indices[t]].y == high.y && box.positions[box.indices[t + 1]].y == high.y &&
              box.positions[box.indices[t + 2]].y == high.y))
            open.insert(open.end(), {box.indices[t], box.indices[t + 1], box.indices[t + 2]});
    ASSERT_EQ(open.size(), box.indices.size() - 6);
    box.indices = open;
    const glm::vec3 slope(0, 0.37f, 0);
    for (glm::vec3& p : box.positions)
        if (p.y == high.y && p.x == low.x) p += slope;
    add_mesh(scene, box, grey);
    add_shape_node(scene, Quad{glm::vec3(low.x, high.y, low.z) + slope, {0, 0, high.z - low.z}, glm::vec3(high.x - low.x, 0, 0) - slope}, grey);
    for (const std::uint32_t size : {32u, 64u}) expect_sealed(grid_over(glm::vec3(-1), 2, size));
}

TEST_F(Voxelization, ASpheresFacesAddUpToItsProjectedArea) {
    add_mesh(scene, tessellate(Sphere{{0.01f, 0.02f, 0.03f}, 0.8f}, 128), grey);
    const VoxelGrid grid = grid_over(glm::vec3(-1), 2, 64);
    const Voxels voxels = voxelize(scene, grid, {});
    const auto corners = world_triangles(scene);
    for (int face = 0; face < 6; ++face) {
        double exact = 0;
        for (std::size_t t = 0; t < corners.size(); t += 3) {
            const double seen = 0.5 * glm::cross(corners[t + 1] - corners[t], corners[t + 2] - corners[t])[face / 2];
            exact += std::max(0.0, face % 2 ? -seen : seen);
        }
        exact /= double{grid.voxel_m} * grid.voxel_m;
        EXPECT_NEAR(voxels.total(face, voxel_field_area) / exact, 1, 1e-5) << "face " << face;
        EXPECT_NEAR(voxels.total(face, voxel_field_albedo) / exact, 0.25, 1e-5);
        EXPECT_NEAR(voxels.total(face, voxel_field_albedo + 2) / exact, 0.75, 1e-5);
        EXPECT_EQ(voxels.total(face, voxel_field_emission), 0);
    }
}

TEST_F(Voxelization, APlaneCoversItsVoxelsExactlyOnce) {
    constexpr std::uint32_t size = 32;
    const VoxelGrid grid = grid_over(glm::vec3(0), size, size);
    add_shape_node(scene, Quad{{0, 10.5f, 0}, {0, 0, size}, {size, 0, 0}}, grey);
    const Voxels voxels = voxelize(scene, grid, {});
    EXPECT_EQ(voxels.records.size(), size * size);
    constexpr double fixed = 3.0 / voxel_fixed_one;
    for (const auto& [place, record] : voxels.records) {
        EXPECT_EQ(voxels.voxel(place).y, 10);
        EXPECT_NEAR(Voxels::field(record, 2, voxel_field_area), 1, fixed);
        EXPECT_NEAR(Voxels::field(record, 2, voxel_field_albedo), 0.25, fixed);
        EXPECT_NEAR(Voxels::field(record, 2, voxel_field_albedo + 1), 0.5, fixed);
        EXPECT_NEAR(Voxels::field(record, 2, voxel_field_normal + 1), 1, fixed);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(Voxels::field(record, 2, voxel_field_position + c), 0.5, fixed);
        EXPECT_EQ(Voxels::field(record, 3, voxel_field_area), 0);
        EXPECT_NEAR(Voxels::field(record, 3, voxel_field_behind), 1, fixed);  // the open sheet's rear
        for (const int face : {0, 1, 4, 5}) EXPECT_EQ(Voxels::field(record, face, voxel_field_area), 0);
    }
    for (std::uint32_t level = 1; level <= 5; ++level) {
        const std::uint32_t count = (size >> level) * (size >> level);
        EXPECT_EQ(voxels.levels.groups[level], glm::uvec4((count + 63) / 64, 1, 1, count)) << "level " << level;
    }
}

TEST_F(Voxelization, SurfacesBetweenVoxelsCountOnce) {
    constexpr std::uint32_t size = 32;
    add_shape_node(scene, Box{glm::vec3(0), glm::vec3(size)}, grey);  // its sides are the grid's own
    add_shape_node(scene, Box{glm::vec3(8), glm::vec3(16)}, grey);
    const Voxels voxels = voxelize(scene, grid_over(glm::vec3(0), size, size), {});
    for (int face = 0; face < 6; ++face)
        EXPECT_NEAR(voxels.total(face, voxel_field_area), size * size + 8 * 8, 1e-2) << "face " << face;
}

TEST_F(Voxelization, EveryRunGivesTheSameSums) {
    add_mesh(scene, torus_knot_mesh(2, 3, 0.85f, 0.16f, 400), grey, {.rotation = rotation_from_euler_deg({10, 20, 30})});
    add_shape_node(scene, Box{glm::vec3(-0.7f), glm::vec3(0.66f)}, grey, {.rotation = rotation_from_euler_deg({5, 15, 25})});
    const VoxelGrid grid = grid_over(glm::vec3(-1.2f), 2.4f, 64);
    const Voxels first = voxelize(scene, grid, {});
    EXPECT_GT(first.header.tile_count, 0u);
    for (int run = 1; run < 5; ++run) EXPECT_TRUE(voxelize(scene, grid, {}).records == first.records);
}

TEST_F(Voxelization, LargeTrianglesAndTheSameInSmallPiecesGiveTheSameSums) {
    const Mesh box = tessellate(Box{glm::vec3(-0.6f), glm::vec3(0.6f)}, 8);
    const Transform turned{.rotation = rotation_from_euler_deg({20, 35, 50})};
    const VoxelGrid grid = grid_over(glm::vec3(-1.1f), 2.2f, 64);
    const NodeId coarse = add_mesh(scene, box, grey, turned);
    const Voxels large = voxelize(scene, grid, {});
    scene.remove(coarse);
    add_mesh(scene, subdivided(box, 64), grey, turned);
    const Voxels small = voxelize(scene, grid, {});
    EXPECT_GT(large.header.tile_count, 50u);
    EXPECT_EQ(small.header.tile_count, 0u);
    // About ten pieces a voxel, each rounded to the fixed point; their corners are rounded to single precision.
    constexpr double tolerance = 40.0 / voxel_fixed_one;
    std::set<std::uint32_t> places;
    for (const Voxels* one : {&large, &small})
        for (const auto& [place, record] : one->records) places.insert(place);
    const VoxelRecord nothing{};
    double worst = 0;
    for (const std::uint32_t place : places) {
        const auto a = large.records.find(place), b = small.records.find(place);
        for (std::uint32_t i = 0; i < record_words; ++i)
            worst = std::max(worst, std::abs(Voxels::field(a == large.records.end() ? nothing : a->second, 0, i) -
                                             Voxels::field(b == small.records.end() ? nothing : b->second, 0, i)));
    }
    EXPECT_LT(worst, tolerance);
}

TEST_F(Voxelization, AGridThatCutsTheSceneHoldsWhatALargerOneHoldsThere) {
    add_mesh(scene, tessellate(Sphere{{0, 0, 0}, 0.8f}, 48), grey);
    add_shape_node(scene, Quad{{-1, 0.31f, -1}, {0, 0.1f, 2}, {2, 0, 0}}, grey);
    const Voxels whole = voxelize(scene, grid_over(glm::vec3(-1), 2, 64), {});
    const Voxels part = voxelize(scene, grid_over(glm::vec3(0), 1, 32), {});
    std::size_t expected = 0;
    for (const auto& [place, record] : whole.records) {
        const glm::ivec3 v = whole.voxel(place) - 32;
        if (glm::any(glm::lessThan(v, glm::ivec3(0)))) continue;
        ++expected;
        const auto found = part.records.find(part.index(v));
        ASSERT_NE(found, part.records.end());
        // Single precision cuts an edge of 64 voxels to some 4·10⁻⁶ voxels, and a piece is cut on six sides.
        for (std::uint32_t i = 0; i < record_words; ++i)
            EXPECT_NEAR(Voxels::field(found->second, 0, i), Voxels::field(record, 0, i), 6e-5);
    }
    EXPECT_EQ(part.records.size(), expected);
}

TEST_F(Voxelization, WhatFindsNoRoomIsReportedAndNothingElseIsLost) {
    add_mesh(scene, tessellate(Sphere{{0, 0, 0}, 0.8f}, 64), grey);
    const VoxelGrid grid = grid_over(glm::vec3(-1), 2, 32);
    const Voxels whole = voxelize(scene, grid, {});
    const Voxels few = voxelize(scene, grid, {.records = 100});
    EXPECT_EQ(few.header.record_demand, whole.header.record_demand);
    EXPECT_EQ(few.header.record_count, 100u);
    ASSERT_EQ(few.records.size(), 100u);
    for (const auto& [place, record] : few.records) EXPECT_EQ(record, whole.records.at(place));
    for (std::size_t i = 0; i < few.number.size(); ++i) {
        EXPECT_EQ(few.number[i] != 0, whole.number[i] != 0);
        if (few.number[i] > 100) EXPECT_EQ(few.number[i], voxel_without_room);
    }
}

TEST_F(Voxelization, TilesThatFindNoRoomAreReported) {
    add_shape_node(scene, Quad{{-1, 0.9f, -1}, {0, 0, 2}, {2, 0, 0}}, grey);
    const VoxelGrid grid = grid_over(glm::vec3(-1), 2, 32);
    const Voxels voxels = voxelize(scene, grid, {.tiles = 3});
    EXPECT_EQ(voxels.header.tile_demand, 26u) << "of 4 x 4 tiles each half of the square meets 10, and 3 by a corner";
    EXPECT_EQ(voxels.header.tile_count, 3u);
    EXPECT_LE(voxels.header.record_count, 3u * 64);
    EXPECT_GT(voxels.header.record_count, 0u);
    EXPECT_EQ(voxelize(scene, grid, {.tiles = 26}).header.record_count, 32u * 32);
}

TEST_F(Voxelization, CoarseVoxelsThatHoldAnythingAreListedOnce) {
    add_mesh(scene, torus_knot_mesh(3, 2, 0.85f, 0.1f, 300), grey);
    const Voxels voxels = voxelize(scene, grid_over(glm::vec3(-1), 2, 64), {});
    for (std::uint32_t level = 1; level <= 6; ++level) {
        const std::uint32_t n = 64 >> level;
        std::set<std::uint32_t> expected;
        for (const auto& [place, record] : voxels.records) {
            const glm::uvec3 v = glm::uvec3(voxels.voxel(place)) >> level;
            expected.insert(v.x + n * (v.y + n * v.z));
        }
        auto listed = voxels.level_lists[level];
        std::ranges::sort(listed);
        EXPECT_TRUE(std::ranges::equal(listed, expected)) << "level " << level;
        EXPECT_EQ(voxels.levels.groups[level].x, (expected.size() + 63) / 64);
    }
}

TEST_F(Voxelization, ScatteredTrianglesThatShareNoVoxelLoseNothing) {
    constexpr std::uint32_t size = 32;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> within(0, 1);
    const auto point = [&] { return glm::vec3(within(random), within(random), within(random)); };
    Mesh mesh;  // a workgroup's triangles show more faces than it has room for
    for (std::uint32_t i = 0; i < 3 * 4096; i += 3) {
        const glm::vec3 corner = point() * (size - 2.0f);
        for (std::uint32_t k = 0; k < 3; ++k) {
            mesh.positions.push_back(corner + 0.6f * point());
            mesh.indices.push_back(i + k);
        }
    }
    add_mesh(scene, mesh, grey);
    const Voxels voxels = voxelize(scene, grid_over(glm::vec3(0), size, size), {});
    const auto corners = world_triangles(scene);
    for (int face = 0; face < 6; ++face) {  // what an open surface does not show, it shows from behind
        double exact = 0;
        for (std::size_t t = 0; t < corners.size(); t += 3)
            exact += std::abs(0.5 * glm::cross(corners[t + 1] - corners[t], corners[t + 2] - corners[t])[face / 2]);
        EXPECT_NEAR((voxels.total(face, voxel_field_area) + voxels.total(face, voxel_field_behind)) / exact, 1, 1e-4) << "face " << face;
    }
}

TEST_F(Voxelization, MoreTrianglesThanOneRowOfWorkgroupsAreAllFound) {
    const VoxelGrid grid = grid_over(glm::vec3(-1), 2, 32);
    const auto with_others = [&](std::size_t most_triangles) {
        Scene crowd;
        const MaterialId material = crowd.add_material(lambert(glm::vec3(0.5f)));
        const GeometryId ball = crowd.add_shape(Sphere{{0, 0, 0}, 0.6f});
        const std::size_t triangles = crowd.geometries().find(ball)->mesh.triangle_count();
        for (std::size_t after = triangles;; after += triangles) {
            Node node;
            const bool last = after > most_triangles;
            node.transform.translation = glm::vec3(last ? 0 : 10);  // the others are outside the grid
            node.parts.push_back({ball, material});
            crowd.add_node(std::move(node));
            if (last) return voxelize(crowd, grid, {});
        }
    };
    const Voxels alone = with_others(0), among = with_others(std::size_t{groups_a_row} * 64);
    EXPECT_GT(alone.records.size(), 1000u);
    EXPECT_EQ(among.records.size(), alone.records.size());
    EXPECT_NEAR(among.total(0, voxel_field_area), alone.total(0, voxel_field_area), 1e-2);
}

TEST_F(Voxelization, TheRasterizerFindsTheSameVoxelsAndSums) {
    add_mesh(scene, tessellate(Sphere{{0.1f, 0.2f, 0.3f}, 0.5f}, 64), grey);
    add_mesh(scene, torus_knot_mesh(2, 3, 0.85f, 0.16f, 1200), grey, {.rotation = rotation_from_euler_deg({10, 20, 30})});
    add_shape_node(scene, Box{glm::vec3(-0.7f), glm::vec3(0.66f)}, grey, {.rotation = rotation_from_euler_deg({5, 15, 25})});
    add_shape_node(scene, Quad{{-3, -0.91f, -2.5f}, {0, 0.1f, 7}, {6, 0, 0.3f}}, grey);  // far beyond the grid
    add_mesh(scene, Mesh{.positions = {{-1, -1, -1}, {1, 1, 0.99f}, {1, 1, 1}}, .indices = {0, 1, 2}}, grey);  // a sliver
    const VoxelGrid grid = grid_over(glm::vec3(-1.01f), 2, 64);
    const Voxels compute = voxelize(scene, grid, {}), raster = voxelize(scene, grid, {}, &passes::add_voxelize_raster);
    EXPECT_GT(compute.records.size(), 15000u);
    EXPECT_EQ(raster.records.size(), compute.records.size());
    double worst = 0;
    for (const auto& [place, record] : compute.records) {
        const auto found = raster.records.find(place);
        ASSERT_NE(found, raster.records.end()) << "voxel " << place;
        for (std::uint32_t i = 0; i < record_words; ++i)
            worst = std::max(worst, std::abs(Voxels::field(found->second, 0, i) - Voxels::field(record, 0, i)));
    }
    // The same formulas, but two compilations of them may round differently.
    EXPECT_LE(worst, 32.0 / voxel_fixed_one);
    EXPECT_TRUE(voxelize(scene, grid, {}, &passes::add_voxelize_raster).records == raster.records) << "and every run the same";
}

}  // namespace
}  // namespace heliodon::tests
