#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/image_io.h"
#include "import/glb_builder.h"
#include "import/picture_files.h"

namespace heliodon {
namespace {

using tests::first;
using tests::GlbBuilder;

TEST(LoadScene, AModelStandsFramedUnderAnOvercastSky) {
    const tests::TemporaryFolder folder;
    GlbBuilder builder;
    builder.add_square();
    Warnings warnings;
    const auto scene = load_scene(folder.write("square.glb", builder.glb()), {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    ASSERT_EQ(scene->sky().model, SkyModel::image);
    const Texture& sky = *scene->textures().find(scene->sky().image);
    double horizontal = 0, mean = 0;  // integrals over the upper half, and over all directions
    for (int y = 0; y < sky.height; ++y) {
        const double top = std::numbers::pi * y / sky.height, bottom = std::numbers::pi * (y + 1) / sky.height;
        float nits = 0;
        std::memcpy(&nits, &sky.levels[0][std::size_t(y) * sky.width * 16], sizeof nits);
        if (2 * y < sky.height)
            horizontal += nits * std::numbers::pi * (std::pow(std::sin(bottom), 2) - std::pow(std::sin(top), 2));
        mean += nits * 0.5 * (std::cos(top) - std::cos(bottom));
    }
    EXPECT_NEAR(horizontal, 10000, 5);
    ASSERT_EQ(scene->cameras().size(), 1u);
    const Camera& camera = first(scene->cameras());
    // A grey card there has 0.18 of the sky's mean luminance; K = 12.5 at ISO 100.
    EXPECT_NEAR(camera.ev100(), std::log2(0.18 * mean * 100 / 12.5), 1e-3);
    for (int corner = 0; corner < 4; ++corner) {
        const glm::vec4 view = camera.world_to_view() * glm::vec4(corner & 1, corner >> 1, 0, 1);
        EXPECT_LT(view.z, 0);
        EXPECT_LT(std::abs(view.y / view.z), std::tan(camera.vertical_fov_rad / 2) + 1e-5f);
        EXPECT_LT(std::abs(view.x / view.z), std::tan(camera.vertical_fov_rad / 2) + 1e-5f);
    }
    EXPECT_EQ(warnings.size(), 3u) << "sky, camera and exposure are said";
}

TEST(LoadScene, AModelWithLightsKeepsThemAndIsExposedForThem) {
    const tests::TemporaryFolder folder;
    GlbBuilder builder;
    builder.add_square();
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 2000}}};
    builder.json["nodes"][0]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
    Warnings warnings;
    const auto scene = load_scene(folder.write("lit.glb", builder.glb()), {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->sky().model, SkyModel::none);
    EXPECT_NEAR(first(scene->cameras()).ev100(), std::log2(0.18 * 1000 / std::numbers::pi * 100 / 12.5), 1e-3);
}

TEST(LoadScene, OverridesReachAModelsOwnScene) {
    const tests::TemporaryFolder folder;
    GlbBuilder builder;
    builder.add_square();
    const Override overrides[] = {{"render.voxels", "64"}};
    Warnings warnings;
    const auto scene = load_scene(folder.write("square.glb", builder.glb()), overrides, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->render_settings().voxels, 64);
    EXPECT_EQ(scene->geometries().size(), 1u);
}

TEST(LoadScene, SceneFilesPackTexturesAndShareThem) {
    const tests::TemporaryFolder folder;
    folder.write("rough.png", tests::png(1, 1, 1, {100}));
    folder.write("metal.png", tests::png(1, 1, 1, {200}));
    folder.write("normal.png", tests::png(1, 1, 3, {128, 128, 255}));
    GlbBuilder builder;
    builder.add_square();
    folder.write("square.glb", builder.glb());
    const auto path = folder.write("a.heliodon.json", R"({"heliodon": 1,
        "cameras": [{"name": "main", "position": [0,1,3], "target": [0,1,0], "vertical_fov_deg": 40, "ev100": 5}],
        "materials": {"a": {"roughness_texture": "rough.png", "metallic_texture": "metal.png", "normal_texture": "normal.png"},
                      "b": {"roughness_texture": "rough.png", "metallic_texture": "metal.png"}},
        "nodes": [{"name": "s", "mesh": "square.glb", "material": "a"}]})");
    Warnings warnings;
    const auto scene = load_scene(path, {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    const Material& a = *scene->materials().find(scene->find_material("a"));
    const Material& b = *scene->materials().find(scene->find_material("b"));
    EXPECT_EQ(a.orm_texture.texture, b.orm_texture.texture);
    EXPECT_EQ(scene->textures().size(), 2u);
    EXPECT_EQ(scene->textures().find(a.orm_texture.texture)->levels[0],
              (std::vector<std::uint8_t>{255, 100, 200, 255}));
    EXPECT_EQ(first(scene->cameras()).ev100(), 5.0f) << "a scene file's exposure stays";
    scene->geometries().each([](GeometryId, const Geometry& geometry) {
        EXPECT_EQ(geometry.mesh.tangents.size(), 4u) << "the normal map asks for them";
    });
}

TEST(LoadScene, ImageSkiesAreReadAsFloats) {
    const tests::TemporaryFolder folder;
    Picture picture;
    picture.image = Image(8, 4, 3, 100.0f);
    ASSERT_TRUE(write_picture(folder / "sky.hdr", picture));
    const auto path = folder.write("a.heliodon.json",
                                   R"({"heliodon": 1, "nodes": [], "sky": {"model": "image", "image": "sky.hdr"}})");
    Warnings warnings;
    const auto scene = load_scene(path, {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    const Texture* sky = scene->textures().find(scene->sky().image);
    ASSERT_TRUE(sky);
    EXPECT_EQ(sky->format, TextureFormat::float32);
    EXPECT_EQ(sky->wrap_v, Wrap::clamp_to_edge);
}

TEST(LoadScene, ErrorsOfAModelReachTheCaller) {
    Warnings warnings;
    const auto scene = load_scene("/nowhere/model.glb", {}, warnings);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().text().find("/nowhere/model.glb"), std::string::npos);
    const auto unknown = load_scene("/nowhere/model.step", {}, warnings);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().text().find(".obj, .gltf, .glb, .ies or .ldt"), std::string::npos);
}

}  // namespace
}  // namespace heliodon
