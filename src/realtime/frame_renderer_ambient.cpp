// FrameRenderer: light without global illumination. What stands for that of surroundings, and what hides the sky.
#include "realtime/area_light.h"
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

AmbientLight FrameRenderer::ambient() const { return settings_.gi == "vct" ? AmbientLight::none : settings_.ambient; }

Result<void> FrameRenderer::place_ambient() {
    inputs_.ambient = ambient() != AmbientLight::none;
    AmbientKey key{ambient()};
    if (inputs_.ambient) {
        key.in_the_open = !settings_.ambient_occlusion.on;
        key.surfaces = gpu_scene_.surface_revision();
        key.lights = gpu_scene_.light_revision();
        key.sky = gpu_scene_.sky_revision();
    }
    if (key == ambient_key_) return {};
    if (inputs_.ambient)
        if (auto done = set_ambient(key); !done) return done;
    ambient_key_ = key;
    return {};
}

Result<void> FrameRenderer::set_ambient(const AmbientKey& key) {
    const convert::FlatScene& flat = gpu_scene_.flat();
    const bool mapped = sky_maps_.specular.handle() != VK_NULL_HANDLE;
    GpuScene::Ambient ambient;
    ambient.data.albedo = mean_albedo_.of(flat, gpu_scene_.geometry_revisions());
    ambient.data.kind = ambient_kind(key.kind);
    ambient.data.in_the_open = key.in_the_open ? 1 : 0;
    ambient.data.sky_slot = mapped ? *sky_reflected_slot_ : shading::no_texture;
    for (const shading::LightData& light : flat.lights()) {
        if (light.type != shading::light_type_directional) continue;
        const shading::LightData center = center_of_area_light(light);
        ambient.lights.push_back({.axis = center.axis, .illuminance = center.intensity});
    }
    if (auto done = gpu_scene_.set_ambient(std::move(ambient)); !done) return done;
    return mapped && reflected_sky_ != key.kind ? filter_sky(false, nullptr) : Result<void>{};
}

void FrameRenderer::occlude_sky(const FrameSample& sample) {
    if (sample.measures) return;  // a picture's passes stay as they are
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
