// What the frame renderer does for the voxel volume: when its steps are due.
#include <algorithm>
#include <cmath>

#include "realtime/camera_frame.h"
#include "realtime/frame_renderer.h"
#include "shading/cone.h"

namespace heliodon::realtime {
namespace {

// A voxel's face gathers with one set of cones. Once light has converged, further sets fill the cells between them,
// so many for a still picture.
constexpr int still_gather_sets = 32;
// Light has converged when a bounce changes the volume by less than half precision can tell.
constexpr double converged_change = 1.0 / 2048;
// Ends what cannot converge: surfaces that reflect everything, in a closed room.
constexpr int most_bounces = 64;

// Live, each frame gathers for the faces to one side, in turn. Light has converged after so many turns of six frames: nine
// tenths reflected come to a thousandth.
constexpr int turn_frames = static_cast<int>(shading::voxel_faces);
constexpr int converging_bounces = 64;
constexpr int most_live_frames = turn_frames * (converging_bounces + 64);
const std::optional<VoxelVolume::Gather> nothing, gather_once = VoxelVolume::Gather{};

/// Bounce `index`: the first `converging` ones forget those before, later ones are averaged with the last of them.
VoxelVolume::Gather next_gather(int index, int converging) {
    if (index < converging) return {};
    const int set = index - converging + 1;
    return {sample_position(static_cast<std::uint32_t>(set), 0, 0), 1.0f / static_cast<float>(set + 1)};
}

/// Set `set` of a still picture, from 1. Cones that share the hemisphere with those of the other sets see past what wide ones
/// blur, so that light comes to another rest than by the one wide set before: later sets weigh more (Shamir & Zhang 2013,
/// polynomial-decay averaging, η = 1), the first forgets what was.
VoxelVolume::Gather still_gather(int set, bool narrow) {
    if (!narrow) return next_gather(set, 1);
    VoxelVolume::Gather gather{sample_position(static_cast<std::uint32_t>(set), 0, 0)};
    gather.weight = 2.0f / static_cast<float>(set + 1);
    gather.share = 1.0f / static_cast<float>(still_gather_sets - 1);
    return gather;
}

std::uint32_t effect_bits(const ConeTracingSettings& vct) {
    return (vct.diffuse ? shading::gi_effect_diffuse : 0) | (vct.specular ? shading::gi_effect_specular : 0) |
           (vct.refraction ? shading::gi_effect_refraction : 0) | (vct.shadows ? shading::gi_effect_shadows : 0) |
           (vct.ao ? shading::gi_effect_occlusion : 0);
}

/// Shadow maps as voxels read them: filtered, without movement of their texel grid.
FrameSample unmoved(const FrameSample& sample) {
    FrameSample still;
    still.count = sample.count;
    still.seed = sample.seed;
    still.force_shadows = sample.force_shadows;
    return still;
}

}  // namespace

Result<void> FrameRenderer::prepare_volume(const Camera& camera) {
    const VoxelVolume::Source source{gpu_scene_, inputs_, lighting_, shadow_depth_, shadow_slope_};
    const bool isotropic = settings_.vct.filtering == VoxelFiltering::isotropic;
    const VoxelSettings settings{settings_.voxels, settings_.cascades, settings_.voxelizer == Voxelizer::raster,
                                 settings_.revoxelize == Revoxelize::always, isotropic, settings_.vct.caustics && !isotropic};
    if (auto done = voxels_.prepare(source, settings, camera.position); !done) return done;
    wanted_.volume = voxels_.texture_revision();
    return {};
}

Result<void> FrameRenderer::update_volume(const Camera& camera, const FrameSample& sample) {
    VolumeKey wanted;
    wanted.scene = gpu_scene_.revision();
    wanted.placement = voxels_.placement_revision();
    wanted.shadow_places = shadow_places_;
    wanted.bounces = settings_.bounces;
    wanted.sky = sample.environment;
    // What else the light of voxels depends on: whether the sky is occluded, and how shadows are found.
    wanted.effects = effect_bits(settings_.vct) & (shading::gi_effect_occlusion | shading::gi_effect_shadows);
    wanted.narrow = settings_.vct.narrow;
    // What the camera exposes for lies in the middle of half precision; powers of two change no digit.
    wanted.radiance_unit = std::exp2(std::floor(camera.ev100()));

    shading::VolumeData data{};
    data.radiance_unit = wanted.radiance_unit;
    data.sky_enabled = sample.environment ? 1 : 0;
    data.effects = effect_bits(settings_.vct);
    data.cone_sets = static_cast<std::uint32_t>(settings_.vct.cones) / shading::cones_per_set;
    data.gather_sets = 1;
    if (auto done = voxels_.upload_data(data); !done) return done;

    const bool live = sample.count == 0;
    voxelize_ = wanted.placement != voxelized_placement_ ||
                (gpu_scene_.surface_revision() != voxelized_surfaces_ && settings_.revoxelize != Revoxelize::once) ||
                (live && settings_.revoxelize == Revoxelize::always);
    relight_ = voxelize_ || !(wanted == volume_key_) || (live && (sample.force_shadows || shadows_lag()));
    if (relight_) bounce_frames_ = 0;
    volume_key_ = wanted;
    return {};
}

Result<void> FrameRenderer::update_surfaces(const Camera& camera, const FrameSample& sample) {
    // Room is made before the first frame; later, live frames look after it now and then (grow_volume).
    constexpr int most_attempts = 4;
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        if (auto done = prepare(camera, sample); !done) return done;
        if (auto done = update_volume(camera, sample); !done) return done;
        const bool within_frame = sample.count == 0 && plan_.batches.size() == 1;  // record_volume
        if (!voxelize_ || (within_frame && voxelized_texture_ == voxels_.texture_revision())) return {};
        auto enough = surfaces_find_room();
        if (!enough) return tl::unexpected(enough.error());
        if (!*enough) continue;
        voxelized_texture_ = voxels_.texture_revision();
        voxelize_ = false;
        return {};
    }
    return fail("render.voxels", "surfaces find no room in the voxel volume");
}

Result<bool> FrameRenderer::grow_volume() {
    if (!key_.cone_traced) return false;
    return voxels_.grow();
}

bool FrameRenderer::emission_or_sky() const {
    return voxels_.emits() || (volume_key_.sky && gpu_scene_.flat().sky().model != shading::sky_model_none);
}

Result<void> FrameRenderer::record_volume_bounces(gpu::Commands& commands, const ShadowBatch* lights) {
    if (settings_.bounces == 0) {
        // All bounces: each turn adds one to what the volume holds.
        if (bounce_frames_ >= most_live_frames) return {};
        VoxelVolume::Gather gather = next_gather(bounce_frames_++ / turn_frames, converging_bounces);
        gather.side = gather_side_ = (gather_side_ + 1) % turn_frames;
        if (lights) return voxels_.record_lit_bounce(commands, &timestamps_, lights->first_light, lights->light_count, gather);
        return voxels_.record_bounce(commands, &timestamps_, gather);
    }
    if (!relight_) return {};
    for (int bounce = 0; bounce < settings_.bounces; ++bounce)
        if (auto done = voxels_.record_bounce(commands, &timestamps_, bounce > 0 || emission_or_sky() ? gather_once : nothing); !done)
            return done;
    return {};
}

Result<void> FrameRenderer::record_volume(gpu::Commands& commands, const FrameSample& sample, std::size_t batch) {
    if (sample.count > 0) return {};  // converged before
    if (voxelize_) {
        graph::Executor* const beside = key_.surfaces_ahead ? surface_executor_.get() : nullptr;
        if (auto done = voxels_.record_surfaces(commands, &timestamps_, settings_.bounces == 0, beside); !done) return done;
        surfaces_voxelized();
    }
    if (relight_) {
        // So many bounces begin with nothing: the frame owes nothing to those before it. Cones that find shadows need the
        // surfaces where they are now.
        if (settings_.bounces > 0 && (emission_or_sky() || has_cone_shadows_))
            if (auto done = voxels_.record_emission(commands, &timestamps_); !done) return done;
        if (auto done = record_shadows(commands, unmoved(sample), batch, &timestamps_); !done) return done;
        const ShadowBatch& lights = plan_.batches[batch];
        if (settings_.bounces == 0 && lighting_.shadows_traced) return record_volume_bounces(commands, &lights);
        if (auto done = voxels_.record_lights(commands, &timestamps_, lights.first_light, lights.light_count, false); !done)
            return done;
    }
    return record_volume_bounces(commands, nullptr);
}

void FrameRenderer::surfaces_voxelized() {
    voxelized_surfaces_ = gpu_scene_.surface_revision();
    voxelized_placement_ = voxels_.placement_revision();
}

Result<bool> FrameRenderer::surfaces_find_room() {
    auto done = device_.run("voxelize", [&](gpu::Commands& commands) {
        if (auto recorded = voxels_.record_surfaces(commands, nullptr, settings_.bounces == 0); !recorded) commands.fail("voxelize", recorded.error().text());
    });
    if (!done) return tl::unexpected(done.error());
    surfaces_voxelized();
    auto grown = voxels_.grow();
    if (!grown) return tl::unexpected(grown.error());
    return !*grown;
}

Result<void> FrameRenderer::converge_volume(const FrameSample& sample) {
    const auto run = [&](const char* name, const auto& record) {
        Result<void> status;
        auto done = device_.run(name, [&](gpu::Commands& commands) { status = record(commands); });
        return status ? done : status;
    };
    if (auto done = run("emission", [&](gpu::Commands& commands) { return voxels_.record_emission(commands, nullptr); }); !done)
        return done;
    for (std::size_t batch = 0; batch < plan_.batches.size(); ++batch) {
        auto done = run("light voxels", [&](gpu::Commands& commands) -> Result<void> {
            if (auto shadows = record_shadows(commands, unmoved(sample), batch, nullptr); !shadows) return shadows;
            const ShadowBatch& lights = plan_.batches[batch];
            return voxels_.record_lights(commands, nullptr, lights.first_light, lights.light_count, batch > 0);
        });
        if (!done) return done;
    }
    const int limit = settings_.bounces > 0 ? settings_.bounces : most_bounces;
    double before = 0;
    const auto bounce = [&](const VoxelVolume::Gather& gather) {
        return run("bounce", [&](gpu::Commands& commands) { return voxels_.record_bounce(commands, nullptr, gather); });
    };
    for (int done_so_far = 0; done_so_far < limit; ++done_so_far) {
        if (auto done = bounce({}); !done) return done;
        auto total = voxels_.total_radiance();
        if (!total) return tl::unexpected(total.error());
        // What lobes hold is not in the total: of metals alone nothing else shows at first.
        if (done_so_far > 0 && std::abs(*total - before) <= converged_change * *total) break;
        before = *total;
    }
    // With all bounces the light is at rest, and more sets of cones only make it finer.
    for (int set = 1; settings_.bounces == 0 && set < still_gather_sets; ++set)
        if (auto done = bounce(still_gather(set, settings_.vct.narrow)); !done) return done;
    relight_ = false;
    bounce_frames_ = most_live_frames;
    return {};
}

}  // namespace heliodon::realtime
