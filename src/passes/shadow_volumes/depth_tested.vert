#version 460
#extension GL_GOOGLE_include_directive : require
// With what an alpha test needs.
#include "passes/shadow_volumes/volume_position.glsl"

layout(location = 0) out vec2 texcoord;
layout(location = 1) out float vertex_alpha;
layout(location = 2) flat out uint instance_index;

void main() {
    const InstanceData instance = instance_table[gl_InstanceIndex];
    const GeometryData geometry = geometry_table[instance.geometry];
    const uint vertex = uint(gl_VertexIndex);
    texcoord = fetch_texcoord(geometry, material_table[instance.material].base_color_texture.texcoord, vertex);
    vertex_alpha = geometry.color_offset == no_attribute ? 1.0f : fetch_vec4(geometry.color_offset, vertex).a;
    instance_index = uint(gl_InstanceIndex);
    gl_Position = volume_position(instance_index, vertex);
}
