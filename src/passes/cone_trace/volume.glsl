// Cones through the voxel volume (docs/gi-theory.md).
//
// Along each axis the volume is a stack of layers. What a layer's faces show stands in the middle of the layer, and a
// cone that passes the middle meets it: it takes the share of the cover that nothing before it took. So a wall is met
// exactly once, at whatever angle and whatever levels the cone goes through: nothing leaks, nothing counts twice.
#ifndef HELIODON_VOLUME_GLSL
#define HELIODON_VOLUME_GLSL
#include "passes/cone_trace/volume_shared.h"

layout(set = 0, binding = 20) uniform sampler3D voxel_faces_texture;
layout(set = 0, binding = 21, std430) readonly buffer Volume_ { VolumeData volume; };

/// World to the lattice of the finest voxels.
vec3 to_lattice(vec3 world) { return (world - volume.lattice) / volume.voxel_m; }

/// The face that a ray sees of layer `layer` (of its level) of the axis that `axis` is 1 for, where the ray passes it
/// at `position` in the lattice: rgb radiance × cover in units of the volume, a cover. Linear across the layer.
vec4 layer_face(vec3 position, vec3 axis, float layer, bool sees_positive, float level) {
    const float cascade = min(level, float(volume.cascades - 1u));
    const float mip = level - cascade;
    const float size = exp2(-mip) * float(volume.size);
    vec3 at = position * exp2(-level) - vec3(volume.cascade[uint(cascade)].base) * exp2(-mip);
    const float middle = layer + 0.5f - dot(axis, vec3(volume.cascade[uint(cascade)].base)) * exp2(-mip);
    at = mix(at, vec3(middle), axis);
    at = clamp(at, vec3(0.5f), vec3(size - 0.5f));
    at += size * vec3(sees_positive ? 0.0f : 1.0f, cascade, axis.y + 2.0f * axis.z);
    return textureLod(voxel_faces_texture, at / (size * vec3(2.0f, float(volume.cascades), 3.0f)), mip);
}

struct ConeResult {
    vec3 radiance;  // cd/m² × cover
    float cover;
};

/// The finest level whose cascade holds the position.
float level_holding(vec3 position) {
    float level = 0.0f;
    for (uint c = 0u; c + 1u < volume.cascades; ++c) {
        const vec3 at = position * exp2(-float(c)) - vec3(volume.cascade[c].base);
        if (all(greaterThanEqual(at, vec3(1.0f))) && all(lessThanEqual(at, vec3(float(volume.size) - 1.0f)))) break;
        level += 1.0f;
    }
    return level;
}

/// `origin` and `reach` in finest voxels; `direction` unit.
ConeResult trace_cone(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeResult result = ConeResult(vec3(0.0f), 0.0f);
    const bvec3 forward = greaterThan(direction, vec3(0.0f));
    const vec3 inverse = 1.0f / mix(direction, mix(vec3(-1.0e-12f), vec3(1.0e-12f), forward), lessThan(abs(direction), vec3(1.0e-12f)));
    const uint last = volume.cascades - 1u;
    const vec3 low = vec3(volume.cascade[last].base) * exp2(float(last));
    const vec3 high = low + exp2(float(last)) * float(volume.size);
    const vec3 exits = (mix(low, high, forward) - origin) * inverse;
    const float end = min(reach, min(exits.x, min(exits.y, exits.z)));
    const float coarsest = float(last) + log2(float(volume.size)) - 1.0f;

    const vec3 step = mix(vec3(-1.0f), vec3(1.0f), forward);
    vec3 level = vec3(level_holding(origin));
    vec3 edge = exp2(level);
    vec3 layer = mix(floor(origin / edge - 0.5f), ceil(origin / edge - 0.5f), forward);
    vec3 next = ((layer + 0.5f) * edge - origin) * inverse;
    while (true) {
        const float t = min(next.x, min(next.y, next.z));
        if (!(t <= end)) break;
        // The axis whose layer comes first; of several, one.
        const vec3 axis = next.x <= t ? vec3(1.0f, 0.0f, 0.0f) : next.y <= t ? vec3(0.0f, 1.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f);
        const vec3 position = origin + direction * t;
        const float here = dot(axis, level);
        const vec4 face = layer_face(position, axis, dot(axis, layer), dot(axis, direction) < 0.0f, here);
        if (face.a > 0.0f) {
            const float gained = min(face.a, 1.0f - result.cover);
            result.radiance += face.rgb * (gained / face.a);
            result.cover += gained;
            if (result.cover >= 0.999f) break;
        }
        layer += axis * step;
        // A voxel's edge is the cone's radius, to the nearest level. An axis goes to the coarser level where its next
        // layer begins one there, so that each of its layers counts once.
        float wanted = min(max(floor(log2(max(t * tan_half_angle, 1.0f)) + 0.5f), here), coarsest);
        if (volume.cascades > 1u) wanted = max(wanted, level_holding(position));
        const float index = dot(axis, layer);
        const bool even = fract(0.5f * index) < 0.25f;
        if (wanted > here && even == (dot(axis, step) > 0.0f)) {
            level += axis;
            edge += axis * edge;
            layer = mix(layer, floor(0.5f * layer), axis);
        }
        next = mix(next, ((layer + 0.5f) * edge - origin) * inverse, axis);
    }
    result.radiance *= volume.radiance_unit;
    return result;
}

#endif
