// Sending light out of point, spot, Lambertian and directional lights: the directions in which it leaves.
#ifndef HELIODON_SHADING_LIGHT_EMISSION_H
#define HELIODON_SHADING_LIGHT_EMISSION_H
#include "shading/light.h"
SHADING_BEGIN

/// Shares of a spot's flux within its inner cone and between the two cones, over 2π I (see light_flux).
SHADING_FN vec2 spot_flux_parts(LightData light) {
    float inner = max(light.cos_inner, light.cos_outer);
    return vec2(1.0f - inner, (inner - light.cos_outer) * (1.0f / 3.0f));
}

/// Density per steradian with which light_sample_emission sends light in `direction`: in proportion to the
/// intensity where that has a closed form, else even; 0 for directional lights without an extent.
SHADING_FN float light_emission_pdf(LightData light, vec3 direction) {
    float cosine = dot(light.axis, direction);
    if (light.type == light_type_directional) {
        return light.radius > 0.0f ? cone_pdf(light_cone(light, vec3(0.0f))) : 0.0f;
    }
    if (light.type == light_type_spot) {
        vec2 parts = spot_flux_parts(light);
        return spot_falloff(cosine, light.cos_inner, light.cos_outer) / (2.0f * pi * max(parts.x + parts.y, 1.0e-30f));
    }
    if (light.type == light_type_lambertian) {
        return cosine_hemisphere_pdf(cosine);
    }
    return uniform_sphere_pdf;
}

SHADING_FN vec3 light_sample_emission(LightData light, vec2 u) {
    if (light.type == light_type_directional) {
        return light.radius > 0.0f ? to_world(frame_from_normal(light.axis), sample_cone(u, light_cone(light, vec3(0.0f))))
                                   : light.axis;
    }
    if (light.type == light_type_spot) {
        // Between the cones the falloff is t², whose integral t³/3 the cube root inverts.
        vec2 parts = spot_flux_parts(light);
        float share = u.x * (parts.x + parts.y);
        float below_one = share;  // 1 − cos
        if (share > parts.x && parts.y > 0.0f) {
            below_one = 1.0f - light.cos_outer - 3.0f * parts.y * pow(1.0f - (share - parts.x) / parts.y, 1.0f / 3.0f);
        }
        return to_world(frame_from_normal(light.axis), sample_cone(vec2(1.0f, u.y), below_one));
    }
    if (light.type == light_type_lambertian) {
        return to_world(frame_from_normal(light.axis), sample_cosine_hemisphere(u));
    }
    return sample_uniform_sphere(u);
}

SHADING_END
#endif
