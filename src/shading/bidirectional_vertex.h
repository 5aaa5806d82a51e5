// Vertices of subpaths, and the partial sums from which the weights of bidirectional path tracing follow.
//
// What is scattered at a vertex is defined as the path tracer defines it, from the camera's side: the shading normal
// is bent, and inside and outside are told apart, for the direction that light leaves to. Light subpaths ask for
// that same value from the far side, so that both find one integrand whatever the shading normals do.
#ifndef HELIODON_SHADING_BIDIRECTIONAL_VERTEX_H
#define HELIODON_SHADING_BIDIRECTIONAL_VERTEX_H
#include "shading/bidirectional_state.h"
#include "shading/material_eval.h"
SHADING_BEGIN

/// Makes `surface` the vertex's as seen from `toward`, with the shading normal there. False where it scatters nothing
/// that way.
SHADING_FN bool vertex_seen(SHADING_IN(SubpathVertex) x, vec3 toward, SHADING_INOUT(Surface) surface, SHADING_OUT(vec3) normal) {
    bool front = dot(toward, x.geometric_normal) > 0.0f;
    bool inside = !front && x.two_sided == 0u;
    surface.inside = inside && x.solid != 0u;
    normal = x.geometric_normal;
    // The back of a one-sided surface is black; that of a transmissive solid is its inside.
    if ((inside && !surface.inside) || surface.model == material_model_unlit) {
        return false;
    }
    normal = usable_shading_normal(x.mapped_normal, front ? x.geometric_normal : -x.geometric_normal, toward);
    return dot(normal, toward) > 0.0f;
}
SHADING_FN bool vertex_turn(SHADING_INOUT(SubpathVertex) x, vec3 toward) {
    vec3 normal;
    bool scatters = vertex_seen(x, toward, x.surface, normal);
    x.toward = toward;
    x.shading_normal = normal;
    if (scatters) {
        x.lobes = bsdf_prepare(x.surface, to_local(surface_frame(x.surface, normal), toward));
    }
    return scatters;
}

/// Light from `other` to `toward`, of which `surface`, `lobes` and `normal` are; the density is that of sampling `other`.
SHADING_FN VertexScattering vertex_evaluate(vec3 geometric_normal, SHADING_IN(Surface) surface, SHADING_IN(BsdfLobes) lobes, vec3 normal,
                                            vec3 toward, vec3 other) {
    VertexScattering result;
    result.value = vec3(0.0f);
    result.pdf = 0.0f;
    Frame frame = surface_frame(surface, normal);
    vec3 wi = to_local(frame, other);
    if (same_side(other, dot(toward, geometric_normal) > 0.0f ? geometric_normal : -geometric_normal, wi.z) > 0.0f) {
        vec3 wo = to_local(frame, toward);
        result.value = bsdf_evaluate_prepared(surface, lobes, wo, wi);
        result.pdf = bsdf_pdf_prepared(surface, lobes, wo, wi);
    }
    return result;
}
SHADING_FN VertexScattering vertex_scattering(SHADING_IN(SubpathVertex) x, vec3 other) {
    return vertex_evaluate(x.geometric_normal, x.surface, x.lobes, x.shading_normal, x.toward, other);
}
/// The same, looked at from `viewer`.
SHADING_FN VertexScattering vertex_scattering_towards(SHADING_IN(SubpathVertex) x, vec3 viewer, vec3 other) {
    Surface surface = x.surface;
    vec3 normal;
    if (!vertex_seen(x, viewer, surface, normal)) {
        VertexScattering black;
        black.value = vec3(0.0f);
        black.pdf = 0.0f;
        return black;
    }
    BsdfLobes lobes = bsdf_prepare(surface, to_local(surface_frame(surface, normal), viewer));
    return vertex_evaluate(x.geometric_normal, surface, lobes, normal, viewer, other);
}
/// What absorbs light, in 1/m, on the side of the vertex that `direction` points to.
SHADING_FN vec3 vertex_absorption(SHADING_IN(SubpathVertex) x, vec3 direction) {
    bool within = is_extended(x.surface) && x.solid != 0u && x.two_sided == 0u && dot(direction, x.geometric_normal) < 0.0f;
    return within ? x.surface.absorption : vec3(0.0f);
}

/// The normal that light sampling aims by (kernel_sample_emitters) for light from `direction`: as kernel_light_side,
/// but of what is the same from wherever the vertex is looked at.
SHADING_FN vec3 vertex_light_side(SHADING_IN(SubpathVertex) x, vec3 direction) {
    if (x.surface.transmission > 0.0f) {
        return vec3(0.0f);
    }
    bool across = dot(x.mapped_normal, x.geometric_normal) * dot(direction, x.geometric_normal) < 0.0f;
    return across ? -x.mapped_normal : x.mapped_normal;
}

/// |cos| of the angle to the geometric normal: what solid angles and areas are converted by.
SHADING_FN float vertex_cosine(SHADING_IN(SubpathVertex) x, vec3 direction) { return abs(dot(x.geometric_normal, direction)); }

// -- weights

/// Keeps products of ratios of densities finite: strategies so much better leave no weight to others anyway.
SHADING_FN float weight_limited(float value) { return min(value, 1.0e30f); }
SHADING_FN float weight_squared(float ratio) { return weight_limited(ratio * ratio); }

/// The other strategies' share beside one that joins subpaths at the vertex: `into` is the density per m² with which
/// the other subpath would find the vertex, `back` that per steradian of its then going on to the vertex before.
SHADING_FN float weight_of_others(PartialWeights weights, float into, float back) {
    return weight_squared(into) * weight_limited(weights.last + weight_squared(back) * weights.before);
}
/// For the ray scattered with density `pdf` at an angle of `cosine` to the geometric normal.
SHADING_FN PartialWeights weights_scattered(PartialWeights weights, float pdf, float back, float cosine) {
    PartialWeights result;
    result.last = weight_squared(1.0f / pdf);
    result.before = weight_limited(weight_squared(cosine / pdf) * weight_limited(weights.last + weight_squared(back) * weights.before));
    return result;
}
/// For the vertex that the ray finds at the squared distance `squared`, at an angle of `cosine` to its normal.
SHADING_FN PartialWeights weights_arrived(PartialWeights weights, float squared, float cosine) {
    float by_angle = weight_squared(1.0f / max(cosine, 1.0e-10f));
    PartialWeights result;
    result.last = weight_limited(weights.last * weight_limited(squared * squared * by_angle));
    result.before = weight_limited(weights.before * by_angle);
    return result;
}
/// For the first vertex of a light subpath: `next_event` = kernel_next_event_pdf from there, `density` =
/// kernel_emission_density; `squared` is the squared distance from a light without extent, else 1.
SHADING_FN PartialWeights weights_lit(float next_event, float density, float squared, float cosine, bool delta) {
    float inverse = squared / max(density * cosine, 1.0e-30f);
    PartialWeights result;
    result.last = weight_squared(next_event * inverse);
    result.before = delta ? 0.0f : weight_squared(inverse);
    return result;
}

SHADING_END
#endif
