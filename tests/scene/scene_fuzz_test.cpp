// Damaged scene files: whatever comes in, one located error or a scene, never a crash (run under sanitizers too).
#include <nlohmann/json.hpp>
#include <random>

#include "json_schema.h"
#include "scene_file_fixture.h"
#include "shared_data.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

constexpr std::string_view every_block = R"({"heliodon": 1,
  "cameras": [{"name": "main", "position": [0,1,3], "target": [0,1,0], "vertical_fov_deg": 40, "iso": 100}],
  "materials": {"white": {"base_color": [0.7,0.7,0.7], "roughness": 0.5, "normal_texture": "n.png"}},
  "nodes": [{"name": "room", "children": [{"name": "ball", "shape": {"type": "sphere", "center": [0,0,0], "radius": 1}, "material": "white"}]},
            {"name": "model", "mesh": "m.obj", "scale": 2, "rotate_deg": [0,90,0], "material": "white"},
            {"name": "knot", "shape": {"type": "torus_knot", "segments": 16}},
            {"name": "spot", "light": {"type": "spot", "flux_lm": 800, "color": [1,1,1], "inner_deg": 20, "outer_deg": 30}}],
  "sky": {"model": "image", "image": "env.hdr", "north_deg": 10},
  "sensors": [{"name": "desk", "type": "illuminance", "position": [0,0.8,0], "normal": [0,1,0]}],
  "probes": {"min": [-1,0,-1], "max": [1,2,1], "counts": [8,8,8]},
  "convert": {"shape_segments": 8}, "render": {"gi": "vct", "voxels": 128, "bounces": "inf", "vct": {"shadows": true, "cones": 18}},
  "animations": [{"name": "turn", "channels": [{"target": "nodes.room.rotate_deg", "times_s": [0, 1], "values": [[0,0,0],[0,90,0]]}]}]})";

constexpr std::string_view daylight = R"({"heliodon": 1, "sky": {"model": "hosek", "turbidity": 3, "ground_albedo": 0.2, "latitude_deg": 59.9,
  "longitude_deg": 10.7, "time": "2026-03-21T09:00:00+01:00", "north_deg": 10, "sun": {"disc": true, "angular_diameter_deg": 0.53}}})";

std::vector<std::string> seeds() {
    std::vector<std::string> texts{std::string(every_block), std::string(daylight)};
    const std::filesystem::path shared =
        std::getenv("HELIODON_SHARED") ? std::getenv("HELIODON_SHARED") : HELIODON_SOURCE_DIR "/../shared";
    if (std::filesystem::exists(shared / "scenes"))
        for (const auto& entry : std::filesystem::directory_iterator(shared / "scenes"))
            texts.push_back(file_text(entry.path()));
    return texts;
}

/// Errors are located: in the file, at a line or a JSON path.
void expect_located_or_read(const Result<Scene>& scene, const std::string& text) {
    if (scene) return;
    const std::string& where = scene.error().where;
    EXPECT_TRUE(where == "test.json" || where.starts_with("test.json:")) << where << "\n" << text;
    EXPECT_FALSE(scene.error().message.empty());
}

class Mutations {
public:
    std::string bytes(std::string text) {
        constexpr std::string_view alphabet = "{}[]\",:.0123456789eE+-truefalsn\\u \n\x01\x7f\xff";
        for (int i = 1 + pick(4); i > 0 && !text.empty(); --i) {
            const std::size_t at = pick(text.size());
            switch (pick(4)) {
                case 0:
                    text[at] = alphabet[pick(alphabet.size())];
                    break;
                case 1:
                    text.erase(at, 1 + pick(8));
                    break;
                case 2:
                    text.insert(at, 1, alphabet[pick(alphabet.size())]);
                    break;
                default:
                    if (pick(20) == 0)
                        text.resize(at);
                    else
                        text[at] = static_cast<char>(pick(256));
            }
        }
        return text;
    }

    json values(json document) {
        json* at = &document;
        while (at->is_structured() && !at->empty() && pick(8) != 0) {
            auto child = at->begin();
            std::advance(child, pick(at->size()));
            at = &*child;
        }
        *at = odd_value();
        return document;
    }

    std::size_t pick(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }

private:
    json odd_value() {
        static const std::vector<json> odd{nullptr,
                                           true,
                                           false,
                                           0,
                                           -1,
                                           1,
                                           2,
                                           0.5,
                                           1e-60,
                                           -0.0,
                                           1e38,
                                           3.5e38,
                                           1e300,
                                           4294967296,
                                           -9223372036854775807,
                                           "",
                                           "x",
                                           "none",
                                           "point",
                                           "\u0000",
                                           json::array(),
                                           json::object(),
                                           {0, 0, 0},
                                           {1, 2, 3},
                                           {1e38, 1e38, 1e38},
                                           {"a", "b"},
                                           {{"type", "spot"}},
                                           {{"name", "a"}}};
        return odd[pick(odd.size())];
    }

    std::mt19937 random_{20260321};
};

TEST(SceneFileFuzz, DamagedBytesGiveALocatedErrorOrAScene) {
    const std::vector<std::string> texts = seeds();
    Mutations mutations;
    for (int i = 0; i < 3000; ++i) {
        const std::string text = mutations.bytes(texts[i % texts.size()]);
        expect_located_or_read(parse(text), text);
    }
}

TEST(SceneFileFuzz, DamagedValuesGiveALocatedErrorOrASceneThatTheSchemaAccepts) {
    const json schema =
        json::parse(file_text(std::filesystem::path(HELIODON_SOURCE_DIR) / "docs" / "scene.schema.json"));
    std::vector<json> documents;
    for (const std::string& text : seeds()) documents.push_back(json::parse(text));
    Mutations mutations;
    int read = 0;
    for (int i = 0; i < 3000; ++i) {
        const json document = mutations.values(documents[i % documents.size()]);
        const std::string text = document.dump();
        const Result<Scene> scene = parse(text);
        expect_located_or_read(scene, text);
        if (!scene) continue;
        ++read;
        const auto violation = schema_violation(schema, document);
        EXPECT_FALSE(violation) << *violation << "\n" << text;
    }
    EXPECT_GT(read, 100) << "the damage should leave some files whole";
}

TEST(SceneFileFuzz, RandomOverridesGiveALocatedErrorOrAScene) {
    Mutations mutations;
    const std::vector<std::string> parts{
        "nodes", "room",  "children", "ball", "0",        "1", "99", "shape",     "radius", "light", "flux_lm",
        "sky",   "model", "cameras",  "main", "position", "2", "",   "materials", "white",  "-1",    "x"};
    const std::vector<std::string> values{"1", "-1", "[1,2,3]", "{}", "none", "null", "\"\"", "[", "1e999", "true"};
    for (int i = 0; i < 2000; ++i) {
        std::string path = parts[mutations.pick(parts.size())];
        for (std::size_t depth = mutations.pick(5); depth > 0; --depth)
            path += "." + parts[mutations.pick(parts.size())];
        const Result<Scene> scene = parse(every_block, {{path, values[mutations.pick(values.size())]}});
        if (scene) continue;
        EXPECT_TRUE(scene.error().where.starts_with("--set ") || scene.error().where.starts_with("test.json: $"))
            << scene.error().text();
    }
}

}  // namespace
}  // namespace heliodon::tests
