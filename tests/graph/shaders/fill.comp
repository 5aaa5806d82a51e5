#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push { vec4 color; };

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(target)))) imageStore(target, texel, color);
}
