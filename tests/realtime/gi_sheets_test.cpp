// What is not closed: sheets that face one way, alone and about solids.
#include "gi_test.h"

namespace heliodon::tests {
namespace {

class GiSheets : public GlobalIllumination {};

/// The sides and the top of a block that stands on `base`, turned about the vertical by `turn_rad`, each a sheet of its
/// own that faces out.
void add_open_block(Scene& scene, glm::vec3 base, glm::vec3 size, float turn_rad, MaterialId material) {
    const glm::vec3 x = size.x * glm::vec3(std::cos(turn_rad), 0, std::sin(turn_rad));
    const glm::vec3 y(0, size.y, 0), z = size.z * glm::vec3(-std::sin(turn_rad), 0, std::cos(turn_rad));
    const glm::vec3 corner = base - 0.5f * (x + z);
    add_shape_node(scene, Quad{corner, y, x}, material);
    add_shape_node(scene, Quad{corner + z, x, y}, material);
    add_shape_node(scene, Quad{corner, z, y}, material);
    add_shape_node(scene, Quad{corner + x, y, z}, material);
    add_shape_node(scene, Quad{corner + y, z, x}, material);
}

TEST_F(GiSheets, WhatIsBuiltOfThemTakesNoLightAwayByTheirRears) {
    // As in the furnace of closed rooms, L/(1 − ρ) everywhere, whatever stands in it.
    Scene scene;
    Material glowing = lambert(glm::vec3(0.5f));
    glowing.emission_nits = glm::vec3(10);
    const MaterialId material = scene.add_material(glowing);
    add_room(scene, {-1, 0, -1}, {1, 1.5f, 1.2f}, material);
    for (const float x : {-0.7f, -0.25f, 0.2f, 0.65f}) add_open_block(scene, {x, 0, -0.4f}, {0.15f, 1.2f, 0.15f}, 0.6f + x, material);
    add_open_block(scene, {0, 0, -0.8f}, {1.2f, 0.7f, 0.03f}, 0.1f, material);  // half a voxel thick
    use_cone_tracing(scene, 32);
    const Picture picture = cone_traced(scene, inside({0, 0.9f, 0.9f}, {-0.1f, 0.3f, -0.6f}, 1.6f), 48, 8);
    const double mean = mean_luminance(picture.image) / 20;
    EXPECT_NEAR(mean, 1.0, 0.05);
    EXPECT_NEAR(mean, 1.0, 1.1 * 0.0229);  // measured: may only fall
}

TEST_F(GiSheets, SeenFromBehindTheyKeepTheSkyOut) {
    // A hall whose walls and roof face out: within it is dark, though no cone from there meets a front.
    Scene scene;
    const MaterialId white = scene.add_material(lambert(glm::vec3(0.5f)));
    add_open_block(scene, {0, 0, 0}, {2, 1.2f, 2}, 0, white);
    add_shape_node(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, white);
    add_shape_node(scene, Box{{-0.2f, 0, -0.2f}, {0.2f, 0.3f, 0.2f}}, white);
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(100)});
    use_cone_tracing(scene, 32);
    const Picture picture = cone_traced(scene, inside({0.6f, 0.7f, 0.6f}, {0, 0, 0}, 1.6f), 32, 8);
    EXPECT_LE(mean_luminance(picture.image), 1.1 * 1.102);  // of the 50 cd/m² in the open: measured, may only fall
}

}  // namespace
}  // namespace heliodon::tests
