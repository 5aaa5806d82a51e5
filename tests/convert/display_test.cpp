#include "convert/display.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

namespace heliodon::convert {
namespace {

Image uniform(float nits, int width = 64, int height = 48) {
    return Image(width, height, 3, nits);
}
void fill(Image& image, int x0, int y0, int x1, int y1, float nits) {
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = nits;
}
/// The meter's reading where there is no light.
float darkness() {
    return shading::metering_stop(0) + std::log2(8.0f);
}
float metered(const Image& image, ExposureSettings settings = {}) {
    settings.mode = ExposureMode::metered;
    return exposure_ev100(settings, meter(image, settings), 0);
}

TEST(Metering, AUniformPictureReadsItsLuminanceByEveryPatternAndMean) {
    for (const float nits : {0.01f, 1.0f, 333.0f, 40000.0f})
        for (const auto pattern : {MeteringPattern::average, MeteringPattern::centre, MeteringPattern::spot})
            for (const bool arithmetic : {false, true})
                EXPECT_NEAR(metered(uniform(nits), {.pattern = pattern, .arithmetic_mean = arithmetic}),
                            std::log2(nits * 100 / 12.5f), 0.002f)
                    << nits;
}

TEST(Metering, HalfBlackHalfBrightIsTheMeanOfStopsOrOfLuminance) {
    Image image = uniform(1);
    fill(image, 0, 0, 32, 48, 1024);
    EXPECT_NEAR(metered(image), std::log2(8.0f) + 5, 0.002f);
    EXPECT_NEAR(metered(image, {.arithmetic_mean = true}), std::log2(8 * 512.5f), 0.003f);
}

TEST(Metering, TheSpotLooksAtTheMiddleAloneAndTheCentreThreeQuarters) {
    Image image = uniform(1, 96, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            if (std::hypot(x + 0.5 - 48, y + 0.5 - 32) <= 16) fill(image, x, y, x + 1, y + 1, 256);
    EXPECT_NEAR(metered(image, {.pattern = MeteringPattern::spot}), std::log2(8 * 256.0f), 0.002f);
    EXPECT_NEAR(metered(image, {.pattern = MeteringPattern::centre}), std::log2(8.0f) + 0.75f * 8, 0.002f);
    const float share = 804.0f / (96 * 64);  // of the circle's pixels
    EXPECT_NEAR(metered(image), std::log2(8.0f) + share * 8, 0.03f);
}

TEST(Metering, PercentilesLeaveOutTheSunAndTheDark) {
    Image image = uniform(100);
    fill(image, 0, 0, 6, 48, 1e6f);      // 9.4 %
    fill(image, 58, 0, 64, 48, 0.001f);  // 9.4 %
    EXPECT_NEAR(metered(image, {.percentiles = {0.1f, 0.9f}}), std::log2(800.0f), 0.002f);
    EXPECT_GT(metered(image, {.arithmetic_mean = true}), 19);
}

TEST(Metering, WhereThereIsNothingTheLogarithmsMeanSeesNothing) {
    Image image = uniform(100);
    fill(image, 0, 0, 32, 48, 0);
    EXPECT_NEAR(metered(image), std::log2(800.0f), 0.002f);
    EXPECT_NEAR(metered(image, {.arithmetic_mean = true}), std::log2(400.0f), 0.002f);
}

TEST(Metering, WhatIsNoNumberOrNegativeCountsAsDark) {
    Image image = uniform(NAN, 4, 4);
    EXPECT_NEAR(metered(image), darkness(), 0.01f);
    image = uniform(-3, 4, 4);
    EXPECT_NEAR(metered(image), darkness(), 0.01f);
    EXPECT_TRUE(std::isfinite(metered(uniform(1e30f, 1, 1))));
}

TEST(Display, ExposureCompensationDoublesTheLightAStop) {
    const Image light = uniform(10, 2, 2);
    DisplaySettings linear{.tone = {.curve = ToneCurve::linear}};
    const float ev100 = std::log2(10 / 0.6f);  // half the sensor's range
    EXPECT_NEAR(displayed(light, linear, ev100).at(0, 0), units::srgb_encode(0.5f), 1e-5f);
    EXPECT_NEAR(displayed(light, linear, ev100 - 0.5f).at(0, 0), units::srgb_encode(0.5f * std::sqrt(2.0f)), 1e-5f);
    EXPECT_EQ(exposure_ev100({.compensation_ev = 1}, {}, 9), 8);
}

TEST(Display, TheCurveAndItsWhiteAreTheSettings) {
    const Image light = uniform(1.2f, 1, 1);  // x = 1 at EV100 0
    const auto value = [&](ToneSettings tone) { return units::srgb_decode(displayed(light, {.tone = tone}, 0).at(0, 0)); };
    EXPECT_NEAR(value({}), 0.492919f, 1e-5f);
    EXPECT_NEAR(value({.curve = ToneCurve::neutral}), 0.869091f, 1e-5f);
    EXPECT_NEAR(value({.curve = ToneCurve::reinhard, .white = 1}), 1, 1e-5f);
    EXPECT_NEAR(value({.curve = ToneCurve::reinhard, .estimate_white = true}), 1, 1e-5f)
        << "a picture of one luminance over its key is white there";
}

}  // namespace
}  // namespace heliodon::convert
