// How the path tracer's database scales with triangles, beside Embree by itself at the same quality: seconds to build, bytes
// that it takes, nanoseconds an incoherent ray, and nanoseconds a ray of a picture. Each measurement has a process of its own.
//
//     build/release/bench/embree_scaling [--json] [TRIANGLES…]
#include <fmt/format.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "scene/scene.h"
#include "shading/random.h"
#include "shading/sampling.h"
#include "trace/embree_scene.h"
#include "trace/path_tracer.h"

namespace heliodon {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Resident bytes of this process, of freed memory rid.
double resident_bytes() {
    malloc_trim(0);
    std::ifstream file("/proc/self/statm");
    double total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// A closed surface of about so many triangles: a sphere of radius 1 with waves.
Mesh wavy_sphere(std::size_t triangles) {
    const auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles) / 4)), columns = 2 * rows;
    Mesh mesh;
    mesh.positions.resize((rows + 1) * columns);
    mesh.indices.resize(6 * rows * columns);
    parallel_for(rows + 1, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (std::size_t column = 0; column < columns; ++column) {
                const double polar = std::numbers::pi * static_cast<double>(row) / static_cast<double>(rows);
                const double turn = 2 * std::numbers::pi * static_cast<double>(column) / static_cast<double>(columns);
                const double radius = 1 + std::sin(polar) * (0.1 * std::sin(9 * turn) * std::sin(7 * polar) + 0.02 * std::sin(53 * turn + 41 * polar));
                mesh.positions[row * columns + column] =
                    glm::vec3(radius * glm::dvec3(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)));
                if (row == rows) continue;
                const auto at = [&](std::size_t r, std::size_t c) { return static_cast<std::uint32_t>(r * columns + c % columns); };
                const std::uint32_t corners[] = {at(row, column),     at(row, column + 1), at(row + 1, column),
                                                 at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)};
                std::copy(std::begin(corners), std::end(corners), &mesh.indices[6 * (row * columns + column)]);
            }
    });
    return mesh;
}

/// From outside to somewhere in the unit sphere: no two alike.
shading::KernelRay incoherent_ray(std::uint32_t i) {
    const glm::vec4 u = shading::random4(i, 0, 0, 1);
    shading::KernelRay ray{};
    ray.kind = shading::kernel_ray_scatter;
    ray.origin = 2.0f * shading::sample_uniform_sphere(glm::vec2(u.x, u.y));
    const glm::vec3 target = std::cbrt(shading::random1(i, 1, 0, 1)) * shading::sample_uniform_sphere(glm::vec2(u.z, u.w));
    ray.direction = glm::normalize(target - ray.origin);
    ray.t_max = shading::kernel_infinity;
    return ray;
}

struct Measured {
    double triangles = 0, build_s = 1e30, bytes = 0, ray_ns = 1e30, hits = 0, picture_ns = 0;
};

/// Nanoseconds of all cores together, the least of some runs; of generating the rays too.
template <class Answer>
void time_rays(const Answer& answer, Measured& measured) {
    constexpr std::size_t rays = 1 << 22;
    for (int run = 0; run < 3; ++run) {
        std::atomic<std::size_t> hits = 0;
        const auto start = Clock::now();
        parallel_for(rays, 4096, [&](std::size_t begin, std::size_t end) {
            std::size_t found = 0;
            for (std::size_t i = begin; i < end; ++i) found += answer(incoherent_ray(static_cast<std::uint32_t>(i)));
            hits += found;
        });
        measured.ray_ns = std::min(measured.ray_ns, 1e9 * seconds_since(start) / rays);
        measured.hits = static_cast<double>(hits) / rays;
    }
}

constexpr int builds = 3;

bool count_bytes(void* counter, ssize_t bytes, bool /*post*/) {
    *static_cast<std::atomic<ssize_t>*>(counter) += bytes;
    return true;
}
/// Embree alone; `bytes` as its monitor counts them.
Measured measure_embree(std::size_t triangles) {
    const Mesh mesh = wavy_sphere(triangles);
    Measured measured{static_cast<double>(mesh.triangle_count())};
    for (int build = 0; build < builds; ++build) {
        std::atomic<ssize_t> bytes = 0;
        const auto start = Clock::now();
        const trace::DeviceReference device(rtcNewDevice(nullptr));
        rtcSetDeviceMemoryMonitorFunction(device.get(), count_bytes, &bytes);
        const trace::GeometryReference geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                                   sizeof(glm::vec3), mesh.positions.size());
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                                   3 * sizeof(std::uint32_t), mesh.triangle_count());
        rtcCommitGeometry(geometry.get());
        const trace::SceneReference scene(rtcNewScene(device.get()));
        rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
        rtcAttachGeometry(scene.get(), geometry.get());
        rtcCommitScene(scene.get());
        measured.build_s = std::min(measured.build_s, seconds_since(start));
        measured.bytes = static_cast<double>(bytes);
        if (build + 1 < builds) continue;
        time_rays(
            [&](const shading::KernelRay& ray) {
                RTCRayHit query{};
                query.ray.org_x = ray.origin.x;
                query.ray.org_y = ray.origin.y;
                query.ray.org_z = ray.origin.z;
                query.ray.dir_x = ray.direction.x;
                query.ray.dir_y = ray.direction.y;
                query.ray.dir_z = ray.direction.z;
                query.ray.tfar = ray.t_max;
                query.ray.mask = ~0u;
                query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                trace::embree_intersect(scene.get(), query);
                return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
            },
            measured);
    }
    return measured;
}

/// Nanoseconds a ray of all cores together, with all that the path tracer does between rays: the surface under an even sky.
double picture_ray_ns(PathTracer& tracer, const Scene& scene) {
    Camera camera;
    camera.position = {0, 1, 3};
    camera.target = {0, 0, 0};
    PathOptions options;
    options.width = options.height = 512;
    double least = 1e30;
    for (int run = 0; run < 3; ++run) {
        PathStatistics statistics;
        options.samples_per_pixel = run == 0 ? 1 : 16;  // the first one makes tables
        if (!tracer.render(scene, camera, options, &statistics)) std::exit(1);
        if (run > 0) least = std::min(least, 1e9 * statistics.seconds / static_cast<double>(statistics.rays));
    }
    return least;
}

Scene scene_of(std::size_t triangles) {
    Scene scene;
    Geometry geometry;
    geometry.mesh = wavy_sphere(triangles);
    geometry.bounds = geometry.mesh.bounds();
    Node node;
    node.parts.push_back({scene.add_geometry(std::move(geometry)), scene.add_material({})});
    scene.add_node(std::move(node));
    Sky sky;
    sky.model = SkyModel::constant;
    sky.luminance_nits = glm::vec3(1);
    scene.set_sky(sky);
    return scene;
}

/// The path tracer; `bytes` all that it and its scene take.
Measured measure_heliodon(std::size_t triangles) {
    {   // What the first use of anything takes, threads among it, does not count: enough triangles that all threads have some.
        const Scene warm = scene_of(200'000);
        PathTracer tracer;
        (void)tracer.update(warm);
    }
    const double before = resident_bytes();
    const Scene scene = scene_of(triangles);
    Measured measured;
    scene.geometries().each([&](GeometryId, const Geometry& geometry) { measured.triangles = static_cast<double>(geometry.mesh.triangle_count()); });
    for (int build = 0; build < builds; ++build) {
        PathTracer tracer;
        const auto start = Clock::now();
        if (!tracer.update(scene)) std::exit(1);
        measured.build_s = std::min(measured.build_s, seconds_since(start));
        if (build == 0) measured.bytes = resident_bytes() - before;  // later ones leave free pages in every thread's heap
        if (build + 1 == builds) measured.picture_ns = picture_ray_ns(tracer, scene);
    }
    convert::FlatScene flat;
    trace::EmbreeScene embree;
    if (!embree.update(flat, flat.update(scene))) std::exit(1);
    time_rays([&](const shading::KernelRay& ray) { return embree.trace(ray).kind == shading::kernel_hit_surface; }, measured);
    return measured;
}

/// `measure` in another process.
template <class Measure>
Measured apart(const Measure& measure) {
    int ends[2];
    if (pipe(ends) != 0) std::exit(1);
    const pid_t child = fork();
    if (child == 0) {
        const Measured measured = measure();
        const bool written = write(ends[1], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    Measured measured;
    const bool read_all = read(ends[0], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!read_all || status != 0) {
        fmt::print(stderr, "a measurement ended early\n");
        std::exit(1);
    }
    return measured;
}

void run(const std::vector<std::size_t>& counts, bool json) {
    if (!json)
        fmt::print("{:>10} | {:>9} {:>9} {:>6} | {:>9} {:>9} {:>6} | {:>9} {:>8} {:>6} | {:>10}\n", "triangles", "Embree s", "ours s", "speed",
                   "Embree MB", "ours MB", "ratio", "Embree ns", "ours ns", "hits", "picture ns");
    std::string rows;
    for (const std::size_t count : counts) {
        const Measured embree = apart([&] { return measure_embree(count); }), ours = apart([&] { return measure_heliodon(count); });
        // Positions of a grid: half as many as triangles.
        const double vertices = 12 * ours.triangles / 2, limit = 1.2 * embree.bytes + vertices;
        if (json)
            rows += fmt::format("{}{{\"triangles\": {}, \"embree\": {{\"build_s\": {:.4f}, \"bytes\": {:.0f}, \"ray_ns\": {:.2f}}}, "
                                "\"heliodon\": {{\"build_s\": {:.4f}, \"bytes\": {:.0f}, \"ray_ns\": {:.2f}, \"picture_ray_ns\": {:.2f}}}, \"bytes_over_limit\": {:.4f}}}",
                                rows.empty() ? "" : ",\n  ", ours.triangles, embree.build_s, embree.bytes, embree.ray_ns, ours.build_s, ours.bytes,
                                ours.ray_ns, ours.picture_ns, ours.bytes / limit);
        else
            fmt::print("{:>10.0f} | {:>9.4f} {:>9.4f} {:>6.3f} | {:>9.1f} {:>9.1f} {:>6.3f} | {:>9.1f} {:>8.1f} {:>6.3f} | {:>10.1f}\n",
                       ours.triangles, embree.build_s, ours.build_s, embree.build_s / ours.build_s, embree.bytes / 1e6, ours.bytes / 1e6,
                       ours.bytes / limit, embree.ray_ns, ours.ray_ns, ours.hits, ours.picture_ns);
        std::fflush(stdout);
    }
    if (json) fmt::print("[{}]\n", rows);
    else fmt::print("\nspeed: Embree's seconds over ours. ratio: our bytes over 1.2 times Embree's and a copy of the positions.\n");
}

}  // namespace
}  // namespace heliodon

int main(int argc, char** argv) {
    bool json = false;
    std::vector<std::size_t> counts;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const unsigned long long count = std::strtoull(argument.c_str(), nullptr, 10);
        if (argument == "--json") json = true;
        else if (count >= 100) counts.push_back(count);
        else return fmt::print(stderr, "expected --json or numbers of triangles from 100, found '{}'\n", argument), 2;
    }
    if (counts.empty()) counts = {10'000, 100'000, 1'000'000, 10'000'000};
    heliodon::run(counts, json);
}
