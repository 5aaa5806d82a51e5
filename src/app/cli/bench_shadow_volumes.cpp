#include "app/cli/bench_shadow_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

Result<Image> measure(RealtimeRenderer& renderer, const Scene& scene, const Camera& camera,
                      const ShadowVolumeOptions& options, VolumesBehind behind, ShadowVolumeReport& report) {
    RealtimeOptions wanted;
    wanted.width = options.timing.size.width;
    wanted.height = options.timing.size.height;
    wanted.samples = 1;
    wanted.frames_timed = options.timing.frames;
    wanted.volumes_behind = behind;
    RealtimeStatistics statistics;
    auto picture = renderer.render(scene, camera, wanted, &statistics);
    if (!picture) return tl::unexpected(picture.error());
    if (!statistics.shadow_volumes)
        return fail(options.scene.path, "expected a sun or another directional light, found none");
    constexpr const char* names[] = {"lit triangles", "lit and joined ones", "all that face the sun"};
    ShadowVolumeReport::Row& row = report.rows.emplace_back();
    row.behind = names[static_cast<std::size_t>(behind)];
    row.volumes = *statistics.shadow_volumes;
    for (const PassTime& pass : statistics.passes) {
        if (pass.name == "shadow volume depth") row.depth_ms += pass.gpu_ms;
        if (pass.name == "shadow volumes") row.stencil_ms += pass.gpu_ms;
    }
    report.device = statistics.device;
    return std::move(picture->image);
}

int different_pixels(const Image& a, const Image& b) {
    int different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += a.channels)
        different += !std::equal(&a.pixels[i], &a.pixels[i] + a.channels, &b.pixels[i]);
    return different;
}

}  // namespace

Result<ShadowVolumeReport> run_shadow_volumes(const ShadowVolumeOptions& options) {
    auto scene = load(options.scene);
    if (!scene) return tl::unexpected(scene.error());
    const auto camera = choose_camera(*scene, options.scene, "");
    if (!camera) return tl::unexpected(camera.error());
    RenderSettings settings = scene->render_settings();
    settings.gi = "none";
    settings.sun_shadows = SunShadows::volumes;
    scene->set_render_settings(std::move(settings));
    auto renderer = RealtimeRenderer::create(options.timing.device);
    if (!renderer) return tl::unexpected(renderer.error());
    ShadowVolumeReport report{.scene = options.scene.path};
    std::optional<Image> first;
    for (const VolumesBehind behind : {VolumesBehind::lit, VolumesBehind::fewest, VolumesBehind::all}) {
        auto image = measure(*renderer, *scene, *camera, options, behind, report);
        if (!image) return tl::unexpected(image.error());
        if (!first) first = *image;
        report.rows.back().different_pixels = different_pixels(*first, *image);
    }
    return report;
}

std::string as_text(const ShadowVolumeReport& report, const ShadowVolumeOptions& options) {
    const Size size = options.timing.size;
    std::string text = fmt::format("{}, {}×{}, {}\n", report.scene, size.width, size.height, report.device);
    text += fmt::format("{} triangles of opaque surfaces\n{:<24}{:>10}{:>10}{:>10}{:>14}{:>14}{:>14}{:>14}\n",
                        report.rows[0].volumes.triangles, "volumes behind", "triangles", "edges", "sides",
                        "stencil (ms)", "depth (ms)", "rebuilt (ms)", "other pixels");
    for (const ShadowVolumeReport::Row& row : report.rows)
        text += fmt::format("{:<24}{:>10}{:>10}{:>10}{:>14.3f}{:>14.3f}{:>14.1f}{:>14}\n", row.behind, row.volumes.caps,
                            row.volumes.edges, row.volumes.sides, row.stencil_ms, row.depth_ms, row.volumes.build_ms,
                            row.different_pixels);
    text += fmt::format("lit triangles: {} parts of their map; newly found by round:", report.rows[0].volumes.parts);
    for (const std::uint32_t found : report.rows[0].volumes.found_by_round) text += fmt::format(" {}", found);
    return text + "\n";
}

std::string as_json(const ShadowVolumeReport& report, const ShadowVolumeOptions& options) {
    nlohmann::ordered_json json{{"scene", report.scene},
                                {"device", report.device},
                                {"width", options.timing.size.width},
                                {"height", options.timing.size.height}};
    for (const ShadowVolumeReport::Row& row : report.rows)
        json["volumes"].push_back({{"behind", row.behind},
                                   {"opaque_triangles", row.volumes.triangles},
                                   {"triangles", row.volumes.caps},
                                   {"edges", row.volumes.edges},
                                   {"sides", row.volumes.sides},
                                   {"stencil_ms", row.stencil_ms},
                                   {"depth_ms", row.depth_ms},
                                   {"rebuilt_ms", row.volumes.build_ms},
                                   {"different_pixels", row.different_pixels},
                                   {"map_parts", row.volumes.parts},
                                   {"found_by_round", row.volumes.found_by_round}});
    return json.dump(2) + "\n";
}

}  // namespace heliodon::cli
