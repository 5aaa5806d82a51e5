#include "scene/civil_time.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>

namespace heliodon {
namespace {

constexpr double day_s = 86400;
constexpr int most_offset_min = 14 * 60;  // Kiritimati's clocks

/// Reads a text from its front.
class Scanner {
public:
    explicit Scanner(std::string_view text) : rest_(text) {}
    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    bool take(char c) {
        if (rest_.empty() || rest_.front() != c) return false;
        rest_.remove_prefix(1);
        return true;
    }
    /// Exactly so many decimal digits.
    std::optional<int> digits(std::size_t count) {
        if (rest_.size() < count) return std::nullopt;
        int value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (rest_[i] < '0' || rest_[i] > '9') return std::nullopt;
            value = 10 * value + (rest_[i] - '0');
        }
        rest_.remove_prefix(count);
        return value;
    }
    /// What follows the point of a decimal fraction: one digit or more.
    std::optional<double> fraction() {
        double value = 0, place = 0.1;
        bool any = false;
        for (; !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; place *= 0.1, any = true) {
            value += place * (rest_.front() - '0');
            rest_.remove_prefix(1);
        }
        return any ? std::optional(value) : std::nullopt;
    }

private:
    std::string_view rest_;
};

struct Fields {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
    double fraction = 0;
    int offset_hour = 0, offset_minute = 0, offset_sign = 1;
};

bool read_digits(Scanner& text, std::size_t count, int& field) {
    const auto value = text.digits(count);
    if (value) field = *value;
    return value.has_value();
}

/// By the letter of the format; whether the values make sense is another question.
std::optional<Fields> scan(std::string_view string) {
    Scanner text(string);
    Fields f;
    if (!(read_digits(text, 4, f.year) && text.take('-') && read_digits(text, 2, f.month) && text.take('-') && read_digits(text, 2, f.day) &&
          text.take('T') && read_digits(text, 2, f.hour) && text.take(':') && read_digits(text, 2, f.minute)))
        return std::nullopt;
    if (text.take(':')) {
        if (!read_digits(text, 2, f.second)) return std::nullopt;
        if (text.take('.')) {
            const auto fraction = text.fraction();
            if (!fraction) return std::nullopt;
            f.fraction = *fraction;
        }
    }
    if (!text.take('Z')) {
        f.offset_sign = text.take('-') ? -1 : 1;
        if (f.offset_sign > 0 && !text.take('+')) return std::nullopt;
        if (!read_digits(text, 2, f.offset_hour)) return std::nullopt;
        if (text.take(':') && !read_digits(text, 2, f.offset_minute)) return std::nullopt;
    }
    return text.at_end() ? std::optional(f) : std::nullopt;
}

std::chrono::year_month_day date_of(const Fields& f) {
    return std::chrono::year(f.year) / std::chrono::month(static_cast<unsigned>(f.month)) / std::chrono::day(static_cast<unsigned>(f.day));
}

/// What is wrong with the values, or nothing.
std::string complaint(const Fields& f) {
    if (f.year < first_year || f.year > last_year) return fmt::format("expected a year from {} to {}, found {}", first_year, last_year, f.year);
    if (!date_of(f).ok()) return fmt::format("expected a day of the calendar, found {:04}-{:02}-{:02}", f.year, f.month, f.day);
    if (f.hour > 23 || f.minute > 59) return fmt::format("expected a time from 00:00 to 23:59, found {:02}:{:02}", f.hour, f.minute);
    if (f.second == 60) return "expected seconds from 00 to 59, found 60: leap seconds cannot be told apart, give the second before or after";
    if (f.second > 60) return fmt::format("expected seconds from 00 to 59, found {:02}", f.second);
    if (f.offset_minute > 59 || 60 * f.offset_hour + f.offset_minute > most_offset_min)
        return fmt::format("expected an offset from UTC of at most 14:00, found {:02}:{:02}", f.offset_hour, f.offset_minute);
    return {};
}

}  // namespace

Result<CivilTime> parse_civil_time(std::string_view text, const std::string& where) {
    const auto fields = scan(text);
    if (!fields)
        return fail(where, fmt::format("expected a time with its offset from UTC as ISO 8601 has it (2026-03-21T09:00:00+01:00 or …Z), found \"{}\"", text));
    if (std::string wrong = complaint(*fields); !wrong.empty()) return fail(where, std::move(wrong));
    const auto days = std::chrono::sys_days(date_of(*fields)).time_since_epoch().count();
    CivilTime time;
    time.offset_min = fields->offset_sign * (60 * fields->offset_hour + fields->offset_minute);
    time.unix_s = day_s * static_cast<double>(days) + 3600 * fields->hour + 60 * (fields->minute - time.offset_min) + fields->second + fields->fraction;
    return time;
}

std::string to_iso8601(const CivilTime& time) {
    const double local = std::round(time.unix_s) + 60.0 * time.offset_min;
    const double day = std::floor(local / day_s);
    const int second = static_cast<int>(local - day * day_s);
    const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(static_cast<long>(day)))};
    std::string text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                                   static_cast<unsigned>(date.day()), second / 3600, second / 60 % 60, second % 60);
    if (time.offset_min == 0) return text + "Z";
    const int offset = std::abs(time.offset_min);
    return text + fmt::format("{}{:02}:{:02}", time.offset_min < 0 ? '-' : '+', offset / 60, offset % 60);
}

CivilTime start_of_day(const CivilTime& time) {
    const double offset = 60.0 * time.offset_min;
    return {std::floor((time.unix_s + offset) / day_s) * day_s - offset, time.offset_min};
}

}  // namespace heliodon
