#include "scene/procedural.h"
#include "voxel_test.h"

namespace heliodon::tests {
namespace {

using namespace shading;

class VoxelizedSurfaces : public VoxelTest {
protected:
    Scene scene;
};

TEST_F(VoxelizedSurfaces, MaterialsSayWhatStopsLightAndWhatGivesIt) {
    constexpr std::uint32_t size = 32;
    VoxelGrid grid = grid_over(glm::vec3(0), size, size);
    grid.emission_unit = 100;
    Material glass, blend = lambert(glm::vec3(0.8f)), mask = lambert(glm::vec3(0.8f)), lamp = lambert(glm::vec3(0));
    glass.transmission = 1;
    glass.base_color = glm::vec3(1);
    glass.roughness = 0;
    blend.alpha_mode = AlphaMode::blend;
    blend.opacity = 0.5f;
    blend.two_sided = true;
    mask.alpha_mode = AlphaMode::mask;
    mask.opacity = 0.4f;
    lamp.emission_nits = {50, 20, 10};
    float height = 4.5f;
    for (const Material& material : {glass, blend, mask, lamp})
        add_shape_node(scene, Quad{{0, std::exchange(height, height + 4), 0}, {0, 0, size}, {size, 0, 0}}, scene.add_material(material));
    const Voxels voxels = voxelize(scene, grid, {});
    const auto mean = [&](int y, int face, std::uint32_t field) {
        double sum = 0;
        for (const auto& [place, record] : voxels.records)
            if (voxels.voxel(place).y == y) sum += Voxels::field(record, face, field);
        return sum / (size * size);
    };
    // What clear glass does not let through it reflects: all light that its cover stops.
    const double reflected = mean(4, 2, voxel_field_area);
    EXPECT_GT(reflected, 0.03);
    EXPECT_LT(reflected, 0.10);
    EXPECT_NEAR(mean(4, 2, voxel_field_albedo) / reflected, 1, 1e-3);
    for (const int face : {2, 3}) {
        EXPECT_NEAR(mean(8, face, voxel_field_area), 0.5, 1e-5);
        EXPECT_NEAR(mean(8, face, voxel_field_albedo), 0.4, 1e-5);
        EXPECT_EQ(mean(12, face, voxel_field_area), 0);
    }
    EXPECT_NEAR(mean(16, 2, voxel_field_emission), 0.5, 1e-5);
    EXPECT_NEAR(mean(16, 2, voxel_field_emission + 2), 0.1, 1e-5);
    EXPECT_NEAR(mean(16, 2, voxel_field_emissive_area), 1, 1e-5);
    EXPECT_EQ(mean(16, 3, voxel_field_emission), 0);
    EXPECT_EQ(mean(16, 3, voxel_field_emissive_area), 0);
    EXPECT_EQ(mean(16, 3, voxel_field_area), 0);
    EXPECT_NEAR(mean(16, 3, voxel_field_behind), 1, 1e-5);
}

TEST_F(VoxelizedSurfaces, ASurfaceThatIsEvaluatedOnceGivesTheSumsOfOneThatIsEvaluatedAtEachPiece) {
    Material glossy;
    glossy.base_color = {0.9f, 0.6f, 0.3f};
    glossy.roughness = 0.3f;
    glossy.clearcoat = 0.5f;
    glossy.emission_nits = {3, 2, 1};
    const MaterialId material = scene.add_material(glossy);
    Mesh mesh = tessellate(Sphere{{0.01f, 0.02f, 0.03f}, 0.8f}, 64);
    VoxelGrid grid = grid_over(glm::vec3(-1), 2, 32);
    grid.emission_unit = 4;
    const NodeId plain = add_mesh(scene, mesh, material);
    const Voxels once = voxelize(scene, grid, {});
    scene.remove(plain);
    mesh.colors.resize(mesh.positions.size(), glm::vec4(1));  // white, but it could vary
    add_mesh(scene, mesh, material);
    const Voxels each = voxelize(scene, grid, {});
    EXPECT_GT(once.total(0, voxel_field_emission), 1);
    ASSERT_EQ(each.records.size(), once.records.size());
    double worst = 0;
    for (const auto& [place, record] : once.records)
        for (std::uint32_t i = 0; i < record_words; ++i)
            worst = std::max(worst, std::abs(Voxels::field(each.records.at(place), 0, i) - Voxels::field(record, 0, i)));
    // Interpolated white is 1 but for rounding; about ten pieces a voxel.
    EXPECT_LE(worst, 16.0 / voxel_fixed_one);
}

}  // namespace
}  // namespace heliodon::tests
