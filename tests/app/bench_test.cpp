// `heliodon bench`: what it measures and says. How long it takes is not tested.
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "app/program.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

class Bench : public ProgramTest {
protected:
    /// The table of a tiny run; empty, and a failed test, where it went wrong.
    [[nodiscard]] json measure(std::initializer_list<std::string> extra) const {
        std::vector<std::string> arguments{"bench", "natus",    "--size", "32x24", "--voxels",
                                           "32",    "--frames", "2",      "--json"};
        arguments.insert(arguments.end(), extra);
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 0) << ended.error;
        return ended.code == 0 ? json::parse(ended.output) : json::object();
    }
    /// Two walls, one of them glowing with `emission` cd/m², and `nodes` besides.
    [[nodiscard]] static std::string walls(const char* emission, const char* nodes) {
        return fmt::format(R"({{"heliodon": 1, "cameras": [{{"name": "c"}}], "render": {{"shadow_map_size": 128}},
          "materials": {{"wall": {{"model": "lambert", "emission_nits": {}}}}},
          "nodes": [{{"shape": {{"type": "quad", "origin": [-1,0,-1], "u": [2,0,0], "v": [0,2,0]}}, "material": "wall"}},
                    {{"shape": {{"type": "quad", "origin": [-1,0,-1], "u": [0,0,2], "v": [2,0,0]}}}}{}]}})",
                           emission, nodes);
    }
    static std::set<int> tests_of(const json& table) {
        std::set<int> numbers;
        for (const json& row : table["timings"]) numbers.insert(row["test"].get<int>());
        return numbers;
    }
    static constexpr const char* bulb = R"(, {"light": {"type": "point", "intensity_cd": 9}, "translate": [0,1,0]})";
};

TEST_F(Bench, MeasuresEveryTestOfASceneAndItsStepsAddUp) {
    write("s.heliodon.json", walls("0", bulb));
    write("s-emissive.heliodon.json", walls("60", ""));
    const json table = measure({"--scene", "s.heliodon.json", "--path-seconds", "0.5"});
    ASSERT_TRUE(table.contains("timings"));
    std::set<std::string> rows;
    std::map<std::string, double> voxelize_ms;
    for (const json& row : table["timings"]) {
        rows.insert(fmt::format("{} {} {}", row["test"].dump(), row["voxels"].dump(), row["revoxelize"].dump()));
        EXPECT_GT(row["frame_mean_ms"], 0);
        double steps = 0;
        for (const auto& [name, ms] : row["steps"].items()) steps += ms.get<double>();
        // The sum of medians is not the median of the sum, and a busy machine varies.
        EXPECT_GT(steps, 0.4 * row["frame_median_ms"].get<double>()) << row.dump();
        EXPECT_LT(steps, 2.5 * row["frame_median_ms"].get<double>()) << row.dump();
        const bool volume = row["test"] != 1;
        EXPECT_EQ(row["steps"]["cone_trace_ms"] > 0, volume) << row.dump();
        voxelize_ms[row["revoxelize"].dump()] += row["steps"]["voxelize_ms"].get<double>();
    }
    EXPECT_EQ(voxelize_ms["null"], 0);
    EXPECT_GT(voxelize_ms["\"always\""], 4 * voxelize_ms["\"once\""]) << "which only empties what it lights anew";
    std::set<std::string> expected{"1 null null"};
    for (const char* test : {"2", "3", "4", "5"})
        for (const char* when : {"always", "once"}) expected.insert(fmt::format("{} 32 \"{}\"", test, when));
    EXPECT_EQ(rows, expected);
    EXPECT_EQ(table["timings"][0]["published_gtx_960_ms"], 4.09);
    EXPECT_EQ(table["published_steps_gtx_960"]["voxelize_ms"], 1.96);

    const json equal = table["equal_error"];
    ASSERT_TRUE(equal.is_object());
    EXPECT_GT(equal["frame_relmse"], 0);
    EXPECT_GT(equal["reference_spp"], equal["path_measured"][1]["spp"]);
    EXPECT_EQ(equal["path_measured"].size(), 2u);
    EXPECT_GT(equal["path_measured"][0]["relmse"], equal["path_measured"][1]["relmse"]) << "error falls with samples";
    // Without the reference's noise the error is a/N, nothing else: N times it is the same.
    double scaled[2], certain[2];
    for (int i = 0; i < 2; ++i) {
        const json& path = equal["path_measured"][i];
        scaled[i] = path["spp"].get<double>() * path["relmse"].get<double>();
        certain[i] = path["spp"].get<double>() * path["relmse_half_width_95"].get<double>();
    }
    EXPECT_NEAR(scaled[0], scaled[1], 2 * (certain[0] + certain[1])) << equal.dump();
    if (equal["path_seconds"].is_null()) return;  // half a second may be too short to tell, and that is said
    const double ratio = equal["path_seconds"].get<double>() * 1000 / equal["frame_mean_ms"].get<double>();
    EXPECT_NEAR(equal["path_over_frame"], ratio, 1e-6 * ratio);
}

TEST_F(Bench, TakesTheTestsThatTheSceneAndTheUserAskFor) {
    write("s.heliodon.json", walls("0", bulb));
    const json lit = measure({"--scene", "s.heliodon.json", "--path-seconds", "0", "--set", "render.bounces=1"});
    EXPECT_EQ(tests_of(lit), (std::set<int>{1, 2, 3, 4})) << "no emissive scene lies beside it";
    EXPECT_TRUE(lit["equal_error"].is_null());
    write("e.heliodon.json", walls("60", ""));
    EXPECT_EQ(tests_of(measure({"--scene", "e.heliodon.json", "--path-seconds", "0"})), (std::set<int>{5}));
    const json direct = measure({"--tests", "1"});
    EXPECT_EQ(tests_of(direct), (std::set<int>{1}));
    EXPECT_NEAR(direct["triangles"].get<double>(), 450e3, 10e3) << "of the built-in scene";
    EXPECT_EQ(files(), (std::vector<std::string>{"e.heliodon.json", "s.heliodon.json"}));
}

TEST_F(Bench, CostHasARowForEachAmountOfWork) {
    const Ended ended =
        run({"bench", "cost", "--series", "pixels", "--size", "32x24", "--voxels", "32", "--frames", "1", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json series = json::parse(ended.output)["series"];
    ASSERT_EQ(series.size(), 1u);
    std::vector<int> pixels;
    for (const json& row : series[0]["rows"]) pixels.push_back(row["pixels"].get<int>());
    EXPECT_EQ(pixels, (std::vector<int>{16 * 12, 32 * 24, 64 * 48}));
    EXPECT_TRUE(series[0]["rows"][0]["time_over_work"].is_null());
    EXPECT_GT(series[0]["rows"][2]["time_over_work"], 0);
}

TEST_F(Bench, FlyTimesEachSceneInEveryModeAndSaysWhatIsNotThere) {
    write("s.heliodon.json", walls("0", bulb));
    const Ended ended =
        run({"bench", "fly", "--size", "32x24", "--frames", "2", "--json", "--scene", "s.heliodon.json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json table = json::parse(ended.output);
    ASSERT_EQ(table["models"].size(), 1u);
    EXPECT_EQ(table["models"][0]["triangles"], 4);
    std::map<std::string, json> modes;
    for (const json& mode : table["models"][0]["modes"]) modes[mode["mode"]] = mode;
    EXPECT_EQ(modes.size(), 5u);
    EXPECT_TRUE(modes["light_maps"]["frames_a_second"].is_null());
    EXPECT_EQ(modes["light_maps"]["note"], "not there yet");
    for (const char* mode : {"simple", "sunlight", "sunlight_redrawn", "sunlight_volumes"}) {
        EXPECT_NEAR(modes[mode]["frames_a_second"].get<double>() * modes[mode]["frame_median_ms"].get<double>(), 1000,
                    0.1);
        EXPECT_TRUE(modes[mode]["published_frames_a_second"].is_null()) << "of no published model";
    }
    EXPECT_GE(modes["sunlight_redrawn"]["shadow_maps_drawn"], 2) << "one a frame at least";
    for (const char* mode : {"simple", "sunlight", "sunlight_volumes"})
        EXPECT_EQ(modes[mode]["shadow_maps_drawn"], 0) << mode << ": drawn before it was timed, if at all";
}

TEST_F(Bench, FlyHasThePublishedModels) {
    const Ended ended = run({"bench", "fly", "--size", "16x12", "--frames", "1", "--tests", "simple", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json models = json::parse(ended.output)["models"];
    ASSERT_EQ(models.size(), 3u);
    const double triangles[] = {138e3, 107e3, 313e3}, simple[] = {33, 33, 24}, maps[] = {35, 38, 26};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(models[i]["triangles"].get<double>(), triangles[i], 5e-3 * triangles[i]);
        ASSERT_EQ(models[i]["modes"].size(), 2u);
        EXPECT_EQ(models[i]["modes"][0]["published_frames_a_second"], simple[i]);
        EXPECT_EQ(models[i]["modes"][1]["published_frames_a_second"], maps[i]);
    }
}

TEST_F(Bench, ShadowVolumesAreComparedByTheTrianglesTheyStandBehind) {
    write("s.heliodon.json",
          walls("0", R"(, {"light": {"type": "directional", "illuminance_lux": 9, "direction": [1,-3,-2]}})"));
    const Ended ended =
        run({"bench", "shadow-volumes", "--size", "32x24", "--frames", "1", "--json", "--scene", "s.heliodon.json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json rows = json::parse(ended.output)["volumes"];
    ASSERT_EQ(rows.size(), 3u);
    for (const json& row : rows) {
        EXPECT_EQ(row["opaque_triangles"], 4);
        EXPECT_EQ(row["different_pixels"], 0);
        EXPECT_LE(rows[1]["sides"], row["sides"]) << "of lit and joined triangles, or whatever has fewest";
    }
    write("dark.heliodon.json", walls("0", bulb));
    EXPECT_EQ(run({"bench", "shadow-volumes", "--size", "32x24", "--scene", "dark.heliodon.json"}).code, 1);
}

TEST_F(Bench, SaysWhereNoneOfTheTestsAskedForIsOfTheScene) {
    write("s.heliodon.json", walls("0", bulb));
    const Ended ended = run({"bench", "natus", "--scene", "s.heliodon.json", "--tests", "5"});
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(ended.error.rfind("heliodon: s.heliodon.json: expected lights", 0), 0u) << ended.error;
    EXPECT_TRUE(ended.output.empty());
}

TEST_F(Bench, RefusesASceneThatIsNotThereWithOneLine) {
    const Ended ended = run({"bench", "natus", "--scene", "absent.heliodon.json"});
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(ended.error_lines(), 1) << ended.error;
    EXPECT_NE(ended.error.find("absent.heliodon.json"), std::string::npos) << ended.error;
    EXPECT_TRUE(ended.output.empty());
}

}  // namespace
}  // namespace heliodon::tests
