#include <gtest/gtest.h>

#include <cmath>

#include "convert/pack.h"

namespace heliodon::convert {
namespace {

using enum MaterialModel;

shading::MaterialData packed(const Material& material) { return pack_material(Scene{}, material); }
Material of_model(MaterialModel model) {
    Material material;
    material.model = model;
    return material;
}
bool is_extended(const Material& material) { return (packed(material).flags & shading::material_flag_extended) != 0; }

TEST(PackMaterial, OnlyWhatIsMoreThanTheStandardModelsCoreIsExtended) {
    for (const MaterialModel model : {standard, lambert, unlit, thin, dielectric}) EXPECT_FALSE(is_extended(of_model(model)));
    for (const MaterialModel model : {disney, oren_nayar, conductor}) EXPECT_TRUE(is_extended(of_model(model)));
    Material material;
    material.thin_walled = true;
    material.attenuation_distance_m = 1;
    material.attenuation_color = glm::vec3(0.5f);
    EXPECT_FALSE(is_extended(material)) << "nothing passes it";
    material.transmission = 1;
    EXPECT_TRUE(is_extended(material));
    for (float Material::*layer : {&Material::anisotropy, &Material::iridescence}) {
        Material layered;
        layered.*layer = 0.5f;
        EXPECT_TRUE(is_extended(layered));
        layered.model = lambert;
        EXPECT_FALSE(is_extended(layered));
    }
}

TEST(PackMaterial, ASolidAbsorbsSoThatItsColourIsLeftAfterTheDistance) {
    Material tea = of_model(dielectric);
    tea.attenuation_color = {0.5f, 0.1f, 1};
    tea.attenuation_distance_m = 0.2f;
    const glm::vec3 absorption = packed(tea).absorption;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::exp(-0.2f * absorption[c]), tea.attenuation_color[c], 1e-6f);
    tea.thin_walled = true;
    EXPECT_EQ(packed(tea).absorption, glm::vec3(0));
    EXPECT_NE(packed(tea).flags & shading::material_flag_two_sided, 0u) << "a sheet has no inside";
}

TEST(PackMaterial, ADielectricIsClearAndAConductorOpaqueWhateverElseTheySay) {
    Material material = of_model(dielectric);
    material.base_color = glm::vec3(0.2f);
    material.metallic = 1;
    EXPECT_EQ(packed(material).base_color, glm::vec3(1));
    EXPECT_EQ(packed(material).transmission, 1);
    EXPECT_EQ(packed(material).metallic, 0);
    material.model = conductor;
    material.metal = NamedMetal::copper;
    EXPECT_EQ(packed(material).metallic, 1);
    EXPECT_EQ(packed(material).transmission, 0);
    EXPECT_NEAR(packed(material).base_color.y, 0.6376f, 2e-4f) << "the spectrum's reflectance";
}

}  // namespace
}  // namespace heliodon::convert
