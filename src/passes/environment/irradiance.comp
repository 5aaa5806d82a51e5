#version 460
#extension GL_GOOGLE_include_directive : require
// Irradiance / π by normal: the cosine-weighted mean over every texel of a reduced sky, so that no bright
// spot is missed.
#include "passes/common/textures.glsl"
#include "passes/environment/environment_shared.h"
#include "shading/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
layout(push_constant) uniform Push { EnvironmentConstants push; };

const uint source_columns = 128u;

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= push.width || texel.y >= push.height) return;
    const vec3 normal = sky_direction((vec2(texel) + 0.5f) / vec2(push.width, push.height), 0.0f);
    const int last = textureQueryLevels(textures[nonuniformEXT(push.source)]) - 1;
    const vec2 full = vec2(textureSize(textures[nonuniformEXT(push.source)], 0));
    const int level = clamp(int(ceil(log2(full.x / float(source_columns)))), 0, last);
    const ivec2 size = textureSize(textures[nonuniformEXT(push.source)], level);
    vec3 sum = vec3(0.0f);
    float weight = 0.0f;
    for (int y = 0; y < size.y; ++y) {
        const float sin_polar = sin(pi * (float(y) + 0.5f) / float(size.y));
        for (int x = 0; x < size.x; ++x) {
            const vec3 direction = sky_direction((vec2(x, y) + 0.5f) / vec2(size), 0.0f);
            const float w = max(dot(direction, normal), 0.0f) * sin_polar;
            if (w <= 0.0f) continue;
            sum += texelFetch(textures[nonuniformEXT(push.source)], ivec2(x, y), level).rgb * w;
            weight += w;
        }
    }
    imageStore(result, ivec2(texel), vec4(sum / max(weight, 1.0e-6f), 1.0f));
}
