#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup a cell: running sums of what each light may give surfaces in the cell.
#include "core/units.h"
#include "passes/common/scene_tables.glsl"
#include "passes/light_grid/light_grid_shared.h"
#include "shading/light.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 22, std430) buffer LightGrid { LightGridHeader header; uint sums[]; };
shared float part_weights[gl_WorkGroupSize.x];
shared uint part_sums[gl_WorkGroupSize.x];

// All sums stay below 2²⁴, which floats count exactly; integers add up alike in any order.
const float whole = 8388608.0f;

/// The cosine of the smallest angle between `axis` and directions from the light into a sphere at `offset` from it.
float nearest_cos(vec3 axis, vec3 offset, float distance, float radius) {
    if (distance <= radius) return 1.0f;
    const float cos_center = dot(axis, offset) / distance;
    const float sin_half = radius / distance;
    const float cos_half = sqrt(1.0f - sin_half * sin_half);
    if (cos_center >= cos_half) return 1.0f;
    return cos_center * cos_half + sqrt(max(0.0f, 1.0f - cos_center * cos_center)) * sin_half;
}

/// The light's illuminance in a cell of this centre and half-diagonal; 0 only where it sends nothing into the cell. Nearer
/// than the half-diagonal it grows no more.
float weight_of(LightData light, vec3 center, float radius) {
    if (light.type == light_type_none) return 0.0f;
    const float strength = luminance(light.intensity);
    if (light.type == light_type_directional) return strength;
    const float reach = radius + light.radius;
    const vec3 offset = center - light.position;
    const float distance = length(offset);
    float falloff = 1.0f;
    // The chord of rounding errors keeps the edge of a cone inside.
    const float cos_theta = min(nearest_cos(light.axis, offset, distance, reach) + 1.0e-5f, 1.0f);
    if (light.type == light_type_spot) falloff = spot_falloff(cos_theta, light.cos_inner, light.cos_outer);
    if (light.type == light_type_lambertian) falloff = max(cos_theta, 0.0f);
    return strength * falloff / max(distance * distance, reach * reach);
}

void main() {
    const uvec3 cell = gl_WorkGroupID;
    const uint base = (cell.x + header.edge * (cell.y + header.edge * cell.z)) * header.light_count;
    const vec3 center = header.origin + (vec3(cell) + 0.5f) * header.cell_m;
    const float radius = 0.5f * length(header.cell_m);
    const uint thread = gl_LocalInvocationIndex;
    const uint share = (header.light_count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(thread * share, header.light_count);
    const uint end = min(begin + share, header.light_count);

    float weight = 0.0f;
    for (uint i = begin; i < end; ++i) {
        const float own = weight_of(light_table[active_light_table[header.light_first + i]], center, radius);
        sums[base + i] = floatBitsToUint(own);
        weight += own;
    }
    part_weights[thread] = weight;
    barrier();
    float total = 0.0f;
    for (uint i = 0u; i < gl_WorkGroupSize.x; ++i) total += part_weights[i];

    // What may give light at all can be picked: it weighs 1 at least.
    uint sum = 0u;
    for (uint i = begin; i < end; ++i) {
        const float own = uintBitsToFloat(sums[base + i]);
        const uint units = own > 0.0f ? 1u + uint(own / total * whole) : 0u;
        sums[base + i] = units;
        sum += units;
    }
    part_sums[thread] = sum;
    barrier();
    uint running = 0u;
    for (uint i = 0u; i < thread; ++i) running += part_sums[i];
    for (uint i = begin; i < end; ++i) {
        running += sums[base + i];
        sums[base + i] = running;
    }
}
