#pragma once

#include "core/image.h"
#include "core/result.h"

namespace heliodon {

/// The metrics of `heliodon compare` (docs/accuracy.md): on linear values divided by 1.2 · 2^EV100.
struct Metrics {
    double mse = 0, rmse = 0;
    double relmse = 0;  ///< mean of d² / (r² + 0.01)
    double mae = 0;
    double median_relative = 0;  ///< median of |d| / r on luminance where r > 0.001; NaN where it nowhere is
    double psnr = 0;             ///< dB, peak 1; infinite for equal pictures
    double ssim = 0;             ///< Wang et al. 2004, Gaussian window 11, sigma 1.5
    double flip = 0;             ///< mean LDR-FLIP, Andersson et al. 2020, 67.02 pixels a degree
};
/// Both pictures of one size (otherwise an error that says both sizes) and finite (otherwise an error that
/// says where not). Alpha is left out; one-channel pictures are grey. The errors' `where` is "reference" or
/// "test", or empty when it is about both. All means are over pixels and channels, ssim's over luminance.
[[nodiscard]] Result<Metrics> compare(const Image& reference, const Image& test, float ev100);
/// FLIP error a pixel in [0,1] (one channel), of values exposed, clipped and sRGB-encoded.
[[nodiscard]] Result<Image> flip_map(const Image& reference, const Image& test, float ev100);
/// `map` in the magma colours, display-encoded, for a heat map PNG.
[[nodiscard]] Image heatmap(const Image& map);

}  // namespace heliodon
