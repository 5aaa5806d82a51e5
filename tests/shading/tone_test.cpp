#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "shading/metering.h"
#include "shading/tone.h"

namespace heliodon::shading {
namespace {

vec3 shown(uint curve, vec3 exposed) {
    return tone_map(curve, curve == tone_curve_reinhard ? reinhard_white : hable_white, exposed);
}
constexpr uint every_curve[] = {tone_curve_linear,         tone_curve_hable, tone_curve_reinhard, tone_curve_aces,
                                tone_curve_aces_narkowicz, tone_curve_agx,   tone_curve_neutral};

// External truth, "Tone and exposure": x = 0.18, 1 and 4.
TEST(Tone, CurvesMatchTheirPublishedValues) {
    struct Row {
        uint curve;
        std::array<float, 3> values;
    };
    constexpr float x[] = {0.18f, 1, 4};
    for (const Row& row : {Row{tone_curve_hable, {0.128338f, 0.492919f, 0.918030f}},
                           Row{tone_curve_aces_narkowicz, {0.266899f, 0.803797f, 0.973417f}},
                           Row{tone_curve_aces, {0.105591f, 0.619115f, 0.909014f}},
                           Row{tone_curve_neutral, {0.14f, 0.869091f, 0.983256f}}})
        for (int i = 0; i < 3; ++i) {
            const vec3 color = shown(row.curve, vec3(x[i]));
            EXPECT_NEAR(color.x, row.values[i], 2e-5f) << row.curve;
            EXPECT_NEAR(color.y, row.values[i], 2e-5f) << row.curve;
            EXPECT_NEAR(color.z, row.values[i], 2e-5f) << row.curve;
        }
    constexpr float encoded[] = {0.500f, 0.78752f, 0.93780f};
    for (int i = 0; i < 3; ++i) {
        const vec3 color = shown(tone_curve_agx, vec3(x[i]));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::pow(color[c], 1 / 2.2f), encoded[i], 1e-4f);
    }
}

TEST(Tone, NeutralKeepsAndWhitensColoursAsItsSpecificationSays) {
    const vec3 red = shown(tone_curve_neutral, vec3(1, 0, 0)), orange = shown(tone_curve_neutral, vec3(3, 1.5f, 0.2f));
    EXPECT_NEAR(red.x, 0.88f, 1e-4f);
    EXPECT_NEAR(red.y, 0.01556f, 1e-4f);
    EXPECT_NEAR(red.z, 0.01556f, 1e-4f);
    EXPECT_NEAR(orange.x, 0.976393f, 1e-4f);
    EXPECT_NEAR(orange.y, 0.595061f, 1e-4f);
    EXPECT_NEAR(orange.z, 0.264574f, 1e-4f);
}

// Reinhard et al. 2002, eq. 4.
TEST(Tone, ReinhardsWhiteIsExactlyOneAndHuesStay) {
    EXPECT_FLOAT_EQ(tone_reinhard(vec3(4), 4).x, 1);
    EXPECT_FLOAT_EQ(tone_reinhard(vec3(1), 4).x, (1 + 1 / 16.0f) / 2);
    const vec3 color(0.4f, 0.2f, 0.1f), darker = tone_reinhard(color, 4);
    EXPECT_FLOAT_EQ(darker.x / darker.y, 2);
    EXPECT_FLOAT_EQ(darker.y / darker.z, 2);
    EXPECT_FLOAT_EQ(tone_hable(vec3(5.6f), hable_white).x, 1) << "half of the white, with the bias of 2";
}

TEST(Tone, EveryCurveRisesFromBlackAndStaysWithinTheDisplay) {
    for (const uint curve : every_curve) {
        EXPECT_LT(shown(curve, vec3(0)).x, 1e-6f) << curve;
        float before = 0;
        for (float x = 1e-4f; x < 1e6f; x *= 1.1f) {
            const float y = shown(curve, vec3(x)).x;
            EXPECT_GE(y, before - 1e-6f) << "curve " << curve << " at " << x;
            EXPECT_LE(y, 1) << curve;
            before = y;
        }
        EXPECT_GT(before, 0.95f) << curve;
        for (const vec3 color : {vec3(1e6f, 0, 0), vec3(0, 2, 30), vec3(-1, 1, 1)}) {
            const vec3 y = shown(curve, color);
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(y[c] >= 0 && y[c] <= 1) << curve;
        }
    }
}

// Reinhard 2002, "Parameter Estimation", eq. 4 and 5: a picture whose log-average lies in the middle of its stops has the
// key of middle grey; one that lies a quarter of its range higher twice that.
TEST(Tone, TheKeyFollowsWhereTheLogAverageStands) {
    Metering even{.luminance_nits = 16, .mean_stop = 4, .low_stop = 0, .high_stop = 8};
    EXPECT_FLOAT_EQ(estimated_key(even), 0.18f);
    EXPECT_NEAR(16 * exposure_scale(ev100_from_key(even)), 0.18f, 1e-6f);
    even.mean_stop = 6;
    EXPECT_NEAR(estimated_key(even), 0.36f, 1e-6f);
    EXPECT_NEAR(estimated_white(even), 1.5f * 8, 1e-5f);
    const Metering flat{.luminance_nits = 16, .mean_stop = 4, .low_stop = 4, .high_stop = 4};
    EXPECT_FLOAT_EQ(estimated_key(flat), 0.18f);
}

TEST(Tone, AMeteredExposureIsAnIncidentMetersInverse) {
    EXPECT_NEAR(ev100_from_metered_luminance(4096), 15, 1e-5f) << "EV100 = log2(L 100/12.5)";
    EXPECT_NEAR(ev100_from_metered_luminance(0.125f), 0, 1e-6f);
}

TEST(Tone, ExposureAdaptsExponentiallyAndFasterToLight) {
    EXPECT_NEAR(adapted_ev100(0, 4, 0.4f, 0.4f, 1.2f), 4 * (1 - std::exp(-1.0f)), 1e-5f);
    EXPECT_NEAR(adapted_ev100(4, 0, 1.2f, 0.4f, 1.2f), 4 * std::exp(-1.0f), 1e-5f);
    EXPECT_EQ(adapted_ev100(4, 0, 1, 0, 0), 0) << "without time constants at once";
    float in_steps = 0;
    for (int i = 0; i < 100; ++i) in_steps = adapted_ev100(in_steps, 4, 0.01f, 0.4f, 1.2f);
    EXPECT_NEAR(in_steps, adapted_ev100(0, 4, 1, 0.4f, 1.2f), 1e-4f) << "whatever the frame rate";
}

TEST(Tone, ExposureFollowsTheCamera) {
    EXPECT_NEAR(ev100_from_camera(16, 1 / 125.0f, 100), 14.966f, 5e-4f);
    EXPECT_NEAR(exposure_scale(0), 1 / 1.2f, 1e-7f);
    EXPECT_NEAR(exposure_scale(10) * 1.2f * 1024, 1.0f, 1e-6f);
}

}  // namespace
}  // namespace heliodon::shading
