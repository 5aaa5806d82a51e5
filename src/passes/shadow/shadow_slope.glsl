#ifndef HELIODON_SHADOW_SLOPE_GLSL
#define HELIODON_SHADOW_SLOPE_GLSL

/// How the stored triangle's depth changes from texel to texel, relative to the depth itself, so that
/// 16-bit floats hold it at any distance. Depth is linear in the window, so this is the triangle's plane.
vec2 depth_slope() {
    const float z = gl_FragCoord.z;
    return clamp(vec2(dFdx(z), dFdy(z)) / max(z, 1.0e-30f), vec2(-60000.0f), vec2(60000.0f));
}

#endif
