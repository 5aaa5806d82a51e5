#include "scene/time_of_day.h"

#include <gtest/gtest.h>

#include "scene_file_fixture.h"

namespace heliodon {
namespace {

CivilTime at(const char* text) {
    const auto time = parse_civil_time(text);
    EXPECT_TRUE(time) << text;
    return time.value_or(CivilTime{});
}

TEST(TimeOfDay, TheSkysSunStandsWhereTheAlmanacHasIt) {
    Sky sky;
    sky.model = SkyModel::hosek;
    sky.place = Place{glm::radians(59.9), glm::radians(10.7)};
    const CivilTime morning = at("2026-03-21T09:00:00+01:00");
    const SunPosition sun = sun_position(*sky.place, morning.unix_s);
    const Sky moved = sky_at(sky, morning);
    EXPECT_FLOAT_EQ(moved.sun_azimuth_rad, static_cast<float>(sun.azimuth_rad));
    EXPECT_FLOAT_EQ(moved.sun_elevation_rad, static_cast<float>(sun.elevation_rad));
    EXPECT_LT(sky_at(sky, at("2026-03-21T01:00:00+01:00")).sun_elevation_rad, 0);
    sky.model = SkyModel::cie;
    EXPECT_EQ(sky_at(sky, at("2026-03-21T01:00:00+01:00")).sun_elevation_rad, 0) << "a CIE sky is one by day";
    sky.place.reset();
    EXPECT_EQ(sky_at(sky, morning).sun_elevation_rad, sky.sun_elevation_rad) << "nowhere";
}

TEST(TimeOfDay, MomentsSpanARangeWithBothItsEnds) {
    const CivilTime first = at("2026-03-21T06:00+01:00"), last = at("2026-03-21T18:00+01:00");
    const auto hours = moments_by_step(first, last, 3600);
    ASSERT_EQ(hours.size(), 13u);
    EXPECT_EQ(to_iso8601(hours[12]), "2026-03-21T18:00:00+01:00");
    EXPECT_EQ(moments_by_step(first, last, 7 * 3600).size(), 2u) << "no step beyond the end";
    const auto frames = moments_between(first, last, 5);
    ASSERT_EQ(frames.size(), 5u);
    EXPECT_EQ(to_iso8601(frames[1]), "2026-03-21T09:00:00+01:00");
    EXPECT_EQ(to_iso8601(frames[4]), "2026-03-21T18:00:00+01:00");
    EXPECT_EQ(moments_between(first, last, 1).size(), 1u);
}

TEST(TimeOfDay, AnAnimationMovesTheSkysTime) {
    using tests::parsed;
    Scene scene = parsed(R"({"heliodon": 1,
        "sky": {"model": "hosek", "latitude_deg": 48, "longitude_deg": 11, "time": "2026-06-21T06:00+02:00"},
        "animations": [{"name": "day", "channels": [{"target": "sky.time", "times_s": [0, 10],
                        "values": ["2026-06-21T06:00+02:00", "2026-06-21T16:00+02:00"]}]}]})");
    scene.apply_animations(4);
    ASSERT_TRUE(scene.sky().time);
    EXPECT_EQ(to_iso8601(*scene.sky().time), "2026-06-21T10:00:00+02:00");
    EXPECT_FLOAT_EQ(scene.sky().sun_elevation_rad,
                    static_cast<float>(sun_position(*scene.sky().place, at("2026-06-21T10:00+02:00").unix_s).elevation_rad));
}

}  // namespace
}  // namespace heliodon
