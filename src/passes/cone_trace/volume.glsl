// Cones through the voxel volume (docs/gi-theory.md).
//
// Along each axis the volume is a stack of layers. A cone that goes through a layer meets what the layer's faces show
// there once, at the depth where it stands: it takes the share of the cover that nothing before it took. So a wall is
// met exactly once, at whatever angle and whatever levels the cone goes through: nothing leaks, nothing counts twice.
#ifndef HELIODON_VOLUME_GLSL
#define HELIODON_VOLUME_GLSL
#include "passes/cone_trace/volume_data.glsl"
#include "passes/occupancy/occupancy_shared.h"
#include "shading/cone.h"
#include "shading/spherical_lobe.h"

layout(set = 0, binding = 20) uniform sampler3D voxel_faces_texture;
layout(set = 0, binding = 22) uniform sampler3D voxel_depths_texture;
layout(set = 0, binding = 30) uniform sampler3D voxel_lobes_texture;
layout(constant_id = 22) const bool has_lobes = false;
layout(constant_id = 6) const bool nested = true;  // there is more than one cascade
layout(set = 0, binding = 23, std430) readonly buffer Occupancy { uint emptiness[]; };

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

/// Of the voxel of the finest cascade that holds a position: its level, and of each face how many levels are empty there.
uint emptiness_at(vec3 position, out uint finest) {
    finest = nested ? uint(level_holding(position)) : 0u;
    const int size = int(volume.size);
    const ivec3 voxel = nested ? ivec3(floor(position * exp2(-float(finest)))) - volume.cascade[finest].base : ivec3(floor(position));
    const ivec3 at = clamp(voxel, ivec3(0), ivec3(size - 1));
    return emptiness[at.x + size * (at.y + size * (at.z + size * int(finest)))];
}

// Cones that graze a layer at less than a quarter of its slope pass it too seldom to matter.
const float most_looks = 4.0f;
// In texels, past a texel's border: on it rounding decides to which side a position belongs.
const float least_step = 1.0e-3f;

/// A cone on its way, in finest voxels. Each axis is walked forward: where the cone goes backward, in the lattice's mirror
/// image. The lattice is as wide as the widest cascade, whose voxels of every level mirror onto themselves.
struct ConeWalk {
    vec3 start, slope, inverse;
    bvec3 backward;
    float wide;        // edge of the lattice
    float begin, end;  // of the way
    float radius;      // where an edge is as long as this times the way, the next level fits
    vec3 look;         // of a layer, from look to look
    vec3 edge;         // of each axis' layers
    vec3 next;         // way to its next look
    float least_edge;  // where it begins
};

ConeWalk begin_walk(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeWalk walk;
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
    walk.least_edge = nested ? exp2(level_holding(origin + direction * walk.begin)) : 1.0f;
    walk.edge = vec3(walk.least_edge);
    const vec3 layer = floor((walk.start + walk.slope * walk.begin) / walk.edge);
    walk.next = max(((layer + 0.5f * walk.look) * walk.edge - walk.start) * walk.inverse, vec3(walk.begin));
    return walk;
}

vec3 walked(ConeWalk walk, float t) { return walk.start + walk.slope * t; }
/// Where that is in the lattice.
vec3 place(ConeWalk walk, vec3 walked) { return mix(walked, walk.wide - walked, walk.backward); }

float coarsest_edge(ConeWalk walk) { return 0.5f * walk.wide; }  // of the level before the last

/// The layer whose look comes first, of one axis; of several, of one.
struct Layer {
    bvec3 axis;
    float start, slope, inverse, edge;  // the walk's along the axis
    float t;                            // way to the look
};
float along(bvec3 axis, vec3 v) { return axis.x ? v.x : axis.y ? v.y : v.z; }

Layer next_layer(ConeWalk walk) {
    Layer layer;
    layer.t = min(walk.next.x, min(walk.next.y, walk.next.z));
    const bool x = walk.next.x <= layer.t;
    const bool y = !x && walk.next.y <= layer.t;
    layer.axis = bvec3(x, y, !x && !y);
    layer.start = along(layer.axis, walk.start);
    layer.slope = along(layer.axis, walk.slope);
    layer.inverse = along(layer.axis, walk.inverse);
    layer.edge = along(layer.axis, walk.edge);
    return layer;
}
void go_on(inout ConeWalk walk, bvec3 axis, float edge, float next) {
    walk.edge = mix(walk.edge, vec3(edge), axis);
    walk.next = mix(walk.next, vec3(next), axis);
}

/// Past its cascade an axis goes on in the layer of the next one that holds its layer, if that lies ahead.
void leave_cascade(inout ConeWalk walk, Layer layer) {
    const float outer_edge = 2.0f * layer.edge;
    float outer = floor(floor((layer.start + layer.slope * layer.t) / layer.edge) * 0.5f);
    if (((outer + 0.5f) * outer_edge - layer.start) * layer.inverse < walk.begin) outer += 1.0f;
    go_on(walk, layer.axis, outer_edge, ((outer + 0.5f) * outer_edge - layer.start) * layer.inverse);
}

// Powers of two by the bits of their exponents.
float inverse_power(float power) { return uintBitsToFloat(0x7f000000u - floatBitsToUint(power)); }
vec3 inverse_power(vec3 power) { return uintBitsToFloat(0x7f000000u - floatBitsToUint(power)); }
/// Twice the powers of two that are at most v.
vec3 twice_power_below(vec3 v) { return uintBitsToFloat((floatBitsToUint(v) & 0x7f800000u) + 0x00800000u); }

/// Where the cone leaves the texel of edge `edge` that holds it at `t`, a little past the border.
float leaves_texel(ConeWalk walk, float edge, float t) {
    const vec3 leaves = ((floor(walked(walk, t) * inverse_power(edge)) + 1.0f + least_step) * edge - walk.start) * walk.inverse;
    return min(leaves.x, min(leaves.y, leaves.z));
}

/// What is empty for an axis ends with a texel of its own edge. Where that is at least the axis' layers' edge it goes on from where
/// the cone leaves the texel: at the level that fits there, but none coarser than what is empty for all axes.
void leave_texels(inout ConeWalk walk, vec3 texels, float t) {
    const vec3 onward = vec3(leaves_texel(walk, texels.x, t), leaves_texel(walk, texels.y, t), leaves_texel(walk, texels.z, t));
    const float coarsest = min(coarsest_edge(walk), min(texels.x, min(texels.y, texels.z)));
    const vec3 fitting = min(twice_power_below(onward * walk.radius), coarsest);
    const bvec3 passes = bvec3(uvec3(lessThan(walk.next, onward)) & uvec3(lessThanEqual(walk.edge, texels)));
    walk.edge = mix(walk.edge, max(walk.edge, fitting), passes);
    const vec3 looks_at = (floor((walk.start + walk.slope * onward) * inverse_power(walk.edge)) + 0.5f * walk.look) * walk.edge;
    walk.next = mix(walk.next, max((looks_at - walk.start) * walk.inverse, onward), passes);
}

/// Goes past what is empty at the way's position; false where the layer has to be looked at.
bool pass_empty(inout ConeWalk walk, Layer layer) {
    const vec3 position = place(walk, walked(walk, layer.t));
    if (nested && exp2(level_holding(position)) > layer.edge) {
        leave_cascade(walk, layer);
        return true;
    }
    uint finest;
    const uint empty = emptiness_at(position, finest);
    // Along an axis what looks backward faces the cone, and where that goes backward, what looks forward.
    const uvec3 facing = emptiness_bits * (uvec3(0u, 2u, 4u) + uvec3(not(walk.backward)));
    const uvec3 levels = (uvec3(empty) >> facing) & ((1u << emptiness_bits) - 1u);
    const vec3 texels = uintBitsToFloat((finest + levels + 126u) << 23u);  // the coarsest empty ones: 2^(levels - 1)
    if (along(layer.axis, texels) < layer.edge) return false;
    leave_texels(walk, texels, layer.t);
    return true;
}

// What a look finds.
const uint missed = 0u, met = 1u, met_later = 2u;

/// The layer is done with once something of it was met. An axis goes to the coarser level where its next layer begins one
/// there, so that each layer counts once.
void leave_look(inout ConeWalk walk, Layer layer, uint found) {
    if (found == met_later) {
        go_on(walk, layer.axis, layer.edge, leaves_texel(walk, layer.edge, layer.t));
        return;
    }
    const float look = along(layer.axis, walk.look);
    const float walked = (layer.start + layer.slope * layer.t) * inverse_power(layer.edge);
    const float after = floor(walked) + 1.0f;
    const float ahead = walked + look;
    const bool leaves = found == met || ahead >= after;
    const bool coarser = leaves && layer.t * walk.radius >= layer.edge && layer.edge < coarsest_edge(walk) && fract(0.5f * after) == 0.0f;
    const float scale = coarser ? 2.0f : 1.0f;
    const float edge = layer.edge * scale;
    const float onward = leaves ? after / scale + 0.5f * look : ahead;
    go_on(walk, layer.axis, edge, (onward * edge - layer.start) * layer.inverse);
}

struct ConeResult {
    vec3 radiance;  // cd/m² × cover
    float cover;
    float entered;  // cover of what was met from its front
};

/// What the cone meets from behind `at` a place on its way: the black rear of a sheet. Where it has gone into something
/// before, this is how it leaves that again, and what interpolation kept from the front's cover shows as it did.
/// `looked_up`: where in the lattice. The surface that the cone comes from, whose texels reach 3/2 edges, is not behind its origin.
uint meet_rear(ConeWalk walk, Layer layer, vec3 at, vec3 looked_up, float behind, float level, float mip, inout ConeResult result) {
    const vec3 first = face_coordinates(looked_up, layer.edge, level);
    vec3 normal;  // along the cone's way: what is seen from behind, less what is from the front
    for (int axis = 0; axis < 3; ++axis) {
        const vec3 corner = vec3(walk.backward[axis] ? 0.0f : 0.5f, 0.0f, float(axis) / 3.0f);
        normal[axis] = -textureLod(voxel_faces_texture, first + corner, mip).a;
    }
    if (!(dot(normal, walk.slope) > 0.0f && dot(normal, at - walk.start) > 1.5f * walk.least_edge * length(normal))) return missed;
    const float left = min(behind, result.entered);
    const float gained = min(behind - left, 1.0f - result.cover);
    if (result.cover > 0.0f) result.radiance *= 1.0f + gained * left / (behind * result.cover);
    result.cover += gained;
    return met;
}

/// Radiance × cover that a layer's faces send along the cone of the lights that shine on them, `at` a place of the texture of
/// lobes. A lobe that a cone sees is as wide as both together: variances add.
vec3 sent_ahead(ConeWalk walk, vec3 at, float mip, float cover) {
    const vec4 light = textureLod(voxel_lobes_texture, at, mip);
    if (light.rgb == vec3(0.0f)) return vec3(0.0f);
    const vec4 lobe = textureLod(voxel_lobes_texture, at + vec3(0.0f, 0.0f, 0.5f), mip);
    const float sum = max(length(lobe.xyz), 1.0e-6f);
    const float concentration = lobe_through_cone(lobe_concentration(sum / max(lobe.w, 1.0e-6f)), one_minus_cos_from_tan(3.0f * walk.radius));
    const vec3 back = mix(-walk.slope, walk.slope, walk.backward);
    return light.rgb * (lobe_density(concentration, dot(lobe.xyz, back) / sum) * cover / max(light.a, 1.0e-7f));
}

/// What the cone meets of the layer it looks at, if it does ahead of its origin and within its reach. A face deeper than
/// the cone goes in this texel is left to a look there: here interpolation shows the ends of what stands elsewhere.
uint meet_layer(ConeWalk walk, Layer layer, inout ConeResult result) {
    const uint level = findMSB(uint(layer.edge));
    const bool turned = any(bvec3(uvec3(layer.axis) & uvec3(walk.backward)));
    const float mip = float(nested ? level - min(level, volume.cascades - 1u) : level);
    // A ray that goes forward sees what looks backward. Along the axis a layer's texels are looked up in their middle,
    // wherever the face stands: layers do not mix.
    const vec3 corner = vec3(turned ? 0.0f : 0.5f, 0.0f, layer.axis.y ? 1.0f / 3.0f : layer.axis.x ? 0.0f : 2.0f / 3.0f);
    const float number = floor((layer.start + layer.slope * layer.t) * inverse_power(layer.edge));
    const float forward_middle = (number + 0.5f) * layer.edge;
    const vec3 middle = vec3(turned ? walk.wide - forward_middle : forward_middle);
    const vec3 looked_at = mix(place(walk, walked(walk, layer.t)), middle, layer.axis);
    const vec3 at = corner + face_coordinates(looked_at, layer.edge, float(level));
    const vec4 seen = textureLod(voxel_faces_texture, at, mip);
    const float deep = textureLod(voxel_depths_texture, at, mip).r;  // both at once: what is empty is seldom looked at
    if (seen.a == 0.0f) return missed;
    const float depth = clamp(deep / seen.a, 0.0f, 1.0f);
    const float stands = (number + (turned ? 1.0f - depth : depth)) * layer.edge;
    const float meets = (stands - layer.start) * layer.inverse;
    if (!(meets >= walk.begin && meets <= walk.end)) return missed;
    if (seen.a < 0.0f) {
        const vec3 at_rear = mix(walked(walk, layer.t), vec3(stands), layer.axis);
        return meet_rear(walk, layer, at_rear, looked_at, -seen.a, float(level), mip, result);
    }
    if (meets > leaves_texel(walk, layer.edge, layer.t)) return met_later;
    const vec3 within = corner + face_coordinates(mix(place(walk, walked(walk, meets)), middle, layer.axis), layer.edge, float(level));
    const vec4 face = textureLod(voxel_faces_texture, within, mip);
    if (face.a <= 0.0f) return missed;
    const float gained = min(face.a, 1.0f - result.cover);
    result.radiance += face.rgb * (gained / face.a);
    if (has_lobes) {
        const float edge = mip == 0.0f ? 2.0f * layer.edge : layer.edge;  // they begin at level 1
        const float layers_middle = (floor(number * layer.edge * inverse_power(edge)) + 0.5f) * edge;
        const vec3 lobes_middle = vec3(turned ? walk.wide - layers_middle : layers_middle);
        const vec3 lobe_at = corner + face_coordinates(mix(place(walk, walked(walk, meets)), lobes_middle, layer.axis), edge, float(level));
        result.radiance += sent_ahead(walk, lobe_at * vec3(1.0f, 1.0f, 0.5f), max(mip - 1.0f, 0.0f), gained);
    }
    result.cover += gained;
    result.entered += gained;
    return met;
}

/// `origin` and `reach` in finest voxels; `direction` unit. Ways past what is empty and looks take turns in one loop, so that
/// cones that are traced together need not wait for each other's way through empty space.
ConeResult trace_cone(vec3 origin, vec3 direction, float tan_half_angle, float reach) {
    ConeResult result = ConeResult(vec3(0.0f), 0.0f, 0.0f);
    ConeWalk walk = begin_walk(origin, direction, tan_half_angle, reach);
    while (result.cover < 0.999f) {
        const Layer layer = next_layer(walk);
        if (!(layer.t <= walk.end)) break;
        if (!pass_empty(walk, layer)) leave_look(walk, layer, meet_layer(walk, layer, result));
    }
    result.radiance *= volume.radiance_unit;
    return result;
}

#endif
