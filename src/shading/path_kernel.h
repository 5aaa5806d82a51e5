// The light-transport kernel: one path as a state machine that hands rays out and takes hits in, and never
// traces anything itself. Unidirectional path tracing with next-event estimation and multiple importance
// sampling (Veach 1997, chapters 8 to 10).
//
//     PathState path = path_begin(x, y, sample);
//     for (KernelRay ray = path_next_ray(path); ray.kind != kernel_ray_none; ray = path_next_ray(path))
//         path_take_hit(path, <answer to ray>);
//     // path.radiance, path.direct
//
// Opens no namespace: GLSL includes it at global scope after the definitions below; C++ inside the struct
// that has them as members (in a namespace that sees heliodon::shading). Include before it, outside:
// shading/{bsdf, light, luminaire_shape, material_eval, sky, spherical_rectangle, kernel_sampler, kernel_state}.h. The includer defines
//
//   what material_fetch.h wants:    scene_texture, scene_texture_size
//   what luminaire.h wants:         luminaire_value
//   KernelFrame kernel_frame()
//   InstanceData fetch_instance(uint), MaterialData fetch_material(uint), LightData fetch_light(uint), SkyData fetch_sky()
//   KernelGeometry fetch_geometry(uint geometry)
//   uvec3 fetch_triangle(uint geometry, uint primitive)            vertex indices
//   vec3 fetch_position, vec3 fetch_normal, vec4 fetch_tangent, vec4 fetch_color (uint geometry, uint vertex)
//   vec2 fetch_texcoord(uint geometry, uint set, uint vertex)
//   KernelEmitter fetch_emitter(uint)
//   uint fetch_first_emitter(uint instance), fetch_light_emitter(uint light), fetch_visible_light(uint i)
//   KernelLightNode fetch_light_node(uint i)
//   float fetch_sky_cumulative(uint i)                             rows, then a run of columns each row
#ifndef HELIODON_SHADING_PATH_KERNEL_H
#define HELIODON_SHADING_PATH_KERNEL_H
#include "shading/material_fetch.h"
#include "shading/kernel_surface.h"
#include "shading/luminaire.h"
#include "shading/kernel_light_tree.h"
#include "shading/kernel_emitters.h"

// -- random numbers: dimension pair 0 is the pixel; each scattering event takes four more

SHADING_FN vec2 kernel_random_pair(uint pixel_seed, uint sample_reversed, uint event, uint pair) {
    return kernel_sample_pair(sample_reversed, pixel_seed + (4u * event + pair) * 0x9e3779b9u);
}
SHADING_FN vec2 path_random_pair(SHADING_IN(PathState) path, uint event, uint pair) {
    if (event < kernel_tiled_events) {
        return kernel_tile_pair(path.sample_reversed, path.place_reversed, path.tile_seed + (4u * event + pair) * 0x9e3779b9u);
    }
    return kernel_random_pair(path.pixel_seed, path.sample_reversed, event, pair);
}
SHADING_FN float path_random_first(SHADING_IN(PathState) path, uint event, uint pair) {
    return kernel_sample_first(path.sample_reversed, path.pixel_seed + (4u * event + pair) * 0x9e3779b9u);
}
/// For decisions that come any number of times between two events.
SHADING_FN float kernel_random_pass(uint pixel_seed, uint sample_reversed, uint pass) {
    return kernel_unit_float(kernel_hash_combine(kernel_hash_combine(pixel_seed, sample_reversed), pass));
}

// -- beginning

SHADING_FN PathState path_begin_along(uint stream, uint sample_index, vec3 origin, vec3 direction) {
    PathState path;
    path.pixel_seed = kernel_hash_combine(kernel_hash(kernel_frame().seed), stream);
    path.sample_reversed = kernel_reverse_bits(sample_index);
    path.origin = origin;
    path.direction = direction;
    path.stage = kernel_stage_scatter;
    path.after_shadow = kernel_stage_done;
    path.throughput = vec3(1.0f);
    path.scatter_pdf = 0.0f;
    path.scatter_origin = origin;
    path.depth = 0u;
    path.shadow_origin = vec3(0.0f);
    path.shadow_t_max = 0.0f;
    path.shadow_direction = vec3(0.0f);
    path.pass_count = 0u;
    path.shadow_light = vec3(0.0f);
    path.radiance = vec3(0.0f);
    path.direct = vec3(0.0f);
    path.eta_scale = 1.0f;
    path.scatter_normal = vec3(0.0f);
    path.tile_seed = path.pixel_seed;
    path.place_reversed = 0u;
    path.absorption = vec3(0.0f);
    path.roulette = 3.0f;  // of sensors; pictures' branches: kernel_next_branch
    path.branches_left = 0u;
    path.branches_begun = 0u;
    return path;
}

/// A path from the camera through pixel (x, y), counted from the top left; box filter.
SHADING_FN PathState path_begin(uint x, uint y, uint sample_index) {
    const uint streams = kernel_frame().sample_streams;
    PathState path = path_begin_along(y * kernel_frame().width + x, sample_index / streams, kernel_frame().camera_position, vec3(0.0f));
    if (sample_index % streams != 0u) {
        path.pixel_seed = kernel_hash_combine(path.pixel_seed, sample_index % streams);
    }
    path.tile_seed = path.pixel_seed;
    const uint bits = kernel_frame().tile_bits;
    if (bits > 0u) {
        const uint mask = (1u << bits) - 1u;
        path.tile_seed = kernel_hash_combine(kernel_hash(kernel_frame().seed ^ 0x5bd1e995u), (y >> bits) << 16u | (x >> bits));
        path.place_reversed = kernel_reverse_bits(kernel_morton(x & mask, y & mask));
    }
    const vec2 jitter = path_random_pair(path, 0u, 0u);
    const float across = 2.0f * (float(x) + jitter.x) / float(kernel_frame().width) - 1.0f;
    const float down = 2.0f * (float(y) + jitter.y) / float(kernel_frame().height) - 1.0f;
    path.direction = normalize(kernel_frame().camera_forward + kernel_frame().camera_right * across - kernel_frame().camera_up * down);
    return path;
}

SHADING_FN KernelRay path_next_ray(SHADING_IN(PathState) path) {
    KernelRay ray;
    ray.kind = kernel_ray_none;
    ray.origin = path.origin;
    ray.direction = path.direction;
    ray.t_max = kernel_infinity;
    if (path.stage == kernel_stage_scatter) {
        ray.kind = kernel_ray_scatter;
    } else if (path.stage == kernel_stage_shadow) {
        ray.kind = kernel_ray_shadow;
        ray.origin = path.shadow_origin;
        ray.direction = path.shadow_direction;
        ray.t_max = path.shadow_t_max;
    }
    return ray;
}

// -- gathering light

SHADING_FN void kernel_add(SHADING_INOUT(PathState) path, vec3 light) {
    path.radiance += light;
    if (path.depth <= 1u) {
        path.direct += light;
    }
}

/// Light met by chance, which light sampling would have found with density `light_pdf`.
SHADING_FN void kernel_add_met(SHADING_INOUT(PathState) path, vec3 radiance, float light_pdf) {
    const float weight = path.scatter_pdf > 0.0f ? power_heuristic(path.scatter_pdf, light_pdf) : 1.0f;
    kernel_add(path, path.throughput * radiance * weight);
}

/// Lights with an extent shine through the segment: they are no surfaces and hide nothing.
SHADING_FN void kernel_add_visible_lights(SHADING_INOUT(PathState) path, float distance) {
    for (uint i = 0u; i < kernel_frame().visible_light_count; ++i) {
        const uint index = fetch_visible_light(i);
        SHADING_IN(LightData) light = fetch_light(index);
        const float t = any_light_intersect(light, path.origin, path.direction);
        if (t >= 0.0f && t < distance) {
            SHADING_IN(KernelEmitter) emitter = fetch_emitter(fetch_light_emitter(index));
            const float pdf = any_light_pdf(light, path.scatter_origin, path.direction) *
                              kernel_selection_probability(emitter, path.scatter_origin, path.scatter_normal);
            kernel_add_met(path, any_light_radiance(light, path.direction), pdf);
        }
    }
}

#include "shading/kernel_scatter.h"

/// A path that measures illuminance in lux at `position` on a plane facing `normal`: the first event is
/// scattering at a white Lambertian surface there, whose radiance is E/π.
SHADING_FN PathState path_begin_illuminance(uint stream, uint sample_index, vec3 position, vec3 normal) {
    PathState path = path_begin_along(stream, sample_index, position, -normal);
    Surface surface = surface_default();
    surface.model = material_model_lambert;
    surface.base_color = vec3(1.0f);
    path.throughput = vec3(pi);
    kernel_scatter(path, position, vec3(0.0f), normal, normal, surface, normal);
    if (path.stage == kernel_stage_done) {
        kernel_next_branch(path);
    }
    return path;
}

// -- taking hits

/// Takes what a shadow ray met: `shadow_light` shrinks at what lets light through. True while the ray goes on behind
/// it; when it ends, `arrived` says whether anything gets to its target.
SHADING_FN bool kernel_shadow_goes_on(SHADING_INOUT(PathState) path, SHADING_IN(KernelHit) hit, SHADING_OUT(bool) arrived) {
    arrived = hit.kind == kernel_hit_nothing;
    if (hit.kind != kernel_hit_surface) {
        return false;
    }
    const KernelPoint point = kernel_point(hit);
    SHADING_IN(MaterialData) material = fetch_material(point.material);
    float passing = thin_transmittance(material, dot(path.shadow_direction, point.geometric_normal));
    if (material.model != material_model_thin) {
        passing = 1.0f - material_opacity_at(material, point.texcoord0, point.texcoord1, point.color.w);
    }
    path.shadow_light = path.shadow_light * passing;
    path.pass_count += 1u;
    if (passing <= 0.0f || path.pass_count >= kernel_most_passes) {
        return false;
    }
    const vec3 onward = kernel_offset(point.position, point.error, point.geometric_normal, path.shadow_direction);
    if (path.shadow_t_max < kernel_infinity) {
        path.shadow_t_max -= dot(onward - path.shadow_origin, path.shadow_direction);
    }
    path.shadow_origin = onward;
    arrived = path.shadow_t_max <= 0.0f;
    return !arrived;
}

SHADING_FN void kernel_take_shadow_hit(SHADING_INOUT(PathState) path, SHADING_IN(KernelHit) hit) {
    bool arrived;
    if (kernel_shadow_goes_on(path, hit, arrived)) {
        return;  // the same stage again
    }
    if (arrived) {
        kernel_add(path, path.shadow_light);
    }
    path.stage = path.after_shadow;
}

/// True where the ray goes on behind the surface as if it were not there, with probability 1 − opacity, or through a
/// pane, which mirrors the others.
SHADING_FN bool kernel_pass_through(SHADING_INOUT(PathState) path, SHADING_IN(KernelPoint) point, SHADING_IN(MaterialData) material) {
    const bool thin = material.model == material_model_thin;
    const float opacity =
        thin ? material.reflectance : material_opacity_at(material, point.texcoord0, point.texcoord1, point.color.w);
    if (opacity >= 1.0f) {
        return false;
    }
    path.pass_count += 1u;
    if (kernel_random_pass(path.pixel_seed, path.sample_reversed, path.pass_count) < opacity) {
        return false;
    }
    if (thin) {
        path.throughput = path.throughput * (thin_transmittance(material, dot(path.direction, point.geometric_normal)) / (1.0f - opacity));
    }
    path.origin = kernel_offset(point.position, point.error, point.geometric_normal, path.direction);
    path.stage = path.pass_count < kernel_most_passes ? kernel_stage_scatter : kernel_stage_done;
    return true;
}

SHADING_FN void kernel_take_surface_hit(SHADING_INOUT(PathState) path, SHADING_IN(KernelHit) hit) {
    const KernelPoint point = kernel_point(hit);
    SHADING_IN(MaterialData) material = fetch_material(point.material);
    if (kernel_pass_through(path, point, material)) {
        return;
    }
    path.stage = kernel_stage_done;
    const bool front = dot(path.direction, point.geometric_normal) < 0.0f;
    const bool two_sided = (material.flags & material_flag_two_sided) != 0u;
    const bool inside = !front && !two_sided;
    const MaterialPoint at = kernel_material(hit, point, material, inside);
    if (is_extended(at.surface) && at.surface.inside && path.depth == 0u) {  // the camera is in the solid
        path.throughput = path.throughput * kernel_solid_transmittance(at.surface.absorption, hit.t);
    }
    if (!inside && max_component(at.emission) > 0.0f) {
        kernel_add_met(path, at.emission, path.scatter_pdf > 0.0f ? kernel_hit_pdf(point, path.scatter_origin, path.scatter_normal) : 0.0f);
    }
    // The back of a one-sided surface is black; that of a transmissive solid is its inside.
    const bool black = inside && !at.surface.inside;
    if (black || material.model == material_model_unlit ||
        (kernel_frame().max_depth != 0u && path.depth >= kernel_frame().max_depth)) {
        return;
    }
    const vec3 wo = -path.direction;
    const vec3 geometric = front ? point.geometric_normal : -point.geometric_normal;
    const vec3 mapped = kernel_mapped_normal(hit, point, material);
    const vec3 normal = mapped == point.geometric_normal ? geometric : usable_shading_normal(mapped, geometric, wo);
    kernel_scatter(path, point.position, point.error, geometric, normal, at.surface, wo);
}

SHADING_FN void kernel_take_hit(SHADING_INOUT(PathState) path, SHADING_IN(KernelHit) hit) {
    if (path.stage == kernel_stage_shadow) {
        kernel_take_shadow_hit(path, hit);
        return;
    }
    if (max_component(path.absorption) > 0.0f) {
        path.throughput = path.throughput *
                          kernel_solid_transmittance(path.absorption, hit.kind == kernel_hit_surface ? hit.t : kernel_infinity);
    }
    if (hit.kind == kernel_hit_surface) {
        kernel_add_visible_lights(path, hit.t);
        kernel_take_surface_hit(path, hit);
        return;
    }
    kernel_add_visible_lights(path, 2.0f * kernel_infinity);
    kernel_add_met(path, kernel_sky_radiance(path.direction), path.scatter_pdf > 0.0f ? kernel_sky_pdf(path.direction) : 0.0f);
    path.stage = kernel_stage_done;
}

SHADING_FN void path_take_hit(SHADING_INOUT(PathState) path, SHADING_IN(KernelHit) hit) {
    kernel_take_hit(path, hit);
    if (path.stage == kernel_stage_done) {
        kernel_next_branch(path);
    }
}

#endif
