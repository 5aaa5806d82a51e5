#version 460
#extension GL_GOOGLE_include_directive : require
// One level of an equirectangular picture of a sky that is a formula: the mean over each texel.
#include "passes/environment/environment_shared.h"
#include "shading/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
layout(set = 0, binding = 1, std430) readonly buffer Sky { SkyData sky; };
layout(push_constant) uniform Push { SkyPictureConstants push; };

const uint points_a_side = 4u;

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= push.width || texel.y >= push.height) return;
    vec3 sum = vec3(0.0f);
    float weight = 0.0f;
    for (uint i = 0u; i < points_a_side * points_a_side; ++i) {
        const vec2 within = (vec2(i % points_a_side, i / points_a_side) + 0.5f) / float(points_a_side);
        const vec2 uv = (vec2(texel) + within) / vec2(push.width, push.height);
        const float sin_polar = sin(pi * uv.y);
        sum += sin_polar * sky_radiance(sky, sky_direction(uv, sky.north_rad), vec3(1.0f));
        weight += sin_polar;
    }
    imageStore(result, ivec2(texel), vec4(sum / weight, 1.0f));
}
