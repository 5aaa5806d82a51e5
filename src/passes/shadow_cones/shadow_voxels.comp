#version 460
#extension GL_GOOGLE_include_directive : require
// Of each occupied voxel finds what of the batch's lights reaches the surfaces in it that face them: one cone a light for
// all six faces, which mostly show the same surface.
#include "passes/inject/record_work.glsl"
#include "passes/shadow_cones/shadow_cones.glsl"

layout(set = 0, binding = 19, std430) writeonly buffer Shares { uvec2 traced_voxels[]; };  // by record
layout(push_constant) uniform Push { InjectConstants push; };

/// From the middle of what the faces show to the light, each by the light that it gets.
float voxel_share(LightData light, uint record) {
    vec4 place = vec4(0.0f);
    vec3 normal = vec3(0.0f);
    for (uint i = 0u; i < voxel_faces; ++i) {
        const VoxelFace face = voxel_face(push.grid, record, i);
        if (face.area <= 0.0f) continue;
        const vec3 to_light = light.type == light_type_directional ? -light.axis : normalize(light.position - face.position);
        const float weight = face.area * max(dot(face.normal, to_light), 0.0f);
        place += weight * vec4(face.position, 1.0f);
        normal += weight * face.normal;
    }
    if (place.w <= 0.0f) return 0.0f;  // none faces it
    return cone_shadow(light, place.xyz / place.w, normalize(normal));
}

void main() {
    const uint record = linear_invocation();
    if (record >= voxel_header.record_count) return;
    vec4 shares = vec4(1.0f);
    for (uint i = 0u; i < min(push.light_count, most_lights_traced); ++i) {
        const LightData light = shining_light(push.light_first + i);
        if (light.cone_radius > 0.0f) shares[i] = voxel_share(light, record);
    }
    traced_voxels[record] = pack_shares(shares);
}
