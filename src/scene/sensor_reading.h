#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace heliodon {

/// What a sensor measured, by either engine.
struct SensorReading {
    std::string name;
    SensorType type = SensorType::illuminance;
    double value = 0;          ///< lux or cd/m²
    glm::dvec3 rgb{0};
    double half_width_95 = 0;  ///< of `value`: of the noise of its samples, not of what an engine approximates
    glm::vec3 position{0};
    bool in_grid = false;      ///< one point of many of its sensor
};

/// A sensor with the place that it looks out from.
struct SensorPoint {
    const Sensor* sensor = nullptr;
    std::string name;  ///< of a grid: name[column,row]
    glm::vec3 position{0}, direction{0};
    float offset_m = 0;
    [[nodiscard]] glm::vec3 origin() const { return position + offset_m * direction; }
};
/// Every reading that the scene's sensors ask for, in their order; a grid's row by row along its u. `default_offset_m`
/// is of sensors without their own.
[[nodiscard]] std::vector<SensorPoint> sensor_points(const Scene& scene, float default_offset_m);

}  // namespace heliodon
