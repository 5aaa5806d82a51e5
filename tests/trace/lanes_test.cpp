// Paths followed eight at a time against the same paths followed one by one.
#include <cmath>
#include <cstring>

#include "import/import.h"
#include "picture_means.h"
#include "trace/lanes/lane_paths.h"

namespace heliodon::tests {
namespace {

PathOptions small_picture(bool lanes, int max_depth = 3) {
    PathOptions options = pictures_of(24, 4, Integrator::path, max_depth);
    options.lanes = lanes;
    options.aovs = {"direct"};
    return options;
}

/// The same random numbers give the same paths: but for rounding, and for the few that it sends elsewhere.
void expect_same_paths(const std::string& name, const Scene& scene, const Camera& camera, int max_depth = 3) {
    const Picture one_by_one = render(scene, camera, small_picture(false, max_depth));
    const Picture lanes = render(scene, camera, small_picture(true, max_depth));
    ASSERT_GT(luminance(mean(one_by_one.image)), 0) << name;
    const auto same = [](const Image& a, const Image& b) {
        const double scale = luminance(mean(a));
        int count = 0;
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x) {
                const double value = luminance(a.rgb(x, y)),
                             difference = luminance(glm::abs(a.rgb(x, y) - b.rgb(x, y)));
                count += difference <= 1e-3 * (value + 0.1 * scale) ? 1 : 0;
            }
        return static_cast<double>(count) / (a.width * a.height);
    };
    EXPECT_GE(same(one_by_one.image, lanes.image), 0.98) << name;
    EXPECT_GE(same(one_by_one.layers[0].image, lanes.layers[0].image), 0.98) << name << ", direct";
}

class Lanes : public testing::Test {
protected:
    void SetUp() override {
#ifdef __x86_64__
        if (trace::lanes_available()) return;
        ASSERT_FALSE(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) << "this build has no lanes";
#endif
        GTEST_SKIP() << "needs AVX2";
    }
};

/// A ball and a quad of the material under a lamp, a spot, a small light and a sky.
Scene shown(Scene scene, const Material& material) {
    add_shape(scene, Sphere{{-.4f, .5f, 0}, .5f}, material);
    add_shape(scene, Quad{{.2f, .1f, .3f}, {.7f, 0, -.2f}, {0, .9f, -.3f}}, material);
    add_shape(scene, Quad{{-2, 0, -2}, {0, 0, 4}, {4, 0, 0}}, lambert(.6f));
    add_shape(scene, Quad{{-.5f, 2, -.5f}, {1, 0, 0}, {0, 0, 1}}, lambert(0, 20));
    Light spot = point_light(10);
    spot.type = LightType::spot;
    spot.inner_rad = .3f;
    spot.outer_rad = .6f;
    add_light(scene, spot, {.3f, 2.5f, .2f}, aiming_down());
    add_light(scene, point_light(5, .1f), {1, 1.5f, 1});
    scene.set_sky(even_sky(1));
    return scene;
}

std::vector<Material> every_material() {
    std::vector<Material> all(15);
    for (Material& material : all) {
        material.base_color = {.8f, .5f, .3f};
        material.roughness = .4f;
    }
    all[0].model = MaterialModel::lambert;
    all[1].model = MaterialModel::standard;
    all[2].metallic = 1;
    all[3].metallic = 1, all[3].anisotropy = .7f, all[3].anisotropy_rotation_rad = .5f;
    all[4].clearcoat = 1, all[4].clearcoat_roughness = .2f;
    all[5].sheen_color = {.5f, .6f, .7f}, all[5].sheen_roughness = .5f;
    all[6].iridescence = 1, all[6].metallic = .5f;
    all[7].transmission = 1;
    all[8].transmission = 1, all[8].attenuation_color = {.9f, .5f, .3f}, all[8].attenuation_distance_m = .3f;
    all[9].transmission = .7f, all[9].thin_walled = true, all[9].two_sided = true;
    all[10].model = MaterialModel::disney, all[10].sheen = 1, all[10].subsurface = .5f, all[10].anisotropy = .4f;
    all[11].model = MaterialModel::oren_nayar, all[11].sigma_rad = .4f;
    all[12].model = MaterialModel::conductor, all[12].metal = NamedMetal::copper;
    all[13].model = MaterialModel::thin, all[13].reflectance = .1f, all[13].transmittance = {.8f},
    all[13].two_sided = true;
    all[14].alpha_mode = AlphaMode::blend, all[14].opacity = .5f, all[14].two_sided = true;
    return all;
}

TEST_F(Lanes, FollowTheSamePathsOverEveryMaterial) {
    const Camera camera = looking({0, 1, 3.4f}, {0, .6f, 0});
    const std::vector<Material> materials = every_material();
    for (std::size_t i = 0; i < materials.size(); ++i)
        expect_same_paths("material " + std::to_string(i), shown({}, materials[i]), camera);
}

TEST_F(Lanes, FollowTheSamePathsUnderEverySky) {
    const Camera camera = looking({0, 1, 3.4f}, {0, .6f, 0}, 70);
    for (const SkyModel model : {SkyModel::none, SkyModel::cie, SkyModel::hosek, SkyModel::preetham}) {
        Scene scene = shown({}, lambert(.5f));
        Sky sky;
        sky.model = model;
        sky.sun_elevation_rad = .6f;
        scene.set_sky(sky);
        expect_same_paths("sky " + std::to_string(static_cast<int>(model)), scene, camera);
    }
}

/// Coloured noise of a format, wrapped as told.
TextureId noise(Scene& scene, TextureFormat format, Wrap u, Wrap v, Filter filter) {
    Texture texture{
        .width = 5, .height = 3, .format = format, .wrap_u = u, .wrap_v = v, .magnify = filter, .minify = filter};
    std::vector<std::uint8_t> bytes(15 * texture.bytes_per_texel());
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(97 * i * i + 31 * i);
    std::vector<float> floats(60);
    for (std::size_t i = 0; i < floats.size(); ++i) floats[i] = static_cast<float>(i % 7) / 7;
    if (format == TextureFormat::float32) std::memcpy(bytes.data(), floats.data(), bytes.size());
    texture.levels.push_back(std::move(bytes));
    return scene.add_texture(std::move(texture));
}

TEST_F(Lanes, ReadTexturesOfEveryFormatWrapAndFilterOnMeshes) {
    const Camera camera = looking({0, 0, 3}, {0, 0, 0});
    for (const TextureFormat format : {TextureFormat::srgb8, TextureFormat::linear8, TextureFormat::float32})
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
            for (const Filter filter : {Filter::nearest, Filter::linear}) {
                Scene scene;
                Geometry sheet =
                    triangle_mesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
                for (const glm::vec3& p : sheet.mesh.positions) {
                    sheet.mesh.texcoords[0].push_back(2.7f * glm::vec2(p.x, p.y));
                    sheet.mesh.normals.push_back(glm::normalize(glm::vec3(.3f * p.x, .2f * p.y, 1)));
                    sheet.mesh.tangents.push_back({1, 0, 0, 1});
                    sheet.mesh.colors.push_back({.5f + .4f * p.x, .9f, .7f, 1});
                }
                Material material;
                material.base_color_texture.texture = noise(scene, format, wrap, Wrap::repeat, filter);
                material.orm_texture.texture = noise(scene, TextureFormat::linear8, Wrap::repeat, wrap, filter);
                material.normal_texture.texture = noise(scene, TextureFormat::linear8, wrap, wrap, Filter::linear);
                material.bump_texture.texture = noise(scene, TextureFormat::linear8, wrap, wrap, Filter::linear);
                material.normal_scale = .3f;
                add_mesh(scene, std::move(sheet), material);
                add_light(scene, point_light(10, .2f), {1, 1, 2});
                scene.set_sky(even_sky(1));
                expect_same_paths(std::to_string(static_cast<int>(format)) + " " +
                                      std::to_string(static_cast<int>(wrap)) + " " +
                                      std::to_string(static_cast<int>(filter)),
                                  scene, camera);
            }
}

TEST_F(Lanes, FollowTheSamePathsToManyLights) {
    Warnings warnings;
    for (const char* file : {"/tests/scenes/three-lights.heliodon.json", "/tests/scenes/veach-lights.heliodon.json",
                             "/tests/scenes/lamp-shade.heliodon.json"}) {
        auto scene = load_scene(std::string(HELIODON_SOURCE_DIR) + file, {}, warnings);
        ASSERT_TRUE(scene) << scene.error().text();
        expect_same_paths(file, *scene, *scene->cameras().at(0));
    }
    Scene many = small_room();
    for (int i = 0; i < 100; ++i)
        add_light(many, point_light(.1f),
                  {-.9f + .2f * static_cast<float>(i % 10), 1.7f, -.9f + .2f * static_cast<float>(i / 10)});
    expect_same_paths("a hundred lights", many, into_box());
}

TEST_F(Lanes, FollowTheSamePathsToLuminairesOfEveryOpening) {
    for (const OpeningShape shape :
         {OpeningShape::box, OpeningShape::cylinder_x, OpeningShape::cylinder_y, OpeningShape::ellipsoid}) {
        Luminaire luminaire;
        for (int i = 0; i <= 18; ++i) {
            const double polar = i * pi / 36;
            luminaire.web.polar_rad.push_back(polar);
            luminaire.web.candela.push_back(200 * std::cos(polar));
        }
        luminaire.web.azimuth_rad = {0};
        luminaire.opening = {shape, {.5f, .2f, .3f}};
        integrate(luminaire);
        Light light{.type = LightType::luminaire, .intensity = glm::vec3(static_cast<float>(luminaire.peak_cd))};
        light.luminaire = std::make_shared<const Luminaire>(luminaire);
        Scene scene = box_scene();
        add_light(scene, light, {0, 1.7f, 0});
        expect_same_paths("opening " + std::to_string(static_cast<int>(shape)), scene, into_box(), 2);
    }
}

TEST_F(Lanes, MeanTheSameAsPathsOneByOneWithoutAnEnd) {
    Scene scene = box_scene();
    scene.set_sky(even_sky(1));
    PathOptions options = pictures_of(16, 8, Integrator::path);
    options.lanes = false;
    const PartMeans one_by_one = means_of(scene, into_box(), options);
    options.lanes = true;
    expect_equal_means("a box of glass and metal", one_by_one, means_of(scene, into_box(), options));
}

TEST_F(Lanes, GiveTheSameBitsOnAnyNumberOfThreadsAndInAnyPasses) {
    Scene scene = small_room();
    PathOptions options = pictures_of(40, 5, Integrator::path);
    options.threads = 1;
    const Picture one = render(scene, into_box(), options);
    for (const int threads : {2, 8}) {
        options.threads = threads;
        EXPECT_EQ(render(scene, into_box(), options).image.pixels, one.image.pixels) << threads << " threads";
    }
    options.keep_state = KeepState::always;
    options.samples_per_pixel = 2;
    const Picture begun = render(scene, into_box(), options);
    options.samples_per_pixel = 5;
    options.resume = &begun;
    EXPECT_EQ(render(scene, into_box(), options).image.pixels, one.image.pixels) << "in two passes";
}

}  // namespace
}  // namespace heliodon::tests
