// The GPU copy of the scene: one descriptor set that every pass binds (GpuScene fills it).
#ifndef HELIODON_SCENE_TABLES_GLSL
#define HELIODON_SCENE_TABLES_GLSL

#include "shading/octahedral.h"
#include "shading/scene_data.h"
#include "passes/common/ambient_shared.h"
#include "passes/common/frame_shared.h"

layout(set = 0, binding = 0, std430) readonly buffer VertexTable { uint vertex_table[]; };
layout(set = 0, binding = 1, std430) readonly buffer IndexTable { uint index_table[]; };
layout(set = 0, binding = 2, std430) readonly buffer GeometryTable { GeometryData geometry_table[]; };
layout(set = 0, binding = 3, std430) readonly buffer InstanceTable { InstanceData instance_table[]; };
layout(set = 0, binding = 4, std430) readonly buffer MaterialTable { MaterialData material_table[]; };
layout(set = 0, binding = 5, std430) readonly buffer LightTable { LightData light_table[]; };
layout(set = 0, binding = 6, std430) readonly buffer ActiveLightTable { uint active_light_table[]; };
layout(set = 0, binding = 7, std430) readonly buffer SkyTable {
    SkyData sky_data;
    uint sky_image_slot;       // the image, or a picture of a formula; or no_texture
    uint sky_specular_slot;    // prefiltered for roughness 0 … 1 over sky_specular_levels mips, or no_texture
    uint sky_irradiance_slot;  // irradiance / π by normal, or no_texture
    uint sky_specular_levels;
    AmbientData ambient_data;
    AmbientLightData ambient_lights[];
};

// What the scene has of what whole branches are for (SceneFeatures, scene_inputs.h).
const uint any_kind = 0xffffffffu;
layout(constant_id = 11) const bool has_textures = true;  // or vertex colours
layout(constant_id = 12) const uint only_model = any_kind;
layout(constant_id = 13) const bool has_sky = true;
layout(constant_id = 14) const uint only_light = any_kind;
layout(constant_id = 15) const bool has_many_lights = true;
layout(constant_id = 16) const bool has_visible_lights = true;
layout(constant_id = 18) const bool has_ambient = false;  // surroundings reflect light though none is traced
// A pass of its own adds the sky and what surroundings reflect, and finds out what hides them (passes/ambient_occlusion).
layout(constant_id = 19) const bool sky_follows = false;

MaterialData material_of(InstanceData instance) {
    MaterialData material = material_table[instance.material];
    if (only_model != any_kind) material.model = only_model;
    return material;
}
/// Light `index` of those that shine.
LightData shining_light(uint index) {
    LightData light = light_table[active_light_table[index]];
    if (only_light != any_kind) {
        light.type = only_light;
        light.radius = 0.0f;
    }
    return light;
}

float fetch_float(uint offset) { return uintBitsToFloat(vertex_table[offset]); }
vec3 fetch_vec3(uint offset, uint vertex) {
    const uint first = offset + 3u * vertex;
    return vec3(fetch_float(first), fetch_float(first + 1u), fetch_float(first + 2u));
}
vec2 fetch_vec2(uint offset, uint vertex) {
    const uint first = offset + 2u * vertex;
    return vec2(fetch_float(first), fetch_float(first + 1u));
}
vec4 fetch_vec4(uint offset, uint vertex) {
    const uint first = offset + 4u * vertex;
    return vec4(fetch_float(first), fetch_float(first + 1u), fetch_float(first + 2u), fetch_float(first + 3u));
}

vec3 fetch_normal(GeometryData geometry, uint vertex) {
    if ((geometry.format & geometry_format_compact_vectors) == 0u) return fetch_vec3(geometry.normal_offset, vertex);
    const uint word = vertex_table[geometry.normal_offset + vertex];
    return word == compact_normal_zero ? vec3(0.0f) : octahedral_decode(unpackSnorm2x16(word));
}
/// w: the bitangent's sign.
vec4 fetch_tangent(GeometryData geometry, uint vertex) {
    if ((geometry.format & geometry_format_compact_vectors) == 0u) return fetch_vec4(geometry.tangent_offset, vertex);
    const uint word = vertex_table[geometry.tangent_offset + vertex];
    const float side = (word & compact_tangent_negative) != 0u ? -1.0f : 1.0f;
    if ((word | compact_tangent_negative) == (compact_tangent_zero | compact_tangent_negative)) return vec4(0.0f, 0.0f, 0.0f, side);
    const int x = int(word << 16) >> 16;
    const int y = int(word << 1) >> 17;
    return vec4(octahedral_decode(vec2(float(x) / 32767.0f, float(y) / 16383.0f)), side);
}
/// Coordinate set 0 or 1 of a vertex; (0, 0) where the mesh has none.
vec2 fetch_texcoord(GeometryData geometry, uint set_index, uint vertex) {
    const uint offset = set_index == 0u ? geometry.texcoord0_offset : geometry.texcoord1_offset;
    if (offset == no_attribute) return vec2(0.0f);
    if ((geometry.format & (geometry_format_compact_texcoord0 << set_index)) == 0u) return fetch_vec2(offset, vertex);
    const vec4 range = fetch_vec4(offset, 0u);  // lowest and step
    const uint word = vertex_table[offset + 4u + vertex];
    return range.xy + range.zw * vec2(float(word & 0xffffu), float(word >> 16));
}

#endif
