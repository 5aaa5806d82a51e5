#include <fmt/format.h>

#include <algorithm>

#include "json_schema.h"
#include "scene_file_fixture.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

/// Whether the schema can tell the fault too: it cannot compare two values or follow a name.
enum class Schema { refuses, accepts };

struct BadFile {
    std::string name;      ///< of the case
    std::string block;     ///< members beside "heliodon": 1
    std::string expected;  ///< the whole error after "test.json: "
    Schema schema = Schema::refuses;
};

std::ostream& operator<<(std::ostream& stream, const BadFile& file) { return stream << file.block; }

std::string node(const std::string& members) {
    return fmt::format(R"("nodes": [{{{}}}])", members);
}
std::string shape(const std::string& members) {
    return node(fmt::format(R"("shape": {{{}}})", members));
}
std::string light(const std::string& members) {
    return node(fmt::format(R"("light": {{{}}})", members));
}
std::string camera(const std::string& members) {
    return fmt::format(R"("cameras": [{{"name": "c", {}}}])", members);
}
std::string material(const std::string& members) {
    return fmt::format(R"("materials": {{"m": {{{}}}}})", members);
}
std::string channel(const std::string& members) {
    return R"("cameras": [{"name": "c"}], "nodes": [{"name": "n"}, {"name": "l", "light": {"type": "point", "intensity_cd": 1}}],
              "animations": [{"name": "a", "channels": [{)" +
           members + "}]}]";
}

const std::vector<BadFile>& bad_files() {
    static const std::vector<BadFile> cases{
        {"UnknownRootKey", R"("camera": [])",
         "$.camera: unknown key; expected heliodon, convert, render, probes, sky, cameras, sensors, materials, nodes, "
         "animations"},
        {"NodesNotAList", R"("nodes": {})", "$.nodes: expected a list, found an object"},
        {"NodeNotAnObject", R"("nodes": [3])", "$.nodes[0]: expected an object, found 3"},
        {"UnknownNodeKey", node(R"("colour": 1)"),
         "$.nodes[0].colour: unknown key; expected name, translate, rotate_deg, scale, visible, light, shape, mesh, "
         "material, children"},
        {"UnknownKeyOfAChild", node(R"("children": [{}, {"odd key": 1}])"),
         "$.nodes[0].children[1][\"odd key\"]: unknown key; expected name, translate, rotate_deg, scale, visible, "
         "light, shape, mesh, material, children"},
        {"NumberAsString", node(R"("translate": [0, "1", 0])"),
         "$.nodes[0].translate[1]: expected a number, found \"1\""},
        {"ShortVector", node(R"("translate": [0, 1])"),
         "$.nodes[0].translate: expected a list of 3 numbers, found a list of 2"},
        {"ZeroScale", node(R"("scale": 0)"), "$.nodes[0].scale: expected a number other than 0, found 0"},
        {"ZeroScaleOnOneAxis", node(R"("scale": [1, 0, 1])"),
         "$.nodes[0].scale[1]: expected a number other than 0, found 0"},
        {"VisibleNotBoolean", node(R"("visible": 1)"), "$.nodes[0].visible: expected true or false, found 1"},
        {"HugeNumber", node(R"("translate": [1e300, 0, 0])"),
         "$.nodes[0].translate[0]: expected a number that single precision holds, found 1e+300"},
        {"ShapeAndMesh", node(R"("mesh": "m.obj", "shape": {"type": "teapot"})"),
         "$.nodes[0]: expected a shape or a mesh, found both"},
        {"MaterialAlone", R"("materials": {"m": {}}, "nodes": [{"material": "m"}])",
         "$.nodes[0].material: expected a shape or a mesh beside the material, found neither"},
        {"UnknownMaterial", node(R"("mesh": "m.obj", "material": "gold")"),
         "$.nodes[0].material: expected the name of one of the file's materials, found \"gold\"", Schema::accepts},
        {"DuplicateNodeName", R"("nodes": [{"name": "a", "children": [{"name": "a"}]}])",
         "$.nodes[0].children[0].name: expected a name that no other node has, found \"a\" again", Schema::accepts},
        {"EmptyMeshPath", node(R"("mesh": "")"), "$.nodes[0].mesh: expected the path of a file, found \"\""},
        {"MissingModel", node(R"("mesh": "missing.obj")"),
         "$.nodes[0].mesh: /base/missing.obj: expected a model, found no file", Schema::accepts},

        {"ShapeWithoutType", shape(R"("radius": 1)"), "$.nodes[0].shape: expected the key \"type\", found none"},
        {"UnknownShape", shape(R"("type": "cone")"),
         "$.nodes[0].shape.type: expected one of \"quad\", \"disk\", \"box\", \"sphere\", \"teapot\", \"torus_knot\", "
         "found \"cone\""},
        {"KeyOfAnotherShape", shape(R"("type": "sphere", "center": [0,0,0], "radius": 1, "normal": [0,1,0])"),
         "$.nodes[0].shape.normal: unknown key; expected type, center, radius"},
        {"NegativeRadius", shape(R"("type": "sphere", "center": [0,0,0], "radius": -1)"),
         "$.nodes[0].shape.radius: expected a number above 0, found -1"},
        {"RadiusBelowSinglePrecision", shape(R"("type": "sphere", "center": [0,0,0], "radius": 1e-60)"),
         "$.nodes[0].shape.radius: expected a number above 0, found 1e-60", Schema::accepts},
        {"QuadWithoutArea", shape(R"("type": "quad", "origin": [0,0,0], "u": [1,0,0], "v": [2,0,0])"),
         "$.nodes[0].shape: expected u and v that span an area, found 0 m²", Schema::accepts},
        {"DiskWithoutNormal", shape(R"("type": "disk", "center": [0,0,0], "normal": [0,0,0], "radius": 1)"),
         "$.nodes[0].shape.normal: expected a direction, found a vector of length 0"},
        {"FlatBox", shape(R"("type": "box", "min": [0,0,0], "max": [1,0,1])"),
         "$.nodes[0].shape.max: expected a corner above min on every axis, found one that is not", Schema::accepts},
        {"FractionalSubdivisions", shape(R"("type": "teapot", "subdivisions": 2.5)"),
         "$.nodes[0].shape.subdivisions: expected a whole number from 1 to 256, found 2.5"},
        {"TooManySegments", shape(R"("type": "torus_knot", "segments": 1000000000000)"),
         "$.nodes[0].shape.segments: expected a whole number from 8 to 8192, found 1000000000000"},

        {"FluxAsString", light(R"("type": "point", "flux_lm": "bright")"),
         "$.nodes[0].light.flux_lm: expected a number at least 0, found \"bright\""},
        {"NegativeFlux", light(R"("type": "point", "flux_lm": -3)"),
         "$.nodes[0].light.flux_lm: expected a number at least 0, found -3"},
        {"NeitherFluxNorIntensity", light(R"("type": "point")"),
         "$.nodes[0].light: expected either intensity_cd or flux_lm, found neither"},
        {"FluxAndIntensity", light(R"("type": "point", "flux_lm": 1, "intensity_cd": 1)"),
         "$.nodes[0].light: expected either intensity_cd or flux_lm, found both"},
        {"ColorBesideIntensity", light(R"("type": "point", "intensity_cd": 1, "color": [1,1,1])"),
         "$.nodes[0].light.color: expected color beside flux_lm alone, found it with intensity_cd"},
        {"BlackColor", light(R"("type": "spot", "flux_lm": 1, "color": [0,0,0])"),
         "$.nodes[0].light.color: expected a colour that is not black, found a list of 3"},
        {"EmptyCone", light(R"("type": "spot", "flux_lm": 1, "inner_deg": 40, "outer_deg": 30)"),
         "$.nodes[0].light: expected outer_deg at least inner_deg (40), found 30", Schema::accepts},
        {"ConeOfNoAngle", light(R"("type": "spot", "flux_lm": 1, "outer_deg": 0)"),
         "$.nodes[0].light.outer_deg: expected a number above 0 and at most 90, found 0"},
        {"ConeOnAPointLight", light(R"("type": "point", "flux_lm": 1, "inner_deg": 4)"),
         "$.nodes[0].light.inner_deg: unknown key; expected type, distribution, intensity_cd, flux_lm, color, "
         "radius_m"},
        {"NegativeLightRadius", light(R"("type": "point", "flux_lm": 1, "radius_m": -1)"),
         "$.nodes[0].light.radius_m: expected a number at least 0, found -1"},
        {"DirectionalWithoutIlluminance", light(R"("type": "directional")"),
         "$.nodes[0].light: expected the key \"illuminance_lux\", found none"},
        {"DirectionOfNoLength", light(R"("type": "directional", "illuminance_lux": 1, "direction": [0,0,0])"),
         "$.nodes[0].light.direction: expected a direction, found a vector of length 0"},
        {"UnknownLightType", light(R"("type": "area")"),
         "$.nodes[0].light.type: expected one of \"point\", \"spot\", \"directional\", \"ies\", found \"area\""},
        {"LuminaireWithoutFile", light(R"("type": "ies", "scale": 1)"), "$.nodes[0].light: expected the key \"file\", found none"},
        {"MissingPhotometricFile", light(R"("type": "ies", "file": "missing.ies")"),
         "$.nodes[0].light.file: /base/missing.ies: expected a photometric file, found none", Schema::accepts},
        {"LampSetZero", light(R"("type": "ies", "file": "a.ldt", "lamp_set": 0)"),
         "$.nodes[0].light.lamp_set: expected a whole number from 1 to 1000, found 0"},
        {"BlackLuminaire", light(R"("type": "ies", "file": "a.ies", "color": [0,0,0])"),
         "$.nodes[0].light.color: expected a colour that is not black, found a list of 3"},
        {"RadiusOfALuminaire", light(R"("type": "ies", "file": "a.ies", "radius_m": 1)"),
         "$.nodes[0].light.radius_m: unknown key; expected type, file, lamp_set, scale, flux_lm, color"},

        {"CameraWithoutName", R"("cameras": [{}])", "$.cameras[0]: expected the key \"name\", found none"},
        {"CameraWithEmptyName", R"("cameras": [{"name": ""}])", "$.cameras[0].name: expected a name, found \"\""},
        {"DuplicateCameraName", R"("cameras": [{"name": "a"}, {"name": "a"}])",
         "$.cameras[1].name: expected a name that no other camera has, found \"a\" again", Schema::accepts},
        {"FieldOfViewTooWide", camera(R"("vertical_fov_deg": 180)"),
         "$.cameras[0].vertical_fov_deg: expected a number above 0 and below 180, found 180"},
        {"CameraAtItsTarget", camera(R"("position": [1,2,3], "target": [1,2,3])"),
         "$.cameras[0]: expected position and target apart, found the same point", Schema::accepts},
        {"UpAlongView", camera(R"("position": [0,9,0], "target": [0,0,0])"),
         "$.cameras[0]: expected an up vector that is not along the view direction or 0, found one", Schema::accepts},
        {"UpOfNoLength", camera(R"("up": [0,0,0])"),
         "$.cameras[0]: expected an up vector that is not along the view direction or 0, found one"},
        {"ClosedAperture", camera(R"("aperture_f": 0)"), "$.cameras[0].aperture_f: expected a number above 0, found 0"},
        {"FarBeforeNear", camera(R"("near_m": 2, "far_m": 1)"),
         "$.cameras[0]: expected far_m beyond near_m (or 0: infinite), found it nearer", Schema::accepts},

        {"UnknownModel", material(R"("model": "phong")"),
         "$.materials.m.model: expected one of \"standard\", \"lambert\", \"unlit\", \"thin\", \"disney\", \"oren_nayar\", "
         "\"conductor\", \"dielectric\", found \"phong\""},
        {"AlbedoAboveOne", material(R"("base_color": [1, 1.01, 1])"),
         "$.materials.m.base_color[1]: expected a number at least 0 and at most 1, found 1.01"},
        {"IorBelowOne", material(R"("ior": 0.9)"), "$.materials.m.ior: expected a number at least 1, found 0.9"},
        {"UnknownMaterialKey", R"("materials": {"mirror metal": {"rough": 1}})",
         "$.materials[\"mirror metal\"].rough: unknown key; expected brdf, model, base_color, metallic, roughness, "
         "ior, transmission, emission_nits, specular, specular_color, clearcoat, clearcoat_roughness, opacity, "
         "alpha_cutoff, two_sided, normal_scale, bump_scale_m, occlusion_strength, base_color_texture, "
         "roughness_texture, metallic_texture, occlusion_texture, normal_texture, bump_texture, emission_texture, "
         "opacity_texture, transmittance, reflectance, subsurface, specular_tint, anisotropic, sheen, sheen_tint, "
         "clearcoat_gloss, metal, eta, k, anisotropy, anisotropy_rotation_deg, sheen_color, sheen_roughness, iridescence, "
         "iridescence_ior, iridescence_thickness_nm, thin_walled, attenuation_color, attenuation_distance_m, sigma_deg, "
         "alpha_mode"},
        {"ConductorOfNoIndex", material(R"("model": "conductor", "eta": 0.2)"),
         "$.materials.m: expected a conductor's metal, or its eta and k"},
        {"ConductorOfTwoIndices", material(R"("model": "conductor", "metal": "gold", "eta": 0.2, "k": 3)"),
         "$.materials.m.metal: expected either metal, or eta and k, found both"},
        {"UnknownMetal", material(R"("model": "conductor", "metal": "mithril")"),
         "$.materials.m.metal: expected one of \"gold\", \"silver\", \"copper\", \"aluminium\", \"iron\", \"chromium\", found \"mithril\""},
        {"MetalOfNoConductor", material(R"("metal": "gold")"), "$.materials.m.metal: expected with the model \"conductor\" alone"},
        {"DisneysSheenElsewhere", material(R"("sheen": 1)"), "$.materials.m.sheen: expected with the model \"disney\" alone"},
        {"SheenColorOfLambert", material(R"("model": "lambert", "sheen_color": [1, 1, 1])"),
         "$.materials.m.sheen_color: expected with the model \"standard\" alone"},
        {"AttenuationOfMetal", material(R"("model": "conductor", "metal": "iron", "attenuation_distance_m": 1)"),
         "$.materials.m.attenuation_distance_m: expected with the model \"standard\" or \"dielectric\" alone"},
        {"AttenuationOverNoDistance", material(R"("attenuation_distance_m": 0)"),
         "$.materials.m.attenuation_distance_m: expected a number above 0, found 0"},
        {"SigmaOfLambert", material(R"("model": "lambert", "sigma_deg": 20)"),
         "$.materials.m.sigma_deg: expected with the model \"oren_nayar\" alone"},
        {"PaneWithoutTransmittance", material(R"("model": "thin")"),
         "$.materials.m: expected the key \"transmittance\", found none"},
        {"TransmittanceOfNoPane", material(R"("transmittance": 0.9)"),
         "$.materials.m.transmittance: expected with the model \"thin\" alone"},
        {"TransmittanceOfTooManyTerms", material(R"("model": "thin", "transmittance": [0, 0, 0, 0, 0, 0, 1])"),
         "$.materials.m.transmittance: expected a number or a list of 1 to 6 numbers, found a list of 7"},
        {"PaneThatMakesLight", material(R"("model": "thin", "transmittance": [0.1, 0.8], "reflectance": 0.2)"),
         "$.materials.m: expected transmittance and reflectance of at most 1 together, found 1.1", Schema::accepts},
        {"MissingTexture", material(R"("base_color_texture": "missing.png")"),
         "$.materials.m: /base/missing.png: expected a picture, found no file", Schema::accepts},
        {"MeasuredBrdfNotYet", material(R"("brdf": "a.binary")"),
         "$.materials.m.brdf: measured BRDFs are not supported yet: expected the standard model's keys, found "
         "\"a.binary\"",
         Schema::accepts},

        {"UnknownSky", R"("sky": {"model": "blue"})",
         "$.sky.model: expected one of \"none\", \"constant\", \"image\", \"preetham\", \"hosek\", \"cie\", found \"blue\""},
        {"DaylightWithoutSun", R"("sky": {"model": "hosek"})",
         "$.sky: expected where the sun stands, on which the light of this model depends: \"sun\" with azimuth_deg and "
         "elevation_deg, or latitude_deg, longitude_deg and time; found neither"},
        {"DaylightOfAPlaceWithoutTime", R"("sky": {"model": "hosek", "latitude_deg": 50, "longitude_deg": 10})",
         "$.sky: expected the key \"time\", found none"},
        {"DaylightOfATimeWithoutPlace", R"("sky": {"model": "hosek", "sun": {"disc": true}, "time": "2026-03-21T09:00:00Z"})",
         "$.sky: expected the key \"latitude_deg\", found none"},
        {"NoSuchDay", R"("sky": {"model": "hosek", "latitude_deg": 50, "longitude_deg": 10, "time": "2026-02-29T09:00:00Z"})",
         "$.sky.time: expected a day of the calendar, found 2026-02-29", Schema::accepts},
        {"LeapSecond", R"("sky": {"time": "2016-12-31T23:59:60Z"})",
         "$.sky.time: expected seconds from 00 to 59, found 60: leap seconds cannot be told apart, give the second before or after", Schema::accepts},
        {"TimeWithoutOffset", R"("sky": {"time": "2026-03-21T09:00:00"})",
         "$.sky.time: expected a time with its offset from UTC as ISO 8601 has it (2026-03-21T09:00:00+01:00 or …Z), found "
         "\"2026-03-21T09:00:00\"",
         Schema::accepts},
        {"SunOfAzimuthAlone", R"("sky": {"model": "hosek", "sun": {"azimuth_deg": 10}})",
         "$.sky.sun: expected the key \"elevation_deg\", found none"},
        {"SunBeyondTheZenith", R"("sky": {"model": "hosek", "sun": {"azimuth_deg": 10, "elevation_deg": 91}})",
         "$.sky.sun.elevation_deg: expected a number at least -90 and at most 90, found 91"},
        {"AirClearerThanNone", R"("sky": {"model": "hosek", "turbidity": 0.9, "sun": {"azimuth_deg": 10, "elevation_deg": 30}})",
         "$.sky.turbidity: expected a number at least 1 and at most 10, found 0.9"},
        {"AirTooClearForPreetham", R"("sky": {"model": "preetham", "turbidity": 1.5, "sun": {"azimuth_deg": 10, "elevation_deg": 30}})",
         "$.sky.turbidity: expected a number at least 2 and at most 10, found 1.5"},
        {"CieTypeBeyondTheStandard", R"("sky": {"model": "cie", "cie_type": 17})",
         "$.sky.cie_type: expected a whole number from 1 to 16, found 17"},
        {"ClearSkyWithoutSun", R"("sky": {"model": "cie", "cie_type": 12})",
         "$.sky: expected where the sun stands, on which the light of cie_type 12 depends: \"sun\" with azimuth_deg and "
         "elevation_deg, or latitude_deg, longitude_deg and time; found neither"},
        {"ClearSkyByNight", R"("sky": {"model": "cie", "cie_type": 12, "latitude_deg": 0, "longitude_deg": 0, "time": "2026-03-21T00:00:00Z"})",
         "$.sky: expected a time by day with a cie sky, found the sun at an elevation of -88.17°", Schema::accepts},
        {"SunBelowTheHorizon", R"("sky": {"model": "cie", "sun": {"azimuth_deg": 0, "elevation_deg": -1}})",
         "$.sky.sun.elevation_deg: expected a number at least 0 and at most 90, found -1"},
        {"DiscOfTheSunNotYet", R"("sky": {"model": "cie", "sun": {"azimuth_deg": 0, "elevation_deg": 30, "disc": true}})",
         "$.sky.sun.disc: suns with a disc in a CIE sky are not supported yet: expected false (a directional light gives the "
         "sun's own light), found true",
         Schema::accepts},
        {"SunWithoutDaylight", R"("sky": {"model": "constant", "luminance_nits": 1, "sun": {"azimuth_deg": 1}})",
         "$.sky.sun: suns in the sky are not supported yet: expected none with this sky model, found an object"},
        {"ConstantSkyWithoutLuminance", R"("sky": {"model": "constant"})",
         "$.sky: expected the key \"luminance_nits\", found none"},
        {"ImageSkyWithoutImage", R"("sky": {"model": "image"})", "$.sky: expected the key \"image\", found none"},
        {"MissingSkyImage", R"("sky": {"model": "image", "image": "missing.hdr"})",
         "$.sky.image: /base/missing.hdr: expected a picture, found no file", Schema::accepts},
        {"LatitudeBeyondThePole", R"("sky": {"latitude_deg": 91})",
         "$.sky.latitude_deg: expected a number at least -90 and at most 90, found 91"},

        {"SensorWithoutNormal", R"("sensors": [{"name": "s", "type": "illuminance", "position": [0,0,0]}])",
         "$.sensors[0]: expected the key \"normal\", found none"},
        {"SensorWithTheOthersKey",
         R"("sensors": [{"name": "s", "type": "luminance", "position": [0,0,0], "direction": [0,0,1], "normal": [0,1,0]}])",
         "$.sensors[0].normal: unknown key; expected name, type, position, direction, offset_m"},
        {"GridWithoutArea",
         R"("sensors": [{"name": "s", "type": "grid", "origin": [0,0,0], "u": [1,0,0], "v": [2,0,0], "counts": [2, 2]}])",
         "$.sensors[0]: expected u and v that span an area, found parallel ones or 0", Schema::accepts},
        {"GridOfThreeCounts",
         R"("sensors": [{"name": "s", "type": "grid", "origin": [0,0,0], "u": [1,0,0], "v": [0,0,1], "counts": [2, 2, 2]}])",
         "$.sensors[0].counts: expected a list of 2 whole numbers, found a list of 3"},
        {"DuplicateSensorName",
         R"("sensors": [{"name": "s", "type": "luminance", "position": [0,0,0], "direction": [0,0,1]}, {"name": "s", "type": "luminance", "position": [0,0,0], "direction": [0,0,1]}])",
         "$.sensors[1].name: expected a name that no other sensor has, found \"s\" again", Schema::accepts},
        {"ProbesWithoutCounts", R"("probes": {"min": [0,0,0], "max": [1,1,1]})",
         "$.probes: expected the key \"counts\", found none"},
        {"ProbesInsideOut", R"("probes": {"min": [0,0,0], "max": [-1,1,1], "counts": [1,1,1]})",
         "$.probes.max: expected a corner not below min, found a list of 3", Schema::accepts},
        {"UnknownGi", R"("render": {"gi": "magic"})",
         "$.render.gi: expected one of \"none\", \"vct\", \"probes\", \"lightmaps\", found \"magic\""},
        {"VoxelsNoPowerOfTwo", R"("render": {"voxels": 100})",
         "$.render.voxels: expected a power of two from 32 to 512, found 100"},
        {"TooFewVoxels", R"("render": {"voxels": 16})",
         "$.render.voxels: expected a power of two from 32 to 512, found 16"},
        {"TooManyVoxels", R"("render": {"voxels": 1024})",
         "$.render.voxels: expected a power of two from 32 to 512, found 1024"},
        {"VoxelsNegative", R"("render": {"voxels": -128})",
         "$.render.voxels: expected a power of two from 32 to 512, found -128"},
        {"VoxelsAsString", R"("render": {"voxels": "128"})",
         "$.render.voxels: expected a power of two from 32 to 512, found \"128\""},
        {"NoCascade", R"("render": {"cascades": 0})",
         "$.render.cascades: expected a whole number from 1 to 8, found 0"},
        {"NoBounce", R"("render": {"bounces": 0})", "$.render.bounces: expected a whole number from 1 to 64, found 0"},
        {"HalfABounce", R"("render": {"bounces": 1.5})",
         "$.render.bounces: expected a whole number from 1 to 64, found 1.5"},
        {"BouncesInWords", R"("render": {"bounces": "many"})",
         "$.render.bounces: expected \"inf\" or a whole number from 1 to 64, found \"many\""},
        {"UnknownRevoxelize", R"("render": {"revoxelize": "never"})",
         "$.render.revoxelize: expected one of \"once\", \"changed\", \"always\", found \"never\""},
        {"UnknownVoxelizer", R"("render": {"voxelizer": "hardware"})",
         "$.render.voxelizer: expected one of \"automatic\", \"raster\", \"compute\", found \"hardware\""},
        {"UnknownRasterizer", R"("render": {"rasterizer": "raster"})",
         "$.render.rasterizer: expected one of \"automatic\", \"hardware\", \"compute\", found \"raster\""},
        {"UnknownSunShadows", R"("render": {"sun_shadows": "rays"})",
         "$.render.sun_shadows: expected one of \"cascades\", \"volumes\", found \"rays\""},
        {"NineShadowCascades", R"("render": {"shadow_cascades": {"count": 9}})",
         "$.render.shadow_cascades.count: expected a whole number from 1 to 8, found 9"},
        {"ShadowCascadesThatOnlyBlend", R"("render": {"shadow_cascades": {"blend": 0.6}})",
         "$.render.shadow_cascades.blend: expected a number at least 0 and at most 0.5, found 0.6"},
        {"UnknownShadowCascadeKey", R"("render": {"shadow_cascades": {"near": 1}})",
         "$.render.shadow_cascades.near: unknown key; expected count, split, blend, distance_m"},
        {"ShadowVolumesOfNothing", R"("render": {"shadow_volumes": {"significant_px": 0}})",
         "$.render.shadow_volumes.significant_px: expected a number at least 0.001 and at most 10000, found 0"},
        {"ConeTracingNotAnObject", R"("render": {"vct": true})", "$.render.vct: expected an object, found true"},
        {"AmbientLight", R"("render": {"ambient": "some"})",
         "$.render.ambient: expected one of \"none\", \"constant\", \"directional\", found \"some\""},
        {"AmbientOcclusion", R"("render": {"ambient_occlusion": 3})",
         "$.render.ambient_occlusion: expected true, false or an object, found 3"},
        {"UnknownEffect", R"("render": {"vct": {"gloss": true}})",
         "$.render.vct.gloss: unknown key; expected diffuse, specular, refraction, shadows, ao, cones, narrow, "
         "caustics, resolution, filtering"},
        {"UnknownResolution", R"("render": {"vct": {"resolution": "eighth"}})",
         "$.render.vct.resolution: expected one of \"full\", \"half\", \"quarter\", found \"eighth\""},
        {"EffectNotBoolean", R"("render": {"vct": {"shadows": 1}})",
         "$.render.vct.shadows: expected true or false, found 1"},
        {"TooFewCones", R"("render": {"vct": {"cones": 8}})",
         "$.render.vct.cones: expected a whole number from 9 to 144, found 8"},
        {"ConesBetween", R"("render": {"vct": {"cones": 20}})",
         "$.render.vct.cones: expected a multiple of 9, found 20"},
        {"UnknownFiltering", R"("render": {"vct": {"filtering": "none"}})",
         "$.render.vct.filtering: expected one of \"anisotropic\", \"isotropic\", found \"none\""},
        {"UnknownTonemap", R"("render": {"tonemap": "film"})", R"($.render.tonemap: expected one of "linear", "hable", "reinhard", "aces", "aces-narkowicz", "agx", "neutral", found "film")"},
        {"WhiteOfAFixedCurve", R"("render": {"tonemap": {"curve": "agx", "white": 4}})",
         R"($.render.tonemap.white: expected with the curve "hable" or "reinhard": the others' white is fixed)"},
        {"WhiteThatIsNone", R"("render": {"tonemap": {"curve": "hable", "white": 0}})", "$.render.tonemap.white: expected a number above 0, found 0"},
        {"WhiteByAnotherName", R"("render": {"tonemap": {"curve": "hable", "white": "paper"}})",
         R"($.render.tonemap.white: expected a number above 0 or "auto", found "paper")"},
        {"PercentilesTheWrongWayRound", R"("render": {"exposure": {"percentiles": [90, 10]}})",
         "$.render.exposure.percentiles: expected a lower percentage before a higher one, found a list of 2", Schema::accepts},
        {"TwoWhites", R"("render": {"white_balance": {"temperature_k": 5000, "chromaticity": [0.3, 0.3]}})",
         R"($.render.white_balance: expected either "temperature_k" or "chromaticity")"},
        {"WhiteBeyondAnyLamp", R"("render": {"white_balance": {"temperature_k": 100}})",
         "$.render.white_balance.temperature_k: expected a number at least 1000 and at most 25000, found 100"},
        {"ChromaticityOfNoColour", R"("render": {"white_balance": {"chromaticity": [0.8, 0.8]}})",
         "$.render.white_balance.chromaticity: expected x and y that add up to 1 at most, found a list of 2", Schema::accepts},
        {"TooFewSegments", R"("convert": {"shape_segments": 2})",
         "$.convert.shape_segments: expected a whole number from 3 to 1024, found 2"},
        {"UnknownPrecision", R"("convert": {"vertex_precision": "half"})",
         "$.convert.vertex_precision: expected one of \"full\", \"compact\", found \"half\""},

        {"UnknownTarget", channel(R"("target": "nodes.n.colour", "times_s": [0], "values": [0])"),
         "$.animations[0].channels[0].target: expected nodes.NAME.…, cameras.NAME.…, materials.NAME.…, "
         "sky.luminance_nits or sky.time with an animated value, found \"nodes.n.colour\""},
        {"TimeOfASkyNowhere", channel(R"("target": "sky.time", "times_s": [0], "values": ["2026-03-21T09:00Z"])"),
         "$.animations[0].channels[0].target: expected a sky with latitude_deg and longitude_deg where its time moves, found "
         "\"sky.time\"",
         Schema::accepts},
        {"TargetOfNobody", channel(R"("target": "nodes.x.scale", "times_s": [0], "values": [1])"),
         "$.animations[0].channels[0].target: expected the name of something in the scene that has this value, found "
         "\"nodes.x.scale\"",
         Schema::accepts},
        {"LightTargetOfADarkNode", channel(R"("target": "nodes.n.light.radius_m", "times_s": [0], "values": [1])"),
         "$.animations[0].channels[0].target: expected the name of something in the scene that has this value, found "
         "\"nodes.n.light.radius_m\"",
         Schema::accepts},
        {"ConeTargetOfAPointLight", channel(R"("target": "nodes.l.light.inner_deg", "times_s": [0], "values": [1])"),
         "$.animations[0].channels[0].target: expected a value that the light's type has, found "
         "\"nodes.l.light.inner_deg\"",
         Schema::accepts},
        {"TimesNotIncreasing", channel(R"("target": "nodes.n.scale", "times_s": [0, 1, 1], "values": [1, 1, 1])"),
         "$.animations[0].channels[0].times_s[2]: expected a time after 1 s, found 1", Schema::accepts},
        {"NoTimes", channel(R"("target": "nodes.n.scale", "times_s": [], "values": [])"),
         "$.animations[0].channels[0].times_s: expected a list of at least 1 time, found a list of 0"},
        {"TooFewValues", channel(R"("target": "nodes.n.scale", "times_s": [0, 1], "values": [1])"),
         "$.animations[0].channels[0].values: expected a list of 2, found a list of 1", Schema::accepts},
        {"TooFewCubicValues",
         channel(R"("target": "cameras.c.ev100", "interpolation": "cubic", "times_s": [0], "values": [1])"),
         "$.animations[0].channels[0].values: expected a list of 3, found a list of 1", Schema::accepts},
        {"CubicEulerAngles",
         channel(
             R"("target": "nodes.n.rotate_deg", "interpolation": "cubic", "times_s": [0], "values": [[0,0,0],[0,0,0],[0,0,0]])"),
         "$.animations[0].channels[0].interpolation: expected one of \"step\", \"linear\", found \"cubic\"",
         Schema::accepts},
        {"LinearVisibility",
         channel(R"("target": "nodes.n.visible", "interpolation": "linear", "times_s": [0], "values": [true])"),
         "$.animations[0].channels[0].interpolation: expected \"step\", found \"linear\"", Schema::accepts},
        {"AnimatedOutOfRange", channel(R"("target": "cameras.c.vertical_fov_deg", "times_s": [0], "values": [200])"),
         "$.animations[0].channels[0].values[0]: expected a number above 0 and below 180, found 200", Schema::accepts},
        {"DuplicateAnimationName", R"("animations": [{"name": "a", "channels": []}, {"name": "a", "channels": []}])",
         "$.animations[1].name: expected a name that no other animation has, found \"a\" again", Schema::accepts},
    };
    return cases;
}

json schema() {
    return json::parse(file_text(std::filesystem::path(HELIODON_SOURCE_DIR) / "docs" / "scene.schema.json"));
}

class BadSceneFile : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadSceneFile, IsRefusedAtTheFault) {
    const std::string text = fmt::format(R"({{"heliodon": 1, {}}})", GetParam().block);
    EXPECT_EQ(error_of(text), "test.json: " + GetParam().expected);
}

TEST_P(BadSceneFile, IsRefusedByTheSchemaWhereItCanTell) {
    const json document = json::parse(fmt::format(R"({{"heliodon": 1, {}}})", GetParam().block));
    const auto violation = schema_violation(schema(), document);
    EXPECT_EQ(violation.has_value(), GetParam().schema == Schema::refuses) << violation.value_or("accepted");
}

INSTANTIATE_TEST_SUITE_P(Faults, BadSceneFile, ::testing::ValuesIn(bad_files()),
                         [](const auto& instance) { return instance.param.name; });

TEST(SceneFile, RefusesOtherVersionsAndOtherDocuments) {
    EXPECT_EQ(error_of("{}"), "test.json: $: expected the key \"heliodon\", found none");
    EXPECT_EQ(error_of(R"({"heliodon": 2})"), "test.json: $.heliodon: expected a whole number from 1 to 1, found 2");
    EXPECT_EQ(error_of("[]"), "test.json: $: expected an object, found a list of 0");
    for (const char* text : {"{}", R"({"heliodon": 2})", "[]"})
        EXPECT_TRUE(schema_violation(schema(), json::parse(text)));
}

TEST(SceneFile, LocatesSyntaxErrorsByLineAndColumn) {
    EXPECT_EQ(error_of("{\"heliodon\": 1,\n  \"nodes\": [}\n").substr(0, 16), "test.json:2:13: ");
    EXPECT_EQ(error_of("").substr(0, 15), "test.json:1:1: ");
    EXPECT_EQ(error_of("{\"heliodon\": 1").substr(0, 16), "test.json:1:14: ");
    EXPECT_EQ(error_of("{\"heliodon\": NaN}").substr(0, 16), "test.json:1:14: ") << error_of("{\"heliodon\": NaN}");
    EXPECT_EQ(error_of("{\"heliodon\": 1} x").substr(0, 16), "test.json:1:17: ");
}

TEST(SceneFile, RefusesNumbersBeyondDoublePrecision) {
    const std::string error = error_of("{\"heliodon\": 1,\n\"nodes\": [{\"scale\": 1e999}]}");
    EXPECT_EQ(error.substr(0, 12), "test.json:2:") << error;
    EXPECT_NE(error.find("1e999"), std::string::npos) << error;
}

TEST(SceneFile, RefusesAKeyGivenTwice) {
    EXPECT_EQ(error_of(R"({"heliodon": 1, "materials": {"white": {}, "white": {}}})"),
              "test.json: $.materials: expected each key once, found \"white\" twice");
    EXPECT_EQ(error_of(R"({"heliodon": 1, "nodes": [{}, {"light": {"type": 1, "type": 2}}]})"),
              "test.json: $.nodes[1].light: expected each key once, found \"type\" twice");
}

TEST(SceneFile, RefusesAThousandLevelsOfNesting) {
    std::string lists, nodes = R"({"heliodon": 1, "nodes": [)", ends;
    for (int i = 0; i < 100'000; ++i) lists += '[';
    for (int i = 0; i < 1000; ++i) {
        nodes += R"({"children": [)";
        ends += "]}";
    }
    EXPECT_EQ(error_of(lists), "test.json: expected at most 256 levels of nesting, found more");
    EXPECT_EQ(error_of(nodes + ends + "]}"), "test.json: expected at most 256 levels of nesting, found more");
}

TEST(SceneFile, RefusesBinaryData) {
    std::string bytes;
    for (int i = 0; i < 4096; ++i) bytes += static_cast<char>((i * 193 + 7) & 0xff);
    EXPECT_EQ(error_of(bytes).substr(0, 10), "test.json:");
    EXPECT_EQ(error_of(std::string("{\"heliodon\": 1, \"nodes\": [{\"name\": \"\xff\xfe\"}]}")).substr(0, 12),
              "test.json:1:");
}

TEST(SceneFile, WithoutReadersRefusesTheFilesThatNeedThem) {
    Warnings warnings;
    for (const char* block : {R"("nodes": [{"mesh": "a.obj"}])", R"("sky": {"model": "image", "image": "a.hdr"})",
                              R"("materials": {"m": {"normal_texture": "n.png"}})"}) {
        const auto scene =
            parse_scene(fmt::format(R"({{"heliodon": 1, {}}})", block), "test.json", "", {}, {}, warnings);
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().text().substr(0, 13), "test.json: $.") << scene.error().text();
    }
}

std::vector<std::filesystem::path> scene_files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> result;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().string().ends_with(".heliodon.json")) result.push_back(entry.path());
    std::sort(result.begin(), result.end());
    return result;
}

TEST(SceneSchema, AcceptsEverySharedScene) {
    const auto folder = shared_path("scenes");
    if (!folder) GTEST_SKIP() << "no shared data";
    const std::vector<std::filesystem::path> files = scene_files_in(*folder);
    EXPECT_FALSE(files.empty());
    for (const auto& file : files) {
        const auto violation = schema_violation(schema(), json::parse(file_text(file)));
        EXPECT_FALSE(violation) << file << ": " << *violation;
    }
}

TEST(SceneSchema, AcceptsTheScenesOfTheProgram) {
    const auto folder = std::filesystem::path(HELIODON_SOURCE_DIR) / "assets";
    const std::vector<std::filesystem::path> files = scene_files_in(folder);
    EXPECT_FALSE(files.empty());
    for (const auto& file : files) {
        const auto violation = schema_violation(schema(), json::parse(file_text(file)));
        EXPECT_FALSE(violation) << file << ": " << *violation;
        const std::string error = error_of(file_text(file));
        EXPECT_EQ(error, "no error") << file;
    }
}

TEST(SceneFile, ReadsEverySharedScene) {
    const auto folder = shared_path("scenes");
    if (!folder) GTEST_SKIP() << "no shared data";
    for (const auto& file : scene_files_in(*folder)) EXPECT_EQ(error_of(file_text(file)), "no error") << file;
}

}  // namespace
}  // namespace heliodon::tests
