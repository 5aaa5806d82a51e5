#include "import/material_files.h"

namespace heliodon::import {

TextureSlots add_material_files(const MaterialFiles& source, TextureSet& set) {
    const MaterialTextures& files = source.files;
    TextureSlots slots;
    const auto image = [&](const std::filesystem::path& file) {
        return file.empty() ? -1 : set.add_image({file.string(), file.lexically_normal(), {}});
    };
    const auto add = [&](TextureUse Material::*slot, const TextureRecipe& recipe) {
        slots.push_back({slot, set.add(recipe)});
    };
    const auto whole = [&](TextureUse Material::*slot, const std::filesystem::path& file, TextureFormat format) {
        if (!file.empty()) add(slot, opaque_image(image(file), format, source.sampler));
    };
    if (!files.base_color.empty() || !files.opacity.empty()) {
        TextureRecipe recipe{.format = TextureFormat::srgb8, .sampler = source.sampler};
        if (!files.base_color.empty())
            recipe = whole_image(image(files.base_color), TextureFormat::srgb8, source.sampler);
        if (source.alpha_mode == AlphaMode::opaque)
            recipe.channels[3] = {};
        else if (!files.opacity.empty())
            recipe.opacity = {image(files.opacity), 0};
        recipe.alpha_cutoff = source.alpha_cutoff;
        add(&Material::base_color_texture, recipe);
    }
    if (!files.occlusion.empty() || !files.roughness.empty() || !files.metallic.empty()) {
        TextureRecipe recipe{.format = TextureFormat::linear8, .sampler = source.sampler};
        recipe.channels[0] = {image(files.occlusion), 0};
        recipe.channels[1] = {image(files.roughness), 0};
        recipe.channels[2] = {image(files.metallic), 0};
        // A picture that serves as roughness and as metallic is packed as glTF packs it.
        if (!files.roughness.empty() && files.roughness == files.metallic) {
            recipe.channels[1].channel = 1;
            recipe.channels[2].channel = 2;
        }
        if (!files.roughness.empty() || !files.metallic.empty()) add(&Material::orm_texture, recipe);
        if (!files.occlusion.empty()) add(&Material::occlusion_texture, recipe);
    }
    whole(&Material::normal_texture, files.normal, TextureFormat::linear8);
    whole(&Material::bump_texture, files.bump, TextureFormat::linear8);
    whole(&Material::emission_texture, files.emission, TextureFormat::srgb8);
    return slots;
}

}  // namespace heliodon::import
