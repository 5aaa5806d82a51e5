#version 460
#extension GL_GOOGLE_include_directive : require
// Depth and its slope, where the surface is there: masked parts by their cutoff, blended parts with a chance
// equal to their opacity, drawn anew for each sample, so that the mean passes the light they let through.
#include "passes/common/alpha.glsl"
#include "passes/shadow/shadow_slope.glsl"

layout(push_constant) uniform Push { uint view; uint random_seed; };
layout(location = 0) in vec2 texcoord;
layout(location = 1) in float vertex_alpha;
layout(location = 2) flat in uint instance_index;
layout(location = 0) out vec2 slope;

void main() {
    slope = depth_slope();  // before any invocation leaves
    const MaterialData material = material_table[instance_table[instance_index].material];
    const float opacity = surface_opacity(material, texcoord, vertex_alpha);
    if ((material.flags & material_flag_alpha_blend) != 0u) {
        if (unit_interval(alpha_seed(uvec2(gl_FragCoord.xy), instance_index, random_seed + view)) >= opacity) discard;
    } else if (opacity < material.alpha_cutoff) {
        discard;
    }
}
