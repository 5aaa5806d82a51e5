#pragma once

#include <cstdint>
#include <deque>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/math.h"
#include "core/result.h"
#include "scene/camera.h"
#include "scene/display_settings.h"
#include "scene/geometry.h"
#include "scene/handle.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/sun_position.h"
#include "scene/sun_shadow_settings.h"

namespace heliodon {

using NodeId = Handle<struct NodeTag>;
using GeometryId = Handle<struct GeometryTag>;
using CameraId = Handle<struct CameraTag>;
using SensorId = Handle<struct SensorTag>;
using AnimationId = Handle<struct AnimationTag>;

struct Transform {
    glm::vec3 translation{0};
    glm::quat rotation{1, 0, 0, 0};  ///< w, x, y, z
    glm::vec3 scale{1};
    /// T · R · S
    [[nodiscard]] glm::mat4 matrix() const;
};
/// R = Rx · Ry · Rz, as scene files have it.
[[nodiscard]] glm::quat rotation_from_euler_deg(glm::vec3 degrees);

/// One drawable of a node. An empty material means the default one.
struct Part {
    GeometryId geometry;
    MaterialId material;
};

/// A node's place in the hierarchy, which only the scene changes.
class NodeLinks {
    friend class Scene;
    friend struct Node;
    NodeId parent;
    std::vector<NodeId> children;
};

struct Node {
    std::string name;
    Transform transform;
    std::optional<glm::mat4> matrix;  ///< replaces the transform where a file gives a matrix with shear
    std::vector<Part> parts;
    std::optional<Light> light;
    bool visible = true;  ///< hides the node and all below it

    NodeLinks links;

    [[nodiscard]] glm::mat4 local_matrix() const { return matrix ? *matrix : transform.matrix(); }
    [[nodiscard]] NodeId parent() const { return links.parent; }
    [[nodiscard]] std::span<const NodeId> children() const { return links.children; }
};

enum class SkyModel : std::uint8_t { none, constant, image, cie, hosek, preetham };
struct Sky {
    SkyModel model = SkyModel::none;
    glm::vec3 luminance_nits{0};  ///< constant; for an image sky it scales the image (default 1)
    TextureId image;              ///< equirectangular float32 texture, cd/m²; its centre column looks to −Z
    float north_rad = 0;          ///< turns the sky clockwise seen from above

    static constexpr int traditional_overcast = 16;
    int cie_type = 1;                     ///< ISO 15469's 1 to 15, or traditional_overcast
    float zenith_luminance_nits = 5000;   ///< cie
    float ground_albedo = 0.2f;           ///< cie, hosek, preetham: below the horizon a diffuse ground that the sky lights
    float sun_azimuth_rad = 0;            ///< cie, hosek, preetham: clockwise from north
    float sun_elevation_rad = std::numbers::pi_v<float> / 2;  ///< of the middle of its disc, as it appears
    float turbidity = 3;                  ///< hosek, preetham
    static constexpr float least_turbidity_hosek = 1, least_turbidity_preetham = 2, most_turbidity = 10;
    bool sun_disc = true;                 ///< hosek, preetham: the sun itself shines, as a disc that darkens to its limb
    float sun_angular_diameter_rad = glm::radians(0.53f);
    std::optional<Place> place;     ///< from which the sun is seen, where the scene says so
    std::optional<CivilTime> time;  ///< when

    [[nodiscard]] bool is_daylight() const { return model == SkyModel::hosek || model == SkyModel::preetham; }
};

/// counts.x × counts.y cells of the parallelogram u, v, whose front is u × v.
struct SensorGrid {
    glm::vec3 u{1, 0, 0}, v{0, 1, 0};  ///< metres
    glm::ivec2 counts{1};
};
enum class SensorType : std::uint8_t { illuminance, luminance };
struct Sensor {
    std::string name;
    SensorType type = SensorType::illuminance;
    glm::vec3 position{0};
    glm::vec3 direction{0, 1, 0};  ///< illuminance: the surface normal; luminance: the way it looks
    std::optional<float> offset_m;   ///< how far along `direction` it begins; else 10⁻⁴ of the scene's size
    std::optional<SensorGrid> grid;  ///< many illuminances from `position` on, one in the middle of each cell
};

/// What a keyframe channel drives. Values hold 1, 3 or 4 floats a key as the property needs (rotation:
/// quaternion x y z w).
enum class AnimatedProperty : std::uint8_t {
    node_translation,
    node_rotation,
    node_scale,
    node_visible,
    light_intensity,
    light_inner_rad,
    light_outer_rad,
    light_radius_m,
    light_direction,
    camera_position,
    camera_target,
    camera_vertical_fov_rad,
    camera_ev100,
    material_base_color,
    material_opacity,
    material_metallic,
    material_roughness,
    material_emission_nits,
    material_transmission,
    material_ior,
    sky_luminance_nits,
    sky_time,
};
enum class Interpolation : std::uint8_t { step, linear, cubic };
struct AnimationChannel {
    AnimatedProperty property = AnimatedProperty::node_translation;
    std::variant<std::monostate, NodeId, CameraId, MaterialId> target;  ///< monostate: the sky
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times_s;  ///< increasing
    std::vector<float> values;   ///< cubic: in-tangent, value, out-tangent a key, as glTF
    CivilTime origin;            ///< sky_time: `values` are seconds after it
};
/// Floats a value of `property` takes: 1, 3 or 4.
[[nodiscard]] int component_count(AnimatedProperty property);
struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
};

/// What the derived databases get: the scene file's `convert` block.
struct ConvertSettings {
    int texture_size_limit = 0;  ///< texels a side; 0 = unlimited
    int shape_segments = 128;    ///< round a full circle
    enum class Precision : std::uint8_t { full, compact } vertex_precision = Precision::full;
};
/// When surfaces are voxelized anew: never after the first time, where the scene changed, or in every frame.
enum class Revoxelize : std::uint8_t { once, changed, always };
/// Who voxelizes: the one that is faster on the device, the hardware rasterizer, or compute.
enum class Voxelizer : std::uint8_t { automatic, raster, compute };
/// Who rasterizes the picture and the shadow maps: likewise.
enum class Rasterizer : std::uint8_t { automatic, hardware, compute };

/// How the path engine makes pictures.
enum class Integrator : std::uint8_t { path, bidirectional };

/// What a voxel shows: its own value to each of six sides, or one value to all (docs/gi-theory.md).
enum class VoxelFiltering : std::uint8_t { anisotropic, isotropic };

/// Which pixels trace diffuse and specular cones for those about them: each, or one of 2×2 or of 4×4.
enum class ConeResolution : std::uint8_t { full, half, quarter };

/// Effects of voxel cone tracing, each of which switches alone.
struct ConeTracingSettings {
    bool diffuse = true, specular = true, refraction = true;
    bool shadows = false;  ///< lights by a cone of their true size instead of shadow maps
    bool ao = true;        ///< off: the sky is not occluded
    int cones = 9;         ///< over the hemisphere; a multiple of 9
    bool narrow = true;    ///< a still picture's samples share the hemisphere and the lobe: the more, the narrower their cones
    bool caustics = true;  ///< what surfaces reflect specularly of lights goes ahead to others, not to all sides evenly
    ConeResolution resolution = ConeResolution::full;
    VoxelFiltering filtering = VoxelFiltering::anisotropic;
    bool operator==(const ConeTracingSettings&) const = default;
};

/// Without global illumination: what stands for the light that surroundings reflect. An approximation
/// (docs/accuracy.md): a distant closed shell of the scene's mean albedo, lit by the sun and the sky.
enum class AmbientLight : std::uint8_t { none, constant, directional };

/// Without global illumination: what the picture shows about a surface hides the sky from it.
struct AmbientOcclusionSettings {
    bool on = true;
    float reach_m = 0;      ///< how far away something still hides it; 0: as far as the picture shows
    float thickness_m = 0;  ///< how far what is seen goes on behind its front; 0: without end
    bool operator==(const AmbientOcclusionSettings&) const = default;
};

/// The scene file's `render` block.
struct RenderSettings {
    std::string gi = "none";
    int voxels = 128;   ///< an edge of one cascade of the voxel volume; a power of two, 32 to 512
    int cascades = 1;   ///< nested volumes, each twice as wide as the one within it
    int bounces = 0;    ///< of indirect light in the voxel volume; 0 ("inf" in files): all
    Revoxelize revoxelize = Revoxelize::changed;
    Voxelizer voxelizer = Voxelizer::automatic;
    Rasterizer rasterizer = Rasterizer::automatic;
    Integrator integrator = Integrator::path;
    ConeTracingSettings vct;
    DisplaySettings display;
    AmbientLight ambient = AmbientLight::none;
    AmbientOcclusionSettings ambient_occlusion;
    int shadow_map_size = 0;  ///< texels an edge of a shadow map; 0: as the picture can tell, 2048 at most
    SunShadows sun_shadows = SunShadows::cascades;
    ShadowCascadeSettings shadow_cascades;
    ShadowVolumeSettings shadow_volumes;
};

/// One entry of the journal: which table, which slot, what about it changed.
struct Change {
    enum class Table : std::uint8_t { node, geometry, texture, material, camera, sensor, animation, sky, settings };
    enum Aspect : std::uint8_t {
        added = 1,
        removed = 2,
        value = 4,
        transform = 8,
        parts = 16,
        light = 32,
        hierarchy = 64,
        visibility = 128
    };
    Table table;
    std::uint8_t aspects;
    std::uint32_t index;
};

/// The generic, physical description of a scene. Every edit goes through here and leaves an entry in the
/// change journal; derived databases (GPU, Embree) read the journal from where they last stood. The journal keeps
/// the newest 2²⁰ changes.
class Scene {
public:
    using Nodes = Slots<Node, NodeTag>;
    using Geometries = Slots<Geometry, GeometryTag>;
    using Textures = Slots<Texture, TextureTag>;
    using Materials = Slots<Material, MaterialTag>;
    using Cameras = Slots<Camera, CameraTag>;
    using Sensors = Slots<Sensor, SensorTag>;
    using Animations = Slots<Animation, AnimationTag>;

    // -- reading
    [[nodiscard]] const Nodes& nodes() const { return nodes_; }
    [[nodiscard]] const Geometries& geometries() const { return geometries_; }
    [[nodiscard]] const Textures& textures() const { return textures_; }
    [[nodiscard]] const Materials& materials() const { return materials_; }
    [[nodiscard]] const Cameras& cameras() const { return cameras_; }
    [[nodiscard]] const Sensors& sensors() const { return sensors_; }
    [[nodiscard]] const Animations& animations() const { return animations_; }
    [[nodiscard]] const Sky& sky() const { return sky_; }
    [[nodiscard]] const ConvertSettings& convert_settings() const { return convert_; }
    [[nodiscard]] const RenderSettings& render_settings() const { return render_; }
    [[nodiscard]] std::span<const NodeId> roots() const { return roots_; }
    [[nodiscard]] glm::mat4 world_matrix(NodeId id) const;
    [[nodiscard]] bool world_visible(NodeId id) const;
    /// World bounds of all visible geometry.
    [[nodiscard]] Bounds bounds() const;
    [[nodiscard]] NodeId find_node(std::string_view name) const;
    [[nodiscard]] MaterialId find_material(std::string_view name) const;
    [[nodiscard]] CameraId find_camera(std::string_view name) const;

    // -- adding and removing. Removing a node removes what is below it; removing anything else leaves stale
    // handles in what used it, which read as absent.
    /// An empty handle, adding nothing, where `parent` is stale.
    NodeId add_node(Node node, NodeId parent = {});
    /// Its bounds are computed here.
    GeometryId add_geometry(Geometry geometry);
    /// A shape with its tessellation by `convert_settings().shape_segments`.
    GeometryId add_shape(Shape shape, std::string name = {});
    TextureId add_texture(Texture texture);
    MaterialId add_material(Material material);
    CameraId add_camera(Camera camera);
    SensorId add_sensor(Sensor sensor);
    AnimationId add_animation(Animation animation);
    bool remove(NodeId id);
    bool remove(GeometryId id);
    bool remove(TextureId id);
    bool remove(MaterialId id);
    bool remove(CameraId id);
    bool remove(SensorId id);
    bool remove(AnimationId id);

    // -- editing. Each returns false for a stale handle (and then changes nothing).
    /// Drops the node's matrix. Setting the present transform or visibility again leaves no change.
    bool set_transform(NodeId id, const Transform& transform);
    bool set_matrix(NodeId id, const glm::mat4& matrix);
    bool set_parts(NodeId id, std::vector<Part> parts);
    bool set_light(NodeId id, std::optional<Light> light);
    bool set_visible(NodeId id, bool visible);
    bool set_name(NodeId id, std::string name);
    /// An empty `parent` makes a root. Refused (false) where it would make a cycle.
    bool set_parent(NodeId id, NodeId parent);
    bool set_geometry(GeometryId id, Geometry geometry);
    bool set_texture(TextureId id, Texture texture);
    bool set_material(MaterialId id, Material material);
    bool set_camera(CameraId id, Camera camera);
    bool set_sensor(SensorId id, Sensor sensor);
    void set_sky(const Sky& sky);
    /// A new `shape_segments` tessellates every shape again.
    void set_convert_settings(const ConvertSettings& settings);
    void set_render_settings(RenderSettings settings);

    /// Sets every animated value to its state at `time_s`, through the journal. Before the first key and
    /// after the last, the end values hold.
    void apply_animations(double time_s);
    /// Time of the last key of any animation; 0 without any.
    [[nodiscard]] double animation_duration_s() const;

    // -- the journal
    /// Sequence number one past the newest change.
    [[nodiscard]] std::uint64_t journal_end() const { return journal_begin_ + journal_.size(); }
    /// Calls `visit(const Change&)` for each change from `since` on; returns false (visiting nothing) when
    /// the journal no longer reaches back that far, and the reader must rebuild.
    template <class Visit>
    bool changes_since(std::uint64_t since, Visit&& visit) const {
        if (since < journal_begin_) return false;
        for (std::size_t i = since - journal_begin_; i < journal_.size(); ++i) visit(journal_[i]);
        return true;
    }

private:
    void record(Change::Table table, std::uint8_t aspects, std::uint32_t index);
    std::vector<NodeId>& siblings(const Node& node);
    void apply(const AnimationChannel& channel, double time_s);
    void apply_to_node(NodeId id, AnimatedProperty property, glm::vec4 value);
    void apply_to_light(NodeId id, AnimatedProperty property, glm::vec4 value);
    void apply_to_camera(CameraId id, AnimatedProperty property, glm::vec4 value);
    void apply_to_material(MaterialId id, AnimatedProperty property, glm::vec4 value);
    void apply_to_sky(glm::vec3 luminance_nits);

    Nodes nodes_;
    Geometries geometries_;
    Textures textures_;
    Materials materials_;
    Cameras cameras_;
    Sensors sensors_;
    Animations animations_;
    std::vector<NodeId> roots_;
    Sky sky_;
    ConvertSettings convert_;
    RenderSettings render_;
    std::deque<Change> journal_;
    std::uint64_t journal_begin_ = 0;
};

}  // namespace heliodon
