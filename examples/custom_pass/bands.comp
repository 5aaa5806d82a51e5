#version 460
#extension GL_EXT_samplerless_texture_functions : require
// Luminance in steps of one stop: each band of the picture is twice as bright as the one below it.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform texture2D radiance;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D bands;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(bands)))) return;
    vec3 color = texelFetch(radiance, pixel, 0).rgb;
    float luminance = dot(color, vec3(0.2126, 0.7152, 0.0722));  // cd/m², ITU-R BT.709-6
    imageStore(bands, pixel, vec4(vec3(exp2(floor(log2(max(luminance, 1e-6))))), 1.0));
}
