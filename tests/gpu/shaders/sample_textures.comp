#version 460
#extension GL_EXT_nonuniform_qualifier : require

layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Colors { vec4 colors[]; };
layout(set = 0, binding = 1) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 0) uniform sampler2D textures[];

void main() {
    const uint index = gl_GlobalInvocationID.x;
    colors[index] = textureLod(textures[nonuniformEXT(slots[index])], vec2(0.5), 0.0);
}
