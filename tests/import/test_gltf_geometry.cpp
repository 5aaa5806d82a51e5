#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <random>

#include "import/glb_builder.h"

namespace heliodon {
namespace {

using tests::first;
using tests::GlbBuilder;
using tests::Json;

Mesh load_mesh(GlbBuilder& builder) {
    Scene scene;
    std::string error;
    EXPECT_TRUE(builder.load(scene, &error)) << error;
    return scene.geometries().size() > 0 ? first(scene.geometries()).mesh : Mesh{};
}

template <class T>
std::vector<T> plain(const PaddedArray<T>& values) {
    return {values.begin(), values.end()};
}

const std::vector<float> square_positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

template <class Index>
void expect_indices_of() {
    GlbBuilder builder;
    builder.add_primitive({{"attributes", {{"POSITION", builder.add_accessor(square_positions, "VEC3")}}},
                           {"indices", builder.add_accessor<Index>({0, 1, 2, 0, 2, 3}, "SCALAR")}});
    EXPECT_EQ(load_mesh(builder).triangle_count(), 2u);
}

TEST(GltfGeometry, IndicesMayBeBytesShortsOrInts) {
    expect_indices_of<std::uint8_t>();
    expect_indices_of<std::uint16_t>();
    expect_indices_of<std::uint32_t>();
}

TEST(GltfGeometry, AttributesArriveAsTheyAreWritten) {
    GlbBuilder builder;
    Json& square = builder.add_square();
    square["attributes"]["COLOR_0"] =
        builder.add_accessor<std::uint8_t>({255, 0, 51, 255, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8}, "VEC4", true);
    square["attributes"]["TEXCOORD_1"] =
        builder.add_accessor<std::uint16_t>({0, 65535, 65535, 0, 0, 0, 13107, 0}, "VEC2", true);
    const Mesh mesh = load_mesh(builder);
    EXPECT_EQ(plain(mesh.indices), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
    EXPECT_EQ(mesh.normals[3], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.texcoords[0][1], glm::vec2(1, 1));
    EXPECT_EQ(mesh.texcoords[1][0], glm::vec2(0, 1));
    EXPECT_NEAR(mesh.texcoords[1][3].x, 0.2f, 1e-6f);
    EXPECT_EQ(mesh.colors[0], glm::vec4(1, 0, 0.2f, 1));
    EXPECT_TRUE(mesh.tangents.empty()) << "no normal map asks for them";
}

TEST(GltfGeometry, ColoursWithoutAlphaAreOpaque) {
    GlbBuilder builder;
    builder.add_square()["attributes"]["COLOR_0"] =
        builder.add_accessor<float>({.5f, .25f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC3");
    EXPECT_EQ(load_mesh(builder).colors[0], glm::vec4(.5f, .25f, 1, 1));
}

TEST(GltfGeometry, QuantizedAttributesKeepTheirValues) {
    GlbBuilder builder;
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    builder.add_primitive(
        {{"attributes",
          {{"POSITION", builder.add_accessor<std::int16_t>({0, 0, 0, 1000, 0, 0, 1000, -500, 0}, "VEC3")},
           {"NORMAL", builder.add_accessor<std::int8_t>({0, 0, 127, 0, 0, 127, 0, -127, 0}, "VEC3", true)}}}});
    const Mesh mesh = load_mesh(builder);
    EXPECT_EQ(mesh.positions[2], glm::vec3(1000, -500, 0));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, -1, 0));
}

TEST(GltfGeometry, NormalizedPositionsAreScaledAndMostNegativeIntegersClamped) {
    GlbBuilder builder;
    builder.add_primitive(
        {{"attributes",
          {{"POSITION", builder.add_accessor<std::int8_t>({-128, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC3", true)}}}});
    const Mesh mesh = load_mesh(builder);
    EXPECT_EQ(mesh.positions[0], glm::vec3(-1, 0, 0));
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
}

TEST(GltfGeometry, StripsAndFansBecomeTriangles) {
    for (const auto& [mode, expected] :
         {std::pair{5, std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}}, {6, {1, 2, 0, 2, 3, 0}}}) {
        GlbBuilder builder;
        const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, fan = square_positions;
        builder.add_primitive(
            {{"attributes",
              {{"POSITION", builder.add_accessor(mode == 5 ? strip : fan, "VEC3")},
               {"NORMAL", builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}},
             {"mode", mode}});
        const Mesh mesh = load_mesh(builder);
        EXPECT_EQ(plain(mesh.indices), expected);
    }
}

TEST(GltfGeometry, PointsAndLinesAreIgnoredWithOneMessage) {
    GlbBuilder builder;
    builder.add_square();
    for (const int mode : {0, 1, 2, 3})
        builder.add_primitive(
            {{"attributes", {{"POSITION", builder.add_accessor(square_positions, "VEC3")}}}, {"mode", mode}});
    EXPECT_EQ(load_mesh(builder).triangle_count(), 2u);
    EXPECT_TRUE(builder.warned("4 primitives of points or lines"));
    EXPECT_EQ(builder.warnings.size(), 1u);
}

TEST(GltfGeometry, SparseAccessorsReplaceElements) {
    GlbBuilder builder;
    const std::size_t position = builder.add_accessor(square_positions, "VEC3");
    const std::size_t indices = builder.add_view(GlbBuilder::bytes_of<std::uint16_t>({1, 3}));
    const std::size_t values = builder.add_view(GlbBuilder::bytes_of<float>({5, 0, 0, 0, 7, 0}));
    builder.json["accessors"][position]["sparse"] = {{"count", 2},
                                                     {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                                     {"values", {{"bufferView", values}}}};
    builder.add_primitive({{"attributes",
                            {{"POSITION", position},
                             {"NORMAL", builder.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}},
                           {"indices", builder.add_accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR")}});
    const Mesh mesh = load_mesh(builder);
    EXPECT_EQ(mesh.positions[1], glm::vec3(5, 0, 0));
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
    EXPECT_EQ(mesh.positions[3], glm::vec3(0, 7, 0));
}

TEST(GltfGeometry, SparseAccessorsWithoutBufferViewStartFromZero) {
    GlbBuilder builder;
    const std::size_t indices = builder.add_view(GlbBuilder::bytes_of<std::uint8_t>({1, 2}));
    const std::size_t values = builder.add_view(GlbBuilder::bytes_of<float>({1, 0, 0, 0, 1, 0}));
    builder.json["accessors"].push_back({{"componentType", 5126},
                                         {"count", 3},
                                         {"type", "VEC3"},
                                         {"sparse",
                                          {{"count", 2},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", values}}}}}});
    builder.add_primitive({{"attributes", {{"POSITION", 0}}}});
    const Mesh mesh = load_mesh(builder);
    ASSERT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.positions[0], glm::vec3(0));
    EXPECT_EQ(mesh.positions[2], glm::vec3(0, 1, 0));
}

TEST(GltfGeometry, InterleavedBufferViewsAreReadByTheirStride) {
    GlbBuilder builder;
    const std::vector<float> interleaved = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
    const std::size_t view = builder.add_view(GlbBuilder::bytes_of(interleaved));
    builder.json["bufferViews"][view]["byteStride"] = 24;
    builder.json["accessors"] = {
        {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
        {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}};
    builder.add_primitive({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}});
    const Mesh mesh = load_mesh(builder);
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
}

TEST(GltfGeometry, MissingNormalsAreFlat) {
    GlbBuilder builder;  // two triangles at a right angle along the edge 0-1
    builder.add_primitive(
        {{"attributes", {{"POSITION", builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3")}}},
         {"indices", builder.add_accessor<std::uint8_t>({0, 1, 2, 1, 0, 3}, "SCALAR")}});
    const Mesh mesh = load_mesh(builder);
    ASSERT_EQ(mesh.positions.size(), 6u);
    for (std::size_t corner = 0; corner < 6; ++corner)
        EXPECT_EQ(mesh.normals[mesh.indices[corner]], corner < 3 ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0));
    EXPECT_TRUE(builder.warned("flat normals"));
}

TEST(GltfGeometry, TrianglesWithoutAreaAreDroppedWithOneMessage) {
    GlbBuilder builder;
    builder.add_primitive(
        {{"attributes", {{"POSITION", builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0}, "VEC3")}}},
         {"indices", builder.add_accessor<std::uint8_t>({0, 1, 2, 0, 0, 1, 0, 1, 3}, "SCALAR")}});
    const Mesh mesh = load_mesh(builder);
    EXPECT_EQ(mesh.triangle_count(), 1u);
    EXPECT_EQ(mesh.positions.size(), 3u) << "the vertex that only a dropped triangle used goes too";
    EXPECT_TRUE(builder.warned("drops 2 triangles"));
}

TEST(GltfGeometry, NodesThatNameOneMeshShareItsGeometry) {
    GlbBuilder builder;
    builder.add_square();
    builder.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
    builder.json["scenes"][0]["nodes"] = {0, 1};
    Scene scene;
    ASSERT_TRUE(builder.load(scene));
    EXPECT_EQ(scene.geometries().size(), 1u);
    EXPECT_EQ(scene.bounds().max.x, 6.0f);
}

TEST(GltfGeometry, PrimitivesKeepOnlyTheVerticesTheyUse) {
    GlbBuilder builder;
    const std::size_t position = builder.add_accessor(square_positions, "VEC3");
    for (const auto& indices : {std::vector<std::uint8_t>{0, 1, 2}, {0, 2, 3}})
        builder.add_primitive(
            {{"attributes", {{"POSITION", position}}}, {"indices", builder.add_accessor(indices, "SCALAR")}});
    Scene scene;
    ASSERT_TRUE(builder.load(scene));
    ASSERT_EQ(scene.geometries().size(), 2u);
    scene.geometries().each(
        [](GeometryId, const Geometry& geometry) { EXPECT_EQ(geometry.mesh.positions.size(), 3u); });
}

/// The unit square, draco-compressed.
GlbBuilder draco_square() {
    draco::TriangleSoupMeshBuilder soup;
    soup.Start(2);
    const int position = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int texcoord = soup.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                uv[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    const int faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int f = 0; f < 2; ++f) {
        soup.SetAttributeValuesForFace(position, draco::FaceIndex(unsigned(f)), corners[faces[f][0]],
                                       corners[faces[f][1]], corners[faces[f][2]]);
        soup.SetAttributeValuesForFace(texcoord, draco::FaceIndex(unsigned(f)), uv[faces[f][0]], uv[faces[f][1]],
                                       uv[faces[f][2]]);
    }
    const auto source = soup.Finalize();
    draco::ExpertEncoder encoder(*source);
    encoder.SetAttributeQuantization(position, 14);
    encoder.SetAttributeQuantization(texcoord, 12);
    draco::EncoderBuffer encoded;
    EXPECT_TRUE(encoder.EncodeToBuffer(&encoded).ok());

    GlbBuilder builder;
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const std::size_t view = builder.add_view({encoded.data(), encoded.size()});
    builder.json["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                                 {{"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
                                 {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
    builder.add_primitive({{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}},
                           {"indices", 2},
                           {"extensions",
                            {{"KHR_draco_mesh_compression",
                              {{"bufferView", view},
                               {"attributes",
                                {{"POSITION", source->attribute(position)->unique_id()},
                                 {"TEXCOORD_0", source->attribute(texcoord)->unique_id()}}}}}}}});
    return builder;
}

TEST(GltfGeometry, DracoMeshesAreDecoded) {
    GlbBuilder builder = draco_square();
    const Mesh mesh = load_mesh(builder);
    ASSERT_EQ(mesh.triangle_count(), 2u);
    EXPECT_NEAR(mesh.bounds().max.x, 1, 1e-4);
    EXPECT_NEAR(mesh.bounds().max.y, 1, 1e-4);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(mesh.texcoords[0][v].x, mesh.positions[v].x, 1e-3);
        EXPECT_NEAR(mesh.texcoords[0][v].y, 1 - mesh.positions[v].y, 1e-3);
    }
}

/// A view that holds `encoded` and decodes to `count` elements of `stride` bytes in a buffer without data.
std::size_t add_meshopt_view(GlbBuilder& builder, const std::vector<unsigned char>& encoded, std::size_t count,
                             std::size_t stride, const std::string& mode, const std::string& filter = "NONE") {
    const std::size_t compressed = builder.add_view(GlbBuilder::bytes_of(encoded));
    Json& view = builder.json["bufferViews"][compressed];
    Json inside = {{"buffer", 0},
                   {"byteOffset", view["byteOffset"]},
                   {"byteLength", view["byteLength"]},
                   {"byteStride", stride},
                   {"count", count},
                   {"mode", mode},
                   {"filter", filter}};
    view = {{"buffer", 1},
            {"byteOffset", 0},
            {"byteLength", count * stride},
            {"extensions", {{"EXT_meshopt_compression", inside}}}};
    if (mode == "ATTRIBUTES") view["byteStride"] = stride;
    return compressed;
}

std::vector<unsigned char> encode_vertices(const void* data, std::size_t count, std::size_t stride) {
    std::vector<unsigned char> encoded(meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), data, count, stride));
    return encoded;
}

const std::vector<float> filtered_normals = {0, 0, 1, 1, 0, 0.6f, 0.8f, 1, 1, 0, 0, 1, 0, -1, 0, 1};

/// The unit square with those normals, compressed and filtered by meshoptimizer.
GlbBuilder meshopt_square() {
    GlbBuilder builder;
    builder.json["extensionsUsed"] =
        builder.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    std::vector<std::int8_t> oct(16);
    meshopt_encodeFilterOct(oct.data(), 4, 4, 8, filtered_normals.data());
    std::vector<std::uint32_t> exponents(12);
#if MESHOPTIMIZER_VERSION < 190  // knows only exponents shared by a vector's components
    meshopt_encodeFilterExp(exponents.data(), 4, 12, 15, square_positions.data());
#else
    meshopt_encodeFilterExp(exponents.data(), 4, 12, 15, square_positions.data(), meshopt_EncodeExpSharedVector);
#endif
    const std::vector<unsigned> indices = {0, 1, 2, 0, 2, 3};
    std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(6, 4));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), 6));

    builder.add_view(GlbBuilder::bytes_of<float>({0}));
    const std::size_t position =
        add_meshopt_view(builder, encode_vertices(exponents.data(), 4, 12), 4, 12, "ATTRIBUTES", "EXPONENTIAL");
    const std::size_t normal =
        add_meshopt_view(builder, encode_vertices(oct.data(), 4, 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
    const std::size_t index = add_meshopt_view(builder, triangles, 6, 4, "TRIANGLES");
    builder.json["accessors"] = {
        {{"bufferView", position}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", normal}, {"componentType", 5120}, {"normalized", true}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", index}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
    builder.add_primitive({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}});
    builder.json["buffers"] = {
        {{"byteLength", builder.binary.size()}},
        {{"byteLength", 88}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    return builder;
}

TEST(GltfGeometry, MeshoptBufferViewsAndFiltersAreDecoded) {
    GlbBuilder builder = meshopt_square();
    const Mesh mesh = load_mesh(builder);
    ASSERT_EQ(mesh.positions.size(), 4u);
    ASSERT_EQ(mesh.triangle_count(), 2u);
    for (std::size_t v = 0; v < 4; ++v)
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mesh.positions[v][c], square_positions[v * 3 + std::size_t(c)], 1e-4);
            EXPECT_NEAR(mesh.normals[v][c], filtered_normals[v * 4 + std::size_t(c)], 0.02);
        }
}

TEST(GltfGeometry, DamagedCompressedMeshesNeverCrash) {
    std::mt19937 random(3);
    for (const GlbBuilder& whole : {draco_square(), meshopt_square()})
        for (int i = 0; i < 1500; ++i) {
            GlbBuilder builder = whole;
            for (int k = 0; k < 1 + i % 4; ++k) builder.binary[random() % builder.binary.size()] = char(random());
            Scene scene;
            std::string error;
            if (!builder.load(scene, &error)) EXPECT_NE(error.find("model.glb: $."), std::string::npos) << error;
        }
}

TEST(GltfGeometry, MeshoptIndexSequencesAndQuaternionsAreDecoded) {
    GlbBuilder builder;
    builder.json["extensionsUsed"] = {"EXT_meshopt_compression"};
    const std::vector<unsigned> indices = {0, 1, 2, 3};
    std::vector<unsigned char> sequence(meshopt_encodeIndexSequenceBound(4, 4));
    sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), indices.data(), 4));
    const std::vector<float> quaternions = {0, 0, 0, 1, 0.6f, 0, 0, 0.8f};
    std::vector<std::int16_t> encoded(8);
    meshopt_encodeFilterQuat(encoded.data(), 2, 8, 12, quaternions.data());
    const std::size_t position = builder.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
    const std::size_t times = builder.add_accessor<float>({0, 1}, "SCALAR");
    const std::size_t index_view = add_meshopt_view(builder, sequence, 4, 4, "INDICES");
    const std::size_t quaternion_view =
        add_meshopt_view(builder, encode_vertices(encoded.data(), 2, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
    builder.json["accessors"].push_back(
        {{"bufferView", index_view}, {"componentType", 5125}, {"count", 4}, {"type", "SCALAR"}});
    builder.json["accessors"].push_back({{"bufferView", quaternion_view},
                                         {"componentType", 5122},
                                         {"normalized", true},
                                         {"count", 2},
                                         {"type", "VEC4"}});
    builder.add_primitive({{"attributes", {{"POSITION", position}}}, {"indices", 2}, {"mode", 5}});
    builder.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}},
                                   {"samplers", {{{"input", times}, {"output", 3}}}}}};
    builder.json["buffers"] = {
        {{"byteLength", builder.binary.size()}},
        {{"byteLength", 32}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    Scene scene;
    std::string error;
    ASSERT_TRUE(builder.load(scene, &error)) << error;
    EXPECT_EQ(first(scene.geometries()).mesh.triangle_count(), 2u);
    const AnimationChannel& channel = first(scene.animations()).channels.at(0);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(channel.values[i], quaternions[i], 2e-3);
}

}  // namespace
}  // namespace heliodon
