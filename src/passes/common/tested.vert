#version 460
#extension GL_GOOGLE_include_directive : require
// Positions, and what an alpha test needs, pulled from the vertex table.
#include "passes/common/scene_tables.glsl"

layout(set = 0, binding = 8, std430) readonly buffer Views { ViewData views[]; };
layout(push_constant) uniform Push { uint view; uint random_seed; };
layout(location = 0) out vec2 texcoord;
layout(location = 1) out float vertex_alpha;
layout(location = 2) flat out uint instance_index;
layout(location = 3) out vec3 position;

void main() {
    const InstanceData instance = instance_table[gl_InstanceIndex];
    const GeometryData geometry = geometry_table[instance.geometry];
    const uint vertex = uint(gl_VertexIndex);
    const vec4 world = instance.object_to_world * vec4(fetch_vec3(geometry.position_offset, vertex), 1.0f);
    texcoord = fetch_texcoord(geometry, material_table[instance.material].base_color_texture.texcoord, vertex);
    vertex_alpha = geometry.color_offset == no_attribute ? 1.0f : fetch_vec4(geometry.color_offset, vertex).a;
    instance_index = uint(gl_InstanceIndex);
    position = world.xyz;
    gl_Position = views[view].world_to_clip * world;
}
