#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "import/photometric_text.h"
#include "scene/luminaire.h"

namespace heliodon::import {

// One a format; each throws ImportFailure. What is doubtful goes into `warnings`.
/// IES LM-63 of 1986, 1991, 1995, 2002 and 2019. `folder` is where TILT=FILE is looked for.
[[nodiscard]] Luminaire read_ies(PhotometricText& text, const std::filesystem::path& folder, Warnings& warnings);
/// EULUMDAT (Stockmar 1990, 1998) with the lamps of set `lamp_set`, counted from 1.
[[nodiscard]] Luminaire read_eulumdat(PhotometricText& text, int lamp_set, Warnings& warnings);

/// What follows "TILT" and "=" where the line says so, whatever its case.
[[nodiscard]] std::optional<std::string_view> tilt_of(std::string_view line);

/// A message where angles in degrees from nadir do not cover the lower half, the upper half or both.
[[nodiscard]] std::optional<std::string> doubt_of_polar_angles(std::span<const double> polar_deg);

/// Intensities in one half-plane about the polar axis.
struct PhotometricPlane {
    double azimuth_deg = 0;
    std::vector<double> candela;
};
/// What a file's planes stand for besides themselves.
enum class PlaneSymmetry { none, all_round, mirrored_at_0_180, mirrored_at_90_270, quadrants, half_space };
/// The whole web from planes that hold one part of it. Half-spaces lie within 90° of azimuth 0, and send nothing to the
/// other side.
[[nodiscard]] PhotometricWeb complete_web(std::span<const double> polar_deg, std::vector<PhotometricPlane> planes,
                                          PlaneSymmetry symmetry);

}  // namespace heliodon::import
