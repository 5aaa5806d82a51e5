#include "realtime/scene_features.h"

#include "passes/light_grid/light_grid_shared.h"

namespace heliodon::realtime {
namespace {

/// The kind that all have of those that were added.
class OnlyKind {
public:
    void add(std::uint32_t kind) {
        if (count_++ == 0) kind_ = kind;
        else if (kind != kind_) kind_ = passes::SceneFeatures::any_kind;
    }
    [[nodiscard]] std::uint32_t kind() const { return kind_; }

private:
    std::uint32_t kind_ = passes::SceneFeatures::any_kind;
    std::size_t count_ = 0;
};

bool has_textures(const shading::MaterialData& m) {
    const auto used = [](const shading::TextureRef& texture) { return texture.texture_index != shading::no_texture; };
    return used(m.base_color_texture) || used(m.orm_texture) || used(m.occlusion_texture) || used(m.normal_texture) ||
           used(m.bump_texture) || used(m.emission_texture) || used(m.transmission_texture) || used(m.specular_texture) ||
           used(m.specular_color_texture) || used(m.clearcoat_texture) || used(m.clearcoat_roughness_texture) ||
           used(m.anisotropy_texture) || used(m.sheen_color_texture) || used(m.sheen_roughness_texture) ||
           used(m.iridescence_texture) || used(m.film_thickness_texture);
}

void add_surfaces(passes::SceneFeatures& features, const convert::FlatScene& scene) {
    OnlyKind model;
    for (const shading::InstanceData& instance : scene.instances()) {
        if (!(instance.flags & shading::instance_flag_visible)) continue;
        const shading::MaterialData& material = scene.materials()[instance.material];
        const Geometry* geometry = scene.geometries()[instance.geometry];
        features.extended |= (material.flags & shading::material_flag_extended) != 0;
        features.textures |= has_textures(material) || (geometry && !geometry->mesh.colors.empty());
        model.add(material.model);
    }
    features.only_model = model.kind();
}

void add_lights(passes::SceneFeatures& features, const convert::FlatScene& scene) {
    OnlyKind type;
    std::uint32_t count = 0;
    for (const shading::LightData& light : scene.lights()) {
        if (light.type == shading::light_type_none) continue;
        ++count;
        features.luminaires |= light.type == shading::light_type_luminaire;
        features.visible_lights |= light.radius > 0;
        type.add(light.type);
    }
    features.many_lights = count > shading::most_lights_summed;
    // Points of lights with an extent are of other types.
    if (!features.visible_lights) features.only_light = type.kind();
}

}  // namespace

passes::SceneFeatures scene_features(const convert::FlatScene& scene) {
    passes::SceneFeatures features;
    features.textures = features.many_lights = features.visible_lights = false;
    features.sky = scene.sky().model != shading::sky_model_none;
    add_surfaces(features, scene);
    add_lights(features, scene);
    return features;
}

}  // namespace heliodon::realtime
