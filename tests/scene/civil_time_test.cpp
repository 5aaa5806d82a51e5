// Times as ISO 8601 writes them.
#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "scene/civil_time.h"

namespace heliodon {
namespace {

TEST(CivilTime, ReadsIso8601WithItsOffset) {
    const std::pair<const char*, double> table[] = {{"1970-01-01T00:00:00Z", 0},
                                                    {"1970-01-01T01:00+01:00", 0},
                                                    {"1969-12-31T19:30:00-04:30", 0},
                                                    {"2000-02-29T12:00:00.25+00", 951825600.25},
                                                    {"1900-01-01T00:00:00Z", -2208988800.0},
                                                    {"2100-12-31T23:59:59Z", 4133980799.0}};
    for (const auto& [text, seconds] : table) {
        const auto time = parse_civil_time(text);
        ASSERT_TRUE(time) << text << ": " << time.error().text();
        EXPECT_DOUBLE_EQ(time->unix_s, seconds) << text;
    }
}

TEST(CivilTime, WritesWhatItReads) {
    for (const char* text : {"2026-03-21T09:00:00+01:00", "1999-12-31T23:59:59Z", "2024-02-29T00:00:00-11:30", "1900-01-01T00:00:01+14:00"})
        EXPECT_EQ(to_iso8601(*parse_civil_time(text)), text);
    EXPECT_EQ(to_iso8601(*parse_civil_time("2025-12-31T23:59:59.7Z")), "2026-01-01T00:00:00Z") << "rounds to whole seconds";
    EXPECT_EQ(to_iso8601(start_of_day(*parse_civil_time("2026-03-21T00:30:00+01:00"))), "2026-03-21T00:00:00+01:00");
}

TEST(CivilTime, BadDatesAndTimesAreToldWhatIsWrongWithThem) {
    const std::pair<const char*, const char*> table[] = {
        {"2023-02-29T12:00:00Z", "expected a day of the calendar, found 2023-02-29"},
        {"1900-02-29T12:00:00Z", "expected a day of the calendar, found 1900-02-29"},
        {"2026-13-01T12:00:00Z", "expected a day of the calendar, found 2026-13-01"},
        {"2026-00-10T12:00:00Z", "expected a day of the calendar, found 2026-00-10"},
        {"2026-04-31T12:00:00Z", "expected a day of the calendar, found 2026-04-31"},
        {"1899-12-31T23:59:59Z", "expected a year from 1900 to 2100, found 1899"},
        {"2101-01-01T00:00:00Z", "expected a year from 1900 to 2100, found 2101"},
        {"2026-03-21T24:00:00Z", "expected a time from 00:00 to 23:59, found 24:00"},
        {"2026-03-21T12:60:00Z", "expected a time from 00:00 to 23:59, found 12:60"},
        {"2016-12-31T23:59:60Z", "expected seconds from 00 to 59, found 60: leap seconds"},
        {"2026-03-21T12:00:61Z", "expected seconds from 00 to 59, found 61"},
        {"2026-03-21T12:00:00+15:00", "offset from UTC of at most 14:00, found 15:00"},
        {"2026-03-21T12:00:00", "expected a time with its offset"},
        {"2026-03-21 12:00:00Z", "expected a time with its offset"},
        {"2026-3-21T12:00:00Z", "expected a time with its offset"},
        {"2026-03-21T12:00:00.Z", "expected a time with its offset"},
        {"2026-03-21T12:00:00Z ", "expected a time with its offset"},
        {"2026-03-21T12:00:00+1:00", "expected a time with its offset"},
        {"noon", "expected a time with its offset"},
        {"", "expected a time with its offset"}};
    for (const auto& [text, message] : table) {
        const auto time = parse_civil_time(text, "$.sky.time");
        ASSERT_FALSE(time) << text;
        EXPECT_NE(time.error().message.find(message), std::string::npos) << text << ": " << time.error().message;
        EXPECT_EQ(time.error().where, "$.sky.time");
    }
}

TEST(CivilTime, AnyTextIsReadOrRefused) {
    std::mt19937 random(7);
    const std::string whole = "2026-03-21T09:00:00.5+01:00", characters = "0123456789-+:.TZ \xff";
    for (int i = 0; i < 20000; ++i) {
        std::string text = whole.substr(0, random() % (whole.size() + 1));
        for (unsigned changes = random() % 4; changes-- > 0 && !text.empty();) text[random() % text.size()] = characters[random() % characters.size()];
        if (const auto time = parse_civil_time(text)) {
            EXPECT_TRUE(parse_civil_time(to_iso8601(*time)) || std::abs(time->unix_s - 0.5 * (4133980799.0 - 2208988800.0)) > 3.1e9) << text;
        } else {
            EXPECT_FALSE(time.error().message.empty());
        }
    }
}

}  // namespace
}  // namespace heliodon
