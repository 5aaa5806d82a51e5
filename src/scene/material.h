#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/handle.h"

namespace heliodon {

using TextureId = Handle<struct TextureTag>;
using MaterialId = Handle<struct MaterialTag>;

enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };
enum class Filter : std::uint8_t { nearest, linear };
enum class TextureFormat : std::uint8_t {
    srgb8,    ///< four bytes a texel, RGB sRGB-encoded, A linear
    linear8,  ///< four bytes a texel, linear (normals, occlusion-roughness-metallic, bump …)
    float32,  ///< four floats a texel (16 bytes), linear: image skies
};

/// A decoded picture with its whole mip chain, level 0 first. Rows from the top.
struct Texture {
    std::string name;
    int width = 0;
    int height = 0;
    TextureFormat format = TextureFormat::srgb8;
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Filter magnify = Filter::linear;
    Filter minify = Filter::linear;
    bool mipmapped = true;                       ///< false: sample level 0 only
    bool opaque = true;                          ///< every alpha is 1
    std::vector<std::vector<std::uint8_t>> levels;  ///< bytes of each level; level k is max(1, size >> k)

    [[nodiscard]] std::size_t bytes_per_texel() const { return format == TextureFormat::float32 ? 16 : 4; }
    [[nodiscard]] std::size_t bytes() const {
        std::size_t total = 0;
        for (const auto& level : levels) total += level.size();
        return total;
    }
};

/// A texture as a material uses it: uv' = uv_matrix · uv + uv_offset (KHR_texture_transform).
struct TextureUse {
    TextureId texture;
    int texcoord = 0;  ///< which of the mesh's coordinate sets
    glm::mat2 uv_matrix{1.0f};
    glm::vec2 uv_offset{0.0f};
};

enum class MaterialModel : std::uint8_t {
    standard,  ///< metallic/roughness with a dielectric coat of `ior`
    lambert,   ///< exactly base_color/π and nothing else
    unlit,     ///< base_color × emission_nits' white: shown as it is, takes no light (KHR_materials_unlit)
    thin,      ///< a pane of no thickness: lets `transmittance` pass straight on and mirrors `reflectance`
    disney,      ///< Burley's principled BRDF of 2012
    oren_nayar,  ///< rough and diffuse, by `sigma_rad` or else by `roughness`
    conductor,   ///< a metal by its index n + ik, or by name
    dielectric,  ///< clear and colourless: a solid's interface of `ior`
};
/// Metals whose measured index the program knows (shading/metals.h).
enum class NamedMetal : std::uint8_t { none, gold, silver, copper, aluminium, iron, chromium };
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

struct Material {
    std::string name;
    MaterialModel model = MaterialModel::standard;
    glm::vec3 base_color{0.8f};
    float opacity = 1.0f;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    float metallic = 0.0f;
    float roughness = 1.0f;  ///< perceptual; GGX alpha = roughness²
    float ior = 1.5f;
    float transmission = 0.0f;
    glm::vec3 emission_nits{0.0f};  ///< emitted radiance, cd/m²
    float specular = 1.0f;          ///< KHR_materials_specular: scales the dielectric F0 and F90
    glm::vec3 specular_color{1.0f};
    float clearcoat = 0.0f;
    float clearcoat_roughness = 0.0f;
    float normal_scale = 1.0f;
    float bump_scale_m = 0.01f;       ///< height of a bump texture's white over its black, metres
    float occlusion_strength = 1.0f;  ///< acts on indirect diffuse light only
    bool two_sided = false;
    /// Thin: share let through by the cosine of incidence, coefficients of its 0th to 5th power.
    std::array<float, 6> transmittance{1};
    float reflectance = 0.0f;  ///< thin: share mirrored, at any incidence

    float anisotropy = 0.0f;               ///< KHR_materials_anisotropy's strength; disney: anisotropic
    float anisotropy_rotation_rad = 0.0f;  ///< from the tangent towards the bitangent
    glm::vec3 sheen_color{0.0f};           ///< KHR_materials_sheen
    float sheen_roughness = 0.0f;
    float iridescence = 0.0f;  ///< KHR_materials_iridescence
    float iridescence_ior = 1.3f;
    float iridescence_thickness_nm = 400.0f;    ///< of the film; where the texture is 1
    float iridescence_thinnest_nm = 100.0f;     ///< where it is 0
    glm::vec3 attenuation_color{1.0f};          ///< of white light after attenuation_distance_m within the solid
    float attenuation_distance_m = std::numeric_limits<float>::infinity();
    bool thin_walled = false;                   ///< transmission passes a sheet instead of a solid
    glm::vec3 conductor_eta{1.0f};              ///< conductor without a name: n and k of each channel, against air
    glm::vec3 conductor_k{0.0f};
    NamedMetal metal = NamedMetal::none;
    float subsurface = 0.0f;  ///< disney, as what follows
    float specular_tint = 0.0f;
    float sheen = 0.0f;
    float sheen_tint = 0.5f;
    float clearcoat_gloss = 1.0f;
    std::optional<float> sigma_rad;  ///< oren_nayar: standard deviation of the facets' slope angle

    TextureUse base_color_texture;  ///< srgb8; alpha multiplies the opacity
    TextureUse orm_texture;         ///< linear8: occlusion R, roughness G, metallic B; factors multiply
    TextureUse occlusion_texture;   ///< linear8: R; the same texture as orm_texture where packed together
    TextureUse normal_texture;      ///< linear8, tangent space, glTF's handedness
    TextureUse bump_texture;        ///< linear8: R is height
    TextureUse emission_texture;    ///< srgb8; multiplies emission_nits
    TextureUse transmission_texture;  ///< linear8: R multiplies transmission
    TextureUse specular_texture;      ///< linear8: A multiplies specular
    TextureUse specular_color_texture;       ///< srgb8
    TextureUse clearcoat_texture;            ///< linear8: R
    TextureUse clearcoat_roughness_texture;  ///< linear8: G
    TextureUse anisotropy_texture;             ///< linear8: direction RG, strength B
    TextureUse sheen_color_texture;            ///< srgb8
    TextureUse sheen_roughness_texture;        ///< linear8: A
    TextureUse iridescence_texture;            ///< linear8: R
    TextureUse iridescence_thickness_texture;  ///< linear8: G
};

}  // namespace heliodon
