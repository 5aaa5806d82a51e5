#include "scene/scene_overrides.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

namespace heliodon::scene_file {
namespace {

struct Place {
    Json* value = nullptr;
    std::string path;
};

/// The rest of `path` after `name`, when `path` is `name` or begins with `name.`; names may hold dots.
std::optional<std::string_view> after_name(std::string_view path, std::string_view name) {
    if (!path.starts_with(name)) return std::nullopt;
    if (path.size() == name.size()) return std::string_view{};
    if (path[name.size()] != '.') return std::nullopt;
    return path.substr(name.size() + 1);
}

std::string_view first_component(std::string_view path) {
    return path.substr(0, path.find('.'));
}

std::string_view without_first_component(std::string_view path) {
    const std::size_t dot = path.find('.');
    return dot == std::string_view::npos ? std::string_view{} : path.substr(dot + 1);
}

struct Match {
    Place place;
    std::string_view rest;
};

/// The element that the longest name at the front of `path` names; nodes are found below `children` too.
std::optional<Match> find_named_element(const Place& list, std::string_view path) {
    std::optional<Match> best;
    for (std::size_t i = 0; i < list.value->size(); ++i) {
        Json& element = (*list.value)[i];
        if (!element.is_object()) continue;
        const std::string place = element_path(list.path, i);
        const auto consider = [&](const Match& match) {
            if (!best || match.rest.size() < best->rest.size()) best = match;
        };
        if (const auto name = element.find("name"); name != element.end() && name->is_string())
            if (const auto rest = after_name(path, name->get_ref<const std::string&>()))
                consider({{&element, place}, *rest});
        if (const auto children = element.find("children"); children != element.end() && children->is_array())
            if (const auto below = find_named_element({&*children, member_path(place, "children")}, path))
                consider(*below);
    }
    return best;
}

std::optional<Match> find_element(const Place& list, std::string_view path) {
    if (auto named = find_named_element(list, path)) return named;
    const std::string_view text = first_component(path);
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc{} || end != text.data() + text.size() || index >= list.value->size()) return std::nullopt;
    return Match{{&(*list.value)[index], element_path(list.path, index)}, without_first_component(path)};
}

/// The member that the longest key at the front of `path` names.
std::optional<Match> find_member(const Place& object, std::string_view path) {
    std::optional<Match> best;
    for (auto member = object.value->begin(); member != object.value->end(); ++member) {
        const auto rest = after_name(path, member.key());
        if (rest && (!best || rest->size() < best->rest.size()))
            best = Match{{&member.value(), member_path(object.path, member.key())}, *rest};
    }
    return best;
}

/// Keys that say the same thing in another way: setting the first removes the second.
constexpr std::array<std::array<std::string_view, 2>, 8> alternatives{{{"flux_lm", "intensity_cd"},
                                                                       {"intensity_cd", "flux_lm"},
                                                                       {"intensity_cd", "color"},
                                                                       {"mesh", "shape"},
                                                                       {"shape", "mesh"},
                                                                       {"aperture_f", "ev100"},
                                                                       {"shutter_s", "ev100"},
                                                                       {"iso", "ev100"}}};

void remove_alternatives(const Place& object, std::string_view key) {
    if (object.path == "$.materials") return;  // its keys are names
    for (const auto& [set, replaced] : alternatives)
        if (set == key) object.value->erase(std::string(replaced));
}

/// A time says where the sun stands.
void remove_sun_direction(Json& sky) {
    const auto sun = sky.find("sun");
    if (sun == sky.end() || !sun->is_object()) return;
    sun->erase("azimuth_deg");
    sun->erase("elevation_deg");
}

/// Where `path` leads; members that are missing are made.
Result<AppliedOverride> set_value(Json& document, const Override& override_, const std::string& label) {
    Place at{&document, "$"};
    std::string_view rest = override_.path;
    std::string first_made;
    while (!rest.empty()) {
        std::optional<Match> next;
        if (at.value->is_array()) {
            next = find_element(at, rest);
            if (!next)
                return fail(label,
                            fmt::format("expected the name or index of one of the {} elements of {}, found \"{}\"",
                                        at.value->size(), at.path, first_component(rest)));
        } else if (at.value->is_object()) {
            next = find_member(at, rest);
            const std::string_view key = next ? rest.substr(0, rest.size() - next->rest.size()) : first_component(rest);
            remove_alternatives(at, key.ends_with('.') ? key.substr(0, key.size() - 1) : key);
            if (!next) {
                const std::string made = member_path(at.path, key);
                if (first_made.empty()) first_made = made;
                next = Match{{&(*at.value)[std::string(key)], made}, without_first_component(rest)};
                if (!next->rest.empty()) *next->place.value = Json::object();
            }
        } else {
            return fail(label,
                        fmt::format("expected an object or a list at {}, found {}", at.path, describe(*at.value)));
        }
        at = next->place;
        rest = next->rest;
    }
    if (at.path == "$.sky.time") remove_sun_direction(document["sky"]);
    const Result<Json> value = parse_document(override_.value, label);
    *at.value = value ? *value : Json(override_.value);
    return AppliedOverride{label, at.path, first_made.empty() ? at.path : first_made};
}

}  // namespace

Result<std::vector<AppliedOverride>> apply_overrides(Json& document, std::span<const Override> overrides) {
    std::vector<AppliedOverride> applied;
    for (const Override& override_ : overrides) {
        const std::string label = override_.option.empty() ? fmt::format("--set {}={}", override_.path, override_.value) : override_.option;
        if (override_.path.empty()) return fail(label, "expected a dotted path before '=', found none");
        Result<AppliedOverride> result = set_value(document, override_, label);
        if (!result) return tl::unexpected<Error>(result.error());
        applied.push_back(*std::move(result));
    }
    return applied;
}

}  // namespace heliodon::scene_file
