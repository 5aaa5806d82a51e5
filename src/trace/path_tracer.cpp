#include "trace/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <exception>
#include <glm/gtc/matrix_access.hpp>

#include "core/units.h"
#include "shading/tables.h"
#include "trace/bidirectional_loop.h"
#include "trace/branching.h"
#include "trace/lanes/lane_loop.h"
#include "trace/lanes/lane_paths.h"
#include "trace/measure.h"
#include "trace/render_loop.h"

namespace heliodon {
namespace {

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Result<void> check_camera(const Camera& camera) {
    const glm::vec3 view = camera.target - camera.position;
    if (!is_finite(camera.position) || !is_finite(camera.target) || !is_finite(camera.up) ||
        !(glm::dot(view, view) > 0))
        return fail(fmt::format("camera '{}'", camera.name),
                    "expected finite positions and a target apart from the camera");
    if (!(camera.vertical_fov_rad > 0 && camera.vertical_fov_rad < std::numbers::pi_v<float>))
        return fail(fmt::format("camera '{}'", camera.name),
                    fmt::format("expected a vertical field of view between 0 and 180°, found {}°",
                                glm::degrees(camera.vertical_fov_rad)));
    return {};
}

Result<void> check_options(const PathOptions& options) {
    constexpr int most = 65536;
    if (options.width < 1 || options.height < 1 || options.width > most || options.height > most)
        return fail("", fmt::format("expected a picture size from 1x1 to {0}x{0}, found {1}x{2}", most, options.width,
                                    options.height));
    if (options.samples_per_pixel < 1 || options.samples_per_pixel > most_samples_per_pixel)
        return fail("", fmt::format("expected 1 to {} samples, found {}", most_samples_per_pixel,
                                    options.samples_per_pixel));
    if (options.target_error && !(*options.target_error > 0))
        return fail("", fmt::format("expected a target error above 0, found {}", *options.target_error));
    if (options.target_error && options.integrator == Integrator::bidirectional)
        return fail("", "expected no target error with the bidirectional integrator, which samples all pixels alike");
    if (options.branches != 0 && options.branches != 1 && options.branches != 2 && options.branches != 4)
        return fail("", fmt::format("expected 1, 2 or 4 branches, or 0 for as many as pay, found {}", options.branches));
    if (options.max_depth < 0)
        return fail("", fmt::format("expected a depth of 0 (unlimited) or more, found {}", options.max_depth));
    if (options.seconds && !(*options.seconds > 0))
        return fail("", fmt::format("expected more than 0 seconds, found {}", *options.seconds));
    return trace::check_aovs(options.aovs);
}

void set_camera(const Camera& camera, const PathOptions& options, shading::KernelFrame& frame) {
    const glm::mat4 view = camera.world_to_view();
    const float tangent = std::tan(0.5f * camera.vertical_fov_rad);
    const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
    frame.camera_position = camera.position;
    frame.camera_right = glm::vec3(glm::row(view, 0)) * (tangent * aspect);
    frame.camera_up = glm::vec3(glm::row(view, 1)) * tangent;
    frame.camera_forward = -glm::vec3(glm::row(view, 2));
    frame.width = static_cast<std::uint32_t>(options.width);
    frame.height = static_cast<std::uint32_t>(options.height);
}

/// Bidirectional subpaths do not branch.
trace::Branching branches_of(const PathOptions& options, const trace::CpuKernel& kernel, const trace::EmbreeScene& embree) {
    trace::Branching branching;
    if (options.integrator == Integrator::bidirectional) return branching;
    if (options.branches > 0)
        branching.bits = static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(options.branches)));
    else
        trace::run_on_threads(options.threads, [&] { branching = trace::choose_branching(kernel, embree); });
    return branching;
}

}  // namespace

struct PathTracer::State {
    convert::FlatScene flat;
    trace::EmbreeScene embree;
    trace::TextureTable textures;
    trace::GeometryTable geometries;
    trace::EmitterTable emitters;
    bool emitters_current = false;
    bool emitters_environment = false;
    bool ready = false;

    Result<TraceUpdate> update(const Scene& scene) {
        const convert::FlatChanges changes = flat.update(scene);
        // Tables of pointers and samples are cheap beside a picture; acceleration structures are not.
        if (changes.everything || !changes.textures.empty()) textures.update(flat);
        if (changes.everything || !changes.geometries.empty()) geometries = trace::build_geometry_table(flat);
        if (changes.any()) emitters_current = false;
        ready = false;
        Result<TraceUpdate> result = embree.update(flat, changes);
        ready = result.has_value();
        return result;
    }

    /// Made by all threads, before a path asks for them and the other threads wait for the one that does.
    void make_shading_tables() const {
        const auto asks = [&](const shading::InstanceData& instance) {
            return (instance.flags & shading::instance_flag_visible) &&
                   flat.materials()[instance.material].model != shading::material_model_lambert;
        };
        if (std::ranges::any_of(flat.instances(), asks)) static_cast<void>(shading::shading_tables());
    }

    trace::CpuKernel kernel(const PathOptions& options) {
        if (!emitters_current || emitters_environment != options.environment) {
            emitters = trace::build_emitters(flat, textures, options.environment);
            emitters_current = true;
            emitters_environment = options.environment;
        }
        trace::CpuKernel kernel{flat, geometries, textures, emitters, {}};
        kernel.frame.max_depth = static_cast<std::uint32_t>(options.max_depth);
        kernel.frame.seed = options.seed;
        kernel.frame.emitter_count = emitters.emitters.empty() || emitters.emitters.back().cumulative <= 0
                                         ? 0u
                                         : static_cast<std::uint32_t>(emitters.emitters.size());
        kernel.frame.visible_light_count = static_cast<std::uint32_t>(emitters.visible_lights.size());
        kernel.frame.environment = options.environment ? 1 : 0;
        kernel.frame.sky_emitter = emitters.sky_emitter;
        kernel.frame.sky_columns = emitters.sky_columns;
        kernel.frame.sky_rows = emitters.sky_rows;
        kernel.frame.scattered_emission = emitters.scattered_emission ? 1 : 0;
        kernel.frame.sample_streams = 1;
        kernel.frame.branch_bits = 0;
        kernel.frame.distant_emitters = emitters.distant_emitters;
        kernel.frame.light_node_count =
            options.light_tree ? static_cast<std::uint32_t>(emitters.light_nodes.size()) : 0u;
        return kernel;
    }
};

PathTracer::PathTracer() : state_(std::make_unique<State>()) {}
PathTracer::~PathTracer() = default;
PathTracer::PathTracer(PathTracer&&) noexcept = default;
PathTracer& PathTracer::operator=(PathTracer&&) noexcept = default;

Result<TraceUpdate> PathTracer::update(const Scene& scene) try {
    return state_->update(scene);
} catch (const std::exception& exception) {
    return fail("", fmt::format("the tracing database cannot follow the scene: {}", exception.what()));
}

Result<Picture> PathTracer::render(const Scene&, const Camera& camera, const PathOptions& options,
                                   PathStatistics* statistics, const Progress& progress) try {
    if (auto checked = check_options(options); !checked) return tl::unexpected(checked.error());
    if (auto checked = check_camera(camera); !checked) return tl::unexpected(checked.error());
    if (!state_->ready) return fail("", "expected the tracer to have followed the scene before it renders");
    trace::CpuKernel kernel = state_->kernel(options);
    set_camera(camera, options, kernel.frame);
    const auto start = std::chrono::steady_clock::now();
    state_->make_shading_tables();
    // A finer tree costs the time of one or two samples a triangle. Whether it pays is asked of the picture's size, not of its
    // samples: going on with a picture must meet the same surfaces.
    constexpr std::size_t triangles_a_pixel = 16;
    const std::size_t pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
    Result<void> chosen;
    trace::run_on_threads(options.threads, [&] { chosen = state_->embree.choose_tree(state_->flat, triangles_a_pixel * pixels); });
    if (!chosen) return tl::unexpected(chosen.error());
    const double preparing = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // Whoever tells the scatter of pixels from their neighbours' needs them independent.
    constexpr std::uint32_t tile_bits = 4;
    if (trace::wants_variance(options))
        kernel.frame.sample_streams = trace::variance_streams;
    else if (options.blue_noise)
        kernel.frame.tile_bits = tile_bits;
    const trace::Branching branching = branches_of(options, kernel, state_->embree);
    kernel.frame.branch_bits = branching.bits;
    trace::EmissionTable emission;
    trace::AddSamples samples;
    if (options.lanes && trace::lanes_available()) samples = trace::lane_samples(kernel, state_->embree);
    if (options.integrator == Integrator::bidirectional) {
        emission = trace::build_emission(state_->flat, state_->emitters, options.environment);
        samples = trace::bidirectional_samples({kernel, emission}, state_->embree);
    }
    constexpr double floor = 0.01;  // of the luminance that the camera shows as white
    PathStatistics counted;
    auto picture = trace::render_picture(kernel, state_->embree, options, floor / units::exposure_scale(camera.ev100()),
                                         counted, progress, samples);
    if (!picture) return picture;
    counted.seconds += branching.seconds + preparing;
    counted.rays += branching.rays;
    picture->ev100 = camera.ev100();
    picture->has_ev100 = true;
    if (statistics) *statistics = counted;
    return picture;
} catch (const std::exception& exception) {
    return fail("", fmt::format("the path tracer cannot render: {}", exception.what()));
}

Result<std::vector<SensorReading>> PathTracer::measure(const Scene& scene, const PathOptions& options,
                                                       const Progress& progress) try {
    if (auto checked = check_options(options); !checked) return tl::unexpected(checked.error());
    if (!state_->ready) return fail("", "expected the tracer to have followed the scene before it measures");
    state_->make_shading_tables();
    Result<void> chosen;
    trace::run_on_threads(options.threads, [&] { chosen = state_->embree.choose_tree(state_->flat, 0); });
    if (!chosen) return tl::unexpected(chosen.error());
    return trace::measure_sensors(scene, state_->kernel(options), state_->embree, options, progress);
} catch (const std::exception& exception) {
    return fail("", fmt::format("the path tracer cannot measure: {}", exception.what()));
}

}  // namespace heliodon
