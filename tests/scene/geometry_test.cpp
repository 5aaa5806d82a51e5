#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/camera.h"
#include "scene/geometry.h"
#include "scene/light.h"

namespace heliodon {
namespace {

struct Triangle {
    glm::dvec3 a, b, c;
    [[nodiscard]] glm::dvec3 area_vector() const { return 0.5 * glm::cross(b - a, c - a); }
};

std::vector<Triangle> triangles_of(const Mesh& mesh) {
    std::vector<Triangle> result;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        result.push_back({mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                          mesh.positions[mesh.indices[i + 2]]});
    return result;
}

double area(const Mesh& mesh) {
    double total = 0;
    for (const Triangle& triangle : triangles_of(mesh)) total += glm::length(triangle.area_vector());
    return total;
}

/// By the divergence theorem; positive where a closed mesh faces outward.
double enclosed_volume(const Mesh& mesh) {
    double total = 0;
    for (const Triangle& triangle : triangles_of(mesh)) total += glm::dot(triangle.a, triangle.area_vector()) / 3.0;
    return total;
}

void expect_sound(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    ASSERT_EQ(mesh.texcoords[0].size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1, 1e-6);
        EXPECT_NEAR(glm::length(glm::vec3(mesh.tangents[i])), 1, 1e-6);
        EXPECT_NEAR(glm::dot(glm::vec3(mesh.tangents[i]), mesh.normals[i]), 0, 1e-6);
    }
    const std::vector<Triangle> triangles = triangles_of(mesh);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Triangle& triangle = triangles[i / 3];
        ASSERT_GT(glm::length(triangle.area_vector()), 0);
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_GT(glm::dot(triangle.area_vector(), glm::dvec3(mesh.normals[mesh.indices[i + corner]])), 0)
                << "a triangle faces away from its vertex normals";
    }
}

/// The tangent and bitangent follow the texture: ∂position/∂u along the tangent, −∂position/∂v along the bitangent.
void expect_tangents_follow_texture(const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t* corner = &mesh.indices[i];
        const glm::vec3 e1 = mesh.positions[corner[1]] - mesh.positions[corner[0]];
        const glm::vec3 e2 = mesh.positions[corner[2]] - mesh.positions[corner[0]];
        const glm::vec2 t1 = mesh.texcoords[0][corner[1]] - mesh.texcoords[0][corner[0]];
        const glm::vec2 t2 = mesh.texcoords[0][corner[2]] - mesh.texcoords[0][corner[0]];
        const float determinant = t1.x * t2.y - t2.x * t1.y;
        ASSERT_NE(determinant, 0);
        const glm::vec3 along_u = (e1 * t2.y - e2 * t1.y) / determinant;
        const glm::vec3 along_v = (e2 * t1.x - e1 * t2.x) / determinant;
        const glm::vec4 tangent = mesh.tangents[corner[0]];
        const glm::vec3 bitangent = tangent.w * glm::cross(mesh.normals[corner[0]], glm::vec3(tangent));
        EXPECT_GT(glm::dot(glm::normalize(along_u), glm::vec3(tangent)), 0.8f);
        EXPECT_LT(glm::dot(glm::normalize(along_v), bitangent), -0.8f);
    }
}

TEST(Tessellation, OfAQuadIsExactAndFacesUCrossV) {
    const Quad quad{{1, 2, 3}, {0, 0, 2}, {4, 0, 0}};
    const Mesh mesh = tessellate(quad, 16);
    EXPECT_EQ(mesh.triangle_count(), 2u);
    EXPECT_NEAR(area(mesh), 8, 1e-6);
    for (const glm::vec3& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 1, 0));
    expect_sound(mesh);
    expect_tangents_follow_texture(mesh);
}

TEST(Tessellation, OfABoxIsExactAndFacesOutward) {
    const Mesh mesh = tessellate(Box{{-1, 0, 2}, {1, 3, 6}}, 16);
    EXPECT_EQ(mesh.triangle_count(), 12u);
    EXPECT_NEAR(area(mesh), 2 * (2 * 3 + 3 * 4 + 2 * 4), 1e-5);
    EXPECT_NEAR(enclosed_volume(mesh), 2 * 3 * 4, 1e-5);
    expect_sound(mesh);
    expect_tangents_follow_texture(mesh);
}

TEST(Tessellation, OfASphereFacesOutwardAndConvergesToItsVolume) {
    const Sphere sphere{{1, -2, 3}, 0.5f};
    const double exact = 4.0 / 3.0 * std::numbers::pi * 0.125;
    for (const int segments : {3, 8, 32, 128}) {
        const Mesh mesh = tessellate(sphere, segments);
        expect_sound(mesh);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            EXPECT_NEAR(glm::length(mesh.positions[i] - sphere.center - 0.5f * mesh.normals[i]), 0, 1e-6);
    }
    const double error_32 = exact - enclosed_volume(tessellate(sphere, 32));
    const double error_128 = exact - enclosed_volume(tessellate(sphere, 128));
    EXPECT_GT(error_128, 0);
    EXPECT_NEAR(error_32 / error_128, 16, 1) << "expected second-order convergence";
    expect_tangents_follow_texture(tessellate(sphere, 64));
}

TEST(Tessellation, OfADiskIsARegularPolygonFacingItsNormal) {
    const Disk disk{{0, 1, 0}, {1, 1, 0}, 2};
    const Mesh mesh = tessellate(disk, 64);
    EXPECT_EQ(mesh.triangle_count(), 64u);
    EXPECT_NEAR(area(mesh), 0.5 * 64 * 4 * std::sin(2 * std::numbers::pi / 64), 1e-4);
    expect_sound(mesh);
    expect_tangents_follow_texture(mesh);
}

TEST(Tessellation, ClampsAbsurdSegmentCounts) {
    EXPECT_EQ(tessellate(Disk{}, -5).triangle_count(), 3u);
    EXPECT_EQ(tessellate(Disk{}, 1 << 30).triangle_count(), 4096u);
}

TEST(Geometry, DiskTangentIsPerpendicularForEveryNormal) {
    for (const glm::vec3 direction : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0, 0, 1),
                                      glm::vec3(1e-3f, 1, 1e-3f), glm::vec3(1, -2, 3)}) {
        const glm::vec3 normal = glm::normalize(direction);
        EXPECT_NEAR(glm::dot(disk_tangent(normal), normal), 0, 1e-6);
        EXPECT_NEAR(glm::length(disk_tangent(normal)), 1, 1e-6);
    }
    EXPECT_EQ(disk_tangent({0, 1, 0}), glm::vec3(1, 0, 0));
    EXPECT_EQ(disk_tangent({0, -1, 0}), glm::vec3(1, 0, 0));
}

TEST(Geometry, BoundsOfShapesAreExact) {
    const Bounds sphere = bounds(Sphere{{1, 2, 3}, 2});
    EXPECT_EQ(sphere.min, glm::vec3(-1, 0, 1));
    EXPECT_EQ(sphere.max, glm::vec3(3, 4, 5));
    const Bounds disk = bounds(Disk{{0, 5, 0}, {0, 2, 0}, 3});
    EXPECT_NEAR(glm::length(disk.min - glm::vec3(-3, 5, -3)), 0, 1e-6);
    EXPECT_NEAR(glm::length(disk.max - glm::vec3(3, 5, 3)), 0, 1e-6);
    EXPECT_EQ(bounds(Quad{{0, 0, 0}, {-1, 0, 0}, {0, 2, 0}}).min, glm::vec3(-1, 0, 0));
}

TEST(Geometry, BytesCountEveryArray) {
    Mesh mesh;
    mesh.positions.resize(10);
    mesh.normals.resize(10);
    mesh.tangents.resize(10);
    mesh.texcoords[0].resize(10);
    mesh.texcoords[1].resize(10);
    mesh.colors.resize(10);
    mesh.indices.resize(6);
    EXPECT_EQ(mesh.bytes(), 10u * (12 + 12 + 16 + 8 + 8 + 16) + 6 * 4);
    EXPECT_TRUE(Mesh{}.bounds().empty());
}

/// Flux per candela by integrating the light's distribution over the sphere.
double integrated_flux(const Light& light) {
    const double cos_inner = std::cos(static_cast<double>(light.inner_rad));
    const double cos_outer = std::cos(static_cast<double>(light.outer_rad));
    const int steps = 2'000'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double cosine = -1 + 2 * (i + 0.5) / steps;
        const double ramp = std::clamp((cosine - cos_outer) / (cos_inner - cos_outer), 0.0, 1.0);
        const double spot = ramp * ramp, lambertian = std::max(cosine, 0.0);
        sum += light.type == LightType::spot ? spot : light.lambertian ? lambertian : 1.0;
    }
    return sum * 2.0 / steps * 2.0 * std::numbers::pi;
}

TEST(Light, FluxPerCandelaIsTheIntegralOfTheDistribution) {
    EXPECT_NEAR(flux_per_candela({}), integrated_flux({}), 1e-9);
    const Light lambertian{.lambertian = true};
    EXPECT_NEAR(flux_per_candela(lambertian), integrated_flux(lambertian), 1e-5);
    for (const auto& [inner, outer] : {std::pair{0.0f, 0.5f}, {0.35f, 0.52f}, {0.2f, 1.5f}}) {
        const Light spot{.type = LightType::spot, .inner_rad = inner, .outer_rad = outer};
        EXPECT_NEAR(flux_per_candela(spot), integrated_flux(spot), 1e-5) << inner << " " << outer;
    }
    const Light hard{.type = LightType::spot, .inner_rad = 1, .outer_rad = 1};
    EXPECT_NEAR(flux_per_candela(hard), 2 * std::numbers::pi * (1 - std::cos(1.0)), 1e-6);
    EXPECT_EQ(flux_per_candela({.type = LightType::directional}), 0);
}

TEST(Light, FluxWeighsColourByLuminance) {
    const Light green{.intensity = {0, 10, 0}};
    EXPECT_NEAR(flux_lm(green), 7.152 * 4 * std::numbers::pi, 1e-6);
}

// The published example: f/16, 1/125 s, ISO 100 is EV 14.966.
TEST(Camera, ExposureValueOfSunny16) {
    const Camera camera{.aperture_f = 16, .shutter_s = 1.0f / 125, .iso = 100};
    EXPECT_NEAR(camera.ev100(), 14.966, 5e-4);
    EXPECT_EQ((Camera{.ev100_override = 3.0f}.ev100()), 3.0f);
}

TEST(Camera, LooksAlongMinusZOfViewSpace) {
    const Camera camera{.position = {1, 2, 3}, .target = {1, 2, -7}};
    EXPECT_NEAR(glm::length(glm::vec3(camera.world_to_view() * glm::vec4(1, 2, -7, 1)) - glm::vec3(0, 0, -10)), 0,
                1e-5);
    const glm::vec4 right = camera.world_to_view() * glm::vec4(1, 0, 0, 0),
                    up = camera.world_to_view() * glm::vec4(0, 1, 0, 0);
    EXPECT_NEAR(right.x, 1, 1e-6);
    EXPECT_NEAR(up.y, 1, 1e-6);
}

TEST(Camera, ViewStaysFiniteWhenLookingStraightUp) {
    const glm::mat4 view = Camera{.position = {0, 0, 0}, .target = {0, 5, 0}, .up = {0, 1, 0}}.world_to_view();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) EXPECT_TRUE(std::isfinite(view[column][row]));
    EXPECT_NEAR(std::abs(glm::determinant(view)), 1, 1e-5);
}

}  // namespace
}  // namespace heliodon
