#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "import/import.h"
#include "scene_building.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

PathOptions options_of(int size, int samples, int max_depth = 0) {
    PathOptions options;
    options.width = options.height = size;
    options.samples_per_pixel = samples;
    options.max_depth = max_depth;
    return options;
}

/// A camera so near the sphere that it fills the picture.
Camera facing_unit_sphere() {
    return looking({0, 0, 4}, {0, 0, 0}, 20);
}

/// The picture's mean and the half-width of that mean over its pixels, which are independent.
void report_mean(const std::string& name, double expected, const Picture& picture) {
    SensorReading reading;
    reading.value = luminance(mean(picture.image));
    double squares = 0;
    const int pixels = picture.image.width * picture.image.height;
    for (int i = 0; i < pixels; ++i)
        squares +=
            std::pow(luminance(picture.image.rgb(i % picture.image.width, i / picture.image.width)) - reading.value, 2);
    reading.half_width_95 = 1.96 * std::sqrt(squares / (pixels - 1.0) / pixels);
    report(name, expected, reading);
}

TEST(WhiteFurnace, ALambertSphereOfHalfReflectanceReturnsExactlyHalfOfAnEvenSky) {
    Scene scene;
    scene.set_sky(even_sky(1));
    add_shape(scene, Sphere{{0, 0, 0}, 1}, lambert(.5f));
    const Picture picture = render(scene, facing_unit_sphere(), options_of(32, 4));
    report_mean("white furnace, lambert of reflectance .5", .5, picture);
    for (const float value : picture.image.pixels) EXPECT_NEAR(value, 0.5f, 2e-6f);
}

TEST(WhiteFurnace, EveryRoughnessAndMetalnessReturnsAllOfAnEvenSky) {
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
            Scene scene;
            scene.set_sky(even_sky(1));
            Material material;
            material.base_color = glm::vec3(1);
            material.metallic = metallic;
            material.roughness = roughness;
            add_shape(scene, Sphere{{0, 0, 0}, 1}, material);
            const Picture picture = render(scene, facing_unit_sphere(), options_of(48, 64));
            const std::string name = fmt::format("white furnace, metallic {:g}, roughness {:g}", metallic, roughness);
            report_mean(name, 1, picture);
            EXPECT_NEAR(luminance(mean(picture.image)), 1.0, 0.005) << name;
        }
}

TEST(WhiteFurnace, ClearGlassReturnsAllOfAnEvenSky) {
    for (const float roughness : {0.0f, 0.3f}) {
        Scene scene;
        scene.set_sky(even_sky(1));
        Material glass;
        glass.base_color = glm::vec3(1);
        glass.transmission = 1;
        glass.roughness = roughness;
        add_shape(scene, Sphere{{0, 0, 0}, 1}, glass);
        const Picture picture = render(scene, facing_unit_sphere(), options_of(48, 256));
        report_mean(fmt::format("white furnace, clear glass, roughness {:g}", roughness), 1, picture);
        EXPECT_NEAR(luminance(mean(picture.image)), 1.0, 0.01) << "roughness " << roughness;
    }
}

TEST(Determinism, ThePictureDoesNotDependOnTheNumberOfThreads) {
    const Scene scene = small_room();
    const Camera camera = looking({0, 1, 3.4f}, {0, 1, 0});
    PathOptions options = options_of(40, 8);
    options.threads = 1;
    const Picture one = render(scene, camera, options);
    for (const int threads : {2, 8}) {
        options.threads = threads;
        EXPECT_EQ(render(scene, camera, options).image.pixels, one.image.pixels) << threads << " threads";
    }
    options.threads = 0;
    options.seed = 1;
    EXPECT_NE(render(scene, camera, options).image.pixels, one.image.pixels) << "another seed";
}

TEST(Layers, DirectAndIndirectLightAddUpToThePicture) {
    const Scene scene = small_room();
    PathOptions options = options_of(32, 8);
    options.aovs = {"albedo", "normal", "depth", "position", "direct", "indirect"};
    const Picture picture = render(scene, looking({0, 1, 3.4f}, {0, 1, 0}), options);
    ASSERT_EQ(picture.layers.size(), 6u);
    const Image &direct = picture.layers[4].image, &indirect = picture.layers[5].image;
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
        EXPECT_NEAR(direct.pixels[i] + indirect.pixels[i], picture.image.pixels[i],
                    1e-5f * (1 + picture.image.pixels[i]));
    // The middle of the back wall, 4.4 m from the camera; lit and hidden by nothing.
    EXPECT_NEAR(picture.layers[2].image.at(10, 10), 4.4f, 1e-3f);
    EXPECT_NEAR(picture.layers[3].image.at(10, 10, 2), -1, 1e-5f);
    EXPECT_EQ(picture.layers[1].image.rgb(10, 10), glm::vec3(0, 0, 1));
}

TEST(Layers, AnUnknownLayerIsOneErrorThatNamesIt) {
    Scene scene;
    PathTracer tracer;
    ASSERT_TRUE(tracer.update(scene));
    PathOptions options = options_of(4, 1);
    options.aovs = {"velocity"};
    const auto picture = tracer.render(scene, Camera{}, options);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().text().find("'velocity'"), std::string::npos);
}

// -- what light passes

double lux_behind(const Material& material, const Light& light = point_light(100)) {
    Scene scene;
    add_shape(scene, Quad{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}}, material);
    add_light(scene, light, {0, 2, 0});
    // Something opaque beside it, so that both kinds of instance are there.
    add_shape(scene, Box{{5, 0, 5}, {6, 1, 6}}, lambert(0));
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    return measure(scene, 32768, 1)[0].value;
}

TEST(Translucency, ABlendedSurfaceLetsThroughWhatItsOpacityLeaves) {
    Material veil = lambert(0, 0, true);
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = .3f;
    EXPECT_NEAR(lux_behind(veil), .7 * 100 / 4, .04);  // 1 mm of sensor offset on 2 m
    // A lamp with an extent is met by scattered rays too: both estimators agree.
    EXPECT_NEAR(lux_behind(veil, point_light(100, .2f)), .7 * 100 / 4, .08);
    veil.alpha_mode = AlphaMode::mask;
    veil.alpha_cutoff = .5f;
    EXPECT_NEAR(lux_behind(veil), 25, .05);
    veil.alpha_cutoff = .2f;
    EXPECT_EQ(lux_behind(veil), 0);
}

TEST(OneSidedSurfaces, BlockLightFromBothSides) {
    EXPECT_EQ(lux_behind(lambert(.5f)), 0);  // its front faces down
    Scene scene;
    add_shape(scene, Quad{{-1, 1, -1}, {0, 0, 2}, {2, 0, 0}}, lambert(.5f, 10));  // its front faces up
    add_light(scene, point_light(100), {0, 2, 0});
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    add_sensor(scene, SensorType::luminance, {0, 0, 0}, {0, 1, 0});
    const auto readings = measure(scene, 4096);
    EXPECT_EQ(readings[0].value, 0) << "the back emits nothing and blocks the lamp";
    EXPECT_EQ(readings[1].value, 0) << "the back is black";
}

TEST(Depth, OneScatteringEventIsDirectLightAlone) {
    // A point light over a white floor, and a white wall beside it that lights the floor at the second event.
    Scene scene;
    add_shape(scene, Quad{{-5, 0, -5}, {0, 0, 10}, {10, 0, 0}}, lambert(.5f));
    add_shape(scene, Quad{{-5, 0, -1}, {10, 0, 0}, {0, 5, 0}}, lambert(.9f));
    add_light(scene, point_light(100), {0, 2, 0});
    add_sensor(scene, SensorType::luminance, {0, 1, .5f}, glm::normalize(glm::vec3(0, -1, -.5f)));
    const double direct = .5 / pi * 100 / 4;
    const auto one = measure(scene, 64, 1), all = measure(scene, 1024);
    EXPECT_NEAR(one[0].value, direct, 1e-3 * direct);
    EXPECT_GT(all[0].value, 1.05 * direct);
}

// -- estimators that must agree

TEST(MultipleImportanceSampling, AnImageSkyWithABrightSpotLightsAsItsIntegralSays) {
    // 64 × 32 texels of 1 cd/m² and one of 5000 high up; E of a horizontal sensor is the sum over texels.
    Texture image;
    image.width = 64;
    image.height = 32;
    image.format = TextureFormat::float32;
    image.wrap_v = Wrap::clamp_to_edge;
    image.magnify = image.minify = Filter::nearest;
    std::vector<float> texels(64 * 32 * 4, 1.0f);
    const int row = 5, column = 20;
    for (int c = 0; c < 3; ++c) texels[4 * (row * 64 + column) + c] = 5000;
    image.levels.emplace_back(texels.size() * sizeof(float));
    std::memcpy(image.levels[0].data(), texels.data(), image.levels[0].size());
    Scene scene;
    Sky sky;
    sky.model = SkyModel::image;
    sky.luminance_nits = glm::vec3(2);
    sky.image = scene.add_texture(std::move(image));
    scene.set_sky(sky);
    add_shape(scene, Box{{5, -2, 5}, {6, -1, 6}}, lambert(0));
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    add_lux(scene, {0, 0, 0}, {1, 0, 0});
    const auto readings = measure(scene, 1 << 15, 1);
    const auto cap = [](double a, double b) { return 0.5 * (std::pow(std::sin(b), 2) - std::pow(std::sin(a), 2)); };
    const double spot = 2 * 4999 * (2 * pi / 64) * cap(pi * row / 32, pi * (row + 1) / 32);
    EXPECT_NEAR(readings[0].value, 2 * pi + spot, .005 * (2 * pi + spot));
    EXPECT_NEAR(readings[0].value, 2 * pi + spot, 3 * readings[0].half_width_95);
    // The spot's column lies to the left of −Z, that is at −X: a sensor that faces +X does not see it.
    EXPECT_NEAR(readings[1].value, 2 * pi, .01 * 2 * pi);
}

TEST(MultipleImportanceSampling, AGlossyFloorReflectsASphereLightAsALongRunWithoutLightSamplingSays) {
    // The same emitter as an exact sphere shape and as a point light with a radius: two codes, one answer.
    const auto build = [](bool shape) {
        Scene scene;
        Material glossy;
        glossy.base_color = glm::vec3(.8f);
        glossy.metallic = 1;
        glossy.roughness = .25f;
        add_shape(scene, Quad{{-3, 0, -3}, {0, 0, 6}, {6, 0, 0}}, glossy);
        if (shape)
            add_shape(scene, Sphere{{0, 1, -1}, .3f}, lambert(0, 1000));
        else
            add_light(scene, point_light(static_cast<float>(1000 * pi * .09), .3f), {0, 1, -1});
        add_sensor(scene, SensorType::luminance, {0, 1, 1}, glm::normalize(glm::vec3(0, -1, -1)));
        add_sensor(scene, SensorType::luminance, {0, 1, 1}, glm::normalize(glm::vec3(.5f, -1, -1)));
        return measure(scene, 1 << 15, 1);
    };
    const auto shape = build(true), light = build(false);
    for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(shape[i].value, light[i].value, 3 * std::hypot(shape[i].half_width_95, light[i].half_width_95))
            << i;
    EXPECT_LT(shape[0].half_width_95, .01 * shape[0].value);
}

/// White at u < ½, black beyond.
TextureId half_white(Scene& scene) {
    Texture texture;
    texture.width = 2;
    texture.height = 1;
    texture.magnify = texture.minify = Filter::nearest;
    texture.wrap_u = texture.wrap_v = Wrap::clamp_to_edge;
    texture.levels.push_back({255, 255, 255, 255, 0, 0, 0, 255});
    return scene.add_texture(std::move(texture));
}

TEST(EmissiveTextures, LightAsTheirPictureSaysOnShapesAndMeshesMirroredOrNot) {
    // The half of the quad at u < ½ glows: the same as a quad of half the size, sampled as a shape, as triangles
    // and, with x turned round twice (by the quad and by the instance), mirrored.
    const Quad whole{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}}, half{{-1, 1, -1}, {1, 0, 0}, {0, 0, 2}};
    const auto lux = [](Scene& scene) {
        add_lux(scene, {.8f, 0, .1f}, {0, 1, 0});
        return measure(scene, 1 << 14, 1)[0];
    };
    Scene plain;
    add_shape(plain, half, lambert(0, 50));
    const SensorReading expected = lux(plain);
    for (const char* kind : {"shape", "mesh", "mirrored"}) {
        Scene scene;
        Material material = lambert(0, 50);
        material.emission_texture.texture = half_white(scene);
        if (std::string(kind) == "shape") {
            add_shape(scene, whole, material);
        } else {
            const bool mirrored = std::string(kind) == "mirrored";
            Geometry geometry;
            geometry.mesh = tessellate(mirrored ? Quad{{1, 1, -1}, {0, 0, 2}, {-2, 0, 0}} : whole, 8);
            if (mirrored)
                for (glm::vec2& uv : geometry.mesh.texcoords[0])
                    uv = {1 - uv.y, uv.x};  // u again along the second edge
            geometry.bounds = geometry.mesh.bounds();
            Transform transform;
            if (mirrored) transform.scale.x = -1;
            add_mesh(scene, std::move(geometry), material, transform);
        }
        const SensorReading reading = lux(scene);
        EXPECT_NEAR(reading.value, expected.value,
                    3 * std::hypot(reading.half_width_95, expected.half_width_95) + 2e-4 * expected.value)
            << kind;
        EXPECT_LT(reading.half_width_95, .02 * reading.value) << kind;
    }
}

TEST(EmissiveShapes, KeepTheirLightWhenTheyAreScaledUnevenly) {
    // An ellipsoid has no closed form here: its exact shape is held to its fine tessellation.
    const auto lux = [](bool exact) {
        Scene scene;
        Transform transform;
        transform.scale = {1, .4f, .7f};
        transform.translation = {0, 2, 0};
        const Sphere sphere{{0, 0, 0}, 1};
        if (exact) {
            add_shape(scene, sphere, lambert(0, 50), transform);
        } else {
            Geometry geometry;
            geometry.mesh = tessellate(sphere, 256);
            geometry.bounds = geometry.mesh.bounds();
            add_mesh(scene, std::move(geometry), lambert(0, 50), transform);
        }
        add_lux(scene, {.5f, 0, .3f}, {0, 1, 0});
        return measure(scene, 1 << 15, 1)[0];
    };
    const SensorReading shape = lux(true), mesh = lux(false);
    EXPECT_NEAR(shape.value, mesh.value, 3 * std::hypot(shape.half_width_95, mesh.half_width_95) + 5e-4 * mesh.value);
}

TEST(DirectionalLights, ADiscOfAnyWidthKeepsItsIlluminance) {
    for (const float diameter_deg : {0.0f, 0.53f, 20.0f}) {
        Scene scene;
        Light sun;
        sun.type = LightType::directional;
        sun.intensity = glm::vec3(1000);
        sun.direction = glm::normalize(glm::vec3(1, -1, 0));
        sun.angular_diameter_rad = glm::radians(diameter_deg);
        add_light(scene, sun, {0, 0, 0});
        add_shape(scene, Box{{5, -2, 5}, {6, -1, 6}}, lambert(0));
        add_lux(scene, {0, 0, 0}, glm::normalize(glm::vec3(-1, 1, 0)));
        add_lux(scene, {0, 0, 0}, {0, 1, 0});
        const auto readings = measure(scene, 4096);
        EXPECT_NEAR(readings[0].value, 1000, 1) << diameter_deg;
        EXPECT_NEAR(readings[1].value, 1000 / std::sqrt(2.0), 1) << diameter_deg;
    }
}

// -- self-intersection

TEST(Robustness, SurfacesNeitherShadowThemselvesNorLeakAtAnyScale) {
    for (const float metres : {0.001f, 1.0f, 100.0f}) {
        Scene scene;
        // A closed black box round a lamp, one wall through a coordinate plane, the whole turned and set off.
        Transform transform;
        transform.scale = glm::vec3(metres);
        transform.rotation = rotation_from_euler_deg({10, 20, 30});
        transform.translation = glm::vec3(3, -2, 1) * metres;
        Material material = lambert(.5f);
        material.two_sided = true;
        add_shape(scene, Box{{0, 0, 0}, {1, 1, 1}}, material, transform);
        const glm::vec3 center = glm::vec3(transform.matrix() * glm::vec4(.5f, .5f, .5f, 1));
        add_light(scene, point_light(metres * metres), center);
        // Looked at from outside: nothing must shine through.
        Camera camera = looking(center + glm::vec3(0, 0, 3 * metres), center, 40);
        const Picture outside = render(scene, camera, options_of(48, 16));
        EXPECT_EQ(*std::max_element(outside.image.pixels.begin(), outside.image.pixels.end()), 0) << metres;
        // From inside: every pixel lit, nothing darker than its neighbours' geometry allows.
        camera = looking(center - glm::vec3(.2f, 0, 0) * metres, center, 90);
        const Picture inside = render(scene, camera, options_of(48, 16, 1));
        const auto [low, high] = std::minmax_element(inside.image.pixels.begin(), inside.image.pixels.end());
        // E from 1 m² · cd at the middle of a wall to its corner: 4 to 4/3^1.5 by the cube's geometry, times ρ/π.
        EXPECT_GT(*low, .9 * .5 / pi * .5 / std::pow(.75, 1.5)) << metres;
        EXPECT_LT(*high, 1.01 * .5 / pi * 4) << metres;
    }
}

TEST(Robustness, FloorsThroughTheOriginAreLit) {
    Scene scene;
    add_shape(scene, Quad{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, lambert(.5f));
    add_light(scene, point_light(100), {0, 2, 0});
    const Picture picture = render(scene, looking({0, 1, 0}, {.01f, 0, 0}, 30), options_of(32, 16, 1));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) EXPECT_GT(picture.image.rgb(x, y).g, .9 * .5 / pi * 25) << x << ' ' << y;
}

TEST(Robustness, AnEmptySceneIsBlackAndBadRequestsAreErrors) {
    Scene scene;
    PathTracer tracer;
    EXPECT_FALSE(tracer.render(scene, Camera{}, options_of(4, 1))) << "not updated yet";
    ASSERT_TRUE(tracer.update(scene));
    const auto black = tracer.render(scene, Camera{}, options_of(4, 1));
    ASSERT_TRUE(black);
    EXPECT_EQ(luminance(mean(black->image)), 0);
    EXPECT_FALSE(tracer.render(scene, Camera{}, options_of(0, 1)));
    EXPECT_FALSE(tracer.render(scene, Camera{}, options_of(4, 0)));
    EXPECT_FALSE(tracer.render(scene, looking({1, 1, 1}, {1, 1, 1}), options_of(4, 1)));
    EXPECT_FALSE(tracer.render(scene, looking({NAN, 1, 1}, {1, 1, 1}), options_of(4, 1)));
}

TEST(Robustness, AnIndexOutOfRangeIsOneErrorThatNamesItsGeometryAndCanBeMended) {
    Scene scene;
    Geometry broken = triangle_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    broken.name = "broken";
    broken.mesh.indices[2] = 3;
    const NodeId node = add_mesh(scene, broken, lambert(.5f, 1, true));
    PathTracer tracer;
    const auto refused = tracer.update(scene);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text(), "broken: expected vertex indices below 3, found 3");
    EXPECT_FALSE(tracer.render(scene, looking({.2f, .2f, 2}, {.2f, .2f, 0}), options_of(4, 1)));
    broken.mesh.indices[2] = 2;
    scene.set_geometry(scene.nodes().find(node)->parts[0].geometry, broken);
    ASSERT_TRUE(tracer.update(scene));
    const auto picture = tracer.render(scene, looking({.2f, .2f, 2}, {.2f, .2f, 0}, 5), options_of(4, 1));
    ASSERT_TRUE(picture);
    EXPECT_NEAR(luminance(mean(picture->image)), 1, 1e-5);
}

// -- following the scene

TEST(Updates, FollowMovedChangedAddedAndRemovedThings) {
    Scene scene;
    const NodeId lamp = add_shape(scene, Quad{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}}, lambert(0, 10));
    const NodeId shade = add_shape(scene, Box{{-5, .4f, -5}, {5, .6f, 5}}, lambert(0), {{100, 0, 0}});
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    PathTracer tracer;
    const PathOptions options = options_of(1, 4096, 1);
    const auto lux = [&](const TraceUpdate& expected) {
        const auto update = tracer.update(scene);
        EXPECT_TRUE(update);
        EXPECT_EQ(update->geometries_built, expected.geometries_built);
        EXPECT_EQ(update->instances_updated, expected.instances_updated);
        EXPECT_EQ(update->top_level_built, expected.top_level_built);
        return tracer.measure(scene, options)->front().value;
    };
    const double open = lux({2, 2, true});
    EXPECT_NEAR(open, 10 * pi * .55412642, .01 * open);
    EXPECT_EQ(lux({0, 0, false}), open) << "nothing changed";
    scene.set_transform(shade, {});
    EXPECT_EQ(lux({0, 1, true}), 0) << "the shade moved under the lamp";
    scene.set_visible(shade, false);
    EXPECT_NEAR(lux({0, 1, true}), open, .01 * open);  // the scene's size, and with it the sensor's offset, changed
    const MaterialId bright = scene.nodes().find(lamp)->parts[0].material;
    scene.set_material(bright, lambert(0, 20));
    EXPECT_NEAR(lux({0, 0, false}), 2 * open, .02 * open) << "a material is no geometry";
    scene.set_geometry(scene.nodes().find(lamp)->parts[0].geometry, [] {
        Geometry geometry;
        geometry.shape = Quad{{-1, 1, -1}, {1, 0, 0}, {0, 0, 2}};
        geometry.mesh = tessellate(*geometry.shape, 8);
        geometry.bounds = geometry.mesh.bounds();
        return geometry;
    }());
    EXPECT_NEAR(lux({1, 1, true}), open, .01 * open) << "half the lamp";
    scene.remove(lamp);
    EXPECT_EQ(lux({0, 1, true}), 0);
}

TEST(Updates, FollowAMeshThatMovesIsShownTwiceOrChangesItsMask) {
    Scene scene;
    const NodeId lamp = add_shape(scene, Quad{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}}, lambert(0, 10));
    const NodeId shade = add_mesh(scene, triangle_mesh({{-9, .5f, -9}, {0, .5f, 9}, {9, .5f, -9}}), lambert(0, 0, true));
    const Node node = *scene.nodes().find(shade);
    add_lux(scene, {0, 0, 0}, {0, 1, 0});
    PathTracer tracer;
    const auto lux = [&](int geometries_built, int instances_updated) {
        const auto update = tracer.update(scene);
        EXPECT_TRUE(update);
        EXPECT_EQ(update->geometries_built, geometries_built);
        EXPECT_EQ(update->instances_updated, instances_updated);
        return tracer.measure(scene, options_of(1, 4096, 1))->front().value;
    };
    const double open = 10 * pi * .55412642;
    const auto moved = [](float x) {
        Transform transform;
        transform.translation.x = x;
        return transform;
    };
    EXPECT_EQ(lux(2, 2), 0);
    Material glass = lambert(0, 0, true);
    glass.alpha_mode = AlphaMode::blend;
    glass.opacity = .5f;
    scene.set_material(node.parts[0].material, glass);
    EXPECT_NEAR(lux(0, 1), open / 2, .01 * open) << "half of the light passes";
    Node second = node;
    second.transform = moved(20);
    scene.add_node(second);
    EXPECT_NEAR(lux(1, 2), open / 2, .01 * open) << "shown twice, the mesh has a tree of its own, as what both show";
    scene.set_transform(shade, moved(-20));
    EXPECT_NEAR(lux(0, 1), open, .01 * open);
    scene.set_transform(shade, {});
    EXPECT_NEAR(lux(0, 1), open / 2, .01 * open) << "once it has moved, it may move at no cost";
    scene.remove(shade);
    EXPECT_NEAR(lux(0, 1), open, .01 * open);
    scene.remove(lamp);
    EXPECT_EQ(lux(0, 1), 0);
}

TEST(Updates, MovingOneNodeOfNatusRebuildsNoGeometry) {
    const auto path = shared_path("scenes/natus.heliodon.json");
    if (!path) GTEST_SKIP() << "no shared data";
    Warnings warnings;
    auto scene = load_scene(*path, {}, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    PathTracer tracer;
    const auto first = tracer.update(*scene);
    ASSERT_TRUE(first);
    EXPECT_GE(first->geometries_built, 9);
    const NodeId teapot = scene->find_node("teapot");
    ASSERT_TRUE(teapot);
    Transform transform = scene->nodes().find(teapot)->transform;
    transform.translation.x += .1f;
    ASSERT_TRUE(scene->set_transform(teapot, transform));
    const auto moved = tracer.update(*scene);
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->geometries_built, 0);
    EXPECT_LE(moved->instances_updated, 2);
    EXPECT_TRUE(moved->top_level_built);
}

TEST(SharedScenes, RenderWithoutASingleSampleThatIsNoNumber) {
    for (const char* name : {"scenes/cornell-point.heliodon.json", "scenes/natus.heliodon.json",
                             "scenes/sponza.heliodon.json", "scenes/car.heliodon.json", "models/damaged-helmet.glb"}) {
        const auto path = shared_path(name);
        if (!path) GTEST_SKIP() << "no shared data";
        Warnings warnings;
        auto scene = load_scene(*path, {}, warnings);
        ASSERT_TRUE(scene) << scene.error().text();
        const Camera* camera = nullptr;
        scene->cameras().each([&](CameraId, const Camera& each) { camera = camera ? camera : &each; });
        ASSERT_TRUE(camera) << name;
        PathStatistics statistics;
        const Picture picture = render(*scene, *camera, options_of(64, 4), &statistics);
        EXPECT_EQ(statistics.non_finite_samples, 0u) << name;
        EXPECT_GT(luminance(mean(picture.image)), 0) << name;
        for (const float value : picture.image.pixels) EXPECT_GE(value, 0) << name;
    }
}

}  // namespace
}  // namespace heliodon::tests
