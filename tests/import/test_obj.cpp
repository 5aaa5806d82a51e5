#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "core/image_io.h"
#include "import/glb_builder.h"
#include "import/picture_files.h"
#include "shared_data.h"

namespace heliodon {
namespace {

using tests::first;

struct ObjFile {
    tests::TemporaryFolder folder;
    Scene scene;
    Warnings warnings;

    Result<NodeId> load(const std::string& text) {
        return import_model(scene, {}, folder.write("model.obj", text), warnings);
    }
    std::string error(const std::string& text) {
        const auto root = load(text);
        return root ? "" : root.error().text();
    }
    bool warned(std::string_view text) const {
        for (const Error& warning : warnings)
            if (warning.message.find(text) != std::string::npos) return true;
        return false;
    }
    const Material& material(std::string_view name) const { return *scene.materials().find(scene.find_material(name)); }
};

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(Obj, VerticesAreSharedByPositionTextureAndNormal) {
    ObjFile file;
    ASSERT_TRUE(
        file.load("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                  "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n"));
    const Mesh& mesh = first(file.scene.geometries()).mesh;
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangle_count(), 2u);
    EXPECT_EQ(mesh.texcoords[0][0], glm::vec2(0, 1)) << "v runs down from the picture's top";
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
}

TEST(Obj, NegativeIndicesCountFromTheEnd) {
    ObjFile file;
    ASSERT_TRUE(file.load(triangle + "f -3 -2 -1\nv 9 9 9\n"));
    EXPECT_EQ(first(file.scene.geometries()).mesh.bounds().max, glm::vec3(1, 1, 0));
}

TEST(Obj, ConcavePolygonsAreTriangulatedInside) {
    ObjFile file;  // an L of area 3
    ASSERT_TRUE(file.load("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 3 4 5 6 1 2\n"));
    const Mesh& mesh = first(file.scene.geometries()).mesh;
    EXPECT_EQ(mesh.triangle_count(), 4u);
    double area = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                        c = mesh.positions[mesh.indices[i + 2]];
        const float z = glm::cross(b - a, c - a).z;
        EXPECT_GT(z, 0);
        area += 0.5 * z;
    }
    EXPECT_NEAR(area, 3, 1e-6);
}

TEST(Obj, ObjectsBecomeNodesAndMaterialsParts) {
    ObjFile file;
    file.folder.write("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    ASSERT_TRUE(file.load(
        "mtllib m.mtl\n" + triangle +
        "o one\nusemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\nusemtl red\nf 2 3 1\no two\nusemtl blue\nf 1 2 3\n"));
    const Node& one = *file.scene.nodes().find(file.scene.find_node("one"));
    ASSERT_EQ(one.parts.size(), 2u);
    EXPECT_EQ(file.scene.geometries().find(one.parts[0].geometry)->mesh.triangle_count(), 2u);
    EXPECT_EQ(one.parts[0].material, file.scene.find_material("red"));
    EXPECT_EQ(file.scene.nodes().find(file.scene.find_node("two"))->parts.size(), 1u);
}

TEST(Obj, PbrKeysArrive) {
    ObjFile file;
    file.folder.write("m.mtl",
                      "newmtl a\nKd 0.1 0.2 0.3\nKe 5 6 7\nPr 0.25\nPm 0.75\nPc 0.5\nPcr 0.125\nNi 1.4\nd 0.5\n");
    ASSERT_TRUE(file.load("mtllib m.mtl\n" + triangle + "usemtl a\nf 1 2 3\n"));
    const Material& material = file.material("a");
    EXPECT_EQ(material.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(material.emission_nits, glm::vec3(5, 6, 7));
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.metallic, 0.75f);
    EXPECT_EQ(material.clearcoat, 0.5f);
    EXPECT_EQ(material.clearcoat_roughness, 0.125f);
    EXPECT_FLOAT_EQ(material.ior, 1.4f);
    EXPECT_EQ(material.opacity, 0.5f);
    EXPECT_EQ(material.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(file.warned("Ke"));
}

TEST(Obj, PhongExponentsBecomeRoughness) {
    ObjFile file;
    file.folder.write("m.mtl", "newmtl a\nKs 1 1 1\nNs 30\nillum 2\nnewmtl b\nKd 1 1 1\n");
    ASSERT_TRUE(file.load("mtllib m.mtl\n" + triangle + "usemtl a\nf 1 2 3\n"));
    EXPECT_NEAR(file.material("a").roughness, 0.5f, 1e-6f) << "α² = 2/(30 + 2), roughness = √α";
    EXPECT_EQ(file.material("b").specular, 0.0f) << "no highlight asked for";
}

TEST(Obj, MapsArePackedAndTransformed) {
    ObjFile file;
    file.folder.write("color.png", tests::png(2, 1, 4, {10, 20, 30, 255, 40, 50, 60, 0}));
    file.folder.write("rough.png", tests::png(1, 1, 1, {100}));
    file.folder.write("metal.png", tests::png(1, 1, 1, {200}));
    file.folder.write("normal.png", tests::png(1, 1, 3, {128, 128, 255}));
    file.folder.write("alpha.png", tests::png(2, 1, 1, {255, 255}));
    file.folder.write("m.mtl",
                      "newmtl a\nmap_Kd -s 2 3 1 -o 0.5 0.25 0 color.png\nmap_Pr rough.png\nmap_Pm metal.png\nnorm "
                      "normal.png\nmap_d alpha.png\n");
    const auto root = file.load("mtllib m.mtl\n" + triangle + "vt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n");
    ASSERT_TRUE(root) << root.error().text();
    const Material& material = file.material("a");
    const Texture& color = *file.scene.textures().find(material.base_color_texture.texture);
    EXPECT_EQ(color.levels[0], (std::vector<std::uint8_t>{10, 20, 30, 255, 40, 50, 60, 0}));
    EXPECT_EQ(material.alpha_mode, AlphaMode::mask) << "all of its alpha is 0 or 1";
    EXPECT_EQ(material.base_color, glm::vec3(1)) << "a map without Kd is not darkened";
    const Texture& orm = *file.scene.textures().find(material.orm_texture.texture);
    EXPECT_EQ(orm.levels[0], (std::vector<std::uint8_t>{255, 100, 200, 255}));
    EXPECT_EQ(file.scene.textures().size(), 3u);
    // OBJ's uv (1, 1) is glTF's (1, 0); MTL's 2·1 + 0.5 and 3·1 + 0.25 are then (2.5, 1 − 3.25).
    const glm::vec2 moved =
        material.base_color_texture.uv_matrix * glm::vec2(1, 0) + material.base_color_texture.uv_offset;
    EXPECT_EQ(moved, glm::vec2(2.5f, -2.25f));
    EXPECT_FALSE(first(file.scene.geometries()).mesh.tangents.empty());
}

TEST(Obj, VertexColoursArrive) {
    ObjFile file;
    ASSERT_TRUE(file.load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n"));
    EXPECT_EQ(first(file.scene.geometries()).mesh.colors[1], glm::vec4(0, 1, 0, 1));
}

TEST(Obj, LinesMayBeContinuedAndEndAnyWay) {
    ObjFile file;
    ASSERT_TRUE(file.load("v 0 0 0\r\nv 1 0 \\\r\n 0\r\nv 0 1 0\r\nf 1 \\\n2 3"));
    EXPECT_EQ(first(file.scene.geometries()).mesh.triangle_count(), 1u);
}

TEST(Obj, ErrorsNameTheirLine) {
    const std::pair<std::string, std::string> cases[] = {
        {triangle + "f 1 2 4\n", "model.obj:4: vertex index 4 is out of range"},
        {triangle + "f 1 2 -4\n", "model.obj:4: vertex index -4 is out of range"},
        {triangle + "f 1 2 0\n", "model.obj:4: expected a corner"},
        {triangle + "f 1/1 2/1 3/1\n", "model.obj:4: texture coordinate index 1"},
        {triangle + "f 1//2 2//2 3//2\n", "model.obj:4: normal index 2"},
        {triangle + "\n# \\\n comment\nf 1 2\n", "model.obj:7: expected at least 3 corners"},
        {triangle + "f 1 2 x\n", "model.obj:4: expected a corner"},
        {triangle + "f 1 2 3/4/5/6\n", "model.obj:4: expected at most three"},
        {triangle + "f 1 2 99999999999999999999\n", "model.obj:4: expected a corner"},
        {"v 0 0\n", "model.obj:1: expected 3 numbers after v, found 2"},
        {"v 0 nan 0\n", "model.obj:1: expected a finite number, found \"nan\""},
        {"v 0 0 1e999\n", "model.obj:1: expected a finite number"},
        {"v 0 inf 0\n", "model.obj:1: expected a finite number"},
        {"v 0 0x 0\n", "model.obj:1: expected a finite number, found \"0x\""},
        {"vt a\n", "model.obj:1: expected a finite number"},
        {"", "model.obj: expected faces"},
        {triangle, "model.obj: expected faces"},
    };
    for (const auto& [text, expected] : cases) {
        ObjFile file;
        const std::string error = file.error(text);
        EXPECT_NE(error.find(expected), std::string::npos) << "for \"" << text << "\": " << error;
        EXPECT_EQ(file.scene.nodes().size(), 0u);
    }
}

TEST(Obj, ErrorsInMtlNameTheirLine) {
    for (const auto& [text, expected] : {std::pair{"newmtl a\nKd 1 x 0\n", "m.mtl:2: expected a finite number"},
                                         {"newmtl a\nNs\n", "m.mtl:2: expected a number after Ns"},
                                         {"newmtl a\nKd 1 1 1\nmap_Kd gone.png\n", "gone.png"}}) {
        ObjFile file;
        file.folder.write("m.mtl", text);
        const std::string error = file.error("mtllib m.mtl\n" + triangle + "usemtl a\nf 1 2 3\n");
        EXPECT_NE(error.find(expected), std::string::npos) << error;
    }
}

TEST(Obj, AMissingMtlFileIsAMessage) {
    ObjFile file;
    ASSERT_TRUE(file.load("mtllib gone.mtl\n" + triangle + "usemtl a\nf 1 2 3\n"));
    EXPECT_TRUE(file.warned("cannot be read"));
    EXPECT_TRUE(file.warned("material \"a\""));
}

TEST(Obj, AnEmptyMtlFileIsHarmless) {
    ObjFile file;
    file.folder.write("m.mtl", "");
    EXPECT_TRUE(file.load("mtllib m.mtl\n" + triangle + "f 1 2 3\n"));
}

TEST(Obj, DamagedFilesNeverCrash) {
    const auto path = tests::shared_path("models/teapot.obj");
    if (!path) GTEST_SKIP() << "no shared data";
    const std::string text = *read_file(*path);
    std::mt19937 random(99);
    for (int i = 0; i < 120; ++i) {
        std::string copy = i % 2 ? text.substr(0, random() % text.size()) : text;
        for (int k = 0; k < 3 && i % 4 != 1; ++k) copy[random() % copy.size()] = char(random());
        ObjFile file;
        const std::string error = file.error(copy);
        if (!error.empty()) EXPECT_NE(error.find("model.obj"), std::string::npos) << error;
    }
}

}  // namespace
}  // namespace heliodon
