// From a visible triangle and a pixel's ray to a point ready for shading: what a path tracer's hit would
// give, so that both engines shade the same positions.
#ifndef HELIODON_SURFACE_GLSL
#define HELIODON_SURFACE_GLSL
#include "passes/common/scene_tables.glsl"
#include "passes/common/textures.glsl"
#include "shading/material_eval.h"

// Footprint of the picture's sample on the coordinates of the material's textures.
vec2 texture_gradient_x = vec2(0.0f);
vec2 texture_gradient_y = vec2(0.0f);

vec4 scene_texture(uint texture_index, vec2 uv) {
    return textureGrad(textures[nonuniformEXT(texture_index)], uv, texture_gradient_x, texture_gradient_y);
}
vec2 scene_texture_size(uint texture_index) { return vec2(textureSize(textures[nonuniformEXT(texture_index)], 0)); }
#include "shading/material_fetch.h"

struct SurfacePoint {
    vec3 position;
    vec3 geometric;  // unit, facing the viewer
    vec3 wo;         // unit, to the viewer
    Frame frame;     // shading frame, facing the viewer
    MaterialPoint material;
    bool dark;       // the back of a one-sided surface: black, emits nothing
};

struct TriangleHit {
    uvec3 index;
    vec3 p0;
    vec3 edge1;
    vec3 edge2;
    vec3 barycentric;
    float t;
    vec3 normal;  // edge1 × edge2, not normalized
};

/// Möller & Trumbore 1997. The pixel's ray can pass the triangle by what rasterization rounds: then the
/// nearest point of it by barycentric coordinates is meant.
TriangleHit intersect(InstanceData instance, GeometryData geometry, uint primitive, vec3 origin, vec3 direction) {
    TriangleHit hit;
    const uint first = geometry.first_index + 3u * primitive;
    hit.index = uvec3(index_table[first], index_table[first + 1u], index_table[first + 2u]);
    hit.p0 = vec3(instance.object_to_world * vec4(fetch_vec3(geometry.position_offset, hit.index.x), 1.0f));
    hit.edge1 = vec3(instance.object_to_world * vec4(fetch_vec3(geometry.position_offset, hit.index.y), 1.0f)) - hit.p0;
    hit.edge2 = vec3(instance.object_to_world * vec4(fetch_vec3(geometry.position_offset, hit.index.z), 1.0f)) - hit.p0;
    hit.normal = cross(hit.edge1, hit.edge2);
    const vec3 p = cross(direction, hit.edge2);
    const float determinant = dot(hit.edge1, p);
    const vec3 from = origin - hit.p0;
    const vec3 q = cross(from, hit.edge1);
    const float inverse = determinant != 0.0f ? 1.0f / determinant : 0.0f;
    float u = clamp(dot(from, p) * inverse, 0.0f, 1.0f);
    float v = clamp(dot(direction, q) * inverse, 0.0f, 1.0f);
    const float sum = max(u + v, 1.0f);
    u /= sum;
    v /= sum;
    hit.barycentric = vec3(1.0f - u - v, u, v);
    hit.t = dot(hit.edge2, q) * inverse;
    return hit;
}

vec2 interpolate_texcoord(GeometryData geometry, uint set_index, TriangleHit hit) {
    return fetch_texcoord(geometry, set_index, hit.index.x) * hit.barycentric.x +
           fetch_texcoord(geometry, set_index, hit.index.y) * hit.barycentric.y +
           fetch_texcoord(geometry, set_index, hit.index.z) * hit.barycentric.z;
}

/// The first texture that a material uses decides the footprint of all of them.
TextureRef footprint_texture(MaterialData m) {
    if (m.base_color_texture.texture_index != no_texture) return m.base_color_texture;
    if (m.normal_texture.texture_index != no_texture) return m.normal_texture;
    if (m.orm_texture.texture_index != no_texture) return m.orm_texture;
    if (m.emission_texture.texture_index != no_texture) return m.emission_texture;
    return m.bump_texture;
}

/// Ray differentials (Igehy 1999, eq. 10 to 14): what one pixel step moves the hit point on its plane.
void set_texture_gradients(MaterialData m, GeometryData geometry, TriangleHit hit, vec3 direction, vec3 ray_dx,
                           vec3 ray_dy, float scale) {
    const TextureRef use = footprint_texture(m);
    const vec2 uv0 = fetch_texcoord(geometry, use.texcoord, hit.index.x);
    const vec2 uv1 = fetch_texcoord(geometry, use.texcoord, hit.index.y) - uv0;
    const vec2 uv2 = fetch_texcoord(geometry, use.texcoord, hit.index.z) - uv0;
    const float facing = dot(hit.normal, direction);
    const float area2 = dot(hit.normal, hit.normal);
    if (facing == 0.0f || area2 == 0.0f) return;
    const mat2 uv_matrix = mat2(use.uv_matrix.xy, use.uv_matrix.zw);
    const vec3 dx = hit.t * (ray_dx - direction * (dot(hit.normal, ray_dx) / facing));
    const vec3 dy = hit.t * (ray_dy - direction * (dot(hit.normal, ray_dy) / facing));
    texture_gradient_x = uv_matrix * (uv1 * dot(cross(dx, hit.edge2), hit.normal) + uv2 * dot(cross(hit.edge1, dx), hit.normal)) * (scale / area2);
    texture_gradient_y = uv_matrix * (uv1 * dot(cross(dy, hit.edge2), hit.normal) + uv2 * dot(cross(hit.edge1, dy), hit.normal)) * (scale / area2);
}

vec3 interpolated_normal(InstanceData instance, GeometryData geometry, TriangleHit hit, vec3 geometric) {
    if (geometry.normal_offset == no_attribute) return geometric;
    const vec3 n = fetch_normal(geometry, hit.index.x) * hit.barycentric.x +
                   fetch_normal(geometry, hit.index.y) * hit.barycentric.y +
                   fetch_normal(geometry, hit.index.z) * hit.barycentric.z;
    const vec3 world = mat3(instance.normal_to_world) * n;
    const float squared = dot(world, world);
    return squared > 0.0f ? world * inversesqrt(squared) : geometric;
}

/// World, w = handedness; 0 where the mesh has none.
vec4 interpolated_tangent(InstanceData instance, GeometryData geometry, TriangleHit hit) {
    if (geometry.tangent_offset == no_attribute) return vec4(0.0f);
    const vec4 t0 = fetch_tangent(geometry, hit.index.x);
    const vec3 t = t0.xyz * hit.barycentric.x + fetch_tangent(geometry, hit.index.y).xyz * hit.barycentric.y +
                   fetch_tangent(geometry, hit.index.z).xyz * hit.barycentric.z;
    return vec4(mat3(instance.object_to_world) * t, t0.w * instance.determinant_sign);
}

bool texture_derivatives(GeometryData geometry, uint set_index, TriangleHit hit, out vec3 dp_du, out vec3 dp_dv) {
    return triangle_derivatives(hit.p0, hit.p0 + hit.edge1, hit.p0 + hit.edge2, fetch_texcoord(geometry, set_index, hit.index.x),
                                fetch_texcoord(geometry, set_index, hit.index.y), fetch_texcoord(geometry, set_index, hit.index.z),
                                dp_du, dp_dv);
}

vec3 mapped_normal(InstanceData instance, GeometryData geometry, MaterialData m, TriangleHit hit, vec2 uv0, vec2 uv1, vec3 n) {
    if (!has_textures || m.normal_texture.texture_index == no_texture && m.bump_texture.texture_index == no_texture) return n;
    const vec4 tangent = interpolated_tangent(instance, geometry, hit);
    vec3 dp_du = vec3(0.0f);
    vec3 dp_dv = vec3(0.0f);
    if (m.bump_texture.texture_index != no_texture) texture_derivatives(geometry, m.bump_texture.texcoord, hit, dp_du, dp_dv);
    return material_normal_at(m, uv0, uv1, n, tangent, dp_du, dp_dv);
}

/// The world tangent of a surface that is not alike in all directions: the mesh's, or along the first coordinate set's u.
void orient_surface(InstanceData instance, GeometryData geometry, TriangleHit hit, vec3 normal, inout Surface surface) {
    if (!is_extended(surface) || surface.anisotropy <= 0.0f) return;
    vec4 tangent = interpolated_tangent(instance, geometry, hit);
    if (tangent.xyz == vec3(0.0f)) {
        vec3 dp_du;
        vec3 dp_dv;
        texture_derivatives(geometry, 0u, hit, dp_du, dp_dv);
        tangent = vec4(dp_du, dot(cross(normal, dp_du), dp_dv) > 0.0f ? -1.0f : 1.0f);  // v runs down: the bitangent up
    }
    orient_tangent(normal, tangent, surface);
}

vec4 vertex_color_at(GeometryData geometry, TriangleHit hit) {
    if (geometry.color_offset == no_attribute) return vec4(1.0f);
    return fetch_vec4(geometry.color_offset, hit.index.x) * hit.barycentric.x +
           fetch_vec4(geometry.color_offset, hit.index.y) * hit.barycentric.y +
           fetch_vec4(geometry.color_offset, hit.index.z) * hit.barycentric.z;
}

vec3 hit_position(TriangleHit hit) { return hit.p0 + hit.edge1 * hit.barycentric.y + hit.edge2 * hit.barycentric.z; }
vec3 outward_normal(InstanceData instance, TriangleHit hit) {
    return hit.normal * (instance.determinant_sign * inversesqrt(max(dot(hit.normal, hit.normal), 1.0e-38f)));
}

/// `direction`: the pixel's ray, as long as FrameData has it.
SurfacePoint resolve_surface(uint instance_index, uint primitive, FrameData frame, vec3 direction) {
    const InstanceData instance = instance_table[instance_index];
    const GeometryData geometry = geometry_table[instance.geometry];
    const MaterialData material = material_of(instance);
    const TriangleHit hit = intersect(instance, geometry, primitive, frame.position, direction);
    if (has_textures) set_texture_gradients(material, geometry, hit, direction, frame.ray_dx, frame.ray_dy, frame.texture_gradient_scale);

    SurfacePoint point;
    point.position = hit_position(hit);
    point.wo = -normalize(direction);
    const vec3 outward = outward_normal(instance, hit);
    const bool back = dot(outward, point.wo) < 0.0f;
    point.geometric = back ? -outward : outward;

    const vec2 uv0 = interpolate_texcoord(geometry, 0u, hit);
    const vec2 uv1 = interpolate_texcoord(geometry, 1u, hit);
    const bool inside = back && (material.flags & material_flag_two_sided) == 0u;
    if (has_textures) point.material = material_at(material, uv0, uv1, vertex_color_at(geometry, hit), inside);
    else point.material = material_combine(material, material_texels_default(), vec4(1.0f), inside);
    const vec3 smooth_normal = interpolated_normal(instance, geometry, hit, outward);
    const vec3 normal = mapped_normal(instance, geometry, material, hit, uv0, uv1, smooth_normal);
    orient_surface(instance, geometry, hit, smooth_normal, point.material.surface);
    point.frame = surface_frame(point.material.surface, usable_shading_normal(back ? -normal : normal, point.geometric, point.wo));
    point.dark = inside && !point.material.surface.inside;
    if (inside) point.material.emission = vec3(0.0f);
    return point;
}

#endif
