#version 460
#extension GL_GOOGLE_include_directive : require
// Irradiance / π by normal: the cosine-weighted mean over every texel of a reduced sky, so that no bright
// spot is missed. A workgroup a normal: its invocations share the texels.
#include "passes/environment/environment_shared.h"
#include "shading/sky.h"

layout(local_size_x = 128) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
// Not by the table of textures: what is written here is in it.
layout(set = 0, binding = 1) uniform sampler2D source;
layout(push_constant) uniform Push { EnvironmentConstants push; };

const uint source_columns = 128u;
shared vec4 parts[gl_WorkGroupSize.x];

void main() {
    const uvec2 texel = gl_WorkGroupID.xy;
    const vec3 normal = sky_direction((vec2(texel) + 0.5f) / vec2(push.width, push.height), 0.0f);
    const int last = textureQueryLevels(source) - 1;
    const vec2 full = vec2(textureSize(source, 0));
    const int level = clamp(int(ceil(log2(full.x / float(source_columns)))), 0, last);
    const uvec2 size = uvec2(textureSize(source, level));
    vec4 sum = vec4(0.0f);
    for (uint i = gl_LocalInvocationIndex; i < size.x * size.y; i += gl_WorkGroupSize.x) {
        const uvec2 at = uvec2(i % size.x, i / size.x);
        const vec3 direction = sky_direction((vec2(at) + 0.5f) / vec2(size), 0.0f);
        const float sin_polar = sqrt(max(0.0f, 1.0f - direction.y * direction.y));
        const float weight = sin_polar * (push.even != 0u ? 1.0f : max(dot(direction, normal), 0.0f));
        if (weight > 0.0f) sum += weight * vec4(texelFetch(source, ivec2(at), level).rgb, 1.0f);
    }
    parts[gl_LocalInvocationIndex] = sum;
    for (uint half_count = gl_WorkGroupSize.x / 2u; half_count > 0u; half_count /= 2u) {
        barrier();
        if (gl_LocalInvocationIndex < half_count) parts[gl_LocalInvocationIndex] += parts[gl_LocalInvocationIndex + half_count];
    }
    if (gl_LocalInvocationIndex > 0u) return;
    sum = parts[0];
    imageStore(result, ivec2(texel), vec4(sum.rgb / max(sum.a, 1.0e-6f), 1.0f));
}
