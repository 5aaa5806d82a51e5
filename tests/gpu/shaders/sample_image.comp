#version 460

layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler2D source;
layout(binding = 1) uniform samplerCube cube;
layout(binding = 2) uniform sampler3D volume;
layout(binding = 3) buffer Colors { vec4 colors[]; };

void main() {
    colors[0] = textureLod(source, vec2(0.5), 0.0);
    colors[1] = textureLod(source, vec2(0.5), 1.0);
    colors[2] = textureLod(cube, vec3(1.0, 0.0, 0.0), 0.0);
    colors[3] = textureLod(cube, vec3(0.0, 0.0, -1.0), 0.0);
    colors[4] = textureLod(volume, vec3(0.5, 0.5, 0.75), 0.0);
}
