#include "shading/ambient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace heliodon::tests {
namespace {

/// ∫ f dω over the sphere by midpoints.
template <class Function>
double over_sphere(Function f) {
    constexpr int rows = 400, columns = 400;
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double z = 1 - 2 * (i + 0.5) / rows, phi = 2 * std::numbers::pi * (j + 0.5) / columns, r = std::sqrt(1 - z * z);
            sum += f(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z));
        }
    return sum * 4 * std::numbers::pi / (rows * columns);
}

TEST(Ambient, TheProductOfTwoCosinesOverTheSphereIsTheClosedForm) {
    for (const double angle_deg : {0.0, 20.0, 60.0, 90.0, 135.0, 170.0, 180.0}) {
        const double angle = angle_deg * std::numbers::pi / 180;
        const glm::dvec3 a(0, 0, 1), b(std::sin(angle), 0, std::cos(angle));
        const double expected = over_sphere([&](glm::dvec3 w) { return std::max(0.0, glm::dot(a, w)) * std::max(0.0, glm::dot(b, w)); });
        EXPECT_NEAR(shading::cosines_product(static_cast<float>(std::cos(angle))), expected, 2e-4) << angle_deg;
    }
}

TEST(Ambient, TheConstantTermIsTheMeanOfTheDirectionalOneAndOfTheShell) {
    const double faces = over_sphere([](glm::dvec3 n) { return shading::shell_reflected(static_cast<float>(n.z)); });
    const double shell = over_sphere([](glm::dvec3 w) { return shading::shell_radiance(static_cast<float>(w.z)); });
    EXPECT_NEAR(faces / (4 * std::numbers::pi), shading::shell_reflected_mean, 1e-5);
    EXPECT_NEAR(shell / (4 * std::numbers::pi), shading::shell_reflected_mean, 1e-5);
}

TEST(Ambient, AFaceTurnedFromTheLightGetsMostAndOneTowardsItNothing) {
    EXPECT_NEAR(shading::shell_reflected(1), 2 / (3 * std::numbers::pi), 1e-6);
    EXPECT_NEAR(shading::shell_reflected(-1), 0, 1e-6);
}

}  // namespace
}  // namespace heliodon::tests
