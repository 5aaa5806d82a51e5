#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "core/math.h"
#include "core/padded_array.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/units.h"

namespace heliodon {
namespace {

// f/16, 1/125 s, ISO 100 is EV 14.966 ("Tone and exposure" of the shared data).
TEST(Units, ExposureOfASunnyDayIsThePublishedOne) {
    EXPECT_NEAR(units::ev100_from_camera(16.0f, 1.0f / 125.0f, 100.0f), 14.966, 5e-4);
    EXPECT_NEAR(units::ev100_from_camera(16.0f, 1.0f / 125.0f, 200.0f), 13.966, 5e-4);
}

TEST(Units, SaturationLuminanceAndExposureAreInverse) {
    EXPECT_FLOAT_EQ(units::exposure_scale(0) * 1.2f, 1.0f);
    EXPECT_FLOAT_EQ(units::exposure_scale(10) * 1228.8f, 1.0f);
    for (const float ev100 : {-6.0f, 0.0f, 14.966f}) {
        const float nits = 1.0f / units::exposure_scale(ev100);
        EXPECT_NEAR(units::ev100_from_saturation_luminance(nits), ev100, 1e-5);
    }
}

TEST(Units, SrgbEncodingMeetsItsStandardAndDecodingUndoesIt) {
    EXPECT_EQ(units::srgb_encode(0.0f), 0.0f);
    EXPECT_NEAR(units::srgb_encode(1.0f), 1.0f, 1e-6);
    EXPECT_NEAR(units::srgb_encode(0.5f), 0.735357f, 1e-6);
    EXPECT_NEAR(units::srgb_decode(0.5f), 0.214041f, 1e-6);
    for (float value = 0.0f; value <= 1.0f; value += 1.0f / 512.0f) {
        EXPECT_NEAR(units::srgb_decode(units::srgb_encode(value)), value, 1e-6);
    }
}

TEST(Units, LuminanceWeightsSumToOne) {
    EXPECT_FLOAT_EQ(units::luminance(glm::vec3(1.0f)), 1.0f);
    EXPECT_FLOAT_EQ(units::luminance(glm::vec3(0.0f, 2.0f, 0.0f)), 1.4304f);
}

TEST(ParallelFor, VisitsEveryItemOnceInPiecesOfTheGrainOnAnyNumberOfThreads) {
    for (const int threads : {0, 1, 2, 7}) {
        for (const std::size_t count : {0u, 1u, 15u, 16u, 1000u}) {
            std::vector<std::atomic<int>> visits(count);
            parallel_for(
                count, 16,
                [&](std::size_t begin, std::size_t end) {
                    EXPECT_EQ(begin % 16, 0u);
                    EXPECT_TRUE(end == begin + 16 || end == count);
                    for (std::size_t i = begin; i < end; ++i) ++visits[i];
                },
                threads);
            for (const auto& visit : visits) EXPECT_EQ(visit, 1);
        }
    }
}

TEST(ParallelFor, RunsInOrderOnOneThread) {
    std::vector<std::size_t> begins;
    parallel_for(
        50, 0, [&](std::size_t begin, std::size_t) { begins.push_back(begin); }, 1);
    std::vector<std::size_t> expected(50);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_EQ(begins, expected);
}

TEST(ParallelFor, PassesExceptionsOn) {
    const auto body = [](std::size_t begin, std::size_t) {
        if (begin == 40) throw std::runtime_error("piece 40");
    };
    for (const int threads : {0, 1, 2}) EXPECT_THROW(parallel_for(100, 10, body, threads), std::runtime_error);
}

TEST(Bounds, GrowAroundPointsAndFollowTransforms) {
    Bounds bounds;
    EXPECT_TRUE(bounds.empty());
    EXPECT_EQ(bounds.extent(), glm::vec3(0.0f));
    bounds.include(Bounds{});
    EXPECT_TRUE(bounds.empty()) << "an empty box adds nothing";
    EXPECT_TRUE(bounds.transformed(glm::mat4(2.0f)).empty());
    bounds.include(glm::vec3(1.0f, 2.0f, 3.0f));
    bounds.include(glm::vec3(-1.0f, 2.0f, 5.0f));
    EXPECT_EQ(bounds.extent(), glm::vec3(2.0f, 0.0f, 2.0f));
    EXPECT_EQ(bounds.center(), glm::vec3(0.0f, 2.0f, 4.0f));
    EXPECT_FLOAT_EQ(bounds.diagonal(), std::sqrt(8.0f));
    const Bounds moved = bounds.transformed(glm::translate(glm::mat4(1.0f), glm::vec3(1.0f)));
    EXPECT_EQ(moved.min, glm::vec3(0.0f, 3.0f, 4.0f));
    EXPECT_EQ(moved.max, glm::vec3(2.0f, 3.0f, 6.0f));
}

TEST(PaddedArray, HasSixteenReadableBytesPastItsEnd) {
    const PaddedArray<float> values(5, 1.0f);
    // The allocation is larger than the array; address sanitizer would object to this read otherwise.
    const volatile char* past = reinterpret_cast<const char*>(values.data() + values.size());
    for (int i = 0; i < 16; ++i) static_cast<void>(past[i]);
    EXPECT_EQ(values.size(), 5u);
}

TEST(Error, TextNamesThePlaceWhereThereIsOne) {
    EXPECT_EQ((Error{"a.json:3", "expected a number"}.text()), "a.json:3: expected a number");
    EXPECT_EQ((Error{"", "no device"}.text()), "no device");
}

}  // namespace
}  // namespace heliodon
