// What lights' light a voxel's face reflects specularly: the sum of lobes of all lights.
#ifndef HELIODON_FACE_LOBE_GLSL
#define HELIODON_FACE_LOBE_GLSL

/// `light` times lobe_density() is radiance; the lobes' mean over the sphere is `direction` over `weight`.
struct FaceLobe {
    vec3 light;  // in radiance units of the grid
    vec3 direction;
    float weight;
};
const FaceLobe no_lobe = FaceLobe(vec3(0.0f), vec3(0.0f), 0.0f);

/// As buffers keep it: half floats.
uvec4 packed_lobe(FaceLobe lobe) {
    const float largest_half = 65504.0f;
    const float scale = min(1.0f, largest_half / max(lobe.weight, max(lobe.light.x, max(lobe.light.y, lobe.light.z))));
    const vec3 light = scale * lobe.light;
    const vec4 direction = scale * vec4(lobe.direction, lobe.weight);
    return uvec4(packHalf2x16(light.rg), packHalf2x16(vec2(light.b, 0.0f)), packHalf2x16(direction.xy), packHalf2x16(direction.zw));
}
FaceLobe unpacked_lobe(uvec4 words) {
    const vec2 last = unpackHalf2x16(words.w);
    return FaceLobe(vec3(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x), vec3(unpackHalf2x16(words.z), last.x), last.y);
}

#endif
