#include "app/cli/bench_natus.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "app/cli/bench_scene.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

/// The passes of each step, by how their names begin.
constexpr std::pair<std::string_view, double NatusSteps::*> step_of_passes[] = {
    {"shadow", &NatusSteps::shadow_map_ms},   {"voxelize", &NatusSteps::voxelize_ms},
    {"inject", &NatusSteps::filter_ms},       {"gather", &NatusSteps::filter_ms},
    {"radiance", &NatusSteps::filter_ms},     {"filter", &NatusSteps::filter_ms},
    {"cone trace", &NatusSteps::cone_trace_ms}};

NatusSteps steps_of(const std::vector<PassTime>& passes) {
    NatusSteps steps;
    for (const PassTime& pass : passes) {
        const auto found = std::find_if(std::begin(step_of_passes), std::end(step_of_passes),
                                        [&](const auto& step) { return pass.name.starts_with(step.first); });
        steps.*(found == std::end(step_of_passes) ? &NatusSteps::rest_ms : found->second) += pass.gpu_ms;
    }
    return steps;
}

bool has_lights(const Scene& scene) {
    bool found = false;
    scene.nodes().each([&](NodeId, const Node& node) { found = found || node.light; });
    return found;
}

std::size_t triangle_count(const Scene& scene) {
    std::size_t triangles = 0;
    scene.nodes().each([&](NodeId, const Node& node) {
        for (const Part& part : node.parts)
            if (const Geometry* geometry = scene.geometries().find(part.geometry))
                triangles += geometry->mesh.triangle_count();
    });
    return triangles;
}

void set_bulb_radius(Scene& scene, float radius_m) {
    std::vector<std::pair<NodeId, Light>> bulbs;
    scene.nodes().each([&](NodeId id, const Node& node) {
        if (node.light && node.light->type == LightType::point) bulbs.emplace_back(id, *node.light);
    });
    for (auto& [id, light] : bulbs) {
        light.radius_m = radius_m;
        scene.set_light(id, light);
    }
}

void set_up(Scene& scene, const NatusTiming& timing) {
    RenderSettings settings = scene.render_settings();
    settings.gi = timing.test.gi ? "vct" : "none";
    if (timing.voxels > 0) settings.voxels = timing.voxels;
    settings.revoxelize = timing.each_frame ? Revoxelize::always : Revoxelize::once;
    settings.vct.diffuse = settings.vct.specular = settings.vct.refraction = true;
    settings.vct.shadows = timing.test.shadows_by_cones;
    settings.vct.ao = timing.test.occlusion;
    scene.set_render_settings(std::move(settings));
    set_bulb_radius(scene, timing.test.bulb_radius_m);
}

/// Everything that is timed of one scene, in the order of the table.
std::vector<NatusTiming> plan(bool emissive, const std::vector<int>& voxels) {
    std::vector<NatusTiming> timings;
    for (const NatusTest& test : natus_tests) {
        if (test.emissive != emissive) continue;
        if (!test.gi) {
            timings.push_back({test});
            continue;
        }
        for (const bool each_frame : {true, false})
            for (const int edge : voxels) timings.push_back({test, edge, each_frame});
    }
    return timings;
}

/// One scene on one device, timed and compared with the path tracer.
class Bench {
public:
    Bench(Scene& scene, const NatusOptions& options, const std::string& path) : scene_(scene), options_(options), path_(path) {
        picture_.width = options.size.width;
        picture_.height = options.size.height;
        picture_.samples = 1;
        picture_.frames_timed = options.frames;
    }
    Result<void> open() {
        SceneArgument argument = options_.scene;
        argument.path = path_;
        auto camera = choose_camera(scene_, argument, "");
        if (!camera) return tl::unexpected(camera.error());
        camera_ = *camera;
        auto renderer = RealtimeRenderer::create(options_.device);
        if (!renderer) return tl::unexpected(renderer.error());
        renderer_.emplace(std::move(*renderer));
        return {};
    }
    Result<Picture> time(NatusTiming& timing, std::string& device) {
        set_up(scene_, timing);
        picture_.gi = scene_.render_settings().gi;
        RealtimeStatistics numbers;
        auto picture = renderer_->render(scene_, camera_, picture_, &numbers);
        if (interrupted()) return fail("", "interrupted");
        if (!picture) return picture;
        timing.mean_ms = numbers.gpu_ms_mean;
        timing.median_ms = numbers.gpu_ms_total;
        timing.steps = steps_of(numbers.passes);
        device = numbers.device;
        return picture;
    }
    Result<EqualError> compare_with_paths(const NatusTiming& timing) {
        NatusTiming again = timing;
        std::string device;
        const auto picture = time(again, device);
        if (!picture) return tl::unexpected(picture.error());
        auto result = find_equal_error(scene_, camera_, picture->image, options_.path_seconds);
        if (!result) return result;
        result->voxels = timing.voxels;
        result->frame_ms = timing.mean_ms;
        return result;
    }

private:
    Scene& scene_;
    const NatusOptions& options_;
    std::string path_;
    Camera camera_;
    RealtimeOptions picture_;
    std::optional<RealtimeRenderer> renderer_;
};

/// Test 4 with every effect, voxelized in each frame, at 128³ or else the first grid asked for.
const NatusTiming* published_comparison(const std::vector<NatusTiming>& timings) {
    const NatusTiming* chosen = nullptr;
    for (const NatusTiming& timing : timings)
        if (timing.test.number == 4 && timing.each_frame && (!chosen || timing.voxels == 128)) chosen = &timing;
    return chosen;
}

Result<void> measure(Scene scene, const std::string& path, const NatusOptions& options, NatusReport& report) {
    Bench bench(scene, options, path);
    if (auto opened = bench.open(); !opened) return opened;
    std::vector<NatusTiming> timings = plan(!has_lights(scene), options.voxels);
    {
        ProgressBar bar("bench");
        const Progress progress = bar.callback();
        for (std::size_t i = 0; i < timings.size(); ++i) {
            if (!progress(static_cast<double>(i) / timings.size())) return fail("", "interrupted");
            if (auto timed = bench.time(timings[i], report.device); !timed) return tl::unexpected(timed.error());
        }
    }
    const NatusTiming* compared = published_comparison(timings);
    if (compared && options.path_seconds > 0) {
        auto result = bench.compare_with_paths(*compared);
        if (!result) return tl::unexpected(result.error());
        report.equal_error = *result;
    }
    report.timings.insert(report.timings.end(), timings.begin(), timings.end());
    return {};
}

/// The scene that only its wall lights: NAME-emissive.heliodon.json beside NAME.heliodon.json, where there is one.
std::optional<std::string> emissive_beside(const std::string& path) {
    constexpr std::string_view ending = ".heliodon.json";
    if (!path.ends_with(ending)) return std::nullopt;
    std::string beside = path.substr(0, path.size() - ending.size()) + "-emissive" + std::string(ending);
    std::error_code error;
    return std::filesystem::exists(beside, error) ? std::optional(std::move(beside)) : std::nullopt;
}

}  // namespace

Result<NatusReport> run_natus(const NatusOptions& options) {
    NatusReport report;
    if (options.scene.path.empty()) {
        report.scene = "built-in";
        Scene scene = natus_scene(false);
        report.triangles = triangle_count(scene);
        if (auto done = measure(std::move(scene), "built-in", options, report); !done) return tl::unexpected(done.error());
        if (auto done = measure(natus_scene(true), "built-in", options, report); !done) return tl::unexpected(done.error());
        return report;
    }
    report.scene = options.scene.path;
    auto scene = load(options.scene);
    if (!scene) return tl::unexpected(scene.error());
    report.triangles = triangle_count(*scene);
    const bool lit = has_lights(*scene);
    if (auto done = measure(std::move(*scene), report.scene, options, report); !done) return tl::unexpected(done.error());
    const auto beside = emissive_beside(options.scene.path);
    if (!lit || !beside) return report;
    say("test 5: " + *beside);
    SceneArgument argument = options.scene;
    argument.path = *beside;
    auto emissive = load(argument);
    if (!emissive) return tl::unexpected(emissive.error());
    if (auto done = measure(std::move(*emissive), *beside, options, report); !done) return tl::unexpected(done.error());
    return report;
}

}  // namespace heliodon::cli
