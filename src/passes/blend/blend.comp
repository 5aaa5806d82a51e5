#version 460
#extension GL_GOOGLE_include_directive : require
// Shades each pixel's blended fragments from back to front over the opaque picture: Porter & Duff 1984, over.
#include "passes/common/lighting.glsl"
#include "passes/common/visible_lights.glsl"
#include "passes/blend/blend_shared.h"
#include "passes/blend/blended_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 1) const bool cone_traced = false;
layout(set = 0, binding = 8, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 12, std430) buffer Fragments { uint fragment_count; uint fragment_demand; uint padding1; uint padding2; BlendFragment fragments[]; };
layout(set = 0, binding = 13, std430) readonly buffer Heads { uint heads[]; };
layout(set = 0, binding = 14, rgba32f) uniform image2D contribution;

/// A strict order of a pixel's fragments, farthest first; what is equally far goes by its identity, so
/// that the picture does not depend on the order in which fragments arrived.
bool farther(BlendFragment a, BlendFragment b) {
    if (a.depth != b.depth) return a.depth < b.depth;
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
}

/// The farthest fragment that is nearer than `last`; index + 1, or 0.
uint next_nearer(uint head, bool first, BlendFragment last) {
    uint best = 0u;
    for (uint at = head; at != 0u; at = fragments[at - 1u].next) {
        if (!first && !farther(last, fragments[at - 1u])) continue;
        if (best == 0u || farther(fragments[at - 1u], fragments[best - 1u])) best = at;
    }
    return best;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    // The most fragments that any sample wanted, for the renderer to look at afterwards.
    if (pixel == uvec2(0u)) atomicMax(fragment_demand, fragment_count);
    const uint head = heads[pixel.y * frame.width + pixel.x];
    if (head == 0u) return;
    const vec2 position = vec2(pixel) + 0.5f + frame.jitter;
    const vec3 direction = frame.ray_corner + frame.ray_dx * position.x + frame.ray_dy * position.y;
    const uint seed = pcg_hash(pixel.x + pcg_hash(pixel.y + pcg_hash(frame.random_seed)));

    vec4 value = imageLoad(contribution, ivec2(pixel));
    BlendFragment fragment = fragments[head - 1u];
    for (uint at = next_nearer(head, true, fragment); at != 0u; at = next_nearer(head, false, fragment)) {
        fragment = fragments[at - 1u];
        const SurfacePoint point = resolve_surface(fragment.instance, fragment.triangle, frame, direction);
        const MaterialData material = material_table[instance_table[fragment.instance].material];
        float opacity = point.material.opacity;
        float passing = 1.0f - opacity;
        if (material.model == material_model_thin) {  // mirrors a part and lets another pass
            opacity = material.reflectance;
            passing = thin_transmittance(material, dot(point.wo, point.geometric));
        }
        if (passing >= 1.0f) continue;
        vec3 radiance = vec3(0.0f);
        if (opacity > 0.0f) radiance = surface_radiance(point, frame, pcg_hash(seed + fragment.instance + pcg_hash(fragment.triangle)));
        if (opacity > 0.0f && cone_traced && frame.batch == 0u) radiance += indirect_reflected(point, frame.cone_shift, frame.cone_share, solid_diagonal(fragment.instance));
        // The picture has all lights that stand before opaque surfaces: those before this one it does not dim.
        vec3 before = vec3(0.0f);
        if (frame.batch == 0u) before = lights_seen(frame.position, -point.wo, distance(frame.position, point.position));
        value.rgb = (value.rgb - before) * passing + radiance * opacity + before;
        value.a = 1.0f - (1.0f - value.a) * passing;
    }
    imageStore(contribution, ivec2(pixel), value);
}
