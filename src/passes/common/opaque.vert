#version 460
#extension GL_GOOGLE_include_directive : require
// Positions alone, pulled from the vertex table.
#include "passes/common/scene_tables.glsl"

layout(set = 0, binding = 8, std430) readonly buffer Views { ViewData views[]; };
layout(push_constant) uniform Push { uint view; uint random_seed; };
layout(location = 0) flat out uint instance_index;

void main() {
    const InstanceData instance = instance_table[gl_InstanceIndex];
    const GeometryData geometry = geometry_table[instance.geometry];
    const vec4 world = instance.object_to_world * vec4(fetch_vec3(geometry.position_offset, uint(gl_VertexIndex)), 1.0f);
    instance_index = uint(gl_InstanceIndex);
    gl_Position = views[view].world_to_clip * world;
}
