#pragma once

#include <cstdio>
#include <cstdlib>

#include "core/metrics.h"
#include "test_scenes.h"
#include "trace/path_tracer.h"

namespace heliodon::tests {

/// HELIODON_ACCURACY_TABLE=1 prints the rows of docs/accuracy.md.
inline bool prints_accuracy_table() {
    return std::getenv("HELIODON_ACCURACY_TABLE") != nullptr;
}

/// A volume of `voxels` an edge and all bounces, by the wide cones of a single frame.
inline void use_cone_tracing(Scene& scene, int voxels, int cones = 9) {
    RenderSettings settings = scene.render_settings();
    settings.gi = "vct";
    settings.voxels = voxels;
    settings.cascades = 1;
    settings.bounces = 0;
    settings.vct = {};
    settings.vct.cones = cones;
    settings.vct.narrow = false;
    scene.set_render_settings(settings);
}

inline const Image& layer(const Picture& picture, std::string_view name) {
    for (const Layer& layer : picture.layers)
        if (layer.name == name) return layer.image;
    ADD_FAILURE() << "no layer " << name;
    return picture.image;
}

inline double mean_luminance(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += units::luminance(image.rgb(x, y));
    return sum / (double(image.width) * image.height);
}

/// An axis-aligned room that faces inward.
inline void add_room(Scene& scene, glm::vec3 min, glm::vec3 max, MaterialId material) {
    const glm::vec3 size = max - min;
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 u(0), v(0), far(0);
        u[(axis + 1) % 3] = size[(axis + 1) % 3];
        v[(axis + 2) % 3] = size[(axis + 2) % 3];
        far[axis] = size[axis];
        add_shape_node(scene, Quad{min, u, v}, material);
        add_shape_node(scene, Quad{min + far, v, u}, material);
    }
}

/// A camera in a room.
inline Camera inside(glm::vec3 eye, glm::vec3 target, float vertical_fov_rad = 1.9f) {
    Camera camera;
    camera.position = eye;
    camera.target = target;
    camera.vertical_fov_rad = vertical_fov_rad;
    camera.ev100_override = 3.0f;
    return camera;
}

/// The renderer with cone tracing, and the path tracer.
class GlobalIllumination : public RealtimeTest {
protected:
    /// A new renderer: each follows one scene.
    void start_over() {
        TearDown();
        SetUp();
    }
    Picture cone_traced(const Scene& scene, const Camera& camera, int size, int samples) {
        const auto updated = renderer->update(scene);
        if (!updated) ADD_FAILURE() << updated.error().text();
        RealtimeOptions options;
        options.width = options.height = size;
        options.samples = samples;
        options.gi = "vct";
        options.aovs = {"indirect"};
        return render(scene, camera, options);
    }
    static Picture path_traced(const Scene& scene, const Camera& camera, int size, int samples, int max_depth,
                               std::vector<std::string> aovs) {
        PathTracer tracer;
        const auto updated = tracer.update(scene);
        if (!updated) ADD_FAILURE() << updated.error().text();
        PathOptions options;
        options.width = options.height = size;
        options.samples_per_pixel = samples;
        options.max_depth = max_depth;
        options.aovs = std::move(aovs);
        auto picture = tracer.render(scene, camera, options);
        if (!picture) ADD_FAILURE() << picture.error().text();
        return picture ? std::move(*picture) : Picture{Image(size, size, 3), {}, 0, false};
    }
};

}  // namespace heliodon::tests
