#include "realtime/scene_features.h"

#include <gtest/gtest.h>

#include "passes/light_grid/light_grid_shared.h"
#include "scene/scene.h"

namespace heliodon::realtime {
namespace {

class SceneFeatures : public ::testing::Test {
protected:
    void add_ball(const Material& material) {
        Node node;
        node.parts.push_back({ball, scene.add_material(material)});
        scene.add_node(node);
    }
    void add_light(const Light& light) {
        Node node;
        node.light = light;
        scene.add_node(node);
    }
    passes::SceneFeatures features() {
        flat.update(scene);
        return scene_features(flat);
    }
    Scene scene;
    GeometryId ball = scene.add_geometry({.mesh = tessellate(Sphere{}, 8)});
    convert::FlatScene flat;
};

TEST_F(SceneFeatures, NameTheOnlyModelAndTheOnlyTypeOfLightWhileThereIsOne) {
    EXPECT_EQ(features().only_model, passes::SceneFeatures::any_kind);
    add_ball({.model = MaterialModel::lambert});
    add_light({.type = LightType::point});
    EXPECT_EQ(features().only_model, shading::material_model_lambert);
    EXPECT_EQ(features().only_light, shading::light_type_point);
    add_ball({});
    add_light({.type = LightType::spot});
    EXPECT_EQ(features().only_model, passes::SceneFeatures::any_kind);
    EXPECT_EQ(features().only_light, passes::SceneFeatures::any_kind);
}

TEST_F(SceneFeatures, LightsWithAnExtentAreOfAnyTypeSinceTheirPointsAre) {
    add_light({.type = LightType::point, .radius_m = 0.1f});
    EXPECT_TRUE(features().visible_lights);
    EXPECT_EQ(features().only_light, passes::SceneFeatures::any_kind);
}

TEST_F(SceneFeatures, TellWhetherThereIsASkyAndMoreLightsThanAreSummed) {
    EXPECT_FALSE(features().sky);
    for (std::uint32_t i = 0; i <= shading::most_lights_summed; ++i) {
        EXPECT_FALSE(features().many_lights) << i;
        add_light({.type = LightType::point});
    }
    EXPECT_TRUE(features().many_lights);
    scene.set_sky({.model = SkyModel::constant, .luminance_nits = glm::vec3(5)});
    EXPECT_TRUE(features().sky);
}

}  // namespace
}  // namespace heliodon::realtime
