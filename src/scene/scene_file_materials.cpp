#include <fmt/format.h>

#include <algorithm>

#include "scene/scene_file_parts.h"

namespace heliodon::scene_file {
namespace {

AlphaMode default_alpha_mode(const MaterialBlock& block) {
    const bool see_through = block.material.opacity < 1 || !block.textures.opacity.empty();
    return see_through ? AlphaMode::blend : AlphaMode::opaque;
}

void read_factors(ObjectReader& object, Material& material) {
    object.read("base_color", material.base_color, unit_interval);
    object.read("metallic", material.metallic, unit_interval);
    object.read("roughness", material.roughness, unit_interval);
    object.read("ior", material.ior, Range{.low = 1});
    object.read("transmission", material.transmission, unit_interval);
    if (const auto emission = object.find("emission_nits"))
        material.emission_nits = emission->number_or_vector(not_negative);
    object.read("specular", material.specular, unit_interval);
    object.read("specular_color", material.specular_color, not_negative);
    object.read("clearcoat", material.clearcoat, unit_interval);
    object.read("clearcoat_roughness", material.clearcoat_roughness, unit_interval);
    object.read("opacity", material.opacity, unit_interval);
    object.read("alpha_cutoff", material.alpha_cutoff, unit_interval);
    object.read("two_sided", material.two_sided);
    object.read("normal_scale", material.normal_scale);
    object.read("bump_scale_m", material.bump_scale_m);
    object.read("occlusion_strength", material.occlusion_strength, unit_interval);
}

/// Refuses `keys` in materials of any other model than these.
void allow(const ObjectReader& object, const Material& material, std::initializer_list<const char*> keys,
           std::initializer_list<MaterialModel> models, std::string_view names) {
    if (std::find(models.begin(), models.end(), material.model) != models.end()) return;
    for (const char* key : keys)
        if (object.cursor().json().contains(key))
            throw Refusal{object.cursor().path() + "." + key, fmt::format("expected with the model {} alone", names)};
}

void read_disney(ObjectReader& object, Material& material) {
    allow(object, material, {"subsurface", "specular_tint", "anisotropic", "sheen", "sheen_tint", "clearcoat_gloss"},
          {MaterialModel::disney}, "\"disney\"");
    object.read("subsurface", material.subsurface, unit_interval);
    object.read("specular_tint", material.specular_tint, unit_interval);
    object.read("anisotropic", material.anisotropy, unit_interval);
    object.read("sheen", material.sheen, unit_interval);
    object.read("sheen_tint", material.sheen_tint, unit_interval);
    object.read("clearcoat_gloss", material.clearcoat_gloss, unit_interval);
}

/// `metal` by name, or `eta` and `k`.
void read_conductor(ObjectReader& object, Material& material) {
    allow(object, material, {"metal", "eta", "k"}, {MaterialModel::conductor}, "\"conductor\"");
    const auto metal = object.find("metal"), eta = object.find("eta"), k = object.find("k");
    if (material.model != MaterialModel::conductor) return;
    if (metal && (eta || k)) throw Refusal{metal->path(), "expected either metal, or eta and k, found both"};
    if (metal) {
        material.metal = metal->one_of<NamedMetal>({{"gold", NamedMetal::gold}, {"silver", NamedMetal::silver},
                                                    {"copper", NamedMetal::copper}, {"aluminium", NamedMetal::aluminium},
                                                    {"iron", NamedMetal::iron}, {"chromium", NamedMetal::chromium}});
        return;
    }
    if (!eta || !k) throw Refusal{object.cursor().path(), "expected a conductor's metal, or its eta and k"};
    material.conductor_eta = eta->number_or_vector(positive);
    material.conductor_k = k->number_or_vector(not_negative);
}

void read_layers(ObjectReader& object, Material& material) {
    using enum MaterialModel;
    allow(object, material, {"anisotropy", "iridescence", "iridescence_ior", "iridescence_thickness_nm", "sheen_color", "sheen_roughness"},
          {standard}, "\"standard\"");
    allow(object, material, {"anisotropy_rotation_deg"}, {standard, disney}, "\"standard\" or \"disney\"");
    allow(object, material, {"thin_walled", "attenuation_color", "attenuation_distance_m"}, {standard, dielectric},
          "\"standard\" or \"dielectric\"");
    allow(object, material, {"sigma_deg"}, {oren_nayar}, "\"oren_nayar\"");
    object.read("anisotropy", material.anisotropy, unit_interval);
    object.read_degrees("anisotropy_rotation_deg", material.anisotropy_rotation_rad, any_number);
    object.read("sheen_color", material.sheen_color, unit_interval);
    object.read("sheen_roughness", material.sheen_roughness, unit_interval);
    object.read("iridescence", material.iridescence, unit_interval);
    object.read("iridescence_ior", material.iridescence_ior, Range{.low = 1});
    object.read("iridescence_thickness_nm", material.iridescence_thickness_nm, not_negative);
    object.read("thin_walled", material.thin_walled);
    object.read("attenuation_color", material.attenuation_color, unit_interval);
    object.read("attenuation_distance_m", material.attenuation_distance_m, positive);
    if (const auto sigma = object.find("sigma_deg")) material.sigma_rad = glm::radians(sigma->number(Range{.low = 0, .high = 90}));
}

/// `transmittance` is one number, or up to six coefficients of a polynomial in the cosine of incidence.
void read_pane(ObjectReader& object, Material& material) {
    const bool thin = material.model == MaterialModel::thin;
    const auto transmittance = thin ? object.require("transmittance") : object.find("transmittance");
    const auto reflectance = object.find("reflectance");
    for (const auto& key : {transmittance, reflectance})
        if (key && !thin) throw Refusal{key->path(), "expected with the model \"thin\" alone"};
    if (!thin) return;
    if (reflectance) material.reflectance = reflectance->number(unit_interval);
    if (transmittance->json().is_number()) {
        material.transmittance = {transmittance->number(unit_interval)};
    } else {
        const std::size_t most = material.transmittance.size();
        if (!transmittance->json().is_array() || transmittance->json().empty() || transmittance->json().size() > most)
            transmittance->refuse(fmt::format("a number or a list of 1 to {} numbers", most));
        material.transmittance = {};
        std::size_t power = 0;
        for (const JsonCursor& coefficient : transmittance->elements()) material.transmittance[power++] = coefficient.number();
    }
    // The polynomial is held within 0 and 1, so that this bounds what leaves a pane by what arrives.
    float most_passing = 0;
    for (int step = 0; step <= 100; ++step) {
        float passing = 0;
        for (std::size_t i = material.transmittance.size(); i-- > 0;)
            passing = passing * static_cast<float>(step) * 0.01f + material.transmittance[i];
        most_passing = std::max(most_passing, std::min(passing, 1.0f));
    }
    constexpr float rounding = 1e-3f;
    if (most_passing + material.reflectance > 1 + rounding)
        throw Refusal{object.cursor().path(), fmt::format("expected transmittance and reflectance of at most 1 together, found {:.4g}",
                                                          most_passing + material.reflectance)};
}

void read_textures(ObjectReader& object, MaterialTextures& textures) {
    object.read("base_color_texture", textures.base_color);
    object.read("roughness_texture", textures.roughness);
    object.read("metallic_texture", textures.metallic);
    object.read("occlusion_texture", textures.occlusion);
    object.read("normal_texture", textures.normal);
    object.read("bump_texture", textures.bump);
    object.read("emission_texture", textures.emission);
    object.read("opacity_texture", textures.opacity);
}

}  // namespace

MaterialBlock read_material(const std::string& name, const JsonCursor& cursor) {
    ObjectReader object(cursor);
    MaterialBlock block;
    block.material.name = name;
    if (const auto brdf = object.find("brdf"))
        brdf->refuse_as_unsupported("measured BRDFs", "the standard model's keys");
    if (const auto model = object.find("model"))
        block.material.model = model->one_of<MaterialModel>({{"standard", MaterialModel::standard},
                                                             {"lambert", MaterialModel::lambert},
                                                             {"unlit", MaterialModel::unlit},
                                                             {"thin", MaterialModel::thin},
                                                             {"disney", MaterialModel::disney},
                                                             {"oren_nayar", MaterialModel::oren_nayar},
                                                             {"conductor", MaterialModel::conductor},
                                                             {"dielectric", MaterialModel::dielectric}});
    if (block.material.model == MaterialModel::disney) block.material.specular = block.material.roughness = 0.5f;
    read_factors(object, block.material);
    read_textures(object, block.textures);
    read_pane(object, block.material);
    read_disney(object, block.material);
    read_conductor(object, block.material);
    read_layers(object, block.material);
    block.material.alpha_mode = default_alpha_mode(block);
    if (const auto mode = object.find("alpha_mode"))
        block.material.alpha_mode = mode->one_of<AlphaMode>(
            {{"opaque", AlphaMode::opaque}, {"mask", AlphaMode::mask}, {"blend", AlphaMode::blend}});
    object.finish();
    return block;
}

}  // namespace heliodon::scene_file
