#include "samples.h"

#include <stdexcept>

#include "core/image_io.h"
#include "import/glb_builder.h"

namespace heliodon::tests {
namespace {

/// A room corner with everything on it: textures of every slot, two coordinate sets, colours, tangents, a sparse
/// accessor, a strip, lights, cameras, an animation.
GlbBuilder rich_gltf() {
    GlbBuilder builder;
    Json& json = builder.json;
    builder.add_square();
    Json& square = json["meshes"][0]["primitives"][0];
    square["material"] = 0;
    square["attributes"]["TEXCOORD_1"] =
        builder.add_accessor<std::uint8_t>({0, 255, 255, 255, 255, 0, 0, 0}, "VEC2", true);
    square["attributes"]["COLOR_0"] =
        builder.add_accessor<std::uint16_t>({65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 9, 9, 9}, "VEC3", true);
    square["attributes"]["TANGENT"] =
        builder.add_accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1}, "VEC4");

    Json strip = {{"mode", 5}, {"material", 1}};
    const std::size_t position = builder.add_accessor<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1}, "VEC3");
    json["accessors"][position]["sparse"] = {
        {"count", 1},
        {"indices",
         {{"bufferView", builder.add_view(GlbBuilder::bytes_of<std::uint16_t>({3}))}, {"componentType", 5123}}},
        {"values", {{"bufferView", builder.add_view(GlbBuilder::bytes_of<float>({1, 0, 1.5f}))}}}};
    strip["attributes"]["POSITION"] = position;
    builder.add_primitive(strip);

    const std::size_t picture = builder.add_view(picture_bytes(".png", 8, 8));
    json["images"] = {{{"bufferView", picture}, {"mimeType", "image/png"}},
                      {{"bufferView", builder.add_view(picture_bytes(".jpg", 16, 8))}, {"mimeType", "image/jpeg"}}};
    json["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33648}}};
    json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    const Json turned = {
        {"index", 0},
        {"extensions", {{"KHR_texture_transform", {{"offset", {0.1, 0.2}}, {"scale", {2, 3}}, {"rotation", 1}}}}}};
    json["materials"] = {
        {{"name", "all"},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.3},
         {"doubleSided", true},
         {"emissiveFactor", {1, 1, 1}},
         {"emissiveTexture", {{"index", 1}}},
         {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
         {"occlusionTexture", {{"index", 1}, {"texCoord", 1}, {"strength", 0.5}}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {1, 1, 1, 0.9}},
           {"baseColorTexture", turned},
           {"metallicFactor", 0.5},
           {"roughnessFactor", 0.4},
           {"metallicRoughnessTexture", {{"index", 1}}}}},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}},
           {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}}},
           {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorTexture", {{"index", 1}}}}},
           {"KHR_materials_ior", {{"ior", 1.4}}}}}},
        {{"name", "glass"},
         {"alphaMode", "BLEND"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 1, 0.9, 0.5}}, {"roughnessFactor", 0}}},
         {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}};
    json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_clearcoat"};
    json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 100}, {"color", {1, 0.9, 0.8}}},
        {{"type", "spot"}, {"intensity", 100}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}}}},
        {{"type", "directional"}, {"intensity", 1000}}};
    const auto lit = [](int light) { return Json{{"KHR_lights_punctual", {{"light", light}}}}; };
    json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 1}}}}};
    json["nodes"] = {
        {{"children", {1, 2, 3, 4}}, {"rotation", {0, 0.6, 0, 0.8}}},
        {{"mesh", 0}, {"scale", {1, 2, 1}}},
        {{"extensions", lit(0)}, {"translation", {0.5, 0.5, 2}}, {"children", {5}}},
        {{"camera", 0}, {"translation", {0.5, 0.5, 3}}},
        {{"extensions", lit(1)}, {"matrix", {1, 0, 0, 0, 0.2, 1, 0, 0, 0, 0, 1, 0, 0, 1, 2, 1}}, {"mesh", 0}},
        {{"extensions", lit(2)}}};
    const std::size_t times = builder.add_accessor<float>({0, 0.5f, 2}, "SCALAR");
    json["animations"] = {
        {{"samplers",
          {{{"input", times}, {"output", builder.add_accessor<float>({0, 0, 0, 1, 1, 1, 2, 0, 0}, "VEC3")}},
           {{"input", times},
            {"output", builder.add_accessor<float>({0, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4")},
            {"interpolation", "STEP"}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
    return builder;
}

/// The same with its bytes beside it and its first picture in a data URI's place.
Sample beside(const GlbBuilder& builder) {
    Json json = builder.json;
    json["buffers"] = {{{"byteLength", builder.binary.size()}, {"uri", "rich.bin"}}};
    json["images"][0] = {{"uri", "tile.png"}};
    return {"gltf",
            "rich.gltf",
            {{"rich.gltf", json.dump()}, {"rich.bin", builder.binary}, {"tile.png", picture_bytes(".png", 8, 8)}}};
}

std::string little_endian(std::initializer_list<int> values, int bytes) {
    std::string text;
    for (const int value : values)
        for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 255);
    return text;
}

/// 4 × 4 texels of 24 bits, rows from the bottom.
std::string bmp() {
    const std::string header = "BM" + little_endian({54 + 48, 0, 54, 40, 4, 4}, 4) + little_endian({1, 24}, 2) +
                               little_endian({0, 48, 2835, 2835, 0, 0}, 4);
    return header + std::string(48, '\x60');
}

/// 8 × 2 texels of 32 bits, a run and a literal packet a row.
std::string run_length_tga() {
    const std::string row = "\x83" + std::string("\x10\x20\x30\xff", 4) + "\x03" + std::string(16, '\x40');
    return little_endian({0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0, 2, 0, 32, 0x28}, 1) + row + row;
}

constexpr const char* obj_text = R"(# two walls and a polygon
mtllib walls.mtl
o walls
v 0 0 0
v 1 0 0 1 0.5 0.2
v 1 1 0
v 0 1 0
v 0 0 1
v 0 1 1
v 0.5 1.5 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 1
usemtl painted
s 1
f 1/1/1 2/2/1 3/3/1 4/4/1
f -7 -6 -5 -1 -4
usemtl glowing
g left side
f 1//1 5//1 6//1 4//1
o rest
usemtl missing
f 2 3 6 \
  5
l 1 2
p 3
)";

constexpr const char* mtl_text = R"(newmtl painted
Kd 0.5 0.6 0.7
Ks 0.2 0.2 0.2
Ns 40
map_Kd -s 2 2 1 -o 0.1 0.1 tile.png
map_Bump -bm 0.02 tile.png
d 0.9
illum 2
newmtl glowing
Ke 10 10 8
Pr 0.3
Pm 0.1
map_Pr tile.jpg
map_d tile.png
Ni 1.5
)";

constexpr const char* scene_text = R"({
  "heliodon": 1,
  "cameras": [{ "name": "main", "position": [0.5, 0.5, 4], "target": [0.5, 0.5, 0], "vertical_fov_deg": 40, "ev100": 8 }],
  "materials": { "tiles": { "base_color_texture": "tile.png", "roughness_texture": "tile.jpg", "bump_texture": "tile.png",
                            "metallic": 0.3, "emission_nits": [1, 0, 0] },
                 "paper": { "model": "lambert", "base_color": [0.5, 0.6, 0.7], "two_sided": true } },
  "nodes": [
    { "name": "model", "mesh": "walls.obj", "translate": [0, 0.1, 0], "rotate_deg": [0, 20, 0], "scale": 0.8,
      "material": "tiles" },
    { "name": "floor", "shape": { "type": "quad", "origin": [-2, 0, -2], "u": [0, 0, 4], "v": [4, 0, 0] }, "material": "paper" },
    { "name": "ball", "shape": { "type": "sphere", "center": [0.5, 0.5, 1], "radius": 0.3 }, "material": "tiles" },
    { "name": "lid", "shape": { "type": "disk", "center": [0, 2, 0], "normal": [0, -1, 0], "radius": 0.5 }, "material": "tiles" },
    { "name": "crate", "shape": { "type": "box", "min": [-1, 0, 0], "max": [-0.5, 0.5, 0.5] }, "rotate_deg": [0, 20, 0], "material": "paper",
      "children": [{ "name": "bulb", "light": { "type": "point", "intensity_cd": [50, 50, 50], "radius_m": 0.05 }, "translate": [0, 1.9, 0] }] },
    { "name": "spot", "light": { "type": "spot", "flux_lm": 800, "color": [1, 1, 1], "inner_deg": 20, "outer_deg": 30 }, "translate": [0, 2, 2] },
    { "name": "beam", "light": { "type": "directional", "illuminance_lux": [1000, 1000, 1000], "direction": [0, -1, -1], "angular_diameter_deg": 0.5 } }
  ],
  "sky": { "model": "image", "image": "sky.hdr", "north_deg": 30 },
  "sensors": [{ "name": "desk", "type": "illuminance", "position": [0, 0.8, 0], "normal": [0, 1, 0] }]
})";

constexpr const char* ies_text = R"(IESNA:LM-63-2002
[TEST] none
[LUMINAIRE] Downlight
TILT=INCLUDE
1
3
0 45 90
1 .95 .9
1 1000 1.5 4 3 1 2 -.2 -.3 .1
1 1 10
0 30 60 90
0 45 90
100 80 40 0
100 90 50 0
100 95 60 1
)";

constexpr const char* ldt_text = R"(Maker
2
3
4
90
3
45
report
name
number
file
date
1200
200
80
1100
150
0
0
0
0
100
60,5
1.0
0
1
2
LED
4000
4000K
1A
40
0.2
0.3
0.4
0.5
0.6
0.7
0.7
0.8
0.8
0.9
0
90
180
270
0
45
90
300
200
10
300
150
20
300
100
30
)";

constexpr const char* lit_scene_text = R"({
  "heliodon": 1,
  "cameras": [{ "name": "main", "position": [0, 1, 3], "target": [0, 1, 0], "ev100": 8 }],
  "nodes": [
    { "name": "floor", "shape": { "type": "quad", "origin": [-2, 0, -2], "u": [0, 0, 4], "v": [4, 0, 0] } },
    { "name": "drum", "light": { "type": "ies", "file": "lamp.ies", "scale": 0.5 }, "translate": [1, 1.5, 0], "rotate_deg": [20, 0, 0] },
    { "name": "panel", "light": { "type": "ies", "file": "lamp.ldt", "flux_lm": 900, "color": [1, 0.9, 0.8] }, "translate": [-1, 1.5, 0] }
  ],
  "sensors": [{ "name": "desk", "type": "illuminance", "position": [0, 0.8, 0], "normal": [0, 1, 0] }]
})";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

}  // namespace

std::string picture_bytes(const std::string& ending, int width, int height) {
    Picture picture;
    picture.image = Image(width, height, 3);
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i)
        picture.image.pixels[i] = static_cast<float>(i * 2654435761u % 251) / 250.0f;
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / ("picture" + ending);
    if (const auto written = write_picture(path, picture); !written) throw std::runtime_error(written.error().text());
    return read_file(path).value();
}

std::vector<Sample> samples() {
    const GlbBuilder rich = rich_gltf();
    const std::vector<SampleFile> walls{{"walls.obj", obj_text},
                                        {"walls.mtl", mtl_text},
                                        {"tile.png", picture_bytes(".png", 8, 8)},
                                        {"tile.jpg", picture_bytes(".jpg", 16, 16)}};
    std::vector<SampleFile> scene = walls;
    scene.push_back({"scene.heliodon.json", scene_text});
    scene.push_back({"sky.hdr", picture_bytes(".hdr", 16, 8)});
    const std::vector<SampleFile> other_pictures{{"scene.heliodon.json", replaced(scene_text, "sky.hdr", "sky.exr")},
                                                 {"walls.obj", obj_text},
                                                 {"walls.mtl", mtl_text},
                                                 {"tile.png", run_length_tga()},
                                                 {"tile.jpg", bmp()},
                                                 {"sky.exr", picture_bytes(".exr", 16, 8)}};
    return {{"glb", "rich.glb", {{"rich.glb", rich.glb()}}},
            beside(rich),
            {"obj", "walls.obj", walls},
            {"scene", "scene.heliodon.json", scene},
            {"scene of other pictures", "scene.heliodon.json", other_pictures},
            {"luminaire", "lamp.ies", {{"lamp.ies", ies_text}}},
            {"scene of luminaires",
             "lit.heliodon.json",
             {{"lamp.ldt", ldt_text}, {"lamp.ies", ies_text}, {"lit.heliodon.json", lit_scene_text}}}};
}

}  // namespace heliodon::tests
