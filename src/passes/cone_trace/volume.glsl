// Cones through the voxel volume (docs/gi-theory.md).
//
// Along each axis the volume is a stack of layers. A cone that goes through a layer meets what the layer's faces show
// there once, at the depth where it stands: it takes the share of the cover that nothing before it took. So a wall is
// met exactly once, at whatever angle and whatever levels the cone goes through: nothing leaks, nothing counts twice.
#ifndef HELIODON_VOLUME_GLSL
#define HELIODON_VOLUME_GLSL
#include "passes/cone_trace/volume_shared.h"

layout(set = 0, binding = 20) uniform sampler3D voxel_faces_texture;
layout(set = 0, binding = 22) uniform sampler3D voxel_depths_texture;
layout(set = 0, binding = 21, std430) readonly buffer Volume_ { VolumeData volume; };

/// World to the lattice of the finest voxels.
vec3 to_lattice(vec3 world) { return (world - volume.lattice) / volume.voxel_m; }

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

/// Edge of the voxels that a surface's cones have to start past, by `lift` of them. Near a cascade's border it grows to the
/// next one's, so that cones that leave the cascade have risen past its voxels by then: a cone in the middle of the outer
/// of nine cells (diffuse_cone) rises 1/√3 on its way.
float surface_edge(vec3 start, float lift) {
    const float rise = 0.57735027f;
    float edge = 1.0f;
    for (uint c = 0u; c + 1u < volume.cascades; ++c) {
        const vec3 at = start * exp2(-float(c)) - vec3(volume.cascade[c].base);
        const vec3 inside = min(at, float(volume.size) - at) - 1.0f;
        const float border = min(inside.x, min(inside.y, inside.z));
        if (border >= 0.0f) return edge * (1.0f + max(0.0f, 1.0f - border * rise / lift));
        edge *= 2.0f;
    }
    return edge;
}

/// Where the cones of a surface start, in finest voxels: past the layers that the surface itself lies in. The middle of
/// a voxel that a plane of unit normal n passes lies within S/2 of it, S = |nx| + |ny| + |nz|. What the voxel shows along
/// axis a, linear interpolation spreads one voxel along the two other axes, S − |na| further; the faces show |na|/S of
/// the plane's area each, so on average over them the plane reaches 3S/2 − 1/S voxels. `least_edge`: of the voxels that
/// show the surface, if it is voxels that cones start from.
vec3 cone_origin(vec3 position, vec3 geometric, float least_edge) {
    const vec3 start = to_lattice(position);
    const float total = abs(geometric.x) + abs(geometric.y) + abs(geometric.z);
    const float lift = 1.5f * total - 1.0f / total;
    return start + geometric * (lift * max(least_edge, surface_edge(start, lift)));
}
vec3 cone_origin(vec3 position, vec3 geometric) { return cone_origin(position, geometric, 1.0f); }

/// Texture coordinates of a position in the lattice, on the first face of the cascade that has voxels of `edge`;
/// linear interpolation stays within the face.
vec3 face_coordinates(vec3 position, float edge, float level) {
    const float size = float(volume.size);
    vec3 at = position;
    float cascade = 0.0f;
    float texel = edge;
    if (volume.cascades > 1u) {
        cascade = min(level, float(volume.cascades - 1u));
        at = at * exp2(-cascade) - vec3(volume.cascade[uint(cascade)].base);
        texel *= exp2(-cascade);
    }
    at = clamp(at, vec3(0.5f * texel), vec3(size - 0.5f * texel));
    at.y += size * cascade;
    return at / (size * vec3(2.0f, float(volume.cascades), 3.0f));
}

// Cones that graze a layer at less than a quarter of its slope pass it too seldom to matter.
const float most_looks = 4.0f;

struct ConeResult {
    vec3 radiance;  // cd/m² × cover
    float cover;
};

/// `origin` and `reach` in finest voxels; `direction` unit.
ConeResult trace_cone(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeResult result = ConeResult(vec3(0.0f), 0.0f);
    // Each axis is walked forward: where the cone goes backward, in the lattice's mirror image. The lattice is as wide as
    // the widest cascade, whose voxels of every level mirror onto themselves.
    const float wide = exp2(float(volume.cascades - 1u)) * float(volume.size);
    const bvec3 backward = lessThan(direction, vec3(0.0f));
    const vec3 start = mix(origin, wide - origin, backward);
    const vec3 inverse = 1.0f / max(abs(direction), vec3(1.0e-12f));
    const vec3 entries = -start * inverse;
    const float begin = max(0.0f, max(entries.x, max(entries.y, entries.z)));
    const vec3 exits = (wide - start) * inverse;
    const float end = min(reach, min(exits.x, min(exits.y, exits.z)));
    const float coarsest = 0.5f * wide;  // edge of the voxels of the level before the last
    // A ray that goes forward sees what looks backward.
    const vec3 side = mix(vec3(0.5f), vec3(0.0f), backward);
    // A texel is the mean over its edge and interpolation spreads it by another: it reaches 3/2 edges to each side. Where
    // that is the cone's radius the level fits; an axis goes to the next one at √2 times it, to the nearest level.
    const float radius = tan_half_angle * (inversesqrt(2.0f) / 1.5f);

    vec3 level = vec3(level_holding(origin + direction * begin));
    vec3 edge = exp2(level);
    vec3 layer = floor((start + abs(direction) * begin) / edge);
    // A cone that grazes a layer goes far along it, and looks at it once a voxel, so that what stands at the layer's near
    // side is seen before the cone has passed it by.
    const vec3 size = abs(direction);
    const vec3 looks = clamp(ceil(max(size.yzx, size.zxy) * inverse), vec3(1.0f), vec3(most_looks));
    vec3 look = vec3(0.0f);
    vec3 next = max(((layer + 0.5f / looks) * edge - start) * inverse, vec3(begin));
    while (true) {
        const float t = min(next.x, min(next.y, next.z));
        if (!(t <= end)) break;
        // The axis whose layer's middle comes first; of several, one.
        const bool x = next.x <= t;
        const bool y = !x && next.y <= t;
        float axis_edge = x ? edge.x : y ? edge.y : edge.z;
        float axis_level = x ? level.x : y ? level.y : level.z;
        const vec3 position = origin + direction * t;
        if (volume.cascades > 1u && level_holding(position) > axis_level) {
            // Past its cascade an axis goes on in the layer of the next one that holds this layer, if it lies ahead.
            const bvec3 axis = bvec3(x, y, !x && !y);
            vec3 outer = floor(0.5f * layer);
            const vec3 middle = ((outer + 0.5f) * 2.0f * edge - start) * inverse;
            outer += mix(vec3(0.0f), vec3(1.0f), lessThan(middle, vec3(begin)));
            layer = mix(layer, outer, axis);
            edge = mix(edge, 2.0f * edge, axis);
            level = mix(level, level + 1.0f, axis);
            next = mix(next, ((layer + 0.5f) * edge - start) * inverse, axis);
            continue;
        }
        const vec3 corner = vec3(x ? side.x : y ? side.y : side.z, 0.0f, x ? 0.0f : y ? 1.0f / 3.0f : 2.0f / 3.0f);
        const float mip = axis_level - (volume.cascades > 1u ? min(axis_level, float(volume.cascades - 1u)) : 0.0f);
        // Along the axis a layer's texels are looked up in their middle, wherever the face stands: layers do not mix.
        const float here = x ? layer.x : y ? layer.y : layer.z;
        const bool turned = x ? backward.x : y ? backward.y : backward.z;
        const float forward_middle = (here + 0.5f) * axis_edge;
        const vec3 of_layer = vec3(turned ? wide - forward_middle : forward_middle);
        const bvec3 axis = bvec3(x, y, !x && !y);
        const vec3 at = corner + face_coordinates(mix(position, of_layer, axis), axis_edge, axis_level);
        vec4 face = textureLod(voxel_faces_texture, at, mip);
        if (face.a > 0.0f) {
            // Where the cone meets it, if it does ahead of its origin and within its reach.
            const float depth = clamp(textureLod(voxel_depths_texture, at, mip).r / face.a, 0.0f, 1.0f);
            const float there = here + (turned ? 1.0f - depth : depth);
            const float meets = x ? (there * axis_edge - start.x) * inverse.x
                                  : y ? (there * axis_edge - start.y) * inverse.y : (there * axis_edge - start.z) * inverse.z;
            if (meets >= begin && meets <= end)
                face = textureLod(voxel_faces_texture, corner + face_coordinates(mix(origin + direction * meets, of_layer, axis), axis_edge, axis_level), mip);
            else
                face = vec4(0.0f);
        }
        if (face.a > 0.0f) {
            const float gained = min(face.a, 1.0f - result.cover);
            result.radiance += face.rgb * (gained / face.a);
            result.cover += gained;
            if (result.cover >= 0.999f) break;
        }
        const float axis_looks = x ? looks.x : y ? looks.y : looks.z;
        float axis_look = (x ? look.x : y ? look.y : look.z) + 1.0f;
        float axis_layer = here;
        const bool onward = face.a > 0.0f || axis_look >= axis_looks;
        if (onward) {
            axis_look = 0.0f;
            axis_layer += 1.0f;
        }
        // An axis goes to the coarser level where its next layer begins one there, so that each layer counts once.
        const bool coarser = t * radius >= axis_edge && axis_edge < coarsest;
        if (onward && coarser && fract(0.5f * axis_layer) == 0.0f) {
            axis_layer *= 0.5f;
            axis_edge *= 2.0f;
            axis_level += 1.0f;
        }
        const float middle = (axis_layer + (axis_look + 0.5f) / axis_looks) * axis_edge;
        if (x) {
            look.x = axis_look;
            layer.x = axis_layer, edge.x = axis_edge, level.x = axis_level;
            next.x = (middle - start.x) * inverse.x;
        } else if (y) {
            look.y = axis_look;
            layer.y = axis_layer, edge.y = axis_edge, level.y = axis_level;
            next.y = (middle - start.y) * inverse.y;
        } else {
            look.z = axis_look;
            layer.z = axis_layer, edge.z = axis_edge, level.z = axis_level;
            next.z = (middle - start.z) * inverse.z;
        }
    }
    result.radiance *= volume.radiance_unit;
    return result;
}

#endif
