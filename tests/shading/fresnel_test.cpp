#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shading/fresnel.h"
#include "shading/ggx_albedo.h"
#include "shading/quadrature.h"

namespace heliodon::shading {
namespace {

float cos_deg(double degrees) {
    return static_cast<float>(std::cos(degrees * std::numbers::pi / 180));
}

double average(float eta) {
    // Split at the critical angle; the square in the map removes the root there.
    const GaussLegendre<48> rule;
    const double critical = eta < 1 ? std::sqrt(1.0 - double(eta) * eta) : 0.0;
    double sum = critical * critical;
    for (std::size_t i = 0; i < 48; ++i) {
        const double t = rule.x[i], mu = critical + (1 - critical) * t * t;
        sum += rule.weight[i] * 2 * t * (1 - critical) * 2 * mu * fresnel_dielectric(static_cast<float>(mu), eta);
    }
    return sum;
}

// Numbers: exact Fresnel at n = 1.5 (external truth, "Materials").
TEST(Fresnel, DielectricMatchesExactValuesAtIndexOneAndAHalf) {
    EXPECT_NEAR(fresnel_dielectric(cos_deg(45), 1.5f), 0.050240, 2e-6);
    EXPECT_NEAR(fresnel_dielectric(cos_deg(60), 1.5f), 0.089187, 2e-6);
    EXPECT_NEAR(fresnel_dielectric(cos_deg(75), 1.5f), 0.253061, 2e-6);
    EXPECT_NEAR(fresnel_dielectric(cos_deg(85), 1.5f), 0.612800, 2e-6);
}

TEST(Fresnel, AveragesMatchExactValuesOnBothSides) {
    EXPECT_NEAR(average(1.5f), 0.091778, 2e-6);
    EXPECT_NEAR(average(1 / 1.5f), 0.596346, 2e-5);
}

TEST(Fresnel, TabulatedAveragesAreWithinATenthOfAPerCentOfTheLight) {
    for (float ior : {1.1f, 1.33f, 1.5f, 1.8f, 2.42f}) {
        EXPECT_NEAR(glass_fresnel_average(ior), average(ior), 1e-3) << ior;
        EXPECT_NEAR(glass_fresnel_average(1 / ior), average(1 / ior), 1e-3) << "from within " << ior;
    }
}

TEST(Fresnel, NormalReflectanceFollowsFromTheIndex) {
    EXPECT_NEAR(f0_from_ior(1.33f), 0.020059, 1e-6);
    EXPECT_NEAR(f0_from_ior(1.52f), 0.042580, 1e-6);
    EXPECT_NEAR(f0_from_ior(2.42f), 0.172395, 1e-6);
    for (float ior : {1.0f, 1.33f, 1.52f, 2.42f}) EXPECT_NEAR(fresnel_dielectric(1.0f, ior), f0_from_ior(ior), 1e-6);
}

TEST(Fresnel, ReflectionIsTotalBeyondTheCriticalAngle) {
    const float critical = std::sqrt(1 - 1 / 2.25f);
    EXPECT_EQ(fresnel_dielectric(critical - 1e-3f, 1 / 1.5f), 1.0f);
    EXPECT_LT(fresnel_dielectric(critical + 1e-3f, 1 / 1.5f), 1.0f);
    EXPECT_EQ(fresnel_dielectric(0.0f, 1.5f), 1.0f);
}

TEST(Fresnel, BothSidesOfAnInterfaceReflectAlikeAlongOneRay) {
    for (float mu : {0.1f, 0.4f, 0.9f}) {
        const float inside = std::sqrt(1 - (1 - mu * mu) / 2.25f);
        EXPECT_NEAR(fresnel_dielectric(mu, 1.5f), fresnel_dielectric(inside, 1 / 1.5f), 2e-6);
    }
}

TEST(Fresnel, ConductorWithoutAbsorptionIsTheDielectric) {
    for (float mu : {0.05f, 0.3f, 0.7f, 1.0f}) {
        EXPECT_NEAR(fresnel_conductor(mu, 1.5f, 0.0f), fresnel_dielectric(mu, 1.5f), 1e-5);
    }
}

TEST(Fresnel, ConductorAtNormalIncidenceIsTheClosedForm) {
    // ((n − 1)² + k²)/((n + 1)² + k²), gold near 600 nm
    const float n = 0.25f, k = 3.07f;
    EXPECT_NEAR(fresnel_conductor(1.0f, n, k), ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-6);
    EXPECT_NEAR(fresnel_conductor(0.0f, n, k), 1.0f, 1e-6);
}

TEST(Fresnel, SchlickAverageIsTheIntegral) {
    const GaussLegendre<8> rule;
    double sum = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        sum += rule.weight[i] * 2 * rule.x[i] * fresnel_schlick(vec3(0.04f), 1.0f, static_cast<float>(rule.x[i])).x;
    }
    EXPECT_NEAR(fresnel_schlick_average(vec3(0.04f), 1.0f).x, sum, 1e-6);
}

}  // namespace
}  // namespace heliodon::shading
