// The cones that the voxel volume is traced with: the diffuse hemisphere in cells, a light of its true size; those of
// GGX's lobes are in lobe_cone.h. docs/gi-theory.md derives them. Directions are local, z = normal.
#ifndef HELIODON_SHADING_CONE_H
#define HELIODON_SHADING_CONE_H
#include "shading/environment.h"
#include "shading/light.h"
SHADING_BEGIN

struct Cone {
    vec3 direction;  // unit
    float tan_half_angle;
    float one_minus_cos;  // of the half-angle: solid angle / 2π
    float weight;         // share of the lobe's energy that this cone stands for
};

SHADING_FN float tan_from_one_minus_cos(float one_minus_cos) {
    return sqrt(max(0.0f, one_minus_cos * (2.0f - one_minus_cos))) / max(1.0f - one_minus_cos, 1.0e-6f);
}
SHADING_FN float one_minus_cos_from_tan(float tangent) {
    float squared = tangent * tangent;
    return squared / (1.0f + squared + sqrt(1.0f + squared));  // 1 − 1/√(1 + tan²) without cancellation
}

SHADING_CONST uint cones_per_set = 9u;

/// Cone `cone` of cones_per_set of set `set_index` of `set_count`: irradiance = π Σ weight · radiance over all. The
/// hemisphere is projected onto the disk (Nusselt 1928), where areas are cosine-weighted solid angles, and cut into
/// nine cells of equal area: three round the normal (sin² θ in [0, 1/3]), six about them. Each set has one point
/// in each cell, together a Hammersley set, moved round the cell by `shift` in [0, 1)² (Cranley & Patterson
/// 1976): (0, 0) leaves it centred (one set: the cells' middles), and the mean over even shifts is without bias. A
/// cone has the solid angle of its cell / set_count, so that all of them have the hemisphere's; where 1 / `share` such
/// hemispheres of cones are averaged, at as many shifts, it has `share` of that, and they have it together.
SHADING_FN Cone diffuse_cone(uint cone, uint set_index, uint set_count, vec2 shift, float share) {
    bool inner = cone < 3u;
    float sectors = inner ? 3.0f : 6.0f;
    float sector = float(inner ? cone : cone - 3u);
    vec2 u = fract(hammersley(set_index, set_count) + vec2(0.0f, 0.5f / float(set_count)) + shift);
    float sin2 = inner ? u.x * (1.0f / 3.0f) : (1.0f + 2.0f * u.x) * (1.0f / 3.0f);
    float phi = 2.0f * pi * (sector + u.y) / sectors;
    float sine = sqrt(sin2);
    float boundary = 0.816496580927726f;  // √(2/3): cos θ where sin² θ = 1/3
    Cone result;
    result.direction = vec3(sine * cos(phi), sine * sin(phi), sqrt(max(0.0f, 1.0f - sin2)));
    result.one_minus_cos = (inner ? 1.0f - boundary : boundary) / (sectors * float(set_count)) * share;
    result.tan_half_angle = tan_from_one_minus_cos(result.one_minus_cos);
    result.weight = 1.0f / float(cones_per_set * set_count);
    return result;
}

/// Tangent of the half-angle under which a light with an extent appears from `point`; 0 for any other light and
/// from within a sphere.
SHADING_FN float light_cone_tan(LightData light, vec3 point) {
    return light.radius > 0.0f ? tan_from_one_minus_cos(light_cone(light, point)) : 0.0f;
}

SHADING_END
#endif
