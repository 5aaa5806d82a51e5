#version 460
#extension GL_GOOGLE_include_directive : require
// One roughness level of the prefiltered sky, equirectangular like its source (north is applied where it
// is looked up).
#include "passes/common/textures.glsl"
#include "passes/environment/environment_shared.h"
#include "shading/environment.h"
#include "shading/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
layout(push_constant) uniform Push { EnvironmentConstants push; };

vec3 source_at(vec3 direction, float level) {
    return textureLod(textures[nonuniformEXT(push.source)], sky_uv(direction, 0.0f), level).rgb;
}

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= push.width || texel.y >= push.height) return;
    const vec3 normal = sky_direction((vec2(texel) + 0.5f) / vec2(push.width, push.height), 0.0f);
    const vec2 size = vec2(textureSize(textures[nonuniformEXT(push.source)], 0));
    vec3 sum = vec3(0.0f);
    if (push.roughness <= 0.0f) {
        sum = source_at(normal, max(log2(size.x / float(push.width)), 0.0f));
    } else {
        const Frame frame = frame_from_normal(normal);
        const float alpha = ggx_alpha(push.roughness);
        const float texel_steradian = 4.0f * pi / (size.x * size.y);
        float weight = 0.0f;
        for (uint i = 0u; i < push.samples; ++i) {
            const PrefilterSample s = prefilter_sample(hammersley(i, push.samples), alpha);
            if (s.weight <= 0.0f) continue;
            sum += source_at(to_world(frame, s.direction), prefilter_level(s.pdf, push.samples, texel_steradian)) * s.weight;
            weight += s.weight;
        }
        sum /= max(weight, 1.0e-6f);
    }
    imageStore(result, ivec2(texel), vec4(sum, 1.0f));
}
