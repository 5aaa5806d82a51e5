// Luminaires: intensities from a table of measured ones, sent out by a luminous opening; and what every light answers,
// luminaires included. Opens no namespace: C++ includes it inside the struct that answers luminaire_value, GLSL after it.
// Include before it, outside: shading/luminaire_shape.h. The includer defines
//
//   float luminaire_value(uint i)   the tables: count of polar angles, count of azimuths, the polar angles and the
//                                   azimuths in radians, ascending (azimuths from 0 to 2π, or one alone), then
//                                   intensities relative to the peak, by azimuth and then by polar angle
#ifndef HELIODON_SHADING_LUMINAIRE_H
#define HELIODON_SHADING_LUMINAIRE_H

/// The interval of ascending values that holds `x`: how many begin at or below it, of `count` − 1.
SHADING_FN uint luminaire_interval(uint first, uint count, float x) {
    uint low = 0u;
    uint high = count - 1u;
    while (low + 1u < high) {
        const uint middle = (low + high) / 2u;
        if (luminaire_value(first + middle) <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}
SHADING_FN float luminaire_fraction(uint lower, float x) {
    const float begin = luminaire_value(lower);
    const float end = luminaire_value(lower + 1u);
    return end > begin ? clamp((x - begin) / (end - begin), 0.0f, 1.0f) : 0.0f;
}

/// Bilinear in both angles (radians); nothing outside the measured polar angles.
SHADING_FN float luminaire_relative_intensity(uint table, float polar, float azimuth) {
    const uint polar_count = uint(luminaire_value(table));
    const uint azimuth_count = uint(luminaire_value(table + 1u));
    const uint polars = table + 2u;
    const uint azimuths = polars + polar_count;
    if (polar < luminaire_value(polars) || polar > luminaire_value(azimuths - 1u)) {
        return 0.0f;
    }
    const uint row = luminaire_interval(polars, polar_count, polar);
    const float down = luminaire_fraction(polars + row, polar);
    uint first = azimuths + azimuth_count + row;
    if (azimuth_count == 1u) {
        return mix(luminaire_value(first), luminaire_value(first + 1u), down);
    }
    const uint plane = luminaire_interval(azimuths, azimuth_count, azimuth);
    first += plane * polar_count;
    const uint second = first + polar_count;
    return mix(mix(luminaire_value(first), luminaire_value(first + 1u), down),
               mix(luminaire_value(second), luminaire_value(second + 1u), down), luminaire_fraction(azimuths + plane, azimuth));
}

SHADING_FN vec3 luminaire_side(SHADING_IN(LightData) light) {
    const vec3 y = cross(light.tangent, light.axis);
    return (light.opening & opening_mirrored) != 0u ? -y : y;
}
SHADING_FN vec3 luminaire_to_local(SHADING_IN(LightData) light, vec3 v) {
    return vec3(dot(v, light.tangent), dot(v, luminaire_side(light)), dot(v, light.axis));
}
SHADING_FN vec3 luminaire_to_world(SHADING_IN(LightData) light, vec3 v) {
    return light.tangent * v.x + luminaire_side(light) * v.y + light.axis * v.z;
}

/// Intensity in cd towards the unit direction `away`; of one point of an opening, that point's share of it.
SHADING_FN vec3 luminaire_intensity(SHADING_IN(LightData) light, vec3 away) {
    const vec3 local = luminaire_to_local(light, away);
    const float aside = length(vec2(local.x, local.y));
    const float polar = atan(aside, local.z);
    const float turned = aside > 0.0f ? atan(local.y, local.x) : 0.0f;
    const float azimuth = turned < 0.0f ? turned + 2.0f * pi : turned;
    float share = 1.0f;
    if (dot(light.weighted_normal, light.weighted_normal) > 0.0f) {
        const float area = opening_projected_area(light.opening & opening_shape_bits, light.half_extent, local);
        share = max(dot(light.weighted_normal, away), 0.0f) / area;
    }
    return light.intensity * (share * luminaire_relative_intensity(light.table, polar, azimuth));
}
/// Radiance in cd/m² of the opening towards `away`.
SHADING_FN vec3 luminaire_radiance(SHADING_IN(LightData) light, vec3 away) {
    const float area =
        opening_projected_area(light.opening & opening_shape_bits, light.half_extent, luminaire_to_local(light, away));
    return luminaire_intensity(light, away) / max(area, 1.0e-30f);
}

// -- any light: what light.h has for those without a table

SHADING_FN vec3 any_light_radiance(SHADING_IN(LightData) light, vec3 direction) {
    if (light.type != light_type_luminaire) {
        return light_radiance(light, direction);
    }
    return light.radius > 0.0f ? luminaire_radiance(light, -direction) : vec3(0.0f);
}

/// Distance at which a ray meets a light with an extent, or a negative number.
SHADING_FN float any_light_intersect(SHADING_IN(LightData) light, vec3 origin, vec3 direction) {
    if (light.type != light_type_luminaire) {
        return light_intersect(light, origin, direction);
    }
    if (light.radius <= 0.0f) {
        return -1.0f;
    }
    return opening_intersect(light.opening & opening_shape_bits, light.half_extent,
                             luminaire_to_local(light, origin - light.position), luminaire_to_local(light, direction)).t;
}

/// Density per steradian with which any_light_sample, from `point`, picks the unit direction `direction`, which meets
/// the light.
SHADING_FN float any_light_pdf(SHADING_IN(LightData) light, vec3 point, vec3 direction) {
    if (light.type != light_type_luminaire) {
        return light_pdf(light, point);
    }
    if (light.radius <= 0.0f) {
        return 0.0f;
    }
    const uint shape = light.opening & opening_shape_bits;
    const vec3 from = luminaire_to_local(light, point - light.position);
    const vec3 along = luminaire_to_local(light, direction);
    return opening_pdf(shape, light.half_extent, from, along, opening_intersect(shape, light.half_extent, from, along));
}

/// From the luminaire's position, whatever the extent of its opening.
SHADING_FN LightSample luminaire_point_sample(SHADING_IN(LightData) light, vec3 point) {
    const vec3 to_center = light.position - point;
    LightSample result;
    result.is_delta = true;
    result.pdf = 0.0f;
    result.value = vec3(0.0f);
    result.distance = length(to_center);
    result.direction = to_center / max(result.distance, 1.0e-30f);
    if (result.distance > 0.0f) {  // inverse-square law
        result.value = luminaire_intensity(light, -result.direction) / (result.distance * result.distance);
    }
    return result;
}

SHADING_FN LightSample any_light_sample(SHADING_IN(LightData) light, vec3 point, vec2 u) {
    if (light.type != light_type_luminaire) {
        return light_sample(light, point, u);
    }
    if (light.radius <= 0.0f) {
        return luminaire_point_sample(light, point);
    }
    const OpeningSample seen = opening_sample(light.opening & opening_shape_bits, light.half_extent,
                                              luminaire_to_local(light, point - light.position), u);
    LightSample result;
    result.is_delta = false;
    result.pdf = 0.0f;
    result.value = vec3(0.0f);
    result.distance = seen.t;
    result.direction = luminaire_to_world(light, seen.direction);
    if (seen.pdf <= 0.0f) {
        return result;
    }
    result.pdf = seen.pdf;
    result.value = luminaire_radiance(light, -result.direction) / seen.pdf;
    return result;
}

#endif
