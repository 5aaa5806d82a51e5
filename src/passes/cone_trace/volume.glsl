// Cones through the voxel volume (docs/gi-theory.md).
//
// Along each axis the volume is a stack of layers. A cone that goes through a layer meets what the layer's faces show
// there once, at the depth where it stands: it takes the share of the cover that nothing before it took. So a wall is
// met exactly once, at whatever angle and whatever levels the cone goes through: nothing leaks, nothing counts twice.
#ifndef HELIODON_VOLUME_GLSL
#define HELIODON_VOLUME_GLSL
#include "passes/cone_trace/volume_shared.h"
#include "passes/occupancy/occupancy_shared.h"

layout(set = 0, binding = 20) uniform sampler3D voxel_faces_texture;
layout(set = 0, binding = 22) uniform sampler3D voxel_depths_texture;
layout(constant_id = 6) const bool nested = true;  // there is more than one cascade
layout(set = 0, binding = 21, std430) readonly buffer Volume_ { VolumeData volume; };
layout(set = 0, binding = 23, std430) readonly buffer Occupancy { uint occupancy[]; };

/// World to the lattice of the finest voxels.
vec3 to_lattice(vec3 world) { return (world - volume.lattice) / volume.voxel_m; }

/// The finest level whose cascade holds the position.
float level_holding(vec3 position) {
    float level = 0.0f;
    for (uint c = 0u; nested && c + 1u < volume.cascades; ++c) {
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
    // Voxels of one value show the plane to the axes that it does not face too: past what spreads furthest.
    const float least = min(abs(geometric.x), min(abs(geometric.y), abs(geometric.z)));
    const float lift = 1.5f * total - (volume.isotropic != 0u ? least : 1.0f / total);
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
    if (nested) {
        cascade = min(level, float(volume.cascades - 1u));
        at = at * exp2(-cascade) - vec3(volume.cascade[uint(cascade)].base);
        texel *= exp2(-cascade);
    }
    at = clamp(at, vec3(0.5f * texel), vec3(size - 0.5f * texel));
    at.y += size * cascade;
    return at / (size * vec3(2.0f, nested ? float(volume.cascades) : 1.0f, 3.0f));
}

/// Bit 2 axis + side: whether a look at this texel, of the lattice at `level`, can find that face to cover anything.
uint occupied_faces(ivec3 texel, uint level) {
    const uint cascade = nested ? min(level, volume.cascades - 1u) : 0u;
    const uint mip = level - cascade;
    const int size = int(volume.size >> mip);
    const ivec3 at = clamp(nested ? texel - volume.cascade[cascade].base : texel, ivec3(0), ivec3(size - 1));  // the widest has base 0
    const uint word = occupancy_first(volume.size, cascade, mip) + uint(at.x + size * (at.y + size * at.z)) / 4u;
    return occupancy[word] >> 8u * (uint(at.x) & 3u);
}

// Cones that graze a layer at less than a quarter of its slope pass it too seldom to matter.
const float most_looks = 4.0f;
// In texels, past a texel's border: on it rounding decides to which side a position belongs.
const float least_step = 1.0e-3f;

struct ConeResult {
    vec3 radiance;  // cd/m² × cover
    float cover;
};

/// `origin` and `reach` in finest voxels; `direction` unit.
ConeResult trace_cone(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeResult result = ConeResult(vec3(0.0f), 0.0f);
    // Each axis is walked forward: where the cone goes backward, in the lattice's mirror image. The lattice is as wide as
    // the widest cascade, whose voxels of every level mirror onto themselves.
    const float wide = (nested ? exp2(float(volume.cascades - 1u)) : 1.0f) * float(volume.size);
    const bvec3 backward = lessThan(direction, vec3(0.0f));
    const vec3 start = mix(origin, wide - origin, backward);
    const vec3 slope = max(abs(direction), vec3(1.0e-12f));
    const vec3 inverse = 1.0f / slope;
    const vec3 entries = -start * inverse;
    const float begin = max(0.0f, max(entries.x, max(entries.y, entries.z)));
    const vec3 exits = (wide - start) * inverse;
    const float end = min(reach, min(exits.x, min(exits.y, exits.z)));
    const float coarsest = 0.5f * wide;  // edge of the voxels of the level before the last
    // A texel is the mean over its edge and interpolation spreads it by another: it reaches 3/2 edges to each side. Where
    // that is the cone's radius the level fits; an axis goes to the next one at √2 times it, to the nearest level.
    const float radius = tan_half_angle * (inversesqrt(2.0f) / 1.5f);
    // A cone that grazes a layer goes far along it, and looks at it once a voxel, so that what stands at the layer's near
    // side is seen before the cone has passed it by.
    const vec3 look = 1.0f / clamp(ceil(max(slope.yzx, slope.zxy) * inverse), vec3(1.0f), vec3(most_looks));

    vec3 edge = vec3(nested ? exp2(level_holding(origin + direction * begin)) : 1.0f);
    vec3 next = max(((floor((start + slope * begin) / edge) + 0.5f * look) * edge - start) * inverse, vec3(begin));
    // Bits of the faces that look against the cone.
    const uint facing = (backward.x ? 1u : 2u) | (backward.y ? 4u : 8u) | (backward.z ? 16u : 32u);
    const uint levels = occupancy_levels(volume.size) + (nested ? volume.cascades - 1u : 0u);
    uint wide_level = 0u;  // at which to look first whether there is anything
    while (true) {
        const float t = min(next.x, min(next.y, next.z));
        if (!(t <= end)) break;
        // The axis whose look comes first; of several, one.
        const bool x = next.x <= t;
        const bool y = !x && next.y <= t;
        const bvec3 axis = bvec3(x, y, !x && !y);
        const vec3 unit = vec3(axis);
        float axis_edge = dot(unit, edge);
        const float axis_start = dot(unit, start);
        const float axis_slope = dot(unit, slope);
        const float axis_inverse = dot(unit, inverse);
        const float walked = axis_start + axis_slope * t;
        const float layer = floor(walked / axis_edge);
        const vec3 position = origin + direction * t;
        if (nested && exp2(level_holding(position)) > axis_edge) {
            // Past its cascade an axis goes on in the layer of the next one that holds this layer, if it lies ahead.
            axis_edge *= 2.0f;
            float outer = floor(0.5f * layer);
            if (((outer + 0.5f) * axis_edge - axis_start) * axis_inverse < begin) outer += 1.0f;
            edge = mix(edge, vec3(axis_edge), axis);
            next = mix(next, vec3(((outer + 0.5f) * axis_edge - axis_start) * axis_inverse), axis);
            continue;
        }
        const uint own_level = findMSB(uint(axis_edge));
        const uint asked_level = max(own_level, wide_level);
        if (asked_level < levels) {
            const float asked_edge = float(1u << asked_level);
            if ((occupied_faces(ivec3(floor(position / asked_edge)), asked_level) & facing) == 0u) {
                // Nothing until the cone leaves this texel, at its level and finer ones: their axes go on from there, at
                // the level that fits there if its texels lie within this one.
                const vec3 leaves = ((floor((start + slope * t) / asked_edge) + 1.0f) * asked_edge - start) * inverse;
                const float onward = min(leaves.x, min(leaves.y, leaves.z)) + least_step * asked_edge;
                const uint reach_there = uint(onward * radius);
                const float fitting = reach_there == 0u ? 1.0f : float(2u << findMSB(reach_there));
                const bvec3 passes = bvec3(uvec3(lessThan(next, vec3(onward))) & uvec3(lessThanEqual(edge, vec3(asked_edge))));
                edge = mix(edge, min(max(edge, vec3(fitting)), vec3(min(asked_edge, coarsest))), passes);
                const vec3 looks_at = (floor((start + slope * onward) / edge) + 0.5f * look) * edge;
                next = mix(next, max((looks_at - start) * inverse, vec3(onward)), passes);
                wide_level = asked_level + 1u;
                continue;
            }
            wide_level = max(asked_level, 1u) - 1u;
            if (asked_level > own_level) continue;
        }
        const bool turned = any(bvec3(axis.x && backward.x, axis.y && backward.y, axis.z && backward.z));
        const float level = float(own_level);
        const float mip = nested ? level - min(level, float(volume.cascades - 1u)) : level;
        // A ray that goes forward sees what looks backward. Along the axis a layer's texels are looked up in their middle,
        // wherever the face stands: layers do not mix.
        const vec3 corner = vec3(turned ? 0.0f : 0.5f, 0.0f, y ? 1.0f / 3.0f : x ? 0.0f : 2.0f / 3.0f);
        const float forward_middle = (layer + 0.5f) * axis_edge;
        const vec3 middle = vec3(turned ? wide - forward_middle : forward_middle);
        const vec3 at = corner + face_coordinates(mix(position, middle, axis), axis_edge, level);
        bool met = false;
        const vec4 seen = textureLod(voxel_faces_texture, at, mip);
        if (seen.a > 0.0f) {
            // Where the cone meets it, if it does ahead of its origin and within its reach.
            const float depth = clamp(textureLod(voxel_depths_texture, at, mip).r / seen.a, 0.0f, 1.0f);
            const float meets = ((layer + (turned ? 1.0f - depth : depth)) * axis_edge - axis_start) * axis_inverse;
            if (meets >= begin && meets <= end) {
                const vec3 place = corner + face_coordinates(mix(origin + direction * meets, middle, axis), axis_edge, level);
                const vec4 face = textureLod(voxel_faces_texture, place, mip);
                met = face.a > 0.0f;
                const float gained = min(face.a, 1.0f - result.cover);
                if (met) result.radiance += face.rgb * (gained / face.a);
                result.cover += gained;
                if (result.cover >= 0.999f) break;
            }
        }
        // The layer is done with once something of it was met. An axis goes to the coarser level where its next layer
        // begins one there, so that each layer counts once.
        const float axis_look = dot(unit, look);
        const float ahead = walked / axis_edge + axis_look;
        float onward = ahead;
        if (met || ahead >= layer + 1.0f) {
            onward = layer + 1.0f;
            if (t * radius >= axis_edge && axis_edge < coarsest && fract(0.5f * onward) == 0.0f) {
                onward *= 0.5f;
                axis_edge *= 2.0f;
            }
            onward += 0.5f * axis_look;
        }
        edge = mix(edge, vec3(axis_edge), axis);
        next = mix(next, vec3((onward * axis_edge - axis_start) * axis_inverse), axis);
    }
    result.radiance *= volume.radiance_unit;
    return result;
}

#endif
