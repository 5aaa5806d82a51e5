#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/cli/commands.h"
#include "app/cli/terminal.h"
#include "core/units.h"
#include "scene/scene.h"
#include "scene/sun_position.h"
#include "shading/cie_sky.h"
#include "shading/daylight.h"

namespace heliodon::cli {
namespace {

struct SunOptions {
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
    std::string time;
    Air air;
    std::string model = "hosek";
    double turbidity = 3, ground_albedo = 0.2;
    bool json = false;
};

struct Illuminance {
    double sun_normal, sky_horizontal, horizontal;
};

Illuminance illuminance(const SunOptions& options, const SunPosition& sun) {
    const Sky defaults;
    shading::Daylight daylight;
    daylight.model = options.model == "hosek" ? shading::sky_model_hosek : shading::sky_model_preetham;
    daylight.turbidity = options.turbidity;
    daylight.ground_albedo = options.ground_albedo;
    daylight.sun_elevation = sun.elevation_rad;
    shading::SkyData sky{};
    shading::set_daylight_sky(daylight, sky);
    const shading::Sunlight direct = shading::sunlight(daylight.model, options.turbidity, sun.elevation_rad, defaults.sun_angular_diameter_rad);
    const double from_sky = shading::horizontal_illuminance(sky);
    return {units::luminance(direct.normal()), from_sky, from_sky + units::luminance(direct.level())};
}

const char* name(SunState state) {
    switch (state) {
        case SunState::polar_day: return "polar_day";
        case SunState::polar_night: return "polar_night";
        default: return "rises_and_sets";
    }
}

Result<void> sun(const SunOptions& options) {
    const auto time = parse_civil_time(options.time, "--time");
    if (!time) return tl::unexpected(time.error());
    const Place place{glm::radians(options.latitude_deg), glm::radians(options.longitude_deg), options.altitude_m};
    const SunPosition position = sun_position(place, time->unix_s, options.air);
    const SunDay day = sun_day(place, *time);
    const Illuminance lux = illuminance(options, position);
    const auto clock = [&](double unix_s) { return to_iso8601({unix_s, time->offset_min}); };
    const double azimuth_deg = glm::degrees(position.azimuth_rad), elevation_deg = glm::degrees(position.elevation_rad);
    if (!options.json) {
        const auto or_none = [&](const std::optional<double>& moment) { return moment ? clock(*moment) : std::string("none"); };
        return print(fmt::format("azimuth     {:9.4f}° from north, clockwise\nelevation   {:9.4f}° apparent, {:.4f}° without refraction\n"
                                 "sunrise     {}\nsolar noon  {}\nsunset      {}\nstate       {}\n"
                                 "sun         {:.6g} lx on a plane that faces it\nsky         {:.6g} lx on level ground\ntogether    {:.6g} lx on level ground\n",
                                 azimuth_deg, elevation_deg, glm::degrees(position.elevation_true_rad), or_none(day.sunrise), clock(day.solar_noon),
                                 or_none(day.sunset), name(day.state), lux.sun_normal, lux.sky_horizontal, lux.horizontal));
    }
    nlohmann::ordered_json result{{"azimuth_deg", azimuth_deg},
                                  {"elevation_deg", elevation_deg},
                                  {"elevation_true_deg", glm::degrees(position.elevation_true_rad)},
                                  {"sunrise", nullptr},
                                  {"solar_noon", clock(day.solar_noon)},
                                  {"sunset", nullptr},
                                  {"state", name(day.state)},
                                  {"illuminance_lux", {{"direct_normal", lux.sun_normal}, {"sky_horizontal", lux.sky_horizontal}, {"global_horizontal", lux.horizontal}}}};
    if (day.sunrise) result["sunrise"] = clock(*day.sunrise);
    if (day.sunset) result["sunset"] = clock(*day.sunset);
    return print(result.dump(2) + "\n");
}

/// A number of this range, NaN being none.
CLI::Validator between(double low, double high) {
    return CLI::Validator(
        [low, high](std::string& text) {
            double value = 0;
            const bool read = CLI::detail::lexical_cast(text, value);
            return read && value >= low && value <= high ? std::string() : fmt::format("expected a number from {:g} to {:g}, found \"{}\"", low, high, text);
        },
        fmt::format("{:g} to {:g}", low, high));
}

}  // namespace

Action declare_sun(CLI::App& command) {
    auto options = std::make_shared<SunOptions>();
    command.add_option("--latitude-deg", options->latitude_deg, "North of the equator")->required()->check(between(-90, 90));
    command.add_option("--longitude-deg", options->longitude_deg, "East of Greenwich")->required()->check(between(-180, 180));
    command.add_option("--time", options->time, "ISO 8601 with its offset: 2026-03-21T09:00:00+01:00")->required();
    command.add_option("--altitude-m", options->altitude_m, "Above sea level; default 0")->check(between(-500, 10000));
    command.add_option("--pressure-hpa", options->air.pressure_hpa, "Of the air, for refraction; default 1010")->check(between(0, 1200));
    command.add_option("--temperature-c", options->air.temperature_c, "Of the air, for refraction; default 10")->check(between(-100, 100));
    command.add_option("--model", options->model, "Of the sky: hosek (default) or preetham")->check(CLI::IsMember({"hosek", "preetham"}));
    command.add_option("--turbidity", options->turbidity, "Of the air; default 3")->check(between(Sky::least_turbidity_hosek, Sky::most_turbidity));
    command.add_option("--ground-albedo", options->ground_albedo, "Default 0.2")->check(between(0, 1));
    command.add_flag("--json", options->json, "Print JSON");
    return [options] {
        if (options->model == "preetham" && options->turbidity < Sky::least_turbidity_preetham)
            throw CLI::ValidationError("--turbidity", fmt::format("expected at least {:g} with the model preetham, found {:g}",
                                                                  Sky::least_turbidity_preetham, options->turbidity));
        return sun(*options);
    };
}

}  // namespace heliodon::cli
