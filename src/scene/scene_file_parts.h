#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "scene/json_cursor.h"
#include "scene/scene.h"
#include "scene/scene_file.h"

/// The blocks of a scene file, each read into the scene's own types. All of them throw Refusal.
namespace heliodon::scene_file {

[[nodiscard]] Camera read_camera(const JsonCursor& cursor);
[[nodiscard]] Sensor read_sensor(const JsonCursor& cursor);
/// A light, and for a luminaire the file that measured it and what is made of it.
struct LightBlock {
    Light light;
    struct Photometry {
        std::filesystem::path file;  ///< relative to the scene file
        int lamp_set = 1;
        float scale = 1;
        std::optional<float> flux_lm;  ///< in the place of the measured
        glm::vec3 color{1};            ///< of luminance 1
    };
    std::optional<Photometry> photometry;
};
[[nodiscard]] LightBlock read_light(const JsonCursor& cursor);
/// An exact shape, or the triangles of a procedural one.
[[nodiscard]] std::variant<Shape, Mesh> read_shape(const JsonCursor& cursor);
[[nodiscard]] ConvertSettings read_convert_settings(const JsonCursor& cursor);
[[nodiscard]] RenderSettings read_render_settings(const JsonCursor& cursor);
/// Of the render block: tonemap, exposure, white_balance.
[[nodiscard]] DisplaySettings read_display(ObjectReader& render);
/// Probe grids are checked and not kept: nothing bakes them yet.
void check_probes(const JsonCursor& cursor);

struct MaterialBlock {
    Material material;
    MaterialTextures textures;  ///< relative to the file
};
[[nodiscard]] MaterialBlock read_material(const std::string& name, const JsonCursor& cursor);

struct SkyBlock {
    Sky sky;
    std::filesystem::path image;  ///< relative to the file; empty unless the model is `image`
};
[[nodiscard]] SkyBlock read_sky(const JsonCursor& cursor);

/// Targets name nodes, cameras and materials of `scene`, which must be complete.
[[nodiscard]] Animation read_animation(const JsonCursor& cursor, const Scene& scene);

}  // namespace heliodon::scene_file
