#version 460
#extension GL_GOOGLE_include_directive : require
// Depth and its slope, where the surface is there: masked parts by their cutoff, blended parts with a chance
// equal to their opacity (panes: to what they keep back at this angle), drawn anew for each sample, so that the mean passes the light they let through.
#include "passes/common/alpha.glsl"
#include "passes/shadow/shadow_slope.glsl"

layout(set = 0, binding = 8, std430) readonly buffer Views { ViewData views[]; };
layout(push_constant) uniform Push { uint view; uint random_seed; };
layout(location = 0) in vec2 texcoord;
layout(location = 1) in float vertex_alpha;
layout(location = 2) flat in uint instance_index;
layout(location = 3) in vec3 position;
layout(location = 0) out vec2 slope;

void main() {
    slope = depth_slope();  // before any invocation leaves
    const vec3 normal = cross(dFdx(position), dFdy(position));
    const MaterialData material = material_table[instance_table[instance_index].material];
    float opacity = surface_opacity(material, texcoord, vertex_alpha);
    if (material.model == material_model_thin) {
        const vec4 clip = views[view].world_to_clip * vec4(position, 1.0f);
        opacity = pane_cover(material, views[view].world_to_clip, clip.xy / clip.w, normal);
    }
    if ((material.flags & material_flag_alpha_blend) != 0u) {
        if (unit_interval(alpha_seed(uvec2(gl_FragCoord.xy), instance_index, random_seed + view)) >= opacity) discard;
    } else if (opacity < material.alpha_cutoff) {
        discard;
    }
}
