// A material as voxels know it.
#ifndef HELIODON_VOXEL_SURFACE_GLSL
#define HELIODON_VOXEL_SURFACE_GLSL
#include "passes/common/surface.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
float shading_table(uint index) { return shading_tables[index]; }

/// At a point of the voxel. Differences first: they are exact, wherever the grid lies.
TriangleHit hit_at(VoxelTriangle triangle, uvec3 index, ivec3 voxel, vec3 within) {
    TriangleHit hit;
    hit.index = index;
    hit.p0 = triangle.p0;
    hit.edge1 = triangle.p1 - triangle.p0;
    hit.edge2 = triangle.p2 - triangle.p0;
    hit.normal = cross(hit.edge1, hit.edge2);
    hit.t = 0.0f;
    const vec3 from = (vec3(voxel) - triangle.p0) + within;
    const float inverse = 1.0f / dot(hit.normal, hit.normal);
    const float u = clamp(dot(cross(from, hit.edge2), hit.normal) * inverse, 0.0f, 1.0f);
    const float v = clamp(dot(cross(hit.edge1, from), hit.normal) * inverse, 0.0f, 1.0f - u);
    hit.barycentric = vec3(1.0f - u - v, u, v);
    return hit;
}

/// Textures are filtered over a voxel.
void set_voxel_gradients(GeometryData geometry, TextureRef use, TriangleHit hit) {
    texture_gradient_x = vec2(0.0f);
    texture_gradient_y = vec2(0.0f);
    vec3 dp_du;
    vec3 dp_dv;
    if (use.texture_index == no_texture ||
        !triangle_derivatives(hit.p0, hit.p0 + hit.edge1, hit.p0 + hit.edge2, fetch_texcoord(geometry, use.texcoord, hit.index.x),
                              fetch_texcoord(geometry, use.texcoord, hit.index.y),
                              fetch_texcoord(geometry, use.texcoord, hit.index.z), dp_du, dp_dv))
        return;
    const mat2 uv_matrix = mat2(use.uv_matrix.xy, use.uv_matrix.zw);
    texture_gradient_x = uv_matrix * vec2(1.0f / max(length(dp_du), 1.0e-20f), 0.0f);
    texture_gradient_y = uv_matrix * vec2(0.0f, 1.0f / max(length(dp_dv), 1.0e-20f));
}

/// Whether the material looks different from place to place.
bool varies(GeometryData geometry, MaterialData m) {
    const uint textures_used = m.base_color_texture.texture_index & m.orm_texture.texture_index & m.emission_texture.texture_index &
                               m.transmission_texture.texture_index & m.specular_texture.texture_index &
                               m.specular_color_texture.texture_index & m.clearcoat_texture.texture_index &
                               m.clearcoat_roughness_texture.texture_index & m.sheen_color_texture.texture_index;
    return textures_used != no_texture || geometry.color_offset != no_attribute;
}

VoxelSurface surface_of(GeometryData geometry, MaterialData material, MaterialPoint point) {
    // Voxels reflect diffusely what the surface reflects at the mean cosine of a diffuse field,
    // ∫cos² / ∫cos = 2/3.
    const vec3 wo = vec3(sqrt(5.0f) / 3.0f, 0.0f, 2.0f / 3.0f);
    const BsdfLobes lobes = bsdf_prepare(point.surface, wo);
    VoxelSurface result;
    result.opacity = point.opacity;
    const vec3 through = point.surface.model == material_model_standard ? bsdf_transmission_albedo_prepared(point.surface, lobes) : vec3(0.0f);
    result.cover = point.opacity * (1.0f - (through.x + through.y + through.z) * (1.0f / 3.0f));
    const vec3 specular = bsdf_specular_albedo_prepared(point.surface, lobes);
    const float coat = bsdf_coat_albedo_prepared(lobes);
    result.albedo = point.opacity * (bsdf_diffuse_albedo_prepared(point.surface, lobes) + specular + coat);
    const float base = dot(specular, vec3(1.0f / 3.0f));
    result.specular = point.opacity * (base + coat);
    result.alpha = base + coat > 0.0f ? (base * lobes.alpha + coat * lobes.coat_alpha) / (base + coat) : 0.0f;
    result.emission = push.grid.emission_unit > 0.0f ? point.opacity * point.emission / push.grid.emission_unit : vec3(0.0f);
    result.flags = (varies(geometry, material) ? voxel_surface_varies : 0u) |
                   ((material.flags & material_flag_two_sided) != 0u ? voxel_surface_two_sided : 0u) |
                   ((geometry.format & geometry_format_closed) != 0u ? voxel_surface_closed : 0u);
    return result;
}

/// What the material is everywhere, if it does not vary.
VoxelSurface even_surface(GeometryData geometry, MaterialData material) {
    return surface_of(geometry, material, material_combine(material, material_texels_default(), vec4(1.0f), false));
}

VoxelSurface surface_at(VoxelTriangle triangle, ivec3 voxel, vec3 within) {
    const InstanceData instance = instance_table[triangle.instance];
    const GeometryData geometry = geometry_table[instance.geometry];
    const MaterialData material = material_table[instance.material];
    const TriangleHit hit = hit_at(triangle, triangle_index(geometry, triangle.primitive), voxel, within);
    set_voxel_gradients(geometry, footprint_texture(material), hit);
    return surface_of(geometry, material, material_at(material, interpolate_texcoord(geometry, 0u, hit),
                                                      interpolate_texcoord(geometry, 1u, hit), vertex_color_at(geometry, hit), false));
}

#endif
