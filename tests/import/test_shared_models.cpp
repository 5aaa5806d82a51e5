#include <gtest/gtest.h>

#include "import/import.h"
#include "shared_data.h"

namespace heliodon {
namespace {

struct Counts {
    std::size_t triangles = 0, bytes = 0;
};

Counts count(const Scene& scene) {
    Counts counts;
    scene.geometries().each([&](GeometryId, const Geometry& geometry) {
        counts.triangles += geometry.mesh.triangle_count();
        counts.bytes += geometry.mesh.bytes();
    });
    scene.textures().each([&](TextureId, const Texture& texture) { counts.bytes += texture.bytes(); });
    return counts;
}

struct Expected {
    const char* file;
    std::size_t triangles, materials, images_at_most;
    glm::vec3 extent;
};

class SharedModel : public testing::TestWithParam<Expected> {};

TEST_P(SharedModel, LoadsWhole) {
    const Expected& expected = GetParam();
    const auto path = tests::shared_path(expected.file);
    if (!path) GTEST_SKIP() << "no shared data";
    Scene scene;
    Warnings warnings;
    const auto root = import_model(scene, {}, *path, warnings);
    ASSERT_TRUE(root) << root.error().text();
    for (const Error& w : warnings) std::cout << w.text() << "\n";
    const Counts counts = count(scene);
    std::cout << expected.file << " " << counts.triangles << " " << counts.bytes << " " << scene.bounds().min.x << " " << scene.bounds().min.y << " " << scene.bounds().min.z << " / "
              << scene.bounds().max.x << " " << scene.bounds().max.y << " " << scene.bounds().max.z << " textures " << scene.textures().size()
              << " materials " << scene.materials().size() << " geometries " << scene.geometries().size() << "\n";
}

INSTANTIATE_TEST_SUITE_P(Import, SharedModel,
                         testing::Values(Expected{"models/car.glb", 0, 45, 8, {}}, Expected{"models/damaged-helmet.glb", 15452, 1, 5, {}},
                                         Expected{"models/dragon.glb", 348503, 1, 0, {}}, Expected{"models/lucy.glb", 79976, 1, 0, {}},
                                         Expected{"models/sponza.glb", 262267, 25, 57, {}}, Expected{"models/suzanne.glb", 15744, 1, 0, {}},
                                         Expected{"models/teapot.obj", 6320, 0, 0, {}}));

TEST(Scenes, Load) {
    for (const char* name : {"scenes/cornell.heliodon.json", "scenes/natus.heliodon.json", "scenes/car.heliodon.json", "scenes/sponza.heliodon.json", "models/suzanne.glb"}) {
        const auto path = tests::shared_path(name);
        if (!path) GTEST_SKIP();
        Warnings warnings;
        const auto scene = load_scene(*path, {}, warnings);
        ASSERT_TRUE(scene) << scene.error().text();
        for (const Error& w : warnings) std::cout << w.text() << "\n";
        std::cout << name << " " << count(*scene).triangles << "\n";
    }
}

}  // namespace
}  // namespace heliodon
