#version 460
#extension GL_GOOGLE_include_directive : require
// One roughness level of the prefiltered sky, equirectangular like its source (north is applied where it
// is looked up). The samples are the same about every normal: a workgroup works them out once.
#include "passes/environment/environment_shared.h"
#include "shading/environment.h"
#include "shading/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
// Not by the table of textures: what is written here is in it.
layout(set = 0, binding = 1) uniform sampler2D source;
layout(push_constant) uniform Push { EnvironmentConstants push; };

const uint samples = 512u;
shared vec4 reflections[samples];  // direction about the normal, whose z is the weight; level

vec3 source_at(vec3 direction, float level) {
    return textureLod(source, sky_uv(direction, 0.0f), level).rgb;
}

void main() {
    const vec2 size = vec2(textureSize(source, 0));
    const float alpha = ggx_alpha(push.roughness);
    const float texel_steradian = 4.0f * pi / (size.x * size.y);
    for (uint i = gl_LocalInvocationIndex; i < samples; i += 64u) {
        const PrefilterSample s = prefilter_sample(hammersley(i, samples), alpha);
        reflections[i] = vec4(s.direction.xy, s.weight, prefilter_level(s.pdf, samples, texel_steradian));
    }
    barrier();
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= push.width || texel.y >= push.height) return;
    const vec3 normal = sky_direction((vec2(texel) + 0.5f) / vec2(push.width, push.height), 0.0f);
    if (push.roughness <= 0.0f) {
        imageStore(result, ivec2(texel), vec4(source_at(normal, max(log2(size.x / float(push.width)), 0.0f)), 1.0f));
        return;
    }
    const Frame frame = frame_from_normal(normal);
    vec3 sum = vec3(0.0f);
    float weight = 0.0f;
    for (uint i = 0u; i < samples; ++i) {
        const vec4 s = reflections[i];
        if (s.z <= 0.0f) continue;
        sum += source_at(to_world(frame, s.xyz), s.w) * s.z;
        weight += s.z;
    }
    imageStore(result, ivec2(texel), vec4(sum / max(weight, 1.0e-6f), 1.0f));
}
