// From cd/m² to the display.
#ifndef HELIODON_SHADING_TONE_H
#define HELIODON_SHADING_TONE_H
#include "core/units.h"
#include "shading/language.h"
SHADING_BEGIN

#ifdef __cplusplus
using units::ev100_from_camera;
using units::exposure_scale;
using units::luminance;
using units::srgb_decode;
using units::srgb_encode;
#endif

SHADING_CONST uint tone_curve_linear = 0u;
SHADING_CONST uint tone_curve_hable = 1u;
SHADING_CONST uint tone_curve_reinhard = 2u;
SHADING_CONST uint tone_curve_aces = 3u;            // Hill's fit of the reference and output transforms
SHADING_CONST uint tone_curve_aces_narkowicz = 4u;  // a fit of the same by one curve a channel
SHADING_CONST uint tone_curve_agx = 5u;
SHADING_CONST uint tone_curve_neutral = 6u;

/// The exposed value that becomes white: as published for Hable, two stops over the sensor's saturation for Reinhard.
SHADING_CONST float hable_white = 11.2f;
SHADING_CONST float reinhard_white = 4.0f;

// All curves: input exposed (L / (1.2 · 2^EV100)) and not negative, output linear; tone_map clamps it to [0, 1].

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
/// Exposure bias 2, as published.
SHADING_FN vec3 tone_hable(vec3 exposed, float white) {
    return hable_partial(exposed * 2.0f) / hable_partial(vec3(white));
}

/// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", eq. 4, of the luminance: hues stay.
SHADING_FN vec3 tone_reinhard(vec3 exposed, float white) {
    float l = luminance(exposed);
    return exposed * ((1.0f + l / (white * white)) / (1.0f + l));
}

/// Hill 2016, "ACES fitted" (BakingLab): sRGB to the rendering transform's primaries with its desaturation, a rational
/// fit of the reference rendering and sRGB output transforms, and back.
SHADING_FN vec3 tone_aces(vec3 exposed) {
    vec3 v = vec3(dot(vec3(0.59719f, 0.35458f, 0.04823f), exposed), dot(vec3(0.07600f, 0.90834f, 0.01566f), exposed),
                  dot(vec3(0.02840f, 0.13383f, 0.83777f), exposed));
    v = (v * (v + vec3(0.0245786f)) - vec3(0.000090537f)) / (v * (v * 0.983729f + vec3(0.4329510f)) + vec3(0.238081f));
    return vec3(dot(vec3(1.60475f, -0.53108f, -0.07367f), v), dot(vec3(-0.10208f, 1.10813f, -0.00605f), v),
                dot(vec3(-0.00327f, -0.07276f, 1.07602f), v));
}

/// Narkowicz 2016, "ACES Filmic Tone Mapping Curve".
SHADING_FN vec3 tone_aces_narkowicz(vec3 exposed) {
    return exposed * (exposed * 2.51f + vec3(0.03f)) / (exposed * (exposed * 2.43f + vec3(0.59f)) + vec3(0.14f));
}

/// One side of AgX's sigmoid through the pivot, for `x` ≥ 0 beyond it and `y` left to its end (Sobotka 2022): a line of
/// slope 2 bent by `power` so that it just reaches the end at `end`.
SHADING_FN float agx_side(float x, float end, float power) {
    float slope = 2.0f;
    float y_end = 0.5f;
    float scale = pow(pow(slope * end, -power) * (pow(slope * end / y_end, power) - 1.0f), -1.0f / power);
    float t = slope * x / scale;
    return scale * t / pow(1.0f + pow(t, power), 1.0f / power);
}
/// AgX's default contrast, display-encoded by 2.2: stops from 10 below to 6.5 above 0.18, which becomes a half, by a
/// sigmoid of toe 3 and shoulder 3.25.
SHADING_FN float agx_contrast(float exposed) {
    float least_stop = -12.47393f;  // log2 of 0.18 less 10
    float most_stop = 4.026069f;    // log2 of 0.18 and 6.5
    float pivot = 10.0f / 16.5f;
    float x = (clamp(log2(max(exposed, 1e-10f)), least_stop, most_stop) - least_stop) / (most_stop - least_stop);
    return x < pivot ? 0.5f - agx_side(pivot - x, pivot, 3.0f) : 0.5f + agx_side(x - pivot, 1.0f - pivot, 3.25f);
}
/// AgX (Sobotka 2022): primaries drawn in before the curve and back after it (Wrensch 2023, "Minimal AgX
/// Implementation": the matrices for linear Rec. 709, their rows made to add up to 1, so that grey stays grey).
SHADING_FN vec3 tone_agx(vec3 exposed) {
    vec3 v = vec3(dot(vec3(0.842364158f, 0.0784229025f, 0.0792129399f), exposed),
                  dot(vec3(0.0423298082f, 0.878501136f, 0.0791690562f), exposed),
                  dot(vec3(0.0423776793f, 0.0784373471f, 0.879184974f), exposed));
    v = vec3(agx_contrast(v.x), agx_contrast(v.y), agx_contrast(v.z));
    v = vec3(dot(vec3(1.19704227f, -0.098017255f, -0.0990250133f), v),
             dot(vec3(-0.0529040673f, 1.15186052f, -0.0989564493f), v),
             dot(vec3(-0.0529788612f, -0.0980398231f, 1.15101868f), v));
    return pow(max(v, vec3(0.0f)), vec3(2.2f));
}

/// Khronos Group 2024, "PBR Neutral Tone Mapper Specification": colours below 0.76 keep their value less the Fresnel
/// reflection of black, brighter ones are compressed and whitened.
SHADING_FN vec3 tone_neutral(vec3 exposed) {
    float f90 = 0.04f;
    float start = 0.8f - f90;
    float desaturation = 0.15f;
    float least = min(exposed.x, min(exposed.y, exposed.z));
    vec3 color = exposed - vec3(least < 2.0f * f90 ? least - least * least / (4.0f * f90) : f90);
    float peak = max(color.x, max(color.y, color.z));
    if (peak < start) {
        return color;
    }
    float room = 1.0f - start;
    float compressed = 1.0f - room * room / (peak + room - start);
    float saturated = 1.0f / (desaturation * (peak - compressed) + 1.0f);
    return mix(vec3(compressed), color * (compressed / peak), saturated);
}

/// `exposed` by `curve` (tone_curve_*), linear in [0, 1]. `white` counts for hable and reinhard.
SHADING_FN vec3 tone_map(uint curve, float white, vec3 exposed) {
    vec3 x = max(exposed, vec3(0.0f));
    vec3 shown = x;
    if (curve == tone_curve_hable) {
        shown = tone_hable(x, white);
    } else if (curve == tone_curve_reinhard) {
        shown = tone_reinhard(x, white);
    } else if (curve == tone_curve_aces) {
        shown = tone_aces(x);
    } else if (curve == tone_curve_aces_narkowicz) {
        shown = tone_aces_narkowicz(x);
    } else if (curve == tone_curve_agx) {
        shown = tone_agx(x);
    } else if (curve == tone_curve_neutral) {
        shown = tone_neutral(x);
    }
    return clamp(shown, vec3(0.0f), vec3(1.0f));
}

SHADING_FN vec3 srgb_encode_rgb(vec3 linear) {
    return vec3(srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z));
}

SHADING_END
#endif
