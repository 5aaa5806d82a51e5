// FrameRenderer: light without global illumination. What stands for that of surroundings, and what hides the sky.
#include "convert/mean_albedo.h"
#include "realtime/frame_renderer.h"
#include "shading/ambient.h"

namespace heliodon::realtime {
namespace {

// Of one sample; still pictures average over many.
constexpr std::uint32_t slices = 2, steps = 8;

std::uint32_t ambient_kind(AmbientLight kind) {
    switch (kind) {
        case AmbientLight::none: return shading::ambient_none;
        case AmbientLight::constant: return shading::ambient_constant;
        case AmbientLight::directional: return shading::ambient_directional;
    }
    return shading::ambient_none;
}

}  // namespace

Result<void> FrameRenderer::place_ambient() {
    inputs_.ambient = settings_.ambient != AmbientLight::none && settings_.gi != "vct";
    AmbientKey key{settings_.ambient};
    if (inputs_.ambient) {
        key.surfaces = gpu_scene_.surface_revision();
        key.lights = gpu_scene_.light_revision();
        key.sky = gpu_scene_.sky_revision();
    }
    if (key == ambient_key_) return {};
    const bool other_kind = key.kind != ambient_key_.kind;
    ambient_key_ = key;
    if (!inputs_.ambient) return {};
    const convert::FlatScene& flat = gpu_scene_.flat();
    const bool mapped = sky_maps_.specular.handle() != VK_NULL_HANDLE;
    GpuScene::Ambient ambient;
    ambient.data.albedo = convert::mean_albedo(flat);
    ambient.data.kind = ambient_kind(settings_.ambient);
    ambient.data.sky_slot = mapped ? *sky_reflected_slot_ : shading::no_texture;
    for (const shading::LightData& light : flat.lights())
        if (light.type == shading::light_type_directional) ambient.lights.push_back({.axis = light.axis, .illuminance = light.intensity});
    if (auto done = gpu_scene_.set_ambient(std::move(ambient)); !done) return done;
    return mapped && other_kind ? filter_sky(nullptr) : Result<void>{};
}

void FrameRenderer::occlude_sky(const FrameSample& sample) {
    const AmbientOcclusionSettings& settings = settings_.ambient_occlusion;
    // Other pictures than of light have no sky in them.
    const bool of_light = sample.aov == shading::frame_aov_none || sample.aov == shading::frame_aov_occlusion ||
                          sample.aov == shading::frame_aov_illuminance;
    const bool any = inputs_.features.sky || inputs_.ambient || sample.aov == shading::frame_aov_occlusion;
    wanted_.sky_occluded = sample.occludes_sky && !sample.cone_traced && of_light && any &&
                           (settings.on || sample.aov == shading::frame_aov_occlusion);
    occlusion_ = {settings.reach_m, settings.thickness_m, slices, steps};
}

}  // namespace heliodon::realtime
