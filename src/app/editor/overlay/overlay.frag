#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "app/editor/overlay/overlay_shared.h"

layout(set = 1, binding = 0) uniform sampler2D textures[];
layout(push_constant) uniform Push { OverlayPush push; };

layout(location = 0) in vec2 texcoord;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

void main() { result = color * texture(textures[push.texture_slot], texcoord); }
