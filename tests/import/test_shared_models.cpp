#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "import/import.h"
#include "shared_data.h"

namespace heliodon {
namespace {

struct Expected {
    const char* file;
    std::size_t triangles;  ///< of the file, those without area included
    std::size_t without_area, geometries, materials, textures;
};

std::size_t triangles_of(const Scene& scene) {
    std::size_t triangles = 0;
    scene.geometries().each([&](GeometryId, const Geometry& geometry) { triangles += geometry.mesh.triangle_count(); });
    return triangles;
}

void expect_sound(const Geometry& geometry) {
    const Mesh& mesh = geometry.mesh;
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size()) << geometry.name;
    std::size_t bad_indices = 0, bad_normals = 0, bad_tangents = 0;
    for (const std::uint32_t index : mesh.indices) bad_indices += index >= mesh.positions.size();
    for (const glm::vec3& normal : mesh.normals) bad_normals += !(std::abs(glm::length(normal) - 1) < 1e-4f);
    for (const glm::vec4& tangent : mesh.tangents)
        bad_tangents += !(std::abs(glm::length(glm::vec3(tangent)) - 1) < 1e-4f);
    EXPECT_EQ(bad_indices + bad_normals + bad_tangents, 0u) << geometry.name;
    EXPECT_EQ(geometry.bounds.min, mesh.bounds().min);
    EXPECT_EQ(geometry.bounds.max, mesh.bounds().max);
}

class SharedModel : public testing::TestWithParam<Expected> {};

TEST_P(SharedModel, LoadsWhole) {
    const Expected& expected = GetParam();
    const auto path = tests::shared_path(expected.file);
    if (!path) GTEST_SKIP() << "no shared data";
    Scene scene;
    Warnings warnings;
    const auto root = import_model(scene, {}, *path, warnings);
    ASSERT_TRUE(root) << root.error().text();
    EXPECT_EQ(triangles_of(scene) + expected.without_area, expected.triangles);
    EXPECT_EQ(scene.geometries().size(), expected.geometries);
    EXPECT_EQ(scene.materials().size(), expected.materials);
    EXPECT_EQ(scene.textures().size(), expected.textures);
    scene.geometries().each([](GeometryId, const Geometry& geometry) { expect_sound(geometry); });
    scene.materials().each([&](MaterialId, const Material& material) {
        if (!material.normal_texture.texture) return;
        scene.nodes().each([&](NodeId, const Node& node) {
            for (const Part& part : node.parts)
                if (scene.materials().find(part.material) == &material)
                    EXPECT_FALSE(scene.geometries().find(part.geometry)->mesh.tangents.empty()) << material.name;
        });
    });
}

TEST_P(SharedModel, PeakMemoryStaysBelowThreeTimesWhatIsDecoded) {
    if (HELIODON_SANITIZED) GTEST_SKIP() << "a sanitizer keeps freed memory to see who still uses it";
    const auto path = tests::shared_path(GetParam().file);
    if (!path) GTEST_SKIP() << "no shared data";
    const std::string command = std::string("\"") + HELIODON_PEAK_MEMORY + "\" \"" + path->string() + "\"";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    ASSERT_TRUE(pipe);
    unsigned long long decoded = 0, peak = 0;
    ASSERT_EQ(std::fscanf(pipe.get(), "%llu %llu", &decoded, &peak), 2);
    EXPECT_GT(decoded, 0u);
    EXPECT_GT(peak, decoded);
    EXPECT_LT(peak, 3 * decoded + (64ull << 20));
    RecordProperty("peak_over_decoded_percent", int(100 * peak / decoded));
}

// The helmet's five pictures are four textures: its occlusion is packed with roughness and metal.
INSTANTIATE_TEST_SUITE_P(Import, SharedModel,
                         testing::Values(Expected{"models/car.glb", 145917, 0, 46, 45, 8},
                                         Expected{"models/damaged-helmet.glb", 15452, 0, 1, 1, 4},
                                         Expected{"models/dragon.glb", 348503, 579, 1, 1, 0},
                                         Expected{"models/lucy.glb", 79976, 7, 1, 1, 0},
                                         Expected{"models/sponza.glb", 262267, 0, 25, 25, 57},
                                         Expected{"models/suzanne.glb", 15744, 0, 1, 1, 0},
                                         Expected{"models/teapot.obj", 6320, 0, 1, 0, 0}),
                         [](const auto& info) {
                             std::string name = std::filesystem::path(info.param.file).stem().string();
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(SharedModels, TheTeapotIsSmoothWithCreases) {
    const auto path = tests::shared_path("models/teapot.obj");
    if (!path) GTEST_SKIP() << "no shared data";
    Scene scene;
    Warnings warnings;
    ASSERT_TRUE(import_model(scene, {}, *path, warnings));
    const Mesh& mesh = scene.geometries().at(0)->mesh;
    EXPECT_GE(mesh.positions.size(), 3241u) << "at least one vertex a place";
    EXPECT_LT(mesh.positions.size(), 2 * 3644u) << "far below the 18 960 corners of flat shading";
    EXPECT_FALSE(mesh.normals.empty());
}

TEST(SharedModels, SceneFilesLoad) {
    for (const auto& [name, triangles] : {std::pair{"scenes/natus.heliodon.json", std::size_t(449967)},
                                          {"scenes/sponza.heliodon.json", std::size_t(262267)},
                                          {"scenes/cornell-point.heliodon.json", std::size_t(34)},
                                          {"scenes/car.heliodon.json", std::size_t(145919)}}) {
        const auto path = tests::shared_path(name);
        if (!path) GTEST_SKIP() << "no shared data";
        Warnings warnings;
        const auto scene = load_scene(*path, {}, warnings);
        ASSERT_TRUE(scene) << scene.error().text();
        EXPECT_EQ(triangles_of(*scene), triangles) << name;
    }
}

}  // namespace
}  // namespace heliodon
