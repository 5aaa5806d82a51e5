#include "scene/sensor_reading.h"

#include <fmt/format.h>

namespace heliodon {

std::vector<SensorPoint> sensor_points(const Scene& scene, float default_offset_m) {
    std::vector<SensorPoint> points;
    scene.sensors().each([&](SensorId, const Sensor& sensor) {
        const float offset_m = sensor.offset_m.value_or(default_offset_m);
        const glm::vec3 direction = glm::normalize(sensor.direction);
        if (!sensor.grid) {
            points.push_back({&sensor, sensor.name, sensor.position, direction, offset_m});
            return;
        }
        const SensorGrid& grid = *sensor.grid;
        for (int row = 0; row < grid.counts.y; ++row)
            for (int column = 0; column < grid.counts.x; ++column) {
                const glm::vec2 at = (glm::vec2(column, row) + 0.5f) / glm::vec2(grid.counts);
                points.push_back({&sensor, fmt::format("{}[{},{}]", sensor.name, column, row),
                                  sensor.position + at.x * grid.u + at.y * grid.v, direction, offset_m});
            }
    });
    return points;
}

}  // namespace heliodon
