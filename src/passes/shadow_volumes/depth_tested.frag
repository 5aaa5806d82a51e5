#version 460
#extension GL_GOOGLE_include_directive : require
#include "passes/common/alpha.glsl"

layout(location = 0) in vec2 texcoord;
layout(location = 1) in float vertex_alpha;
layout(location = 2) flat in uint instance_index;

void main() {
    const MaterialData material = material_table[instance_table[instance_index].material];
    if (surface_opacity(material, texcoord, vertex_alpha) < material.alpha_cutoff) discard;
}
