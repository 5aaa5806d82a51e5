#version 460
#extension GL_GOOGLE_include_directive : require
// The illuminance that the voxels' faces to one side get from the volume as it is and from the sky: one more bounce.
// An invocation traces one cone of each set. Those beside it trace the same one from faces nearby, so that they
// go alike, and long cones keep no other cone of their face waiting.
#include "passes/cone_trace/cone_light.glsl"
#include "passes/inject/lit_faces.glsl"

layout(local_size_x = gather_faces_a_group, local_size_y = cones_per_set) in;
layout(set = 0, binding = 19, std430) buffer Gathered { vec4 gathered[]; };  // w: 1 once there is any
layout(push_constant) uniform Push { InjectConstants push; };

shared vec3 arriving[cones_per_set][gather_faces_a_group];

/// Irradiance / π by one cone of each set.
vec3 light_of_cone(vec3 origin, vec3 normal, uint index) {
    const Frame frame = frame_from_normal(normal);
    vec3 sum = vec3(0.0f);
    for (uint set = 0u; set < volume.gather_sets; ++set) {
        Cone cone = diffuse_cone(index, set, volume.gather_sets, push.gather_shift, push.gather_share);
        cone.direction = to_world(frame, cone.direction);
        sum += cone.weight * cone_light(origin, cone).radiance;
    }
    return sum;
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint cone = gl_LocalInvocationID.y;
    uint record;
    bool enclosed;
    const bool listed = lit_record(push.face, linear_group() * gather_faces_a_group + lane, record, enclosed);
    const uint index = record * voxel_faces + push.face;
    const vec4 before = listed ? gathered[index] : vec4(0.0f);
    const bool wanted = listed && (push.unlit_only == 0u || before.w == 0.0f);
    arriving[cone][lane] = vec3(0.0f);
    if (wanted && !enclosed) {
        const VoxelFace face = voxel_face(push.grid, record, push.face);
        arriving[cone][lane] = light_of_cone(cone_origin(face.position, face.normal, exp2(float(push.cascade))), face.normal, cone);
    }
    barrier();
    if (!wanted || cone != 0u) return;
    vec3 light = vec3(0.0f);
    for (uint i = 0u; i < cones_per_set; ++i) light += arriving[i][lane];  // in one order, run for run
    light *= pi;
    if (push.gather_weight < 1.0f && before.w > 0.0f) light = mix(before.rgb, light, push.gather_weight);
    gathered[index] = vec4(light, enclosed ? 0.0f : 1.0f);
}
