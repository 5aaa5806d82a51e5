#version 460
#extension GL_GOOGLE_include_directive : require
// Resolves the visibility buffer and lights it; may leave what cones need to know of the surfaces.
#include "passes/common/lighting.glsl"
#include "passes/common/visible_lights.glsl"
#include "passes/shade/left_surface.glsl"
#include "passes/shadow_cones/pixel_shadows.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// Pictures of something else than radiance have a pipeline of their own, so that the common one stays small.
layout(constant_id = 0) const bool draws_aov = false;
layout(constant_id = 2) const bool leaves_surfaces = false;
layout(set = 0, binding = 8, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 12) uniform usampler2D visibility;
layout(set = 0, binding = 29) uniform usampler2D shadowed;  // of passes/shadow_volumes
layout(set = 0, binding = 13, rgba32f) uniform writeonly image2D contribution;

vec4 background(vec3 direction) {
    if (draws_aov || frame.batch != 0u) return vec4(0.0f);
    const vec3 unit = normalize(direction);
    vec3 seen = lights_seen(frame.position, unit, beyond_every_light);
    if (has_sky && frame.sky_enabled != 0u) seen += sky_seen(unit);
    return vec4(seen, 0.0f);
}

/// What a white Lambertian surface in its place reflects, times π, is the illuminance.
void make_white(inout SurfacePoint point) {
    point.material.surface = surface_default();
    point.material.surface.model = material_model_lambert;
    point.material.surface.base_color = vec3(1.0f);
    point.material.emission = vec3(0.0f);
}

vec3 value_of(SurfacePoint point, vec3 wo, BsdfLobes lobes, uint pixel_seed) {
    if (!draws_aov) return surface_radiance(point, wo, lobes, frame, pixel_seed);
    switch (frame.aov) {
        case frame_aov_albedo: return point.material.surface.base_color;
        case frame_aov_normal: return point.frame.normal;
        case frame_aov_depth: return vec3(dot(point.position - frame.position, frame.forward));
        case frame_aov_position: return point.position;
        case frame_aov_illuminance: return pi * surface_radiance(point, wo, lobes, frame, pixel_seed);
        default: return vec3(0.0f);  // indirect light
    }
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
    const vec3 direction = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
    const uvec2 visible = texelFetch(visibility, ivec2(pixel), 0).xy;
    vec4 value;
    if (visible.x == 0u) {
        value = background(direction);
        if (leaves_surfaces) leave_nothing(ivec2(pixel));
    } else {
        const uint seed = pcg_hash(pixel.x + pcg_hash(pixel.y + pcg_hash(frame.random_seed)));
        SurfacePoint point = resolve_surface(visible.x - 1u, visible.y, frame, direction);
        if (draws_aov && frame.aov == frame_aov_illuminance) make_white(point);
        const vec3 wo = to_local(point.frame, point.wo);
        const BsdfLobes lobes = bsdf_prepare(point.material.surface, wo);
        if (leaves_surfaces) leave_surface(ivec2(pixel), point, wo, lobes, frame);
        if (volumes_cast) {
            volume_light = frame.volume_light;
            volume_share = texelFetch(shadowed, ivec2(pixel), 0).r == 0u ? 1.0f : 0.0f;
        }
        if (shadows_traced) traced_shares = pixel_shares(ivec2(pixel), point.position, point.geometric, frame);
        value = vec4(value_of(point, wo, lobes, seed), 1.0f);
        // Batches add up, the surface counts once.
        if (draws_aov && frame.aov == frame_aov_illuminance && frame.batch != 0u) value.a = 0.0f;
        if (!draws_aov && frame.batch == 0u)
            value.rgb += lights_seen(frame.position, -point.wo, distance(frame.position, point.position));
    }
    imageStore(contribution, ivec2(pixel), value);
}
