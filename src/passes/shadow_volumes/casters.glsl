// The instances that cast shadows, and their triangles.
#ifndef HELIODON_CASTERS_GLSL
#define HELIODON_CASTERS_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/shadow_volumes/shadow_volumes_shared.h"

layout(set = 0, binding = 12, std430) readonly buffer CasterRanges { CasterRange caster_ranges[]; };

/// The instance that triangle or edge `number` belongs to.
uint caster_of(uint number, uint range_count, bool edges) {
    uint low = 0u;
    uint high = range_count;
    while (high - low > 1u) {
        const uint middle = (low + high) / 2u;
        const CasterRange range = caster_ranges[middle];
        if ((edges ? range.first_edge : range.first_triangle) <= number) low = middle;
        else high = middle;
    }
    return low;
}

uint caster_of_triangle(uint triangle, uint range_count) { return caster_of(triangle, range_count, false); }
uint caster_of_edge(uint edge, uint range_count) { return caster_of(edge, range_count, true); }

uint caster_first_index(CasterRange range, uint triangle) {
    return geometry_table[instance_table[range.instance].geometry].first_index + 3u * (triangle - range.first_triangle);
}

vec3[3] caster_corners(CasterRange range, uint triangle) {
    const InstanceData instance = instance_table[range.instance];
    const uint positions = geometry_table[instance.geometry].position_offset;
    const uint first = caster_first_index(range, triangle);
    vec3 corners[3];
    for (uint i = 0u; i < 3u; ++i)
        corners[i] = vec3(instance.object_to_world * vec4(fetch_vec3(positions, index_table[first + i]), 1.0f));
    return corners;
}

/// Whether a volume stands behind the triangle; `choice`: not behind_fewest.
bool casts_volume(uint state, uint choice) {
    if ((state & (caster_toward | caster_away)) == 0u) return false;
    if (choice == behind_all) return (state & caster_rear) == 0u;
    return (state & (choice == behind_joined ? caster_lit | caster_joined : caster_lit)) != 0u;
}

/// Joined triangles, chosen all at once, may also leave more sides than the lit ones have. Of equals, fewer triangles.
uint fewest_sides(CasterTally tally) {
    if (tally.lit <= min(tally.joined, tally.all)) return behind_lit;
    return tally.joined <= tally.all ? behind_joined : behind_all;
}

#endif
