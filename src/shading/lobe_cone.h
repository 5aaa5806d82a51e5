// The cones that stand for GGX's lobes: a reflection from a table, a refraction by quadrature. docs/gi-theory.md derives
// them. Directions are local, z = normal; `wo`.z > 0.
//
// A lobe of density p (∫ p dω = 1) becomes the cone of even density about its mean direction with the same mean
// square, ∫ p² dω = 1/Ω. An even cone is thereby itself, the long tail of GGX does not widen it as a mean
// cosine would, and since (∫ p dω)² ≤ Ω' ∫ p² dω over a support Ω' (Cauchy-Schwarz) it is never wider than that.
#ifndef HELIODON_SHADING_LOBE_CONE_H
#define HELIODON_SHADING_LOBE_CONE_H
#include "shading/cone.h"
#include "shading/fresnel.h"
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

/// Where a table over √μ and √α is read, bilinearly: the first of the four entries, and how far on towards the next column and row.
struct LobeTableCell {
    uint entry;
    float x;
    float y;
};
SHADING_FN LobeTableCell lobe_table_cell(float mu, float alpha, uint layer, uint rows, uint columns) {
    float row = alpha_coordinate(alpha) * float(rows - 1u);
    float column = sqrt(clamp(mu, 0.0f, 1.0f)) * float(columns - 1u);
    uint j = min(uint(row), rows - 2u);
    uint i = min(uint(column), columns - 2u);
    LobeTableCell cell;
    cell.entry = (layer * rows + j) * columns + i;
    cell.x = column - float(i);
    cell.y = row - float(j);
    return cell;
}

SHADING_FN vec2 specular_lobe_row(uint first, float x) {
    return mix(vec2(shading_table(first), shading_table(first + 1u)),
               vec2(shading_table(first + 2u), shading_table(first + 3u)), x);
}
/// What stands in a layer of specular_lobe_start's table: the mean direction's angle from the normal as a share of the
/// mirror's, and √(1 − cos γ)/α; bilinear in √μ (to which the second of a narrow lobe is in proportion) and √α. Between the entries it
/// is within 0.1° and 1 % of solid angle for μ ≥ 0.1, 10 % below (tests/shading/cone_test.cpp).
SHADING_FN vec2 specular_lobe(float mu, float alpha, uint layer) {
    LobeTableCell cell = lobe_table_cell(mu, alpha, layer, specular_lobe_rows, specular_lobe_columns);
    uint first = specular_lobe_start + 2u * cell.entry;
    return mix(specular_lobe_row(first, cell.x), specular_lobe_row(first + 2u * specular_lobe_columns, cell.x), cell.y);
}

/// The cone of a lobe in the plane of incidence by specular_lobe()'s pair; weight 1.
SHADING_FN Cone specular_cone_of(vec3 wo, float alpha, vec2 lobe) {
    float angle = lobe.x * atan(sqrt(wo.x * wo.x + wo.y * wo.y), wo.z);
    float width = lobe.y * alpha;
    return lobe_cone(wo, -sin(angle), cos(angle), width * width);
}
/// The GGX reflection lobe D G2/(4 μo) (ggx_reflection), Fresnel's factor left out, as one cone.
SHADING_FN Cone specular_cone(vec3 wo, float alpha) {
    return specular_cone_of(wo, alpha, specular_lobe(wo.z, alpha, 0u));
}
/// With Schlick's factor for `f0`; `split`: ggx_albedo_split(). What reflects little from the front reflects most where
/// facets are grazed: seen from low, a rough dielectric's cone looks ahead where a metal's looks up. The factor is linear
/// in F0, so that every lobe is a mixture of those at F0 = lobe_dielectric_f0 and 1, by their energies; of cones the
/// middle one is taken.
SHADING_FN Cone specular_cone(vec3 wo, float alpha, float f0, vec2 split) {
    float dielectric = min(1.0f - f0, 0.98f) / (1.0f - lobe_dielectric_f0);  // water has less F0 than most
    float energy = dielectric * (lobe_dielectric_f0 * split.x + split.y);
    float rest = (1.0f - dielectric) * (split.x + split.y);
    vec2 lobe = specular_lobe(wo.z, alpha, 1u);
    if (rest != 0.0f) {
        lobe = mix(lobe, specular_lobe(wo.z, alpha, 0u), rest / (energy + rest));
    }
    return specular_cone_of(wo, alpha, lobe);
}

/// F0 of a lobe whose directional albedo is `albedo`, as far as that is F0 A + B (ggx_albedo_split).
SHADING_FN vec3 f0_of_albedo(vec3 albedo, vec2 split) {
    return clamp((albedo - vec3(split.y)) * (1.0f / max(split.x, 1.0e-6f)), vec3(0.0f), vec3(1.0f));
}

/// One of 1/`share` cones that share the lobe: about a direction drawn by `u` in [0, 1)² from the visible normals (Heitz
/// 2018), of `share` of the solid angle that its density asks for. `weight`: what it counts, 1 on average over u; 0 where
/// it leads below.
SHADING_FN Cone specular_cone_part(vec3 wo, float alpha, vec3 f0, vec2 split, vec2 u, float share, SHADING_OUT(vec3) weight) {
    vec3 h = ggx_sample_visible_normal(wo, alpha, u);
    float facing = dot(wo, h);
    Cone cone;
    cone.direction = h * (2.0f * facing) - wo;
    cone.one_minus_cos = 0.0f;
    cone.weight = 1.0f;
    weight = vec3(0.0f);
    if (cone.direction.z > 0.0f) {
        float unmasked = ggx_g2(wo.z, cone.direction.z, alpha) / ggx_g1(wo.z, alpha);
        weight = fresnel_schlick(f0, 1.0f, facing) * unmasked / max(f0 * split.x + vec3(split.y), vec3(1.0e-6f));
        float sine = sqrt(max(0.0f, 1.0f - cone.direction.z * cone.direction.z));
        float widest = sine > 0.0f ? one_minus_cos_from_tan(cone.direction.z / sine) : 1.0f;
        cone.one_minus_cos = min(share * 0.5f * inverse_pi / ggx_reflection_pdf(wo, h, alpha), widest);
    }
    cone.tan_half_angle = tan_from_one_minus_cos(cone.one_minus_cos);
    return cone;
}

/// The lobe of a surface of that specular albedo: all of it as one cone, or a sample's `share` of it.
SHADING_FN Cone reflection_cone(vec3 wo, float alpha, vec3 albedo, vec2 u, float share, SHADING_OUT(vec3) weight) {
    vec2 split = ggx_albedo_split(wo.z, alpha);
    vec3 f0 = f0_of_albedo(albedo, split);
    weight = vec3(1.0f);
    if (share < 1.0f) {
        return specular_cone_part(wo, alpha, f0, split, u, share, weight);
    }
    return specular_cone(wo, alpha, (f0.x + f0.y + f0.z) * (1.0f / 3.0f), split);
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
