#version 460
#extension GL_GOOGLE_include_directive : require
// Adds indirect light from the voxel volume to the picture.
#include "passes/cone_trace/half_resolution.glsl"
#include "passes/cone_trace/indirect.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool draws_aov = false;
layout(constant_id = 1) const bool half_resolution = false;
layout(set = 0, binding = 8, std430) readonly buffer Frame_ { FrameData frame; };
layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
layout(set = 0, binding = 12) uniform usampler2D visibility;
layout(set = 0, binding = 13, rgba32f) uniform image2D picture;
layout(set = 0, binding = 14) uniform sampler2D half_diffuse;  // of half_diffuse.comp
layout(set = 0, binding = 15) uniform sampler2D half_places;
float shading_table(uint index) { return shading_tables[index]; }

/// The volume as a pixel's own cone sees it.
vec4 volume_seen(vec3 direction) {
    const float size = length(cross(frame.ray_dx, frame.ray_dy));
    const ConeResult seen = trace_cone(to_lattice(frame.position), normalize(direction), sqrt(size * inverse_pi), unlimited);
    return vec4(frame.aov == frame_aov_opacity ? vec3(seen.cover) : seen.radiance, 1.0f);
}

/// The light of the traced pixels about this one, as far as they are like it; not known where none is.
vec4 upsampled(SurfacePoint point, ivec2 pixel) {
    const ivec2 traced = traced_pixel(frame.sample_index);
    const vec2 at = 0.5f * vec2(pixel - traced);
    const ivec2 corner = ivec2(floor(at));
    const ivec2 last = textureSize(half_places, 0) - 1;
    vec4 sum = vec4(0.0f);
    float total = 0.0f;
    for (int i = 0; i < 4; ++i) {
        const ivec2 tap = corner + ivec2(i & 1, i >> 1);
        if (any(lessThan(tap, ivec2(0))) || any(greaterThan(tap, last))) continue;
        const vec4 place = texelFetch(half_places, tap, 0);
        if (place.w == 0.0f) continue;
        const vec2 share = 1.0f - abs(at - vec2(tap));
        const vec2 there = vec2(2 * tap + traced) + 0.5f + frame.jitter;
        const vec3 position = frame.position + place.w * (frame.ray_corner + frame.ray_dx * there.x + frame.ray_dy * there.y);
        const float weight = share.x * share.y * likeness(point.frame.normal, position - point.position, place.xyz, volume.voxel_m);
        sum += weight * texelFetch(half_diffuse, tap, 0);
        total += weight;
    }
    // A sixteenth is the least that one of the four taps counts in the middle of its cell, were it wholly alike.
    if (total < 0.0625f) return not_known;
    return vec4(sum.rgb * volume.radiance_unit, sum.a) / total;
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
    const IndirectLight light = indirect_light(point, frame.cone_shift, half_resolution ? upsampled(point, ivec2(pixel)) : not_known);
    vec4 value = imageLoad(picture, ivec2(pixel));
    value.rgb += draws_aov && frame.aov == frame_aov_occlusion ? vec3(light.openness) : light.radiance;
    imageStore(picture, ivec2(pixel), value);
}
