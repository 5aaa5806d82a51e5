// From cd/m² to the display.
#ifndef HELIODON_SHADING_TONE_H
#define HELIODON_SHADING_TONE_H
#include "core/units.h"
#include "shading/language.h"
SHADING_BEGIN

#ifdef __cplusplus
using units::ev100_from_camera;
using units::exposure_scale;
using units::srgb_decode;
using units::srgb_encode;
#endif

/// Hable 2010, "Filmic Tonemapping for Real-time Rendering", with his published A … F:
/// (x(Ax + CB) + DE)/(x(Ax + B) + DF) − E/F, brought over one denominator so that black stays exactly black.
SHADING_FN vec3 hable_partial(vec3 x) {
    float a = 0.15f;
    float b = 0.50f;
    float c = 0.10f;
    float d = 0.20f;
    float e = 0.02f;
    float f = 0.30f;
    return x * (x * (a * (f - e)) + vec3(b * (c * f - e))) / ((x * (x * a + vec3(b)) + vec3(d * f)) * f);
}
/// White at 11.2, exposure bias 2, as published. Input exposed, output linear in [0, 1].
SHADING_FN vec3 tone_hable(vec3 exposed) {
    return clamp(hable_partial(max(exposed, vec3(0.0f)) * 2.0f) / hable_partial(vec3(11.2f)), vec3(0.0f), vec3(1.0f));
}

SHADING_FN vec3 srgb_encode_rgb(vec3 linear) {
    return vec3(srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z));
}

SHADING_END
#endif
