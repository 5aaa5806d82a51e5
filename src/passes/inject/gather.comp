#version 460
#extension GL_GOOGLE_include_directive : require
// The illuminance that every face of every voxel gets from the volume as it is and from the sky: one more bounce.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/inject/record_work.glsl"

layout(set = 0, binding = 19, std430) buffer Gathered { vec4 gathered[]; };
layout(push_constant) uniform Push { InjectConstants push; };

void main() {
    const uint index = linear_invocation();
    if (index >= voxel_header.record_count * voxel_faces) return;
    const VoxelFace face = voxel_face(push.grid, index / voxel_faces, index % voxel_faces);
    vec3 light = vec3(0.0f);
    if (face.area > 0.0f && face.albedo != vec3(0.0f) && face.normal != vec3(0.0f))
        light = pi * diffuse_light(cone_origin(face.position, face.normal, exp2(float(push.cascade))), face.normal, volume.gather_sets, push.gather_shift).radiance;
    if (push.gather_weight < 1.0f) light = mix(gathered[index].rgb, light, push.gather_weight);
    gathered[index] = vec4(light, 0.0f);
}
