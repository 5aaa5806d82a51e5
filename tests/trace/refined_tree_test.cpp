// The tree that pictures of many rays are traced in, against the one that a change of the scene builds.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "scene_building.h"
#include "trace/embree_scene.h"
#include "trace/triangle_pairs.h"

namespace heliodon::tests {
namespace {

/// A closed surface around the origin, its triangles out of order and begun at any corner.
Geometry bumpy_ball(std::uint32_t rows, std::uint32_t columns) {
    Geometry geometry;
    Mesh& mesh = geometry.mesh;
    const auto at = [&](std::uint32_t row, std::uint32_t column) {
        return row == 0 ? 0 : row == rows ? 1 : 2 + (row - 1) * columns + column % columns;
    };
    mesh.positions = {{.1f, 2, 0}, {.1f, -2, 0}};
    for (std::uint32_t row = 1; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const double polar = pi * row / rows, turn = 2 * pi * column / columns;
            const double radius = 2 + .2 * std::sin(7 * polar) * std::cos(5 * turn);
            mesh.positions.emplace_back(.1 + radius * std::sin(polar) * std::cos(turn), radius * std::cos(polar),
                                        radius * std::sin(polar) * std::sin(turn));
        }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            if (row > 0) triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column)});
            if (row + 1 < rows)
                triangles.push_back({at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)});
        }
    std::mt19937 random(5);
    std::shuffle(triangles.begin(), triangles.end(), random);
    for (std::array<std::uint32_t, 3>& triangle : triangles) {
        std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
        mesh.indices.insert(mesh.indices.end(), triangle.begin(), triangle.end());
    }
    geometry.bounds = mesh.bounds();
    return geometry;
}

TEST(TrianglePairs, HoldEachTriangleOnceAndNameItsPoints) {
    const Geometry ball = bumpy_ball(40, 60);
    const Mesh& mesh = ball.mesh;
    const trace::TrianglePairs pairs = trace::pair_triangles(mesh);
    ASSERT_EQ(pairs.corners.size(), pairs.members.size());
    EXPECT_LT(pairs.members.size(), mesh.triangle_count() * 0.6);
    std::set<std::uint32_t> seen;
    for (std::uint32_t i = 0; i < pairs.members.size(); ++i) {
        const glm::uvec4 q = pairs.corners[i];
        for (const bool second : {false, true}) {
            if (second && pairs.members[i].second == trace::TrianglePairs::none) continue;
            // As Embree names points: of the second triangle from the opposite corner.
            const float a = .3f, b = .1f;
            const auto corner = [&](int c) { return mesh.positions[q[c]]; };
            const glm::vec3 point = second ? corner(2) * (1 - a - b) + corner(3) * a + corner(1) * b
                                           : corner(0) * (1 - a - b) + corner(1) * a + corner(3) * b;
            std::uint32_t triangle = i;
            float u = second ? 1 - a : a, v = second ? 1 - b : b;
            trace::unpair(pairs.members[i], triangle, u, v);
            EXPECT_TRUE(seen.insert(triangle).second) << triangle;
            const std::uint32_t* index = &mesh.indices[3 * triangle];
            const glm::vec3 named =
                mesh.positions[index[0]] * (1 - u - v) + mesh.positions[index[1]] * u + mesh.positions[index[2]] * v;
            EXPECT_LT(glm::length(named - point), 1e-6f);
        }
    }
    EXPECT_EQ(seen.size(), mesh.triangle_count());
}

TEST(TrianglePairs, LeaveStrangersAlone) {
    const Geometry apart = triangle_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    const trace::TrianglePairs pairs = trace::pair_triangles(apart.mesh);
    ASSERT_EQ(pairs.members.size(), 2u);
    for (const auto& members : pairs.members) EXPECT_EQ(members.second, trace::TrianglePairs::none);
}

/// Both trees of a scene of one mesh.
class RefinedTree : public testing::Test {
protected:
    RefinedTree() {
        ball_ = add_mesh(scene_, bumpy_ball(60, 80), lambert(.5f));
        for (trace::EmbreeScene* each : {&plain_, &refined_}) EXPECT_TRUE(each->update(flat_, everything()));
        EXPECT_TRUE(refined_.choose_tree(flat_, 1u << 20));
    }
    convert::FlatChanges everything() {
        flat_ = {};
        return flat_.update(scene_);
    }
    const Mesh& mesh() const { return flat_.geometries()[0]->mesh; }

    Scene scene_;
    NodeId ball_;
    convert::FlatScene flat_;
    trace::EmbreeScene plain_, refined_;
    std::mt19937 random_{7};
};

shading::KernelRay ray_of(glm::vec3 origin, glm::vec3 direction) {
    shading::KernelRay ray{};
    ray.kind = shading::kernel_ray_scatter;
    ray.origin = origin;
    ray.direction = glm::normalize(direction);
    ray.t_max = shading::kernel_infinity;
    return ray;
}

TEST_F(RefinedTree, IsMetWhereTheOtherIs) {
    std::uniform_real_distribution<float> anywhere(-3, 3);
    const auto point = [&] { return glm::vec3(anywhere(random_), anywhere(random_), anywhere(random_)); };
    int same = 0, met = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 origin = point();
        const shading::KernelRay ray = ray_of(origin, point() - origin);
        const shading::KernelHit a = plain_.trace(ray), b = refined_.trace(ray);
        ASSERT_EQ(a.kind, b.kind);
        if (a.kind != shading::kernel_hit_surface) continue;
        ++met;
        EXPECT_NEAR(a.t, b.t, 1e-5f * a.t + 2e-6f);
        same += a.primitive == b.primitive && glm::length(a.barycentric - b.barycentric) < 1e-3f;
    }
    EXPECT_GT(met, 10000);
    EXPECT_GE(same, met - 20) << "but for rays through an edge";
}

TEST_F(RefinedTree, LetsNoRayThroughAnEdge) {
    std::uniform_real_distribution<float> part(0, 1);
    for (std::size_t triangle = 0; triangle < mesh().triangle_count(); ++triangle) {
        trace::KernelRays8 rays{};
        rays.kind = shading::kernel_ray_scatter;
        for (int i = 0; i < 8; ++i) {
            const glm::vec3 origin = glm::vec3(part(random_), part(random_), part(random_)) - .5f;
            const glm::vec3 a = mesh().positions[mesh().indices[3 * triangle + i % 3]],
                            b = mesh().positions[mesh().indices[3 * triangle + (i + 1) % 3]];
            const shading::KernelRay ray = ray_of(origin, glm::mix(a, b, part(random_)) - origin);
            ASSERT_EQ(refined_.trace(ray).kind, shading::kernel_hit_surface);
            rays.valid[i] = -1;
            rays.t_max[i] = ray.t_max;
            for (int axis = 0; axis < 3; ++axis)
                rays.origin[axis][i] = ray.origin[axis], rays.direction[axis][i] = ray.direction[axis];
        }
        trace::KernelHits8 hits;
        refined_.trace(rays, hits);
        for (int i = 0; i < 8; ++i) ASSERT_EQ(hits.kind[i], shading::kernel_hit_surface);
    }
}

TEST_F(RefinedTree, IsLeftWhenTheSceneChanges) {
    const shading::KernelRay up = ray_of({0, 0, 0}, {0, 1, .01f}), down = ray_of({0, 0, 0}, {0, -1, .01f});
    const float bottom = refined_.trace(down).t;
    const NodeId lid = add_mesh(scene_, triangle_mesh({{-9, 1, -9}, {0, 1, 9}, {9, 1, -9}}), lambert(.5f));
    const auto first = refined_.update(flat_, flat_.update(scene_));
    ASSERT_TRUE(first) << first.error().text();
    EXPECT_NEAR(refined_.trace(up).t, 1, 1e-3);
    EXPECT_NEAR(refined_.trace(down).t, bottom, 1e-5);
    ASSERT_TRUE(refined_.choose_tree(flat_, 1u << 20));
    EXPECT_NEAR(refined_.trace(up).t, 1, 1e-3);
    EXPECT_NEAR(refined_.trace(down).t, bottom, 1e-5);
    Transform raised;
    raised.translation.y = .5f;
    ASSERT_TRUE(scene_.set_transform(lid, raised));
    ASSERT_TRUE(refined_.update(flat_, flat_.update(scene_)));
    EXPECT_NEAR(refined_.trace(up).t, 1.5, 1e-3);
    EXPECT_NEAR(refined_.trace(down).t, bottom, 1e-5);
}

TEST_F(RefinedTree, DependsOnThePictureNotOnThoseBefore) {
    std::uniform_real_distribution<float> anywhere(-3, 3);
    const auto point = [&] { return glm::vec3(anywhere(random_), anywhere(random_), anywhere(random_)); };
    std::vector<shading::KernelRay> rays;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 origin = point();
        rays.push_back(ray_of(origin, point() - origin));
    }
    const auto hits = [&](const trace::EmbreeScene& tree) {
        std::vector<std::array<float, 3>> all;
        for (const shading::KernelRay& ray : rays) {
            const shading::KernelHit hit = tree.trace(ray);
            if (hit.kind == shading::kernel_hit_surface) all.push_back({hit.t, hit.barycentric.x, hit.barycentric.y});
        }
        return all;
    };
    const auto plain = hits(plain_), refined = hits(refined_);
    EXPECT_NE(plain, refined) << "or the rest says nothing";
    ASSERT_TRUE(refined_.choose_tree(flat_, 5000));
    EXPECT_EQ(hits(refined_), plain) << "of a picture that is too small";
    ASSERT_TRUE(refined_.choose_tree(flat_, 1u << 20));
    EXPECT_EQ(hits(refined_), refined);
}

TEST_F(RefinedTree, StaysWhereOnlyLightChanges) {
    const shading::KernelRay ray = ray_of({0, 0, 0}, {.3f, 1, .2f});
    add_light(scene_, point_light(5), {0, 0, 0});
    scene_.set_sky(even_sky(3));
    scene_.set_material(scene_.nodes().find(ball_)->parts[0].material, lambert(.2f));
    const auto update = refined_.update(flat_, flat_.update(scene_));
    ASSERT_TRUE(update);
    EXPECT_FALSE(update->top_level_built);
    EXPECT_EQ(update->geometries_built, 0);
    const float t = refined_.trace(ray).t;
    trace::EmbreeScene fresh;
    ASSERT_TRUE(fresh.update(flat_, everything()));
    ASSERT_TRUE(fresh.choose_tree(flat_, 1u << 20));
    EXPECT_EQ(fresh.trace(ray).t, t);
}

TEST_F(RefinedTree, AnswersShadowRaysThroughWhatIsTranslucent) {
    Material glass = lambert(0);
    glass.alpha_mode = AlphaMode::blend;
    glass.opacity = .5f;
    const NodeId pane = add_mesh(scene_, triangle_mesh({{-9, 1, -9}, {0, 1, 9}, {9, 1, -9}}), glass);
    for (const bool refine : {false, true}) {
        trace::EmbreeScene tree;
        ASSERT_TRUE(tree.update(flat_, everything()));
        if (refine) ASSERT_TRUE(tree.choose_tree(flat_, 1u << 20));
        shading::KernelRay ray = ray_of({0, 0, 0}, {0, 1, .01f});
        ray.kind = shading::kernel_ray_shadow;
        EXPECT_EQ(tree.trace(ray).kind, shading::kernel_hit_blocked) << "by the ball behind the pane";
        ray.t_max = 1.5f;
        const shading::KernelHit hit = tree.trace(ray);
        ASSERT_EQ(hit.kind, shading::kernel_hit_surface);
        EXPECT_NEAR(hit.t, 1, 1e-3);
        EXPECT_EQ(
            flat_.materials()[flat_.instances()[hit.instance].material].flags & shading::material_flag_alpha_blend,
            shading::material_flag_alpha_blend);
        ray.t_max = .9f;
        EXPECT_EQ(tree.trace(ray).kind, shading::kernel_hit_nothing);
        scene_.set_material(scene_.nodes().find(pane)->parts[0].material, lambert(0));
        ASSERT_TRUE(tree.update(flat_, flat_.update(scene_)));
        ray.t_max = 1.5f;
        EXPECT_EQ(tree.trace(ray).kind, shading::kernel_hit_blocked) << "by what was a pane";
        scene_.set_material(scene_.nodes().find(pane)->parts[0].material, glass);
    }
}

}  // namespace
}  // namespace heliodon::tests
