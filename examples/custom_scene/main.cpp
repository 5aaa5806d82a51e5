// Builds a scene in code, renders it with both engines and says how far they are apart.
#include <heliodon/heliodon.h>
#include <cstdio>

using namespace heliodon;

namespace {

Scene build_scene() {
    Scene scene;

    Material plaster;
    plaster.name = "plaster";
    plaster.model = MaterialModel::lambert;
    plaster.base_color = glm::vec3(0.7f);
    const MaterialId plaster_id = scene.add_material(plaster);

    Material brass;
    brass.name = "brass";
    brass.base_color = {0.91f, 0.78f, 0.42f};
    brass.metallic = 1.0f;
    brass.roughness = 0.4f;
    const MaterialId brass_id = scene.add_material(brass);

    Node floor;
    floor.name = "floor";
    floor.parts = {{scene.add_shape(Quad{{-2, 0, -2}, {0, 0, 4}, {4, 0, 0}}, "floor"), plaster_id}};
    scene.add_node(floor);

    Node ball;
    ball.name = "ball";
    ball.transform.translation = {0, 0.5f, 0};
    ball.parts = {{scene.add_shape(Sphere{{0, 0, 0}, 0.5f}, "ball"), brass_id}};
    scene.add_node(ball);

    Light bulb;
    bulb.intensity = glm::vec3(200.0f);  // cd
    Node lamp;
    lamp.name = "lamp";
    lamp.transform.translation = {1, 2, 1};
    lamp.light = bulb;
    scene.add_node(lamp);

    Camera camera;
    camera.name = "main";
    camera.position = {0, 1.2f, 3};
    camera.target = {0, 0.4f, 0};
    camera.ev100_override = 5.0f;
    scene.add_camera(camera);
    return scene;
}

int complain(const Error& error) {
    std::fprintf(stderr, "%s\n", error.text().c_str());
    return 1;
}

Result<Picture> render_with_paths(const Scene& scene, const Camera& camera, int size) {
    PathTracer tracer;
    if (const auto updated = tracer.update(scene); !updated) return tl::unexpected(updated.error());
    PathOptions options;
    options.width = options.height = size;
    options.max_depth = 1;  // direct light, as the real-time engine
    return tracer.render(scene, camera, options);
}

Result<Picture> render_in_real_time(const Scene& scene, const Camera& camera, int size) {
    auto renderer = RealtimeRenderer::create({});
    if (!renderer) return tl::unexpected(renderer.error());
    if (const auto updated = renderer->update(scene); !updated) return tl::unexpected(updated.error());
    RealtimeOptions options;
    options.width = options.height = size;
    return renderer->render(scene, camera, options);
}

}  // namespace

int main() {
    const Scene scene = build_scene();
    const Camera camera = *scene.cameras().at(0);

    const auto reference = render_with_paths(scene, camera, 256);
    if (!reference) return complain(reference.error());
    const auto picture = render_in_real_time(scene, camera, 256);
    if (!picture) return complain(picture.error());
    if (const auto written = write_picture("custom_scene-path.exr", *reference); !written)
        return complain(written.error());
    if (const auto written = write_picture("custom_scene-realtime.exr", *picture); !written)
        return complain(written.error());

    const auto error = compare(reference->image, picture->image, camera.ev100());
    if (!error) return complain(error.error());
    std::printf("median relative error %.4f, FLIP %.4f\n", error->median_relative, error->flip);
}
