// The GPU copy of the scene: one descriptor set that every pass binds (GpuScene fills it).
#ifndef HELIODON_SCENE_TABLES_GLSL
#define HELIODON_SCENE_TABLES_GLSL

#include "shading/scene_data.h"
#include "passes/common/frame_shared.h"

layout(set = 0, binding = 0, std430) readonly buffer VertexTable { float vertex_table[]; };
layout(set = 0, binding = 1, std430) readonly buffer IndexTable { uint index_table[]; };
layout(set = 0, binding = 2, std430) readonly buffer GeometryTable { GeometryData geometry_table[]; };
layout(set = 0, binding = 3, std430) readonly buffer InstanceTable { InstanceData instance_table[]; };
layout(set = 0, binding = 4, std430) readonly buffer MaterialTable { MaterialData material_table[]; };
layout(set = 0, binding = 5, std430) readonly buffer LightTable { LightData light_table[]; };
layout(set = 0, binding = 6, std430) readonly buffer ActiveLightTable { uint active_light_table[]; };
layout(set = 0, binding = 7, std430) readonly buffer SkyTable {
    SkyData sky_data;
    uint sky_image_slot;
    uint sky_specular_slot;    // prefiltered for roughness 0 … 1 over sky_specular_levels mips, or no_texture
    uint sky_irradiance_slot;  // irradiance / π by normal, or no_texture
    uint sky_specular_levels;
};

vec3 fetch_vec3(uint offset, uint vertex) {
    const uint first = offset + 3u * vertex;
    return vec3(vertex_table[first], vertex_table[first + 1u], vertex_table[first + 2u]);
}
vec2 fetch_vec2(uint offset, uint vertex) {
    const uint first = offset + 2u * vertex;
    return vec2(vertex_table[first], vertex_table[first + 1u]);
}
vec4 fetch_vec4(uint offset, uint vertex) {
    const uint first = offset + 4u * vertex;
    return vec4(vertex_table[first], vertex_table[first + 1u], vertex_table[first + 2u], vertex_table[first + 3u]);
}
/// Coordinate set 0 or 1 of a vertex; (0, 0) where the mesh has none.
vec2 fetch_texcoord(GeometryData geometry, uint set_index, uint vertex) {
    const uint offset = set_index == 0u ? geometry.texcoord0_offset : geometry.texcoord1_offset;
    return offset == no_attribute ? vec2(0.0f) : fetch_vec2(offset, vertex);
}

#endif
