// Part of bidirectional_kernel.h (see there how it is included): light that sets out from the emitters, and the
// densities that weigh it against next-event estimation. Veach 1997, section 8.3.2.
#ifndef HELIODON_SHADING_KERNEL_EMISSION_H
#define HELIODON_SHADING_KERNEL_EMISSION_H

SHADING_FN uint kernel_select_emission(float u) {
    uint low = 0u;
    uint high = emission_count() - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (fetch_emission_cumulative(middle) > u) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}
/// The constant sky, which next-event estimation leaves alone, follows the emitters.
SHADING_FN float kernel_emission_probability(uint emitter) {
    const uint i = emitter == kernel_constant_sky ? kernel_frame().emitter_count : emitter;
    if (i >= emission_count() || (i == kernel_frame().emitter_count) != (emitter == kernel_constant_sky)) {
        return 0.0f;  // a table of nothing but emitters of no light
    }
    return fetch_emission_cumulative(i) - (i > 0u ? fetch_emission_cumulative(i - 1u) : 0.0f);
}

SHADING_FN bool kernel_emits_from_afar(uint emitter) {
    if (emitter == kernel_constant_sky) {
        return true;
    }
    SHADING_IN(KernelEmitter) e = fetch_emitter(emitter);
    return e.kind == kernel_emitter_sky || (e.kind == kernel_emitter_light && fetch_light(e.index).type == light_type_directional);
}
/// No ray meets it by chance.
SHADING_FN bool kernel_is_delta(uint emitter) {
    if (emitter == kernel_constant_sky) {
        return false;
    }
    SHADING_IN(KernelEmitter) e = fetch_emitter(emitter);
    return e.kind == kernel_emitter_light && light_is_delta(fetch_light(e.index));
}

/// 1/m² of the disc about the scene, facing the light, where light from afar enters it.
SHADING_FN float kernel_far_disc_pdf() {
    const float radius = scene_sphere().w;
    return 1.0f / (pi * radius * radius);
}
/// 1/m² at `normal` on an emissive surface, even over it in object space.
SHADING_FN float kernel_emitter_area_pdf(SHADING_IN(KernelEmitter) emitter, vec3 normal) {
    if (emitter.kind != kernel_emitter_sphere) {
        return 1.0f / emitter.area;
    }
    if (emitter.area > 0.0f) {
        return 1.0f / (4.0f * pi * emitter.area * emitter.area);
    }
    SHADING_IN(InstanceData) instance = fetch_instance(emitter.index);
    const float radius = fetch_geometry(instance.geometry).radius;
    return 1.0f / (4.0f * pi * radius * radius * kernel_area_ratio(instance.object_to_world, normal));
}
SHADING_FN float kernel_emitter_sides(SHADING_IN(KernelEmitter) emitter) {
    return (fetch_material(fetch_instance(emitter.index).material).flags & material_flag_two_sided) != 0u ? 2.0f : 1.0f;
}

/// Front normal at `position` on an emitter whose area density depends on it; anything for others.
SHADING_FN vec3 kernel_emitter_normal(uint emitter, vec3 position) {
    SHADING_IN(KernelEmitter) e = fetch_emitter(emitter);
    if (e.kind != kernel_emitter_sphere || e.area > 0.0f) {
        return vec3(0.0f, 0.0f, 1.0f);
    }
    const mat4 m = fetch_instance(e.index).normal_to_world;
    const vec3 d = position - e.origin;
    return kernel_transform_normal(m, normalize(vec3(dot(vec3(m[0]), d), dot(vec3(m[1]), d), dot(vec3(m[2]), d))));
}

/// Density with which light sets out along one ray, over area across the ray and solid angle: from a surface,
/// that of position and direction over the cosine, which cancels, as directions are drawn by it. Of lights without
/// extent what is left of it: a point's per steradian, a parallel beam's per m².
SHADING_FN float kernel_emission_density(uint emitter, vec3 normal, vec3 direction) {
    const float probability = kernel_emission_probability(emitter);
    if (probability <= 0.0f) {
        return 0.0f;
    }
    if (emitter == kernel_constant_sky) {
        return probability * uniform_sphere_pdf * kernel_far_disc_pdf();
    }
    SHADING_IN(KernelEmitter) e = fetch_emitter(emitter);
    if (e.kind == kernel_emitter_sky) {
        return probability * kernel_sky_direction_pdf(-direction) * kernel_far_disc_pdf();
    }
    if (e.kind != kernel_emitter_light) {
        return probability * kernel_emitter_area_pdf(e, normal) * inverse_pi / kernel_emitter_sides(e);
    }
    SHADING_IN(LightData) light = fetch_light(e.index);
    const bool delta = light_is_delta(light);
    if (light.type == light_type_directional) {
        return probability * (delta ? 1.0f : light_emission_pdf(light, direction)) * kernel_far_disc_pdf();
    }
    return probability * light_emission_pdf(light, direction) * (delta ? 1.0f : inverse_pi / (light.radius * light.radius));
}

/// Density per steradian with which light sampling at `from` picks that place of the emitter; of lights without
/// extent the probability of picking them. `normal`: see kernel_sample_emitters.
SHADING_FN float kernel_next_event_pdf(SHADING_IN(EmittedLight) emitted, vec3 from, vec3 normal) {
    if (emitted.emitter == kernel_constant_sky) {
        return 0.0f;
    }
    SHADING_IN(KernelEmitter) e = fetch_emitter(emitted.emitter);
    if (e.kind == kernel_emitter_sky) {
        return kernel_sky_pdf(-emitted.direction);
    }
    const float probability = kernel_selection_probability(e, from, normal);
    if (e.kind == kernel_emitter_light) {
        SHADING_IN(LightData) light = fetch_light(e.index);
        return probability * (light_is_delta(light) ? 1.0f : any_light_pdf(light, from, -emitted.direction));
    }
    return probability * kernel_surface_pdf(e, from, emitted.position, emitted.normal);
}

/// Light enters the scene along `emitted.direction` through the disc.
SHADING_FN void kernel_enter_from_afar(SHADING_INOUT(EmittedLight) emitted, vec2 u) {
    const float radius = scene_sphere().w;
    const vec2 disk = sample_disk(u) * radius;
    const Frame frame = frame_from_normal(emitted.direction);
    emitted.origin = vec3(scene_sphere()) + to_world(frame, vec3(disk.x, disk.y, -radius));
}

SHADING_FN void kernel_emit_from_light(SHADING_INOUT(EmittedLight) emitted, SHADING_IN(LightData) light, vec2 u_position, vec2 u_direction) {
    emitted.direction = light_sample_emission(light, u_direction);
    const bool delta = light_is_delta(light);
    if (light.type == light_type_directional) {
        kernel_enter_from_afar(emitted, u_position);
        emitted.light = delta ? light.intensity : any_light_radiance(light, -emitted.direction);
        return;
    }
    emitted.origin = light.position;
    if (delta) {
        emitted.light = light.type == light_type_luminaire ? luminaire_intensity(light, emitted.direction)
                                                           : light_intensity(light, emitted.direction);
        return;
    }
    // Even over the disc across the direction that holds the light's outline: what a ray back from there meets shines.
    const vec2 disk = sample_disk(u_position);
    emitted.origin += to_world(frame_from_normal(emitted.direction), vec3(disk, 1.0f) * light.radius);
    const float t = any_light_intersect(light, emitted.origin, -emitted.direction);
    if (t >= 0.0f) {
        emitted.origin -= emitted.direction * t;
        emitted.light = any_light_radiance(light, -emitted.direction);
    }
}

SHADING_FN void kernel_emit_from_surface(SHADING_INOUT(EmittedLight) emitted, SHADING_IN(KernelEmitter) e, float u_side, vec2 u_position,
                                         vec2 u_direction) {
    // By area: from its own centre a sphere is not sampled by a cone, nor a quad by its solid angle.
    KernelEmitter by_area = e;
    if (e.kind == kernel_emitter_rectangle) {
        by_area.kind = kernel_emitter_quad;
    }
    vec3 front;
    float seen_pdf;
    const KernelHit hit = kernel_point_on_emitter(by_area, e.origin, u_position, emitted.position, front, seen_pdf);
    emitted.normal = front;
    const vec3 side = u_side * kernel_emitter_sides(e) < 1.0f ? front : -front;
    emitted.direction = to_world(frame_from_normal(side), sample_cosine_hemisphere(u_direction));
    const float extent = e.kind == kernel_emitter_sphere ? length(e.origin - emitted.position) : 0.0f;
    const vec3 terms = abs(e.origin) + abs(e.edge0) + abs(e.edge1) + vec3(extent);
    emitted.origin = kernel_offset(emitted.position, kernel_error_bound(terms) * 2.0f, side, side);
    emitted.light = kernel_emission(hit);
}

/// Light that sets out; `light` is 0 where none does.
SHADING_FN EmittedLight kernel_sample_emission(vec2 u_select, vec2 u_position, vec2 u_direction) {
    EmittedLight emitted;
    emitted.emitter = kernel_select_emission(u_select.x);
    emitted.origin = vec3(0.0f);
    emitted.direction = vec3(0.0f, 0.0f, 1.0f);
    emitted.position = vec3(0.0f);
    emitted.normal = vec3(0.0f, 0.0f, 1.0f);
    emitted.light = vec3(0.0f);
    if (emitted.emitter == kernel_frame().emitter_count) {
        emitted.emitter = kernel_constant_sky;
        emitted.direction = sample_uniform_sphere(u_direction);
        emitted.light = kernel_sky_radiance(-emitted.direction);
        kernel_enter_from_afar(emitted, u_position);
    } else {
        SHADING_IN(KernelEmitter) e = fetch_emitter(emitted.emitter);
        if (e.kind == kernel_emitter_light) {
            kernel_emit_from_light(emitted, fetch_light(e.index), u_position, u_direction);
        } else if (e.kind == kernel_emitter_sky) {
            emitted.direction = -kernel_sample_sky(u_direction).direction;
            emitted.light = kernel_sky_radiance(-emitted.direction);
            kernel_enter_from_afar(emitted, u_position);
        } else {
            kernel_emit_from_surface(emitted, e, u_select.y, u_position, u_direction);
        }
    }
    emitted.density = kernel_emission_density(emitted.emitter, emitted.normal, emitted.direction);
    emitted.light = emitted.density > 0.0f ? emitted.light / emitted.density : vec3(0.0f);
    return emitted;
}

#endif
