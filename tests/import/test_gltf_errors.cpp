#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "core/image_io.h"
#include "import/glb_builder.h"
#include "import/picture_files.h"
#include "shared_data.h"

namespace heliodon {
namespace {

using tests::GlbBuilder;
using tests::Json;

struct Damage {
    const char* name;
    std::function<void(GlbBuilder&)> apply;
    const char* where;    ///< stands in the error
    const char* message;  ///< stands in the error too
};

class DamagedGltf : public testing::TestWithParam<Damage> {};

TEST_P(DamagedGltf, GivesOneLocatedError) {
    GlbBuilder builder;
    builder.add_square({{"material", 0}});
    builder.json["materials"] = Json::array({Json::object()});
    GetParam().apply(builder);
    Scene scene;
    std::string error;
    ASSERT_FALSE(builder.load(scene, &error));
    EXPECT_NE(error.find("model.glb"), std::string::npos) << error;
    EXPECT_NE(error.find(GetParam().where), std::string::npos) << error;
    EXPECT_NE(error.find(GetParam().message), std::string::npos) << error;
    EXPECT_EQ(scene.nodes().size(), 0u);
    EXPECT_EQ(scene.geometries().size(), 0u);
}

constexpr std::uint64_t huge = 0xffffffffffffff00ull;
const float nan = std::nanf(""), infinite = std::numeric_limits<float>::infinity();

const Damage damages[] = {
    {"unknown_required_extension", [](GlbBuilder& b) { b.json["extensionsRequired"] = {"ACME_glitter"}; },
     "$.extensionsRequired", "ACME_glitter"},
    {"version_1", [](GlbBuilder& b) { b.json["asset"]["version"] = "1.0"; }, "$.asset.version", "expected glTF 2"},
    {"no_asset", [](GlbBuilder& b) { b.json.erase("asset"); }, "$.asset.version", "expected"},
    {"meshes_not_a_list", [](GlbBuilder& b) { b.json["meshes"] = 3; }, "$.meshes", "expected a list"},
    {"cycle",
     [](GlbBuilder& b) {
         b.json["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}};
     },
     "$.nodes[2].children[0]", "two parents"},
    {"own_ancestor",
     [](GlbBuilder& b) {
         b.json["nodes"] = {Json::object(), {{"children", {2}}}, {{"children", {1}}}};
     },
     "$.nodes[", "cycle"},
    {"own_child",
     [](GlbBuilder& b) {
         b.json["nodes"] = {{{"children", {0}}}};
     },
     "$.nodes[0]", "cycle"},
    {"node_mesh", [](GlbBuilder& b) { b.json["nodes"][0]["mesh"] = 7; }, "$.nodes[0].mesh", "out of range"},
    {"negative_mesh", [](GlbBuilder& b) { b.json["nodes"][0]["mesh"] = -1; }, "$.nodes[0].mesh", "whole number"},
    {"scene_node", [](GlbBuilder& b) { b.json["scenes"][0]["nodes"] = {9}; }, "$.scenes[0].nodes", "does not exist"},
    {"default_scene", [](GlbBuilder& b) { b.json["scene"] = 5; }, "$.scene", "out of range"},
    {"short_matrix",
     [](GlbBuilder& b) {
         b.json["nodes"][0]["matrix"] = {1, 2};
     },
     "$.nodes[0].matrix", "16 numbers"},
    {"zero_quaternion",
     [](GlbBuilder& b) {
         b.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "$.nodes[0].rotation", "quaternion"},
    {"overflowing_translation",
     [](GlbBuilder& b) {
         b.json["nodes"][0]["translation"] = {1e300, 0, 0};
     },
     "$.nodes[0]", "finite"},
    {"primitive_material", [](GlbBuilder& b) { b.json["meshes"][0]["primitives"][0]["material"] = 4; },
     "$.meshes[0].primitives[0].material", "out of range"},
    {"primitive_accessor", [](GlbBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 44; },
     "$.meshes[0].primitives[0].attributes.POSITION", "out of range"},
    {"no_position", [](GlbBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION"); },
     "$.meshes[0].primitives[0].attributes", "POSITION"},
    {"mode", [](GlbBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 9; }, "$.meshes[0].primitives[0].mode",
     "0 to 6"},
    {"index_out_of_range",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["indices"] = b.add_accessor<std::uint16_t>({0, 1, 4}, "SCALAR");
     },
     "$.meshes[0].primitives[0].indices", "index 4 at 2 is out of range"},
    {"partial_triangle",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["indices"] = b.add_accessor<std::uint8_t>({0, 1, 2, 3}, "SCALAR");
     },
     "$.meshes[0].primitives[0].indices", "whole triangles"},
    {"float_indices",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["indices"] = b.add_accessor<float>({0, 1, 2}, "SCALAR");
     },
     "$.meshes[0].primitives[0].indices", "unsigned"},
    {"nan_position",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
             b.add_accessor<float>({0, 0, 0, 1, nan, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
     },
     "$.meshes[0].primitives[0].attributes.POSITION", "element 1"},
    {"infinite_normal",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
             b.add_accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, infinite}, "VEC3");
     },
     "$.meshes[0].primitives[0].attributes.NORMAL", "element 3"},
    {"unequal_counts",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = b.add_accessor<float>({0, 0, 1}, "VEC3");
     },
     "$.meshes[0].primitives[0].attributes.NORMAL", "has 1 elements, POSITION has 4"},
    {"position_width", [](GlbBuilder& b) { b.json["accessors"][0]["type"] = "VEC2"; }, "attributes.POSITION",
     "3 to 3 components"},
    {"accessor_too_long", [](GlbBuilder& b) { b.json["accessors"][0]["count"] = 5; }, "$.accessors[0]", "do not fit"},
    {"accessor_overflows", [](GlbBuilder& b) { b.json["accessors"][0]["count"] = huge; }, "$.accessors[0].count",
     "2^31"},
    {"accessor_offset_overflows", [](GlbBuilder& b) { b.json["accessors"][0]["byteOffset"] = huge; }, "$.accessors[0]",
     "do not fit"},
    {"accessor_empty", [](GlbBuilder& b) { b.json["accessors"][0]["count"] = 0; }, "$.accessors[0].count", "found 0"},
    {"accessor_type", [](GlbBuilder& b) { b.json["accessors"][0]["type"] = "VEC9"; }, "$.accessors[0].type", "SCALAR"},
    {"component_type", [](GlbBuilder& b) { b.json["accessors"][0]["componentType"] = 5124; },
     "$.accessors[0].componentType", "5124"},
    {"view_too_long", [](GlbBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 1 << 20; }, "$.bufferViews[0]",
     "outside"},
    {"view_overflows", [](GlbBuilder& b) { b.json["bufferViews"][1]["byteLength"] = huge; }, "$.bufferViews[1]",
     "outside"},
    {"view_buffer", [](GlbBuilder& b) { b.json["bufferViews"][0]["buffer"] = 3; }, "$.bufferViews[0].buffer",
     "out of range"},
    {"view_stride_below_element", [](GlbBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 4; }, "$.accessors[0]",
     "overlap"},
    {"buffer_longer_than_chunk",
     [](GlbBuilder& b) {
         b.json["buffers"] = {{{"byteLength", 1 << 20}}};
     },
     "$.buffers[0].byteLength", "are there"},
    {"missing_buffer_file",
     [](GlbBuilder& b) {
         b.json["buffers"] = {{{"byteLength", 4}, {"uri", "nowhere.bin"}}};
     },
     "$.buffers[0].uri", "nowhere.bin"},
    {"bad_base64",
     [](GlbBuilder& b) {
         b.json["buffers"] = {{{"byteLength", 4}, {"uri", "data:application/octet-stream;base64,A*"}}};
     },
     "$.buffers[0].uri", "base64"},
    {"texture_source",
     [](GlbBuilder& b) {
         b.json["textures"] = {{{"source", 2}}};
     },
     "$.textures[0].source", "out of range"},
    {"material_texture",
     [](GlbBuilder& b) {
         b.json["materials"][0]["normalTexture"] = {{"index", 3}};
     },
     "$.materials[0].normalTexture.index", "out of range"},
    {"extension_texture",
     [](GlbBuilder& b) {
         b.json["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"] = {{"index", 3}};
     },
     "$.materials[0].extensions.KHR_materials_clearcoat.clearcoatTexture.index", "out of range"},
    {"alpha_mode", [](GlbBuilder& b) { b.json["materials"][0]["alphaMode"] = "FOG"; }, "$.materials[0].alphaMode",
     "FOG"},
    {"damaged_picture",
     [](GlbBuilder& b) {
         b.json["images"] = {{{"bufferView", b.add_view("this is no picture")}, {"mimeType", "image/png"}}};
         b.json["textures"] = {{{"source", 0}}};
         b.json["materials"][0]["normalTexture"] = {{"index", 0}};
     },
     "$.images[0]", "expected a picture"},
    {"truncated_picture",
     [](GlbBuilder& b) {
         b.json["images"] = {
             {{"bufferView", b.add_view(tests::png(8, 8, 3, std::vector<std::uint8_t>(192, 5)).substr(0, 60))},
              {"mimeType", "image/png"}}};
         b.json["textures"] = {{{"source", 0}}};
         b.json["materials"][0]["normalTexture"] = {{"index", 0}};
     },
     "$.images[0]", "damaged"},
    {"sparse_index",
     [](GlbBuilder& b) {
         const auto indices = b.add_view(GlbBuilder::bytes_of<std::uint16_t>({99})),
                    values = b.add_view(GlbBuilder::bytes_of<float>({1, 2, 3}));
         b.json["accessors"][0]["sparse"] = {{"count", 1},
                                             {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                             {"values", {{"bufferView", values}}}};
     },
     "attributes.POSITION", "sparse index 99"},
    {"sparse_too_long",
     [](GlbBuilder& b) {
         const auto view = b.add_view(GlbBuilder::bytes_of<std::uint16_t>({0}));
         b.json["accessors"][0]["sparse"] = {{"count", 2},
                                             {"indices", {{"bufferView", view}, {"componentType", 5123}}},
                                             {"values", {{"bufferView", view}}}};
     },
     "$.accessors[0].sparse.indices", "do not fit"},
    {"draco_garbage",
     [](GlbBuilder& b) {
         b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
             {"bufferView", b.add_view("DRACO but not really")}, {"attributes", {{"POSITION", 0}}}};
     },
     "$.meshes[0].primitives[0].extensions.KHR_draco_mesh_compression", "draco cannot decode"},
    {"meshopt_garbage",
     [](GlbBuilder& b) {
         b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
             {"buffer", 0},      {"byteOffset", 0}, {"byteLength", 16},
             {"byteStride", 12}, {"count", 4},      {"mode", "ATTRIBUTES"}};
     },
     "$.bufferViews[0].extensions.EXT_meshopt_compression", "cannot decode"},
    {"meshopt_bomb",
     [](GlbBuilder& b) {
         b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
             {"buffer", 0}, {"byteLength", 16}, {"byteStride", 256}, {"count", 1u << 31}, {"mode", "ATTRIBUTES"}};
     },
     "$.bufferViews[0].extensions.EXT_meshopt_compression", "cannot come from"},
    {"meshopt_count_of_gigabytes",
     [](GlbBuilder& b) {
         b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
             {"buffer", 0}, {"byteLength", 48}, {"byteStride", 256}, {"count", 16384}, {"mode", "ATTRIBUTES"}};
     },
     "$.bufferViews[0].extensions.EXT_meshopt_compression", "cannot come from"},
    {"gigabytes_of_zeros",
     [](GlbBuilder& b) {
         b.json["accessors"].push_back({{"componentType", 5126}, {"count", 1u << 30}, {"type", "VEC3"}});
         b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = b.json["accessors"].size() - 1;
     },
     "$.meshes[0].primitives[0].attributes.POSITION", "expected a bufferView"},
    {"gigabytes_of_zero_indices",
     [](GlbBuilder& b) {
         b.json["accessors"].push_back({{"componentType", 5125}, {"count", 1u << 30}, {"type", "SCALAR"}});
         b.json["meshes"][0]["primitives"][0]["indices"] = b.json["accessors"].size() - 1;
     },
     "$.accessors[", "expected a bufferView"},
    {"animation_sampler",
     [](GlbBuilder& b) {
         b.json["animations"] = {{{"samplers", Json::array()},
                                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
     },
     "$.animations[0].channels[0].sampler", "does not exist"},
    {"animation_times",
     [](GlbBuilder& b) {
         const auto times = b.add_accessor<float>({1, 0}, "SCALAR"),
                    values = b.add_accessor<float>({0, 0, 0, 0, 0, 0}, "VEC3");
         b.json["animations"] = {{{"samplers", {{{"input", times}, {"output", values}}}},
                                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
     },
     "$.animations[0].samplers[0].input", "increasing"},
    {"animation_count",
     [](GlbBuilder& b) {
         const auto times = b.add_accessor<float>({0, 1}, "SCALAR"), values = b.add_accessor<float>({0, 0, 0}, "VEC3");
         b.json["animations"] = {{{"samplers", {{{"input", times}, {"output", values}}}},
                                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
     },
     "$.animations[0].samplers[0]", "expected 2 values"},
    {"light_index",
     [](GlbBuilder& b) {
         b.json["nodes"][0]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
     },
     "$.nodes[0].extensions.KHR_lights_punctual.light", "out of range"},
    {"light_type",
     [](GlbBuilder& b) {
         b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "laser"}}};
     },
     "$.extensions.KHR_lights_punctual.lights[0].type", "laser"},
    {"negative_light",
     [](GlbBuilder& b) {
         b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", -5}}};
     },
     "$.extensions.KHR_lights_punctual.lights[0].intensity", "from 0 on"},
    {"overflowing_emission",
     [](GlbBuilder& b) {
         b.json["materials"][0]["emissiveFactor"] = {1e300, 0, 0};
     },
     "$.materials[0]", "single precision"},
    {"spot_cone",
     [](GlbBuilder& b) {
         b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
             {{"type", "spot"}, {"spot", {{"innerConeAngle", 1}, {"outerConeAngle", 0.5}}}}};
     },
     "$.extensions.KHR_lights_punctual.lights[0].spot", "inner < outer"},
    {"camera_angle",
     [](GlbBuilder& b) {
         b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 0.1}}}}};
     },
     "$.cameras[0].perspective.yfov", "between 0 and π"},
};

INSTANTIATE_TEST_SUITE_P(Import, DamagedGltf, testing::ValuesIn(damages),
                         [](const auto& info) { return info.param.name; });

std::string error_of(std::string_view name, std::string_view bytes) {
    const tests::TemporaryFolder folder;
    Scene scene;
    Warnings warnings;
    const auto root = import_model(scene, {}, folder.write(name, bytes), warnings);
    if (!root) EXPECT_EQ(scene.nodes().size(), 0u);
    return root ? "" : root.error().text();
}

TEST(GltfErrors, SyntaxErrorsNameLineAndColumn) {
    EXPECT_NE(error_of("a.gltf", "{\n  \"asset\": {,\n}").find("a.gltf:2:13"), std::string::npos)
        << error_of("a.gltf", "{\n  \"asset\": {,\n}");
    EXPECT_NE(error_of("a.gltf", "").find("a.gltf:1:1"), std::string::npos);
    EXPECT_NE(error_of("a.gltf", "[]").find("expected an object"), std::string::npos);
}

TEST(GltfErrors, DeepJsonIsRefused) {
    EXPECT_NE(error_of("a.gltf", "{\"extras\":" + std::string(100000, '[')).find("nests deeper"), std::string::npos);
}

TEST(GltfErrors, BrokenContainersAreRefused) {
    GlbBuilder builder;
    builder.add_square();
    const std::string file = builder.glb();
    EXPECT_NE(error_of("a.glb", "").find("no \"glTF\""), std::string::npos);
    EXPECT_NE(error_of("a.glb", "PK\3\4 something else").find("no \"glTF\""), std::string::npos);
    EXPECT_NE(error_of("a.glb", file.substr(0, 16)).find("cut off"), std::string::npos);
    EXPECT_NE(error_of("a.glb", file.substr(0, file.size() - 1)).find("cut off"), std::string::npos);
    std::string version = file;
    version[4] = 1;
    EXPECT_NE(error_of("a.glb", version).find("version 2"), std::string::npos);
}

TEST(GltfErrors, UnknownEndingsAndMissingFilesAreRefused) {
    EXPECT_NE(error_of("a.xyz", "hello").find(".obj, .gltf, .glb, .ies or .ldt"), std::string::npos);
    Scene scene;
    Warnings warnings;
    const auto root = import_model(scene, {}, "/nowhere/at/all.glb", warnings);
    ASSERT_FALSE(root);
    EXPECT_NE(root.error().text().find("/nowhere/at/all.glb"), std::string::npos);
}

/// Loads many damaged copies; every one loads or gives a located error, and none takes the process down.
void sweep(const std::string& name, const std::string& bytes, int copies,
           const std::function<std::string(std::mt19937&)>& damage) {
    std::mt19937 random(12345);
    for (int i = 0; i < copies; ++i) {
        const std::string error = error_of(name, damage(random));
        if (!error.empty()) EXPECT_NE(error.find(name), std::string::npos) << error;
    }
    EXPECT_EQ(error_of(name, bytes), "") << "the whole file loads";
}

TEST(GltfErrors, TruncatedAndCorruptedModelsNeverCrash) {
    for (const char* model : {"models/suzanne.glb", "models/lucy.glb"}) {
        const auto path = tests::shared_path(model);
        if (!path) GTEST_SKIP() << "no shared data";
        const std::string bytes = *read_file(*path);
        sweep("cut.glb", bytes, 60, [&](std::mt19937& random) { return bytes.substr(0, random() % bytes.size()); });
        sweep("flipped.glb", bytes, 60, [&](std::mt19937& random) {
            std::string copy = bytes;
            for (int k = 0; k < 8; ++k) copy[random() % copy.size()] = char(random());
            return copy;
        });
        sweep("head.glb", bytes, 200, [&](std::mt19937& random) {  // the JSON, where most of the meaning is
            std::string copy = bytes;
            for (int k = 0; k < 2; ++k) copy[12 + random() % 1200] = char(32 + random() % 95);
            return copy;
        });
    }
}

TEST(GltfErrors, CorruptedTexturedModelsNeverCrash) {
    for (const char* model : {"models/sponza.glb", "models/damaged-helmet.glb"}) {
        const auto path = tests::shared_path(model);
        if (!path) GTEST_SKIP() << "no shared data";
        const std::string bytes = *read_file(*path);
        std::mt19937 random(7);
        for (int i = 0; i < 4; ++i) {
            std::string copy = bytes;
            for (int k = 0; k < 400; ++k) copy[copy.size() / 4 + random() % (copy.size() * 3 / 4)] = char(random());
            const std::string error = error_of("flipped.glb", copy);
            if (!error.empty()) EXPECT_NE(error.find("flipped.glb"), std::string::npos) << error;
        }
    }
}

}  // namespace
}  // namespace heliodon
