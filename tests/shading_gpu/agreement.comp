#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Tables { float tables[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Values { vec4 values[]; };

#include "shading_gpu/agreement_case.h"
float shading_table(uint index) { return tables[index]; }

vec4 scene_texture(uint texture_index, vec2 uv) { return vec4(uv, float(texture_index), 1.0f); }
vec2 scene_texture_size(uint texture_index) { return vec2(64.0f); }
// Included to prove that it compiles at global scope.
#include "shading/material_fetch.h"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < uint(values.length())) {
        values[index] = agreement_value(index / agreement_values, index % agreement_values);
    }
}
