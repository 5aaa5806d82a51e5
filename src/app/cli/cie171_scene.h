#pragma once

#include "app/cli/bench_cie171.h"

/// Building blocks of the report's scenes: x and y across, z up; here the second and the third change places.
namespace heliodon::cli {

[[nodiscard]] inline glm::dvec3 room(double x, double y, double z) {
    return {x, z, y};
}
[[nodiscard]] Material black();
[[nodiscard]] Material reflecting(float reflectance, float emission_nits = 0);
void add_quad(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, const Material& material);
void add_light(Scene& scene, const Light& light, const glm::dvec3& position);
/// Sensors stand a hundredth of a millimetre off their surface: on it to four digits of the smallest distance here.
void add_sensor(Scene& scene, const glm::dvec3& position, const glm::dvec3& normal, std::optional<SensorGrid> grid = {});
/// A grid over the rectangle, which faces u × v, and the weight of each of its points for the mean over it.
double add_grid(Scene& scene, const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, int count_a_side);

/// A sensor's point of its own.
void add_point(CieScene& scene, const std::string& name, const glm::dvec3& position, const glm::dvec3& normal, double exact);

/// 6 mm clear glass of the report, test 5.5: coefficients of the cosine of incidence.
inline constexpr std::array<double, 6> clear_glass{-.028378, 3.156075, -3.058376, -1.428919, 4.014235, -1.775827};
[[nodiscard]] double clear_glass_transmittance(double cosine);
[[nodiscard]] Material clear_glass_pane();

[[nodiscard]] std::vector<CieScene> cie_daylight_scenes(const std::string& test);  ///< 5.9 to 5.14

}  // namespace heliodon::cli
