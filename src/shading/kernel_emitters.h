// Part of path_kernel.h (see there how it is included): selecting, sampling and weighing what emits light.
#ifndef HELIODON_SHADING_KERNEL_EMITTERS_H
#define HELIODON_SHADING_KERNEL_EMITTERS_H

/// The first emitter whose cumulative probability exceeds `u`.
SHADING_FN uint kernel_select_emitter(float u) {
    uint low = 0u;
    uint high = kernel_frame().emitter_count - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (fetch_emitter(middle).cumulative > u) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

// -- a sky that varies: cells of equal steps in azimuth and polar angle, each sampled evenly in solid angle

/// Cumulative share up to and including cell `i` of the run that starts at `first`.
SHADING_FN uint kernel_search_sky(uint first, uint count, float u) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (fetch_sky_cumulative(first + middle) > u) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}
SHADING_FN float kernel_sky_share(uint first, uint i) {
    return fetch_sky_cumulative(first + i) - (i > 0u ? fetch_sky_cumulative(first + i - 1u) : 0.0f);
}
/// Density per steradian anywhere in a cell.
SHADING_FN float kernel_sky_cell_pdf(uint row, uint column) {
    const uint columns = kernel_frame().sky_columns;
    const uint rows = kernel_frame().sky_rows;
    const float share = kernel_sky_share(0u, row) * kernel_sky_share(rows + row * columns, column);
    // cos a − cos b = 2 sin((a + b)/2) sin((b − a)/2) keeps its digits at the zenith.
    const float step = pi / float(rows);
    const float cap = 2.0f * sin((float(row) + 0.5f) * step) * sin(0.5f * step);
    return share * float(columns) / (2.0f * pi * cap);
}
/// Density per steradian with which kernel_sample_sky picks `direction`.
SHADING_FN float kernel_sky_direction_pdf(vec3 direction) {
    const vec2 uv = sky_uv(direction, fetch_sky().north_rad);
    const uint column = min(uint(uv.x * float(kernel_frame().sky_columns)), kernel_frame().sky_columns - 1u);
    const uint row = min(uint(uv.y * float(kernel_frame().sky_rows)), kernel_frame().sky_rows - 1u);
    return kernel_sky_cell_pdf(row, column);
}
SHADING_FN float kernel_sky_pdf(vec3 direction) {
    if (kernel_frame().sky_emitter == kernel_no_emitter) {
        return 0.0f;
    }
    return kernel_sky_direction_pdf(direction) * fetch_emitter(kernel_frame().sky_emitter).probability;
}
SHADING_FN vec3 kernel_sky_radiance(vec3 direction) {
    if (kernel_frame().environment == 0u) {
        return vec3(0.0f);
    }
    SHADING_IN(SkyData) sky = fetch_sky();
    vec3 texel = vec3(1.0f);
    if (sky.model == sky_model_image) {
        texel = vec3(scene_texture(sky.texture_index, sky_uv(direction, sky.north_rad)));
    }
    return sky_radiance(sky, direction, texel);
}
SHADING_FN KernelLightSample kernel_sample_sky(vec2 u) {
    const uint columns = kernel_frame().sky_columns;
    const uint rows = kernel_frame().sky_rows;
    const uint row = kernel_search_sky(0u, rows, u.y);
    const uint first = rows + row * columns;
    const uint column = kernel_search_sky(first, columns, u.x);
    // Where in its cell u fell is again uniform.
    const float below_row = row > 0u ? fetch_sky_cumulative(row - 1u) : 0.0f;
    const float below_column = column > 0u ? fetch_sky_cumulative(first + column - 1u) : 0.0f;
    const float y = clamp((u.y - below_row) / max(kernel_sky_share(0u, row), 1.0e-30f), 0.0f, 1.0f);
    const float x = clamp((u.x - below_column) / max(kernel_sky_share(first, column), 1.0e-30f), 0.0f, 1.0f);
    const float step = pi / float(rows);
    const float cos_top = cos(float(row) * step);
    const float cos_bottom = cos(float(row + 1u) * step);
    const float polar = acos(clamp(mix(cos_top, cos_bottom, y), -1.0f, 1.0f));
    KernelLightSample result;
    result.direction = sky_direction(vec2((float(column) + x) / float(columns), polar * inverse_pi), fetch_sky().north_rad);
    result.pdf = kernel_sky_cell_pdf(row, column);
    result.light = result.pdf > 0.0f ? kernel_sky_radiance(result.direction) / result.pdf : vec3(0.0f);
    result.distance = kernel_infinity;
    result.target = vec3(0.0f);
    return result;
}

// -- emissive surfaces

/// m² in the world a m² on the object-space sphere, where the world normal is `n`: |det M| / |Mᵀ n|.
SHADING_FN float kernel_area_ratio(mat4 m, vec3 n) {
    const vec3 x = vec3(m[0]);
    const vec3 y = vec3(m[1]);
    const vec3 z = vec3(m[2]);
    return abs(dot(x, cross(y, z))) / length(vec3(dot(x, n), dot(y, n), dot(z, n)));
}

/// True where the sphere is sampled by the cone under which it appears.
SHADING_FN bool kernel_sees_cone(SHADING_IN(KernelEmitter) emitter, vec3 from) {
    const vec3 to_center = emitter.origin - from;
    return emitter.area > 0.0f && dot(to_center, to_center) > emitter.area * emitter.area * 1.0001f;
}
SHADING_FN float kernel_sphere_cone(SHADING_IN(KernelEmitter) emitter, vec3 from) {
    const vec3 to_center = emitter.origin - from;
    return one_minus_cos_from_sin2(emitter.area * emitter.area / dot(to_center, to_center));
}

SHADING_FN SphericalRectangle kernel_rectangle(SHADING_IN(KernelEmitter) emitter, vec3 from) {
    return spherical_rectangle(emitter.origin - from, emitter.edge0, emitter.edge1, emitter.lengths, emitter.normal);
}
/// Rectangles that appear smaller are sampled by area, where single precision keeps more digits than the sum of
/// the solid angle's four corners: their solid angle is as good as even over them.
SHADING_FN bool kernel_sees_solid_angle(SphericalRectangle rectangle) {
    return rectangle.solid_angle > 0.05f && rectangle.z0 < -1.0e-4f * (rectangle.x1 - rectangle.x0);
}

/// Density per steradian with which kernel_sample_surface, from `from`, picks the point `position` of this
/// emitter, whose normal there is `normal`.
SHADING_FN float kernel_surface_pdf(SHADING_IN(KernelEmitter) emitter, vec3 from, vec3 position, vec3 normal) {
    const vec3 path = position - from;
    const float squared = dot(path, path);
    const float cosine = abs(dot(path, normal)) * inversesqrt(max(squared, 1.0e-37f));
    if (cosine <= 0.0f) {
        return 0.0f;
    }
    float area = emitter.area;
    if (emitter.kind == kernel_emitter_rectangle) {
        const SphericalRectangle rectangle = kernel_rectangle(emitter, from);
        if (kernel_sees_solid_angle(rectangle)) {
            return 1.0f / rectangle.solid_angle;
        }
    }
    if (emitter.kind == kernel_emitter_sphere) {
        if (kernel_sees_cone(emitter, from)) {
            return cone_pdf(kernel_sphere_cone(emitter, from));
        }
        SHADING_IN(InstanceData) instance = fetch_instance(emitter.index);
        const float radius = fetch_geometry(instance.geometry).radius;
        area = 4.0f * pi * radius * radius * kernel_area_ratio(instance.object_to_world, normal);
    }
    return squared / (cosine * area);
}

/// Radiance that leaves the surface at `hit` (opacity included) on its front side.
SHADING_FN vec3 kernel_emission(SHADING_IN(KernelHit) hit) {
    const uint index = fetch_instance(hit.instance).material;
    SHADING_IN(MaterialData) material = fetch_material(index);
    if (material.emission_texture.texture_index == no_texture &&
        (material.flags & (material_flag_alpha_mask | material_flag_alpha_blend)) == 0u) {
        return material.emission_nits;
    }
    const KernelPoint point = kernel_point(hit);
    return material.emission_nits * vec3(fetch_or_one(material.emission_texture, point.texcoord0, point.texcoord1)) *
           material_opacity_at(material, point.texcoord0, point.texcoord1, point.color.w);
}

/// A point of the emitter, as a hit would name it; `normal` is on its front side. `pdf`: its density per steradian where
/// that comes with it, else 0.
SHADING_FN KernelHit kernel_point_on_emitter(SHADING_IN(KernelEmitter) emitter, vec3 from, vec2 u, SHADING_OUT(vec3) position,
                                             SHADING_OUT(vec3) normal, SHADING_OUT(float) pdf) {
    pdf = 0.0f;
    KernelHit hit;
    hit.kind = kernel_hit_surface;
    hit.instance = emitter.index;
    hit.primitive = emitter.primitive;
    hit.t = 0.0f;
    hit.object_normal = vec3(0.0f, 0.0f, 1.0f);
    hit.barycentric = u;
    if (emitter.kind == kernel_emitter_sphere) {
        SHADING_IN(InstanceData) instance = fetch_instance(emitter.index);
        SHADING_IN(KernelGeometry) geometry = fetch_geometry(instance.geometry);
        if (kernel_sees_cone(emitter, from)) {
            const vec3 to_center = emitter.origin - from;
            const float distance = length(to_center);
            const Frame frame = frame_from_normal(to_center / distance);
            const vec3 local = sample_cone(u, kernel_sphere_cone(emitter, from));
            const float sin2 = local.x * local.x + local.y * local.y;
            const float t = distance * local.z - sqrt(max(0.0f, emitter.area * emitter.area - distance * distance * sin2));
            normal = normalize(from + to_world(frame, local) * t - emitter.origin);
            position = emitter.origin + normal * emitter.area;
            const mat4 m = instance.object_to_world;
            hit.object_normal = normalize(vec3(dot(vec3(m[0]), normal), dot(vec3(m[1]), normal), dot(vec3(m[2]), normal)));
        } else {
            hit.object_normal = sample_uniform_sphere(u);
            position = kernel_transform_point(instance.object_to_world, geometry.center + hit.object_normal * geometry.radius);
            normal = kernel_transform_normal(instance.normal_to_world, hit.object_normal);
        }
        return hit;
    }
    normal = emitter.normal;
    if (emitter.kind == kernel_emitter_disk) {
        hit.barycentric = sample_disk(u);
    } else if (emitter.kind == kernel_emitter_triangle) {
        const vec3 weights = sample_triangle(u);
        hit.barycentric = vec2(weights.y, weights.z);
    }
    if (emitter.kind == kernel_emitter_rectangle) {
        const SphericalRectangle rectangle = kernel_rectangle(emitter, from);
        if (kernel_sees_solid_angle(rectangle)) {
            hit.barycentric = sample_spherical_rectangle(rectangle, u);
            pdf = 1.0f / rectangle.solid_angle;
        }
    }
    position = emitter.origin + emitter.edge0 * hit.barycentric.x + emitter.edge1 * hit.barycentric.y;
    if (emitter.kind == kernel_emitter_quad || emitter.kind == kernel_emitter_rectangle) {
        // Its two triangles: (0, u, u + v) and (0, u + v, v).
        const vec2 along = hit.barycentric;
        const bool lower = along.x >= along.y;
        hit.primitive = lower ? 0u : 1u;
        hit.barycentric = lower ? vec2(along.x - along.y, along.y) : vec2(along.x, along.y - along.x);
    }
    return hit;
}

SHADING_FN KernelLightSample kernel_sample_surface(SHADING_IN(KernelEmitter) emitter, vec3 from, vec2 u) {
    vec3 position;
    vec3 normal;
    float pdf;
    const KernelHit hit = kernel_point_on_emitter(emitter, from, u, position, normal, pdf);
    KernelLightSample result;
    result.light = vec3(0.0f);
    result.pdf = 0.0f;
    const vec3 path = position - from;
    result.distance = length(path);
    result.direction = path / max(result.distance, 1.0e-37f);
    result.target = position;
    const float cosine = -dot(normal, result.direction);
    const bool two_sided = (fetch_material(fetch_instance(emitter.index).material).flags & material_flag_two_sided) != 0u;
    if (result.distance <= 0.0f || cosine == 0.0f || (cosine < 0.0f && !two_sided)) {
        return result;
    }
    result.pdf = pdf > 0.0f ? pdf : kernel_surface_pdf(emitter, from, position, normal);
    if (result.pdf <= 0.0f) {
        return result;
    }
    result.light = kernel_emission(hit) / result.pdf;
    const float extent = emitter.kind == kernel_emitter_sphere ? length(emitter.origin - position) : 0.0f;
    const vec3 terms = abs(emitter.origin) + abs(emitter.edge0) + abs(emitter.edge1) + vec3(extent);
    result.target = kernel_offset(position, kernel_error_bound(terms) * 2.0f, normal, -result.direction);
    return result;
}

// -- any of them

SHADING_FN KernelLightSample kernel_sample_light(SHADING_IN(LightData) light, vec3 from, vec2 u) {
    const LightSample sampled = any_light_sample(light, from, u);
    KernelLightSample result;
    result.direction = sampled.direction;
    result.pdf = sampled.pdf;
    result.light = sampled.value;
    result.distance = light.type == light_type_directional ? kernel_infinity : sampled.distance;
    result.target = from + sampled.direction * sampled.distance;
    return result;
}

/// Share of the samples that goes to emitters outside the light tree.
SHADING_FN float kernel_distant_share() {
    return kernel_frame().distant_emitters > 0u ? fetch_emitter(kernel_frame().distant_emitters - 1u).cumulative : 0.0f;
}

/// Probability with which kernel_sample_emitters, from there, selects this emitter.
SHADING_FN float kernel_selection_probability(SHADING_IN(KernelEmitter) emitter, vec3 from, vec3 normal) {
    if (kernel_frame().light_node_count == 0u || emitter.light_node == kernel_no_emitter) {
        return emitter.probability;
    }
    return (1.0f - kernel_distant_share()) * kernel_light_leaf_probability(emitter.light_node, from, normal);
}

/// An emitter and the probability of selecting it there; kernel_no_emitter where none lights the place.
SHADING_FN uint kernel_select_emitter_at(vec3 from, vec3 normal, float u, SHADING_OUT(float) probability) {
    const float distant = kernel_distant_share();
    if (kernel_frame().light_node_count == 0u || u < distant) {
        const uint selected = kernel_select_emitter(u);
        probability = fetch_emitter(selected).probability;
        return selected;
    }
    probability = 1.0f - distant;
    return kernel_walk_light_tree(from, normal, min((u - distant) / probability, 0.99999994f), probability);
}

/// One emitter, one direction to it; pdf and light account for the selection. `normal` is the shading normal
/// on the side that light must come from, or zero where light from both sides counts.
SHADING_FN KernelLightSample kernel_sample_emitters(vec3 from, vec3 normal, float u_select, vec2 u) {
    float probability;
    const uint selected = kernel_select_emitter_at(from, normal, u_select, probability);
    if (selected == kernel_no_emitter) {
        KernelLightSample nothing;
        nothing.direction = vec3(0.0f, 1.0f, 0.0f);
        nothing.pdf = 0.0f;
        nothing.light = vec3(0.0f);
        nothing.distance = kernel_infinity;
        nothing.target = vec3(0.0f);
        nothing.emitter = kernel_no_emitter;
        return nothing;
    }
    SHADING_IN(KernelEmitter) emitter = fetch_emitter(selected);
    KernelLightSample result;
    if (emitter.kind == kernel_emitter_light) {
        result = kernel_sample_light(fetch_light(emitter.index), from, u);
    } else if (emitter.kind == kernel_emitter_sky) {
        result = kernel_sample_sky(u);
    } else {
        result = kernel_sample_surface(emitter, from, u);
    }
    result.pdf *= probability;
    result.light = result.light / max(probability, 1.0e-30f);
    result.emitter = selected;
    return result;
}

/// Density with which light sampling, from `from` with `normal`, would have picked the emissive surface that a ray hit.
SHADING_FN float kernel_hit_pdf(SHADING_IN(KernelPoint) point, vec3 from, vec3 normal) {
    const uint first = fetch_first_emitter(point.instance);
    if (first == kernel_no_emitter) {
        return 0.0f;
    }
    KernelEmitter emitter = fetch_emitter(first);
    if (emitter.kind == kernel_emitter_triangle) {
        emitter = fetch_emitter(first + point.primitive);
    }
    return kernel_selection_probability(emitter, from, normal) *
           kernel_surface_pdf(emitter, from, point.position, point.geometric_normal);
}

#endif
