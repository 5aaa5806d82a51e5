#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/display_options.h"
#include "app/cli/probe.h"
#include "scene/scene.h"

namespace heliodon::cli {

enum class Engine { realtime, path };

/// Readers for option values. What they cannot read is thrown as CLI::ValidationError naming `option`.
[[nodiscard]] Engine read_engine(const std::string& text);
[[nodiscard]] Integrator read_integrator(const std::string& text);

struct Size {
    int width = 1024, height = 768;
};
/// `WIDTHxHEIGHT`, each from 1 to 16384.
[[nodiscard]] Size read_size(const std::string& text);

struct FrameRange {
    int first = 0, last = 0;
};
/// `A..B`, both included, A ≤ B, not negative.
[[nodiscard]] FrameRange read_frames(const std::string& text);

/// Comma-separated names out of albedo, normal, depth, position, direct, indirect, illuminance, ao, and those of is_voxel_aov and is_path_aov.
[[nodiscard]] std::vector<std::string> read_aovs(const std::string& text);

[[nodiscard]] float read_ev100(const std::string& text);
[[nodiscard]] ToneCurve read_tone_curve(const std::string& text);
/// `MIN:MAX`, 0 ≤ MIN < MAX, or `MIN:MAX:log`, 0 < MIN; either with `:lux` behind it.
[[nodiscard]] FalseColourRange read_false_colour(const std::string& text);
struct TimeRange {
    CivilTime first, last;
};
/// `A..B`, two ISO 8601 moments, B not before A.
[[nodiscard]] TimeRange read_time_range(const std::string& text);
/// A duration in seconds: a number with s, min, h or d.
[[nodiscard]] double read_duration(const std::string& text);
/// `X,Y` of a pixel.
[[nodiscard]] ProbedPixel read_pixel(const std::string& text);
/// Accepts the kinds of global illumination that this version has: none, vct.
[[nodiscard]] std::string read_gi(const std::string& text);
/// A power of two that a voxel volume may have an edge.
[[nodiscard]] int read_voxels(const std::string& text);
/// Whether the AOV shows the voxel volume: voxels, opacity.
[[nodiscard]] bool is_voxel_aov(const std::string& name);
/// Whether the AOV tells of the path tracer's samples: variance, samples.
[[nodiscard]] bool is_path_aov(const std::string& name);

/// Validators of numbers: empty, or what was expected and found.
[[nodiscard]] std::string check_positive(const std::string& text);
[[nodiscard]] std::string check_not_negative(const std::string& text);

/// `path` for frame `frame`: a run of # becomes the number with that many digits; without one, `-0000` goes
/// before the ending.
[[nodiscard]] std::string numbered_path(const std::string& path, int frame);

}  // namespace heliodon::cli
