// Part of path_kernel.h (see there how it is included): from a hit to the point of the surface.
#ifndef HELIODON_SHADING_KERNEL_SURFACE_H
#define HELIODON_SHADING_KERNEL_SURFACE_H

/// Bound on the rounding error of coordinates that are sums of `terms` in absolute value (Pharr, Jakob &
/// Humphreys 2016, section 3.9.4). The first factor covers interpolation and transformation here (about 10
/// roundings of 2⁻²⁴) and the same again where the ray is taken back into object space; the second keeps a
/// surface through a coordinate plane, whose own terms vanish, from being met again at distance 0.
SHADING_FN vec3 kernel_error_bound(vec3 terms) { return terms * 1.2e-6f + vec3(max_component(terms) * 2.4e-7f); }

/// Of a weighted sum of object-space points, each within ±`extent`, transformed to the world.
SHADING_FN vec3 kernel_position_error(mat4 object_to_world, vec3 extent) {
    return kernel_error_bound(abs(vec3(object_to_world[0])) * extent.x + abs(vec3(object_to_world[1])) * extent.y +
                              abs(vec3(object_to_world[2])) * extent.z + abs(vec3(object_to_world[3])));
}

/// `position` moved off the surface to the side that `direction` points to, farther than its error reaches.
SHADING_FN vec3 kernel_offset(vec3 position, vec3 error, vec3 normal, vec3 direction) {
    const float distance = dot(abs(normal), error);
    return position + normal * (dot(normal, direction) < 0.0f ? -distance : distance);
}

SHADING_FN vec3 kernel_transform_normal(mat4 normal_to_world, vec3 n) {
    return normalize(vec3(normal_to_world[0]) * n.x + vec3(normal_to_world[1]) * n.y + vec3(normal_to_world[2]) * n.z);
}
SHADING_FN vec3 kernel_transform_vector(mat4 m, vec3 v) { return vec3(m[0]) * v.x + vec3(m[1]) * v.y + vec3(m[2]) * v.z; }
SHADING_FN vec3 kernel_transform_point(mat4 m, vec3 v) { return kernel_transform_vector(m, v) + vec3(m[3]); }

SHADING_FN void kernel_triangle_point(SHADING_IN(KernelHit) hit, SHADING_IN(InstanceData) instance, SHADING_IN(KernelGeometry) geometry,
                                      SHADING_INOUT(KernelPoint) point) {
    const bool in_place = (instance.flags & instance_flag_in_place) != 0u;
    const uvec3 index = fetch_triangle(instance.geometry, hit.primitive);
    const vec3 p0 = fetch_position(instance.geometry, index.x);
    const vec3 p1 = fetch_position(instance.geometry, index.y);
    const vec3 p2 = fetch_position(instance.geometry, index.z);
    const float b1 = hit.barycentric.x;
    const float b2 = hit.barycentric.y;
    const float b0 = 1.0f - b1 - b2;
    const vec3 extent = max(abs(p0), max(abs(p1), abs(p2)));
    vec3 edge1 = p1 - p0;
    vec3 edge2 = p2 - p0;
    point.position = p0 * b0 + p1 * b1 + p2 * b2;
    if (in_place) {
        point.error = kernel_error_bound(extent);
    } else {
        point.position = kernel_transform_point(instance.object_to_world, point.position);
        point.error = kernel_position_error(instance.object_to_world, extent);
        edge1 = kernel_transform_vector(instance.object_to_world, edge1);
        edge2 = kernel_transform_vector(instance.object_to_world, edge2) * instance.determinant_sign;
    }
    point.geometric_normal = normalize(cross(edge1, edge2));
    point.normal = point.geometric_normal;
    if ((geometry.attributes & kernel_has_normals) != 0u) {
        const vec3 n = fetch_normal(instance.geometry, index.x) * b0 + fetch_normal(instance.geometry, index.y) * b1 +
                       fetch_normal(instance.geometry, index.z) * b2;
        const vec3 world = in_place ? n : kernel_transform_vector(instance.normal_to_world, n);
        const float squared = dot(world, world);
        if (squared > 0.0f) {
            point.normal = world * inversesqrt(squared);
        }
    }
    point.tangent = vec4(0.0f);
    if ((geometry.attributes & kernel_has_tangents) != 0u) {
        const vec4 t0 = fetch_tangent(instance.geometry, index.x);
        const vec3 t = vec3(t0) * b0 + vec3(fetch_tangent(instance.geometry, index.y)) * b1 +
                       vec3(fetch_tangent(instance.geometry, index.z)) * b2;
        point.tangent = vec4(kernel_transform_vector(instance.object_to_world, t), t0.w * instance.determinant_sign);
    }
    point.texcoord0 = vec2(0.0f);
    point.texcoord1 = vec2(0.0f);
    if ((geometry.attributes & kernel_has_texcoord0) != 0u) {
        point.texcoord0 = fetch_texcoord(instance.geometry, 0u, index.x) * b0 + fetch_texcoord(instance.geometry, 0u, index.y) * b1 +
                          fetch_texcoord(instance.geometry, 0u, index.z) * b2;
    }
    if ((geometry.attributes & kernel_has_texcoord1) != 0u) {
        point.texcoord1 = fetch_texcoord(instance.geometry, 1u, index.x) * b0 + fetch_texcoord(instance.geometry, 1u, index.y) * b1 +
                          fetch_texcoord(instance.geometry, 1u, index.z) * b2;
    }
    point.color = vec4(1.0f);
    if ((geometry.attributes & kernel_has_colors) != 0u) {
        point.color = fetch_color(instance.geometry, index.x) * b0 + fetch_color(instance.geometry, index.y) * b1 +
                      fetch_color(instance.geometry, index.z) * b2;
    }
}

/// Texture coordinates and tangents as scene/geometry.h defines them for disks and spheres.
SHADING_FN void kernel_shape_point(SHADING_IN(KernelHit) hit, SHADING_IN(InstanceData) instance, SHADING_IN(KernelGeometry) geometry,
                                   SHADING_INOUT(KernelPoint) point) {
    vec3 normal;
    vec3 position;
    vec3 tangent;
    point.texcoord0 = vec2(0.0f);
    if (geometry.shape == kernel_shape_sphere) {
        normal = hit.object_normal;
        position = geometry.center + normal * geometry.radius;
        const float horizontal = sqrt(normal.x * normal.x + normal.z * normal.z);
        tangent = horizontal > 0.0f ? vec3(normal.z, 0.0f, -normal.x) / horizontal : vec3(-1.0f, 0.0f, 0.0f);
        if ((geometry.attributes & kernel_has_texcoord0) != 0u) {
            const float azimuth = atan(-normal.x, -normal.z) * (0.5f * inverse_pi);
            point.texcoord0 = vec2(azimuth < 0.0f ? azimuth + 1.0f : azimuth, atan(horizontal, normal.y) * inverse_pi);
        }
    } else {
        normal = cross(geometry.axis0, geometry.axis1);
        tangent = geometry.axis0;
        position = geometry.center + (geometry.axis0 * hit.barycentric.x + geometry.axis1 * hit.barycentric.y) * geometry.radius;
        point.texcoord0 = vec2(0.5f + 0.5f * hit.barycentric.x, 0.5f - 0.5f * hit.barycentric.y);
    }
    point.texcoord1 = point.texcoord0;
    point.position = kernel_transform_point(instance.object_to_world, position);
    point.error = kernel_position_error(instance.object_to_world, abs(geometry.center) + vec3(geometry.radius));
    point.geometric_normal = kernel_transform_normal(instance.normal_to_world, normal);
    point.normal = point.geometric_normal;
    point.tangent = vec4(kernel_transform_vector(instance.object_to_world, tangent), instance.determinant_sign);
    point.color = vec4(1.0f);
}

/// Derivatives of the world position by texture coordinate set `texcoord`, for bump maps; zero where the
/// coordinates are degenerate.
SHADING_FN void kernel_derivatives(SHADING_IN(KernelHit) hit, uint texcoord, SHADING_OUT(vec3) dp_du, SHADING_OUT(vec3) dp_dv) {
    SHADING_IN(InstanceData) instance = fetch_instance(hit.instance);
    SHADING_IN(KernelGeometry) geometry = fetch_geometry(instance.geometry);
    vec3 du = vec3(0.0f);
    vec3 dv = vec3(0.0f);
    if (geometry.shape == kernel_shape_disk) {
        du = geometry.axis0 * (2.0f * geometry.radius);
        dv = geometry.axis1 * (-2.0f * geometry.radius);
    } else if (geometry.shape == kernel_shape_sphere) {
        const vec3 n = hit.object_normal;
        const float horizontal = max(sqrt(n.x * n.x + n.z * n.z), 1.0e-6f);
        du = vec3(n.z, 0.0f, -n.x) * (2.0f * pi * geometry.radius);
        dv = vec3(n.x * n.y / horizontal, -horizontal, n.z * n.y / horizontal) * (pi * geometry.radius);
    } else if ((geometry.attributes & (texcoord == 0u ? kernel_has_texcoord0 : kernel_has_texcoord1)) != 0u) {
        const uvec3 index = fetch_triangle(instance.geometry, hit.primitive);
        triangle_derivatives(fetch_position(instance.geometry, index.x), fetch_position(instance.geometry, index.y),
                             fetch_position(instance.geometry, index.z), fetch_texcoord(instance.geometry, texcoord, index.x),
                             fetch_texcoord(instance.geometry, texcoord, index.y),
                             fetch_texcoord(instance.geometry, texcoord, index.z), du, dv);
    }
    dp_du = kernel_transform_vector(instance.object_to_world, du);
    dp_dv = kernel_transform_vector(instance.object_to_world, dv);
}

SHADING_FN KernelPoint kernel_point(SHADING_IN(KernelHit) hit) {
    SHADING_IN(InstanceData) instance = fetch_instance(hit.instance);
    SHADING_IN(KernelGeometry) geometry = fetch_geometry(instance.geometry);
    KernelPoint point;
    if (geometry.shape == kernel_shape_disk || geometry.shape == kernel_shape_sphere) {
        kernel_shape_point(hit, instance, geometry, point);
    } else {
        kernel_triangle_point(hit, instance, geometry, point);
    }
    point.instance = hit.instance;
    point.primitive = hit.primitive;
    point.material = instance.material;
    point.attributes = geometry.attributes;
    return point;
}

/// The material there, its tangent in the world. `inside`: see Surface.
SHADING_FN MaterialPoint kernel_material(SHADING_IN(KernelHit) hit, SHADING_IN(KernelPoint) point, SHADING_IN(MaterialData) material,
                                         bool inside) {
    MaterialPoint at = material_at(material, point.texcoord0, point.texcoord1, point.color, inside);
    if (is_extended(at.surface) && at.surface.anisotropy > 0.0f) {
        vec4 tangent = point.tangent;
        if (dot(vec3(tangent), vec3(tangent)) == 0.0f) {
            vec3 dp_dv;
            vec3 dp_du;
            kernel_derivatives(hit, 0u, dp_du, dp_dv);
            // v runs down: the bitangent up.
            tangent = vec4(dp_du, dot(cross(point.normal, dp_du), dp_dv) > 0.0f ? -1.0f : 1.0f);
        }
        orient_tangent(point.normal, tangent, at.surface);
    }
    return at;
}

/// The interpolated normal after the material's normal and bump maps.
SHADING_FN vec3 kernel_mapped_normal(SHADING_IN(KernelHit) hit, SHADING_IN(KernelPoint) point, SHADING_IN(MaterialData) material) {
    const bool bump = material.bump_texture.texture_index != no_texture;
    if (!bump && material.normal_texture.texture_index == no_texture) {
        return point.normal;
    }
    vec3 dp_du = vec3(0.0f);
    vec3 dp_dv = vec3(0.0f);
    if (bump) {
        kernel_derivatives(hit, material.bump_texture.texcoord, dp_du, dp_dv);
    }
    return material_normal_at(material, point.texcoord0, point.texcoord1, point.normal, point.tangent, dp_du, dp_dv);
}

#endif
