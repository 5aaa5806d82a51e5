#include "core/white_balance.h"

#include <gtest/gtest.h>

#include "core/units.h"

namespace heliodon {
namespace {

TEST(WhiteBalance, ChromaticitiesOfStandardIlluminantsComeOut) {
    // CIE 15:2004: D50, D65, D75 by their correlated temperatures; illuminant A is a black body of 2856 K.
    struct Row {
        float temperature_k;
        glm::vec2 xy;
    };
    for (const Row& row : {Row{5003, {0.34567f, 0.35850f}}, Row{6504, {0.31272f, 0.32903f}}, Row{7504, {0.29902f, 0.31485f}},
                           Row{2856, {0.44757f, 0.40745f}}}) {
        EXPECT_NEAR(white_chromaticity(row.temperature_k).x, row.xy.x, 4e-4f) << row.temperature_k;
        EXPECT_NEAR(white_chromaticity(row.temperature_k).y, row.xy.y, 4e-4f) << row.temperature_k;
    }
}

TEST(WhiteBalance, DaylightOf6504KelvinStaysAsItIs) {
    const glm::vec3 white = white_balance_matrix(white_chromaticity(6504)) * glm::vec3(1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-3f);
}

TEST(WhiteBalance, TheWhiteThatIsNamedBecomesNeutralOfTheSameLuminance) {
    // Linear Rec. 709 of illuminant A at luminance 1.
    const glm::vec2 xy = white_chromaticity(2856);
    const glm::dvec3 xyz(xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y);
    const glm::dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                         -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                         0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    const glm::vec3 balanced = white_balance_matrix(xy) * glm::vec3(rgb);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(balanced[c], 1, 1e-4f);
}

}  // namespace
}  // namespace heliodon
