#version 460
#extension GL_GOOGLE_include_directive : require
// Traces the diffuse cones of one pixel in four.
#include "passes/cone_trace/half_resolution.glsl"
#include "passes/cone_trace/indirect.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8, std430) readonly buffer Frame_ { FrameData frame; };
layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
layout(set = 0, binding = 12) uniform usampler2D visibility;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D diffuse;  // irradiance / π in the volume's unit, openness
layout(set = 0, binding = 14, rgba32f) uniform writeonly image2D places;   // normal, depth along the view (0: nothing)
float shading_table(uint index) { return shading_tables[index]; }

void main() {
    const uvec2 half_pixel = gl_GlobalInvocationID.xy;
    const ivec2 pixel = min(2 * ivec2(half_pixel) + traced_pixel(frame.sample_index), ivec2(frame.width, frame.height) - 1);
    if (2u * half_pixel.x >= frame.width || 2u * half_pixel.y >= frame.height || frame.batch != 0u) return;
    const uvec2 visible = texelFetch(visibility, pixel, 0).xy;
    vec4 light = vec4(0.0f);
    vec4 place = vec4(0.0f);
    if (visible.x != 0u) {
        const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
        const vec3 direction = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
        const SurfacePoint point = resolve_surface(visible.x - 1u, visible.y, frame, direction);
        const ConeLight traced = diffuse_light(cone_origin(point.position, point.geometric), point.frame.normal, volume.cone_sets, frame.cone_shift);
        light = vec4(min(traced.radiance / volume.radiance_unit, vec3(65504.0f)), traced.openness);
        place = vec4(point.frame.normal, dot(point.position - frame.position, frame.forward));
    }
    imageStore(diffuse, ivec2(half_pixel), light);
    imageStore(places, ivec2(half_pixel), place);
}
