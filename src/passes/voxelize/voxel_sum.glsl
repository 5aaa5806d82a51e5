// Adds what a voxel holds of a triangle to the voxel's record.
#ifndef HELIODON_VOXEL_SUM_GLSL
#define HELIODON_VOXEL_SUM_GLSL
#include "passes/common/hash.glsl"
#include "passes/common/surface.glsl"
#include "passes/voxelize/clip.glsl"
#include "passes/voxelize/voxel_triangle.glsl"

layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
layout(set = 0, binding = 16, std430) readonly buffer Numbers { VoxelHeader header; uint voxel_number[]; };
layout(set = 0, binding = 18, std430) buffer Records { uint records[]; };
float shading_table(uint index) { return shading_tables[index]; }

/// A material as voxels know it. Shares are of the surface's area.
struct VoxelSurface {
    float cover;    // that stops light
    vec3 albedo;    // share of arriving light that is reflected
    vec3 emission;  // in units of the grid's
    float opacity;  // there at all
};

/// At a point of the voxel. Differences first: they are exact, wherever the grid lies.
TriangleHit hit_at(VoxelTriangle triangle, ivec3 voxel, vec3 within) {
    TriangleHit hit;
    hit.index = triangle.index;
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

VoxelSurface surface_at(VoxelTriangle triangle, GeometryData geometry, MaterialData material, ivec3 voxel, vec3 within) {
    const TriangleHit hit = hit_at(triangle, voxel, within);
    set_voxel_gradients(geometry, footprint_texture(material), hit);
    const MaterialPoint point = material_at(material, interpolate_texcoord(geometry, 0u, hit), interpolate_texcoord(geometry, 1u, hit),
                                            vertex_color_at(geometry, hit), false);
    // Voxels reflect diffusely what the surface reflects at the mean cosine of a diffuse field,
    // ∫cos² / ∫cos = 2/3.
    const vec3 wo = vec3(sqrt(5.0f) / 3.0f, 0.0f, 2.0f / 3.0f);
    const BsdfLobes lobes = bsdf_prepare(point.surface, wo);
    VoxelSurface result;
    result.opacity = point.opacity;
    const vec3 through = point.surface.model == material_model_standard ? bsdf_transmission_albedo_prepared(point.surface, lobes) : vec3(0.0f);
    result.cover = point.opacity * (1.0f - (through.x + through.y + through.z) * (1.0f / 3.0f));
    result.albedo = point.opacity * (bsdf_diffuse_albedo_prepared(point.surface, lobes) +
                                     bsdf_specular_albedo_prepared(point.surface, lobes) + bsdf_coat_albedo_prepared(lobes));
    result.emission = push.grid.emission_unit > 0.0f ? point.opacity * point.emission / push.grid.emission_unit : vec3(0.0f);
    return result;
}

void add(uint place, float value, float rounding) {
    const int amount = int(floor(clamp(value, -2047.0f, 2047.0f) * voxel_fixed_one + rounding));
    if (amount != 0) atomicAdd(records[place], uint(amount));
}

/// One side's share of the record's face; a black one has no colour.
void add_to_face(uint first, VoxelSurface surface, bool black, vec3 normal, vec3 position, float area, float rounding) {
    const float shown = area * surface.cover;
    add(first + voxel_field_area, shown, rounding);
    for (uint c = 0u; c < 3u; ++c) {
        add(first + voxel_field_normal + c, shown * normal[c], rounding);
        add(first + voxel_field_position + c, shown * clamp(position[c], 0.0f, 1.0f), rounding);
        if (!black && surface.albedo[c] > 0.0f) add(first + voxel_field_albedo + c, area * surface.albedo[c], rounding);
        if (!black && surface.emission[c] > 0.0f) add(first + voxel_field_emission + c, area * surface.emission[c], rounding);
    }
    if (!black && any(greaterThan(surface.emission, vec3(0.0f))))
        add(first + voxel_field_emissive_area, area * surface.opacity, rounding);
}

void sum(VoxelTriangle triangle, ivec3 voxel) {
    const uint size = push.grid.size;
    const uint place = uint(voxel.x) + size * (uint(voxel.y) + size * uint(voxel.z));
    const uint number = voxel_number[place];
    if (number == 0u || number == voxel_without_room) return;
    const vec4 part = centroid_and_area(triangle.p0, triangle.p1, triangle.p2, vec3(voxel));
    if (!(part.w > 0.0f)) return;
    const InstanceData instance = instance_table[triangle.instance];
    const GeometryData geometry = geometry_table[instance.geometry];
    const MaterialData material = material_table[instance.material];
    const VoxelSurface surface = surface_at(triangle, geometry, material, voxel, part.xyz);
    if (!(surface.opacity > 0.0f)) return;
    const bool two_sided = (material.flags & material_flag_two_sided) != 0u;
    const bool closed = (geometry.format & geometry_format_closed) != 0u;
    // Up or down at random, by what is rounded alone: pieces smaller than the fixed point's step count on average,
    // and every run gives the same sums.
    const uvec3 in_lattice = uvec3(voxel + push.grid.base);
    const uint of_triangle = pcg_hash(triangle.primitive + pcg_hash(triangle.instance));
    const float rounding = unit_interval(pcg_hash(in_lattice.x + pcg_hash(in_lattice.y + pcg_hash(in_lattice.z + of_triangle))));
    // The faces that see a side of it, a bit each: a loop over them alone keeps neighbouring invocations together.
    uint faces = 0u;
    for (uint axis = 0u; axis < 3u; ++axis) {
        const float along = triangle.normal[axis];
        if (along != 0.0f) faces |= (along > 0.0f ? 1u : 2u) << (2u * axis);
        if (along != 0.0f && (two_sided || !closed)) faces |= 3u << (2u * axis);
    }
    while (faces != 0u) {
        const uint face = uint(findLSB(faces));
        faces &= faces - 1u;
        const float along = triangle.normal[face >> 1u];
        const bool rear = (along > 0.0f) == ((face & 1u) != 0u);
        add_to_face(((number - 1u) * voxel_faces + face) * voxel_field_count, surface, rear && !two_sided,
                    rear ? -triangle.normal : triangle.normal, part.xyz, part.w * abs(along), rounding);
    }
}

#endif
