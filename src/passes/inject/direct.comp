#version 460
#extension GL_GOOGLE_include_directive : require
// The illuminance of one batch of lights, with their shadows, on the voxels' faces to one side.
#include "passes/common/light_visibility.glsl"
#include "passes/common/hash.glsl"
#include "passes/inject/lit_faces.glsl"
#include "passes/light_grid/light_choice.glsl"
#include "shading/environment.h"
#include "passes/common/luminaires.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 19, std430) buffer Illuminance { vec4 illuminance[]; };
layout(set = 0, binding = 27, std430) readonly buffer Shares { uvec2 traced_voxels[]; };  // of shadow_voxels.comp
layout(push_constant) uniform Push { InjectConstants push; };

const uint area_light_samples = 16u;

vec3 illuminance_from(uint index, VoxelFace face) {
    const LightData light = shining_light(push.light_first + index);
    const uint samples = light_is_delta(light) ? 1u : area_light_samples;
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < samples; ++i) {
        const LightSample arriving = scene_light_sample(light, face.position, hammersley(i, samples));
        sum += arriving.value * max(dot(arriving.direction, face.normal), 0.0f);
    }
    if (sum == vec3(0.0f)) return sum;
    return sum * (light_reaching(light, index, face.position, face.normal, shadow_filter_percentage_closer) / float(samples));
}

const uint light_picks_a_face = 32u;

/// Of very many lights each face picks some, always the same ones: cones see the mean of many faces.
vec3 lights_illuminance(VoxelFace face, uint cell) {
    vec3 sum = vec3(0.0f);
    LightPicks picks = light_picks(face.position, push.light_count, light_picks_a_face, unit_interval(pcg_hash(voxel_faces * cell + push.face)));
    LightPick pick;
    while (next_light(picks, pick))
        sum += pick.weight * illuminance_from(pick.light, face);
    return sum;
}

void main() {
    uint record;
    bool enclosed;
    if (!lit_record(push.face, linear_invocation(), record, enclosed)) return;
    if (shadows_traced) traced_shares = unpack_shares(traced_voxels[record]);
    const uint index = record * voxel_faces + push.face;
    const vec3 before = push.add != 0u ? illuminance[index].rgb : vec3(0.0f);
    illuminance[index] = vec4(before + lights_illuminance(voxel_face(push.grid, record, push.face), record_cell[record]), 0.0f);
}
