#include <gtest/gtest.h>

#include <cmath>

#include "shading/material_eval.h"

namespace heliodon::shading {
namespace {

/// A texture table of one picture per index: constant colours and a ramp of height along u.
struct Fetches {
    vec4 scene_texture(uint index, vec2 uv) const {
        if (index == 7u) return vec4(uv.x, 0, 0, 1);
        if (index == 8u) return vec4(0.5f, 0.5f, 1.0f, 1.0f);
        return vec4(0.5f, 0.25f, 0.75f, 0.4f);
    }
    vec2 scene_texture_size(uint) const { return vec2(256, 128); }
#include "shading/material_fetch.h"
};

TextureRef no_texture_ref() {
    TextureRef ref{};
    ref.uv_matrix = vec4(1, 0, 0, 1);
    ref.texture_index = no_texture;
    return ref;
}
TextureRef texture_ref(uint index) {
    TextureRef ref = no_texture_ref();
    ref.texture_index = index;
    return ref;
}

MaterialData plain_material() {
    MaterialData m{};
    m.base_color = vec3(0.8f, 0.6f, 0.4f);
    m.opacity = 1;
    m.emission_nits = vec3(10);
    m.alpha_cutoff = 0.5f;
    m.specular_color = vec3(1);
    m.specular = 1;
    m.metallic = 0.5f;
    m.roughness = 0.8f;
    m.ior = 1.5f;
    m.normal_scale = 1;
    m.bump_scale_m = 0.01f;
    m.occlusion_strength = 1;
    m.base_color_texture = m.orm_texture = m.occlusion_texture = m.normal_texture = m.bump_texture =
        m.emission_texture = m.transmission_texture = m.specular_texture = m.specular_color_texture =
            m.clearcoat_texture = m.clearcoat_roughness_texture = no_texture_ref();
    return m;
}

TEST(MaterialEval, WithoutTexturesTheFactorsStand) {
    Fetches fetches;
    const MaterialPoint p = fetches.material_at(plain_material(), vec2(0.3f), vec2(0), vec4(1), false);
    EXPECT_EQ(p.surface.base_color, vec3(0.8f, 0.6f, 0.4f));
    EXPECT_FLOAT_EQ(p.surface.roughness, 0.8f);
    EXPECT_FLOAT_EQ(p.surface.metallic, 0.5f);
    EXPECT_EQ(p.emission, vec3(10));
    EXPECT_EQ(p.opacity, 1.0f);
    EXPECT_EQ(p.occlusion, 1.0f);
}

TEST(MaterialEval, TexelsMultiplyTheFactorsOfTheirChannels) {
    Fetches fetches;
    MaterialData m = plain_material();
    m.base_color_texture = m.orm_texture = m.occlusion_texture = m.emission_texture = texture_ref(1);
    m.occlusion_strength = 0.5f;
    const MaterialPoint p = fetches.material_at(m, vec2(0), vec2(0), vec4(0.5f, 1, 1, 1), false);
    EXPECT_FLOAT_EQ(p.surface.base_color.x, 0.8f * 0.5f * 0.5f);
    EXPECT_FLOAT_EQ(p.surface.base_color.y, 0.6f * 0.25f);
    EXPECT_FLOAT_EQ(p.surface.roughness, 0.8f * 0.25f);
    EXPECT_FLOAT_EQ(p.surface.metallic, 0.5f * 0.75f);
    EXPECT_FLOAT_EQ(p.emission.z, 7.5f);
    EXPECT_FLOAT_EQ(p.occlusion, 0.75f);
}

TEST(MaterialEval, AlphaModesTurnAlphaIntoCoverage) {
    Fetches fetches;
    MaterialData m = plain_material();
    m.base_color_texture = texture_ref(1);  // alpha 0.4
    EXPECT_EQ(fetches.material_opacity_at(m, vec2(0), vec2(0), 1.0f), 1.0f);
    m.flags = material_flag_alpha_mask;
    EXPECT_EQ(fetches.material_opacity_at(m, vec2(0), vec2(0), 1.0f), 0.0f);
    m.alpha_cutoff = 0.4f;
    EXPECT_EQ(fetches.material_opacity_at(m, vec2(0), vec2(0), 1.0f), 1.0f);
    m.flags = material_flag_alpha_blend;
    EXPECT_FLOAT_EQ(fetches.material_opacity_at(m, vec2(0), vec2(0), 0.5f), 0.2f);
    EXPECT_FLOAT_EQ(fetches.material_at(m, vec2(0), vec2(0), vec4(1, 1, 1, 0.5f), false).opacity, 0.2f);
}

TEST(MaterialEval, OnlyTransmissiveStandardSurfacesHaveAnInside) {
    Fetches fetches;
    MaterialData m = plain_material();
    EXPECT_FALSE(fetches.material_at(m, vec2(0), vec2(0), vec4(1), true).surface.inside);
    m.transmission = 1;
    EXPECT_TRUE(fetches.material_at(m, vec2(0), vec2(0), vec4(1), true).surface.inside);
    m.model = material_model_lambert;
    EXPECT_FALSE(fetches.material_at(m, vec2(0), vec2(0), vec4(1), true).surface.inside);
}

TEST(MaterialEval, TextureTransformMatrixActsOnColumns) {
    Fetches fetches;
    TextureRef ref = texture_ref(7);
    ref.uv_matrix = vec4(0, 1, -1, 0);  // a quarter turn: u' = −v, v' = u
    ref.uv_offset = vec2(0.5f, 0.25f);
    const vec2 uv = fetches.texture_uv(ref, vec2(0.2f, 0.1f), vec2(0));
    EXPECT_FLOAT_EQ(uv.x, 0.4f);
    EXPECT_FLOAT_EQ(uv.y, 0.45f);
    ref.texcoord = 1;
    EXPECT_FLOAT_EQ(fetches.texture_uv(ref, vec2(9), vec2(0)).x, 0.5f);
}

TEST(MaterialEval, FlatNormalMapLeavesTheNormal) {
    Fetches fetches;
    MaterialData m = plain_material();
    m.normal_texture = texture_ref(8);
    const vec3 n = normalize(vec3(0.2f, 1, 0.1f));
    const vec3 result = fetches.material_normal_at(m, vec2(0), vec2(0), n, vec4(1, 0, 0, 1), vec3(0), vec3(0));
    EXPECT_LT(length(result - n), 1e-6f);
}

TEST(MaterialEval, NormalMapTiltsAlongTangentAndHandedBitangent) {
    const vec3 n(0, 0, 1);
    EXPECT_GT(perturb_normal_map(n, vec4(1, 0, 0, 1), vec3(0.8f, 0.5f, 0.9f), 1).x, 0.3f);
    EXPECT_GT(perturb_normal_map(n, vec4(1, 0, 0, 1), vec3(0.5f, 0.8f, 0.9f), 1).y, 0.3f);
    EXPECT_LT(perturb_normal_map(n, vec4(1, 0, 0, -1), vec3(0.5f, 0.8f, 0.9f), 1).y, -0.3f);
    EXPECT_EQ(perturb_normal_map(n, vec4(0), vec3(0.8f, 0.5f, 0.9f), 1), n);
}

TEST(MaterialEval, BumpMapTiltsTheNormalByTheSlopeOfTheHeight) {
    // Height u · 0.01 m over 0.1 m a unit of u: slope 0.1 along x.
    Fetches fetches;
    MaterialData m = plain_material();
    m.bump_texture = texture_ref(7);
    const vec3 n(0, 0, 1), expected = normalize(vec3(-0.1f, 0, 1));
    const vec3 result =
        fetches.material_normal_at(m, vec2(0.25f), vec2(0), n, vec4(1, 0, 0, 1), vec3(0.1f, 0, 0), vec3(0, 0.1f, 0));
    EXPECT_LT(length(result - expected), 1e-4f);
    // Mirrored texture coordinates keep the height upward.
    EXPECT_LT(length(perturb_bump(n, vec3(-0.1f, 0, 0), vec3(0, 0.1f, 0), 0.01f, 0) - normalize(vec3(0.1f, 0, 1))),
              1e-6f);
}

TEST(MaterialEval, DerivativesFollowTheTexturesAxes) {
    vec3 dp_du, dp_dv;
    ASSERT_TRUE(
        triangle_derivatives(vec3(0), vec3(2, 0, 0), vec3(0, 0, 3), vec2(0), vec2(1, 0), vec2(0, 0.5f), dp_du, dp_dv));
    EXPECT_LT(length(dp_du - vec3(2, 0, 0)), 1e-6f);
    EXPECT_LT(length(dp_dv - vec3(0, 0, 6)), 1e-6f);
    EXPECT_FALSE(triangle_derivatives(vec3(0), vec3(2, 0, 0), vec3(0, 0, 3), vec2(0), vec2(0), vec2(0), dp_du, dp_dv));
}

TEST(MaterialEval, UsableNormalsKeepTheMirrorDirectionAboveTheSurface) {
    const vec3 geometric(0, 0, 1);
    for (float tilt = -1.5f; tilt < 1.5f; tilt += 0.1f) {
        for (float view = 0.02f; view < 3.12f; view += 0.1f) {
            const vec3 wo(std::cos(view), 0, std::sin(view)), n(std::sin(tilt), 0, std::cos(tilt));
            const vec3 used = usable_shading_normal(n, geometric, wo);
            EXPECT_NEAR(length(used), 1.0f, 1e-5f);
            EXPECT_GT(dot(used, wo), 0.0f);
            EXPECT_GE((2 * dot(used, wo) * used - wo).z, 0.0f);
        }
    }
    const vec3 mild = normalize(vec3(0.1f, 0, 1));
    EXPECT_EQ(usable_shading_normal(mild, geometric, vec3(0, 0, 1)), mild);
}

TEST(MaterialEval, UnlitShowsItsBaseColourTimesItsEmission) {
    Fetches fetches;
    MaterialData m = plain_material();
    m.model = material_model_unlit;
    const MaterialPoint p = fetches.material_at(m, vec2(0), vec2(0), vec4(1), false);
    EXPECT_FLOAT_EQ(p.emission.y, 6.0f);
}

}  // namespace
}  // namespace heliodon::shading
