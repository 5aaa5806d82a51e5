#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform writeonly image2D target;

// The left half only: the right one is left as it was.
void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x < imageSize(target).x / 2 && texel.y < imageSize(target).y) imageStore(target, texel, vec4(1.0));
}
