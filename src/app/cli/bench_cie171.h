#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace heliodon::cli {

/// One number that CIE 171:2006 asks for, from the readings of one or more sensors.
struct CiePoint {
    std::string name;
    double exact = 0;
    std::vector<std::pair<std::size_t, double>> sensors;  ///< number and weight
};

/// A scene of a test case with everything that is measured in it.
struct CieScene {
    std::string test;     ///< "5.9"
    std::string variant;  ///< "opening 1×1 m, sky 12"; empty if there is one alone
    std::string unit;     ///< of the points
    Scene scene;
    std::vector<CiePoint> points;
    double scale = 1;         ///< from a sensor's reading to the unit
    double error_share = 1;   ///< of the target error that each sensor may take: less where they are combined
    double floor = 0;         ///< in the unit: smaller values are zero to the target error
    int samples = 1 << 15;    ///< a sensor, at least
    int max_depth = 0;
    bool indirect = false;    ///< without what the lights send directly
};

[[nodiscard]] std::vector<std::string> cie_tests();
/// The scenes of one of those tests.
[[nodiscard]] std::vector<CieScene> cie_scenes(const std::string& test);

struct CieResult {
    std::string name;
    double exact = 0, value = 0, half_width_95 = 0;
    /// Relative; of a point whose exact value is 0 absolute, in the unit.
    [[nodiscard]] double error() const { return exact != 0 ? value / exact - 1 : value; }
    [[nodiscard]] double relative_half_width() const { return exact != 0 ? half_width_95 / exact : 0; }
};
struct CieSceneReport {
    std::string test, variant, unit;
    std::vector<CieResult> points;
};
struct CieReport {
    std::vector<CieSceneReport> scenes;
    double seconds = 0;
};

inline constexpr double full_target_error = 0.002;
struct CieOptions {
    std::vector<std::string> tests = cie_tests();
    double target_error = full_target_error;  ///< 95 % half-width over value
    std::uint32_t seed = 0;
};
[[nodiscard]] Result<CieReport> run_cie171(const CieOptions& options);
[[nodiscard]] std::string as_text(const CieReport& report);
[[nodiscard]] std::string as_json(const CieReport& report);

}  // namespace heliodon::cli
