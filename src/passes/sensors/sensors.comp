#version 460
#extension GL_GOOGLE_include_directive : require
// Illuminance on planes: the batch's lights with their shadows, and the open sky with what stands for surroundings.
#include "passes/common/lighting.glsl"
#include "passes/sensors/sensors_shared.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 12, std430) buffer Sensors { SensorData sensors[]; };
layout(push_constant) uniform Push { SensorConstants push; };

/// Lights with an extent come here as one of their points, and the shadow grids move; the caller averages over many.
vec3 illuminance_from(uint index, vec3 position, vec3 normal) {
    const LightData light = shining_light(push.light_first + index);
    const LightSample arriving = scene_light_sample(light, position, vec2(0.5f));
    const vec3 unshadowed = arriving.value * max(dot(arriving.direction, normal), 0.0f);
    if (unshadowed == vec3(0.0f)) return unshadowed;
    return unshadowed * light_reaching(light, index, position, normal, shadow_filter_free);
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.sensor_count) return;
    const vec3 position = sensors[index].position;
    const vec3 normal = sensors[index].normal;
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < push.light_count; ++i)
        sum += illuminance_from(i, position, normal);
    if (push.sky_enabled != 0u) sum += sky_diffuse(normal) * pi;
    if (ambient_in_the_open() && push.ambient_enabled != 0u) sum += ambient_diffuse(normal, push.sky_enabled != 0u) * pi;
    sensors[index].illuminance = sum;
}
