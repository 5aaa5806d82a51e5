// `heliodon bench`: what it measures and says. How long it takes is not tested.
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
        std::vector<std::string> arguments{"bench", "natus", "--size", "32x24", "--voxels", "32", "--frames", "2", "--json"};
        arguments.insert(arguments.end(), extra);
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 0) << ended.error;
        return ended.code == 0 ? json::parse(ended.output) : json::object();
    }
};

TEST_F(Bench, MeasuresEveryTestOfTheBuiltInSceneAndItsStepsAddUp) {
    const json table = measure({"--path-seconds", "0.5"});
    ASSERT_TRUE(table.contains("timings"));
    EXPECT_GT(table["triangles"], 400'000);
    std::set<std::string> rows;
    for (const json& row : table["timings"]) {
        rows.insert(fmt::format("{} {} {}", row["test"].dump(), row["voxels"].dump(), row["revoxelize"].dump()));
        EXPECT_GT(row["frame_mean_ms"], 0);
        EXPECT_GT(row["frame_median_ms"], 0);
        double steps = 0;
        for (const auto& [name, ms] : row["steps"].items()) steps += ms.get<double>();
        // The median of a sum is not the sum of medians.
        EXPECT_NEAR(steps, row["frame_median_ms"], 0.5 * row["frame_median_ms"].get<double>()) << row.dump();
        const bool volume = row["test"] != 1;
        EXPECT_EQ(row["steps"]["cone_trace_ms"] > 0, volume) << row.dump();
        EXPECT_EQ(row["steps"]["voxelize_ms"] > 0, volume && row["revoxelize"] == "always") << row.dump();
    }
    std::set<std::string> expected{"1 null null"};
    for (const char* test : {"2", "3", "4", "5"})
        for (const char* when : {"always", "once"}) expected.insert(fmt::format("{} 32 \"{}\"", test, when));
    EXPECT_EQ(rows, expected);
    EXPECT_EQ(table["timings"][0]["published_gtx_960_ms"], 4.09);
    EXPECT_EQ(table["published_steps_gtx_960"]["voxelize_ms"], 1.96);
}

TEST_F(Bench, ComparesWithThePathTracerAtEqualError) {
    const json equal = measure({"--path-seconds", "0.5"})["equal_error"];
    ASSERT_TRUE(equal.is_object());
    EXPECT_GT(equal["frame_relmse"], 0);
    EXPECT_GT(equal["reference_spp"], equal["path_measured"][1]["spp"]);
    EXPECT_EQ(equal["path_measured"].size(), 2u);
    EXPECT_GT(equal["path_measured"][0]["relmse"], equal["path_measured"][1]["relmse"]) << "error falls with samples";
    if (equal["path_seconds"].is_null()) return;  // a reference of half a second may be too noisy, and is said to be
    EXPECT_NEAR(equal["path_over_frame"], equal["path_seconds"].get<double>() * 1000 / equal["frame_mean_ms"].get<double>(),
                1e-6 * equal["path_over_frame"].get<double>());
}

TEST_F(Bench, TakesASceneFileAndTheOneBesideItThatItsWallLights) {
    const auto scene = [&](const char* emission, const char* lamp) {
        return fmt::format(R"({{"heliodon": 1, "cameras": [{{"name": "c"}}],
          "materials": {{"wall": {{"model": "lambert", "emission_nits": {}}}}},
          "nodes": [{{"shape": {{"type": "quad", "origin": [-1,0,-1], "u": [2,0,0], "v": [0,2,0]}}, "material": "wall"}},
                    {{"shape": {{"type": "quad", "origin": [-1,0,-1], "u": [0,0,2], "v": [2,0,0]}}}}{}]}})",
                           emission, lamp);
    };
    write("s.heliodon.json", scene("0", R"(, {"light": {"type": "point", "intensity_cd": 9}, "translate": [0,1,0]})"));
    const auto tests = [](const json& table) {
        std::set<int> numbers;
        for (const json& row : table["timings"]) numbers.insert(row["test"].get<int>());
        return numbers;
    };
    EXPECT_EQ(tests(measure({"--scene", "s.heliodon.json", "--path-seconds", "0"})), (std::set<int>{1, 2, 3, 4}));
    write("s-emissive.heliodon.json", scene("60", ""));
    const json both = measure({"--scene", "s.heliodon.json", "--path-seconds", "0", "--set", "render.bounces=1"});
    EXPECT_EQ(tests(both), (std::set<int>{1, 2, 3, 4, 5}));
    EXPECT_TRUE(both["equal_error"].is_null());
    EXPECT_EQ(tests(measure({"--scene", "s-emissive.heliodon.json", "--path-seconds", "0"})), (std::set<int>{5}));
    EXPECT_EQ(files(), (std::vector<std::string>{"s-emissive.heliodon.json", "s.heliodon.json"}));
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
