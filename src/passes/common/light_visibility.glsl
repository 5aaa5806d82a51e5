// Does a light reach a point? By its shadow map, or by a cone of its true size through the voxel volume.
#ifndef HELIODON_LIGHT_VISIBILITY_GLSL
#define HELIODON_LIGHT_VISIBILITY_GLSL
#include "passes/common/shadow_lookup.glsl"
#include "passes/cone_trace/volume.glsl"
#include "shading/cone.h"

layout(constant_id = 7) const bool cone_shadows = false;

float cone_shadow(LightData light, vec3 point, vec3 normal) {
    const bool directional = light.type == light_type_directional;
    const vec3 to_light = directional ? -light.axis : light.position - point;
    const float distance = length(to_light);
    LightData whole = light;
    whole.radius = light.cone_radius;
    const float reach = directional ? 1.0e30f : max(distance - light.cone_radius, 0.0f) / volume.voxel_m;
    return 1.0f - trace_cone(cone_origin(point, normal), to_light / distance, light_cone_tan(whole, point), reach).cover;
}

/// Share of `light` that reaches `point` on a surface of geometric normal `normal`.
float light_reaching(LightData light, vec3 point, vec3 normal, uint filter_mode) {
    if (cone_shadows && light.cone_radius > 0.0f) return cone_shadow(light, point, normal);
    return light_visibility(light, point, normal, filter_mode);
}

#endif
