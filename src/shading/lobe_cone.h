// The cones that stand for GGX's lobes: a reflection from a table, a refraction by quadrature. docs/gi-theory.md derives
// them. Directions are local, z = normal; `wo`.z > 0.
//
// A lobe of density p (∫ p dω = 1) becomes the cone of even density about its mean direction with the same mean
// square, ∫ p² dω = 1/Ω. An even cone is thereby itself, the long tail of GGX does not widen it as a mean
// cosine would, and since (∫ p dω)² ≤ Ω' ∫ p² dω over a support Ω' (Cauchy-Schwarz) it is never wider than that.
#ifndef HELIODON_SHADING_LOBE_CONE_H
#define HELIODON_SHADING_LOBE_CONE_H
#include "shading/cone.h"
#include "shading/ggx_albedo.h"
SHADING_BEGIN

/// The cone of a lobe whose mean direction is (sine, cosine) in the plane of incidence, the sine along the viewer's side.
/// Below the horizon there is no light of the lobe: the cone is no wider than the widest about its axis that stays clear.
SHADING_FN Cone lobe_cone(vec3 wo, float sine, float cosine, float one_minus_cos) {
    float across = sqrt(wo.x * wo.x + wo.y * wo.y);
    vec2 x = across > 0.0f ? vec2(wo.x, wo.y) / across : vec2(1.0f, 0.0f);
    float widest = sine != 0.0f ? one_minus_cos_from_tan(abs(cosine / sine)) : 1.0f;
    Cone cone;
    cone.direction = vec3(sine * x.x, sine * x.y, cosine);
    cone.one_minus_cos = min(one_minus_cos, widest);
    cone.tan_half_angle = tan_from_one_minus_cos(cone.one_minus_cos);
    cone.weight = 1.0f;
    return cone;
}

SHADING_FN vec2 specular_lobe_row(uint first, float x) {
    return mix(vec2(shading_table(first), shading_table(first + 1u)),
               vec2(shading_table(first + 2u), shading_table(first + 3u)), x);
}
/// What stands in specular_lobe_start's table: the mean direction's angle from the normal as a share of the mirror's, and
/// √(1 − cos γ)/α; bilinear in √μ (to which the second of a narrow lobe is in proportion) and √α. Between the entries it
/// is within 0.1° and 1 % of solid angle for μ ≥ 0.1, 10 % below (tests/shading/cone_test.cpp).
SHADING_FN vec2 specular_lobe(float mu, float alpha) {
    float row = alpha_coordinate(alpha) * float(specular_lobe_rows - 1u);
    float column = sqrt(clamp(mu, 0.0f, 1.0f)) * float(specular_lobe_columns - 1u);
    uint j = min(uint(row), specular_lobe_rows - 2u);
    uint i = min(uint(column), specular_lobe_columns - 2u);
    uint first = specular_lobe_start + 2u * (j * specular_lobe_columns + i);
    float x = column - float(i);
    return mix(specular_lobe_row(first, x), specular_lobe_row(first + 2u * specular_lobe_columns, x), row - float(j));
}

/// The GGX reflection lobe D G2/(4 μo) (ggx_reflection), Fresnel's factor left out, as one cone; weight 1.
SHADING_FN Cone specular_cone(vec3 wo, float alpha) {
    vec2 lobe = specular_lobe(wo.z, alpha);
    float angle = lobe.x * atan(sqrt(wo.x * wo.x + wo.y * wo.y), wo.z);
    float width = lobe.y * alpha;
    return lobe_cone(wo, -sin(angle), cos(angle), width * width);
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
    vec3 mean = normalize(sums.direction);
    cone = lobe_cone(wo, mean.x, mean.z, sums.energy * sums.energy / sums.mean_square * (0.5f * inverse_pi));
    cone.weight = refracting;
    return true;
}

SHADING_END
#endif
