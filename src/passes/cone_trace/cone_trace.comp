#version 460
#extension GL_GOOGLE_include_directive : require
// Adds indirect light from the voxel volume to the picture.
#include "passes/cone_trace/indirect.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool draws_aov = false;
layout(set = 0, binding = 8, std430) readonly buffer Frame_ { FrameData frame; };
layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
layout(set = 0, binding = 12) uniform usampler2D visibility;
layout(set = 0, binding = 13, rgba32f) uniform image2D picture;
float shading_table(uint index) { return shading_tables[index]; }

/// The volume as a pixel's own cone sees it.
vec4 volume_seen(vec3 direction) {
    const float size = length(cross(frame.ray_dx, frame.ray_dy));
    const ConeResult seen = trace_cone(to_lattice(frame.position), normalize(direction), sqrt(size * inverse_pi), unlimited);
    return vec4(frame.aov == frame_aov_opacity ? vec3(seen.cover) : seen.radiance, 1.0f);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height || frame.batch != 0u) return;
    const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
    const vec3 direction = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
    if (draws_aov && (frame.aov == frame_aov_voxels || frame.aov == frame_aov_opacity)) {
        imageStore(picture, ivec2(pixel), volume_seen(direction));
        return;
    }
    const uvec2 visible = texelFetch(visibility, ivec2(pixel), 0).xy;
    if (visible.x == 0u) return;
    const SurfacePoint point = resolve_surface(visible.x - 1u, visible.y, frame, direction);
    const IndirectLight light = indirect_light(point, frame.cone_shift);
    vec4 value = imageLoad(picture, ivec2(pixel));
    value.rgb += draws_aov && frame.aov == frame_aov_occlusion ? vec3(light.openness) : light.radiance;
    imageStore(picture, ivec2(pixel), value);
}
