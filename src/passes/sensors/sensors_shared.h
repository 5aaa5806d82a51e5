#ifndef HELIODON_PASSES_SENSORS_SHARED_H
#define HELIODON_PASSES_SENSORS_SHARED_H
#include "shading/language.h"
SHADING_BEGIN

/// A plane that receives light, and the illuminance it gets (lux, RGB).
struct SensorData {
    vec3 position;
    float padding0;
    vec3 normal;
    float padding1;
    vec3 illuminance;
    float padding2;
};

struct SensorConstants {
    uint sensor_count;
    uint light_first;
    uint light_count;
    uint sky_enabled;      // with the first batch of lights only, as is the next
    uint ambient_enabled;  // what surroundings reflect, though no light is traced
};

SHADING_END
#endif
