// heliodon sun, and --time where a scene's sky follows it.
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace heliodon::tests {
namespace {

class SunCommand : public ProgramTest {
protected:
    Ended sun(std::vector<std::string> more) {
        std::vector<std::string> arguments{"sun"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
};

TEST_F(SunCommand, TellsWhereTheSunStandsAsJson) {
    const Ended ended = sun({"--latitude-deg", "39.742476", "--longitude-deg", "-105.1786", "--altitude-m", "1830.14", "--pressure-hpa", "820",
                             "--temperature-c", "11", "--time", "2003-10-17T12:30:30-07:00", "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    const auto json = nlohmann::json::parse(ended.output);
    EXPECT_NEAR(json["azimuth_deg"].get<double>(), 194.340241, 0.001);
    EXPECT_NEAR(json["elevation_deg"].get<double>(), 90 - 50.111622, 0.001);
    EXPECT_LT(json["elevation_true_deg"], json["elevation_deg"]);
    EXPECT_EQ(json["sunrise"].get<std::string>().substr(0, 16), "2003-10-17T06:12");
    EXPECT_EQ(json["solar_noon"], "2003-10-17T11:46:05-07:00");
    EXPECT_EQ(json["state"], "rises_and_sets");
    const auto& lux = json["illuminance_lux"];
    EXPECT_GT(lux["direct_normal"], 60000);
    EXPECT_GT(lux["global_horizontal"], lux["sky_horizontal"]);
}

TEST_F(SunCommand, TellsOfPolarNightInWords) {
    const Ended ended = sun({"--latitude-deg", "78.2", "--longitude-deg", "15.6", "--time", "2026-12-21T12:00:00+01:00"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    EXPECT_NE(ended.output.find("polar_night"), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("sunrise     none"), std::string::npos) << ended.output;
}

TEST_F(SunCommand, RefusesABadDateWithOneLineAndExitCode1) {
    for (const char* time : {"2026-02-29T12:00:00Z", "2016-12-31T23:59:60Z", "1850-01-01T00:00:00Z", "today"}) {
        const Ended ended = sun({"--latitude-deg", "50", "--longitude-deg", "8", "--time", time});
        EXPECT_EQ(ended.code, 1) << time;
        EXPECT_EQ(ended.error_lines(), 1) << ended.error;
        EXPECT_EQ(ended.error.rfind("heliodon: --time: expected", 0), 0u) << ended.error;
        EXPECT_TRUE(ended.output.empty());
    }
}

TEST_F(SunCommand, RefusesPlacesAndAirThatThereAreNot) {
    const std::vector<std::string> noon{"--longitude-deg", "8", "--time", "2026-06-21T12:00:00Z"};
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--latitude-deg", "91"}, {"--latitude-deg", "nan"}, {"--latitude-deg", "50", "--turbidity", "0"},
                                                  {"--latitude-deg", "50", "--turbidity", "1.5", "--model", "preetham"}, {"--latitude-deg", "50", "--model", "nishita"}}) {
        std::vector<std::string> arguments = noon;
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const Ended ended = sun(arguments);
        EXPECT_EQ(ended.code, 2) << ended.error;
        EXPECT_EQ(ended.error_lines(), 1) << ended.error;
    }
}

constexpr const char* open_ground = R"({"heliodon": 1, "cameras": [{"name": "c"}],
    "sky": {"model": "hosek", "latitude_deg": 48.8, "longitude_deg": 9.2, "sun": {"azimuth_deg": 10, "elevation_deg": 60}},
    "sensors": [{"name": "ground", "type": "illuminance", "position": [0,0,0], "normal": [0,1,0]}]})";

TEST_F(SunCommand, TimeTakesThePlaceOfTheScenesOwnSun) {
    write("s.heliodon.json", open_ground);
    const auto lux = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"measure", "s.heliodon.json", "--spp", "1024", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Ended ended = run(arguments);
        EXPECT_EQ(ended.code, 0) << ended.error;
        return ended.code == 0 ? nlohmann::json::parse(ended.output)["sensors"][0]["value"].get<double>() : 0;
    };
    const double by_sun = lux({}), noon = lux({"--time", "2026-06-21T13:25:00+02:00"}), night = lux({"--time", "2026-06-21T01:00:00+02:00"});
    EXPECT_GT(by_sun, 50000);
    EXPECT_NEAR(noon, by_sun, 0.1 * by_sun) << "64.6° high";
    EXPECT_LT(night, 0.1);
    EXPECT_GT(night, 1e-4);
    const Ended wrong = run({"measure", "s.heliodon.json", "--time", "2026-06-31T13:25:00+02:00"});
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.error.find("expected a day of the calendar, found 2026-06-31"), std::string::npos) << wrong.error;
    EXPECT_NE(wrong.error.find("--time"), std::string::npos) << wrong.error;
}

TEST_F(SunCommand, NoEnvironmentPutsTheSunOutToo) {
    write("s.heliodon.json", open_ground);
    const Ended ended = run({"measure", "s.heliodon.json", "--spp", "64", "--json", "--no-environment"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    EXPECT_EQ(nlohmann::json::parse(ended.output)["sensors"][0]["value"].get<double>(), 0);
}

}  // namespace
}  // namespace heliodon::tests
