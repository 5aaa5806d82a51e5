#include <gtest/gtest.h>

#include <numbers>

#include "import/glb_builder.h"
#include "import/picture_files.h"

namespace heliodon {
namespace {

using tests::first;
using tests::GlbBuilder;
using tests::Json;

/// A square with `material`; pictures are added by the test.
struct MaterialFile {
    GlbBuilder builder;
    Scene scene;

    int add_texture(const std::string& picture, const Json& sampler = {}) {
        builder.json["images"].push_back({{"bufferView", builder.add_view(picture)}, {"mimeType", "image/png"}});
        Json texture = {{"source", builder.json["images"].size() - 1}};
        if (!sampler.is_null()) {
            builder.json["samplers"].push_back(sampler);
            texture["sampler"] = builder.json["samplers"].size() - 1;
        }
        builder.json["textures"].push_back(texture);
        return int(builder.json["textures"].size() - 1);
    }
    const Material& load(const Json& material) {
        builder.add_square({{"material", 0}});
        builder.json["materials"] = Json::array({material});
        std::string error;
        EXPECT_TRUE(builder.load(scene, &error)) << error;
        return first(scene.materials());
    }
    const Texture& texture(const TextureUse& use) const { return *scene.textures().find(use.texture); }
    std::vector<int> texel(const TextureUse& use, std::size_t index = 0) const {
        const auto& level = texture(use).levels.at(0);
        return {level[index * 4], level[index * 4 + 1], level[index * 4 + 2], level[index * 4 + 3]};
    }
};

std::string one_texel(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a = 255) {
    return tests::png(1, 1, 4, {r, g, b, a});
}

TEST(GltfMaterials, FactorsArrive) {
    MaterialFile file;
    const Material& material =
        file.load({{"name", "paint"},
                   {"doubleSided", true},
                   {"emissiveFactor", {1, 0.5, 0}},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}}});
    EXPECT_EQ(material.name, "paint");
    EXPECT_TRUE(material.two_sided);
    EXPECT_EQ(material.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(material.opacity, 1.0f) << "OPAQUE ignores alpha";
    EXPECT_EQ(material.metallic, 0.25f);
    EXPECT_EQ(material.roughness, 0.75f);
    EXPECT_EQ(material.emission_nits, glm::vec3(1, 0.5f, 0));
}

TEST(GltfMaterials, DefaultsAreThoseOfTheSpecification) {
    MaterialFile file;
    const Material& material = file.load(Json::object());
    EXPECT_EQ(material.base_color, glm::vec3(1));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_EQ(material.emission_nits, glm::vec3(0));
    EXPECT_EQ(material.alpha_mode, AlphaMode::opaque);
    EXPECT_FALSE(material.two_sided);
}

TEST(GltfMaterials, FactorsOutsideTheirRangeAreBroughtIntoIt) {
    MaterialFile file;
    const Material& material =
        file.load({{"emissiveFactor", {-1, 2, 0}},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {-1, 5, 0.5, 1}}, {"metallicFactor", 7}, {"roughnessFactor", -3}}}});
    EXPECT_EQ(material.base_color, glm::vec3(0, 1, 0.5f));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 0.0f);
    EXPECT_EQ(material.emission_nits, glm::vec3(0, 2, 0));
    EXPECT_TRUE(file.builder.warned("outside their range"));
}

TEST(GltfMaterials, ExtensionsArrive) {
    MaterialFile file;
    const Material& material =
        file.load({{"emissiveFactor", {1, 1, 1}},
                   {"extensions",
                    {{"KHR_materials_emissive_strength", {{"emissiveStrength", 250}}},
                     {"KHR_materials_ior", {{"ior", 1.33}}},
                     {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                     {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0.25}}}},
                     {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.8}, {"clearcoatRoughnessFactor", 0.1}}}}}});
    EXPECT_EQ(material.emission_nits, glm::vec3(250));
    EXPECT_FLOAT_EQ(material.ior, 1.33f);
    EXPECT_FLOAT_EQ(material.transmission, 0.9f);
    EXPECT_EQ(material.specular, 0.5f);
    EXPECT_EQ(material.specular_color, glm::vec3(1, 0.5f, 0.25f));
    EXPECT_FLOAT_EQ(material.clearcoat, 0.8f);
    EXPECT_FLOAT_EQ(material.clearcoat_roughness, 0.1f);
}

TEST(GltfMaterials, LayersAndVolumesArrive) {
    MaterialFile file;
    const int texture = file.add_texture(one_texel(10, 20, 30, 40));
    const Material& material =
        file.load({{"extensions",
                    {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1.5}}},
                     {"KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}}, {"sheenRoughnessFactor", 0.4}}},
                     {"KHR_materials_iridescence", {{"iridescenceFactor", 0.5}, {"iridescenceIor", 1.8}, {"iridescenceThicknessMaximum", 700},
                                                    {"iridescenceThicknessTexture", {{"index", texture}}}}},
                     {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                     {"KHR_materials_volume", {{"thicknessFactor", 0.1}, {"attenuationColor", {0.9, 0.8, 0.7}}, {"attenuationDistance", 0.25}}}}}});
    EXPECT_FLOAT_EQ(material.anisotropy, 0.6f);
    EXPECT_FLOAT_EQ(material.anisotropy_rotation_rad, 1.5f);
    EXPECT_EQ(material.sheen_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_FLOAT_EQ(material.sheen_roughness, 0.4f);
    EXPECT_FLOAT_EQ(material.iridescence, 0.5f);
    EXPECT_FLOAT_EQ(material.iridescence_ior, 1.8f);
    EXPECT_EQ(material.iridescence_thickness_nm, 700);
    EXPECT_EQ(material.iridescence_thinnest_nm, 100);
    EXPECT_EQ(file.texel(material.iridescence_thickness_texture)[1], 20);
    EXPECT_EQ(material.attenuation_color, glm::vec3(0.9f, 0.8f, 0.7f));
    EXPECT_FLOAT_EQ(material.attenuation_distance_m, 0.25f);
    EXPECT_FALSE(material.thin_walled);
    EXPECT_TRUE(file.builder.warned("whatever thickness"));
}

TEST(GltfMaterials, WhatIsTransmissiveWithoutAVolumeIsASheet) {
    for (const Json& extensions : {Json{{"KHR_materials_transmission", {{"transmissionFactor", 1}}}},
                                   Json{{"KHR_materials_transmission", {{"transmissionFactor", 1}}}, {"KHR_materials_volume", Json::object()}}}) {
        MaterialFile file;
        EXPECT_TRUE(file.load({{"extensions", extensions}}).thin_walled) << extensions;
    }
    MaterialFile opaque;
    EXPECT_FALSE(opaque.load(Json::object()).thin_walled);
}

TEST(GltfMaterials, UnlitMaterialsShowAsADisplayWould) {
    MaterialFile file;
    const Material& material = file.load({{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    EXPECT_EQ(material.model, MaterialModel::unlit);
    EXPECT_EQ(material.emission_nits, glm::vec3(80));
    EXPECT_TRUE(file.builder.warned("80 cd/m²"));
}

TEST(GltfMaterials, OneImageForOcclusionRoughnessAndMetalIsOneTexture) {
    MaterialFile file;
    const int texture = file.add_texture(one_texel(10, 20, 30));
    const Material& material =
        file.load({{"occlusionTexture", {{"index", texture}, {"strength", 0.5}}},
                   {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", texture}}}}}});
    EXPECT_EQ(file.scene.textures().size(), 1u);
    EXPECT_EQ(material.orm_texture.texture, material.occlusion_texture.texture);
    EXPECT_EQ(material.occlusion_strength, 0.5f);
    EXPECT_EQ(file.texel(material.orm_texture), (std::vector<int>{10, 20, 30, 255}));
    EXPECT_EQ(file.texture(material.orm_texture).format, TextureFormat::linear8);
}

TEST(GltfMaterials, SeparateOcclusionIsPackedWithRoughnessAndMetalAtTheLargerSize) {
    MaterialFile file;
    const int occlusion = file.add_texture(tests::png(2, 2, 3, {0, 9, 9, 100, 9, 9, 0, 9, 9, 100, 9, 9}));
    const int rough = file.add_texture(one_texel(1, 200, 50));
    const Material& material =
        file.load({{"occlusionTexture", {{"index", occlusion}}},
                   {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", rough}}}}}});
    EXPECT_EQ(file.scene.textures().size(), 1u);
    EXPECT_EQ(file.texture(material.orm_texture).width, 2);
    EXPECT_EQ(file.texel(material.orm_texture, 0), (std::vector<int>{0, 200, 50, 255}));
    EXPECT_EQ(file.texel(material.orm_texture, 1), (std::vector<int>{100, 200, 50, 255}));
}

TEST(GltfMaterials, OcclusionWithAnotherSamplerStaysApart) {
    MaterialFile file;
    const int occlusion = file.add_texture(one_texel(70, 0, 0), {{"wrapS", 33071}});
    const int rough = file.add_texture(one_texel(1, 200, 50));
    const Material& material =
        file.load({{"occlusionTexture", {{"index", occlusion}}},
                   {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", rough}}}}}});
    EXPECT_EQ(file.scene.textures().size(), 2u);
    EXPECT_EQ(file.texel(material.orm_texture), (std::vector<int>{255, 200, 50, 255}))
        << "no occlusion where none is packed";
    EXPECT_EQ(file.texel(material.occlusion_texture)[0], 70);
}

TEST(GltfMaterials, ColourAndDataOfOneImageAreKeptApart) {
    MaterialFile file;
    const int texture = file.add_texture(one_texel(128, 128, 255));
    const Material& material = file.load({{"normalTexture", {{"index", texture}, {"scale", 0.5}}},
                                          {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    EXPECT_EQ(file.scene.textures().size(), 2u);
    EXPECT_EQ(file.texture(material.base_color_texture).format, TextureFormat::srgb8);
    EXPECT_EQ(file.texture(material.normal_texture).format, TextureFormat::linear8);
    EXPECT_EQ(material.normal_scale, 0.5f);
    EXPECT_FALSE(first(file.scene.geometries()).mesh.tangents.empty()) << "a normal map needs tangents";
}

TEST(GltfMaterials, SamplersArrive) {
    MaterialFile file;
    const int texture =
        file.add_texture(tests::png(4, 4, 3, std::vector<std::uint8_t>(48, 7)),
                         {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9729}});
    const Material& material = file.load({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    const Texture& made = file.texture(material.base_color_texture);
    EXPECT_EQ(made.wrap_u, Wrap::clamp_to_edge);
    EXPECT_EQ(made.wrap_v, Wrap::mirrored_repeat);
    EXPECT_EQ(made.magnify, Filter::nearest);
    EXPECT_EQ(made.minify, Filter::linear);
    EXPECT_FALSE(made.mipmapped);
    EXPECT_TRUE(made.opaque);
}

TEST(GltfMaterials, TextureTransformsRotateCounterClockwiseAsTheirExampleShows) {
    MaterialFile file;
    const int texture = file.add_texture(one_texel(1, 2, 3));
    const Json transform = {
        {"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}, {"texCoord", 1}};
    const Material& material = file.load(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", texture}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
    const TextureUse& use = material.base_color_texture;
    EXPECT_EQ(use.texcoord, 1);
    // "Only the lower left quadrant of the source image, rotated clockwise 90°": u 0…0.5, v 0.5…1.
    for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)}) {
        const glm::vec2 moved = use.uv_matrix * uv + use.uv_offset;
        EXPECT_NEAR(moved.x, 0.5f * uv.y, 1e-6f);
        EXPECT_NEAR(moved.y, 1 - 0.5f * uv.x, 1e-6f);
    }
}

TEST(GltfMaterials, MaskKeepsAlphaAndCutoffAndOpaqueDropsIt) {
    for (const char* mode : {"MASK", "BLEND", "OPAQUE"}) {
        MaterialFile file;
        const int texture = file.add_texture(one_texel(9, 9, 9, 100));
        const Material& material =
            file.load({{"alphaMode", mode},
                       {"alphaCutoff", 0.3},
                       {"pbrMetallicRoughness",
                        {{"baseColorFactor", {1, 1, 1, 0.5}}, {"baseColorTexture", {{"index", texture}}}}}});
        const bool opaque = std::string(mode) == "OPAQUE";
        EXPECT_EQ(file.texture(material.base_color_texture).opaque, opaque);
        EXPECT_EQ(file.texel(material.base_color_texture)[3], opaque ? 255 : 100);
        EXPECT_EQ(material.opacity, opaque ? 1.0f : 0.5f);
        EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.3f);
    }
}

TEST(GltfMaterials, PicturesMayBeDataUrisOrFilesBesideTheModel) {
    const tests::TemporaryFolder folder;
    folder.write("a b.png", one_texel(1, 2, 3));
    MaterialFile file;
    file.builder.json["images"] = {{{"uri", "a%20b.png"}}};
    file.builder.json["textures"] = {{{"source", 0}}};
    file.builder.add_square({{"material", 0}});
    file.builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    Warnings warnings;
    const auto root = import_model(file.scene, {}, folder.write("model.glb", file.builder.glb()), warnings);
    ASSERT_TRUE(root) << root.error().text();
    EXPECT_EQ(file.texel(first(file.scene.materials()).base_color_texture), (std::vector<int>{1, 2, 3, 255}));
    std::filesystem::remove(folder / "a b.png");
    Scene scene;
    const auto missing = import_model(scene, {}, folder / "model.glb", warnings);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().text().find("a b.png"), std::string::npos) << missing.error().text();
    EXPECT_EQ(scene.geometries().size(), 0u) << "a refused file leaves the scene as it was";
}

}  // namespace
}  // namespace heliodon
