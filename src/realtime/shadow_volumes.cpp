#include "realtime/shadow_volumes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <set>

#include "convert/mesh_edges.h"

namespace heliodon::realtime {
namespace {

using shading::CasterEdge;
using shading::CasterRange;

constexpr std::uint32_t no_triangle = 0xffffffffu;
constexpr std::uint32_t most_rounds = 7;  // 4⁶ parts in the last one
constexpr gpu::Access everything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
static_assert(sizeof(convert::MeshEdge) == sizeof(CasterEdge));

/// The last round's texels are so small that a significant triangle has as many as a map surely shows.
std::uint32_t last_round(float significant_px) {
    std::uint32_t round = 0;
    for (float px = significant_px; px < shading::lit_map_seen_texels && round + 1 < most_rounds; px *= 4) ++round;
    return round;
}

template <class T>
Result<void> upload(gpu::Device& device, GrowingBuffer& buffer, const std::vector<T>& values) {
    if (auto done = buffer.reserve(device, values.size() * sizeof(T), 0); !done) return done;
    return values.empty() ? Result<void>{} : device.upload<T>(buffer.buffer(), values);
}

/// Records, submits and waits; what was written can be read by whatever follows.
template <class Record>
Result<void> run(gpu::Device& device, const char* name, const Record& record) {
    Result<void> recorded;
    auto done = device.run(name, [&](gpu::Commands& commands) {
        commands.memory_barrier(everything, everything);
        recorded = record(commands);
        commands.memory_barrier(everything, everything);
    });
    return recorded ? done : recorded;
}

/// The first `count` words of a buffer.
Result<std::vector<std::uint32_t>> words_of(gpu::Device& device, const gpu::Buffer& buffer, std::size_t count) {
    auto bytes = device.read_back(buffer, 0, count * sizeof(std::uint32_t));
    if (!bytes) return tl::unexpected(bytes.error());
    std::vector<std::uint32_t> words(count);
    std::memcpy(words.data(), bytes->data(), count * sizeof(std::uint32_t));
    return words;
}

bool casts_volumes(const convert::FlatScene& flat, const shading::InstanceData& instance) {
    if ((instance.flags & shading::instance_flag_visible) == 0) return false;
    constexpr std::uint32_t see_through = shading::material_flag_alpha_mask | shading::material_flag_alpha_blend;
    if ((flat.materials()[instance.material].flags & see_through) != 0) return false;
    const Geometry* geometry = flat.geometries()[instance.geometry];
    return geometry && !geometry->mesh.indices.empty();
}

}  // namespace

ShadowVolumes::ShadowVolumes(gpu::Device& device, gpu::Pipelines& pipelines)
    : device_(device), pipelines_(pipelines), map_executor_(device) {}

Result<void> ShadowVolumes::update(const GpuScene& scene, const passes::SceneInputs& inputs, glm::vec3 sun,
                                   const ShadowVolumeSettings& settings, VolumesBehind behind) {
    const Key wanted{scene.surface_revision(), sun, settings, behind};
    scene_ = inputs;
    scene_.has_tested = scene_.has_blended = false;
    if (wanted == key_) return {};
    const auto begin = std::chrono::steady_clock::now();
    if (wanted.surfaces != key_.surfaces)
        if (auto done = list_casters(scene); !done) return done;
    key_ = wanted;
    const Result<void> made = find_lit_triangles(scene.bounds()).and_then([&] { return list_volumes(); });
    if (!made) return key_ = {}, made;
    statistics_.build_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    inputs_.sun = sun;
    return {};
}

Result<void> ShadowVolumes::list_edges(const GpuScene& scene, const std::vector<std::uint32_t>& geometries) {
    std::vector<std::pair<std::uint32_t, std::uint64_t>> wanted;
    for (const std::uint32_t geometry : geometries) wanted.emplace_back(geometry, scene.geometry_revisions()[geometry]);
    if (wanted == listed_edges_) return {};
    std::vector<convert::MeshEdge> edges;
    std::vector<std::uint32_t> uses;
    edge_tables_.assign(scene.flat().geometries().size(), 0);
    edge_counts_ = edge_tables_;
    for (const std::uint32_t geometry : geometries) {
        convert::MeshEdges own = convert::mesh_edges(scene.flat().geometries()[geometry]->mesh);
        edge_tables_[geometry] = static_cast<std::uint32_t>(edges.size());
        edge_counts_[geometry] = static_cast<std::uint32_t>(own.edges.size());
        for (convert::MeshEdge& edge : own.edges) edge.first_use += static_cast<std::uint32_t>(uses.size());
        edges.insert(edges.end(), own.edges.begin(), own.edges.end());
        uses.insert(uses.end(), own.uses.begin(), own.uses.end());
    }
    listed_edges_.clear();
    if (auto done = upload(device_, edges_, edges); !done) return done;
    if (auto done = upload(device_, edge_uses_, uses); !done) return done;
    listed_edges_ = std::move(wanted);
    return {};
}

Result<void> ShadowVolumes::list_casters(const GpuScene& scene) {
    const convert::FlatScene& flat = scene.flat();
    std::set<std::uint32_t> geometries;
    for (const shading::InstanceData& instance : flat.instances())
        if (casts_volumes(flat, instance)) geometries.insert(instance.geometry);
    if (auto done = list_edges(scene, {geometries.begin(), geometries.end()}); !done) return done;
    std::vector<CasterRange> ranges;
    std::vector<std::uint32_t> first_triangles(flat.instances().size(), no_triangle);
    std::uint64_t triangles = 0, edges = 0;
    for (std::uint32_t i = 0; i < flat.instances().size(); ++i) {
        const shading::InstanceData& instance = flat.instances()[i];
        if (!casts_volumes(flat, instance)) continue;
        first_triangles[i] = static_cast<std::uint32_t>(triangles);
        ranges.push_back({static_cast<std::uint32_t>(triangles), static_cast<std::uint32_t>(edges), i,
                          edge_tables_[instance.geometry]});
        triangles += flat.geometries()[instance.geometry]->mesh.triangle_count();
        edges += edge_counts_[instance.geometry];
    }
    // Vertices of draws count three times as many.
    if (std::max(triangles, edges) > 0xffffffffull / 3)
        return fail("render.sun_shadows", "more triangles than volumes can number");
    if (auto done = upload(device_, ranges_, ranges); !done) return done;
    if (auto done = upload(device_, first_triangles_, first_triangles); !done) return done;
    if (auto done = states_.reserve(device_, triangles * sizeof(std::uint32_t), 0); !done) return done;
    if (auto done = tallies_.reserve(device_, ranges.size() * sizeof(shading::CasterTally), 0); !done) return done;
    casters_ = {&ranges_.buffer(),
                &first_triangles_.buffer(),
                &edges_.buffer(),
                &edge_uses_.buffer(),
                &states_.buffer(),
                static_cast<std::uint32_t>(ranges.size()),
                static_cast<std::uint32_t>(triangles),
                static_cast<std::uint32_t>(edges)};
    return {};
}

ShadowVolumes::View ShadowVolumes::view_of(const Bounds& bounds, glm::vec3 sun) {
    View view{axes_along(sun)};
    const Bounds seen = seen_along(view.axes, bounds);
    const glm::dvec3 low(seen.min), high(seen.max);
    view.edge_m = std::max(high.x - low.x, high.y - low.y);
    view.left = 0.5 * (low.x + high.x - view.edge_m);
    view.top = 0.5 * (low.y + high.y + view.edge_m);
    view.near_m = low.z;
    view.range_m = high.z - low.z;
    return view;
}

glm::mat4 ShadowVolumes::View::world_to_clip(std::uint32_t round, Part part) const {
    const double half = std::ldexp(edge_m, -static_cast<int>(round) - 1);
    const double x = left + (2 * part.x + 1) * half, y = top - (2 * part.y + 1) * half;
    const glm::dvec3 right(axes.right), up(axes.up), forward(axes.forward);
    return glm::transpose(
        glm::mat4(glm::dmat4(glm::dvec4(right, -x) / half, glm::dvec4(up, -y) / half,
                             glm::dvec4(-forward, near_m + range_m) / range_m, glm::dvec4(0, 0, 0, 1))));
}

Result<void> ShadowVolumes::build_map_graph(std::uint32_t size) {
    const std::uint32_t capacity = instance_capacity(scene_.instance_count);
    const std::pair wanted{size, capacity};
    if (wanted != map_key_) {
        map_key_ = {};
        if (auto done = device_.wait_idle(); !done) return done;
        graph::Graph graph;
        map_buffers_ = {graph.import_buffer({"caster states"}), graph.import_buffer({"lit map header"})};
        graph.export_buffer(map_buffers_.states);
        graph.export_buffer(map_buffers_.header);
        if (auto done = passes::add_lit_map(graph, pipelines_, scene_, casters_, map_buffers_, view_.buffer(), part_,
                                            size, capacity);
            !done)
            return done;
        if (auto done = map_executor_.set_graph(graph); !done) return done;
        map_key_ = wanted;
    }
    map_executor_.bind(map_buffers_.states, states_.buffer());
    map_executor_.bind(map_buffers_.header, header_.buffer());
    return {};
}

Result<void> ShadowVolumes::find_lit_triangles(const Bounds& bounds) {
    statistics_ = {.triangles = casters_.triangle_count, .builds = statistics_.builds + 1};
    if (casters_.triangle_count == 0) return {};
    const View view = view_of(bounds, key_.sun);
    const auto size = static_cast<std::uint32_t>(key_.settings.map_size);
    const double texel_m = view.edge_m / size;
    const auto significant_m2 = static_cast<float>(key_.settings.significant_px * texel_m * texel_m);
    if (auto done = view_.reserve(device_, sizeof(shading::ViewData), 0); !done) return done;
    auto done = run(device_, "caster states", [&](gpu::Commands& commands) {
        return passes::record_classify(commands, pipelines_, scene_, casters_, key_.sun, significant_m2);
    });
    // Volumes behind all triangles need not know which are lit.
    if (!done || key_.behind == VolumesBehind::all) return done;
    std::vector<Part> parts{{0, 0}};
    const std::uint32_t last = last_round(key_.settings.significant_px);
    for (std::uint32_t round = 0; round <= last && !parts.empty(); ++round) {
        auto next = draw_round(view, round, round == last, parts);
        if (!next) return tl::unexpected(next.error());
        parts = std::move(*next);
    }
    return key_.behind == VolumesBehind::fewest ? join_triangles() : Result<void>{};
}

Result<std::vector<ShadowVolumes::Part>> ShadowVolumes::draw_round(const View& view, std::uint32_t round, bool last,
                                                                   const std::vector<Part>& parts) {
    const auto size = static_cast<std::uint32_t>(key_.settings.map_size);
    const std::uint32_t row = 2u << round;
    constexpr std::size_t header_words = sizeof(shading::LitMapHeader) / sizeof(std::uint32_t);
    const std::vector<std::uint32_t> zeros(header_words + std::size_t{row} * row, 0);
    if (auto done = upload(device_, header_, zeros); !done) return tl::unexpected(done.error());
    if (auto done = build_map_graph(size); !done) return tl::unexpected(done.error());
    const double texel_m = std::ldexp(view.edge_m / size, -static_cast<int>(round));
    for (const Part part : parts) {
        const shading::ViewData drawn{view.world_to_clip(round, part)};
        part_ = {drawn.world_to_clip, casters_.range_count, casters_.triangle_count, size,
                 static_cast<float>(texel_m / view.range_m), 2 * part.x, 2 * part.y, row, last ? 1u : 0u};
        if (auto done = device_.upload(view_.buffer(), std::span<const shading::ViewData>(&drawn, 1)); !done)
            return tl::unexpected(done.error());
        auto done = run(device_, "lit map", [&](gpu::Commands& commands) { return map_executor_.execute(commands); });
        if (!done) return tl::unexpected(done.error());
    }
    auto words = words_of(device_, header_.buffer(), zeros.size());
    if (!words) return tl::unexpected(words.error());
    statistics_.parts += static_cast<std::uint32_t>(parts.size());
    statistics_.found_by_round.push_back(words->front());
    std::vector<Part> next;
    for (std::uint32_t y = 0; y < row; ++y)
        for (std::uint32_t x = 0; x < row; ++x)
            if ((*words)[header_words + y * row + x] != 0) next.push_back({x, y});
    return next;
}

Result<void> ShadowVolumes::join_triangles() {
    if (auto done = weights_.reserve(device_, casters_.triangle_count * sizeof(std::int32_t), 0); !done) return done;
    return run(device_, "joined triangles", [&](gpu::Commands& commands) {
        for (const GrowingBuffer* zeros : {&weights_, &tallies_}) commands.fill(zeros->buffer(), 0);
        commands.memory_barrier(everything, everything);
        return passes::record_joins(commands, pipelines_, scene_, casters_, weights_.buffer(), tallies_.buffer());
    });
}

Result<void> ShadowVolumes::list_volumes() {
    constexpr std::uint32_t choices[] = {shading::behind_lit, shading::behind_fewest, shading::behind_all};
    std::uint32_t side_count = 1, cap_count = 1;
    while (true) {
        constexpr std::uint64_t side_bytes = 3 * sizeof(std::uint32_t), cap_bytes = sizeof(glm::uvec2);
        if (auto done = sides_.reserve(device_, side_count * side_bytes, 0); !done) return done;
        if (auto done = caps_.reserve(device_, 2 * cap_count * cap_bytes, 0); !done) return done;
        const std::vector<shading::VolumeDraw> none(shading::volume_edges + 1, {0, 1, 0, 0});
        if (auto done = upload(device_, draws_, none); !done) return done;
        const passes::VolumeLists lists{&sides_.buffer(), &caps_.buffer(), &draws_.buffer(), &tallies_.buffer(),
                                        static_cast<std::uint32_t>(sides_.size() / side_bytes),
                                        static_cast<std::uint32_t>(caps_.size() / (2 * cap_bytes))};
        inputs_.sides = lists.sides;
        inputs_.caps = lists.caps;
        inputs_.draws = lists.draws;
        inputs_.cap_capacity = lists.cap_capacity;
        if (casters_.triangle_count == 0) return {};
        auto done = run(device_, "volume lists", [&](gpu::Commands& commands) {
            return passes::record_volume_lists(commands, pipelines_, scene_, casters_, lists,
                                               choices[static_cast<std::size_t>(key_.behind)]);
        });
        if (!done) return done;
        auto counted = device_.read_back(draws_.buffer(), 0, sizeof(shading::VolumeDraw) * none.size());
        if (!counted) return tl::unexpected(counted.error());
        std::array<shading::VolumeDraw, shading::volume_edges + 1> draws;
        std::memcpy(draws.data(), counted->data(), sizeof(draws));
        side_count = draws[shading::volume_draw_sides].vertex_count / 3;
        const std::uint32_t toward = draws[shading::volume_draw_toward].vertex_count / 3;
        const std::uint32_t away = draws[shading::volume_draw_away].vertex_count / 3;
        cap_count = std::max(toward, away);
        statistics_.edges = draws[shading::volume_edges].vertex_count;
        statistics_.sides = side_count;
        statistics_.caps = toward + away;
        if (side_count <= lists.side_capacity && cap_count <= lists.cap_capacity) return {};
    }
}

}  // namespace heliodon::realtime
