#version 460
#extension GL_GOOGLE_include_directive : require
// The illuminance of one batch of lights, with their shadows, on every face of every voxel.
#include "passes/common/shadow_lookup.glsl"
#include "passes/inject/record_work.glsl"
#include "shading/environment.h"
#include "shading/light.h"

layout(set = 0, binding = 19, std430) buffer Illuminance { vec4 illuminance[]; };
layout(push_constant) uniform Push { InjectConstants push; };

const uint area_light_samples = 16u;

vec3 illuminance_from(LightData light, VoxelFace face) {
    const uint samples = light_is_delta(light) ? 1u : area_light_samples;
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < samples; ++i) {
        const LightSample arriving = light_sample(light, face.position, hammersley(i, samples));
        sum += arriving.value * max(dot(arriving.direction, face.normal), 0.0f);
    }
    if (sum == vec3(0.0f)) return sum;
    return sum * (light_visibility(light, face.position, face.normal, shadow_filter_percentage_closer) / float(samples));
}

void main() {
    const uint index = linear_invocation();
    if (index >= voxel_header.record_count * voxel_faces) return;
    const VoxelFace face = voxel_face(push.grid, index / voxel_faces, index % voxel_faces);
    vec3 sum = push.add != 0u ? illuminance[index].rgb : vec3(0.0f);
    if (face.area > 0.0f && face.albedo != vec3(0.0f)) {
        for (uint i = 0u; i < push.light_count; ++i)
            sum += illuminance_from(light_table[active_light_table[push.light_first + i]], face);
    }
    illuminance[index] = vec4(sum, 0.0f);
}
