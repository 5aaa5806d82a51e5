// Bidirectional path tracing as a state machine like path_kernel.h's: every sample of a pixel follows one subpath
// from the lights and one from the camera and joins every vertex of one with every vertex of the other, weighted
// by multiple importance sampling with the power heuristic (Veach 1997, chapter 10). docs/bidirectional.md derives it.
//
//     BidirectionalState state = bidirectional_begin(x, y, sample, slot);
//     for (KernelRay ray = path_next_ray(state.walk); ray.kind != kernel_ray_none; ray = path_next_ray(state.walk)) {
//         bidirectional_take_hit(state, <answer to ray>);
//         if (state.splat_pixel != bidirectional_no_pixel) <add state.splat_light to that pixel>;
//     }
//     // state.walk.radiance, state.walk.direct
//
// A pixel's value for one sample is the path's radiance and all splats that fell there in that sample of the whole
// picture. Included after path_kernel.h and like it, with shading/{bidirectional_vertex, light_emission}.h before.
// Beyond what path_kernel.h wants, the includer defines
//
//   vec4 scene_sphere()                        centre and radius of a sphere about the scene, m
//   uint emission_count()                      entries of the next: the emitters and, where it shines, the constant sky
//   float fetch_emission_cumulative(uint i)    cumulative probability of starting a light subpath there
//   SubpathVertex fetch_light_vertex(uint slot, uint i), void store_light_vertex(uint slot, uint i, SubpathVertex)
//   uvec2 fetch_only_strategy()                tests: (light, camera) vertices of the only strategy wanted, alone and
//                                              unweighted; bidirectional_any for any number, twice for all strategies
#ifndef HELIODON_SHADING_BIDIRECTIONAL_KERNEL_H
#define HELIODON_SHADING_BIDIRECTIONAL_KERNEL_H
#include "shading/kernel_emission.h"
#include "shading/bidirectional_walk.h"

// -- the light subpath

/// Joins the light subpath's vertex in hand with the camera.
SHADING_FN bool bidirectional_connect_camera(SHADING_INOUT(BidirectionalState) state) {
    const vec3 path = state.vertex.position - kernel_frame().camera_position;
    const float squared = dot(path, path);
    const vec3 direction = path * inversesqrt(max(squared, 1.0e-37f));
    const uint pixel = camera_pixel(direction);
    if (pixel == bidirectional_no_pixel) {
        return false;
    }
    const VertexScattering scattering = vertex_scattering_towards(state.vertex, -direction, state.vertex.toward);
    const float pdf = camera_pdf(dot(direction, kernel_frame().camera_forward)) * vertex_cosine(state.vertex, direction) / squared /
                      bidirectional_light_paths();
    const float others = weight_of_others(state.vertex.weights, pdf, scattering.pdf);
    const vec3 light = state.vertex.throughput * scattering.value *
                       bidirectional_transmittance(state, -direction, sqrt(squared)) *
                       (pdf * bidirectional_weight(state.vertex.events + 1u, 1u, others) /
                        max(vertex_cosine(state.vertex, state.vertex.toward), 1.0e-10f));
    if (max_component(light) <= 0.0f) {
        return false;
    }
    bidirectional_cast_shadow(state, -direction, kernel_frame().camera_position, light, state.vertex.events);
    state.shadow_pixel = pixel;
    return true;
}

SHADING_FN void bidirectional_go_on_from_light(SHADING_INOUT(BidirectionalState) state) {
    bidirectional_scatter(state);
    if (state.walk.stage == kernel_stage_done) {
        bidirectional_begin_camera(state);
    }
}

SHADING_FN void bidirectional_take_light_hit(SHADING_INOUT(BidirectionalState) state, SHADING_IN(KernelHit) hit) {
    if (hit.kind == kernel_hit_surface) {
        const KernelPoint point = kernel_point(hit);
        SHADING_IN(MaterialData) material = fetch_material(point.material);
        if (kernel_pass_through(state.walk, point, material)) {
            if (state.walk.stage == kernel_stage_done) {
                bidirectional_begin_camera(state);
            }
            return;
        }
        const MaterialPoint at = kernel_material(hit, point, material, true);
        if (bidirectional_arrive(state, hit, point, material, at)) {
            if (state.vertex.events == 1u) {
                const bool delta = kernel_is_delta(state.emitted.emitter);
                const bool afar = kernel_emits_from_afar(state.emitted.emitter);
                const vec3 path = point.position - state.emitted.origin;
                const float squared = delta && !afar ? dot(path, path) : 1.0f;
                // A lamp within a solid.
                state.vertex.throughput = state.vertex.throughput *
                                          bidirectional_transmittance(state, -state.walk.direction, afar ? kernel_infinity : length(path));
                const float next_event = kernel_next_event_pdf(state.emitted, point.position,
                                                               vertex_light_side(state.vertex, -state.walk.direction));
                state.vertex.weights = weights_lit(next_event, state.emitted.density, squared,
                                                   vertex_cosine(state.vertex, state.walk.direction), delta);
            }
            store_light_vertex(state.slot, state.light_vertices, state.vertex);
            state.light_vertices += 1u;
            if (!bidirectional_connect_camera(state)) {
                bidirectional_go_on_from_light(state);
            }
            return;
        }
    }
    bidirectional_begin_camera(state);
}

// -- the camera subpath

SHADING_FN void bidirectional_add(SHADING_INOUT(BidirectionalState) state, vec3 light, uint events) {
    state.walk.radiance += light;
    if (events <= 1u) {
        state.walk.direct += light;
    }
}

/// Light met by chance: emitted along the walk's ray with these densities.
SHADING_FN void bidirectional_add_met(SHADING_INOUT(BidirectionalState) state, vec3 radiance, float next_event, float density) {
    float weight = 1.0f;
    if (state.walk.depth > 0u) {  // nothing else finds the lights that the camera sees itself
        const float others = weight_limited(weight_squared(next_event) * state.weights.last) +
                             weight_limited(weight_squared(density) * state.weights.before);
        weight = bidirectional_weight(0u, state.walk.depth + 2u, others);
    }
    bidirectional_add(state, state.walk.throughput * radiance * weight, state.walk.depth);
}

SHADING_FN void bidirectional_add_visible_lights(SHADING_INOUT(BidirectionalState) state, float distance) {
    for (uint i = 0u; i < kernel_frame().visible_light_count; ++i) {
        const uint index = fetch_visible_light(i);
        SHADING_IN(LightData) light = fetch_light(index);
        const float t = any_light_intersect(light, state.walk.origin, state.walk.direction);
        if (t >= 0.0f && t < distance) {
            const uint emitter = fetch_light_emitter(index);
            const float next_event =
                any_light_pdf(light, state.walk.scatter_origin, state.walk.direction) *
                kernel_selection_probability(fetch_emitter(emitter), state.walk.scatter_origin, state.walk.scatter_normal);
            bidirectional_add_met(state, any_light_radiance(light, state.walk.direction), next_event,
                                  kernel_emission_density(emitter, vec3(0.0f), -state.walk.direction));
        }
    }
}

SHADING_FN void bidirectional_add_sky(SHADING_INOUT(BidirectionalState) state) {
    const uint image = kernel_frame().sky_emitter;
    const float density = kernel_emission_density(image != kernel_no_emitter ? image : kernel_constant_sky, vec3(0.0f), -state.walk.direction);
    bidirectional_add_met(state, kernel_sky_radiance(state.walk.direction), kernel_sky_pdf(state.walk.direction), density);
}

SHADING_FN void bidirectional_add_emission(SHADING_INOUT(BidirectionalState) state, SHADING_IN(KernelPoint) point, vec3 emission) {
    uint emitter = fetch_first_emitter(point.instance);
    float density = 0.0f;
    if (emitter != kernel_no_emitter) {
        if (fetch_emitter(emitter).kind == kernel_emitter_triangle) {
            emitter += point.primitive;
        }
        density = kernel_emission_density(emitter, point.geometric_normal, -state.walk.direction);
    }
    bidirectional_add_met(state, emission, kernel_hit_pdf(point, state.walk.scatter_origin, state.walk.scatter_normal), density);
}

/// Next-event estimation at the camera subpath's vertex in hand.
SHADING_FN bool bidirectional_sample_emitters(SHADING_INOUT(BidirectionalState) state) {
    const uint event = state.vertex.events - 1u;
    const vec3 side = vertex_light_side(state.vertex, state.vertex.toward);
    const KernelLightSample light = kernel_sample_emitters(state.vertex.position, side, path_random_pair(state.walk, event, 1u).x,
                                                           path_random_pair(state.walk, event, 2u));
    if (max_component(light.light) <= 0.0f) {
        return false;
    }
    const VertexScattering scattering = vertex_scattering(state.vertex, light.direction);
    if (max_component(scattering.value) <= 0.0f) {
        return false;
    }
    const bool delta = light.pdf <= 0.0f;
    const float next_event =
        delta ? kernel_selection_probability(fetch_emitter(light.emitter), state.vertex.position, side) : light.pdf;
    const float others_light = delta ? 0.0f : weight_squared(scattering.pdf / next_event);
    const float squared = delta && light.distance < kernel_infinity ? light.distance * light.distance : 1.0f;
    const float density = kernel_emission_density(light.emitter, kernel_emitter_normal(light.emitter, light.target), -light.direction);
    const float into = density * vertex_cosine(state.vertex, light.direction) / (squared * next_event);
    const float back = vertex_scattering_towards(state.vertex, light.direction, state.vertex.toward).pdf;
    const float others = others_light + weight_of_others(state.vertex.weights, into, back);
    const vec3 gathered = state.vertex.throughput * scattering.value * light.light *
                          bidirectional_transmittance(state, light.direction, light.distance) *
                          bidirectional_weight(1u, state.vertex.events + 1u, others);
    kernel_aim_shadow(state.walk, state.vertex.position, state.vertex.error, state.vertex.geometric_normal, light, gathered);
    state.shadow_events = state.vertex.events;
    return true;
}

/// Joins the camera subpath's vertex in hand with one of the light subpath's.
SHADING_FN bool bidirectional_connect(SHADING_INOUT(BidirectionalState) state, SHADING_IN(SubpathVertex) y) {
    const vec3 path = y.position - state.vertex.position;
    const float squared = dot(path, path);
    if (squared <= 0.0f) {
        return false;
    }
    const vec3 direction = path * inversesqrt(squared);
    const VertexScattering at_camera = vertex_scattering(state.vertex, direction);
    if (max_component(at_camera.value) <= 0.0f) {
        return false;
    }
    const VertexScattering at_light = vertex_scattering_towards(y, -direction, y.toward);
    if (max_component(at_light.value) <= 0.0f) {
        return false;
    }
    const float camera_cosine = vertex_cosine(state.vertex, direction);
    const float light_cosine = vertex_cosine(y, direction);
    const float from_light = vertex_scattering(y, -direction).pdf;
    const float back = vertex_scattering_towards(state.vertex, direction, state.vertex.toward).pdf;
    const float others = weight_of_others(y.weights, at_camera.pdf * light_cosine / squared, at_light.pdf) +
                         weight_of_others(state.vertex.weights, from_light * camera_cosine / squared, back);
    const vec3 light = state.vertex.throughput * at_camera.value * y.throughput * at_light.value *
                       bidirectional_transmittance(state, direction, sqrt(squared)) *
                       (light_cosine / (squared * max(vertex_cosine(y, y.toward), 1.0e-10f)) *
                        bidirectional_weight(y.events + 1u, state.vertex.events + 1u, others));
    if (max_component(light) <= 0.0f) {
        return false;
    }
    bidirectional_cast_shadow(state, direction, kernel_offset(y.position, y.error, y.geometric_normal, -direction), light,
                              y.events + state.vertex.events);
    return true;
}

SHADING_FN void bidirectional_go_on_from_camera(SHADING_INOUT(BidirectionalState) state) {
    while (state.next_light_vertex < state.light_vertices && !bidirectional_too_deep(state.vertex.events + state.next_light_vertex + 1u)) {
        state.next_light_vertex += 1u;
        if (bidirectional_connect(state, fetch_light_vertex(state.slot, state.next_light_vertex - 1u))) {
            return;
        }
    }
    bidirectional_scatter(state);
}

SHADING_FN void bidirectional_take_camera_hit(SHADING_INOUT(BidirectionalState) state, SHADING_IN(KernelHit) hit) {
    if (hit.kind != kernel_hit_surface) {
        bidirectional_add_visible_lights(state, 2.0f * kernel_infinity);
        bidirectional_add_sky(state);
        state.walk.stage = kernel_stage_done;
        return;
    }
    bidirectional_add_visible_lights(state, hit.t);
    const KernelPoint point = kernel_point(hit);
    SHADING_IN(MaterialData) material = fetch_material(point.material);
    if (kernel_pass_through(state.walk, point, material)) {
        return;
    }
    const bool back = dot(state.walk.direction, point.geometric_normal) >= 0.0f && (material.flags & material_flag_two_sided) == 0u;
    const MaterialPoint at = kernel_material(hit, point, material, true);
    if (state.walk.depth == 0u && back && at.surface.inside && is_extended(at.surface)) {  // the camera is in the solid
        state.walk.throughput = state.walk.throughput * kernel_solid_transmittance(at.surface.absorption, hit.t);
    }
    if (!back && max_component(at.emission) > 0.0f) {
        bidirectional_add_emission(state, point, at.emission);
    }
    state.walk.stage = kernel_stage_done;
    if (bidirectional_too_deep(state.walk.depth + 1u) || !bidirectional_arrive(state, hit, point, material, at)) {
        return;
    }
    state.next_light_vertex = 0u;
    if (kernel_frame().emitter_count == 0u || !bidirectional_sample_emitters(state)) {
        bidirectional_go_on_from_camera(state);
    }
}

// -- the state machine

/// One sample of pixel (x, y), counted from the top left.
SHADING_FN BidirectionalState bidirectional_begin(uint x, uint y, uint sample_index, uint slot) {
    BidirectionalState state;
    state.pixel = y * kernel_frame().width + x;
    state.sample_index = sample_index;
    state.slot = slot;
    state.phase = bidirectional_phase_light;
    state.light_vertices = 0u;
    state.next_light_vertex = 0u;
    state.shadow_events = 0u;
    state.shadow_pixel = bidirectional_no_pixel;
    state.splat_pixel = bidirectional_no_pixel;
    state.splat_light = vec3(0.0f);
    state.weights.last = 0.0f;
    state.weights.before = 0.0f;
    state.walk = path_begin(x, y, sample_index);
    state.walk.pixel_seed = kernel_hash_combine(state.walk.pixel_seed, 1u);  // a stream of its own
    if (emission_count() == 0u) {
        bidirectional_begin_camera(state);
        return state;
    }
    state.emitted = kernel_sample_emission(bidirectional_random_pair(state, 0u, 1u), bidirectional_random_pair(state, 0u, 2u),
                                           bidirectional_random_pair(state, 0u, 3u));
    state.walk.origin = state.emitted.origin;
    state.walk.scatter_origin = state.emitted.origin;
    state.walk.direction = state.emitted.direction;
    state.walk.throughput = state.emitted.light;
    state.walk.eta_scale = max_component(state.emitted.light);  // Russian roulette counts from what set out
    if (state.walk.eta_scale <= 0.0f) {
        bidirectional_begin_camera(state);
    }
    return state;
}

SHADING_FN void bidirectional_take_hit(SHADING_INOUT(BidirectionalState) state, SHADING_IN(KernelHit) hit) {
    const bool from_light = state.phase == bidirectional_phase_light;
    state.splat_pixel = bidirectional_no_pixel;
    if (state.walk.stage == kernel_stage_scatter) {
        if (max_component(state.walk.absorption) > 0.0f) {
            state.walk.throughput =
                state.walk.throughput *
                kernel_solid_transmittance(state.walk.absorption, hit.kind == kernel_hit_surface ? hit.t : kernel_infinity);
        }
        if (from_light) {
            bidirectional_take_light_hit(state, hit);
        } else {
            bidirectional_take_camera_hit(state, hit);
        }
        return;
    }
    bool arrived;
    if (kernel_shadow_goes_on(state.walk, hit, arrived)) {
        return;  // the same stage again
    }
    if (from_light) {
        if (arrived) {
            state.splat_pixel = state.shadow_pixel;
            state.splat_light = state.walk.shadow_light;
        }
        bidirectional_go_on_from_light(state);
    } else {
        if (arrived) {
            bidirectional_add(state, state.walk.shadow_light, state.shadow_events);
        }
        bidirectional_go_on_from_camera(state);
    }
}

#endif
