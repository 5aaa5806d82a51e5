#version 460
#extension GL_GOOGLE_include_directive : require
// The sky's light on each surface, from those directions in which the picture shows nothing before it. As Jimenez, Wu,
// Pesce & Jarabo 2016 ("Practical Realtime Strategies for Accurate Indirect Occlusion") in slices: planes through the
// viewer's direction, in each of which the cosine-weighted integral over an angle has a closed form. What is seen along
// a slice covers the angles from its front to where it ends (Therrien, Levesque & Gilet 2023, "Screen Space Indirect
// Lighting with Visibility Bitmask"), so that light passes behind it. All samples of a picture turn the slices evenly.
#include "passes/ambient_occlusion/ambient_occlusion_shared.h"
#include "passes/common/hash.glsl"
#include "passes/common/sky_light.glsl"
#include "passes/cone_trace/cone_surface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool draws_aov = false;
layout(set = 0, binding = 8, std140) uniform Frame_ { FrameData frame; };
layout(set = 0, binding = 11, std430) readonly buffer ShadingTables { float shading_tables[]; };
layout(set = 0, binding = 12) uniform usampler2D surface_places;
layout(set = 0, binding = 13, rgba32f) uniform image2D picture;
layout(set = 0, binding = 18) uniform usampler2D surface_albedos;
layout(set = 0, binding = 19) uniform usampler2D surface_lobes;
layout(push_constant) uniform Push { AmbientOcclusionConstants push; };
float shading_table(uint index) { return shading_tables[index]; }

const uint sectors = 32u;       // of a slice's half circle about the normal, a bit each
const uint sectors_a_look = 4u;  // at the sky
const float look_columns = 2.0f * float(sectors / sectors_a_look);  // of a sky's picture whose texels are as wide
const float in_plane_sine = 0.02f;  // a degree: what rises less over a plane lies in it

/// Along the view 1 m long.
vec3 view_ray(ivec2 pixel) {
    const vec2 at = vec2(pixel) + 0.5f + frame.jitter;
    return frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
}

/// One surface and the slice through it. Angles are from the viewer's direction, towards `along` positive.
struct Slice {
    vec3 position;
    vec3 to_viewer;
    vec3 along;
    vec3 across;   // its plane's normal
    vec3 slip;     // out of it within the surface, by 1
    vec2 step;     // pixels, of length 1: `along` in the picture
    float gamma;   // of the normal's projection
    float projected;  // its length
};

/// ∫ |sin θ| cos(θ − γ) dθ from 0 to `theta`: Jimenez et al. 2016, eq. 7; below 0 negative, so that it rises.
float slice_integral(float theta, float gamma) {
    const float g = theta < 0.0f ? -gamma : gamma;
    const float x = abs(theta);
    return sign(theta) * 0.25f * (cos(g) - cos(2.0f * x - g) + 2.0f * x * sin(g));
}

/// Sectors whose middle lies between two angles.
uint sectors_between(Slice slice, float a, float b) {
    const vec2 angles = vec2(min(a, b), max(a, b)) - slice.gamma;
    const vec2 place = angles * (float(sectors) * inverse_pi) + 0.5f * float(sectors);
    const ivec2 ends = ivec2(clamp(round(place), 0.0f, float(sectors)));
    const int count = ends.y - ends.x;
    return count <= 0 ? 0u : (count >= int(sectors) ? ~0u : ((1u << uint(count)) - 1u) << uint(ends.x));
}

/// Of a place beside the surface. Pixels lie off the slice by up to half of one: they are moved into it along the surface,
/// so that what lies in its plane stays there.
float angle_to(Slice slice, vec3 offset, float side) {
    const vec3 within = offset - dot(offset, slice.across) * slice.slip;
    return side * acos(clamp(dot(normalize(within), slice.to_viewer), -1.0f, 1.0f));
}

/// How many pixels a half of the slice has before the picture ends.
float pixels_ahead(vec2 from, vec2 step) {
    const vec2 room = mix(from, vec2(frame.width, frame.height) - from, greaterThan(step, vec2(0.0f)));
    const vec2 ahead = room / max(abs(step), vec2(1.0e-6f));
    return min(ahead.x, ahead.y);
}

/// What one step along the slice shows.
struct Seen {
    bool there;
    vec3 place;
    vec3 normal;
    float angle;
};

Seen look_along(Slice slice, ivec2 at, float side) {
    const uvec4 packed_place = texelFetch(surface_places, at, 0);
    const float depth_m = uintBitsToFloat(packed_place.x);
    Seen seen = Seen(false, frame.position + depth_m * view_ray(at), unpack_direction(packed_place.y), 0.0f);
    const vec3 offset = seen.place - slice.position;
    const float distance2 = dot(offset, offset);
    const bool reached = push.reach_m <= 0.0f || distance2 <= push.reach_m * push.reach_m;
    seen.there = depth_m > 0.0f && distance2 > 0.0f && reached;
    if (seen.there) seen.angle = angle_to(slice, offset, side);
    return seen;
}

/// What is seen at a step ends on average half a step farther, at `pixel`: there the angle to its plane, or its own where
/// that is no longer near it.
float angle_onward(Slice slice, Seen seen, vec2 pixel, float most, float side) {
    const vec2 at = pixel + frame.jitter;
    const vec3 ray = frame.ray_corner + frame.ray_dx * at.x + frame.ray_dy * at.y;
    const vec3 offset = seen.place - frame.position;
    const float depth_m = dot(seen.normal, offset) / dot(seen.normal, ray);
    const float change = depth_m / dot(offset, frame.forward);
    if (!(change > 1.0f / most && change < most)) return seen.angle;
    return angle_to(slice, frame.position + depth_m * ray - slice.position, side);
}

/// Sectors that one step hides; half a step onward is `ratio` times as far off, at `onward`.
uint hidden_by(Slice slice, Seen seen, Seen before, vec2 onward, float ratio, float side) {
    float back = side * pi;
    if (push.thickness_m > 0.0f) {
        const vec3 onward_m = push.thickness_m * normalize(seen.place - frame.position);
        back = angle_to(slice, seen.place - slice.position + onward_m, side);
    }
    const uint bits = sectors_between(slice, seen.angle, back) |
                      sectors_between(slice, seen.angle, angle_onward(slice, seen, onward, ratio, side));
    // Of one plane nothing lies between two places.
    const vec3 along = seen.place - before.place;
    const float rise = max(abs(dot(along, before.normal)), abs(dot(along, seen.normal)));
    const bool joined = before.there && rise <= in_plane_sine * length(along);
    return joined ? bits | sectors_between(slice, before.angle, seen.angle) : bits;
}

/// What the picture shows along one half of the slice.
uint covered(Slice slice, ivec2 pixel, ConePlace place, float side, float offset) {
    const vec2 from = vec2(pixel) + 0.5f;
    const vec2 step = slice.step * side;
    const float pixels_a_metre = inversesqrt(dot(frame.ray_dx, frame.ray_dx)) / place.depth_m;
    float farthest = pixels_ahead(from, step);
    if (push.reach_m > 0.0f) farthest = min(farthest, push.reach_m * pixels_a_metre);
    const float half_step = exp2(0.5f * log2(max(farthest, 1.0f)) / float(push.steps));
    uint bits = 0u;
    ivec2 last = pixel;
    Seen before = Seen(true, slice.position, place.geometric, slice.gamma + side * 0.5f * pi);
    for (uint i = 0u; i < push.steps; ++i) {
        // Steps grow as the distance does, so that all angles and sizes count alike.
        const float ahead = exp2(log2(max(farthest, 1.0f)) * (float(i) + offset) / float(push.steps));
        const ivec2 at = clamp(ivec2(from + step * ahead), ivec2(0), ivec2(frame.width, frame.height) - 1);
        if (at == last || at == pixel) continue;
        last = at;
        const Seen seen = look_along(slice, at, side);
        const vec3 away = seen.place - slice.position;
        // The facets of a smooth surface hide nothing from each other.
        if (seen.there && dot(away, place.geometric) > in_plane_sine * length(away))
            bits |= hidden_by(slice, seen, before, from + step * ahead * half_step, half_step, side);
        before = seen;
    }
    return bits;
}

struct Openness {
    vec3 open_sky;   // Σ of weighted radiance, open
    vec3 whole_sky;  // and all
    float hidden;          // Σ of weights, hidden
    vec3 hidden_way;       // and of weighted directions
};

vec3 look_at_sky(vec3 direction) {
    vec3 texel = vec3(1.0f);
    if (sky_image_slot != no_texture) {
        const float width = float(textureSize(textures[nonuniformEXT(sky_image_slot)], 0).x);
        texel = sky_map(sky_image_slot, direction, log2(width / look_columns));
    }
    return sky_radiance_filtered(sky_data, texel);
}

void add_slice(Slice slice, uint bits, bool sky, inout Openness sum) {
    const float begin = slice.gamma - 0.5f * pi;
    const float wide = pi * float(sectors_a_look) / float(sectors);
    float before = slice_integral(begin, slice.gamma);
    for (uint look = 0u; look < sectors / sectors_a_look; ++look) {
        const float end = begin + wide * float(look + 1u);
        const float integral = slice_integral(end, slice.gamma);
        const float weight = slice.projected * (integral - before);
        before = integral;
        const float middle = end - 0.5f * wide;
        const vec3 direction = cos(middle) * slice.to_viewer + sin(middle) * slice.along;
        const uint hidden = bitCount(bitfieldExtract(bits, int(look * sectors_a_look), int(sectors_a_look)));
        const float open = weight * (1.0f - float(hidden) / float(sectors_a_look));
        sum.hidden += weight - open;
        sum.hidden_way += (weight - open) * direction;
        if (sky) {
            const vec3 radiance = look_at_sky(direction);
            sum.whole_sky += weight * radiance;
            sum.open_sky += open * radiance;
        }
    }
}

/// Sums of `push.slices`: the weights of one are 1 on average over all.
Openness openness_of(ivec2 pixel, ConePlace place, vec3 position, bool sky) {
    const vec3 ray = view_ray(pixel);
    const vec3 to_viewer = -normalize(ray);
    const Frame about = frame_from_normal(to_viewer);
    const uint seed = pcg_hash(uint(pixel.x) + pcg_hash(uint(pixel.y)));
    // Roberts 2018 (the plastic number's sequence), moved from pixel to pixel.
    const vec2 moved_by = float(frame.sample_index & 0xffffu) * vec2(0.7548776662f, 0.5698402910f);
    const vec2 u = fract(vec2(unit_interval(seed), unit_interval(pcg_hash(seed))) + moved_by);
    Openness sum = Openness(vec3(0.0f), vec3(0.0f), 0.0f, vec3(0.0f));
    for (uint i = 0u; i < push.slices; ++i) {
        const float phi = pi * (u.x + float(i)) / float(push.slices);
        Slice slice;
        slice.position = position;
        slice.to_viewer = to_viewer;
        slice.along = cos(phi) * about.tangent + sin(phi) * about.bitangent;
        slice.across = cross(slice.along, to_viewer);
        const float tilt = dot(slice.across, place.geometric);
        slice.slip = (slice.across - tilt * place.geometric) / max(1.0f - tilt * tilt, 1.0e-3f);
        const vec3 moved = slice.along - ray * dot(slice.along, frame.forward);
        const vec2 pixels2 = vec2(dot(frame.ray_dx, frame.ray_dx), dot(frame.ray_dy, frame.ray_dy));
        slice.step = normalize(vec2(dot(moved, frame.ray_dx), dot(moved, frame.ray_dy)) / pixels2);
        const vec2 normal = vec2(dot(place.normal, slice.along), dot(place.normal, to_viewer));
        slice.projected = length(normal);
        slice.gamma = atan(normal.x, normal.y);
        const uint bits = covered(slice, pixel, place, 1.0f, u.y) | covered(slice, pixel, place, -1.0f, u.y);
        add_slice(slice, bits, sky, sum);
    }
    return sum;
}

/// Share of a reflection's cone that lies within that of what is open about the bent normal: Oat & Sander 2007
/// ("Ambient Aperture Lighting", section 3), the solid angle of two caps' intersection.
float share_open(Cone lobe, vec3 lobe_direction, vec3 bent, float openness) {
    const float open = acos(sqrt(clamp(1.0f - openness, 0.0f, 1.0f)));  // Jimenez et al. 2016: cos² = 1 − openness
    const float wide = acos(1.0f - lobe.one_minus_cos);
    const float apart = acos(clamp(dot(lobe_direction, bent), -1.0f, 1.0f));
    const float least = abs(open - wide);
    const float shared_at_most = min(1.0f, (1.0f - cos(open)) / max(lobe.one_minus_cos, 1.0e-6f));
    return shared_at_most * smoothstep(0.0f, 1.0f, 1.0f - (apart - least) / max(open + wide - least, 1.0e-6f));
}

/// What hides the sky is surroundings, which reflect.
vec3 reflected(ConePlace place, Frame about, vec3 to_viewer, float alpha, vec3 bent, float openness, bool sky) {
    const Cone lobe = specular_cone(to_local(about, to_viewer), alpha);
    const float open = share_open(lobe, to_world(about, lobe.direction), bent, openness);
    vec3 sum = sky ? open * sky_specular(place.normal, to_viewer, sqrt(alpha)) : vec3(0.0f);
    const vec3 mirror = reflect(-to_viewer, place.normal);
    if (has_ambient) sum += (1.0f - open) * ambient_seen(dominant_reflection(place.normal, mirror, sqrt(alpha)), sky);
    return sum;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height))) || frame.batch != 0u) return;
    const ConePlace place = unpack_place(texelFetch(surface_places, pixel, 0));
    const bool asks_openness = draws_aov && frame.aov == frame_aov_occlusion;
    if (place.depth_m <= 0.0f || !(asks_openness || place.rough || place.glossy || place.coated)) return;
    const bool sky = sky_shines(frame.sky_enabled);
    const ConeLobes albedo = unpack_lobes(texelFetch(surface_albedos, pixel, 0), texelFetch(surface_lobes, pixel, 0).x);
    const vec3 ray = view_ray(pixel);
    const vec3 to_viewer = -normalize(ray);
    const Openness found = openness_of(pixel, place, frame.position + place.depth_m * ray, sky);
    // Unbiased, as the share of the weights of so few slices were not; of one sample it may leave 0 to 1.
    const float openness = 1.0f - found.hidden / float(push.slices);
    vec4 value = imageLoad(picture, pixel);
    if (asks_openness) {
        imageStore(picture, pixel, vec4(value.rgb + openness, value.a));
        return;
    }
    vec3 light = vec3(0.0f);
    // Of the sky the share, which keeps what its picture has between the looks at it.
    if (sky) light += sky_diffuse(place.normal) * found.open_sky / max(found.whole_sky, vec3(1.0e-30f));
    if (has_ambient) light += (1.0f - openness) * ambient_diffuse(place.normal, sky);
    light *= albedo.diffuse;
    // Of an open hemisphere the cosine-weighted mean direction is 2/3 of the normal.
    const vec3 open_way = place.normal * (2.0f / 3.0f) - found.hidden_way / float(push.slices);
    const vec3 bent = normalize(open_way + 1.0e-6f * place.normal);
    const Frame about = frame_from_normal(place.normal);
    if (place.glossy) light += albedo.specular * reflected(place, about, to_viewer, place.alpha, bent, openness, sky);
    if (place.coated) light += albedo.coat * reflected(place, about, to_viewer, place.coat_alpha, bent, openness, sky);
    value.rgb += light;
    imageStore(picture, pixel, value);
}
