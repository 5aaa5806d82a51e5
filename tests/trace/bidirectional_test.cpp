// Bidirectional path tracing is equal in the mean to the path tracer, whatever emits, scatters and hides.
#include <fmt/format.h>

#include <cstring>
#include <functional>

#include "picture_means.h"
#include "scene/luminaire.h"

namespace heliodon::tests {
namespace {

// -- scenes

Light spot_light(float radius_m) {
    Light light = point_light(60, radius_m);
    light.type = LightType::spot;
    light.inner_rad = .3f;
    light.outer_rad = 1;
    return light;
}

Light beam(float angular_diameter_rad) {
    Light light;
    light.type = LightType::directional;
    light.intensity = {500, 450, 400};
    light.angular_diameter_rad = angular_diameter_rad;
    return light;
}

Light luminaire(glm::vec3 opening_m) {
    auto measured = std::make_shared<Luminaire>();
    measured->web.polar_rad = {0, pi / 6, pi / 3, pi / 2};
    measured->web.azimuth_rad = {0};
    measured->web.candela = {60, 90, 30, 0};
    measured->opening = {opening_m.x > 0 ? OpeningShape::box : OpeningShape::point, opening_m};
    integrate(*measured);
    Light light;
    light.type = LightType::luminaire;
    light.intensity = glm::vec3(static_cast<float>(measured->peak_cd));
    light.luminaire = measured;
    return light;
}

/// A dim sky of 8 × 4 texels with a bright one, up in front of the camera.
void add_image_sky(Scene& scene) {
    constexpr int columns = 8, rows = 4;
    std::vector<float> texels(4 * columns * rows, 1.0f);
    for (int c = 0; c < 3; ++c) texels[4 * (1 * columns + 1) + c] = 60;
    Texture image;
    image.width = columns;
    image.height = rows;
    image.format = TextureFormat::float32;
    image.levels.emplace_back(texels.size() * sizeof(float));
    std::memcpy(image.levels[0].data(), texels.data(), image.levels[0].size());
    Sky sky;
    sky.model = SkyModel::image;
    sky.luminance_nits = glm::vec3(10);
    sky.image = scene.add_texture(std::move(image));
    scene.set_sky(sky);
}

TEST(Bidirectional, AgreesWithThePathTracerWhateverEmits) {
    const Material lamp = lambert(.2f, 300), both_sides = lambert(.2f, 150, true);
    const glm::quat down = aiming_down();
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> emitters{
        {"point", [](Scene& s) { add_light(s, point_light(40), {.2f, 1.6f, .1f}); }},
        {"sphere light", [](Scene& s) { add_light(s, point_light(40, .2f), {.2f, 1.6f, .1f}); }},
        {"spot", [&](Scene& s) { add_light(s, spot_light(0), {.2f, 1.8f, .1f}, down); }},
        {"spot of a sphere", [&](Scene& s) { add_light(s, spot_light(.1f), {.2f, 1.8f, .1f}, down); }},
        {"lambertian",
         [&](Scene& s) {
             Light light = point_light(60);
             light.lambertian = true;
             add_light(s, light, {.2f, 1.8f, .1f}, down);
         }},
        {"directional", [](Scene& s) { add_light(s, beam(0), {}, glm::angleAxis(-.6f, glm::vec3(1, .5f, 0))); }},
        {"directional disc", [](Scene& s) { add_light(s, beam(.2f), {}, glm::angleAxis(-.6f, glm::vec3(1, .5f, 0))); }},
        {"quad", [&](Scene& s) { add_shape(s, Quad{{-.3f, 1.9f, -.3f}, {.6f, 0, 0}, {0, 0, .6f}}, lamp); }},
        {"parallelogram", [&](Scene& s) { add_shape(s, Quad{{-.3f, 1.9f, -.3f}, {.6f, 0, .3f}, {0, 0, .6f}}, both_sides); }},
        {"disk", [&](Scene& s) { add_shape(s, Disk{{0, 1.9f, 0}, {0, -1, 0}, .3f}, lamp); }},
        {"sphere", [&](Scene& s) { add_shape(s, Sphere{{.1f, 1.6f, 0}, .15f}, lamp); }},
        {"ellipsoid", [&](Scene& s) { add_shape(s, Sphere{{0, 1.6f, 0}, .2f}, lamp, {.scale = {1, .5f, 1.6f}}); }},
        {"box of triangles", [&](Scene& s) { add_shape(s, Box{{-.2f, 1.4f, -.1f}, {.2f, 1.6f, .1f}}, lamp); }},
        {"luminaire", [](Scene& s) { add_light(s, luminaire({0, 0, 0}), {.2f, 1.8f, .1f}); }},
        {"luminaire with an opening", [](Scene& s) { add_light(s, luminaire({.5f, .1f, .3f}), {.2f, 1.8f, .1f}); }},
        {"constant sky", [](Scene& s) { s.set_sky(even_sky(30)); }},
        {"image sky", add_image_sky},
        {"constant sky and lamp",
         [&](Scene& s) {
             s.set_sky(even_sky(10));
             add_shape(s, Disk{{0, 1.9f, 0}, {0, -1, 0}, .3f}, lamp);
         }},
    };
    for (const auto& [name, add] : emitters) {
        Scene scene = box_scene();
        add(scene);
        expect_both_modes_agree(name, scene, into_box());
    }
}

TEST(Bidirectional, AgreesAtEveryDepth) {
    Scene scene = box_scene();
    add_light(scene, point_light(40, .1f), {.2f, 1.6f, .1f});
    add_shape(scene, Disk{{-.5f, 1.9f, 0}, {0, -1, 0}, .2f}, lambert(.2f, 300));
    scene.set_sky(even_sky(3));
    for (const int depth : {1, 2, 3, 4}) expect_both_modes_agree(fmt::format("depth {}", depth), scene, into_box(), depth);
}

/// A row of balls and blocks of the models beyond the standard one's core.
TEST(Bidirectional, AgreesForEveryMaterialModel) {
    Scene scene = box_scene(false);
    add_light(scene, point_light(40, .1f), {.2f, 1.6f, .1f});
    Material disney, brushed, silk, sheet = rough_glass(), honey = rough_glass(), pane, clay;
    disney.model = MaterialModel::disney;
    disney.base_color = {.8f, .4f, .2f};
    disney.roughness = .5f;
    disney.clearcoat = disney.sheen = 1;
    brushed.model = MaterialModel::conductor;
    brushed.metal = NamedMetal::copper;
    brushed.roughness = .6f;
    brushed.anisotropy = .8f;
    silk.sheen_color = glm::vec3(.8f);
    silk.sheen_roughness = .5f;
    sheet.thin_walled = sheet.two_sided = true;
    honey.model = MaterialModel::dielectric;
    honey.base_color = glm::vec3(1);
    honey.attenuation_color = {.8f, .5f, .1f};
    honey.attenuation_distance_m = .3f;
    pane.model = MaterialModel::thin;
    pane.transmittance = {.2f, .6f};
    pane.two_sided = true;
    clay.model = MaterialModel::oren_nayar;
    clay.sigma_rad = .5f;
    add_shape(scene, Sphere{{.4f, .4f, .3f}, .3f}, honey);
    add_shape(scene, Sphere{{-.6f, 1.2f, -.3f}, .25f}, disney);
    add_shape(scene, Sphere{{0, 1.2f, -.3f}, .25f}, brushed);
    add_shape(scene, Sphere{{.6f, 1.2f, -.3f}, .25f}, silk);
    add_shape(scene, Box{{-.9f, 0, .2f}, {-.6f, .4f, .6f}}, clay);
    add_shape(scene, Quad{{-1, .5f, .7f}, {.9f, 0, 0}, {0, .6f, 0}}, sheet);
    add_shape(scene, Quad{{.1f, .9f, .7f}, {.8f, 0, 0}, {0, .8f, 0}}, pane);
    expect_both_modes_agree("material models", scene, into_box(), 0, 8);
}

/// A floor whose normals lean towards the wall, and a sheet whose normals lean away from its triangles by up to 40° and
/// by a map further.
Scene bent_normals() {
    Scene scene = box_scene(false);
    Geometry floor = triangle_mesh({{-1, .01f, -1}, {-1, .01f, 1}, {1, .01f, 1}, {-1, .01f, -1}, {1, .01f, 1}, {1, .01f, -1}});
    floor.mesh.normals.assign(6, glm::normalize(glm::vec3(.5f, 1, -1)));
    add_mesh(scene, std::move(floor), lambert(.9f));
    add_light(scene, point_light(40), {.2f, 1.6f, .1f});
    Geometry sheet = leaning_sheet();
    for (const glm::vec3& position : sheet.mesh.positions) {
        sheet.mesh.texcoords[0].push_back(3.0f * glm::vec2(position));
        sheet.mesh.tangents.push_back({1, 0, 0, 1});
    }
    Texture map;
    map.width = map.height = 4;
    map.format = TextureFormat::float32;
    std::vector<float> texels;
    for (int i = 0; i < 16; ++i) texels.insert(texels.end(), {.5f + .25f * (i % 3 - 1), .5f + .2f * (i / 4 % 3 - 1), 1, 1});
    map.levels.emplace_back(texels.size() * sizeof(float));
    std::memcpy(map.levels[0].data(), texels.data(), map.levels[0].size());
    Material glossy = rough_glass();
    glossy.transmission = .4f;
    glossy.two_sided = true;
    glossy.normal_texture.texture = scene.add_texture(std::move(map));
    add_mesh(scene, std::move(sheet), glossy);
    return scene;
}

TEST(Bidirectional, AgreesWhereShadingNormalsLeaveTheGeometry) {
    expect_both_modes_agree("bent normals", bent_normals(), into_box(), 0, 16);
}

TEST(Bidirectional, AgreesThroughVeilsMasksAndGlass) {
    expect_both_modes_agree("small room", small_room(), into_box(), 0, 8, .05);
    // A lamp of glowing plaster within a glass ball: all light crosses its surface.
    Scene globe = box_scene(false);
    add_shape(globe, Sphere{{.4f, 1.1f, 0}, .45f}, rough_glass());
    add_shape(globe, Sphere{{.4f, 1.1f, 0}, .2f}, lambert(.7f, 300));
    expect_both_modes_agree("lamp in glass", globe, into_box(), 0, 16);
}

}  // namespace
}  // namespace heliodon::tests
