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
layout(constant_id = 8) const bool asks_occupancy = true;
layout(set = 0, binding = 21, std140) uniform Volume_ { VolumeData volume; };
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

/// A cone on its way, in finest voxels. Each axis is walked forward: where the cone goes backward, in the lattice's mirror
/// image. The lattice is as wide as the widest cascade, whose voxels of every level mirror onto themselves.
struct ConeWalk {
    vec3 origin, direction;  // in the lattice
    vec3 start, slope, inverse;
    bvec3 backward;
    float wide;        // edge of the lattice
    float begin, end;  // of the way
    float radius;      // where an edge is as long as this times the way, the next level fits
    vec3 look;         // of a layer, from look to look
    vec3 edge;         // of each axis' layers
    vec3 next;         // way to its next look
    uint facing;       // bits of the faces that look against the cone
    uint levels;       // whose occupancy is asked for
    uint wide_level;   // at which to ask first whether there is anything
};

ConeWalk begin_walk(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeWalk walk;
    walk.origin = origin;
    walk.direction = direction;
    walk.wide = (nested ? exp2(float(volume.cascades - 1u)) : 1.0f) * float(volume.size);
    walk.backward = lessThan(direction, vec3(0.0f));
    walk.start = mix(origin, walk.wide - origin, walk.backward);
    walk.slope = max(abs(direction), vec3(1.0e-12f));
    walk.inverse = 1.0f / walk.slope;
    const vec3 entries = -walk.start * walk.inverse;
    walk.begin = max(0.0f, max(entries.x, max(entries.y, entries.z)));
    const vec3 exits = (walk.wide - walk.start) * walk.inverse;
    walk.end = min(reach, min(exits.x, min(exits.y, exits.z)));
    // A texel is the mean over its edge and interpolation spreads it by another: it reaches 3/2 edges to each side. Where
    // that is the cone's radius the level fits; the next one, twice as wide, does where it is half of that.
    walk.radius = tan_half_angle / 3.0f;
    // A cone that grazes a layer goes far along it, and looks at it once a voxel, so that what stands at the layer's near
    // side is seen before the cone has passed it by.
    walk.look = 1.0f / clamp(ceil(max(walk.slope.yzx, walk.slope.zxy) * walk.inverse), vec3(1.0f), vec3(most_looks));
    walk.edge = vec3(nested ? exp2(level_holding(origin + direction * walk.begin)) : 1.0f);
    const vec3 layer = floor((walk.start + walk.slope * walk.begin) / walk.edge);
    walk.next = max(((layer + 0.5f * walk.look) * walk.edge - walk.start) * walk.inverse, vec3(walk.begin));
    walk.facing = (walk.backward.x ? 1u : 2u) | (walk.backward.y ? 4u : 8u) | (walk.backward.z ? 16u : 32u);
    walk.levels = asks_occupancy ? occupancy_levels(volume.size) + (nested ? volume.cascades - 1u : 0u) : 0u;
    walk.wide_level = 0u;
    return walk;
}

float coarsest_edge(ConeWalk walk) { return 0.5f * walk.wide; }  // of the level before the last

/// The axis whose look comes first; of several, one.
bvec3 next_axis(ConeWalk walk, float t) {
    const bool x = walk.next.x <= t;
    const bool y = !x && walk.next.y <= t;
    return bvec3(x, y, !x && !y);
}

/// Past its cascade an axis goes on in the layer of the next one that holds its layer, if that lies ahead.
void leave_cascade(inout ConeWalk walk, bvec3 axis, float t) {
    const vec3 outer_edge = 2.0f * walk.edge;
    vec3 outer = floor(floor((walk.start + walk.slope * t) / walk.edge) * 0.5f);
    outer += vec3(lessThan(((outer + 0.5f) * outer_edge - walk.start) * walk.inverse, vec3(walk.begin)));
    walk.next = mix(walk.next, ((outer + 0.5f) * outer_edge - walk.start) * walk.inverse, axis);
    walk.edge = mix(walk.edge, outer_edge, axis);
}

/// Where the cone leaves the texel of edge `edge` that holds it at `t`, a little past the border.
float leaves_texel(ConeWalk walk, float edge, float t) {
    const vec3 leaves = ((floor((walk.start + walk.slope * t) / edge) + 1.0f + least_step) * edge - walk.start) * walk.inverse;
    return min(leaves.x, min(leaves.y, leaves.z));
}

/// Nothing in the texel that holds the way's position: axes of its level and finer ones go on from where the cone leaves
/// it, at the level that fits there as far as that one's texels lie within this texel.
void leave_texel(inout ConeWalk walk, float texel_edge, float t) {
    const float onward = leaves_texel(walk, texel_edge, t);
    const uint width = uint(onward * walk.radius);
    const float fitting = width == 0u ? 1.0f : float(2u << findMSB(width));
    const bvec3 passes = bvec3(uvec3(lessThan(walk.next, vec3(onward))) & uvec3(lessThanEqual(walk.edge, vec3(texel_edge))));
    walk.edge = mix(walk.edge, min(max(walk.edge, vec3(fitting)), vec3(min(texel_edge, coarsest_edge(walk)))), passes);
    const vec3 looks_at = (floor((walk.start + walk.slope * onward) / walk.edge) + 0.5f * walk.look) * walk.edge;
    walk.next = mix(walk.next, max((looks_at - walk.start) * walk.inverse, vec3(onward)), passes);
}

/// One step of the walk: true at a look that can find something. Steps and looks take turns in one loop, so that cones that
/// are traced together need not wait for each other's way through empty space.
bool step_on(inout ConeWalk walk, float t, out bvec3 axis, out uint level) {
    axis = next_axis(walk, t);
    const float edge = dot(vec3(axis), walk.edge);
    const vec3 position = walk.origin + walk.direction * t;
    level = findMSB(uint(edge));
    if (nested && exp2(level_holding(position)) > edge) {
        leave_cascade(walk, axis, t);
        return false;
    }
    if (level >= walk.levels) return true;
    const uint asked = max(level, min(walk.wide_level, walk.levels - 1u));
    const float asked_edge = float(1u << asked);
    if ((occupied_faces(ivec3(floor(position / asked_edge)), asked) & walk.facing) == 0u) {
        leave_texel(walk, asked_edge, t);
        walk.wide_level = asked + 1u;
        return false;
    }
    walk.wide_level = max(asked, 1u) - 1u;
    return asked == level;
}

// What a look finds.
const uint missed = 0u, met = 1u, met_later = 2u;

/// The layer is done with once something of it was met. An axis goes to the coarser level where its next layer begins one
/// there, so that each layer counts once.
void leave_look(inout ConeWalk walk, bvec3 axis, float t, uint found) {
    if (found == met_later) {
        walk.next = mix(walk.next, vec3(leaves_texel(walk, dot(vec3(axis), walk.edge), t)), axis);
        return;
    }
    const vec3 walked = (walk.start + walk.slope * t) / walk.edge;
    const vec3 layer = floor(walked);
    const vec3 ahead = walked + walk.look;
    const bvec3 leaves = bvec3(uvec3(found == met) | uvec3(greaterThanEqual(ahead, layer + 1.0f)));
    const bvec3 coarser = bvec3(uvec3(leaves) & uvec3(greaterThanEqual(vec3(t * walk.radius), walk.edge)) &
                                uvec3(lessThan(walk.edge, vec3(coarsest_edge(walk)))) & uvec3(equal(fract(0.5f * (layer + 1.0f)), vec3(0.0f))));
    const vec3 scale = mix(vec3(1.0f), vec3(2.0f), coarser);
    const vec3 edge = walk.edge * scale;
    const vec3 onward = mix(ahead, (layer + 1.0f) / scale + 0.5f * walk.look, leaves);
    walk.edge = mix(walk.edge, edge, axis);
    walk.next = mix(walk.next, (onward * edge - walk.start) * walk.inverse, axis);
}

struct ConeResult {
    vec3 radiance;  // cd/m² × cover
    float cover;
};

/// What the cone meets of the layer it looks at, if it does ahead of its origin and within its reach. A face deeper than
/// the cone goes in this texel is left to a look there: here interpolation shows the ends of what stands elsewhere.
uint meet_layer(ConeWalk walk, bvec3 axis, float t, uint level, inout ConeResult result) {
    const float edge = dot(vec3(axis), walk.edge);
    const float start = dot(vec3(axis), walk.start);
    const bool turned = any(bvec3(axis.x && walk.backward.x, axis.y && walk.backward.y, axis.z && walk.backward.z));
    const float mip = float(nested ? level - min(level, volume.cascades - 1u) : level);
    // A ray that goes forward sees what looks backward. Along the axis a layer's texels are looked up in their middle,
    // wherever the face stands: layers do not mix.
    const vec3 corner = vec3(turned ? 0.0f : 0.5f, 0.0f, axis.y ? 1.0f / 3.0f : axis.x ? 0.0f : 2.0f / 3.0f);
    const float layer = floor((start + dot(vec3(axis), walk.slope) * t) / edge);
    const float forward_middle = (layer + 0.5f) * edge;
    const vec3 middle = vec3(turned ? walk.wide - forward_middle : forward_middle);
    const vec3 at = corner + face_coordinates(mix(walk.origin + walk.direction * t, middle, axis), edge, float(level));
    const vec4 seen = textureLod(voxel_faces_texture, at, mip);
    if (seen.a <= 0.0f) return missed;
    const float depth = clamp(textureLod(voxel_depths_texture, at, mip).r / seen.a, 0.0f, 1.0f);
    const float meets = ((layer + (turned ? 1.0f - depth : depth)) * edge - start) * dot(vec3(axis), walk.inverse);
    if (!(meets >= walk.begin && meets <= walk.end)) return missed;
    if (meets > leaves_texel(walk, edge, t)) return met_later;
    const vec3 place = corner + face_coordinates(mix(walk.origin + walk.direction * meets, middle, axis), edge, float(level));
    const vec4 face = textureLod(voxel_faces_texture, place, mip);
    if (face.a <= 0.0f) return missed;
    const float gained = min(face.a, 1.0f - result.cover);
    result.radiance += face.rgb * (gained / face.a);
    result.cover += gained;
    return met;
}

/// `origin` and `reach` in finest voxels; `direction` unit.
ConeResult trace_cone(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeResult result = ConeResult(vec3(0.0f), 0.0f);
    ConeWalk walk = begin_walk(origin, direction, tan_half_angle, reach);
    while (result.cover < 0.999f) {
        const float t = min(walk.next.x, min(walk.next.y, walk.next.z));
        if (!(t <= walk.end)) break;
        bvec3 axis;
        uint level;
        if (!step_on(walk, t, axis, level)) continue;
        leave_look(walk, axis, t, meet_layer(walk, axis, t, level, result));
    }
    result.radiance *= volume.radiance_unit;
    return result;
}

#endif
