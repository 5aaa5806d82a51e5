#include <cmath>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "core/image_io.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

class Commands : public ProgramTest {
protected:
    /// Starts a render that takes forever and interrupts it. On a busy machine the signal may come before the program is
    /// ready for it: then later.
    [[nodiscard]] Ended interrupt(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"render", "s.heliodon.json", "--spp", "10000000", "--size", "64x64"});
        Ended ended;
        for (int seconds = 1; seconds <= 16 && ended.error.empty(); seconds *= 2)
            ended = run(arguments, "timeout --foreground --preserve-status --signal INT " + std::to_string(seconds));
        return ended;
    }
    void SetUp() override {
        ProgramTest::SetUp();
        write("s.heliodon.json", small_scene);
    }
    [[nodiscard]] Ended render(std::vector<std::string> extra) const {
        std::vector<std::string> arguments{"render", "s.heliodon.json", "--size", "48x32", "--spp", "4"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        return run(arguments);
    }
};

std::vector<std::string> keys(const json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;  // nlohmann::json holds them sorted
}

TEST_F(Commands, RenderWritesEveryOutputAndTheExrStoresItsExposure) {
    const Ended ended =
        render({"--engine", "path", "-o", "a.exr", "-o", "a.png", "-o", "a.hdr", "-o", "a.pfm", "-o", "a.jpg"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm", "a.jpg"}) {
        const auto picture = read_picture(folder() / name);
        ASSERT_TRUE(picture) << picture.error().text();
        EXPECT_EQ(picture->image.width, 48) << name;
        EXPECT_EQ(picture->image.height, 32) << name;
    }
    const auto picture = read_picture(folder() / "a.exr");
    EXPECT_TRUE(picture->has_ev100);
    EXPECT_FLOAT_EQ(picture->ev100, 5.0f);
}

TEST_F(Commands, TheCameraAndTheExposureAreChosenByOption) {
    ASSERT_EQ(render({"--engine", "path", "--camera", "above", "-o", "a.exr"}).code, 0);
    EXPECT_FLOAT_EQ(read_picture(folder() / "a.exr")->ev100, 6.0f);
    ASSERT_EQ(render({"--engine", "path", "--ev100", "-2.5", "-o", "b.exr"}).code, 0);
    EXPECT_FLOAT_EQ(read_picture(folder() / "b.exr")->ev100, -2.5f);
}

TEST_F(Commands, TheSameCommandGivesTheSamePictureWhateverTheThreadCount) {
    ASSERT_EQ(render({"--engine", "path", "--threads", "1", "-o", "a.exr"}).code, 0);
    ASSERT_EQ(render({"--engine", "path", "--threads", "3", "-o", "b.exr"}).code, 0);
    ASSERT_EQ(render({"--engine", "path", "--seed", "7", "-o", "c.exr"}).code, 0);
    EXPECT_EQ(read_picture(folder() / "a.exr")->image.pixels, read_picture(folder() / "b.exr")->image.pixels);
    EXPECT_NE(read_picture(folder() / "a.exr")->image.pixels, read_picture(folder() / "c.exr")->image.pixels);
}

TEST_F(Commands, AnInterruptedRealTimeRenderWritesNothing) {
    const Ended ended = interrupt({"--engine", "realtime", "-o", "a.exr"});
    EXPECT_EQ(ended.code, 130) << ended.error;
    EXPECT_EQ(ended.error, "heliodon: interrupted\n");
    EXPECT_EQ(files(), std::vector<std::string>{"s.heliodon.json"});
}

TEST_F(Commands, AnInterruptedPathTracedPictureIsWrittenAndGoneOnFrom) {
    const Ended ended = interrupt({"--engine", "path", "-o", "a.exr", "-o", "a.png"});
    EXPECT_EQ(ended.code, 130) << ended.error;
    EXPECT_EQ(ended.error_lines(), 1);
    EXPECT_NE(ended.error.find("the picture so far, and --resume goes on from a.exr"), std::string::npos) << ended.error;
    EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "a.png", "s.heliodon.json"}));
    const auto before = read_picture(folder() / "a.exr");
    ASSERT_TRUE(before) << before.error().text();
    const Ended more = run({"render", "s.heliodon.json", "--engine", "path", "--size", "64x64", "--seconds", "0.2",
                            "--resume", "-o", "a.exr"});
    ASSERT_EQ(more.code, 0) << more.error;
    const auto after = read_picture(folder() / "a.exr");
    EXPECT_GT(std::stoi(after->attributes.at("resume.samples")), std::stoi(before->attributes.at("resume.samples")));
}

TEST_F(Commands, ResumingGivesTheSameBitsAsAllSamplesAtOnce) {
    const auto path = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"render", "s.heliodon.json", "--engine", "path", "--size", "24x16"});
        return run(arguments);
    };
    ASSERT_EQ(path({"--spp", "6", "--resume", "-o", "a.exr"}).code, 0) << "nothing there yet";
    ASSERT_EQ(path({"--spp", "20", "--resume", "-o", "a.exr"}).code, 0);
    ASSERT_EQ(path({"--spp", "20", "-o", "b.exr"}).code, 0);
    const auto resumed = read_picture(folder() / "a.exr"), at_once = read_picture(folder() / "b.exr");
    EXPECT_EQ(resumed->image.pixels, at_once->image.pixels);
    EXPECT_TRUE(at_once->layers.empty()) << "state that nobody asked for";
    const Ended other = path({"--seed", "3", "--resume", "-o", "a.exr"});
    EXPECT_EQ(other.code, 1);
    EXPECT_EQ(other.error, "heliodon: a.exr: cannot go on with another seed: expected 3, found 0\n");
    const Ended stateless = path({"--resume", "-o", "b.exr"});
    EXPECT_EQ(stateless.code, 1);
    EXPECT_EQ(stateless.error.find("heliodon: b.exr: expected a picture of an interrupted"), 0u) << stateless.error;
}

TEST_F(Commands, ATargetErrorSaysHowFarItGot) {
    const auto path = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"render", "s.heliodon.json", "--engine", "path", "--size", "24x16", "--json"});
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 0) << ended.error;
        return json::parse(ended.output);
    };
    const json reached = path({"--target-error", "0.1", "--aov", "variance,samples", "-o", "a.exr"});
    EXPECT_EQ(reached["target_reached"], 1);
    EXPECT_GE(reached["spp_mean"], 32);
    EXPECT_LE(reached["spp_mean"], reached["spp"]);
    EXPECT_EQ(path({"--target-error", "1e-9", "--spp", "40", "-o", "b.exr"})["spp"], 40);
}

TEST_F(Commands, LayersAreWrittenIntoTheExr) {
    const Ended ended = render({"--engine", "path", "--aov", "albedo,depth", "-o", "a.exr"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const auto picture = read_picture(folder() / "a.exr");
    ASSERT_EQ(picture->layers.size(), 2u);
    EXPECT_EQ(picture->layers[0].name, "albedo");
    EXPECT_EQ(picture->layers[1].name, "depth");
}

TEST_F(Commands, StatisticsOfThePathEngineHaveTheDesignsKeys) {
    const Ended ended = render({"--engine", "path", "--stats", "n.json", "--json", "-o", "a.exr"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json stats = json::parse(read_text(folder() / "n.json"));
    EXPECT_EQ(keys(stats), (std::vector<std::string>{"peak_rss_bytes", "rays_per_second", "seconds", "spp"}));
    EXPECT_EQ(stats["spp"], 4);
    EXPECT_GT(stats["rays_per_second"], 0);
    EXPECT_EQ(json::parse(ended.output), stats);
}

TEST_F(Commands, StatisticsOfTheRealtimeEngineHaveTheDesignsKeys) {
    const Ended ended = render({"--frames-timed", "3", "--stats", "n.json", "-o", "a.exr"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json stats = json::parse(read_text(folder() / "n.json"));
    // Beside the design's: vertex_bytes, which shows what convert.vertex_precision saves, and what filtering the sky took.
    EXPECT_EQ(keys(stats), (std::vector<std::string>{"cpu_ms", "device", "gpu_memory_bytes", "gpu_ms_total", "passes",
                                                     "peak_rss_bytes", "sky_gpu_ms", "sky_passes", "vertex_bytes"}));
    EXPECT_GT(stats["vertex_bytes"], 0);
    EXPECT_FALSE(stats["passes"].empty());
    for (const json& pass : stats["passes"]) EXPECT_EQ(keys(pass), (std::vector<std::string>{"gpu_ms", "name"}));
    EXPECT_GT(stats["gpu_ms_total"], 0);
}

TEST_F(Commands, FramesAreNumberedAndTheAnimationMovesBetweenThem) {
    json scene = json::parse(small_scene);
    scene["animations"] = json::parse(R"([{ "name": "dim", "channels": [
        { "target": "nodes.bulb.light.intensity_cd", "times_s": [0, 1], "values": [[400, 400, 400], [100, 100, 100]] }] }])");
    write("s.heliodon.json", scene.dump());
    const Ended ended =
        render({"--engine", "path", "--frames", "0..2", "--fps", "2", "--stats", "n.json", "-o", "a.exr"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const auto first = read_picture(folder() / "a-0000.exr"), last = read_picture(folder() / "a-0002.exr");
    ASSERT_TRUE(first && last && exists("a-0001.exr"));
    EXPECT_FALSE(exists("a.exr"));
    const int below = first->image.height - 4;  // the floor
    EXPECT_NEAR(last->image.rgb(24, below).g, 0.25f * first->image.rgb(24, below).g,
                0.02f * first->image.rgb(24, below).g);
    EXPECT_EQ(json::parse(read_text(folder() / "n.json"))["frames"].size(), 3u);
}

TEST_F(Commands, ASceneThatAsksForGlobalIlluminationIsRenderedDirectWithOneWarning) {
    const Ended ended = render({"--set", "render.gi=probes", "-o", "a.exr"});
    EXPECT_EQ(ended.code, 0) << ended.error;
    EXPECT_NE(ended.error.find("heliodon: warning: s.heliodon.json: render.gi \"probes\""), std::string::npos)
        << ended.error;
}

TEST_F(Commands, MeasureGivesTheInverseSquareLawWithBothEngines) {
    for (const std::string engine : {"path", "realtime"}) {
        const Ended ended = run({"measure", "s.heliodon.json", "--engine", engine, "--spp", "64", "--json"});
        ASSERT_EQ(ended.code, 0) << ended.error;
        const json sensors = json::parse(ended.output)["sensors"];
        ASSERT_EQ(sensors.size(), 1u);
        EXPECT_EQ(keys(sensors[0]),
                  (std::vector<std::string>{"half_width_95", "name", "rgb", "type", "unit", "value"}));
        // The sensor stands off the floor by 10⁻⁴ of the scene's size, the diagonal of 4 m × 4 m.
        const double distance = 2 - 1e-4 * std::sqrt(32.0);
        EXPECT_NEAR(sensors[0]["value"], 400 / (distance * distance), 1e-3) << engine;
        EXPECT_EQ(sensors[0]["unit"], "lux");
        EXPECT_EQ(sensors[0]["type"], "illuminance");
        EXPECT_EQ(sensors[0]["rgb"].size(), 3u);
    }
}

TEST_F(Commands, MeasurePrintsCsvWithQuotedNames) {
    const Ended ended = run({"measure", "s.heliodon.json", "--spp", "64"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    EXPECT_EQ(ended.output.rfind("name,type,value,r,g,b,unit,half_width_95\n\"under, the bulb\",illuminance,", 0), 0u)
        << ended.output;
}

TEST_F(Commands, CompareHasOneKeyAMetricAndWritesAHeatMap) {
    Picture reference, test;
    reference.image = Image(32, 24, 3, 0.5f);
    test.image = Image(32, 24, 3, 0.25f);
    ASSERT_TRUE(write_picture(folder() / "r.exr", reference));
    ASSERT_TRUE(write_picture(folder() / "t.exr", test));
    const Ended ended = run({"compare", "r.exr", "t.exr", "--json", "--heatmap", "h.png"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json metrics = json::parse(ended.output);
    EXPECT_EQ(keys(metrics),
              (std::vector<std::string>{"flip", "mae", "median_relative", "mse", "psnr", "relmse", "rmse", "ssim"}));
    // Published: constants .5 against .25 without exposure.
    EXPECT_NEAR(metrics["psnr"], 12.0412, 1e-3);
    EXPECT_NEAR(metrics["relmse"], 0.240385, 1e-5);
    EXPECT_EQ(read_picture(folder() / "h.png")->image.width, 32);
}

TEST_F(Commands, CompareShowsWhereTheTestIsDarkerAndWhereBrighter) {
    Picture reference, test;
    reference.image = Image(16, 16, 3, 0.5f);
    test.image = reference.image;
    for (int c = 0; c < 3; ++c) {
        test.image.at(0, 0, c) = 0;
        test.image.at(1, 0, c) = 1;
    }
    ASSERT_TRUE(write_picture(folder() / "r.exr", reference));
    ASSERT_TRUE(write_picture(folder() / "t.exr", test));
    ASSERT_EQ(run({"compare", "r.exr", "t.exr", "--difference", "d.png"}).code, 0);
    ASSERT_EQ(run({"compare", "r.exr", "t.exr", "--difference", "d.exr"}).code, 0);
    const auto shown = read_picture(folder() / "d.png"), values = read_picture(folder() / "d.exr");
    ASSERT_TRUE(shown && values);
    EXPECT_GT(shown->image.at(0, 0, 2), shown->image.at(0, 0, 0)) << "darker: blue";
    EXPECT_GT(shown->image.at(1, 0, 0), shown->image.at(1, 0, 2)) << "brighter: red";
    EXPECT_FLOAT_EQ(shown->image.at(2, 0, 1), 1) << "equal: white";
    EXPECT_FLOAT_EQ(values->image.at(0, 0, 1), -0.5f);
}

TEST_F(Commands, CompareTakesTheStoredExposureUnlessOneIsGiven) {
    Picture reference, test;
    reference.ev100 = std::log2(10.0f / 1.2f);
    reference.has_ev100 = true;
    reference.image = Image(16, 16, 3, 5.0f);
    test.image = Image(16, 16, 3, 2.5f);
    ASSERT_TRUE(write_picture(folder() / "r.exr", reference));
    ASSERT_TRUE(write_picture(folder() / "t.exr", test));
    EXPECT_NEAR(json::parse(run({"compare", "r.exr", "t.exr", "--json"}).output)["rmse"], 0.25, 1e-5);
    EXPECT_NEAR(json::parse(run({"compare", "r.exr", "t.exr", "--json", "--ev100", "0"}).output)["rmse"], 2.5 / 1.2,
                1e-4);
}

TEST_F(Commands, CompareRefusesPicturesOfDifferentSizesAndNamesBoth) {
    Picture reference, test;
    reference.image = Image(16, 16, 3);
    test.image = Image(16, 8, 3);
    ASSERT_TRUE(write_picture(folder() / "r.exr", reference));
    ASSERT_TRUE(write_picture(folder() / "t.exr", test));
    const Ended ended = run({"compare", "r.exr", "t.exr"});
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(ended.error_lines(), 1) << ended.error;
    EXPECT_NE(ended.error.find("16"), std::string::npos) << ended.error;
    EXPECT_NE(ended.error.find("8"), std::string::npos) << ended.error;
}

TEST_F(Commands, InfoCountsAndGivesTheFluxOfLights) {
    const Ended ended = run({"info", "s.heliodon.json", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json report = json::parse(ended.output);
    EXPECT_EQ(report["nodes"], 2);
    EXPECT_EQ(report["triangles"], 2);
    EXPECT_EQ(report["bounds_m"]["max"], json::parse("[2.0, 0.0, 2.0]"));
    ASSERT_EQ(report["lights"].size(), 1u);
    EXPECT_NEAR(report["lights"][0]["flux_lm"], 4 * 3.14159265 * 400, 0.01);
    EXPECT_TRUE(report["warnings"].empty());
    const Ended text = run({"info", "s.heliodon.json"});
    EXPECT_EQ(text.code, 0);
    EXPECT_NE(text.output.find("bulb"), std::string::npos);
}

TEST_F(Commands, InfoSaysWhatAPhotometricFileMeasuresAndWhereItContradictsItself) {
    write("down.ies", "IESNA:LM-63-2002\n[LUMINAIRE] Downlight\nTILT=NONE\n1 50 1 2 1 1 2 -.2 -.2 0\n1 1 10\n0 180\n0\n10 10\n");
    const Ended ended = run({"info", "down.ies", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json report = json::parse(ended.output);
    const json& light = report["lights"][0];
    EXPECT_EQ(light["luminaire"], "Downlight");
    EXPECT_NEAR(light["flux_lm"], 4 * 3.14159265 * 10, 1e-3);
    EXPECT_EQ(light["measured_peak_cd"], 10);
    EXPECT_EQ(light["opening"], "disc");
    bool doubted = false;
    for (const json& warning : report["warnings"]) doubted |= warning.get<std::string>().find("more than the 50.0 lm") != std::string::npos;
    EXPECT_TRUE(doubted);
    EXPECT_NE(run({"info", "down.ies"}).output.find("125.664 lm"), std::string::npos);
}

TEST_F(Commands, DevicesAreListedWithWhatTheySupport) {
    const Ended ended = run({"devices", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json devices = json::parse(ended.output)["devices"];
    ASSERT_FALSE(devices.empty());
    for (const json& device : devices) {
        EXPECT_TRUE(device["name"].is_string());
        EXPECT_TRUE(device["usable"].is_boolean());
        EXPECT_TRUE(device["ray_query"].is_boolean());
        EXPECT_GT(device["memory_bytes"], 0);
    }
}

}  // namespace
}  // namespace heliodon::tests
