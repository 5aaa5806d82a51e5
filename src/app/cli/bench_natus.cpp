#include "app/cli/bench_natus.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "app/cli/bench_scene.h"
#include "app/cli/terminal.h"

namespace heliodon::cli {
namespace {

bool has_lights(const Scene& scene) {
    bool found = false;
    scene.nodes().each([&](NodeId, const Node& node) { found = found || node.light; });
    return found;
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
    settings.vct.narrow = false;  // as while something moves
    settings.vct.caustics = false;  // voxels reflect diffusely, as the published engine's
    settings.vct.resolution = ConeResolution::quarter;  // no less accurate at this size (docs/accuracy.md)
    scene.set_render_settings(std::move(settings));
    set_bulb_radius(scene, timing.test.bulb_radius_m);
}

/// Everything that is timed of one scene, in the order of the table.
std::vector<NatusTiming> plan(bool emissive, const NatusOptions& options) {
    std::vector<NatusTiming> timings;
    for (const NatusTest& test : natus_tests) {
        const bool wanted = std::find(options.tests.begin(), options.tests.end(), test.number) != options.tests.end();
        if (test.emissive != emissive || !wanted) continue;
        if (!test.gi) {
            timings.push_back({test});
            continue;
        }
        for (const bool each_frame : {true, false})
            for (const int edge : options.voxels) timings.push_back({test, edge, each_frame});
    }
    return timings;
}

/// Test 4 with every effect, voxelized in each frame, at 128³ or else the first grid asked for.
const NatusTiming* published_comparison(const std::vector<NatusTiming>& timings) {
    const NatusTiming* chosen = nullptr;
    for (const NatusTiming& timing : timings)
        if (timing.test.number == 4 && timing.each_frame && (!chosen || timing.voxels == 128)) chosen = &timing;
    return chosen;
}

Result<void> compare_with_paths(FrameTimer& timer, Scene& scene, const NatusTiming& timing, const NatusOptions& options,
                                NatusReport& report) {
    set_up(scene, timing);
    Picture picture;
    if (const auto timed = timer.time(options.timing.size, &picture); !timed) return tl::unexpected(timed.error());
    auto result = find_equal_error(scene, timer.camera(), picture.image, options.path_seconds);
    if (!result) return tl::unexpected(result.error());
    result->voxels = timing.voxels;
    result->frame_ms = timing.frame.mean_ms;
    report.equal_error = *result;
    return {};
}

/// Nothing where none of the tests asked for is of this scene.
Result<void> measure(Scene scene, const std::string& name, const NatusOptions& options, NatusReport& report) {
    std::vector<NatusTiming> timings = plan(!has_lights(scene), options);
    if (timings.empty()) return {};
    auto timer = FrameTimer::create(scene, name, options.timing);
    if (!timer) return tl::unexpected(timer.error());
    {
        ProgressBar bar("bench");
        const Progress progress = bar.callback();
        for (std::size_t i = 0; i < timings.size(); ++i) {
            if (!progress(static_cast<double>(i) / timings.size())) return fail("", "interrupted");
            set_up(scene, timings[i]);
            const auto timed = timer->time(options.timing.size);
            if (!timed) return tl::unexpected(timed.error());
            timings[i].frame = *timed;
        }
    }
    report.device = timer->device();
    report.timings.insert(report.timings.end(), timings.begin(), timings.end());
    const NatusTiming* compared = published_comparison(timings);
    if (!compared || options.path_seconds == 0) return {};
    return compare_with_paths(*timer, scene, *compared, options, report);
}

/// The scene that only its wall lights: NAME-emissive.heliodon.json beside NAME.heliodon.json, where there is one.
std::optional<std::string> emissive_beside(const std::string& path) {
    constexpr std::string_view ending = ".heliodon.json";
    if (!path.ends_with(ending)) return std::nullopt;
    std::string beside = path.substr(0, path.size() - ending.size()) + "-emissive" + std::string(ending);
    std::error_code error;
    return std::filesystem::exists(beside, error) ? std::optional(std::move(beside)) : std::nullopt;
}

Result<void> measure_built_in(const NatusOptions& options, NatusReport& report) {
    report.scene = "built-in";
    Scene scene = natus_scene(false);
    report.triangles = triangle_count(scene);
    if (auto done = measure(std::move(scene), report.scene, options, report); !done) return done;
    return measure(natus_scene(true), report.scene, options, report);
}

Result<void> measure_file(const NatusOptions& options, NatusReport& report) {
    report.scene = options.scene.path;
    auto scene = load(options.scene);
    if (!scene) return tl::unexpected(scene.error());
    report.triangles = triangle_count(*scene);
    const bool lit = has_lights(*scene);
    if (auto done = measure(std::move(*scene), report.scene, options, report); !done) return done;
    const auto beside = emissive_beside(options.scene.path);
    const bool wanted = std::find(options.tests.begin(), options.tests.end(), 5) != options.tests.end();
    if (!lit || !beside || !wanted) return {};
    say("test 5: " + *beside);
    SceneArgument argument = options.scene;
    argument.path = *beside;
    auto emissive = load(argument);
    if (!emissive) return tl::unexpected(emissive.error());
    return measure(std::move(*emissive), *beside, options, report);
}

}  // namespace

Result<NatusReport> run_natus(const NatusOptions& options) {
    NatusReport report;
    const auto done = options.scene.path.empty() ? measure_built_in(options, report) : measure_file(options, report);
    if (!done) return tl::unexpected(done.error());
    if (report.timings.empty())
        return fail(report.scene,
                    "expected lights for tests 1 to 4 or none for test 5, found nothing to measure of those "
                    "asked for");
    return report;
}

}  // namespace heliodon::cli
