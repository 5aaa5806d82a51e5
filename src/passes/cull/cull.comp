#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation an instance and view: what the view's frustum touches becomes an indirect draw.
#include "passes/common/scene_tables.glsl"
#include "passes/cull/cull_shared.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 8, std430) readonly buffer Views { ViewData views[]; };
layout(set = 0, binding = 9, std430) writeonly buffer Commands { DrawCommand commands[]; };
layout(set = 0, binding = 10, std430) buffer Counts { uint counts[]; };
layout(push_constant) uniform Push { CullConstants push; };

/// The box's corners lie wholly outside one clip plane: Gribb & Hartmann 2001 with the box's projected
/// half-extent on the plane (Akenine-Möller et al., Real-Time Rendering 4th ed., 22.10.1).
bool outside(vec4 plane, vec3 center, mat3 half_axes) {
    const float extent = abs(dot(plane.xyz, half_axes[0])) + abs(dot(plane.xyz, half_axes[1])) +
                         abs(dot(plane.xyz, half_axes[2]));
    return dot(plane.xyz, center) + plane.w < -extent;
}

bool visible(mat4 world_to_clip, vec3 center, mat3 half_axes) {
    const mat4 rows = transpose(world_to_clip);
    if (outside(rows[3] + rows[0], center, half_axes) || outside(rows[3] - rows[0], center, half_axes)) return false;
    if (outside(rows[3] + rows[1], center, half_axes) || outside(rows[3] - rows[1], center, half_axes)) return false;
    // Reversed depth: the near plane is z = w, the far plane z = 0 (never crossed when it is at infinity).
    return !outside(rows[3] - rows[2], center, half_axes) && !outside(rows[2], center, half_axes);
}

uint draw_list_of(uint material_flags) {
    if ((material_flags & material_flag_alpha_blend) != 0u)
        return push.merge_blended != 0u ? draw_list_tested : draw_list_blended;
    return (material_flags & material_flag_alpha_mask) != 0u ? draw_list_tested : draw_list_opaque;
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    const uint view = gl_GlobalInvocationID.y;
    if (index >= push.instance_count) return;
    if ((instance_table[index].flags & instance_flag_visible) == 0u) return;
    const GeometryData geometry = geometry_table[instance_table[index].geometry];
    if (geometry.index_count == 0u) return;

    const mat4 object_to_world = instance_table[index].object_to_world;
    const vec3 center = vec3(object_to_world * vec4(0.5f * (geometry.bounds_min + geometry.bounds_max), 1.0f));
    const vec3 half_extent = 0.5f * (geometry.bounds_max - geometry.bounds_min);
    const mat3 half_axes = mat3(object_to_world[0].xyz * half_extent.x, object_to_world[1].xyz * half_extent.y,
                                object_to_world[2].xyz * half_extent.z);
    if (!visible(views[view].world_to_clip, center, half_axes)) return;

    const uint list = view * draw_lists_per_view + draw_list_of(material_table[instance_table[index].material].flags);
    const uint slot = atomicAdd(counts[list], 1u);
    const uint at = list * push.list_capacity + slot;
    commands[at].index_count = geometry.index_count;
    commands[at].instance_count = 1u;
    commands[at].first_index = geometry.first_index;
    commands[at].vertex_offset = 0;
    commands[at].first_instance = index;
}
