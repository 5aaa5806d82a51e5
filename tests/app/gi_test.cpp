// Voxel cone tracing as the command line asks for it. How right its light is, tests/realtime says.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "core/image_io.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

class GlobalIllumination : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        // A white corner: the wall lights the floor and the floor the wall.
        write("s.heliodon.json", R"({ "heliodon": 1,
          "cameras": [{ "name": "main", "position": [0, 1, 3], "target": [0, 0.5, 0], "ev100": 5 }],
          "materials": { "white": { "model": "lambert", "base_color": [0.8, 0.8, 0.8] } },
          "nodes": [
            { "shape": { "type": "quad", "origin": [-1, 0, -1], "u": [0, 0, 2], "v": [2, 0, 0] }, "material": "white" },
            { "shape": { "type": "quad", "origin": [-1, 0, -1], "u": [2, 0, 0], "v": [0, 2, 0] }, "material": "white" },
            { "name": "bulb", "light": { "type": "point", "intensity_cd": 100 }, "translate": [0, 1, 0.3] }],
          "sensors": [{ "name": "floor", "type": "illuminance", "position": [0, 0, -0.6], "normal": [0, 1, 0] }],
          "render": { "shadow_map_size": 256 } })");
    }
    /// The picture of a render with `extra` options; empty, and a failed test, where it went wrong.
    [[nodiscard]] Picture render(std::vector<std::string> extra) const {
        std::vector<std::string> arguments{"render", "s.heliodon.json", "--size", "32x24", "--spp", "2", "-o", "a.exr"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 0) << ended.error;
        auto picture = ended.code == 0 ? read_picture(folder() / "a.exr") : Result<Picture>();
        return picture ? *std::move(picture) : Picture{};
    }
    static float mean(const Image& image) {
        float sum = 0;
        for (const float value : image.pixels) sum += value;
        return sum / static_cast<float>(std::max<std::size_t>(1, image.pixels.size()));
    }
};

TEST_F(GlobalIllumination, TheOptionsAndTheSceneAskForTheSameLightAndTheOptionsWin) {
    const Picture by_option = render({"--gi", "vct", "--voxels", "32"});
    EXPECT_EQ(by_option.image.pixels, render({"--set", "render.gi=vct", "--set", "render.voxels=32"}).image.pixels);
    EXPECT_EQ(
        by_option.image.pixels,
        render({"--set", "render.gi=none", "--set", "render.voxels=64", "--gi", "vct", "--voxels", "32"}).image.pixels);
    const Picture direct = render({});
    EXPECT_EQ(direct.image.pixels, render({"--set", "render.gi=vct", "--gi", "none"}).image.pixels);
    EXPECT_GT(mean(by_option.image), 1.05f * mean(direct.image));
}

TEST_F(GlobalIllumination, EachEffectIsSwitchedByAnOverride) {
    const Picture direct = render({});
    const Picture no_diffuse = render({"--gi", "vct", "--voxels", "32", "--set", "render.vct.diffuse=false"});
    EXPECT_NEAR(mean(no_diffuse.image), mean(direct.image), 1e-3f * mean(direct.image))
        << "rough surfaces have no other";
    const Picture one = render({"--gi", "vct", "--voxels", "32", "--set", "render.bounces=1"});
    const Picture all = render({"--gi", "vct", "--voxels", "32", "--set", "render.bounces=inf"});
    EXPECT_GT(mean(one.image), 1.02f * mean(direct.image));
    EXPECT_GT(mean(all.image), 1.01f * mean(one.image));
}

TEST_F(GlobalIllumination, LayersShowTheVolume) {
    const Picture picture = render({"--gi", "vct", "--voxels", "32", "--aov", "ao,voxels,opacity,indirect"});
    ASSERT_EQ(picture.layers.size(), 4u);
    for (const Layer& layer : picture.layers) {
        const auto [low, high] = std::minmax_element(layer.image.pixels.begin(), layer.image.pixels.end());
        EXPECT_GE(*low, 0) << layer.name;
        EXPECT_GT(*high, 0) << layer.name;
        if (layer.name == "ao" || layer.name == "opacity") {
            EXPECT_LE(*high, 1.0001f) << layer.name;
        }
        EXPECT_LT(*low, *high) << layer.name;
    }
}

TEST_F(GlobalIllumination, SensorsMeasureIndirectLightToo) {
    const auto lux = [&](std::vector<std::string> extra) {
        std::vector<std::string> arguments{"measure", "s.heliodon.json", "--engine", "realtime", "--json"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 0) << ended.error;
        return ended.code == 0 ? json::parse(ended.output)["sensors"][0]["value"].get<double>() : 0.0;
    };
    const double direct = lux({"--gi", "none"}), global = lux({"--gi", "vct", "--voxels", "32"});
    EXPECT_GT(global, 1.05 * direct);
    EXPECT_EQ(lux({"--gi", "vct", "--voxels", "32", "--max-depth", "1"}), direct) << "one event is direct light";
}

TEST_F(GlobalIllumination, VoxelsOfNoVolumeAreWarnedOf) {
    const Ended ended =
        run({"render", "s.heliodon.json", "--size", "8x8", "--spp", "1", "--voxels", "64", "-o", "a.exr"});
    EXPECT_EQ(ended.code, 0) << ended.error;
    EXPECT_EQ(ended.error.rfind("heliodon: warning: --voxels: ", 0), 0u) << ended.error;
}

}  // namespace
}  // namespace heliodon::tests
