// Part of path_kernel.h (see there how it is included): one scattering event, its light sample and its scattered rays.
#ifndef HELIODON_SHADING_KERNEL_SCATTER_H
#define HELIODON_SHADING_KERNEL_SCATTER_H

/// What a solid leaves of light after `distance` metres: Beer & Lambert.
SHADING_FN vec3 kernel_solid_transmittance(vec3 absorption, float distance) { return exp(absorption * -distance); }

/// Where light sampling may look for light: on the shading normal's side, unless light also passes the surface.
SHADING_FN vec3 kernel_light_side(SHADING_IN(Surface) surface, vec3 normal) {
    return surface.transmission > 0.0f ? vec3(0.0f) : normal;
}

/// Makes the shadow ray to a light sample the next one; `arriving` is what reaches the path if nothing blocks it.
SHADING_FN void kernel_aim_shadow(SHADING_INOUT(PathState) path, vec3 position, vec3 error, vec3 geometric,
                                  SHADING_IN(KernelLightSample) light, vec3 arriving) {
    path.shadow_light = arriving;
    path.shadow_origin = kernel_offset(position, error, geometric, light.direction);
    path.shadow_direction = light.direction;
    path.shadow_t_max = kernel_infinity;
    if (light.distance < kernel_infinity) {
        const vec3 segment = light.target - path.shadow_origin;
        const float length_m = length(segment);
        path.shadow_direction = segment / max(length_m, 1.0e-37f);
        path.shadow_t_max = length_m * (1.0f - 1.0e-6f);  // the rounding of origin + t · direction
    }
    path.stage = kernel_stage_shadow;
}

SHADING_FN void kernel_sample_direct(SHADING_INOUT(PathState) path, vec3 position, vec3 error, vec3 geometric, vec3 normal,
                                     SHADING_IN(Frame) frame, SHADING_IN(Surface) surface, SHADING_IN(BsdfLobes) lobes, vec3 wo,
                                     float branches, float u_select, vec2 u) {
    const KernelLightSample light = kernel_sample_emitters(position, kernel_light_side(surface, normal), u_select, u);
    if (max_component(light.light) <= 0.0f) {
        return;
    }
    const vec3 wi = to_local(frame, light.direction);
    const float side = same_side(light.direction, geometric, wi.z);
    if (side <= 0.0f) {
        return;
    }
    const vec3 value = bsdf_evaluate_prepared(surface, lobes, wo, wi);
    if (max_component(value) <= 0.0f) {
        return;
    }
    float weight = 1.0f;
    if (light.pdf > 0.0f) {
        weight = power_heuristic(light.pdf, branches * bsdf_pdf_prepared(surface, lobes, wo, wi));
    }
    vec3 arriving = path.throughput * value * light.light * weight;
    if (is_extended(surface) && surface.inside != (wi.z < 0.0f)) {  // a light within the solid
        arriving = arriving * kernel_solid_transmittance(surface.absorption, light.distance);
    }
    kernel_aim_shadow(path, position, error, geometric, light, arriving);
}

/// Keeps a direction in which the path leaves its first surface; `share`: of the light that all of them bring.
SHADING_FN void kernel_push_branch(SHADING_INOUT(PathState) path, SHADING_IN(Surface) surface, SHADING_IN(BsdfSample) scattered,
                                   vec3 direction, float share) {
    PathBranch branch;
    branch.direction = direction;
    branch.scatter_pdf = scattered.pdf / share;
    branch.throughput = path.throughput * scattered.weight * share;
    branch.eta_scale = path.eta_scale * scattered.eta_scale;
    branch.absorption = is_extended(surface) && surface.inside != scattered.transmitted ? surface.absorption : vec3(0.0f);
    branch.sample_reversed = path.sample_reversed;
    path.branch3 = path.branch2;
    path.branch2 = path.branch1;
    path.branch1 = path.branch0;
    path.branch0 = branch;
    path.branches_left += 1u;
}

/// Where a path has ended: goes on with the next of its branches, if there is one left.
SHADING_FN void kernel_next_branch(SHADING_INOUT(PathState) path) {
    if (path.branches_left == 0u) {
        return;
    }
    const PathBranch branch = path.branch0;
    path.branch0 = path.branch1;
    path.branch1 = path.branch2;
    path.branch2 = path.branch3;
    path.branches_left -= 1u;
    path.branches_begun += 1u;
    path.sample_reversed = branch.sample_reversed;
    path.origin = kernel_offset(path.first_position, path.first_error, path.first_geometric, branch.direction);
    path.direction = branch.direction;
    path.throughput = branch.throughput;
    path.scatter_pdf = branch.scatter_pdf;
    path.scatter_origin = path.first_position;
    path.scatter_normal = path.first_light_side;
    path.eta_scale = branch.eta_scale;
    path.absorption = branch.absorption;
    // Errors are seen relative to the pixel, which the first surface darkens as it does the branch: the weight that roulette
    // judges is 1 here. Factors from 1 to 2 are as good as each other in a Cornell box and in Sponza (docs/performance.md).
    path.roulette = 1.5f * branch.eta_scale / max_component(branch.throughput);
    path.depth = 1u;
    path.stage = kernel_stage_scatter;
}

/// The path goes on from a later surface in one direction, if roulette lets it.
SHADING_FN void kernel_go_on(SHADING_INOUT(PathState) path, vec3 position, vec3 error, vec3 geometric, vec3 light_side,
                             SHADING_IN(Surface) surface, SHADING_IN(BsdfSample) scattered, vec3 direction) {
    vec3 throughput = path.throughput * scattered.weight;
    const float eta_scale = path.eta_scale * scattered.eta_scale;
    // Russian roulette (Arvo & Kirk 1990), blind to the radiance scaling of refraction, which later leaving the medium undoes.
    const float most = path.depth < 8u ? 1.0f : 0.98f;  // where nothing absorbs, paths end all the same
    const float survival = min(path.roulette * max_component(throughput) / eta_scale, most);
    if (survival < 1.0f) {
        if (path_random_first(path, path.depth, 0u) >= survival) {
            return;
        }
        throughput = throughput / survival;
    }
    // The shadow ray still carries the light of the event itself in shadow_light.
    path.throughput = throughput;
    if (is_extended(surface) && (surface.inside || scattered.transmitted)) {
        path.absorption = surface.inside != scattered.transmitted ? surface.absorption : vec3(0.0f);
    }
    path.eta_scale = eta_scale;
    path.scatter_pdf = scattered.pdf;
    path.scatter_origin = position;
    path.scatter_normal = light_side;
    path.origin = kernel_offset(position, error, geometric, direction);
    path.direction = direction;
    path.after_shadow = kernel_stage_scatter;
    if (path.stage == kernel_stage_done) {
        path.stage = kernel_stage_scatter;
    }
}

/// One scattering event: a light sample, whose shadow ray comes first, and scattered rays: from the first surface
/// 2^branch_bits, whose random numbers are as many points of the sequence in a row, so that they fill each other's gaps.
/// Together those are one technique with that many samples (Veach 1997, section 9.2). `geometric` is the side of the surface
/// that `wo_world` is on.
SHADING_FN void kernel_scatter(SHADING_INOUT(PathState) path, vec3 position, vec3 error, vec3 geometric, vec3 normal,
                               SHADING_IN(Surface) surface, vec3 wo_world) {
    const uint event = path.depth;
    path.depth += 1u;
    const bool last = kernel_frame().max_depth != 0u && path.depth >= kernel_frame().max_depth;
    const Frame frame = surface_frame(surface, normal);
    const vec3 wo = to_local(frame, wo_world);
    path.stage = kernel_stage_done;
    path.after_shadow = kernel_stage_done;
    if (wo.z <= 0.0f) {
        return;
    }
    const BsdfLobes lobes = bsdf_prepare(surface, wo);
    // Which emitter, and which lobe: where there is one of each, nothing is to be chosen.
    vec2 choices = vec2(0.0f);
    if (kernel_frame().emitter_count > 1u || surface.model != material_model_lambert) {
        choices = path_random_pair(path, event, 1u);
    }
    const uint bits = event == 0u ? kernel_frame().branch_bits : 0u;
    const uint branches = 1u << bits;
    if (kernel_frame().emitter_count > 0u) {
        kernel_sample_direct(path, position, error, geometric, normal, frame, surface, lobes, wo, float(branches), choices.x,
                             path_random_pair(path, event, 2u));
    }
    if (last && kernel_frame().scattered_emission == 0u) {
        return;
    }
    const vec3 light_side = kernel_light_side(surface, normal);
    if (event == 0u) {
        path.first_position = position;
        path.first_error = error;
        path.first_geometric = geometric;
        path.first_light_side = light_side;
    }
    const uint sample_reversed = path.sample_reversed;
    for (uint i = 0u; i < branches; ++i) {
        path.sample_reversed = (sample_reversed >> bits) | kernel_reverse_bits(i);
        if (bits > 0u && surface.model != material_model_lambert) {
            choices = path_random_pair(path, 1u, 0u);  // which no roulette uses here
        }
        const vec2 u = path_random_pair(path, event, 3u);
        const BsdfSample scattered = bsdf_sample_prepared(surface, lobes, wo, vec3(u, choices.y));
        const vec3 direction = to_world(frame, scattered.direction);
        const bool lost = scattered.pdf <= 0.0f || max_component(scattered.weight) <= 0.0f ||
                          same_side(direction, geometric, scattered.direction.z) <= 0.0f;
        if (!lost && event == 0u) {
            kernel_push_branch(path, surface, scattered, direction, 1.0f / float(branches));
        } else if (!lost) {
            kernel_go_on(path, position, error, geometric, light_side, surface, scattered, direction);
        }
    }
    path.sample_reversed = sample_reversed;
}

#endif
