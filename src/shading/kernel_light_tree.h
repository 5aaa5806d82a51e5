// Part of path_kernel.h (see there how it is included): selecting one of many lights by a tree of bounds (Conty
// Estevez & Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; one light an event).
#ifndef HELIODON_SHADING_KERNEL_LIGHT_TREE_H
#define HELIODON_SHADING_KERNEL_LIGHT_TREE_H

/// cos(max(0, a − b)) and sin(max(0, a − b)) of angles given by their (cosine, sine).
SHADING_FN vec2 kernel_angle_less(vec2 a, vec2 b) {
    if (a.x > b.x) {
        return vec2(1.0f, 0.0f);
    }
    return vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
}
SHADING_FN vec2 kernel_angle(float cosine) {
    const float c = clamp(cosine, -1.0f, 1.0f);
    return vec2(c, sqrt(max(0.0f, 1.0f - c * c)));
}

/// What a node's lights bring to `from` at most, as far as bounds can tell, in lux up to a factor that all nodes share; 0 only
/// where they bring nothing (Pharr, Jakob & Humphreys 2023, section 12.6.3). `normal` as kernel_sample_emitters takes it.
SHADING_FN float kernel_light_importance(SHADING_IN(KernelLightNode) node, vec3 from, vec3 normal) {
    const vec3 half_diagonal = (node.bounds_max - node.bounds_min) * 0.5f;
    const vec3 from_light = from - (node.bounds_min + half_diagonal);
    const float radius2 = dot(half_diagonal, half_diagonal);
    const float distance2 = dot(from_light, from_light);
    const vec3 direction = from_light * inversesqrt(max(distance2, 1.0e-37f));
    // The half-angle under which the sphere round the bounds appears: all around from within.
    const vec2 extent = distance2 <= radius2 ? vec2(-1.0f, 0.0f) : kernel_angle(sqrt(1.0f - radius2 / distance2));
    const float along = dot(node.axis, direction);
    const vec2 off_axis = kernel_angle((node.flags & kernel_light_node_two_sided) != 0u ? abs(along) : along);
    const vec2 off_normals = kernel_angle_less(kernel_angle_less(off_axis, kernel_angle(node.cos_normals)), extent);
    if (off_normals.x <= node.cos_emission) {
        return 0.0f;
    }
    // At least what the slack that bounds have against rounding (light_tree.cpp) needs to stay above 0.
    float importance = node.intensity * max(off_normals.x, 1.0e-3f) / max(distance2, max(radius2, 1.0e-37f));
    if (normal != vec3(0.0f)) {
        importance *= max(0.0f, kernel_angle_less(kernel_angle(-dot(normal, direction)), extent).x);
    }
    return importance;
}

/// Probability of taking the first of the two children at `first`; negative where neither lights `from`.
SHADING_FN float kernel_first_child_probability(uint first, vec3 from, vec3 normal) {
    const float a = kernel_light_importance(fetch_light_node(first), from, normal);
    const float b = kernel_light_importance(fetch_light_node(first + 1u), from, normal);
    return a + b > 0.0f ? a / (a + b) : -1.0f;
}

/// Walks from the root to an emitter; `probability` shrinks by that of each turn. kernel_no_emitter where bounds say
/// that nothing is lit.
SHADING_FN uint kernel_walk_light_tree(vec3 from, vec3 normal, float u, SHADING_INOUT(float) probability) {
    uint index = 0u;
    while ((fetch_light_node(index).flags & kernel_light_node_leaf) == 0u) {
        const uint first = fetch_light_node(index).child;
        const float share = kernel_first_child_probability(first, from, normal);
        if (share < 0.0f) {
            return kernel_no_emitter;
        }
        // Where in its share u fell is again uniform.
        if (u < share) {
            u = min(u / share, 0.99999994f);
            probability *= share;
            index = first;
        } else {
            u = min((u - share) / (1.0f - share), 0.99999994f);
            probability *= 1.0f - share;
            index = first + 1u;
        }
    }
    return fetch_light_node(index).child;
}

/// Probability with which kernel_walk_light_tree ends at the leaf `index`.
SHADING_FN float kernel_light_leaf_probability(uint index, vec3 from, vec3 normal) {
    float probability = 1.0f;
    while (index != 0u && probability > 0.0f) {
        // Children stand in pairs behind the root: the first at odd places.
        const bool second = (index & 1u) == 0u;
        const float share = kernel_first_child_probability(second ? index - 1u : index, from, normal);
        probability *= share < 0.0f ? 0.0f : second ? 1.0f - share : share;
        index = fetch_light_node(index).parent;
    }
    return probability;
}

#endif
