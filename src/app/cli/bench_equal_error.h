#pragma once

#include <array>
#include <optional>

#include "core/image.h"
#include "core/result.h"
#include "scene/scene.h"

namespace heliodon::cli {

/// relMSE (the mean of d² / (r² + 0.01) on exposed values) without the noise of the reference r: of two independent
/// path-traced pictures A and B, d² is (test − A)(test − B), whose mean their noise does not change, and r is (A + B)
/// / 2.
struct NoiselessError {
    double relmse = 0;
    double half_width_95 = 0;  ///< as pixels differ
};

/// How long the path tracer takes to a picture as far from the truth as one real-time frame is. The error of a picture
/// of N samples is a/N; a is the mean of what two measured pictures say, weighted by how certain they are.
struct EqualError {
    int voxels = 0;       ///< of the real-time frame
    double frame_ms = 0;  ///< mean, on the GPU
    NoiselessError frame;
    int reference_samples = 0;  ///< a pixel, of each of the two references
    double reference_seconds = 0;
    struct Measured {
        int samples = 0;
        double seconds = 0;
        NoiselessError error;
    };
    std::array<Measured, 2> path;
    unsigned threads = 0;  ///< that traced
    /// Nothing where an error is smaller than it is certain. At least one sample a pixel.
    std::optional<double> path_samples, path_seconds;

    [[nodiscard]] std::optional<double> ratio() const {
        return path_seconds ? std::optional(*path_seconds * 1000 / frame_ms) : std::nullopt;
    }
};

/// Traces two references and two pictures of a sixteenth and a quarter of their samples in about `path_seconds`, and
/// compares with them the real-time `frame`, which `voxels` and `frame_ms` are of.
[[nodiscard]] Result<EqualError> find_equal_error(const Scene& scene, const Camera& camera, const Image& frame,
                                                  double path_seconds);

}  // namespace heliodon::cli
