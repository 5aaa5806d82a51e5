#version 460
#extension GL_GOOGLE_include_directive : require
// How each triangle stands to the sun.
#include "passes/shadow_volumes/casters.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 13, std430) writeonly buffer States { uint states[]; };
layout(push_constant) uniform Push { ClassifyConstants push; };

void main() {
    const uint triangle = linear_invocation();
    if (triangle >= push.triangle_count) return;
    const CasterRange range = caster_ranges[caster_of_triangle(triangle, push.range_count)];
    const vec3 corners[3] = caster_corners(range, triangle);
    precise vec3 e1 = corners[1] - corners[0];
    precise vec3 e2 = corners[2] - corners[0];
    // Without fused operations, so that corners in one place give nothing.
    precise vec3 normal = e1.yzx * e2.zxy - e1.zxy * e2.yzx;
    const float facing = -dot(normal, push.sun);
    uint state = facing > 0.0f ? caster_toward : (facing < 0.0f ? caster_away : 0u);
    if (0.5f * abs(facing) > push.significant_m2) state |= caster_significant;
    const InstanceData instance = instance_table[range.instance];
    const bool closed = (geometry_table[instance.geometry].format & geometry_format_closed) != 0u;
    if (closed && facing * instance.determinant_sign < 0.0f) state |= caster_rear;
    states[triangle] = state;
}
