#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>

#include "app/program.h"
#include "core/image_io.h"

namespace heliodon::tests {
namespace {

/// A folder's content that must be refused, the scene to open and what the message must name.
struct BadInput {
    std::string name;
    std::string scene;
    std::function<void(const std::filesystem::path&)> make;
    std::string named;
};
class BadInputs : public ProgramTest, public testing::WithParamInterface<BadInput> {};

void expect_one_located_line(const Ended& ended, const std::string& named) {
    EXPECT_EQ(ended.code, 1) << ended.error;
    EXPECT_EQ(ended.error_lines(), 1) << ended.error;
    EXPECT_EQ(ended.error.rfind("heliodon: ", 0), 0u) << ended.error;
    EXPECT_NE(ended.error.find(named), std::string::npos) << ended.error;
    EXPECT_TRUE(ended.output.empty()) << ended.output;
}

TEST_P(BadInputs, IsOneLocatedLineExitCode1AndNothingWritten) {
    const BadInput& bad = GetParam();
    bad.make(folder());
    const std::vector<std::string> before = files();
    for (const std::string engine : {"path", "realtime"})
        expect_one_located_line(run({"render", bad.scene, "--engine", engine, "--size", "16x16", "--spp", "1", "-o",
                                     "o.exr", "-o", "o.png"}),
                                bad.named);
    expect_one_located_line(run({"info", bad.scene, "--json"}), bad.named);
    EXPECT_EQ(files(), before);
}

auto text_file(std::string name, std::string text) {
    return [=](const std::filesystem::path& folder) { write_text(folder / name, text); };
}

std::string edited(std::string_view from, std::string_view to) {
    std::string text(small_scene);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string scene_with_material(const std::string& material) {
    return edited(R"({ "model": "lambert", "base_color": [0.5, 0.5, 0.5] })", material);
}

std::string scene_with_mesh(const std::string& mesh) {
    return edited(R"("shape": { "type": "quad", "origin": [-2, 0, -2], "u": [0, 0, 4], "v": [4, 0, 0] })",
                  "\"mesh\": \"" + mesh + "\"");
}

/// A glTF with one triangle: nine floats of positions and three 16-bit indices in `t.bin`.
std::string triangle_gltf(const std::string& nodes, int index_count = 3, const std::string& materials = "") {
    return fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{},
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1{}}}]}}],{}
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
                     {{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":6}}],
        "buffers":[{{"uri":"t.bin","byteLength":42}}]}})",
                       nodes, materials.empty() ? "" : ",\"material\":0", materials, index_count);
}

void write_triangle_buffer(const std::filesystem::path& folder, float x, std::uint16_t index) {
    const float positions[9] = {x, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint16_t indices[3] = {0, 1, index};
    std::string bytes(42, '\0');
    std::memcpy(bytes.data(), positions, 36);
    std::memcpy(bytes.data() + 36, indices, 6);
    write_text(folder / "t.bin", bytes);
}

auto gltf(std::string text, float x = 0, std::uint16_t index = 2) {
    return [=](const std::filesystem::path& folder) {
        write_text(folder / "m.gltf", text);
        write_triangle_buffer(folder, x, index);
    };
}

/// A GLB header that announces `announced` bytes, followed by `body`.
std::string glb(std::uint32_t announced, const std::string& body) {
    std::string bytes = "glTF";
    const std::uint32_t words[] = {2, announced};
    bytes.append(reinterpret_cast<const char*>(words), sizeof(words));
    return bytes + body;
}

std::string glb_json_chunk(const std::string& json) {
    const std::uint32_t words[] = {static_cast<std::uint32_t>(json.size()), 0x4E4F534Au};  // length, "JSON"
    return std::string(reinterpret_cast<const char*>(words), sizeof(words)) + json;
}

/// The scene with a textured floor, its PNG cut to `keep` bytes, and with `byte` there flipped when it is asked for.
auto damaged_png(double keep, bool flip) {
    return [=](const std::filesystem::path& folder) {
        write_text(folder / "s.heliodon.json", scene_with_material(R"({ "base_color_texture": "t.png" })"));
        Picture picture;
        picture.image = Image(64, 64, 3);
        for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
            picture.image.pixels[i] = static_cast<float>(i * 2654435761u % 255) / 255.0f;
        ASSERT_TRUE(write_picture(folder / "t.png", picture));
        std::string bytes = read_text(folder / "t.png");
        if (flip) bytes[3] ^= 0x55;  // in the signature
        write_text(folder / "t.png",
                   bytes.substr(0, static_cast<std::size_t>(keep * static_cast<double>(bytes.size()))));
    };
}

void no_files(const std::filesystem::path&) {}

const std::string whole_nodes = R"([{"mesh":0}])";

const BadInput bad_inputs[] = {
    // scene files
    {"SceneMissing", "s.heliodon.json", no_files, "s.heliodon.json"},
    {"SceneIsADirectory", "d.heliodon.json",
     [](const auto& folder) { std::filesystem::create_directory(folder / "d.heliodon.json"); }, "d.heliodon.json"},
    {"SceneEmpty", "s.heliodon.json", text_file("s.heliodon.json", ""), "s.heliodon.json:1"},
    {"SceneTruncated", "s.heliodon.json", text_file("s.heliodon.json", std::string(small_scene.substr(0, 400))),
     "s.heliodon.json:"},
    {"SceneCorrupted", "s.heliodon.json", text_file("s.heliodon.json", "{\"heliodon\": 1, \"nodes\": [\x01\xff\xfe]}"),
     "s.heliodon.json:1"},
    {"SceneUnknownKey", "s.heliodon.json", text_file("s.heliodon.json", edited("\"translate\"", "\"translat\"")),
     "nodes[1].translat"},
    {"SceneWrongType", "s.heliodon.json", text_file("s.heliodon.json", edited("[400, 400, 400]", "\"bright\"")),
     "nodes[1].light.intensity_cd"},
    {"SceneInfiniteNumber", "s.heliodon.json", text_file("s.heliodon.json", edited("[0, 2, 0]", "[0, 1e999, 0]")),
     "s.heliodon.json"},
    {"SceneUnknownMaterial", "s.heliodon.json",
     text_file("s.heliodon.json", edited("\"material\": \"white\"", "\"material\": \"red\"")), "nodes[0].material"},
    {"SceneWithoutCamera", "s.heliodon.json",
     text_file("s.heliodon.json", R"({"heliodon":1,"nodes":[{"name":"a","colour":3}]})"), "nodes[0].colour"},
    {"SceneMeshMissing", "s.heliodon.json", text_file("s.heliodon.json", scene_with_mesh("gone.obj")), "gone.obj"},
    {"SceneMeshUnknownEnding", "s.heliodon.json", text_file("s.heliodon.json", scene_with_mesh("gone.xyz")),
     "gone.xyz"},
    {"TextureMissing", "s.heliodon.json",
     text_file("s.heliodon.json", scene_with_material(R"({ "base_color_texture": "gone.png" })")), "gone.png"},
    {"UnknownEnding", "m.docx", text_file("m.docx", "hello"), "m.docx"},
    // pictures
    {"PngTruncated", "s.heliodon.json", damaged_png(0.5, false), "t.png"},
    {"PngEmpty", "s.heliodon.json", damaged_png(0, false), "t.png"},
    {"PngCorrupted", "s.heliodon.json", damaged_png(1, true), "t.png"},
    // OBJ
    {"ObjTruncated", "m.obj", text_file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1"), "m.obj"},
    {"ObjCorrupted", "m.obj",
     text_file("m.obj", std::string("\x7f"
                                    "ELF\x02\x01\x01\0\0\0v 1 2",
                                    16)),
     "m.obj"},
    {"ObjEmpty", "m.obj", text_file("m.obj", ""), "m.obj"},
    {"ObjIndexOutOfRange", "m.obj", text_file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), "m.obj"},
    {"ObjIndexNegativeOutOfRange", "m.obj", text_file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n"), "m.obj"},
    {"ObjNotANumber", "m.obj", text_file("m.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "m.obj"},
    {"ObjInfinite", "m.obj", text_file("m.obj", "v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "m.obj"},
    // glTF
    {"GlbTruncatedHeader", "m.glb", text_file("m.glb", "glTF\x02"), "m.glb"},
    {"GlbTruncatedBody", "m.glb",
     text_file("m.glb", glb(5000, glb_json_chunk(triangle_gltf(whole_nodes)).substr(0, 200))), "m.glb"},
    {"GlbCorruptedMagic", "m.glb", text_file("m.glb", "gltF" + glb(20, "").substr(4)), "m.glb"},
    {"GlbChunkLongerThanFile", "m.glb", text_file("m.glb", glb(32, std::string("\xff\xff\xff\x7fJSON{}  ", 12))),
     "m.glb"},
    {"GltfTruncated", "m.gltf", text_file("m.gltf", triangle_gltf(whole_nodes).substr(0, 150)), "m.gltf"},
    {"GltfBufferMissing", "m.gltf", text_file("m.gltf", triangle_gltf(whole_nodes)), "m.gltf"},
    {"GltfBufferTruncated", "m.gltf",
     [](const auto& folder) {
         gltf(triangle_gltf(whole_nodes))(folder);
         write_text(folder / "t.bin", "short");
     },
     "m.gltf"},
    {"GltfIndexOutOfRange", "m.gltf", gltf(triangle_gltf(whole_nodes), 0, 3), "m.gltf"},
    {"GltfAccessorOutOfRange", "m.gltf", gltf(triangle_gltf(whole_nodes, 3000)), "m.gltf"},
    {"GltfNotANumber", "m.gltf", gltf(triangle_gltf(whole_nodes), std::numeric_limits<float>::quiet_NaN()), "m.gltf"},
    {"GltfInfinite", "m.gltf", gltf(triangle_gltf(whole_nodes), std::numeric_limits<float>::infinity()), "m.gltf"},
    {"GltfNodeItsOwnChild", "m.gltf", gltf(triangle_gltf(R"([{"mesh":0,"children":[0]}])")), "m.gltf"},
    {"GltfCyclicNodes", "m.gltf",
     gltf(triangle_gltf(R"([{"children":[1]},{"children":[2]},{"mesh":0,"children":[1]}])")), "m.gltf"},
    {"GltfNodeOutOfRange", "m.gltf", gltf(triangle_gltf(R"([{"mesh":0,"children":[7]}])")), "m.gltf"},
    {"GltfMeshOutOfRange", "m.gltf", gltf(triangle_gltf(R"([{"mesh":4}])")), "m.gltf"},
    {"GltfTextureMissing", "m.gltf",
     gltf(triangle_gltf(whole_nodes, 3,
                        R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
                           "textures":[{"source":0}],"images":[{"uri":"gone.png"}],)")),
     "gone.png"},
    {"GltfUnknownRequiredExtension", "m.gltf",
     gltf(triangle_gltf(whole_nodes, 3,
                        R"("extensionsRequired":["ACME_wobble"],"extensionsUsed":["ACME_wobble"],"materials":[{}],)")),
     "ACME_wobble"},
};
INSTANTIATE_TEST_SUITE_P(Of, BadInputs, testing::ValuesIn(bad_inputs),
                         [](const auto& info) { return info.param.name; });

class BadOutput : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        write("s.heliodon.json", small_scene);
    }
    void expect_refused(const std::vector<std::string>& outputs, const std::string& named) {
        std::vector<std::string> arguments{"render", "s.heliodon.json", "--engine", "path", "--size", "16x16"};
        arguments.insert(arguments.end(), outputs.begin(), outputs.end());
        const std::vector<std::string> before = files();
        expect_one_located_line(run(arguments), named);
        EXPECT_EQ(files(), before);
    }
};

TEST_F(BadOutput, InAMissingDirectoryIsRefused) {
    expect_refused({"-o", "gone/o.exr"}, "gone/o.exr");
}
TEST_F(BadOutput, OfUnknownEndingIsRefused) {
    expect_refused({"-o", "o.docx"}, "o.docx");
}
TEST_F(BadOutput, WithoutEndingIsRefused) {
    expect_refused({"-o", "o"}, "o");
}
TEST_F(BadOutput, BesideAGoodOneIsRefusedBeforeAnythingIsWritten) {
    expect_refused({"-o", "o.exr", "-o", "gone/o.png"}, "gone/o.png");
}
TEST_F(BadOutput, OntoADirectoryIsRefused) {
    std::filesystem::create_directory(folder() / "o.exr");
    expect_refused({"-o", "o.exr"}, "o.exr");
}
TEST_F(BadOutput, OnAFileSystemThatCannotBeWrittenIsRefused) {
    expect_refused({"-o", "/proc/o.exr"}, "/proc/o.exr");
}
TEST_F(BadOutput, StatisticsInAMissingDirectoryAreRefused) {
    expect_refused({"-o", "o.exr", "--stats", "gone/n.json"}, "gone/n.json");
}
TEST_F(BadOutput, ACameraThatIsNotThereIsNamedWithThoseThatAre) {
    expect_refused({"-o", "o.exr", "--camera", "left"}, "\"above\"");
}
TEST_F(BadOutput, AnOverrideOfAnUnknownFieldIsRefused) {
    expect_refused({"-o", "o.exr", "--set", "nodes.bulb.light.flux=3"}, "flux");
}

TEST_F(BadOutput, ADeviceThatIsNotThereIsRefused) {
    expect_one_located_line(run({"render", "s.heliodon.json", "--device", "no such device", "-o", "o.exr"}),
                            "no such device");
    EXPECT_FALSE(exists("o.exr"));
}

/// Such triangles are common in real models: they are no error, and nothing becomes NaN.
TEST_F(BadOutput, ZeroAreaTrianglesAreHarmless) {
    write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\nf 1 2 2\nv 2 0 0\nf 1 2 4\n");
    for (const std::string engine : {"path", "realtime"}) {
        const Ended ended =
            run({"render", "m.obj", "--engine", engine, "--size", "16x16", "--spp", "2", "-o", "o.exr"});
        ASSERT_EQ(ended.code, 0) << ended.error;
        const auto picture = read_picture(folder() / "o.exr");
        ASSERT_TRUE(picture) << picture.error().text();
        for (const float value : picture->image.pixels) ASSERT_TRUE(std::isfinite(value));
    }
}

}  // namespace
}  // namespace heliodon::tests
