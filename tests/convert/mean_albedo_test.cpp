#include "convert/mean_albedo.h"

#include <gtest/gtest.h>

namespace heliodon::convert {
namespace {

MaterialId add_material(Scene& scene, glm::vec3 albedo, AlphaMode mode = AlphaMode::opaque) {
    Material material;
    material.model = MaterialModel::lambert;
    material.base_color = albedo;
    material.alpha_mode = mode;
    return scene.add_material(std::move(material));
}

NodeId add_square(Scene& scene, float side, MaterialId material) {
    Node node;
    node.parts.push_back({scene.add_shape(Quad{{0, 0, 0}, {side, 0, 0}, {0, side, 0}}), material});
    return scene.add_node(std::move(node));
}

void expect_near(glm::vec3 found, glm::vec3 expected) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5f);
}

glm::vec3 albedo_of(const FlatScene& flat) {
    return MeanAlbedo().of(flat, std::vector<std::uint64_t>(flat.geometries().size()));
}

TEST(MeanAlbedo, SurfacesCountByTheirAreaInTheWorld) {
    Scene scene;
    add_square(scene, 1, add_material(scene, {0.2f, 0.4f, 0.6f}));
    const NodeId other = add_square(scene, 1, add_material(scene, {0.6f, 0.0f, 0.6f}));
    FlatScene flat;
    flat.update(scene);
    expect_near(albedo_of(flat), {0.4f, 0.2f, 0.6f});
    Transform wider;
    wider.scale = {3, 1, 1};
    scene.set_transform(other, wider);
    flat.update(scene);
    expect_near(albedo_of(flat), {0.5f, 0.1f, 0.6f});
}

TEST(MeanAlbedo, WhatOnlyMovesIsNotLookedAtAgain) {
    Scene scene;
    add_square(scene, 1, add_material(scene, {0.2f, 0.4f, 0.6f}));
    const NodeId other = add_square(scene, 1, add_material(scene, {0.6f, 0.0f, 0.6f}));
    FlatScene flat;
    MeanAlbedo kept;
    const auto found = [&] {
        flat.update(scene);
        return kept.of(flat, std::vector<std::uint64_t>(flat.geometries().size()));
    };
    found();
    EXPECT_EQ(kept.meshes_measured(), 2u);
    Transform moved;
    moved.translation = {1, 2, 3};
    moved.rotation = glm::angleAxis(1.0f, glm::normalize(glm::vec3(1, 2, 3)));
    scene.set_transform(other, moved);
    expect_near(found(), {0.4f, 0.2f, 0.6f});
    EXPECT_EQ(kept.meshes_measured(), 2u);
    moved.scale = {3, 1, 1};
    scene.set_transform(other, moved);
    expect_near(found(), {0.5f, 0.1f, 0.6f});
    EXPECT_EQ(kept.meshes_measured(), 3u);
}

TEST(MeanAlbedo, WhatIsBlendedOrHiddenDoesNotCountAndNothingReflectsNothing) {
    Scene scene;
    FlatScene flat;
    flat.update(scene);
    expect_near(albedo_of(flat), glm::vec3(0));
    add_square(scene, 1, add_material(scene, glm::vec3(0.5f)));
    add_square(scene, 5, add_material(scene, glm::vec3(0.9f), AlphaMode::blend));
    scene.set_visible(add_square(scene, 5, add_material(scene, glm::vec3(0.9f))), false);
    flat.update(scene);
    expect_near(albedo_of(flat), glm::vec3(0.5f));
}

TEST(MeanAlbedo, OfATextureTheMeanOfItsTexelsCounts) {
    Scene scene;
    Texture texture;
    texture.width = 2, texture.height = 1;
    texture.format = TextureFormat::linear8;
    texture.levels = {{0, 0, 0, 255, 204, 102, 51, 255}, {102, 51, 26, 255}};
    Material material;
    material.model = MaterialModel::lambert;
    material.base_color = glm::vec3(1);
    material.base_color_texture = TextureUse{scene.add_texture(std::move(texture))};
    add_square(scene, 1, scene.add_material(std::move(material)));
    FlatScene flat;
    flat.update(scene);
    expect_near(albedo_of(flat), glm::vec3(102, 51, 26) / 255.0f);
}

}  // namespace
}  // namespace heliodon::convert
