// The house of examples/house: read as it was modelled, and lit by the sun of its place and time.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace heliodon::tests {
namespace {

using nlohmann::json;

class House : public ProgramTest {
protected:
    static constexpr const char* file = HELIODON_SOURCE_DIR "/examples/house/house.heliodon.json";
    /// Lux by sensor, those of the grid left out.
    [[nodiscard]] std::map<std::string, double> measure(const std::string& time) const {
        const Ended ended = run({"measure", file, "--time", time, "--spp", "1024", "--json"});
        EXPECT_EQ(ended.code, 0) << ended.error;
        if (ended.code != 0) return {};
        const json found = json::parse(ended.output);
        std::map<std::string, double> lux;
        for (const json& sensor : found["sensors"]) lux[sensor["name"]] = sensor["value"].get<double>();
        return lux;
    }
};

TEST_F(House, IsReadAsItWasModelled) {
    const Ended ended = run({"info", file, "--json"});
    ASSERT_EQ(ended.code, 0) << ended.error;
    EXPECT_TRUE(ended.error.empty()) << ended.error;
    const json found = json::parse(ended.output);
    ASSERT_TRUE(found.contains("warnings"));
    EXPECT_TRUE(found["warnings"].empty()) << found["warnings"];
    EXPECT_EQ(found["cameras"].size(), 2u);
    EXPECT_EQ(found["sensors"].size(), 5u);
}

TEST_F(House, HasDaylightByPlaceAndTime) {
    const auto dawn = measure("2026-04-21T08:00:00+02:00"), morning = measure("2026-04-21T11:00:00+02:00");
    ASSERT_TRUE(dawn.contains("terrace") && morning.contains("desk"));
    // Lambert's cosine: the sun stands at 14.4 and 43.3 degrees, and is dimmer where it is low.
    EXPECT_GT(morning.at("terrace"), dawn.at("terrace") * std::sin(0.756) / std::sin(0.251));
    for (const char* indoors : {"desk", "dining table", "floor"}) {
        EXPECT_GT(morning.at(indoors), 200) << indoors << ": daylight comes through the panes";
        EXPECT_LT(morning.at(indoors), 0.3 * morning.at("terrace")) << indoors;
    }
}

}  // namespace
}  // namespace heliodon::tests
