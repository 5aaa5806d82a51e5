#version 460
#extension GL_GOOGLE_include_directive : require
// Resolves the visibility buffer and leaves what cones need to know of the surfaces, ahead of light.
#include "passes/common/scene_tables.glsl"
layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
float shading_table(uint index) { return shading_tables[index]; }
#include "passes/shade/left_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 12) uniform usampler2D visibility;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    const uvec2 visible = texelFetch(visibility, ivec2(pixel), 0).xy;
    if (visible.x == 0u) {
        leave_nothing(ivec2(pixel));
        return;
    }
    const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
    const vec3 direction = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
    const SurfacePoint point = resolve_surface(visible.x - 1u, visible.y, frame, direction);
    const vec3 wo = to_local(point.frame, point.wo);
    leave_surface(ivec2(pixel), point, wo, bsdf_prepare(point.material.surface, wo), frame);
}
