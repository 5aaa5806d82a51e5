#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the triangles that close volumes towards the sun: those turned to it, then those turned away.
#include "passes/shadow_volumes/casters.glsl"
#include "passes/voxelize/linear_groups.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 13, std430) readonly buffer States { uint states[]; };
layout(set = 0, binding = 14, std430) buffer Draws { VolumeDraw draws[]; };
layout(set = 0, binding = 15, std430) writeonly buffer Caps { uvec2 caps[]; };  // instance, first index
layout(set = 0, binding = 16, std430) readonly buffer Tallies { CasterTally tallies[]; };
layout(push_constant) uniform Push { SilhouetteConstants push; };

void main() {
    const uint triangle = linear_invocation();
    if (triangle >= push.count) return;
    const uint state = states[triangle];
    const uint caster = caster_of_triangle(triangle, push.range_count);
    if (!casts_volume(state, push.choice == behind_fewest ? fewest_sides(tallies[caster]) : push.choice)) return;
    const CasterRange range = caster_ranges[caster];
    const uint draw = (state & caster_toward) != 0u ? volume_draw_toward : volume_draw_away;
    const uint place = atomicAdd(draws[draw].vertex_count, 3u) / 3u;
    if (place >= push.capacity) return;
    const uint first = (draw - volume_draw_toward) * push.capacity;
    caps[first + place] = uvec2(range.instance, caster_first_index(range, triangle));
}
