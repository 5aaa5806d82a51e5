// From cd/m² to the display.
#ifndef HELIODON_SHADING_TONE_H
#define HELIODON_SHADING_TONE_H
#include "shading/language.h"
SHADING_BEGIN

/// What radiance is multiplied by before a tone curve: 1/(1.2 · 2^EV100). ISO 12232:2006's saturation
/// speed 78/Lmax with a lens of q = 0.65 makes the 1.2 (Lagarde & de Rousiers 2014, section 5.1.2).
SHADING_FN float exposure_scale(float ev100) {
    return 1.0f / (1.2f * exp2(ev100));
}

/// log2(N²/t · 100/S): aperture f-number, shutter in seconds, sensitivity in ISO.
SHADING_FN float ev100_from_camera(float aperture_f, float shutter_s, float iso) {
    return log2(aperture_f * aperture_f / shutter_s * 100.0f / iso);
}

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

/// IEC 61966-2-1:1999, linear [0, 1] to encoded [0, 1].
SHADING_FN float srgb_encode(float linear) {
    float x = clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}
SHADING_FN vec3 srgb_encode_rgb(vec3 linear) {
    return vec3(srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z));
}
/// IEC 61966-2-1:1999, encoded to linear.
SHADING_FN float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : pow((encoded + 0.055f) / 1.055f, 2.4f);
}
SHADING_FN vec3 srgb_decode_rgb(vec3 encoded) {
    return vec3(srgb_decode(encoded.x), srgb_decode(encoded.y), srgb_decode(encoded.z));
}

SHADING_END
#endif
