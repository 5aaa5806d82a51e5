#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
// Finds out which of the four traced pixels about each pixel are like it, before they are traced, and lists the pixels that
// have to trace cones of their own.
#include "passes/cone_trace/cone_pixels.glsl"
#include "passes/cone_trace/listed_pixels.glsl"
#include "passes/cone_trace/traced_pixels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 13, rg32ui) uniform writeonly uimage2D weights;  // of four: for diffuse light, for specular

/// Ward & Heckbert 1992 ("Irradiance Gradients", eq. 1): the error ε of taking a point's light for that of another. For the
/// distance R to other surfaces stands a voxel's edge, below which the volume knows no detail. Distance along the
/// surface is left to the interpolation between pixels.
float plane_error(vec3 normal, vec3 offset) { return abs(dot(normal, offset)) / volume.voxel_m; }
float diffuse_error(vec3 normal, vec3 other_normal) { return sqrt(max(0.0f, 1.0f - dot(normal, other_normal))); }
/// The same for one cone: what part of its half-angle the other one is turned away or wider by.
struct Gloss {
    vec3 direction;
    float angle;  // half of the cone's, radians
};
float gloss_error(Gloss gloss, Gloss other) {
    const float turned = 2.0f * asin(min(0.5f * length(gloss.direction - other.direction), 1.0f));
    return (turned + abs(gloss.angle - other.angle)) / min(gloss.angle, other.angle);
}
/// What counts of a traced pixel: nothing where it is half a voxel, or half a cone, from this one.
float likeness(float error) { return max(0.0f, 1.0f - 2.0f * error); }

Gloss gloss_at(ivec2 pixel, ConePlace surface) {
    const Cone cone = specular_cone(viewer(pixel, surface.normal), surface.alpha);
    return Gloss(to_world(frame_from_normal(surface.normal), cone.direction), 2.0f * asin(sqrt(0.5f * cone.one_minus_cos)));
}

void weigh(ivec2 pixel, ConePlace surface, out vec4 diffuse, out vec4 specular) {
    const ivec2 size = ivec2(frame.width, frame.height);
    const AboutPixel about = about_pixel(pixel, frame.sample_index, size);
    const vec3 position = position_at(pixel, surface.depth_m);
    Gloss gloss = Gloss(vec3(0.0f), 0.0f);
    if (surface.glossy) gloss = gloss_at(pixel, surface);
    diffuse = vec4(0.0f);
    specular = vec4(0.0f);
    for (int i = 0; i < 4; ++i) {
        if (about.shares[i] == 0.0f) continue;
        const ivec2 there = traced_pixel(about.cells[i], frame.sample_index, size);
        const ConePlace other = place_at(there);
        if (other.depth_m == 0.0f) continue;
        const float plane = plane_error(surface.normal, position_at(there, other.depth_m) - position);
        if (surface.rough && other.rough)
            diffuse[i] = about.shares[i] * likeness(plane + diffuse_error(surface.normal, other.normal));
        if (surface.glossy && other.glossy)
            specular[i] = about.shares[i] * likeness(plane + gloss_error(gloss, gloss_at(there, other)));
    }
}
uint pack_weights(vec4 weights) {
    const float most = max(max(weights.x, weights.y), max(weights.z, weights.w));
    return most > 0.0f ? packUnorm4x8(weights / most) : 0u;
}

/// A subgroup's pixels go into a list together.
void enlist(uint list, bool wanted, uint packed_pixel) {
    const uvec4 wanting = subgroupBallot(wanted);
    const uint count = subgroupBallotBitCount(wanting);
    uint first = 0u;
    if (subgroupElect() && count > 0u) {
        first = atomicAdd(listed.groups[list].w, count);
        const uvec4 groups = spread_groups((first + count + listed_a_group - 1u) / listed_a_group);
        atomicMax(listed.groups[list].x, groups.x);
        atomicMax(listed.groups[list].y, groups.y);
        atomicMax(listed.groups[list].z, groups.z);
    }
    first = subgroupBroadcastFirst(first) + list * frame.width * frame.height;
    if (wanted) listed.pixels[first + subgroupBallotExclusiveBitCount(wanting)] = packed_pixel;
}

void main() {
    if (frame.batch != 0u) return;
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const bool within = pixel.x < int(frame.width) && pixel.y < int(frame.height);
    const ConePlace surface = place_at(min(pixel, ivec2(frame.width, frame.height) - 1));
    vec4 diffuse = vec4(0.0f);
    vec4 specular = vec4(0.0f);
    if (within && (surface.rough || surface.glossy)) weigh(pixel, surface, diffuse, specular);
    const uvec2 packed_weights = uvec2(pack_weights(diffuse), pack_weights(specular));
    if (within) imageStore(weights, pixel, uvec4(packed_weights, 0u, 0u));
    const bool has_specular = !surface.glossy || packed_weights.y != 0u;
    const uint packed_pixel = pack_listed(pixel, has_specular);
    enlist(unlike_diffuse, within && surface.rough && packed_weights.x == 0u, packed_pixel);
    enlist(unlike_specular, within && (surface.coated || !has_specular), packed_pixel);
    enlist(transmissive, within && surface.transmissive, packed_pixel);
}
