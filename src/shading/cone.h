// The cones that the voxel volume is traced with, each in place of a lobe: the diffuse hemisphere in cells, a GGX
// reflection, a GGX refraction, a light of its true size. docs/gi-theory.md derives them. Directions are local,
// z = normal; `wo`.z > 0.
//
// A lobe of density p (∫ p dω = 1) becomes the cone of even density about its mean direction with the same mean
// square, ∫ p² dω = 1/Ω. An even cone is thereby itself, the long tail of GGX does not widen it as a mean
// cosine would, and since (∫ p dω)² ≤ Ω' ∫ p² dω over a support Ω' (Cauchy-Schwarz) it is never wider than that.
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
/// cone has the solid angle of its cell / set_count, so that all of them have the hemisphere's.
SHADING_FN Cone diffuse_cone(uint cone, uint set_index, uint set_count, vec2 shift) {
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
    result.one_minus_cos = (inner ? 1.0f - boundary : boundary) / (sectors * float(set_count));
    result.tan_half_angle = tan_from_one_minus_cos(result.one_minus_cos);
    result.weight = 1.0f / float(cones_per_set * set_count);
    return result;
}

/// Sums over a lobe; directions in its plane of incidence, x along the viewer's.
struct LobeMoments {
    float energy;       // share of the visible facets' light that leaves on the lobe's side
    vec3 direction;     // its sum
    float mean_square;  // sum of the densities
};
SHADING_CONST uint lobe_rings = 4u;
SHADING_CONST uint lobe_sectors = 6u;  // of the half circle; the other half mirrors it

/// Visible normal of a quadrature's node: Gauss-Legendre over the spherical cap's depth (Abramowitz & Stegun 1964,
/// table 25.4), midpoints over its azimuth. `w` of the result is its weight; those of all nodes add to 1.
SHADING_FN vec4 lobe_node(vec3 stretched, float alpha, uint node) {
    uint ring = node / lobe_sectors;
    bool centre = ring == 1u || ring == 2u;
    float offset = 0.5f * (centre ? 0.339981043584856f : 0.861136311594053f);
    float weight = 0.5f * (centre ? 0.652145154862546f : 0.347854845137454f);
    float phi = pi * (float(node % lobe_sectors) + 0.5f) / float(lobe_sectors);
    vec3 h = ggx_cap_normal(stretched, alpha, ring < 2u ? 0.5f - offset : 0.5f + offset, cos(phi), sin(phi));
    return vec4(h, weight / float(lobe_sectors));
}

/// The lobe's cone, turned into the viewer's plane of incidence. Below the horizon there is no light of the lobe:
/// the cone is no wider than the widest about its axis that stays clear of it.
SHADING_FN Cone cone_of_lobe(LobeMoments sums, vec3 wo) {
    vec3 mean = normalize(sums.direction);
    float across = sqrt(wo.x * wo.x + wo.y * wo.y);
    vec2 x = across > 0.0f ? vec2(wo.x, wo.y) / across : vec2(1.0f, 0.0f);
    float solid_angle = sums.energy * sums.energy / sums.mean_square;
    float slope = sqrt(mean.x * mean.x + mean.y * mean.y);
    float widest = slope > 0.0f ? one_minus_cos_from_tan(abs(mean.z) / slope) : 1.0f;
    Cone cone;
    cone.direction = vec3(mean.x * x.x, mean.x * x.y, mean.z);
    cone.one_minus_cos = min(solid_angle * (0.5f * inverse_pi), widest);
    cone.tan_half_angle = tan_from_one_minus_cos(cone.one_minus_cos);
    cone.weight = 1.0f;
    return cone;
}

/// The GGX reflection lobe D G2/(4 μo) (ggx_reflection), Fresnel's factor left out, as one cone; weight 1. Both
/// moments are integrals over the visible normals: Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
SHADING_FN Cone specular_cone(vec3 wo, float alpha) {
    vec3 o = vec3(sqrt(wo.x * wo.x + wo.y * wo.y), 0.0f, wo.z);
    vec3 stretched = ggx_stretch(o, alpha);
    LobeMoments sums;
    sums.energy = 0.0f;
    sums.direction = vec3(0.0f);
    sums.mean_square = 0.0f;
    float masking = ggx_g1(o.z, alpha);
    for (uint node = 0u; node < lobe_rings * lobe_sectors; ++node) {
        vec4 normal = lobe_node(stretched, alpha, node);
        vec3 h = vec3(normal);
        vec3 i = h * (2.0f * dot(o, h)) - o;
        if (i.z > 0.0f) {
            float share = normal.w * ggx_g2(o.z, i.z, alpha) / masking;
            sums.energy += share;
            sums.direction += vec3(i.x, 0.0f, i.z) * share;
            sums.mean_square += share * ggx_reflection(o, i, h, alpha);
        }
    }
    return cone_of_lobe(sums, wo);
}

/// The GGX refraction lobe (ggx_refraction), Fresnel's factor left out, as one cone below the surface; `eta` = index
/// beyond the surface / index on wo's side. Walter et al. 2007, eq. 21; the eta² of its Jacobian (eq. 17), which
/// radiance loses again, belongs to the density. `weight`: the share of the visible facets that do not reflect
/// totally. False where all of them do.
SHADING_FN bool refraction_cone(vec3 wo, float alpha, float eta, SHADING_OUT(Cone) cone) {
    vec3 o = vec3(sqrt(wo.x * wo.x + wo.y * wo.y), 0.0f, wo.z);
    vec3 stretched = ggx_stretch(o, alpha);
    LobeMoments sums;
    sums.energy = 0.0f;
    sums.direction = vec3(0.0f);
    sums.mean_square = 0.0f;
    float refracting = 0.0f;
    for (uint node = 0u; node < lobe_rings * lobe_sectors; ++node) {
        vec4 normal = lobe_node(stretched, alpha, node);
        vec3 h = vec3(normal);
        vec3 i;
        if (refract_about(o, h, eta, i)) {
            refracting += normal.w;
            if (i.z < 0.0f) {
                float share = normal.w * ggx_g1(-i.z, alpha);
                sums.energy += share;
                sums.direction += vec3(i.x, 0.0f, i.z) * share;
                sums.mean_square += share * eta * eta * ggx_refraction(o, i, h, alpha, eta);
            }
        }
    }
    cone.direction = vec3(0.0f, 0.0f, -1.0f);
    cone.tan_half_angle = 0.0f;
    cone.one_minus_cos = 0.0f;
    cone.weight = 0.0f;
    if (sums.energy <= 0.0f) {
        return false;
    }
    cone = cone_of_lobe(sums, wo);
    cone.weight = refracting;
    return true;
}

/// Tangent of the half-angle under which a light with an extent appears from `point`; 0 for any other light and
/// from within a sphere.
SHADING_FN float light_cone_tan(LightData light, vec3 point) {
    return light.radius > 0.0f ? tan_from_one_minus_cos(light_cone(light, point)) : 0.0f;
}

SHADING_END
#endif
