// Light sources other than emissive surfaces and the sky: point, spot and Lambertian lights (spheres
// where they have a radius) and directional lights (discs in the sky where they have an angular radius). luminaire.h has
// the same for luminaires, and for any light.
// docs/lights.md gives the units and formulas.
#ifndef HELIODON_SHADING_LIGHT_H
#define HELIODON_SHADING_LIGHT_H
#include "shading/sampling.h"
#include "shading/scene_data.h"
SHADING_BEGIN

SHADING_CONST float light_distance_infinite = 1.0e30f;  // metres: where directional lights stand

struct LightSample {
    vec3 direction;  // unit, from the point to the light
    float distance;  // metres, to the light's surface; shadow rays end just before it
    vec3 value;      // the light adds f · |cos θi| · value · visibility. Delta lights: illuminance (lux) on a
                     // plane facing it; area lights: radiance (cd/m²) / pdf
    float pdf;       // per steradian; 0 for delta lights
    bool is_delta;   // no ray hits it by chance: no multiple importance sampling
};

/// glTF's (KHR_lights_punctual) falloff squared: ((cos θ − cos outer)/(cos inner − cos outer))².
SHADING_FN float spot_falloff(float cos_theta, float cos_inner, float cos_outer) {
    if (cos_inner <= cos_outer) {
        return cos_theta >= cos_outer ? 1.0f : 0.0f;
    }
    float t = clamp((cos_theta - cos_outer) / (cos_inner - cos_outer), 0.0f, 1.0f);
    return t * t;
}

/// Intensity in cd towards the unit direction `away` from the light.
SHADING_FN vec3 light_intensity(LightData light, vec3 away) {
    float cos_theta = dot(light.axis, away);
    if (light.type == light_type_spot) {
        return light.intensity * spot_falloff(cos_theta, light.cos_inner, light.cos_outer);
    }
    if (light.type == light_type_lambertian) {
        return light.intensity * max(cos_theta, 0.0f);
    }
    return light.intensity;
}

/// Flux in lm (RGB), exactly; directional lights have none and return 0. Point 4πI; Lambertian πI; spot
/// 2πI (1 − cos inner + (cos inner − cos outer)/3), the integral of spot_falloff over the sphere; luminaire as measured.
SHADING_FN vec3 light_flux(LightData light) {
    if (light.type == light_type_point) {
        return light.intensity * (4.0f * pi);
    }
    if (light.type == light_type_lambertian) {
        return light.intensity * pi;
    }
    if (light.type == light_type_spot) {
        return light.intensity *
               (2.0f * pi * (1.0f - light.cos_inner + (light.cos_inner - light.cos_outer) * (1.0f / 3.0f)));
    }
    if (light.type == light_type_luminaire) {
        return light.intensity * light.flux_factor;
    }
    return vec3(0.0f);
}

SHADING_FN bool light_is_delta(LightData light) {
    return light.radius <= 0.0f;
}

/// 1 − cos α from sin² α, without cancellation for small angles.
SHADING_FN float one_minus_cos_from_sin2(float sin2) {
    return sin2 / (1.0f + sqrt(max(0.0f, 1.0f - sin2)));
}

/// 1 − cos of the half-angle under which an area light appears from `point`; 0 from within a sphere,
/// whose inner side emits nothing.
SHADING_FN float light_cone(LightData light, vec3 point) {
    if (light.type == light_type_directional) {
        float s = sin(0.5f * light.radius);
        return 2.0f * s * s;
    }
    vec3 to_center = light.position - point;
    float d2 = dot(to_center, to_center);
    float r2 = light.radius * light.radius;
    return d2 <= r2 ? 0.0f : one_minus_cos_from_sin2(r2 / d2);
}

/// The sun's luminance relative to its mean, at sin²(angle from its middle) / sin²(angular radius): Neckel & Labs 1994, "Solar
/// limb darkening 1986-1990", table 1, at 560 nm. Its mean over the disc is 0.80605 of the middle's.
SHADING_FN float limb_darkening(float sin2_ratio) {
    float mu = sqrt(max(1.0f - sin2_ratio, 0.0f));
    float of_middle = 0.26892f + mu * (1.34319f + mu * (-1.58427f + mu * (1.91271f + mu * (-1.3135f + mu * 0.37295f))));
    return of_middle * (1.0f / 0.80605f);
}

/// Radiance in cd/m² along a ray that travels in `direction` and meets the area light. A sphere's
/// radiance I(ω)/(πr²) makes its far intensity I(ω) exactly; a disc's E/(π sin² α) its illuminance E on a
/// plane facing it.
SHADING_FN vec3 light_radiance(LightData light, vec3 direction) {
    if (light.radius <= 0.0f) {
        return vec3(0.0f);
    }
    if (light.type == light_type_directional) {
        float s = sin(light.radius);
        vec3 mean = light.intensity / (pi * s * s);
        if (light.opening != opening_sun) {
            return mean;
        }
        if (direction.y < 0.0f) {  // behind the ground, as what is of the sky there (sky_radiance)
            return vec3(0.0f);
        }
        // The chord keeps the digits of small angles.
        vec3 chord = direction + light.axis;
        float chord2 = dot(chord, chord);
        return mean * limb_darkening(chord2 * (1.0f - 0.25f * chord2) / (s * s));
    }
    return light_intensity(light, -direction) / (pi * light.radius * light.radius);
}

/// Density per steradian with which light_sample, from `point`, picks a direction that meets the light.
SHADING_FN float light_pdf(LightData light, vec3 point) {
    float cone = light.radius > 0.0f ? light_cone(light, point) : 0.0f;
    return cone > 0.0f ? cone_pdf(cone) : 0.0f;
}

/// Where a ray meets an area light: the distance in metres (light_distance_infinite for a directional
/// disc), or a negative number. `direction` is unit.
SHADING_FN float light_intersect(LightData light, vec3 origin, vec3 direction) {
    if (light.radius <= 0.0f || light.type == light_type_none) {
        return -1.0f;
    }
    if (light.type == light_type_directional) {
        // sin² of half the angle to the disc's centre against that of half its radius
        vec3 chord = direction + light.axis;
        float s = 2.0f * sin(0.5f * light.radius);
        return dot(chord, chord) <= s * s ? light_distance_infinite : -1.0f;
    }
    vec3 to_center = light.position - origin;
    float b = dot(to_center, direction);
    vec3 perpendicular = to_center - direction * b;  // Hearn & Baker's form keeps the digits far away
    float h2 = light.radius * light.radius - dot(perpendicular, perpendicular);
    if (h2 < 0.0f || b <= 0.0f || dot(to_center, to_center) <= light.radius * light.radius) {
        return -1.0f;
    }
    return b - sqrt(h2);
}

/// A direction from `point` to the light; value 0 where it sends nothing there. Spheres are sampled by
/// the solid angle of their cone: Shirley, Wang & Zimmerman 1996, section 3.2.
SHADING_FN LightSample light_sample(LightData light, vec3 point, vec2 u) {
    LightSample result;
    result.direction = vec3(0.0f, 1.0f, 0.0f);
    result.distance = light_distance_infinite;
    result.value = vec3(0.0f);
    result.pdf = 0.0f;
    result.is_delta = light_is_delta(light);
    if (light.type == light_type_none) {
        return result;
    }
    bool directional = light.type == light_type_directional;
    vec3 to_center = directional ? -light.axis : light.position - point;
    float d2 = dot(to_center, to_center);
    if (d2 <= 0.0f) {
        return result;
    }
    float d = sqrt(d2);
    vec3 axis = to_center / d;
    if (result.is_delta) {
        result.direction = axis;
        result.distance = directional ? light_distance_infinite : d;
        // Inverse-square law of a point's illuminance; a directional light states its illuminance.
        result.value = directional ? light.intensity : light_intensity(light, -axis) / d2;
        return result;
    }
    float cone = light_cone(light, point);
    if (cone <= 0.0f) {
        return result;
    }
    vec3 local = sample_cone(u, cone);
    result.direction = to_world(frame_from_normal(axis), local);
    result.pdf = cone_pdf(cone);
    if (!directional) {
        float sin2 = local.x * local.x + local.y * local.y;
        result.distance = d * local.z - sqrt(max(0.0f, light.radius * light.radius - d2 * sin2));
    }
    result.value = light_radiance(light, result.direction) / result.pdf;
    return result;
}

SHADING_END
#endif
