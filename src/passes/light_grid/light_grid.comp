#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a cell: running sums of what each light may give surfaces in the cell.
#include "core/units.h"
#include "passes/common/scene_tables.glsl"
#include "passes/light_grid/light_grid_shared.h"
#include "shading/light.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 24, std430) buffer LightGrid { LightGridHeader header; uint sums[]; };

// All sums stay below 2²⁴, which floats count exactly.
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

/// The light's illuminance in a cell of this centre and half-diagonal, of a luminaire by its peak; 0 only where it sends
/// nothing into the cell. Nearer than the half-diagonal it grows no more.
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
    const uint index = gl_GlobalInvocationID.x;
    const uint cells = header.edge * header.edge * header.edge;
    if (index >= cells) return;
    const uvec3 cell = uvec3(index, index / header.edge, index / (header.edge * header.edge)) % header.edge;
    const vec3 center = header.origin + (vec3(cell) + 0.5f) * header.cell_m;
    const float radius = 0.5f * length(header.cell_m);
    float total = 0.0f;
    for (uint i = 0u; i < header.light_count; ++i) {
        const float weight = weight_of(light_table[active_light_table[header.light_first + i]], center, radius);
        sums[i * cells + index] = floatBitsToUint(weight);
        total += weight;
    }
    // What may give light at all can be picked: it weighs 1 at least.
    uint sum = 0u;
    for (uint i = 0u; i < header.light_count; ++i) {
        const float weight = uintBitsToFloat(sums[i * cells + index]);
        if (weight > 0.0f) sum += 1u + uint(weight / total * whole);
        sums[i * cells + index] = sum;
    }
}
