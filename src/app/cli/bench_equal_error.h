#pragma once

#include <array>
#include <optional>

#include "core/image.h"
#include "core/result.h"
#include "scene/scene.h"

namespace heliodon::cli {

/// How long the path tracer takes to a picture as far from the truth as one real-time frame is. Both errors are relMSE
/// against a path-traced reference. The path tracer's falls as a/N + b with its samples N, b being the reference's own
/// noise; a and b follow from two measured pictures.
struct EqualError {
    int voxels = 0;              ///< of the real-time frame
    double frame_ms = 0;         ///< mean, on the GPU
    double relmse = 0;           ///< of that frame
    int reference_samples = 0;   ///< a pixel
    double reference_seconds = 0;
    struct Measured {
        int samples = 0;
        double seconds = 0, relmse = 0;
    };
    std::array<Measured, 2> path;
    double reference_noise = 0;  ///< b
    unsigned threads = 0;        ///< that traced
    /// Nothing where the reference is too noisy to tell. At least one sample a pixel.
    std::optional<double> path_samples, path_seconds;

    [[nodiscard]] std::optional<double> ratio() const {
        return path_seconds ? std::optional(*path_seconds * 1000 / frame_ms) : std::nullopt;
    }
};

/// Traces a reference for `path_seconds` and two pictures of a sixteenth and a quarter of its samples, and compares
/// them and the real-time `frame`, which `voxels` and `frame_ms` are of.
[[nodiscard]] Result<EqualError> find_equal_error(const Scene& scene, const Camera& camera, const Image& frame,
                                                  double path_seconds);

}  // namespace heliodon::cli
