#version 460
#extension GL_GOOGLE_include_directive : require
// The illuminance of one batch of lights, with their shadows, on every face of every voxel.
#include "passes/common/light_visibility.glsl"
#include "passes/common/hash.glsl"
#include "passes/inject/record_work.glsl"
#include "passes/light_grid/light_choice.glsl"
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
    return sum * (light_reaching(light, face.position, face.normal, shadow_filter_percentage_closer) / float(samples));
}

const uint light_picks_a_face = 32u;

/// Of very many lights each face picks some, always the same ones: cones see the mean of many faces.
vec3 lights_illuminance(VoxelFace face, uint index) {
    vec3 sum = vec3(0.0f);
    LightPicks picks = light_picks(face.position, push.light_count, light_picks_a_face, unit_interval(pcg_hash(index)));
    LightPick pick;
    while (next_light(picks, pick))
        sum += pick.weight * illuminance_from(light_table[active_light_table[push.light_first + pick.light]], face);
    return sum;
}

void main() {
    const uint index = linear_invocation();
    if (index >= voxel_header.record_count * voxel_faces) return;
    const VoxelFace face = voxel_face(push.grid, index / voxel_faces, index % voxel_faces);
    vec3 sum = push.add != 0u ? illuminance[index].rgb : vec3(0.0f);
    if (face.area > 0.0f && face.albedo != vec3(0.0f)) sum += lights_illuminance(face, index);
    illuminance[index] = vec4(sum, 0.0f);
}
