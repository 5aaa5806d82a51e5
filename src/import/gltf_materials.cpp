#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "import/gltf.h"
#include "import/material_range.h"

namespace heliodon::import::gltf {
namespace {

/// A texture reference of the file: picture, sampler and how coordinates reach it.
struct Reference {
    int image = -1;  ///< of the texture set
    SamplerState sampler;
    TextureUse use;  ///< all but the texture itself

    [[nodiscard]] bool same_lookup(const Reference& other) const {
        return sampler == other.sampler && use.texcoord == other.use.texcoord && use.uv_matrix == other.use.uv_matrix &&
               use.uv_offset == other.use.uv_offset;
    }
};

Wrap wrap(int code) {
    switch (code) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp_to_edge;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirrored_repeat;
        default:
            return Wrap::repeat;
    }
}

SamplerState sampler_state(const tinygltf::Sampler& sampler) {
    SamplerState state{.wrap_u = wrap(sampler.wrapS), .wrap_v = wrap(sampler.wrapT)};
    const auto nearest = {TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST,
                          TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR};
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) state.magnify = Filter::nearest;
    if (std::find(nearest.begin(), nearest.end(), sampler.minFilter) != nearest.end()) state.minify = Filter::nearest;
    state.mipmapped =
        sampler.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST && sampler.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
    return state;
}

class MaterialReader {
public:
    MaterialReader(const Document& document, const tinygltf::Model& model, TextureSet& textures)
        : document_(document), model_(model), textures_(textures), images_(document.count("images"), -1) {}

    MaterialDraft read(std::size_t index) {
        at_ = fmt::format("$.materials[{}]", index);
        const tinygltf::Material& source = model_.materials[index];
        const Json& json = document_.json()["materials"][index];
        MaterialDraft draft;
        Material& material = draft.material;
        material.name = source.name.empty() ? fmt::format("material {}", index) : source.name;
        material.two_sided = source.doubleSided;
        read_alpha(source, material);
        read_base(source, json, draft);
        read_surface(source, json, draft);
        read_emission(source, json, draft);
        read_extensions(json, draft);
        if (bring_into_range(material, document_.where(at_)))
            notes_.insert("brings material factors outside their range into it");
        return draft;
    }
    /// What was approximated, once for the file.
    [[nodiscard]] const std::set<std::string>& notes() const { return notes_; }

private:
    void read_alpha(const tinygltf::Material& source, Material& material) {
        material.alpha_cutoff = float(source.alphaCutoff);
        if (source.alphaMode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (source.alphaMode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        else if (source.alphaMode != "OPAQUE")
            document_.refuse(at_ + ".alphaMode", "expected OPAQUE, MASK or BLEND, found \"" + source.alphaMode + "\"");
    }

    void read_base(const tinygltf::Material& source, const Json& json, MaterialDraft& draft) {
        const auto& pbr = source.pbrMetallicRoughness;
        draft.material.base_color = vector(pbr.baseColorFactor, "pbrMetallicRoughness.baseColorFactor", 4);
        // What OPAQUE says about alpha: it is ignored.
        const bool opaque = draft.material.alpha_mode == AlphaMode::opaque;
        draft.material.opacity = opaque ? 1.0f : float(pbr.baseColorFactor[3]);
        draft.material.metallic = float(pbr.metallicFactor);
        draft.material.roughness = float(pbr.roughnessFactor);
        const auto reference = texture(json.value("/pbrMetallicRoughness/baseColorTexture"_json_pointer, Json()));
        if (!reference) return;
        TextureRecipe recipe = opaque ? opaque_image(reference->image, TextureFormat::srgb8, reference->sampler)
                                      : whole_image(reference->image, TextureFormat::srgb8, reference->sampler);
        if (draft.material.alpha_mode == AlphaMode::mask)
            recipe.alpha_cutoff =
                draft.material.opacity > 0 ? draft.material.alpha_cutoff / draft.material.opacity : 1.0f;
        use(draft, &Material::base_color_texture, *reference, recipe);
    }

    void read_surface(const tinygltf::Material& source, const Json& json, MaterialDraft& draft) {
        const auto rough_metal =
            texture(json.value("/pbrMetallicRoughness/metallicRoughnessTexture"_json_pointer, Json()));
        const auto occlusion = texture(json.value("occlusionTexture", Json()));
        draft.material.occlusion_strength = float(source.occlusionTexture.strength);
        const bool together = rough_metal && occlusion && rough_metal->same_lookup(*occlusion);
        if (rough_metal) {
            TextureRecipe recipe{.format = TextureFormat::linear8, .sampler = rough_metal->sampler};
            if (together) recipe.channels[0] = {occlusion->image, 0};
            recipe.channels[1] = {rough_metal->image, 1};
            recipe.channels[2] = {rough_metal->image, 2};
            use(draft, &Material::orm_texture, *rough_metal, recipe);
            if (together) use(draft, &Material::occlusion_texture, *occlusion, recipe);
        }
        if (occlusion && !together)
            use(draft, &Material::occlusion_texture, *occlusion,
                opaque_image(occlusion->image, TextureFormat::linear8, occlusion->sampler));
        if (const auto normal = texture(json.value("normalTexture", Json()))) {
            draft.material.normal_scale = float(source.normalTexture.scale);
            use(draft, &Material::normal_texture, *normal,
                opaque_image(normal->image, TextureFormat::linear8, normal->sampler));
        }
    }

    void read_emission(const tinygltf::Material& source, const Json& json, MaterialDraft& draft) {
        glm::vec3 emission = vector(source.emissiveFactor, "emissiveFactor", 3);
        if (const Json* strength = extension(json, "KHR_materials_emissive_strength"))
            emission *= number(*strength, "emissiveStrength", 1.0f);
        draft.material.emission_nits = emission;
        if (emission == glm::vec3(0)) return;
        notes_.insert("takes emissiveFactor × emissiveStrength as cd/m²");
        if (const auto reference = texture(json.value("emissiveTexture", Json())))
            use(draft, &Material::emission_texture, *reference,
                opaque_image(reference->image, TextureFormat::srgb8, reference->sampler));
    }

    void read_extensions(const Json& json, MaterialDraft& draft) {
        Material& material = draft.material;
        if (const Json* ior = extension(json, "KHR_materials_ior")) {
            const float value = number(*ior, "ior", 1.5f);
            if (value >= 1)
                material.ior = value;
            else if (value == 0)
                notes_.insert("an index of refraction of 0 (full reflection) is taken as 1.5");
            else
                document_.refuse(at_ + ".extensions.KHR_materials_ior.ior",
                                 fmt::format("expected 0 or at least 1, found {}", value));
        }
        if (const Json* transmission = extension(json, "KHR_materials_transmission")) {
            material.transmission = number(*transmission, "transmissionFactor", 0.0f);
            linear(draft, &Material::transmission_texture, *transmission, "transmissionTexture");
            read_volume(json, material);
        }
        if (const Json* specular = extension(json, "KHR_materials_specular")) {
            material.specular = number(*specular, "specularFactor", 1.0f);
            material.specular_color = color(*specular, "specularColorFactor");
            linear(draft, &Material::specular_texture, *specular, "specularTexture");
            if (const auto reference = texture(specular->value("specularColorTexture", Json())))
                use(draft, &Material::specular_color_texture, *reference,
                    opaque_image(reference->image, TextureFormat::srgb8, reference->sampler));
        }
        if (const Json* coat = extension(json, "KHR_materials_clearcoat")) {
            material.clearcoat = number(*coat, "clearcoatFactor", 0.0f);
            material.clearcoat_roughness = number(*coat, "clearcoatRoughnessFactor", 0.0f);
            linear(draft, &Material::clearcoat_texture, *coat, "clearcoatTexture");
            linear(draft, &Material::clearcoat_roughness_texture, *coat, "clearcoatRoughnessTexture");
            if (coat->contains("clearcoatNormalTexture")) notes_.insert("ignores the clear coat's own normal map");
        }
        read_layers(json, draft);
        if (extension(json, "KHR_materials_unlit")) {
            // Luminance of the reference display's white, IEC 61966-2-1:1999, table 1.
            constexpr float display_white_nits = 80.0f;
            material.model = MaterialModel::unlit;
            material.emission_nits = glm::vec3(display_white_nits);
            notes_.insert("shows unlit materials like a display whose white has 80 cd/m²");
        }
    }

    /// Without a thickness of the volume what is transmissive is a sheet; a thickness says no more here than that there is a
    /// solid, whose own surfaces light meets.
    void read_volume(const Json& json, Material& material) {
        const Json* volume = extension(json, "KHR_materials_volume");
        material.thin_walled = !volume || !(number(*volume, "thicknessFactor", 0.0f) > 0.0f);
        if (!volume || material.thin_walled) return;
        material.attenuation_color = color(*volume, "attenuationColor");
        const float distance = number(*volume, "attenuationDistance", material.attenuation_distance_m);
        if (distance > 0) material.attenuation_distance_m = distance;
        notes_.insert("takes volumes as the solids that their meshes are, whatever thickness they state");
    }

    void read_layers(const Json& json, MaterialDraft& draft) {
        Material& material = draft.material;
        if (const Json* anisotropy = extension(json, "KHR_materials_anisotropy")) {
            material.anisotropy = number(*anisotropy, "anisotropyStrength", 0.0f);
            material.anisotropy_rotation_rad = number(*anisotropy, "anisotropyRotation", 0.0f);
            linear(draft, &Material::anisotropy_texture, *anisotropy, "anisotropyTexture");
            if (material.transmission > 0) notes_.insert("keeps transmissive surfaces as rough along as across their tangents");
        }
        if (const Json* sheen = extension(json, "KHR_materials_sheen")) {
            material.sheen_color = sheen->contains("sheenColorFactor") ? color(*sheen, "sheenColorFactor") : glm::vec3(0);
            material.sheen_roughness = number(*sheen, "sheenRoughnessFactor", 0.0f);
            linear(draft, &Material::sheen_roughness_texture, *sheen, "sheenRoughnessTexture");
            if (const auto reference = texture(sheen->value("sheenColorTexture", Json())))
                use(draft, &Material::sheen_color_texture, *reference,
                    opaque_image(reference->image, TextureFormat::srgb8, reference->sampler));
        }
        if (const Json* film = extension(json, "KHR_materials_iridescence")) {
            material.iridescence = number(*film, "iridescenceFactor", 0.0f);
            material.iridescence_ior = number(*film, "iridescenceIor", 1.3f);
            material.iridescence_thickness_nm = number(*film, "iridescenceThicknessMaximum", 400.0f);
            material.iridescence_thinnest_nm = number(*film, "iridescenceThicknessMinimum", 100.0f);
            linear(draft, &Material::iridescence_texture, *film, "iridescenceTexture");
            linear(draft, &Material::iridescence_thickness_texture, *film, "iridescenceThicknessTexture");
        }
    }

    void linear(MaterialDraft& draft, TextureUse Material::*slot, const Json& object, const char* key) {
        if (const auto reference = texture(object.value(key, Json())))
            use(draft, slot, *reference, whole_image(reference->image, TextureFormat::linear8, reference->sampler));
    }

    void use(MaterialDraft& draft, TextureUse Material::*slot, const Reference& reference,
             const TextureRecipe& recipe) {
        draft.material.*slot = reference.use;
        draft.slots.push_back({slot, textures_.add(recipe)});
    }

    std::optional<Reference> texture(const Json& info) {
        if (!info.is_object() || !info.contains("index")) return std::nullopt;
        const std::size_t index = info["index"];
        const tinygltf::Texture& source = model_.textures[index];
        Reference reference;
        if (source.source < 0) {
            notes_.insert("ignores textures without a picture");
            return std::nullopt;
        }
        reference.image = image(std::size_t(source.source));
        if (source.sampler >= 0) reference.sampler = sampler_state(model_.samplers[std::size_t(source.sampler)]);
        std::size_t set = info.value("texCoord", std::size_t(0));
        if (const Json* transform = extension(info, "KHR_texture_transform")) {
            const glm::vec2 offset = pair(*transform, "offset", glm::vec2(0)),
                            scale = pair(*transform, "scale", glm::vec2(1));
            const float angle = number(*transform, "rotation", 0.0f), c = std::cos(angle), s = std::sin(angle);
            // Counter-clockwise as seen with v running down, as the extension's first example has it.
            reference.use.uv_matrix = glm::mat2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y);
            reference.use.uv_offset = offset;
            set = unsigned_member(document_, *transform, "texCoord", set, at_);
        }
        if (set > 1) {
            notes_.insert("ignores textures on coordinate sets past the second");
            return std::nullopt;
        }
        reference.use.texcoord = int(set);
        return reference;
    }

    int image(std::size_t index) {
        if (images_[index] >= 0) return images_[index];
        const Document::Picture picture = document_.picture(index);
        return images_[index] = textures_.add_image(
                   {document_.where(fmt::format("$.images[{}]", index)), picture.file, picture.bytes});
    }

    float number(const Json& object, const char* key, float fallback) const {
        if (!object.contains(key)) return fallback;
        if (!object[key].is_number())
            document_.refuse(at_, fmt::format("expected a number for {}, found {}", key, object[key].dump()));
        const float value = object[key].get<float>();
        if (!std::isfinite(value)) document_.refuse(at_, fmt::format("expected a finite number for {}", key));
        return value;
    }
    glm::vec3 color(const Json& object, const char* key) const {
        if (!object.contains(key)) return glm::vec3(1);
        std::vector<double> values;
        for (const Json& value : object[key])
            if (value.is_number()) values.push_back(value);
        return vector(values, key, 3);
    }
    glm::vec2 pair(const Json& object, const char* key, glm::vec2 fallback) const {
        if (!object.contains(key)) return fallback;
        const Json& list = object[key];
        if (!list.is_array() || list.size() != 2 || !list[0].is_number() || !list[1].is_number())
            document_.refuse(at_, fmt::format("expected two numbers for {}, found {}", key, list.dump()));
        return {list[0].get<float>(), list[1].get<float>()};
    }
    glm::vec3 vector(const std::vector<double>& values, const char* key, std::size_t length) const {
        if (values.size() != length)
            document_.refuse(fmt::format("{}.{}", at_, key), fmt::format("expected {} numbers", length));
        return {float(values[0]), float(values[1]), float(values[2])};
    }

    const Document& document_;
    const tinygltf::Model& model_;
    TextureSet& textures_;
    std::vector<int> images_;
    std::set<std::string> notes_;
    std::string at_;
};

}  // namespace

bool MaterialDraft::needs_tangents() const {
    return material.anisotropy > 0 || std::any_of(slots.begin(), slots.end(), [](const Slot& slot) {
        return slot.use == &Material::normal_texture || slot.use == &Material::bump_texture;
    });
}

int MaterialDraft::normal_texcoord() const {
    const bool bumped =
        std::any_of(slots.begin(), slots.end(), [](const Slot& slot) { return slot.use == &Material::bump_texture; });
    return bumped ? material.bump_texture.texcoord : material.normal_texture.texcoord;
}

std::vector<MaterialDraft> read_materials(const Document& document, const tinygltf::Model& model, TextureSet& textures,
                                          Warnings& warnings) {
    MaterialReader reader(document, model, textures);
    std::vector<MaterialDraft> materials;
    for (std::size_t i = 0; i < model.materials.size(); ++i) materials.push_back(reader.read(i));
    for (const std::string& note : reader.notes()) warnings.push_back({document.path().string(), note});
    return materials;
}

}  // namespace heliodon::import::gltf
