#version 460
#extension GL_GOOGLE_include_directive : require
// Adds what planes receive from the voxel volume and, past it, from the sky.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/sensors/sensors_shared.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 12, std430) buffer Sensors { SensorData sensors[]; };
layout(push_constant) uniform Push { SensorConstants push; };

const uint sensor_cone_sets = 64u;  // of cones a seventh of a right angle wide, finer than a picture's

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.sensor_count) return;
    const vec3 normal = sensors[index].normal;
    const vec3 origin = cone_origin(sensors[index].position, normal);
    sensors[index].illuminance += pi * diffuse_light(origin, normal, sensor_cone_sets, vec2(0.0f)).radiance;
}
