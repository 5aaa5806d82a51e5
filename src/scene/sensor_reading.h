#pragma once

#include <string>

#include "scene/scene.h"

namespace heliodon {

/// What a sensor measured, by either engine.
struct SensorReading {
    std::string name;
    SensorType type = SensorType::illuminance;
    double value = 0;          ///< lux or cd/m²
    glm::dvec3 rgb{0};
    double half_width_95 = 0;  ///< of `value`; 0 for an engine without noise
};

}  // namespace heliodon
