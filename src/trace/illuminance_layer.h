#pragma once

#include <vector>

#include "trace/render_loop.h"

namespace heliodon::trace {

/// Lux on the side that is seen of the first surface (blended ones are looked through), as a sensor there measures them:
/// the mean over those samples that meet one. 0 on the back of a one-sided surface.
class IlluminanceLayer {
public:
    IlluminanceLayer(int width, int height);
    /// Goes on to `end` samples a pixel.
    [[nodiscard]] PathCounts add_samples(const CpuKernel& kernel, const EmbreeScene& scene, int end);
    /// That each pixel has.
    [[nodiscard]] int samples() const { return done_; }
    [[nodiscard]] Image image() const;

private:
    struct Sum {
        glm::dvec3 lux{0};
        int hits = 0;
    };
    int width_, height_, done_ = 0;
    std::vector<Sum> sums_;
};

}  // namespace heliodon::trace
