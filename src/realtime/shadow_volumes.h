#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "graph/executor.h"
#include "passes/shadow_volumes/lit_map.h"
#include "passes/shadow_volumes/shadow_volumes.h"
#include "realtime/gpu_scene.h"
#include "realtime/light_axes.h"
#include "realtime/shadow_volume_statistics.h"

namespace heliodon::realtime {

/// The shadow volumes of one directional light: finds the triangles that it lights in maps of what it sees, and the
/// silhouettes of these. That is enough, since what first stands in a point's way to the light is itself lit. Opaque
/// surfaces cast volumes, alpha-masked and blended ones do not. Triangles that face the light have volumes too where
/// there are fewer silhouettes with them.
class ShadowVolumes {
public:
    ShadowVolumes(gpu::Device& device, gpu::Pipelines& pipelines);

    /// Makes them anew where the surfaces, the light or the settings changed, and waits. `sun`: unit, the way the light
    /// travels.
    [[nodiscard]] Result<void> update(const GpuScene& scene, const passes::SceneInputs& inputs, glm::vec3 sun,
                                      const ShadowVolumeSettings& settings, VolumesBehind behind);
    /// What the pass draws; the owner of the picture sets its world_to_clip.
    [[nodiscard]] passes::ShadowVolumeInputs& inputs() { return inputs_; }
    [[nodiscard]] const ShadowVolumeStatistics& statistics() const { return statistics_; }

private:
    struct Key {
        std::uint64_t surfaces = ~0ull;
        glm::vec3 sun{0};
        ShadowVolumeSettings settings;
        VolumesBehind behind = VolumesBehind::fewest;
        bool operator==(const Key&) const = default;
    };
    /// One part of the map: of 4^round squares.
    struct Part {
        std::uint32_t x = 0, y = 0;
    };
    /// What the sun sees of the scene: a square, and how far it reaches.
    struct View {
        LightAxes axes;
        double left = 0, top = 0, edge_m = 1, near_m = 0, range_m = 1;
        [[nodiscard]] glm::mat4 world_to_clip(std::uint32_t round, Part part) const;
    };

    [[nodiscard]] static View view_of(const Bounds& bounds, glm::vec3 sun);
    [[nodiscard]] Result<void> list_casters(const GpuScene& scene);
    [[nodiscard]] Result<void> list_edges(const GpuScene& scene, const std::vector<std::uint32_t>& geometries);
    [[nodiscard]] Result<void> build_map_graph(std::uint32_t size);
    [[nodiscard]] Result<void> find_lit_triangles(const Bounds& bounds);
    [[nodiscard]] Result<std::vector<Part>> draw_round(const View& view, std::uint32_t round, bool last,
                                                       const std::vector<Part>& parts);
    [[nodiscard]] Result<void> join_triangles();
    [[nodiscard]] Result<void> list_volumes();

    gpu::Device& device_;
    gpu::Pipelines& pipelines_;
    Key key_;
    passes::SceneInputs scene_;  // without what casts no volumes
    passes::Casters casters_;
    passes::ShadowVolumeInputs inputs_;
    ShadowVolumeStatistics statistics_;
    shading::LitMapConstants part_{};
    graph::Executor map_executor_;
    passes::LitMapBuffers map_buffers_;
    std::pair<std::uint32_t, std::uint32_t> map_key_{0, 0};              // its size, and room for instances
    std::vector<std::pair<std::uint32_t, std::uint64_t>> listed_edges_;  // geometry, revision
    std::vector<std::uint32_t> edge_tables_, edge_counts_;               // by geometry
    GrowingBuffer ranges_{"casters", 0}, first_triangles_{"first triangles", 0}, edges_{"caster edges", 0},
        edge_uses_{"caster edge uses", 0}, states_{"caster states", 0}, header_{"lit map header", 0},
        view_{"lit map view", 0}, weights_{"join weights", 0}, tallies_{"caster tallies", 0}, sides_{"volume sides", 0},
        caps_{"volume caps", 0}, draws_{"volume draws", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT};
};

}  // namespace heliodon::realtime
