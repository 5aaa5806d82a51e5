#include "app/program.h"

namespace heliodon::tests {
namespace {

class Usage : public ProgramTest {};

TEST_F(Usage, VersionIsPrinted) {
    const Ended ended = run({"--version"});
    EXPECT_EQ(ended.code, 0);
    EXPECT_EQ(ended.output.rfind("heliodon ", 0), 0u) << ended.output;
}

TEST_F(Usage, HelpStandsOnStandardOutputForEveryCommand) {
    const Ended overview = run({"--help"});
    EXPECT_EQ(overview.code, 0);
    for (const std::string command : {"view", "render", "measure", "compare", "bench", "sun", "info", "devices"}) {
        EXPECT_NE(overview.output.find(command), std::string::npos) << command;
        const Ended help = run({command, "--help"});
        EXPECT_EQ(help.code, 0) << command;
        EXPECT_FALSE(help.output.empty()) << command;
        EXPECT_TRUE(help.error.empty()) << help.error;
    }
}

struct WrongUsage {
    std::string name;
    std::vector<std::string> arguments;
    std::string named;  ///< what the message must name
};
class WrongUse : public ProgramTest, public testing::WithParamInterface<WrongUsage> {};

TEST_P(WrongUse, IsOneLineAndExitCode2) {
    write("s.heliodon.json", small_scene);
    const Ended ended = run(GetParam().arguments);
    EXPECT_EQ(ended.code, 2) << ended.error;
    EXPECT_EQ(ended.error_lines(), 1) << ended.error;
    EXPECT_EQ(ended.error.rfind("heliodon: ", 0), 0u) << ended.error;
    EXPECT_NE(ended.error.find(GetParam().named), std::string::npos) << ended.error;
    EXPECT_TRUE(ended.output.empty());
    EXPECT_EQ(files(), std::vector<std::string>{"s.heliodon.json"});
}

std::vector<std::string> render_with(std::initializer_list<std::string> extra) {
    std::vector<std::string> arguments{"render", "s.heliodon.json", "-o", "o.exr"};
    arguments.insert(arguments.end(), extra);
    return arguments;
}

INSTANTIATE_TEST_SUITE_P(
    Of, WrongUse,
    testing::Values(WrongUsage{"NoCommand", {}, "required"}, WrongUsage{"UnknownCommand", {"paint"}, "\"paint\""},
                    WrongUsage{"UnknownOption", render_with({"--sice", "3x3"}), "--sice"},
                    WrongUsage{"NoScene", {"render", "-o", "o.exr"}, "SCENE"},
                    WrongUsage{"NoOutput", {"render", "s.heliodon.json"}, "--output"},
                    WrongUsage{"SizeZero", render_with({"--size", "0x0"}), "0x0"},
                    WrongUsage{"SizeNegative", render_with({"--size", "-4x4"}), "-4x4"},
                    WrongUsage{"SizeHuge", render_with({"--size", "100000x100000"}), "100000x100000"},
                    WrongUsage{"SizeWithoutHeight", render_with({"--size", "640"}), "640"},
                    WrongUsage{"SizeWithRest", render_with({"--size", "64x64x"}), "64x64x"},
                    WrongUsage{"Engine", render_with({"--engine", "raster"}), "\"raster\""},
                    WrongUsage{"GlobalIllumination", render_with({"--gi", "magic"}), "\"magic\""},
                    WrongUsage{"GlobalIlluminationNotYet", render_with({"--gi", "probes"}), "\"probes\""},
                    WrongUsage{"GlobalIlluminationOfPaths", render_with({"--engine", "path", "--gi", "vct"}), "--gi"},
                    WrongUsage{"VoxelsNoPowerOfTwo", render_with({"--voxels", "100"}), "\"100\""},
                    WrongUsage{"VoxelsTooMany", render_with({"--gi", "vct", "--voxels", "1024"}), "\"1024\""},
                    WrongUsage{"VoxelsOfPaths", render_with({"--engine", "path", "--voxels", "64"}), "--voxels"},
                    WrongUsage{"AovOfNoVolume", render_with({"--aov", "albedo,voxels"}), "--gi vct"},
                    WrongUsage{"AovOfNoVolumeAskedFor", render_with({"--gi", "none", "--aov", "voxels"}), "--gi vct"},
                    WrongUsage{"AovOfPicturesInPaths", render_with({"--engine", "path", "--aov", "ao"}), "--engine realtime"},
                    WrongUsage{"AovOfNoVolumeInPaths", render_with({"--engine", "path", "--aov", "opacity"}), "--gi vct"},
                    WrongUsage{"BenchWithoutName", {"bench"}, "NAME"},
                    WrongUsage{"BenchUnknown", {"bench", "quake"}, "\"quake\""},
                    WrongUsage{"BenchGrid", {"bench", "natus", "--voxels", "64,100"}, "\"100\""},
                    WrongUsage{"BenchGridTwice", {"bench", "natus", "--voxels", "64,64"}, "once"},
                    WrongUsage{"BenchTest", {"bench", "natus", "--tests", "4,6"}, "\"6\""},
                    WrongUsage{"BenchFramesZero", {"bench", "natus", "--frames", "0"}, "--frames"},
                    WrongUsage{"BenchTimeNegative", {"bench", "natus", "--path-seconds", "-1"}, "--path-seconds"},
                    WrongUsage{"BenchFlyMode", {"bench", "fly", "--tests", "simple,dust"}, "\"dust\""},
                    WrongUsage{"BenchSeries", {"bench", "cost", "--series", "lights,dust"}, "\"dust\""},
                    WrongUsage{"BenchGridsOfCost", {"bench", "cost", "--voxels", "64,128"}, "--voxels"},
                    WrongUsage{"BenchSceneOfCost", {"bench", "cost", "--scene", "s.heliodon.json"}, "--scene"},
                    WrongUsage{"BenchGridOfFly", {"bench", "fly", "--voxels", "64"}, "--voxels: expected with natus or cost"},
                    WrongUsage{"BenchTestsOfShadowVolumes", {"bench", "shadow-volumes", "--tests", "1"}, "--tests"},
                    WrongUsage{"BenchSizeOfCie171", {"bench", "cie171", "--size", "64x64"}, "--size"},
                    WrongUsage{"BenchSize", {"bench", "natus", "--size", "64"}, "\"64\""},
                    WrongUsage{"BenchOverridesOfTheBuiltInScene", {"bench", "natus", "--set", "render.bounces=1"}, "--scene"},
                    WrongUsage{"ToneCurve", render_with({"--tonemap", "film"}), "\"film\""},
                    WrongUsage{"Exposure", render_with({"--ev100", "bright"}), "\"bright\""},
                    WrongUsage{"FalseColourBackwards", render_with({"--false-colour", "9:3"}), "9:3"},
                    WrongUsage{"FalseColourLogarithmOfNothing", render_with({"--false-colour", "0:3:log"}), "0:3:log"},
                    WrongUsage{"FalseColourOfNoUnit", render_with({"--false-colour", "0:3:lumen"}), "0:3:lumen"},
                    WrongUsage{"ProbeOutside", render_with({"--size", "64x64", "--probe", "64,3"}), "64,3"},
                    WrongUsage{"Probe", render_with({"--probe", "middle"}), "middle"},
                    WrongUsage{"AovTwice", render_with({"--aov", "albedo,albedo"}), "once"},
                    WrongUsage{"Aov", render_with({"--aov", "albedo,beauty"}), "\"beauty\""},
                    WrongUsage{
                        "AovWithoutExr", {"render", "s.heliodon.json", "-o", "o.png", "--aov", "albedo"}, "--aov"},
                    WrongUsage{"SamplesZero", render_with({"--engine", "path", "--spp", "0"}), "--spp"},
                    WrongUsage{"TargetErrorZero", render_with({"--engine", "path", "--target-error", "0"}), "--target-error"},
                    WrongUsage{"TargetErrorInRealTime", render_with({"--target-error", "0.1"}), "--engine path"},
                    WrongUsage{"ResumeInRealTime", render_with({"--resume"}), "--engine path"},
                    WrongUsage{"ResumeOfFrames", render_with({"--engine", "path", "--resume", "--frames", "1..2"}), "--frames"},
                    WrongUsage{"VarianceInRealTime", render_with({"--aov", "variance"}), "--engine path"},
                    WrongUsage{"DepthForRealtime", render_with({"--max-depth", "3"}), "--max-depth"},
                    WrongUsage{"Frames", render_with({"--frames", "9..3"}), "9..3"},
                    WrongUsage{"Override", render_with({"--set", "render.gi"}), "render.gi"},
                    WrongUsage{"SeedNegative", render_with({"--seed", "-1"}), "--seed"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace heliodon::tests
