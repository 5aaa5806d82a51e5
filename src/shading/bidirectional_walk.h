// Part of bidirectional_kernel.h (see there how it is included): the camera, and what subpaths from both sides share.
#ifndef HELIODON_SHADING_BIDIRECTIONAL_WALK_H
#define HELIODON_SHADING_BIDIRECTIONAL_WALK_H

/// Weight of the strategy with so many vertices on either side, beside what the others sum up to.
SHADING_FN float bidirectional_weight(uint light_vertices, uint camera_vertices, float others) {
    const uvec2 only = fetch_only_strategy();
    if (only.x == bidirectional_any && only.y == bidirectional_any) {
        return 1.0f / (1.0f + others);
    }
    return (only.x == bidirectional_any || only.x == light_vertices) && (only.y == bidirectional_any || only.y == camera_vertices)
               ? 1.0f
               : 0.0f;
}

SHADING_FN bool bidirectional_too_deep(uint events) { return kernel_frame().max_depth != 0u && events > kernel_frame().max_depth; }

/// Numbers of the subpath under way, as path_random_pair has them. The camera's are its pixel's own sequence. Light
/// subpaths of all pixels reach all pixels: theirs are one sequence over the samples, moved in each pixel by a digital
/// shift taken from a second one over the pixels. Exclusive or keeps a net a net: a pixel's subpaths fill the square
/// evenly, and so do those of one sample of the whole picture.
SHADING_FN vec2 bidirectional_random_pair(SHADING_IN(BidirectionalState) state, uint event, uint pair) {
    if (state.phase == bidirectional_phase_camera) {
        return path_random_pair(state.walk, event, pair);
    }
    const uint streams = kernel_frame().sample_streams;
    const uint stream = state.sample_index % streams;
    const uint seed = kernel_hash_combine(kernel_hash(kernel_frame().seed), 0x6c696768u + stream) + (4u * event + pair) * 0x9e3779b9u;
    const vec2 of_sample = kernel_sample_pair(kernel_reverse_bits(state.sample_index / streams), seed);
    const vec2 of_pixel = kernel_sample_pair(kernel_reverse_bits(state.pixel), kernel_hash(seed));
    const float steps = 16777216.0f;  // of kernel_unit_float
    return vec2(float(uint(of_sample.x * steps) ^ uint(of_pixel.x * steps)), float(uint(of_sample.y * steps) ^ uint(of_pixel.y * steps))) / steps;
}

// -- the camera

/// Density per steradian of a pixel's rays at `cosine` to the camera's axis: even over the picture's plane.
SHADING_FN float camera_pdf(float cosine) {
    const float pixel = 4.0f * length(kernel_frame().camera_right) * length(kernel_frame().camera_up) /
                        (float(kernel_frame().width) * float(kernel_frame().height));
    return 1.0f / (pixel * cosine * cosine * cosine);
}
/// Light subpaths a pixel: each pixel traces one, and each may reach any pixel.
SHADING_FN float bidirectional_light_paths() { return float(kernel_frame().width) * float(kernel_frame().height); }

/// The pixel that the camera sees in `direction`.
SHADING_FN uint camera_pixel(vec3 direction) {
    const float forward = dot(direction, kernel_frame().camera_forward);
    if (forward <= 0.0f) {
        return bidirectional_no_pixel;
    }
    const vec3 right = kernel_frame().camera_right;
    const vec3 up = kernel_frame().camera_up;
    const float across = 0.5f + 0.5f * dot(direction, right) / (forward * dot(right, right));
    const float down = 0.5f - 0.5f * dot(direction, up) / (forward * dot(up, up));
    if (across < 0.0f || across >= 1.0f || down < 0.0f || down >= 1.0f) {
        return bidirectional_no_pixel;
    }
    const uint x = min(uint(across * float(kernel_frame().width)), kernel_frame().width - 1u);
    const uint y = min(uint(down * float(kernel_frame().height)), kernel_frame().height - 1u);
    return y * kernel_frame().width + x;
}

/// The light subpath has ended: the camera's begins.
SHADING_FN void bidirectional_begin_camera(SHADING_INOUT(BidirectionalState) state) {
    state.phase = bidirectional_phase_camera;
    state.walk = path_begin(state.pixel % kernel_frame().width, state.pixel / kernel_frame().width, state.sample_index);
    const float pdf = camera_pdf(dot(state.walk.direction, kernel_frame().camera_forward));
    state.weights.last = weight_squared(bidirectional_light_paths() / pdf);
    state.weights.before = 0.0f;
}

// -- rays

/// What a solid leaves of light on its way of `distance` metres from the vertex in hand.
SHADING_FN vec3 bidirectional_transmittance(SHADING_IN(BidirectionalState) state, vec3 direction, float distance) {
    const vec3 absorption = vertex_absorption(state.vertex, direction);
    return max_component(absorption) > 0.0f ? kernel_solid_transmittance(absorption, distance) : vec3(1.0f);
}

/// A shadow ray from the vertex in hand to `target`, for light that completes a path of `events` scattering events.
SHADING_FN void bidirectional_cast_shadow(SHADING_INOUT(BidirectionalState) state, vec3 direction, vec3 target, vec3 light, uint events) {
    KernelLightSample aim;
    aim.direction = direction;
    aim.distance = 0.0f;
    aim.target = target;
    kernel_aim_shadow(state.walk, state.vertex.position, state.vertex.error, state.vertex.geometric_normal, aim, light);
    state.shadow_events = events;
}

/// Goes on from the vertex in hand; the walk is done where it does not.
SHADING_FN void bidirectional_scatter(SHADING_INOUT(BidirectionalState) state) {
    const bool from_camera = state.phase == bidirectional_phase_camera;
    const uint events = state.vertex.events;
    const uint event = from_camera ? events - 1u : events;  // a light subpath's event 0 is its emission
    state.walk.stage = kernel_stage_done;
    if (bidirectional_too_deep(events + 1u) && (!from_camera || kernel_frame().scattered_emission == 0u)) {
        return;
    }
    const vec2 u = bidirectional_random_pair(state, event, 3u);
    const float u_lobe = bidirectional_random_pair(state, event, 1u).y;
    const Frame frame = surface_frame(state.vertex.surface, state.vertex.shading_normal);
    const vec3 toward = state.vertex.toward;
    const BsdfSample scattered = bsdf_sample_prepared(state.vertex.surface, state.vertex.lobes, to_local(frame, toward), vec3(u, u_lobe));
    if (scattered.pdf <= 0.0f) {
        return;
    }
    const vec3 direction = to_world(frame, scattered.direction);
    const vec3 geometric = dot(toward, state.vertex.geometric_normal) > 0.0f ? state.vertex.geometric_normal : -state.vertex.geometric_normal;
    if (same_side(direction, geometric, scattered.direction.z) <= 0.0f) {
        return;
    }
    const VertexScattering backward = vertex_scattering_towards(state.vertex, direction, toward);
    const float cosine = vertex_cosine(state.vertex, direction);
    vec3 throughput = state.vertex.throughput;
    if (from_camera) {
        throughput = throughput * scattered.weight;
        state.walk.eta_scale *= scattered.eta_scale;
    } else {
        // Veach 1997, eq. 5.19: light scatters by the shading normal but arrives and leaves by the geometric one.
        throughput = throughput * backward.value * (cosine / (max(vertex_cosine(state.vertex, toward), 1.0e-10f) * scattered.pdf));
    }
    if (max_component(throughput) <= 0.0f) {
        return;
    }
    // As in kernel_scatter.
    const float survival = min(3.0f * max_component(throughput) / state.walk.eta_scale, events < 8u ? 1.0f : 0.98f);
    if (survival < 1.0f) {
        if (bidirectional_random_pair(state, event + 1u, 0u).x >= survival) {
            return;
        }
        throughput = throughput / survival;
    }
    state.weights = weights_scattered(state.vertex.weights, scattered.pdf, backward.pdf, cosine);
    state.walk.throughput = throughput;
    state.walk.absorption = vertex_absorption(state.vertex, direction);
    state.walk.scatter_pdf = scattered.pdf;
    state.walk.scatter_origin = state.vertex.position;
    state.walk.scatter_normal = vertex_light_side(state.vertex, direction);
    state.walk.origin = kernel_offset(state.vertex.position, state.vertex.error, state.vertex.geometric_normal, direction);
    state.walk.direction = direction;
    state.walk.stage = kernel_stage_scatter;
}

/// Puts the walk's vertex in hand. False where nothing is scattered there. `at`: as seen from inside.
SHADING_FN bool bidirectional_arrive(SHADING_INOUT(BidirectionalState) state, SHADING_IN(KernelHit) hit, SHADING_IN(KernelPoint) point,
                                     SHADING_IN(MaterialData) material, SHADING_IN(MaterialPoint) at) {
    state.vertex.position = point.position;
    state.vertex.error = point.error;
    state.vertex.geometric_normal = point.geometric_normal;
    state.vertex.two_sided = material.flags & material_flag_two_sided;
    state.vertex.surface = at.surface;
    state.vertex.solid = at.surface.inside ? 1u : 0u;
    state.vertex.mapped_normal = kernel_mapped_normal(hit, point, material);
    state.vertex.events = state.walk.depth + 1u;
    state.vertex.throughput = state.walk.throughput;
    const vec3 path = point.position - state.walk.scatter_origin;
    state.vertex.weights = weights_arrived(state.weights, dot(path, path), vertex_cosine(state.vertex, state.walk.direction));
    state.walk.depth += 1u;
    return vertex_turn(state.vertex, -state.walk.direction);
}

#endif
