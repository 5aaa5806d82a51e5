#include "scene/sensor_reading.h"
#include "scene_file_fixture.h"

#include <fmt/format.h>

#include <cmath>

namespace heliodon::tests {
namespace {

const Node& node_of(const Scene& scene, std::string_view name) {
    const Node* node = scene.nodes().find(scene.find_node(name));
    if (!node) throw std::runtime_error("no node " + std::string(name));
    return *node;
}

const Material& material_of(const Scene& scene, std::string_view name) {
    const Material* material = scene.materials().find(scene.find_material(name));
    if (!material) throw std::runtime_error("no material " + std::string(name));
    return *material;
}

const Material* material_of_part(const Scene& scene, std::string_view node) {
    return scene.materials().find(node_of(scene, node).parts.at(0).material);
}

TEST(SceneFile, NeedsItsVersionAlone) {
    const Scene scene = parsed(R"({"heliodon": 1})");
    EXPECT_EQ(scene.nodes().size(), 0u);
    EXPECT_EQ(scene.sky().model, SkyModel::none);
}

TEST(SceneFile, ReadsCameras) {
    const Scene scene = parsed(R"({"heliodon": 1, "cameras": [{"name": "main", "position": [1,2,3], "target": [0,1,0],
        "up": [0,0,1], "vertical_fov_deg": 40, "near_m": 0.1, "far_m": 100, "aperture_f": 4, "shutter_s": 0.5, "iso": 200},
        {"name": "metered", "ev100": 9.5}, {"name": "default"}]})");
    const Camera& main = *scene.cameras().find(scene.find_camera("main"));
    EXPECT_EQ(main.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(main.target, glm::vec3(0, 1, 0));
    EXPECT_EQ(main.up, glm::vec3(0, 0, 1));
    EXPECT_FLOAT_EQ(main.vertical_fov_rad, glm::radians(40.0f));
    EXPECT_EQ(main.near_m, 0.1f);
    EXPECT_EQ(main.far_m, 100.0f);
    EXPECT_FLOAT_EQ(main.ev100(), std::log2(16.0f / 0.5f / 2.0f));
    EXPECT_EQ(scene.cameras().find(scene.find_camera("metered"))->ev100(), 9.5f);
    EXPECT_NEAR(glm::degrees(scene.cameras().find(scene.find_camera("default"))->vertical_fov_rad), 40, 1e-4);
}

TEST(SceneFile, ReadsEveryMaterialKey) {
    const Scene scene = parsed(R"({"heliodon": 1, "materials": {
        "full": {"model": "standard", "base_color": [0.1,0.2,0.3], "metallic": 0.4, "roughness": 0.5, "ior": 1.6,
                 "transmission": 0.7, "emission_nits": [8,9,10], "specular": 0.11, "specular_color": [1.2,1.3,1.4],
                 "clearcoat": 0.15, "clearcoat_roughness": 0.16, "opacity": 0.17, "alpha_mode": "mask",
                 "alpha_cutoff": 0.18, "two_sided": true, "normal_scale": -1.9, "bump_scale_m": 0.02,
                 "occlusion_strength": 0.21},
        "wall": {"model": "lambert"}, "sign": {"model": "unlit", "emission_nits": 200},
        "veil": {"opacity": 0.5}, "leaf": {"opacity_texture": "leaf.png"}, "solid": {"opacity": 0.5, "alpha_mode": "opaque"}}})");
    const Material& full = material_of(scene, "full");
    EXPECT_EQ(full.model, MaterialModel::standard);
    EXPECT_EQ(full.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(full.metallic, 0.4f);
    EXPECT_EQ(full.roughness, 0.5f);
    EXPECT_EQ(full.ior, 1.6f);
    EXPECT_EQ(full.transmission, 0.7f);
    EXPECT_EQ(full.emission_nits, glm::vec3(8, 9, 10));
    EXPECT_EQ(full.specular, 0.11f);
    EXPECT_EQ(full.specular_color, glm::vec3(1.2f, 1.3f, 1.4f));
    EXPECT_EQ(full.clearcoat, 0.15f);
    EXPECT_EQ(full.clearcoat_roughness, 0.16f);
    EXPECT_EQ(full.opacity, 0.17f);
    EXPECT_EQ(full.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(full.alpha_cutoff, 0.18f);
    EXPECT_TRUE(full.two_sided);
    EXPECT_EQ(full.normal_scale, -1.9f);
    EXPECT_EQ(full.bump_scale_m, 0.02f);
    EXPECT_EQ(full.occlusion_strength, 0.21f);
    EXPECT_EQ(material_of(scene, "wall").model, MaterialModel::lambert);
    EXPECT_EQ(material_of(scene, "wall").alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(material_of(scene, "sign").model, MaterialModel::unlit);
    EXPECT_EQ(material_of(scene, "sign").emission_nits, glm::vec3(200));
    EXPECT_EQ(material_of(scene, "veil").alpha_mode, AlphaMode::blend);
    EXPECT_EQ(material_of(scene, "leaf").alpha_mode, AlphaMode::blend);
    EXPECT_EQ(material_of(scene, "solid").alpha_mode, AlphaMode::opaque);
}

TEST(SceneFile, HandsTexturePathsToTheReaderRelativeToTheFile) {
    SceneFileReaders readers = stub_readers();
    MaterialTextures seen;
    readers.material_textures = [&](Scene&, Material& material, const MaterialTextures& files,
                                    Warnings&) -> Result<void> {
        seen = files;
        material.two_sided = true;
        return {};
    };
    Warnings warnings;
    const auto scene =
        parse_scene(R"({"heliodon": 1, "materials": {"m": {"base_color_texture": "b.png", "roughness_texture": "r.png",
        "metallic_texture": "m.png", "occlusion_texture": "o.png", "normal_texture": "sub/n.png", "bump_texture": "/abs/bump.png",
        "emission_texture": "e.png", "opacity_texture": "a.png"}, "plain": {}}})",
                    "test.json", "/base", {}, readers, warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(seen.base_color, "/base/b.png");
    EXPECT_EQ(seen.roughness, "/base/r.png");
    EXPECT_EQ(seen.metallic, "/base/m.png");
    EXPECT_EQ(seen.occlusion, "/base/o.png");
    EXPECT_EQ(seen.normal, "/base/sub/n.png");
    EXPECT_EQ(seen.bump, "/abs/bump.png");
    EXPECT_EQ(seen.emission, "/base/e.png");
    EXPECT_EQ(seen.opacity, "/base/a.png");
    EXPECT_TRUE(material_of(*scene, "m").two_sided) << "what the reader changes in the material is kept";
    EXPECT_FALSE(material_of(*scene, "plain").two_sided) << "a material without textures is not handed out";
}

TEST(SceneFile, ReadsExactShapes) {
    const Scene scene = parsed(R"({"heliodon": 1, "materials": {"white": {}}, "nodes": [
        {"name": "quad", "shape": {"type": "quad", "origin": [-1,0,-1], "u": [0,0,2], "v": [2,0,0]}, "material": "white"},
        {"name": "disk", "shape": {"type": "disk", "center": [0,1,0], "normal": [0,0,5], "radius": 2}},
        {"name": "box", "shape": {"type": "box", "min": [0,0,0], "max": [1,2,3]}},
        {"name": "sphere", "shape": {"type": "sphere", "center": [0,0.5,0], "radius": 0.5}}]})");
    const auto geometry = [&](std::string_view name) -> const Geometry& {
        return *scene.geometries().find(node_of(scene, name).parts.at(0).geometry);
    };
    EXPECT_EQ(std::get<Quad>(*geometry("quad").shape).v, glm::vec3(2, 0, 0));
    EXPECT_EQ(material_of_part(scene, "quad")->name, "white");
    EXPECT_EQ(std::get<Disk>(*geometry("disk").shape).normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(material_of_part(scene, "disk"), nullptr) << "without a material: the default one";
    EXPECT_EQ(std::get<Box>(*geometry("box").shape).max, glm::vec3(1, 2, 3));
    EXPECT_EQ(std::get<Sphere>(*geometry("sphere").shape).radius, 0.5f);
    EXPECT_EQ(geometry("sphere").bounds.max, glm::vec3(0.5f, 1, 0.5f));
}

TEST(SceneFile, TenThousandEqualShapesShareOneGeometry) {
    std::string nodes;
    for (int i = 0; i < 10'000; ++i)
        nodes += fmt::format(
            R"({}{{"translate": [{}, 0, 0], "shape": {{"type": "sphere", "center": [0,0,0], "radius": 1}}}})",
            i == 0 ? "" : ",", i);
    const Scene scene = parsed(R"({"heliodon": 1, "nodes": [)" + nodes + "]}");
    EXPECT_EQ(scene.nodes().size(), 10'000u);
    EXPECT_EQ(scene.geometries().size(), 1u);
    EXPECT_EQ(scene.bounds().max.x, 10'000.0f);
}

TEST(SceneFile, BuildsProceduralShapes) {
    const Scene scene =
        parsed(R"({"heliodon": 1, "nodes": [{"name": "pot", "shape": {"type": "teapot", "subdivisions": 4}},
        {"name": "knot", "shape": {"type": "torus_knot", "p": 2, "q": 3, "radius": 0.6, "tube_radius": 0.1, "segments": 64}},
        {"name": "plain pot", "shape": {"type": "teapot"}}, {"name": "plain knot", "shape": {"type": "torus_knot"}}]})");
    scene.geometries().each([](GeometryId, const Geometry& geometry) {
        EXPECT_FALSE(geometry.shape);
        EXPECT_GT(geometry.mesh.triangle_count(), 100u);
        EXPECT_FALSE(geometry.bounds.empty());
    });
    EXPECT_EQ(scene.geometries().size(), 4u);
}

TEST(SceneFile, ReadsHierarchyAndTransforms) {
    const Scene scene =
        parsed(R"({"heliodon": 1, "nodes": [{"name": "table", "translate": [1,0,0], "scale": 2, "children": [
        {"name": "cup", "rotate_deg": [10,20,30], "scale": [1,2,3], "visible": false, "children": [{}]}]}]})");
    const Node& table = node_of(scene, "table");
    const Node& cup = node_of(scene, "cup");
    EXPECT_EQ(table.transform.scale, glm::vec3(2));
    EXPECT_EQ(cup.parent(), scene.find_node("table"));
    EXPECT_EQ(cup.transform.rotation, rotation_from_euler_deg({10, 20, 30}));
    EXPECT_EQ(cup.transform.scale, glm::vec3(1, 2, 3));
    EXPECT_FALSE(cup.visible);
    EXPECT_EQ(cup.children().size(), 1u);
    EXPECT_EQ(scene.roots().size(), 1u);
}

TEST(SceneFile, ScalesAndColoursLuminairesByTheirPeak) {
    const Scene scene = parsed(R"({"heliodon": 1, "nodes": [
      {"name": "as measured", "light": {"type": "ies", "file": "a.ies"}},
      {"name": "second set", "light": {"type": "ies", "file": "a.ldt", "lamp_set": 2, "scale": 0.5}},
      {"name": "red", "light": {"type": "ies", "file": "a.ies", "flux_lm": 50, "scale": 2, "color": [2, 0, 0]}}]})");
    const auto light = [&](std::string_view name) { return *scene.nodes().find(scene.find_node(name))->light; };
    EXPECT_EQ(light("as measured").type, LightType::luminaire);
    EXPECT_EQ(light("as measured").luminaire->name, "/base/a.ies");
    EXPECT_EQ(light("as measured").intensity, glm::vec3(100));
    EXPECT_EQ(light("second set").intensity, glm::vec3(100));
    EXPECT_NEAR(flux_lm(light("red")), 100, 1e-3);
    EXPECT_EQ(light("red").intensity.y, 0);
}

TEST(SceneFile, ReadsLightsInPhysicalUnits) {
    const Scene scene = parsed(R"({"heliodon": 1, "nodes": [
        {"name": "rgb", "light": {"type": "point", "intensity_cd": [1,2,3], "radius_m": 0.1}},
        {"name": "white", "light": {"type": "point", "intensity_cd": 50}},
        {"name": "flux", "light": {"type": "point", "flux_lm": 800, "color": [2,1,0.5]}},
        {"name": "lambertian", "light": {"type": "point", "flux_lm": 800, "distribution": "lambertian"}},
        {"name": "spot", "light": {"type": "spot", "flux_lm": 800, "inner_deg": 20, "outer_deg": 30, "radius_m": 0.02}},
        {"name": "sun", "light": {"type": "directional", "illuminance_lux": [1000,900,800], "direction": [0,-2,0],
                                  "angular_diameter_deg": 0.53}},
        {"name": "plain sun", "light": {"type": "directional", "illuminance_lux": 7}}]})");
    const auto light = [&](std::string_view name) { return *node_of(scene, name).light; };
    EXPECT_EQ(light("rgb").intensity, glm::vec3(1, 2, 3));
    EXPECT_EQ(light("rgb").radius_m, 0.1f);
    EXPECT_EQ(light("white").intensity, glm::vec3(50));
    for (const char* name : {"flux", "lambertian", "spot"}) EXPECT_NEAR(flux_lm(light(name)), 800, 1e-3) << name;
    EXPECT_FLOAT_EQ(light("flux").intensity.x, 2 * light("flux").intensity.y);
    EXPECT_TRUE(light("lambertian").lambertian);
    EXPECT_EQ(light("spot").type, LightType::spot);
    EXPECT_FLOAT_EQ(light("spot").inner_rad, glm::radians(20.0f));
    EXPECT_FLOAT_EQ(light("spot").outer_rad, glm::radians(30.0f));
    EXPECT_EQ(light("sun").intensity, glm::vec3(1000, 900, 800));
    EXPECT_EQ(light("sun").direction, glm::vec3(0, -1, 0));
    EXPECT_FLOAT_EQ(light("sun").angular_diameter_rad, glm::radians(0.53f));
    EXPECT_EQ(light("plain sun").intensity, glm::vec3(7));
    EXPECT_EQ(light("plain sun").direction, glm::vec3(0, 0, -1));
}

TEST(SceneFile, ReadsSkies) {
    const Scene constant =
        parsed(R"({"heliodon": 1, "sky": {"model": "constant", "luminance_nits": [1,2,3], "north_deg": 90}})");
    EXPECT_EQ(constant.sky().model, SkyModel::constant);
    EXPECT_EQ(constant.sky().luminance_nits, glm::vec3(1, 2, 3));
    EXPECT_FLOAT_EQ(constant.sky().north_rad, glm::radians(90.0f));
    const Scene image = parsed(R"({"heliodon": 1, "sky": {"model": "image", "image": "env.hdr"}})");
    EXPECT_EQ(image.sky().model, SkyModel::image);
    EXPECT_EQ(image.sky().luminance_nits, glm::vec3(1)) << "an image is taken as it is";
    EXPECT_EQ(image.textures().find(image.sky().image)->name, "/base/env.hdr");
    const Scene none =
        parsed(R"({"heliodon": 1, "sky": {"model": "none", "turbidity": 3, "ground_albedo": 0.2, "cie_type": 1,
        "zenith_luminance_nits": 5000, "latitude_deg": 59.9, "longitude_deg": 10.7, "time": "2026-03-21T09:00:00+01:00"}})");
    EXPECT_EQ(none.sky().model, SkyModel::none) << "what other models use may stand in the file";
}

TEST(SceneFile, ReadsCieSkiesWithTheirSun) {
    const Scene clear = parsed(R"({"heliodon": 1, "sky": {"model": "cie", "cie_type": 12, "zenith_luminance_nits": 3000,
        "ground_albedo": 0.3, "north_deg": 10, "sun": {"azimuth_deg": 180, "elevation_deg": 60, "disc": false}}})");
    EXPECT_EQ(clear.sky().model, SkyModel::cie);
    EXPECT_EQ(clear.sky().cie_type, 12);
    EXPECT_FLOAT_EQ(clear.sky().zenith_luminance_nits, 3000);
    EXPECT_FLOAT_EQ(clear.sky().ground_albedo, 0.3f);
    EXPECT_FLOAT_EQ(clear.sky().sun_azimuth_rad, glm::radians(180.0f));
    EXPECT_FLOAT_EQ(clear.sky().sun_elevation_rad, glm::radians(60.0f));
    EXPECT_EQ(parsed(R"({"heliodon": 1, "sky": {"model": "cie", "cie_type": 16}})").sky().cie_type, Sky::traditional_overcast);
}

TEST(SceneFile, ReadsDaylightWithItsSunByItsPlaceOrByPlaceAndTime) {
    const Sky direct = parsed(R"({"heliodon": 1, "sky": {"model": "preetham", "turbidity": 4, "ground_albedo": 0.3,
        "latitude_deg": 48.8, "longitude_deg": 9.2, "time": "2026-06-21T17:00:00+02:00",
        "sun": {"azimuth_deg": 140, "elevation_deg": -3, "disc": false, "angular_diameter_deg": 1}}})").sky();
    EXPECT_EQ(direct.model, SkyModel::preetham);
    EXPECT_EQ(direct.turbidity, 4);
    EXPECT_FLOAT_EQ(direct.sun_azimuth_rad, glm::radians(140.0f)) << "the sun that is given wins";
    EXPECT_FLOAT_EQ(direct.sun_elevation_rad, glm::radians(-3.0f));
    EXPECT_FLOAT_EQ(direct.sun_angular_diameter_rad, glm::radians(1.0f));
    EXPECT_FALSE(direct.sun_disc);
    const std::string by_time = R"({"heliodon": 1, "sky": {"model": "hosek", "latitude_deg": 59.32938, "longitude_deg": 18.06871,
        "time": "2026-07-06T14:00:00+02:00", "sun": {"disc": true}}})";
    const Sky timed = parsed(by_time).sky();
    EXPECT_EQ(timed.model, SkyModel::hosek);
    EXPECT_NEAR(glm::degrees(timed.sun_azimuth_rad), 205.437817, 0.01) << "JPL Horizons";
    EXPECT_NEAR(glm::degrees(timed.sun_elevation_rad), 51.435969, 0.01);
    EXPECT_TRUE(timed.sun_disc);
    const Sky cie = parsed(R"({"heliodon": 1, "sky": {"model": "cie", "cie_type": 12, "latitude_deg": 59.32938, "longitude_deg": 18.06871,
        "time": "2026-07-06T12:00:00Z"}})").sky();
    EXPECT_EQ(cie.sun_elevation_rad, timed.sun_elevation_rad);
}

TEST(SceneFile, ReadsPanes) {
    const Scene scene = parsed(R"({"heliodon": 1, "materials": {
        "glass": {"model": "thin", "transmittance": [-0.03, 3.2, -3.1, -1.4, 4.0, -1.8], "reflectance": 0.05},
        "film": {"model": "thin", "transmittance": 0.5}}})");
    const Material& glass = *scene.materials().find(scene.find_material("glass"));
    EXPECT_EQ(glass.model, MaterialModel::thin);
    EXPECT_FLOAT_EQ(glass.transmittance[2], -3.1f);
    EXPECT_FLOAT_EQ(glass.transmittance[5], -1.8f);
    EXPECT_FLOAT_EQ(glass.reflectance, 0.05f);
    const Material& film = *scene.materials().find(scene.find_material("film"));
    EXPECT_FLOAT_EQ(film.transmittance[0], 0.5f);
    EXPECT_FLOAT_EQ(film.transmittance[1], 0.0f);
}

TEST(SceneFile, ReadsEveryModelsOwnKeys) {
    const Scene scene = parsed(R"({"heliodon": 1, "materials": {
        "layers": {"anisotropy": 0.1, "anisotropy_rotation_deg": 90, "sheen_color": [0.2,0.3,0.4], "sheen_roughness": 0.5,
                   "iridescence": 0.6, "iridescence_ior": 1.7, "iridescence_thickness_nm": 350, "transmission": 1,
                   "thin_walled": true, "attenuation_color": [0.7,0.8,0.9], "attenuation_distance_m": 0.02},
        "disney": {"model": "disney", "subsurface": 0.1, "specular_tint": 0.2, "anisotropic": 0.3, "sheen": 0.4,
                   "sheen_tint": 0.6, "clearcoat": 0.7, "clearcoat_gloss": 0.8},
        "plaster": {"model": "oren_nayar", "sigma_deg": 20}, "clay": {"model": "oren_nayar"},
        "gold": {"model": "conductor", "metal": "gold"}, "alloy": {"model": "conductor", "eta": [1,2,3], "k": 4},
        "water": {"model": "dielectric", "ior": 1.33}}})");
    const Material& layers = material_of(scene, "layers");
    EXPECT_EQ(layers.anisotropy, 0.1f);
    EXPECT_FLOAT_EQ(layers.anisotropy_rotation_rad, glm::radians(90.0f));
    EXPECT_EQ(layers.sheen_color, glm::vec3(0.2f, 0.3f, 0.4f));
    EXPECT_EQ(layers.sheen_roughness, 0.5f);
    EXPECT_EQ(layers.iridescence, 0.6f);
    EXPECT_EQ(layers.iridescence_ior, 1.7f);
    EXPECT_EQ(layers.iridescence_thickness_nm, 350);
    EXPECT_TRUE(layers.thin_walled);
    EXPECT_EQ(layers.attenuation_color, glm::vec3(0.7f, 0.8f, 0.9f));
    EXPECT_EQ(layers.attenuation_distance_m, 0.02f);
    const Material& disney = material_of(scene, "disney");
    EXPECT_EQ(disney.model, MaterialModel::disney);
    EXPECT_EQ(disney.subsurface, 0.1f);
    EXPECT_EQ(disney.specular_tint, 0.2f);
    EXPECT_EQ(disney.anisotropy, 0.3f);
    EXPECT_EQ(disney.sheen, 0.4f);
    EXPECT_EQ(disney.sheen_tint, 0.6f);
    EXPECT_EQ(disney.clearcoat_gloss, 0.8f);
    EXPECT_EQ(disney.specular, 0.5f) << "Disney's own default";
    EXPECT_EQ(disney.roughness, 0.5f) << "Disney's own default";
    EXPECT_FLOAT_EQ(material_of(scene, "plaster").sigma_rad.value(), glm::radians(20.0f));
    EXPECT_FALSE(material_of(scene, "clay").sigma_rad);
    EXPECT_EQ(material_of(scene, "gold").metal, NamedMetal::gold);
    EXPECT_EQ(material_of(scene, "alloy").conductor_eta, glm::vec3(1, 2, 3));
    EXPECT_EQ(material_of(scene, "alloy").conductor_k, glm::vec3(4));
    EXPECT_EQ(material_of(scene, "water").model, MaterialModel::dielectric);
}

TEST(SceneFile, AGridOfSensorsStandsInTheMiddlesOfItsCellsRowByRow) {
    const Scene scene = parsed(R"({"heliodon": 1, "sensors": [
        {"name": "desk", "type": "grid", "origin": [1,0.8,2], "u": [0,0,4], "v": [2,0,0], "counts": [4,2], "offset_m": 0.01},
        {"name": "eye", "type": "luminance", "position": [0,1,0], "direction": [0,0,-3]}]})");
    const auto points = sensor_points(scene, 0.5f);
    ASSERT_EQ(points.size(), 9u);
    EXPECT_EQ(points[1].name, "desk[1,0]");
    EXPECT_EQ(points[1].position, glm::vec3(1.5f, 0.8f, 3.5f));
    EXPECT_EQ(points[1].direction, glm::vec3(0, 1, 0)) << "u × v";
    EXPECT_FLOAT_EQ(points[1].origin().y, 0.81f);
    EXPECT_EQ(points[7].name, "desk[3,1]");
    EXPECT_EQ(points[8].name, "eye");
    EXPECT_EQ(points[8].origin(), glm::vec3(0, 1, -0.5f)) << "without an offset of its own";
}

TEST(SceneFile, ReadsHowLightIsShown) {
    const auto display = [](const std::string& render) {
        return parsed(R"({"heliodon": 1, "render": )" + render + "}").render_settings().display;
    };
    EXPECT_EQ(display("{}"), DisplaySettings{});
    EXPECT_EQ(display(R"({"tonemap": "aces-narkowicz"})").tone.curve, ToneCurve::aces_narkowicz);
    EXPECT_EQ(display(R"({"tonemap": {"curve": "reinhard", "white": 6}})").tone,
              (ToneSettings{.curve = ToneCurve::reinhard, .white = 6}));
    EXPECT_TRUE(display(R"({"tonemap": {"curve": "reinhard", "white": "auto"}})").tone.estimate_white);
    const ExposureSettings exposure = display(R"({"exposure": {"mode": "auto", "metering": "spot", "mean": "arithmetic",
        "percentiles": [10, 95], "compensation_ev": -1, "to_light_s": 1, "to_dark_s": 2}})").exposure;
    EXPECT_EQ(exposure.mode, ExposureMode::metered);
    EXPECT_EQ(exposure.pattern, MeteringPattern::spot);
    EXPECT_TRUE(exposure.arithmetic_mean);
    EXPECT_FLOAT_EQ(exposure.percentiles.x, 0.1f);
    EXPECT_FLOAT_EQ(exposure.percentiles.y, 0.95f);
    EXPECT_EQ(exposure.compensation_ev, -1);
    EXPECT_EQ(exposure.to_dark_s, 2);
    EXPECT_EQ(display(R"({"white_balance": {"chromaticity": [0.31, 0.33]}})").white_balance, glm::vec2(0.31f, 0.33f));
    EXPECT_NEAR(display(R"({"white_balance": {"temperature_k": 6504}})").white_balance->x, 0.3127f, 1e-4f);
}

TEST(SceneFile, ReadsSensorsAndSettings) {
    const Scene scene = parsed(R"({"heliodon": 1,
        "sensors": [{"name": "desk", "type": "illuminance", "position": [0,0.8,0], "normal": [0,2,0]},
                    {"name": "wall", "type": "luminance", "position": [0,1,3], "direction": [0,0,-1]}],
        "probes": {"min": [-1,0,-1], "max": [1,2,1], "counts": [8,8,8]},
        "convert": {"texture_size_limit": 512, "shape_segments": 12, "vertex_precision": "compact"},
        "render": {"gi": "vct", "voxels": 256, "tonemap": "hable", "shadow_map_size": 1024},
        "nodes": [{"shape": {"type": "disk", "center": [0,0,0], "normal": [0,1,0], "radius": 1}}]})");
    const Sensor& desk = *scene.sensors().at(0);
    const Sensor& wall = *scene.sensors().at(1);
    EXPECT_EQ(desk.type, SensorType::illuminance);
    EXPECT_EQ(desk.direction, glm::vec3(0, 1, 0));
    EXPECT_EQ(wall.type, SensorType::luminance);
    EXPECT_EQ(wall.direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(scene.convert_settings().texture_size_limit, 512);
    EXPECT_EQ(scene.convert_settings().vertex_precision, ConvertSettings::Precision::compact);
    EXPECT_EQ(scene.geometries().at(0)->mesh.triangle_count(), 12u) << "shapes are cut as the convert block says";
    EXPECT_EQ(scene.render_settings().gi, "vct");
    EXPECT_EQ(scene.render_settings().voxels, 256);
    EXPECT_EQ(scene.render_settings().shadow_map_size, 1024);
}

TEST(SceneFile, ReadsLightWithoutGlobalIllumination) {
    const RenderSettings plain = parsed(R"({"heliodon": 1})").render_settings();
    EXPECT_EQ(plain.ambient, AmbientLight::none);
    EXPECT_TRUE(plain.ambient_occlusion.on);
    const RenderSettings off = parsed(R"({"heliodon": 1, "render": {"ambient": "constant", "ambient_occlusion": false}})").render_settings();
    EXPECT_EQ(off.ambient, AmbientLight::constant);
    EXPECT_FALSE(off.ambient_occlusion.on);
    const RenderSettings near = parsed(R"({"heliodon": 1, "render": {"ambient": "directional", "ambient_occlusion":
        {"reach_m": 2, "thickness_m": 0.5}}})").render_settings();
    EXPECT_EQ(near.ambient, AmbientLight::directional);
    EXPECT_EQ(near.ambient_occlusion, (AmbientOcclusionSettings{.on = true, .reach_m = 2, .thickness_m = 0.5f}));
}

TEST(SceneFile, ReadsEverySettingOfVoxelConeTracing) {
    const Scene plain = parsed(R"({"heliodon": 1})");
    EXPECT_EQ(plain.render_settings().vct, ConeTracingSettings{});
    EXPECT_EQ(plain.render_settings().bounces, 0) << "all of them";
    const Scene scene = parsed(R"({"heliodon": 1, "render": {"gi": "vct", "voxels": 512, "cascades": 5, "bounces": 2,
        "revoxelize": "always", "voxelizer": "compute", "rasterizer": "hardware", "vct": {"diffuse": false, "specular": false,
        "refraction": false, "shadows": true, "ao": false, "cones": 36, "narrow": false, "caustics": false, "resolution": "half",
        "filtering": "isotropic"}}})");
    const RenderSettings& render = scene.render_settings();
    EXPECT_EQ(render.voxels, 512);
    EXPECT_EQ(render.cascades, 5);
    EXPECT_EQ(render.bounces, 2);
    EXPECT_EQ(render.revoxelize, Revoxelize::always);
    EXPECT_EQ(render.voxelizer, Voxelizer::compute);
    EXPECT_EQ(render.rasterizer, Rasterizer::hardware);
    EXPECT_EQ(render.vct, (ConeTracingSettings{.diffuse = false,
                                               .specular = false,
                                               .refraction = false,
                                               .shadows = true,
                                               .ao = false,
                                               .cones = 36,
                                               .narrow = false,
                                               .caustics = false,
                                               .resolution = ConeResolution::half,
                                               .filtering = VoxelFiltering::isotropic}));
}

TEST(SceneFile, ReadsHowTheSunCastsItsShadows) {
    EXPECT_EQ(parsed(R"({"heliodon": 1})").render_settings().sun_shadows, SunShadows::cascades);
    const RenderSettings volumes = parsed(R"({"heliodon": 1, "render": {"sun_shadows": "volumes"}})").render_settings();
    EXPECT_EQ(volumes.sun_shadows, SunShadows::volumes);
    EXPECT_EQ(volumes.shadow_cascades, ShadowCascadeSettings{});
    EXPECT_EQ(volumes.shadow_volumes, ShadowVolumeSettings{});
    EXPECT_EQ(parsed(R"({"heliodon": 1, "render": {"shadow_volumes": {"map_size": 256, "significant_px": 2}}})")
                  .render_settings().shadow_volumes,
              (ShadowVolumeSettings{.map_size = 256, .significant_px = 2}));
    for (const float limit : {0.001f, 10000.0f})
        EXPECT_EQ(parsed(fmt::format(R"({{"heliodon": 1, "render": {{"shadow_volumes": {{"significant_px": {}}}}}}})", limit))
                      .render_settings()
                      .shadow_volumes.significant_px,
                  limit);
    const RenderSettings cascades = parsed(R"({"heliodon": 1, "render": {"sun_shadows": "cascades",
        "shadow_cascades": {"count": 8, "split": 1, "blend": 0.25, "distance_m": 100}}})").render_settings();
    EXPECT_EQ(cascades.sun_shadows, SunShadows::cascades);
    EXPECT_EQ(cascades.shadow_cascades, (ShadowCascadeSettings{.count = 8, .split = 1, .blend = 0.25f, .distance_m = 100}));
}

TEST(SceneFile, AMaterialOnAMeshReplacesThoseOfTheModel) {
    const Scene scene = parsed(R"({"heliodon": 1, "materials": {"clay": {}}, "nodes": [
        {"name": "statue", "mesh": "models/statue.obj", "material": "clay", "children": [
            {"name": "plinth", "shape": {"type": "box", "min": [0,0,0], "max": [1,1,1]}}]}]})");
    EXPECT_EQ(material_of_part(scene, "model leaf")->name, "clay");
    EXPECT_EQ(material_of_part(scene, "plinth"), nullptr) << "the node's own children keep theirs";
    EXPECT_EQ(scene.materials().size(), 1u) << "the replaced material is gone";
    EXPECT_EQ(scene.textures().size(), 0u) << "and so are the textures that only it used";
    EXPECT_EQ(node_of(scene, "model root").parent(), scene.find_node("statue"));
}

TEST(SceneFile, AModelNamedTwiceIsReadOnceAndShared) {
    std::vector<std::string> read;
    Warnings warnings;
    auto scene = parse_scene(R"({"heliodon": 1, "materials": {"clay": {}}, "nodes": [
        {"name": "a", "mesh": "m.obj", "material": "clay"}, {"name": "b", "mesh": "x/../m.obj", "translate": [5,0,0]},
        {"name": "c", "mesh": "other.obj"}]})",
                             "test.json", "/base", {}, stub_readers(&read), warnings);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(read, (std::vector<std::string>{"/base/m.obj", "/base/other.obj"}));
    EXPECT_EQ(scene->geometries().size(), 2u);
    EXPECT_EQ(scene->materials().size(), 3u) << "clay, and the model's own for b and c";
    const auto leaf = [&](std::string_view name) {
        const NodeId root = scene->nodes().find(scene->find_node(name))->children()[0];
        return scene->nodes().find(root)->children()[0];
    };
    const auto part = [&](std::string_view name) { return scene->nodes().find(leaf(name))->parts.at(0); };
    EXPECT_EQ(part("a").geometry, part("b").geometry);
    EXPECT_EQ(scene->materials().find(part("a").material)->name, "clay");
    EXPECT_EQ(scene->materials().find(part("b").material)->name, "of the model");
    scene->apply_animations(1);
    EXPECT_EQ(scene->nodes().find(leaf("a"))->transform.translation, glm::vec3(2, 0, 0));
    EXPECT_EQ(scene->nodes().find(leaf("b"))->transform.translation, glm::vec3(2, 0, 0)) << "the copy is animated too";
}

TEST(SceneFile, MakesAMaterialBlendWhoseOpacityIsAnimated) {
    const auto mode = [](const std::string& keys) {
        const Scene scene = parsed(R"({"heliodon": 1, "materials": {"veil": {)" + keys + R"(}},
          "animations": [{"name": "fade", "channels": [
            {"target": "materials.veil.opacity", "times_s": [0, 1], "values": [1, 0]}]}]})");
        return scene.materials().find(scene.find_material("veil"))->alpha_mode;
    };
    EXPECT_EQ(mode(""), AlphaMode::blend);
    EXPECT_EQ(mode(R"("alpha_mode": "mask")"), AlphaMode::mask) << "a mask has its own use for opacity";
}

TEST(SceneFile, ReadsAnimationOfEveryNamedValue) {
    Scene scene = parsed(R"({"heliodon": 1, "cameras": [{"name": "main"}], "materials": {"paint": {}},
      "sky": {"model": "constant", "luminance_nits": 1},
      "nodes": [{"name": "bulb v1.5", "light": {"type": "spot", "intensity_cd": 1}}, {"name": "sun", "light": {"type": "directional", "illuminance_lux": 1}},
                {"mesh": "m.obj"}],
      "animations": [{"name": "all", "channels": [
        {"target": "nodes.bulb v1.5.translate", "times_s": [0, 2], "values": [[0,0,0],[2,4,6]]},
        {"target": "nodes.bulb v1.5.rotate_deg", "times_s": [0, 2], "values": [[0,0,0],[0,90,0]]},
        {"target": "nodes.bulb v1.5.scale", "times_s": [0, 2], "values": [1, [3,3,3]]},
        {"target": "nodes.bulb v1.5.visible", "times_s": [0, 2], "values": [false, true]},
        {"target": "nodes.bulb v1.5.light.intensity_cd", "interpolation": "linear", "times_s": [0, 2], "values": [[0,0,0], 10]},
        {"target": "nodes.bulb v1.5.light.inner_deg", "times_s": [0, 2], "values": [10, 20]},
        {"target": "nodes.bulb v1.5.light.outer_deg", "times_s": [0, 2], "values": [30, 50]},
        {"target": "nodes.bulb v1.5.light.radius_m", "times_s": [0, 2], "values": [0, 1]},
        {"target": "nodes.sun.light.illuminance_lux", "times_s": [0, 2], "values": [0, 8]},
        {"target": "nodes.sun.light.direction", "times_s": [0, 2], "values": [[0,-1,0], [0,-1,0]]},
        {"target": "nodes.model leaf.translate", "times_s": [0, 2], "values": [[0,0,0],[0,0,8]]},
        {"target": "cameras.main.position", "times_s": [0, 2], "values": [[0,0,0],[2,2,2]]},
        {"target": "cameras.main.target", "times_s": [0, 2], "values": [[0,0,0],[4,4,4]]},
        {"target": "cameras.main.vertical_fov_deg", "times_s": [0, 2], "values": [20, 40]},
        {"target": "cameras.main.ev100", "interpolation": "cubic", "times_s": [0, 2], "values": [0, 0, 0, 12, 8, 0]},
        {"target": "materials.paint.base_color", "times_s": [0, 2], "values": [[0,0,0],[1,1,1]]},
        {"target": "materials.paint.opacity", "times_s": [0, 2], "values": [0, 1]},
        {"target": "materials.paint.metallic", "times_s": [0, 2], "values": [0, 1]},
        {"target": "materials.paint.roughness", "interpolation": "step", "times_s": [0, 2], "values": [0, 1]},
        {"target": "materials.paint.emission_nits", "times_s": [0, 2], "values": [0, 100]},
        {"target": "materials.paint.transmission", "times_s": [0, 2], "values": [0, 1]},
        {"target": "materials.paint.ior", "times_s": [0, 2], "values": [1, 2]},
        {"target": "sky.luminance_nits", "times_s": [0, 2], "values": [0, [2,4,6]]}]}]})");
    EXPECT_EQ(scene.animation_duration_s(), 2.0);
    scene.apply_animations(1);
    const Node& bulb = node_of(scene, "bulb v1.5");
    EXPECT_EQ(bulb.transform.translation, glm::vec3(1, 2, 3));
    EXPECT_NEAR(std::abs(glm::dot(bulb.transform.rotation, rotation_from_euler_deg({0, 45, 0}))), 1, 1e-6);
    EXPECT_EQ(bulb.transform.scale, glm::vec3(2));
    EXPECT_FALSE(bulb.visible);
    EXPECT_EQ(bulb.light->intensity, glm::vec3(5));
    EXPECT_FLOAT_EQ(bulb.light->inner_rad, glm::radians(15.0f));
    EXPECT_FLOAT_EQ(bulb.light->outer_rad, glm::radians(40.0f));
    EXPECT_EQ(bulb.light->radius_m, 0.5f);
    EXPECT_EQ(node_of(scene, "sun").light->intensity, glm::vec3(4));
    EXPECT_EQ(node_of(scene, "model leaf").transform.translation, glm::vec3(0, 0, 4))
        << "the file's own comes after the model's";
    const Camera& camera = *scene.cameras().find(scene.find_camera("main"));
    EXPECT_EQ(camera.position, glm::vec3(1));
    EXPECT_EQ(camera.target, glm::vec3(2));
    EXPECT_FLOAT_EQ(camera.vertical_fov_rad, glm::radians(30.0f));
    EXPECT_NEAR(camera.ev100(), 1, 1e-6) << "t³ at 1 s";
    const Material& paint = material_of(scene, "paint");
    EXPECT_EQ(paint.base_color, glm::vec3(0.5f));
    EXPECT_EQ(paint.opacity, 0.5f);
    EXPECT_EQ(paint.metallic, 0.5f);
    EXPECT_EQ(paint.roughness, 0.0f);
    EXPECT_EQ(paint.emission_nits, glm::vec3(50));
    EXPECT_EQ(paint.transmission, 0.5f);
    EXPECT_EQ(paint.ior, 1.5f);
    EXPECT_EQ(scene.sky().luminance_nits, glm::vec3(1, 2, 3));
}

constexpr std::string_view overridable =
    R"({"heliodon": 1, "cameras": [{"name": "main", "position": [0,1,4], "iso": 100}, {"name": "metered", "ev100": 10}],
    "materials": {"red": {"base_color": [1,0,0]}, "red.dark": {}},
    "nodes": [{"name": "room", "children": [{"name": "bulb", "light": {"type": "point", "intensity_cd": [50,50,50]}}]},
              {"name": "ball", "shape": {"type": "sphere", "center": [0,0,0], "radius": 1}, "material": "red"}]})";

TEST(SceneOverride, ReachesElementsByNameAndIndex) {
    const Scene scene = parsed(overridable, {{"cameras.main.iso", "400"},
                                             {"cameras.0.position.1", "7"},
                                             {"materials.red.base_color", "[0, 1, 0]"},
                                             {"materials.red.dark.roughness", "0.25"},
                                             {"nodes.ball.shape.radius", "3"},
                                             {"nodes.1.material", "red.dark"}});
    const Camera& main = *scene.cameras().find(scene.find_camera("main"));
    EXPECT_EQ(main.iso, 400.0f);
    EXPECT_EQ(main.position, glm::vec3(0, 7, 4));
    EXPECT_EQ(material_of(scene, "red").base_color, glm::vec3(0, 1, 0));
    EXPECT_EQ(material_of(scene, "red.dark").roughness, 0.25f) << "names may hold dots";
    EXPECT_EQ(std::get<Sphere>(*scene.geometries().at(0)->shape).radius, 3.0f);
    EXPECT_EQ(material_of_part(scene, "ball")->name, "red.dark") << "a bare string needs no quotes";
}

TEST(SceneOverride, ReachesNodesBelowOthersByTheirName) {
    const Scene scene =
        parsed(overridable, {{"nodes.bulb.translate", "[1,2,3]"}, {"nodes.room.children.0.visible", "false"}});
    EXPECT_EQ(node_of(scene, "bulb").transform.translation, glm::vec3(1, 2, 3));
    EXPECT_FALSE(node_of(scene, "bulb").visible);
}

TEST(SceneOverride, OfTheFluxReplacesTheIntensityAndBack) {
    const Scene flux = parsed(overridable, {{"nodes.bulb.light.flux_lm", "900"}});
    EXPECT_NEAR(flux_lm(*node_of(flux, "bulb").light), 900, 1e-3);
    const Scene intensity = parsed(overridable, {{"nodes.bulb.light.flux_lm", "900"},
                                                 {"nodes.bulb.light.color", "[1,0,0]"},
                                                 {"nodes.bulb.light.intensity_cd", "5"}});
    EXPECT_EQ(node_of(intensity, "bulb").light->intensity, glm::vec3(5));
}

TEST(SceneOverride, OfTheIsoReplacesAFixedExposure) {
    const Scene scene = parsed(overridable, {{"cameras.metered.iso", "200"}});
    EXPECT_FALSE(scene.cameras().find(scene.find_camera("metered"))->ev100_override);
}

TEST(SceneOverride, MakesMembersThatAreMissing) {
    const Scene scene = parsed(overridable, {{"render.voxels", "256"},
                                             {"render.bounces", "inf"},
                                             {"render.vct.shadows", "true"},
                                             {"sky.model", "constant"},
                                             {"sky.luminance_nits", "[1,1,1]"},
                                             {"materials.new.metallic", "1"},
                                             {"nodes.room.light", R"({"type": "point", "intensity_cd": 1})"}});
    EXPECT_EQ(scene.render_settings().voxels, 256);
    EXPECT_EQ(scene.render_settings().bounces, 0);
    EXPECT_TRUE(scene.render_settings().vct.shadows);
    EXPECT_TRUE(scene.render_settings().vct.specular) << "an override of one effect leaves the others";
    EXPECT_EQ(scene.sky().model, SkyModel::constant);
    EXPECT_EQ(material_of(scene, "new").metallic, 1.0f);
    EXPECT_TRUE(node_of(scene, "room").light);
}

TEST(SceneOverride, ErrorsNameTheOverride) {
    const auto error = [](std::string path, std::string value) { return error_of(overridable, {{path, value}}); };
    EXPECT_EQ(error("render.voxel", "2"),
              "--set render.voxel=2: unknown key; expected gi, voxels, cascades, bounces, revoxelize, voxelizer, "
              "rasterizer, integrator, vct, ambient, ambient_occlusion, tonemap, exposure, white_balance, shadow_map_size, sun_shadows, "
              "shadow_cascades, shadow_volumes");
    EXPECT_EQ(error("render.vct.cones", "10"), "--set render.vct.cones=10: expected a multiple of 9, found 10");
    EXPECT_EQ(error("rendr.voxels", "2").substr(0, 33), "--set rendr.voxels=2: unknown key");
    EXPECT_EQ(error("nodes.bulb.light.intensity_cd", "bright"),
              "--set nodes.bulb.light.intensity_cd=bright: expected a number or a list of 3 numbers, found \"bright\"");
    EXPECT_EQ(error("nodes.lamp.visible", "true"),
              "--set nodes.lamp.visible=true: expected the name or index of one of the 2 elements of $.nodes, found "
              "\"lamp\"");
    EXPECT_EQ(
        error("nodes.2.visible", "true"),
        "--set nodes.2.visible=true: expected the name or index of one of the 2 elements of $.nodes, found \"2\"");
    EXPECT_EQ(error("nodes.ball.shape.radius.x", "1"),
              "--set nodes.ball.shape.radius.x=1: expected an object or a list at $.nodes[1].shape.radius, found 1");
    EXPECT_EQ(error("nodes.ball.shape.radius", "-1"),
              "--set nodes.ball.shape.radius=-1: expected a number above 0, found -1");
    EXPECT_EQ(error("nodes.ball.shape.radius", "1e999"),
              "--set nodes.ball.shape.radius=1e999: expected a number above 0, found \"1e999\"");
    EXPECT_EQ(error("nodes.ball.shape.type", "\xff").substr(0, 31), "--set nodes.ball.shape.type=\xff: ") << "not UTF-8";
    EXPECT_EQ(error("cameras.main.position", "[1, up, 3]"),
              "--set cameras.main.position=[1, up, 3]: expected a list of 3 numbers, found \"[1, up, 3]\"");
    EXPECT_EQ(error("cameras.main.position", "[1, true, 3]"),
              "--set cameras.main.position=[1, true, 3]: $.cameras[0].position[1]: expected a number, found true");
    EXPECT_EQ(error("", "1"), "--set =1: expected a dotted path before '=', found none");
    EXPECT_EQ(error("heliodon", "2").substr(0, 19), "--set heliodon=2: e");
    EXPECT_EQ(error_of(overridable, {{"render.voxels", "64"}, {"cameras.main.iso", "0"}}),
              "--set cameras.main.iso=0: expected a number above 0, found 0");
}

TEST(SceneFile, ReadsFromDiskAndTellsWhatItCannotRead) {
    Warnings warnings;
    const auto missing = read_scene_file("/nonexistent/scene.heliodon.json", {}, stub_readers(), warnings);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().text().find("/nonexistent/scene.heliodon.json"), std::string::npos);
    EXPECT_FALSE(read_scene_file(std::filesystem::temp_directory_path(), {}, stub_readers(), warnings))
        << "a directory";
    const auto path = std::filesystem::path(::testing::TempDir()) / "heliodon_scene_file_test.heliodon.json";
    std::ofstream(path) << R"({"heliodon": 1, "nodes": [{"mesh": "m.obj"}]})";
    std::vector<std::string> read;
    EXPECT_TRUE(read_scene_file(path, {}, stub_readers(&read), warnings));
    EXPECT_EQ(read, std::vector<std::string>{(path.parent_path() / "m.obj").generic_string()});
    std::filesystem::remove(path);
}

TEST(SceneFile, OpensNoFileBeforeTheWholeDocumentIsRight) {
    std::vector<std::string> read;
    Warnings warnings;
    const auto scene = parse_scene(R"({"heliodon": 1, "nodes": [{"mesh": "m.obj"}, {"nam": "late slip"}]})",
                                   "test.json", "", {}, stub_readers(&read), warnings);
    EXPECT_FALSE(scene);
    EXPECT_TRUE(read.empty());
}

}  // namespace
}  // namespace heliodon::tests
